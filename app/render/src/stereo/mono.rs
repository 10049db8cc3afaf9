//! The dominant eye's view shown to both eyes: what doing nothing costs and looks like.

use std::rc::Rc;

use super::finish::Finish;
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{AntiAliasing, StereoOptions};
use crate::render::{DepthImage, GpuScene, RenderSettings, Renderer, ViewTargets};
use yoro::eyes::{DepthConvention, EyePair, GuardBand, View};
use yoro_gl::{Context, GlError};

/// One render from where the dominant eye is, in the union of both frusta; each eye gets its own part of it, which is
/// the same image where the frusta are the same.
pub struct Mono {
    gl: Rc<Context>,
    targets: ViewTargets,
    finish: Finish,
}

impl Mono {
    /// Makes the targets.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a target or a program.
    pub fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<Mono, GlError> {
        Ok(Mono {
            gl: gl.clone(),
            targets: ViewTargets::new(gl, [1, 1], DepthConvention::Standard, settings)?,
            finish: Finish::new(gl, settings, options.anti_aliasing != AntiAliasing::Off)?,
        })
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
        let here = EyePair { poses: [pair.poses[pair.dominant.index()]; 2], ..*pair };
        let views = here.synthesis(GuardBand::None)?;
        let wants_depth = to.iter().any(|eye| eye.depth.is_some());
        renderer.render_all(&mut self.targets, scene, &views.source, wants_depth)?;
        let color = self.targets.color_target();
        let depth = |origin| DepthImage { origin, ..DepthImage::whole(self.targets.depth()) };
        let [dominant, other] = [pair.dominant, pair.dominant.other()].map(|eye| &to[eye.index()]);
        let (crop, other_crop) = (views.dominant_crop, origin_in(&views.source, &views.target));
        self.finish.color(color, crop, &dominant.color);
        if other_crop == crop {
            self.gl.pass("copy", || self.gl.copy(&dominant.color, &other.color));
        } else {
            self.finish.color(color, other_crop, &other.color);
        }
        Finish::depth(|| depth(crop), dominant);
        Finish::depth(|| depth(other_crop), other);
        Ok(())
    }
}

/// The pixel of `whole` that is nearest to the lower left corner of `part`, a view from the same place.
fn origin_in(whole: &View, part: &View) -> [u32; 2] {
    let pixels = |tangents: f32, size: u32, extent: f32| (tangents / extent * size as f32).round() as u32;
    [
        pixels(part.frustum.left - whole.frustum.left, whole.size[0], whole.frustum.width()),
        pixels(part.frustum.bottom - whole.frustum.bottom, whole.size[1], whole.frustum.height()),
    ]
}
