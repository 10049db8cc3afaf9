//! [`super::single_pass`] with the forward renderer: both eyes side by side, by instancing.

use std::rc::Rc;

use super::finish::Finish;
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{AntiAliasing, StereoOptions};
use super::single_pass::side_by_side;
use crate::render::{DepthImage, GpuScene, Layout, RenderSettings, Renderer, ViewTargets};
use yoro::eyes::{Eye, EyePair};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// One culling and one draw call per visible range of opaque triangles, for both eyes.
pub struct ForwardSinglePass {
    layout: Layout,
    targets: ViewTargets,
    /// An eye by itself, for anti-aliasing that looks beyond its border.
    alone: Option<RenderTarget>,
    finish: Finish,
}

impl ForwardSinglePass {
    /// Single-pass stereo by instancing, with clip distances where the driver has them.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a target or a program.
    pub fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<ForwardSinglePass, GlError> {
        let layout = side_by_side(gl);
        let formats = [(Format::Rgba8, Filter::Linear)];
        let alone = (settings.samples() == 1).then(|| RenderTarget::new(gl, [1, 1], &formats, None));
        Ok(ForwardSinglePass {
            layout,
            targets: ViewTargets::of_both_eyes(gl, layout, settings)?,
            alone: alone.transpose()?,
            finish: Finish::new(gl, settings, options.anti_aliasing != AntiAliasing::Off)?,
        })
    }
}

impl StereoMethod for ForwardSinglePass {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        Ok(renderer.prepare(scene, self.layout, &[])?)
    }

    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.prepare(renderer, scene)?;
        let views = Eye::BOTH.map(|eye| pair.view(eye));
        let wants_depth = to.iter().any(|eye| eye.depth.is_some());
        renderer.render_both(&mut self.targets, scene, &views, wants_depth)?;
        for eye in Eye::BOTH {
            let (view, to) = (&views[eye.index()], &to[eye.index()]);
            let (image, origin) = renderer.develop_eye(&self.targets, view, eye)?;
            match &mut self.alone {
                Some(alone) => {
                    alone.resize(view.size)?;
                    image.copy_color(origin, &Destination::whole(alone));
                    self.finish.color(alone, [0, 0], &to.color);
                }
                None => self.finish.color(image, origin, &to.color),
            }
            let origin = self.layout.origin(view.size, eye);
            Finish::depth(|| DepthImage { origin, ..DepthImage::whole(self.targets.depth()) }, to);
        }
        Ok(())
    }
}
