//! How the other eye of a camera is produced.

use bevy::anti_alias::{fxaa::Fxaa, smaa::Smaa};
use bevy::camera::Hdr;
use bevy::ecs::query::QueryData;
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use yoro_wgpu::yoro::synthesis::Edges;

/// How the other eye is produced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
pub enum StereoMode {
    /// Opaque surfaces and the sky are synthesized. Transparent objects, bloom, tone mapping, FXAA and SMAA are drawn
    /// for each eye. With 4 or 2 MSAA samples the synthesis uses the depth of each sample. Both eyes are rendered with
    /// temporal anti-aliasing, and with `Hdr` and MSAA together.
    #[default]
    Opaque,
    /// The finished image is synthesized. This is the cheapest mode, and works with temporal anti-aliasing. Transparent
    /// objects move with what is behind them, and highlights with their surface.
    Finished,
    /// Both eyes are rendered, for comparison.
    Rendered,
}

/// What is actually done: the mode, as far as the camera's other components allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plan {
    Opaque(Edges),
    Finished(Edges),
    Rendered,
}

impl Plan {
    /// True if the other eye has a camera of its own.
    pub(crate) fn has_other_camera(self) -> bool {
        !matches!(self, Plan::Finished(_))
    }
}

/// The components of a camera that determine its plan.
#[derive(QueryData)]
pub(crate) struct Rendering {
    msaa: &'static Msaa,
    hdr: Has<Hdr>,
    jitter: Has<TemporalJitter>,
    fxaa: Has<Fxaa>,
    smaa: Has<Smaa>,
}

impl RenderingItem<'_, '_> {
    /// Returns the plan for a mode.
    ///
    /// # Errors
    /// The reason why the mode is impossible. Both eyes must then be rendered.
    pub(crate) fn plan(&self, mode: StereoMode) -> Result<Plan, &'static str> {
        let samples = self.msaa.samples();
        let edges = match samples {
            // Anti-aliasing smooths the colour at edges, but not the depth.
            1 if mode == StereoMode::Finished && (self.jitter | self.fxaa | self.smaa) => Edges::Sample,
            1 => Edges::Hard,
            _ => Edges::Multisample,
        };
        match mode {
            StereoMode::Rendered => Ok(Plan::Rendered),
            _ if samples > 4 => Err("8 samples cannot be synthesized; use Msaa::Sample4"),
            StereoMode::Opaque if self.jitter => {
                Err("a synthesized eye has no history for temporal anti-aliasing; use StereoMode::Finished")
            }
            StereoMode::Opaque if samples > 1 && self.hdr => {
                Err("samples with Hdr need StereoMode::Finished, or use Msaa::Off")
            }
            StereoMode::Opaque => Ok(Plan::Opaque(edges)),
            StereoMode::Finished => Ok(Plan::Finished(edges)),
        }
    }

    pub(crate) fn msaa(&self) -> Msaa {
        *self.msaa
    }

    /// Returns the number of samples in each pixel.
    pub(crate) fn samples(&self) -> u32 {
        self.msaa.samples()
    }
}
