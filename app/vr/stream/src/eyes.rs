//! Both eyes of a stream at the head's newest pose, made from the newest frame.

use std::rc::Rc;

use glam::IVec2;

use yoro::eyes::{Eye, EyePair};
use yoro::opengl::{AnyView, Options, Outputs, Source};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};

use crate::{Content, EyeView, ViewRequest};

/// A decoded picture.
pub enum DecodedPicture<'a> {
    /// Luma and both colour differences, one after the other, tightly packed, rows from the top.
    Planes(&'a [u8]),
    /// Red, green and blue of a picture of this size. The function uploads them into the bound texture, rows from the
    /// top.
    Upload([u32; 2], &'a dyn Fn()),
}

/// How far the head has moved between the pose that a picture was rendered for and the one that it is shown at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// The distance in metres.
    pub metres: f32,
    /// The angle in radians.
    pub radians: f32,
}

/// Shows a stream: takes decoded frames and makes both eyes from the newest one.
pub struct StreamedEyes {
    gl: Rc<Context>,
    from_planes: Program,
    from_rgb: Program,
    any_view: AnyView,
    /// Luma and both colour differences of the newest picture, rows from the top.
    planes: Option<[Texture; 3]>,
    /// Red, green and blue of a picture that was not taken as planes, rows from the top.
    rgb: Option<Texture>,
    /// The colour of each eye in the picture.
    colors: [RenderTarget; 2],
    /// The eye's depth. Two eyes without depth are treated as infinitely far away.
    depth: RenderTarget,
    newest: Option<(Content, [u16; 2])>,
    /// True if pictures are surrounded by black. Otherwise their border is repeated outward.
    pub framed: bool,
    /// The pair of eyes that was made last.
    pair: Option<EyePair>,
    /// The number of pairs of eyes made since the last [`StreamedEyes::take_correction`], and the sum of their
    /// corrections.
    pairs: u32,
    corrected: Correction,
}

impl StreamedEyes {
    /// Compiles the programs and makes the targets.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses.
    pub fn new(gl: &Rc<Context>) -> Result<StreamedEyes, GlError> {
        let target = |format, filter| RenderTarget::new(gl, [1, 1], &[(format, filter)], None);
        let color = || target(Format::Rgba8, Filter::Linear);
        // Frames and eyes alternate between several sizes.
        let options = Options { parts: true, ..Options::default() };
        Ok(StreamedEyes {
            gl: gl.clone(),
            from_planes: Program::new(gl, ShaderSource::Screen("viewer/decoded.frag"), &[])?,
            from_rgb: Program::new(
                gl,
                ShaderSource::Screen("viewer/decoded.frag"),
                &[("RGB", String::new())],
            )?,
            any_view: AnyView::new(gl, &options, Outputs { depth: true, ..Outputs::default() })?,
            planes: None,
            rgb: None,
            colors: [color()?, color()?],
            depth: target(Format::R8, Filter::Nearest)?,
            newest: None,
            framed: false,
            pair: None,
            pairs: 0,
            corrected: Correction::default(),
        })
    }

    /// Takes a decoded picture whose parts have this size. False if the picture has another size.
    ///
    /// # Errors
    /// [`GlError`] if the GPU has no memory for it.
    pub fn take(
        &mut self,
        content: Content,
        size: [u16; 2],
        picture: &DecodedPicture,
    ) -> Result<bool, GlError> {
        let part = size.map(u32::from);
        let [column, rows] = part.map(|n| n.next_multiple_of(2));
        let whole = [2 * column, rows];
        let (program, textures) = match *picture {
            DecodedPicture::Planes(planes) => {
                let luma = (whole[0] * whole[1]) as usize;
                if planes.len() != luma * 3 / 2 {
                    return Ok(false);
                }
                if self.planes.as_ref().is_none_or(|planes| planes[0].size() != whole) {
                    let plane = |size| Texture::new(&self.gl, size, Format::R8, Filter::Nearest);
                    let half = whole.map(|n| n / 2);
                    self.planes = Some([plane(whole)?, plane(half)?, plane(half)?]);
                }
                let (y, rest) = planes.split_at(luma);
                let (u, v) = rest.split_at(luma / 4);
                let textures = self.planes.as_ref().expect("they have just been made");
                for (texture, bytes) in textures.iter().zip([y, u, v]) {
                    texture.upload(bytes);
                }
                (&self.from_planes, &textures[..])
            }
            DecodedPicture::Upload(size, upload) => {
                if size != whole {
                    return Ok(false);
                }
                if self.rgb.as_ref().is_none_or(|rgb| rgb.size() != whole) {
                    self.rgb = Some(Texture::new(&self.gl, whole, Format::Rgba8, Filter::Nearest)?);
                }
                let texture = self.rgb.as_ref().expect("it has just been made");
                texture.bind(0);
                upload();
                (&self.from_rgb, std::slice::from_ref(texture))
            }
        };
        let draw = |index: u32, depth: bool, to: &mut RenderTarget| -> Result<(), GlError> {
            to.resize(part)?;
            to.overwrite();
            self.gl.set_raster_state(&RasterState::SCREEN);
            program.bind();
            for (unit, (name, texture)) in ["picture", "blue", "red"].into_iter().zip(textures).enumerate() {
                program.texture_of(name, unit as u32, texture);
            }
            let size = IVec2::from(part.map(|n| n as i32));
            program.set("first_column", (index * column) as i32).set("size", size);
            program.set("framed", i32::from(self.framed && !depth)).set("depth", i32::from(depth));
            self.gl.draw_screen();
            Ok(())
        };
        let [first, second] = &mut self.colors;
        draw(0, false, first)?;
        match content {
            Content::Depth(..) => draw(1, true, &mut self.depth)?,
            Content::Eyes(_) => {
                draw(1, false, second)?;
                self.depth.resize(part)?;
                self.depth.bind();
                self.gl.clear(None);
            }
        }
        self.newest = Some((content, size));
        Ok(true)
    }

