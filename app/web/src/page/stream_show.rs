//! A stream on the canvas: eyes at the head's newest pose, made of the newest frame.

use std::rc::Rc;

use super::show::Layout;
use crate::settings::Settings;
use yoro::eyes::{Eye, EyePair, EyesError, Frustum, Pose, PoseWarp, View};
use yoro::synthesis::{AnyView, Outputs, Source, SynthesisOptions};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};
use yoro_render::stereo::StereoFrame;
use yoro_stream::{Content, EyeView, FrameHeader, FromViewer, ViewRequest};

/// Everything that is needed to show a stream.
pub struct StreamShow {
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
    /// The eyes' frusta where they are not the page's: a video's, which has nothing beyond them.
    pub frusta: Option<[Frustum; 2]>,
    /// The eyes that were made last.
    pair: Option<EyePair>,
    /// Their images, where they are for the canvas.
    pub frame: StereoFrame,
}

impl StreamShow {
    pub fn new(gl: &Rc<Context>) -> Result<StreamShow, GlError> {
        let color = || RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None);
        Ok(StreamShow {
            gl: gl.clone(),
            decoded: Program::new(gl, ShaderSource::Screen("viewer/decoded.frag"), &[])?,
            any_view: AnyView::new(gl, &SynthesisOptions::default(), Outputs::default())?,
            planes: None,
            colors: [color()?, color()?],
            depth: None,
            header: None,
            frusta: None,
            pair: None,
            frame: StereoFrame::new(gl, [1, 1])?,
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
        let (pictures, values): (_, Vec<u8>) = match header.content {
            Content::Depth(..) => {
                let from_bottom = y.chunks_exact(row).take(height as usize).rev();
                (1, from_bottom.flat_map(|line| &line[right.clone()]).copied().collect())
            }
            Content::Eyes(_) => (2, vec![0; (width * height) as usize]),
        };
        depth.upload(&values);
        for (i, color) in self.colors.iter_mut().take(pictures).enumerate() {
            color.resize([width, height])?;
            color.bind();
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.decoded.bind();
            for (unit, (name, texture)) in ["luma", "blue", "red"].into_iter().zip(textures).enumerate() {
                self.decoded.texture(name, unit as u32, texture.raw());
            }
            self.decoded.set("first_column", i as i32 * half as i32).set("height", height as i32);
            // What is beyond the border repeats it.
            self.decoded.set("framed", i32::from(self.frusta.is_some()));
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

    /// Returns where the eyes are shown on parts of a canvas of this size, and the eyes of a head there: the page's, or a
    /// video's, whole and with black beside them.
    pub fn place(&self, settings: &Settings, head: Pose, part: [u32; 2]) -> (Layout, EyePair) {
        let Some(frusta) = self.frusta else {
            let layout = Layout { origin: [0, 0], size: part, step: part[0], divider: 0 };
            return (layout, settings.pair(head, part));
        };
        let layout = Layout::whole(part, [frusta[0].width(), frusta[0].height()]);
        let pair = EyePair { frusta, ..settings.pair(head, layout.size) };
        (layout, pair)
    }

    /// Makes both eyes for the canvas.
    ///
    /// # Errors
    /// The GPU has no memory for it.
    pub fn draw(&mut self, pair: &EyePair) -> Result<(), GlError> {
        self.frame.resize(pair.size)?;
        let to = Eye::BOTH.map(|eye| Destination::whole(self.frame.eye(eye)));
        self.render(pair, &to)
    }

    /// Returns the message that asks for the eyes that were made last; none before the first.
    pub fn request(&self, time: f64) -> Option<Vec<u8>> {
        let pair = self.pair?;
        let eye_view =
            |eye: Eye| EyeView { pose: pair.poses[eye.index()], frustum: pair.frusta[eye.index()] };
        let size = pair.size.map(|n| n.clamp(16, 4096) as u16);
        let request = ViewRequest { time, eyes: Eye::BOTH.map(eye_view), dominant: pair.dominant, size };
        Some(FromViewer::Request(request).to_bytes())
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
