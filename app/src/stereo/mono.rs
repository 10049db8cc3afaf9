//! The dominant eye's image shown to both eyes: what doing nothing costs and looks like.

use std::rc::Rc;

use super::{Conventional, StereoError, StereoFrame, StereoMethod, StereoOptions};
use crate::eyes::EyePair;
use crate::gl::{Context, Destination, GlError};
use crate::render::{GpuScene, RenderSettings, Renderer};

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
    fn render(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<(), StereoError> {
        frame.resize(pair.size)?;
        self.eye.render_eye(renderer, scene, pair, pair.dominant, frame)?;
        let (from, to) = (frame.eye(pair.dominant), frame.eye(pair.dominant.other()));
        self.gl.pass("copy", || from.copy_color([0, 0], &Destination::whole(to)));
        Ok(())
    }
}