    /// Makes both eyes, with depth if the targets have a depth attachment. They are black before the first frame, and
    /// where the head has turned away from everything in the frame.
    ///
    /// # Errors
    /// [`GlError`] if the GPU has no memory for it.
    pub fn render(&mut self, pair: &EyePair, to: &[Destination; 2]) -> Result<(), GlError> {
        self.pair = Some(*pair);
        if let Some((content, _)) = self.newest {
            let from = content.source(pair.dominant).view.pose;
            let to = pair.poses[pair.dominant.index()];
            self.pairs += 1;
            self.corrected.metres += from.position.distance(to.position);
            self.corrected.radians += from.orientation.angle_between(to.orientation);
        }
        for eye in Eye::BOTH {
            let to = &to[eye.index()];
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            // The other eye may use the rest of the framebuffer.
            self.gl.clear_rectangle(to.origin, to.size, Some(pair.depth.clear_value()));
            let Some((content, size)) = self.newest else { continue };
            let Ok((part, warp)) = content.warp(size, eye, &pair.view(eye)) else { continue };
            let source = Source::new(self.colors[part].color(0).raw(), self.depth.color(0).raw());
            self.any_view.synthesize(source, &warp, to)?;
        }
        Ok(())
    }

    /// Returns the mean correction of the eyes that were made since the last call; `None` if there were none.
    pub fn take_correction(&mut self) -> Option<Correction> {
        let (pairs, sum) = (std::mem::take(&mut self.pairs) as f32, std::mem::take(&mut self.corrected));
        (pairs > 0.0).then(|| Correction { metres: sum.metres / pairs, radians: sum.radians / pairs })
    }

    /// Returns the request for the eyes that were made last; `None` before the first.
    pub fn request(&self, time_ms: f64) -> Option<ViewRequest> {
        let pair = self.pair?;
        let eye_view =
            |eye: Eye| EyeView { pose: pair.poses[eye.index()], frustum: pair.frusta[eye.index()] };
        let size = pair.size.map(|n| n.clamp(16, 4096) as u16);
        Some(ViewRequest { time_ms, eyes: Eye::BOTH.map(eye_view), dominant: pair.dominant, size })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{EyeOptions, Pose};
    use yoro_context::{Backend, Headless};

    #[test]
    fn eyes_that_share_a_framebuffer_are_as_those_with_one_each() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let side = 32;
        let pair = EyeOptions { size: [side; 2], ..EyeOptions::default() }.pair(Pose::IDENTITY);
        let eye_view =
            |eye: Eye| EyeView { pose: pair.poses[eye.index()], frustum: pair.frusta[eye.index()] };
        // The left eye is white, and the right one grey.
        let row = [[255u8; 32], [100; 32]].concat();
        let planes = [row.repeat(32), vec![128; 2 * 16 * 32]].concat();
        let mut eyes = StreamedEyes::new(gl).unwrap();
        let content = Content::Eyes(Eye::BOTH.map(eye_view));
        assert!(eyes.take(content, [32; 2], &DecodedPicture::Planes(&planes)).unwrap());

        let target = |width| {
            let colors = [(Format::Rgba8, Filter::Nearest)];
            RenderTarget::new(gl, [width, side], &colors, Some(Format::Depth24)).unwrap()
        };
        let (own, shared) = ([target(side), target(side)], target(2 * side));
        eyes.render(&pair, &[0, 1].map(|i| Destination::whole(&own[i]))).unwrap();
        let half = |i: usize| Destination {
            origin: [i as u32 * side, 0],
            size: [side; 2],
            ..Destination::whole(&shared)
        };
        eyes.render(&pair, &[0, 1].map(half)).unwrap();
        for (i, luma) in [255, 100].into_iter().enumerate() {
            let pixels = shared.read_rgba8(0, [i as u32 * side, 0], [side; 2]);
            assert_eq!(pixels, own[i].read_rgba8(0, [0, 0], [side; 2]));
            let middle = &pixels[(16 * 32 + 16) * 4..][..3];
            assert!(middle.iter().all(|value| value.abs_diff(luma) < 3), "{middle:?}");
        }
    }
}
