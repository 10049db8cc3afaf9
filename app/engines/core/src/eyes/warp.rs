//! The displacement of pixels from one eye to the other.

use super::{DepthConvention, Eye, EyesError};

/// The displacement of a pixel as an affine function of the value in the depth buffer, in pixels:
/// `x_target = x_source + offset + scale * depth`. This is the paper's Eq. 5 for parallel eyes. It holds for pixel
/// indices and for pixel centres alike.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DisparityMap {
    /// Pixels at depth 0.
    pub offset: f64,
    /// Pixels per unit of depth.
    pub scale: f64,
}

impl DisparityMap {
    /// Returns the displacement in pixels of a stored depth value.
    pub fn displacement(&self, depth: f64) -> f64 {
        self.offset + self.scale * depth
    }
}

/// What synthesis needs to know about the eyes: sizes, displacement, and the direction of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warp {
    /// Size of the rendered colour and depth in pixels.
    pub source_size: [u32; 2],
    /// Size of the synthesized image in pixels.
    pub target_size: [u32; 2],
    /// Displacement along x.
    pub law: DisparityMap,
    /// `y_target = y_source + row_offset`, rows counted from the bottom.
    pub row_offset: i32,
    /// The eye that is synthesized: nearer pixels move to the right for the left eye, to the left for the right.
    pub target_eye: Eye,
    /// Direction of the stored depth: standard if smaller values are nearer.
    pub convention: DepthConvention,
}

/// The largest displacement in pixels that the shaders' 32-bit floats hold to a sixteenth of a pixel.
const MAX_OFFSET: f64 = (1 << 20) as f64;

impl Warp {
    /// The largest displacement in pixels, beyond that of the far plane, that the shaders can store: 16 bits in units
    /// of 1/16 pixel (`include/tiles.glsl` of `yoro-shaders`). It limits only wider images, since a surface that moves
    /// across the whole image is not visible.
    pub const MAX_DISPLACEMENT: f64 = 4095.0;

    /// Returns the displacements of the far plane and of the near plane in pixels, in forward columns, which increase
    /// in the direction in which nearer surfaces move.
    pub(crate) fn forward_displacements(&self) -> [f64; 2] {
        let [near, far] = self.convention.planes().map(f64::from);
        [far, near].map(|depth| {
            let displacement = self.law.displacement(depth);
            match self.target_eye {
                Eye::Left => displacement,
                Eye::Right => f64::from(self.target_size[0]) - f64::from(self.source_size[0]) - displacement,
            }
        })
    }

    /// Returns the warp for images with row 0 at the top. `vulkan::Pipeline::record` and `yoro-wgpu` convert it
    /// themselves.
    pub fn rows_from_top(&self) -> Warp {
        let [source, target] = [self.source_size[1], self.target_size[1]].map(|rows| rows as i32);
        Warp { row_offset: (target - source).saturating_sub(self.row_offset), ..*self }
    }

    /// Checks that the shaders can store all displacements that land in the target.
    /// [`EyePair::synthesis_views`](super::EyePair::synthesis_views) has already checked its own.
    ///
    /// # Errors
    /// [`EyesError::Displacement`], also if a number is not finite.
    pub fn check(&self) -> Result<(), EyesError> {
        let [far, near] = self.forward_displacements();
        let landing = (near - far).min(f64::from(self.target_size[0]) - far);
        let fits = landing <= Warp::MAX_DISPLACEMENT && far.abs().max(near.abs()) <= MAX_OFFSET;
        if fits { Ok(()) } else { Err(EyesError::Displacement { pixels: near - far }) }
    }
}

/// Returns the paper's minimum object distance `D = IPD / 2 * cot(fov / 2)` in metres, for an angle in radians (section
/// "Impact of Object Distance"). For an IPD of 75 mm and 60 degrees it is 0.065 m, not the 0.129 m that the text
/// states: that value is [`full_overlap_distance`].
pub fn minimum_object_distance(ipd: f32, fov: f32) -> f32 {
    0.5 * ipd / (0.5 * fov).tan()
}

/// Returns `IPD * cot(fov / 2)` in metres, the distance at which the disparity is half the image's width. For an IPD of
/// 75 mm and 60 degrees it is 0.130 m, which the paper states as 0.129 m.
pub fn full_overlap_distance(ipd: f32, fov: f32) -> f32 {
    ipd / (0.5 * fov).tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minimum_distances_match_the_papers_formula_and_value() {
        let fov = 60f32.to_radians();
        assert!((minimum_object_distance(0.075, fov) - 0.065).abs() < 1e-3);
        assert!((full_overlap_distance(0.075, fov) - 0.129).abs() < 2e-3);
    }

    #[test]
    fn rows_from_the_top_lead_to_the_same_rows() {
        let warp = Warp {
            source_size: [8, 13],
            target_size: [8, 10],
            law: DisparityMap { offset: 0.0, scale: 1.0 },
            row_offset: -2,
            target_eye: Eye::Left,
            convention: DepthConvention::Standard,
        };
        let turned = warp.rows_from_top();
        for source_row in 0..13 {
            let target_row = source_row + warp.row_offset;
            let (source_from_top, target_from_top) = (12 - source_row, 9 - target_row);
            assert_eq!(source_from_top + turned.row_offset, target_from_top);
        }
        assert_eq!(turned.rows_from_top(), warp);
    }
}
