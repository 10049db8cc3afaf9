//! How the other eye of a camera is produced.

use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass, NormalPrepass};
use bevy::ecs::query::QueryData;
use bevy::pbr::{AtmosphereSettings, ScreenSpaceReflections};
use bevy::post_process::auto_exposure::AutoExposure;
use bevy::post_process::bloom::Bloom;
use bevy::post_process::effect_stack::{ChromaticAberration, LensDistortion, Vignette};
use bevy::post_process::motion_blur::MotionBlur;
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;

/// How the other eye is produced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
pub enum StereoMode {
    /// Opaque surfaces and the sky are synthesized. Transparent objects, bloom, tone mapping, FXAA and SMAA are drawn
    /// for each eye. With MSAA, the synthesis takes the resolved colour and each pixel's nearest depth. Both eyes are
    /// rendered with temporal anti-aliasing.
    #[default]
    Opaque,
    /// The finished image is synthesized. This is the cheapest mode, and works with temporal anti-aliasing. Transparent
    /// objects move with what is behind them, and highlights with their surface.
    Finished,
    /// Both eyes are rendered.
    Rendered,
    /// `Opaque` or `Rendered`, whichever is cheaper here: [`AutoChoice`](crate::AutoChoice) measures both in turns for
    /// about a second, and again when that may have changed. It compares the GPU's times for a frame, or the times
    /// between frames on devices without timestamps. With foveation both ways have the same levels.
    Auto,
}

/// What becomes of what near objects hide from the rendered eye, in [`StereoMode::Opaque`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
pub enum Holes {
    /// It is filled with what lies around it.
    #[default]
    Filled,
    /// The other eye's camera renders it: opaque objects and the sky box are drawn a second time, where nothing was
    /// synthesized, with the materials as they are. They must test depth. Of foveated eyes this is the inset's. Holes are
    /// filled, and one line in the log says so, with MSAA, prepasses (`ScreenSpaceAmbientOcclusion` has two), and on devices
    /// without `DEPTH32FLOAT_STENCIL8`.
    Rendered,
}

/// What is actually done: the mode, as far as the camera's other components allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plan {
    Opaque,
    Finished,
    Rendered,
}

impl Plan {
    /// True if the other eye has a camera of its own.
    pub(crate) fn has_other_camera(self) -> bool {
        self != Plan::Finished
    }
}

/// The components of a camera that determine its plan.
#[derive(QueryData)]
pub(crate) struct Rendering {
    msaa: &'static Msaa,
    jitter: Has<TemporalJitter>,
    prepasses: (Has<DepthPrepass>, Has<NormalPrepass>),
    whole: WholeImage,
}

/// The effects that cannot be made of an image's parts.
#[derive(QueryData)]
struct WholeImage {
    atmosphere: Has<AtmosphereSettings>,
    auto_exposure: Has<AutoExposure>,
    bloom: Has<Bloom>,
    chromatic_aberration: Has<ChromaticAberration>,
    deferred: Has<DeferredPrepass>,
    lens_distortion: Has<LensDistortion>,
    motion_blur: Has<MotionBlur>,
    reflections: Has<ScreenSpaceReflections>,
    vignette: Has<Vignette>,
}

impl RenderingItem<'_, '_> {
    /// Returns the plan for a mode.
    ///
    /// # Errors
    /// The reason why the mode is impossible. Both eyes must then be rendered.
    pub(crate) fn plan(&self, mode: StereoMode) -> Result<Plan, &'static str> {
        match mode {
            StereoMode::Rendered => Ok(Plan::Rendered),
            StereoMode::Opaque | StereoMode::Auto if self.jitter => {
                Err("a synthesized eye has no history for temporal anti-aliasing; use StereoMode::Finished")
            }
            StereoMode::Opaque | StereoMode::Auto => Ok(Plan::Opaque),
            StereoMode::Finished => Ok(Plan::Finished),
        }
    }

    pub(crate) fn msaa(&self) -> Msaa {
        *self.msaa
    }

    /// Returns the reason why holes cannot be rendered.
    pub(crate) fn filled_holes(&self) -> Option<&'static str> {
        match self.prepasses {
            _ if *self.msaa != Msaa::Off => Some("their pixels would have one sample; use Msaa::Off"),
            (false, false) => None,
            _ => Some("a prepass would draw whole objects once more"),
        }
    }

    /// Returns the name of a component that prevents foveation.
    pub(crate) fn whole_image_effect(&self) -> Option<&'static str> {
        let whole = &self.whole;
        let effects = [
            (whole.atmosphere, "AtmosphereSettings"),
            (whole.auto_exposure, "AutoExposure"),
            (whole.bloom, "Bloom"),
            (whole.chromatic_aberration, "ChromaticAberration"),
            (whole.reflections, "ScreenSpaceReflections"),
            (whole.deferred, "DeferredPrepass"),
            (whole.lens_distortion, "LensDistortion"),
            (whole.motion_blur, "MotionBlur"),
            (whole.vignette, "Vignette"),
        ];
        effects.into_iter().find_map(|(present, name)| present.then_some(name))
    }
}
