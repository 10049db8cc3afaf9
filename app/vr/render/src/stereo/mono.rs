//! The dominant eye's view shown to both eyes: the lower bound of cost and quality.

use super::frame::Frame;
use super::method::{StereoError, StereoMethod};
use crate::view::{GpuScene, Layout, Renderer, Targets};
use yoro::eyes::{Eye, EyePair, GuardBand, View};
use yoro_gl::Format;

/// One render from the dominant eye's position, with the union of both frusta. Each eye shows its own part, which is
/// the same image if the frusta are the same.
#[derive(Default)]
pub struct Mono {
    targets: Option<Targets>,
}

impl StereoMethod for Mono {
    fn prepare(&mut self, renderer: &mut Renderer, _: &GpuScene) -> Result<(), StereoError> {
        if self.targets.is_none() {
            self.targets = Some(renderer.targets(Layout::Single)?);
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<bool, StereoError> {
        let Some(targets) = &mut self.targets else { return Ok(false) };
        let pair = &frame.pair;
        let here = EyePair { poses: [pair.poses[pair.dominant.index()]; 2], ..*pair };
        let views = here.synthesis_views(GuardBand::None)?;
        let wants_depth = Eye::BOTH.iter().any(|eye| frame.wants_depth(*eye));
        let source = &views.source;
        let renderer = frame.renderer;
        renderer.draw_all(targets, &frame.scene, std::slice::from_ref(source), wants_depth, None)?;
        let [dominant, other] = [pair.dominant, pair.dominant.other()];
        let (origin, other_origin) = (views.dominant_crop, origin_in(source, &views.target));
        renderer.composite(targets, source, Eye::Left, origin, &frame.to(dominant).color, None);
        if other_origin == origin {
            let gl = &renderer.gl;
            let [from, to] = [dominant, other].map(|eye| frame.to(eye).color);
            let pass = gl.pass("copy").read("copied", from.image(Format::Rgba8));
            pass.write([to.image(Format::Rgba8)]).run(|| gl.copy(&from, &to));
        } else {
            renderer.composite(targets, source, Eye::Left, other_origin, &frame.to(other).color, None);
        }
        for (eye, origin) in [(dominant, origin), (other, other_origin)] {
            if frame.wants_depth(eye) {
                frame.write_depth(eye, &targets.depth(source.size, Eye::Left, origin));
            }
        }
        Ok(false)
    }
}

/// Returns the pixel of `whole` nearest to the lower left corner of `part`, a view from the same position.
fn origin_in(whole: &View, part: &View) -> [u32; 2] {
    let pixels = |tangents: f32, size: u32, extent: f32| (tangents / extent * size as f32).round() as u32;
    [
        pixels(part.frustum.left - whole.frustum.left, whole.size[0], whole.frustum.width()),
        pixels(part.frustum.bottom - whole.frustum.bottom, whole.size[1], whole.frustum.height()),
    ]
}
