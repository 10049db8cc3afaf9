//! Both eyes rendered, one after the other: the ground truth.

use std::rc::Rc;

use super::finish::Finish;
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{AntiAliasing, StereoOptions};
use crate::render::{DepthImage, GpuScene, RenderSettings, Renderer, Selection, ViewTargets};
use yoro::eyes::{DepthConvention, Eye, EyePair};
use yoro::gl::{Context, GlError};

/// Two full renders.
pub struct Conventional {
    targets: ViewTargets,
    finish: Finish,
}

impl Conventional {
    /// Makes the targets.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a target or a program.
    pub fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<Conventional, GlError> {
        Ok(Conventional {
            targets: ViewTargets::new(gl, [1, 1], DepthConvention::Standard, settings)?,
            finish: Finish::new(gl, options.anti_aliasing != AntiAliasing::Off)?,
        })
    }

    /// Renders one eye to where it is wanted.
    fn render_eye(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        eye: Eye,
        to: &EyeTarget,
    ) -> Result<(), StereoError> {
        let view = pair.view(eye);
        renderer.render(&mut self.targets, scene, &view, Selection::All)?;
        let (color, depth) = (self.targets.color_target(), DepthImage::whole(self.targets.depth()));
        Ok(self.finish.eye(renderer, scene, &view, color, depth, to)?)
    }

    /// The targets that hold the eye that was rendered last.
    pub(super) fn targets(&self) -> &ViewTargets {
        &self.targets
    }
}

impl StereoMethod for Conventional {
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        // The dominant eye last, so that its depth is at hand.
        for eye in [pair.dominant.other(), pair.dominant] {
            self.render_eye(renderer, scene, pair, eye, &to[eye.index()])?;
        }
        Ok(())
    }
}
