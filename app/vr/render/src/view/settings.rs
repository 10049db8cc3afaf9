//! Settings of the renderer.

use yoro_gl::{Capabilities, Format, GlError};
pub use yoro_settings::{MAX_POINT_LIGHTS, MSAA};

/// The depth format of samples: float, since synthesized depth, which is drawn over, is float. With 16 bits, surfaces
/// that lie close together would show through one another.
pub(super) const SAMPLE_DEPTH: Format = Format::Depth32F;

/// Settings of the renderer.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RenderSettings {
    /// Samples per pixel: 1, 2 or 4, if the driver supports it.
    pub msaa: u32,
    /// Edge length of the sun's shadow map in texels; 0 disables shadows.
    pub shadow_map_size: u32,
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
            msaa: 4,
            shadow_map_size: 4096,
            bloom: true,
            point_lights: MAX_POINT_LIGHTS,
            exposure: 1.0,
        }
    }
}

impl RenderSettings {
    /// Checks that the driver supports the number of samples.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with the numbers that the driver supports.
    pub fn supported(&self, capabilities: &Capabilities) -> Result<(), GlError> {
        if !MSAA.contains(&self.msaa) {
            let samples = self.msaa;
            return Err(GlError::Unsupported(format!(
                "there are no {samples} samples a pixel: choose 1, 2 or 4"
            )));
        }
        capabilities.check_samples(self.msaa)
    }
}
