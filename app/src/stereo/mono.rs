//! The dominant eye's image shown to both eyes: what doing nothing costs and looks like.

use std::rc::Rc;

use super::{Conventional, EyeTarget, Finish, StereoError, StereoMethod, StereoOptions};
use crate::eyes::EyePair;
use crate::gl::{Context, GlError};
use crate::render::{DepthImage, GpuScene, RenderSettings, Renderer};

/// One render, one copy.
pub struct Mono {
    gl: Rc<Context>,
    eye: Conventional,
}

impl Mono {
    /// Makes the targets.
    ///
    /// # Errors
    /// As [`Conventional::new`].
    pub fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<Mono, GlError> {
        Ok(Mono { gl: gl.clone(), eye: Conventional::new(gl, settings, options)? })
    }
}

impl StereoMethod for Mono {
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let [from, to] = [pair.dominant, pair.dominant.other()].map(|eye| &to[eye.index()]);
        self.eye.render_eye(renderer, scene, pair, pair.dominant, from)?;
        self.gl.pass("copy", || self.gl.copy(&from.color, &to.color));
        Finish::depth(DepthImage::whole(self.eye.targets().depth()), to);
        Ok(())
    }
}
