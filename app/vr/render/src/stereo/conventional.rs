//! The ground truth: renders both eyes, one after the other.

use super::finish::{EyeImage, Finish};
use super::frame::{Frame, FrameMethod, Setup};
use super::method::StereoError;
use crate::render::{RendererOfKind, ViewRenderer};
use yoro::eyes::Eye;
use yoro_gl::GlError;

/// Two full renders.
pub struct Conventional<R: ViewRenderer> {
    targets: R::Targets,
    finish: Finish,
}

impl<R: RendererOfKind> Conventional<R> {
    /// Makes the targets.
    pub(super) fn new(setup: &Setup) -> Result<Conventional<R>, GlError> {
        Ok(Conventional { targets: R::targets(setup.gl, setup.settings)?, finish: Finish::new(setup)? })
    }

    /// Renders both eyes, the dominant one last. Calls `rendered` after each with its images, which have depth if
    /// `reads_depth` returns true.
    pub(super) fn render_eyes(
        &mut self,
        frame: &Frame<R>,
        reads_depth: impl Fn(Eye) -> bool,
        mut rendered: impl FnMut(Eye, &R::Targets),
    ) -> Result<(), GlError> {
        let dominant = frame.pair.dominant;
        for eye in [dominant.other(), dominant] {
            let depth = frame.wants_depth(eye) || reads_depth(eye);
            frame.renderer.render_all(&mut self.targets, frame.scene, &frame.pair.view(eye), depth)?;
            self.finish.run(&EyeImage::whole(&self.targets, depth), frame.to(eye));
            rendered(eye, &self.targets);
        }
        Ok(())
    }
}

impl<R: RendererOfKind> FrameMethod for Conventional<R> {
    type Renderer = R;

    fn render_frame(&mut self, frame: &Frame<R>) -> Result<(), StereoError> {
        Ok(self.render_eyes(frame, |_| false, |_, _| ())?)
    }
}
