//! Settings of the renderer.

use yoro_gl::{Capabilities, GlError};
pub use yoro_protocol::{MAX_POINT_LIGHTS, MSAA, RendererKind};
use yoro_protocol::{Settings, Ssao};

/// Settings of the renderer.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RenderSettings {
    /// The kind of renderer.
    pub renderer: RendererKind,
    /// Samples in each pixel of the forward renderer: 1, 2 or 4, if the driver has them. The deferred one has one.
    pub msaa: u32,
    /// Edge of the sun's shadow map in texels; 0 for no shadows.
    pub shadow_map_size: u32,
    /// Ambient occlusion; the forward renderer has none.
    pub ssao: bool,
    /// Ambient occlusion at half the resolution: a quarter of the cost, softer at edges.
    pub ssao_half_size: bool,
    /// Radius of ambient occlusion in metres; at most a tenth of the scene's diagonal is used.
    pub ssao_radius: f32,
    /// Glow around what is brighter than white.
    pub bloom: bool,
    /// Number of point lights that light one view, at most [`MAX_POINT_LIGHTS`].
    pub point_lights: usize,
    /// Factor on scene-referred colour before the tone curve.
    pub exposure: f32,
}

impl Default for RenderSettings {
    fn default() -> RenderSettings {
        RenderSettings {
            renderer: RendererKind::default(),
            msaa: 4,
            shadow_map_size: 4096,
            ssao: true,
            ssao_half_size: false,
            ssao_radius: 0.5,
            bloom: true,
            point_lights: MAX_POINT_LIGHTS,
            exposure: 1.0,
        }
    }
}

impl RenderSettings {
    /// The renderer that the viewer's settings ask for.
    pub fn of_settings(settings: &Settings) -> RenderSettings {
        RenderSettings {
            renderer: settings.renderer,
            msaa: settings.msaa,
            shadow_map_size: settings.shadow_map,
            ssao: settings.ssao != Ssao::Off,
            ssao_half_size: settings.ssao == Ssao::Half,
            bloom: settings.bloom,
            point_lights: settings.point_lights,
            ..RenderSettings::default()
        }
    }

    /// True for the forward renderer.
    pub fn is_forward(&self) -> bool {
        self.renderer == RendererKind::Forward
    }

    /// Returns the number of samples in each pixel of a rendered view.
    pub fn samples(&self) -> u32 {
        if self.is_forward() { self.msaa } else { 1 }
    }

    /// Describes the renderer in a few words: `forward, 4 samples a pixel`.
    pub fn summary(&self) -> String {
        match self.renderer {
            RendererKind::Deferred => self.renderer.name().into(),
            RendererKind::Forward => format!("{}, {} samples a pixel", self.renderer.name(), self.msaa),
        }
    }

    /// Checks that a driver has the number of samples.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with the numbers that the driver has.
    pub fn supported(&self, capabilities: &Capabilities) -> Result<(), GlError> {
        let samples = self.samples();
        if !MSAA.contains(&samples) {
            return Err(GlError::Unsupported(format!(
                "there are no {samples} samples a pixel: choose 1, 2 or 4"
            )));
        }
        capabilities.check_samples(samples)
    }

    /// Pixels per texel of ambient occlusion, along each axis.
    pub(super) fn ssao_scale(&self) -> u32 {
        if self.ssao_half_size { 2 } else { 1 }
    }
}
