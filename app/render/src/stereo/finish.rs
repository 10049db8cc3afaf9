//! The last steps of an eye.

use std::rc::Rc;

use super::method::EyeTarget;
use crate::render::{DepthImage, Fxaa, GpuScene, RenderSettings, Renderer};
use yoro::eyes::View;
use yoro_gl::{Context, Destination, GlError, RenderTarget};

/// Transparent objects, then anti-aliasing or a plain copy of a part of an image into the
/// frame.
pub(super) struct Finish {
    gl: Rc<Context>,
    fxaa: Option<Fxaa>,
}

impl Finish {
    /// With anti-aliasing or without; images whose edges are smooth already, by several samples in each pixel, are always
    /// copied.
    pub(super) fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        anti_alias: bool,
    ) -> Result<Finish, GlError> {
        let fxaa = anti_alias && settings.samples() == 1;
        Ok(Finish { gl: gl.clone(), fxaa: fxaa.then(|| Fxaa::new(gl)).transpose()? })
    }

    /// Draws the transparent part of the scene over a rendered eye and fills `to` from it.
    pub(super) fn eye(
        &self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        view: &View,
        color: &RenderTarget,
        depth: DepthImage,
        to: &EyeTarget,
    ) -> Result<(), GlError> {
        if scene.has_transparent() {
            renderer.draw_transparent(&Destination::whole(color), depth, scene, view)?;
        }
        self.color(color, [0, 0], &to.color);
        Finish::depth(|| depth, to);
        Ok(())
    }

    /// Fills `to` from the part of `from` whose lower left corner is `crop`.
    pub(super) fn color(&self, from: &RenderTarget, crop: [u32; 2], to: &Destination) {
        match &self.fxaa {
            Some(fxaa) => fxaa.run(from.color(0), crop, to),
            None => self.gl.pass("copy", || from.copy_color(crop, to)),
        }
    }

    /// Hands an eye's depth to whoever wants it; if nobody does, it is not looked for.
    pub(super) fn depth<'a>(from: impl FnOnce() -> DepthImage<'a>, to: &EyeTarget) {
        if let Some(depth) = &to.depth {
            depth.copy.run(from(), &depth.to);
        }
    }
}
