//! Settings of the renderer.

use yoro_gl::{Capabilities, Format, GlError};
use yoro_settings::DEPTH_BITS;
pub use yoro_settings::{MAX_POINT_LIGHTS, MSAA, RendererKind};

/// The depth format of samples in the forward renderer. Float for both conventions, since synthesized images, whose
/// depth is loaded, have float depth. With 16 bits, surfaces that lie close together would show through one another.
pub(super) const SAMPLE_DEPTH: Format = Format::Depth32F;

/// Settings of the renderer.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RenderSettings {
    /// The kind of renderer.
    pub renderer: RendererKind,
    /// Samples per pixel of the forward renderer: 1, 2 or 4, if the driver supports it. The deferred renderer has one.
    pub msaa: u32,
    /// Bits of each pixel's depth that the forward renderer resolves from the samples: 16 or 32. The samples have 32.
    pub depth_bits: u32,
    /// Edge length of the sun's shadow map in texels; 0 disables shadows.
    pub shadow_map_size: u32,
    /// Ambient occlusion; deferred renderer only.
    pub ssao: bool,
    /// Ambient occlusion at half the resolution: a quarter of the cost, softer at edges.
    pub ssao_half_size: bool,
    /// Radius of ambient occlusion in metres; at most a tenth of the scene's diagonal is used.
    pub ssao_radius: f32,
    /// Glow around areas brighter than white.
    pub bloom: bool,
    /// Maximum number of point lights in one view, at most [`MAX_POINT_LIGHTS`].
    pub point_lights: usize,
    /// Factor on scene-referred colour before the tone curve.
    pub exposure: f32,
}

impl Default for RenderSettings {
    fn default() -> RenderSettings {
        RenderSettings {
            renderer: RendererKind::default(),
            msaa: 4,
            depth_bits: 32,
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

    /// Checks that the driver supports the number of samples.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with the numbers that the driver supports.
    pub fn supported(&self, capabilities: &Capabilities) -> Result<(), GlError> {
        let samples = self.samples();
        if !MSAA.contains(&samples) {
            return Err(GlError::Unsupported(format!(
                "there are no {samples} samples a pixel: choose 1, 2 or 4"
            )));
        }
        if !DEPTH_BITS.contains(&self.depth_bits) {
            let bits = self.depth_bits;
            return Err(GlError::Unsupported(format!("there is no depth of {bits} bits: choose 16 or 32")));
        }
        capabilities.check_samples(samples)
    }

    /// Returns the format of the resolved depth in the forward renderer, where shaders can read the samples
    /// (`readable`) or cannot. Drivers copy depth between equal formats only.
    pub(super) fn depth_format(&self, readable: bool) -> Format {
        let is_coarse = self.depth_bits == 16 && self.samples() > 1 && readable;
        if is_coarse { Format::Depth16 } else { SAMPLE_DEPTH }
    }

    /// Returns the pixels per texel of ambient occlusion, along each axis.
    pub(super) fn ssao_scale(&self) -> u32 {
        if self.ssao_half_size { 2 } else { 1 }
    }
}
