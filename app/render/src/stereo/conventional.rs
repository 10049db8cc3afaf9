//! Both eyes rendered, one after the other: the ground truth.

use super::finish::{EyeImage, Finish};
use super::frame::{Frame, FrameMethod, Setup};
use super::method::StereoError;
use crate::render::{RendererOfKind, ViewImages, ViewRenderer};
use yoro_gl::{GlError, Texture};

/// Two full renders.
pub struct Conventional<R: ViewRenderer> {
    targets: R::Targets,
    /// True if [`Conventional::depth`] is wanted.
    keeps_depth: bool,
    finish: Finish,
}

impl<R: ViewRenderer> Conventional<R> {
    /// Makes the targets.
    pub(super) fn new(setup: &Setup) -> Result<Conventional<R>, GlError> {
        let (targets, finish) = (R::targets(setup.gl, setup.settings)?, Finish::new(setup)?);
        Ok(Conventional { targets, keeps_depth: false, finish })
    }

    /// Keeps depth, for [`Conventional::depth`] after each frame.
    pub(super) fn keeping_depth(self) -> Conventional<R> {
        Conventional { keeps_depth: true, ..self }
    }

    /// The dominant eye's depth, which was rendered last.
    pub(super) fn depth(&self) -> &Texture {
        self.targets.depth()
    }
}

impl<R: RendererOfKind> FrameMethod for Conventional<R> {
    type Renderer = R;

    fn render_frame(&mut self, frame: &Frame<R>) -> Result<(), StereoError> {
        let dominant = frame.pair.dominant;
        // The dominant eye comes last, so that its depth stays in the targets.
        for eye in [dominant.other(), dominant] {
            let depth = frame.wants_depth(eye) || (self.keeps_depth && eye == dominant);
            frame.renderer.render_all(&mut self.targets, frame.scene, &frame.pair.view(eye), depth)?;
            self.finish.run(&EyeImage::whole(&self.targets, depth), frame.to(eye));
        }
        Ok(())
    }
}
