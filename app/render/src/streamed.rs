//! A stream's frames: both eyes at the head's newest pose, made of the newest frame.

use std::rc::Rc;

use yoro::eyes::{Eye, EyePair, EyesError, PoseWarp, View};
use yoro::synthesis::{AnyView, Outputs, Source, SynthesisOptions};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};
use yoro_stream::{Content, EyeView, FrameHeader, ViewRequest};

/// Shows a stream: takes decoded frames, and makes both eyes of the newest one.
pub struct StreamedEyes {
    gl: Rc<Context>,
    decoded: Program,
    any_view: AnyView,
    /// Luma and both colour differences of the newest picture, rows from the top.
    planes: Option<[Texture; 3]>,
    /// Each eye that is in it; the first is the only one beside a depth.
    colors: [RenderTarget; 2],
    /// The first eye's depth. Two eyes have none: all is taken as far away.
    depth: Option<Texture>,
    header: Option<FrameHeader>,
    /// The first eye's depth as it is uploaded, kept from frame to frame.
    depth_rows: Vec<u8>,
    /// True if what is beyond the border of a picture is black; otherwise it repeats the border.
    pub framed: bool,
    /// The eyes that were made last.
    pair: Option<EyePair>,
}

impl StreamedEyes {
    /// Compiles what it needs.
    ///
    /// # Errors
    /// The driver refuses.
    pub fn new(gl: &Rc<Context>) -> Result<StreamedEyes, GlError> {
        let color = || RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None);
        Ok(StreamedEyes {
            gl: gl.clone(),
            decoded: Program::new(gl, ShaderSource::Screen("viewer/decoded.frag"), &[])?,
            any_view: AnyView::new(gl, &SynthesisOptions::default(), Outputs::default())?,
            planes: None,
            colors: [color()?, color()?],
            depth: None,
            header: None,
            depth_rows: Vec::new(),
            framed: false,
            pair: None,
        })
    }

    /// Takes a decoded picture: three planes one after another, tightly packed. False if they have not the size that the
    /// header tells.
    ///
    /// # Errors
    /// The GPU has no memory for it.
    pub fn take(&mut self, header: FrameHeader, planes: &[u8]) -> Result<bool, GlError> {
        let [width, height] = header.size.map(u32::from);
        let [half, rows] = [width, height].map(|n| n.next_multiple_of(2));
        let luma = (2 * half * rows) as usize;
        if planes.len() != luma * 3 / 2 {
            return Ok(false);
        }
        let sizes = [[2 * half, rows], [half, rows / 2], [half, rows / 2]];
        if self.planes.as_ref().is_none_or(|planes| planes[0].size() != sizes[0]) {
            let plane = |i: usize| Texture::new(&self.gl, sizes[i], Format::R8, Filter::Nearest);
            self.planes = Some([plane(0)?, plane(1)?, plane(2)?]);
        }
        let (y, rest) = planes.split_at(luma);
        let (u, v) = rest.split_at(luma / 4);
        let textures = self.planes.as_ref().expect("they have just been made");
        for (texture, bytes) in textures.iter().zip([y, u, v]) {
            texture.upload(bytes);
        }
        if self.depth.as_ref().is_none_or(|depth| depth.size() != [width, height]) {
            self.depth = Some(Texture::new(&self.gl, [width, height], Format::R8, Filter::Nearest)?);
        }
        let depth = self.depth.as_ref().expect("it has just been made");
        let (row, right) = (2 * half as usize, half as usize..(half + width) as usize);
        self.depth_rows.clear();
        let pictures = match header.content {
            Content::Depth(..) => {
                let from_bottom = y.chunks_exact(row).take(height as usize).rev();
                from_bottom.for_each(|line| self.depth_rows.extend_from_slice(&line[right.clone()]));
                1
            }
            Content::Eyes(_) => {
                self.depth_rows.resize((width * height) as usize, 0);
                2
            }
        };
        depth.upload(&self.depth_rows);
        for (i, color) in self.colors.iter_mut().take(pictures).enumerate() {
            color.resize([width, height])?;
            color.bind();
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.decoded.bind();
            for (unit, (name, texture)) in ["luma", "blue", "red"].into_iter().zip(textures).enumerate() {
                self.decoded.texture(name, unit as u32, texture.raw());
            }
            self.decoded.set("first_column", i as i32 * half as i32).set("height", height as i32);
            self.decoded.set("framed", i32::from(self.framed));
            self.gl.draw_screen();
        }
        self.header = Some(header);
        Ok(true)
    }

    /// Makes both eyes; black before the first frame, and where the head has turned away from all that the frame shows.
    ///
    /// # Errors
    /// The GPU has no memory for it.
    pub fn render(&mut self, pair: &EyePair, to: &[Destination; 2]) -> Result<(), GlError> {
        self.pair = Some(*pair);
        for eye in Eye::BOTH {
            let to = &to[eye.index()];
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            self.gl.clear(None);
            let (Some(header), Some(depth)) = (self.header, &self.depth) else { continue };
            let Ok((image, warp)) = warp(&header, &pair.view(eye), eye) else { continue };
            let source = Source::new(self.colors[image].color(0).raw(), depth.raw());
            self.any_view.synthesize(source, &warp, to)?;
        }
        Ok(())
    }

    /// Returns the request for the eyes that were made last, at a time in milliseconds; none before the first.
    pub fn request(&self, time: f64) -> Option<ViewRequest> {
        let pair = self.pair?;
        let eye_view =
            |eye: Eye| EyeView { pose: pair.poses[eye.index()], frustum: pair.frusta[eye.index()] };
        let size = pair.size.map(|n| n.clamp(16, 4096) as u16);
        Some(ViewRequest { time, eyes: Eye::BOTH.map(eye_view), dominant: pair.dominant, size })
    }
}

/// Returns which of the frame's images an eye is made of, and how.
fn warp(header: &FrameHeader, target: &View, eye: Eye) -> Result<(usize, PoseWarp), EyesError> {
    match header.content {
        Content::Depth(eye_view, span) => Ok((0, PoseWarp::new(&eye_view.view(header.size, span), target)?)),
        Content::Eyes(eyes) => {
            let source = eyes[eye.index()].view(header.size, [1.0, 2.0]);
            Ok((eye.index(), PoseWarp::new(&source, target)?.rotation_only()))
        }
    }
}
