//! Both eyes in one set of draw calls: instancing into a double-wide g-buffer, or GL_OVR_multiview2 into a layered
//! one. What comes after the g-buffer runs for each eye.

use std::rc::Rc;

use super::finish::Finish;
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{AntiAliasing, Method, StereoOptions};
use crate::render::{
    DepthImage, FinishTargets, GBuffer, GpuScene, Layout, LightTargets, RenderSettings, Renderer, Role, Seam,
};
use yoro::eyes::{DepthConvention, Eye, EyePair};
use yoro_gl::{Context, GlError};

/// One culling and one draw call per visible range of triangles, for both eyes.
///
/// Against two renders it saves the CPU half of its draw calls and, with multiview where the hardware shares it, some
/// vertex work; every pixel is still rasterized and shaded for each eye.
pub struct SinglePass {
    layout: Layout,
    g_buffer: GBuffer,
    /// Of the eye that is being lit.
    light: LightTargets,
    image: FinishTargets,
    finish: Finish,
}

/// Both eyes side by side, as the driver keeps them apart best.
pub(super) fn side_by_side(gl: &Context) -> Layout {
    Layout::DoubleWide(if gl.capabilities().clip_distances { Seam::ClipDistance } else { Seam::Discard })
}

impl SinglePass {
    /// Single-pass stereo by instancing, with clip distances where the driver has them.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a target or a program.
    pub fn instanced(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<SinglePass, GlError> {
        SinglePass::new(gl, side_by_side(gl), settings, options)
    }

    /// Single-pass stereo by multiview.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] without GL_OVR_multiview2; [`GlError`] when the driver refuses a target or a program.
    pub fn multiview(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<SinglePass, GlError> {
        settings.supports(Method::Multiview, gl.capabilities())?;
        SinglePass::new(gl, Layout::Layered, settings, options)
    }

    pub(super) fn new(
        gl: &Rc<Context>,
        layout: Layout,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<SinglePass, GlError> {
        Ok(SinglePass {
            layout,
            g_buffer: GBuffer::new(gl, layout, [1, 1], DepthConvention::Standard)?,
            light: LightTargets::new(gl, [1, 1], settings)?,
            image: FinishTargets::new(gl, [1, 1], settings)?,
            finish: Finish::new(gl, settings, options.anti_aliasing != AntiAliasing::Off)?,
        })
    }
}

impl StereoMethod for SinglePass {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        let role = Role::of_eye(self.layout, [1, 1], Eye::Left).kind();
        Ok(renderer.prepare(scene, self.layout, &[role])?)
    }

    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.prepare(renderer, scene)?;
        self.g_buffer.fit(pair.size, pair.depth.convention)?;
        self.light.resize(pair.size)?;
        self.image.resize(pair.size)?;
        let views = Eye::BOTH.map(|eye| pair.view(eye));
        renderer.draw(&self.g_buffer, scene, &views, Some([pair.depth.near, pair.depth.far]), |_| {});
        for eye in Eye::BOTH {
            let view = &views[eye.index()];
            let role = Role::of_eye(self.layout, pair.size, eye);
            renderer.light(&self.light, &self.g_buffer, scene, view, role);
            renderer.finish(&self.image, &self.light);
            let depth = DepthImage {
                texture: self.g_buffer.target().depth(),
                origin: self.layout.origin(pair.size, eye),
                layer: (self.layout == Layout::Layered).then_some(eye.index() as u32),
            };
            self.finish.eye(renderer, scene, view, self.image.color(), depth, &to[eye.index()])?;
        }
        Ok(())
    }
}
