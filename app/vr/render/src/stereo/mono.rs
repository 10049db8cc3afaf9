//! The dominant eye's view shown to both eyes: the lower bound of cost and quality.

use super::finish::Finish;
use super::frame::{Frame, FrameMethod, Setup};
use super::method::StereoError;
use crate::render::{DepthImage, RendererOfKind, ViewImages, ViewRenderer};
use yoro::eyes::{Eye, EyePair, GuardBand, View};
use yoro_gl::GlError;

/// One render from the dominant eye's position, with the union of both frusta. Each eye shows its own part, which is
/// the same image if the frusta are the same.
pub struct Mono<R: ViewRenderer> {
    targets: R::Targets,
    finish: Finish,
}

impl<R: ViewRenderer> Mono<R> {
    /// Makes the targets.
    pub(super) fn new(setup: &Setup) -> Result<Mono<R>, GlError> {
        Ok(Mono { targets: R::targets(setup.gl, setup.settings)?, finish: Finish::new(setup)? })
    }
}

impl<R: RendererOfKind> FrameMethod for Mono<R> {
    type Renderer = R;

    fn render_frame(&mut self, frame: &Frame<R>) -> Result<(), StereoError> {
        let Frame { renderer, scene, pair, .. } = frame;
        let here = EyePair { poses: [pair.poses[pair.dominant.index()]; 2], ..**pair };
        let views = here.synthesis_views(GuardBand::None)?;
        let wants_depth = Eye::BOTH.iter().any(|eye| frame.wants_depth(*eye));
        renderer.render_all(&mut self.targets, scene, &views.source, wants_depth)?;
        let color = self.targets.color();
        let [dominant, other] = [pair.dominant, pair.dominant.other()].map(|eye| frame.to(eye));
        let (origin, other_origin) = (views.dominant_crop, origin_in(&views.source, &views.target));
        self.finish.color(color, origin, &dominant.color);
        if other_origin == origin {
            let gl = &renderer.common().gl;
            gl.pass("copy", || gl.copy(&dominant.color, &other.color));
        } else {
            self.finish.color(color, other_origin, &other.color);
        }
        if wants_depth {
            let depth = DepthImage::whole(self.targets.depth());
            Finish::depth(Some(DepthImage { origin, ..depth }), dominant);
            Finish::depth(Some(DepthImage { origin: other_origin, ..depth }), other);
        }
        Ok(())
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
