//! Both eyes rendered, one after the other: the ground truth.

use std::rc::Rc;

use super::finish::Finish;
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{AntiAliasing, StereoOptions};
use crate::render::{DepthImage, GpuScene, RenderSettings, Renderer, ViewTargets};
use yoro::eyes::{DepthConvention, Eye, EyePair};
use yoro_gl::{Context, GlError, Texture};

/// Two full renders.
pub struct Conventional {
    targets: ViewTargets,
    /// Whether [`Conventional::depth`] is wanted.
    keeps_depth: bool,
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
            keeps_depth: false,
            finish: Finish::new(gl, settings, options.anti_aliasing != AntiAliasing::Off)?,
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
        let keeps_depth = self.keeps_depth && eye == pair.dominant;
        renderer.render_all(&mut self.targets, scene, &view, keeps_depth || to.depth.is_some())?;
        self.finish.color(self.targets.color_target(), [0, 0], &to.color);
        Finish::depth(|| DepthImage::whole(self.targets.depth()), to);
        Ok(())
    }

    /// With [`Conventional::depth`] after each frame.
    pub(super) fn keeping_depth(self) -> Conventional {
        Conventional { keeps_depth: true, ..self }
    }

    /// The dominant eye's depth, which was rendered last.
    pub(super) fn depth(&self) -> &Texture {
        self.targets.depth()
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
