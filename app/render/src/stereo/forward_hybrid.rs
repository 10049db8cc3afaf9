//! [`super::hybrid`] with the forward renderer.

use std::rc::Rc;

use super::finish::Finish;
use super::hybrid::{Split, crops, far_view};
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{AntiAliasing, StereoOptions};
use crate::render::{DepthImage, GpuScene, RenderSettings, Renderer, ViewTargets};
use yoro::eyes::{DepthConvention, Eye, EyePair};
use yoro_gl::{Context, GlError};

/// Two renders of what is near, one of what is far.
///
/// Each eye begins with its part of the far field, colour and depth; its near field is drawn over that, sample by sample,
/// so that its edges are as smooth as any.
pub struct ForwardHybrid {
    threshold: f32,
    eye: ViewTargets,
    far: ViewTargets,
    finish: Finish,
}

impl ForwardHybrid {
    /// Makes the targets.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a target or a program.
    pub fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<ForwardHybrid, GlError> {
        let targets = || ViewTargets::new(gl, [1, 1], DepthConvention::Standard, settings);
        Ok(ForwardHybrid {
            threshold: options.split_disparity,
            eye: targets()?,
            far: targets()?,
            finish: Finish::new(gl, settings, options.anti_aliasing != AntiAliasing::Off)?,
        })
    }
}

impl StereoMethod for ForwardHybrid {
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let far_view = far_view(pair)?;
        let crops = crops(pair, &far_view).map(|crop| crop.as_uvec2().to_array());
        let split = Split::of_scene(pair, self.threshold, renderer, scene, &far_view);
        if let Some(slice) = split.far {
            renderer.render_far(&mut self.far, scene, &far_view, slice)?;
        }
        for eye in Eye::BOTH {
            let (view, to) = (pair.view(eye), &to[eye.index()]);
            let wants_depth = to.depth.is_some();
            match split.far {
                Some(_) => {
                    let far = (&self.far, crops[eye.index()]);
                    renderer.render_near(&mut self.eye, scene, &view, split.near, far, wants_depth)?;
                }
                None => renderer.render_all(&mut self.eye, scene, &view, wants_depth)?,
            }
            self.finish.color(self.eye.color_target(), [0, 0], &to.color);
            Finish::depth(|| DepthImage::whole(self.eye.depth()), to);
        }
        Ok(())
    }
}
