//! What the renderer does and how well.

/// The most point lights that light one view.
pub const MAX_POINT_LIGHTS: usize = 24;

/// What the renderer does and how well.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RenderSettings {
    /// Edge of the sun's shadow map in texels; 0 for no shadows.
    pub shadow_map_size: u32,
    /// Ambient occlusion.
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
    /// How many pixels share a texel of ambient occlusion, along each axis.
    pub(super) fn ssao_scale(&self) -> u32 {
        if self.ssao_half_size { 2 } else { 1 }
    }
}
