//! How pixels move from one eye to the other.

use super::{DepthConvention, Eye, EyesError};

/// The affine form of the paper's Eq. 5 for parallel eyes: `x_target = x_source + offset + scale * depth`, in
/// pixels, for the value stored in the depth buffer. The same for pixel indices and for pixel centres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DisparityLaw {
    /// Pixels at depth 0.
    pub offset: f64,
    /// Pixels per unit of depth.
    pub scale: f64,
}

impl DisparityLaw {
    /// Displacement in pixels of a stored depth value.
    pub fn displacement(&self, depth: f64) -> f64 {
        self.offset + self.scale * depth
    }
}

/// All that synthesis has to know about the eyes: sizes, the law of displacement, and what "nearer" means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warp {
    /// Size of the rendered colour and depth in pixels.
    pub source_size: [u32; 2],
    /// Size of the synthesized image in pixels.
    pub target_size: [u32; 2],
    /// Displacement along x.
    pub law: DisparityLaw,
    /// `y_target = y_source + row_offset`, rows counted from the bottom.
    pub row_offset: i32,
    /// The eye that is synthesized: nearer pixels move to the right for the left eye, to the left for the right.
    pub target_eye: Eye,
    /// Whether smaller or larger depth is nearer.
    pub convention: DepthConvention,
}

/// Beyond so many pixels positions in the shaders, 32-bit floats, are rounded by more than a sixteenth of a pixel.
const MAX_OFFSET: f64 = (1 << 20) as f64;

impl Warp {
    /// The largest displacement in pixels, beyond that of the far plane, that the shaders can tell: 16 bits of a
    /// sixteenth of a pixel (`include/tiles.glsl` of `yoro-shaders`). It matters only where images are wider: what moves
    /// across the whole image is seen nowhere.
    pub const MAX_DISPLACEMENT: f64 = 4095.0;

    /// Returns the displacements of the far plane and of the near plane in pixels, in forward columns: the direction in
    /// which nearer surfaces lie further along.
    pub(crate) fn forward_displacements(&self) -> [f64; 2] {
        let (near, far) = match self.convention {
            DepthConvention::Standard => (0.0, 1.0),
            DepthConvention::Reversed => (1.0, 0.0),
        };
        [far, near].map(|depth| {
            let displacement = self.law.displacement(depth);
            match self.target_eye {
                Eye::Left => displacement,
                Eye::Right => f64::from(self.target_size[0]) - f64::from(self.source_size[0]) - displacement,
            }
        })
    }

    /// Checks that the shaders can tell all displacements that land in the target.
    pub(super) fn check_displacement(&self) -> Result<(), EyesError> {
        let [far, near] = self.forward_displacements();
        let landing = (near - far).min(f64::from(self.target_size[0]) - far);
        let tellable = landing <= Warp::MAX_DISPLACEMENT;
        let exact = far.abs().max(near.abs()) <= MAX_OFFSET;
        if tellable && exact { Ok(()) } else { Err(EyesError::Displacement { pixels: near - far }) }
    }
}

/// The paper's minimum object distance `D = IPD / 2 * cot(fov / 2)` in metres (section "Impact of Object
/// Distance"), fov in radians. With IPD 75 mm and 60 degrees it gives 0.065 m, not the 0.129 m that the text
/// states; that value is [`full_overlap_distance`].
pub fn minimum_object_distance(ipd: f32, fov: f32) -> f32 {
    0.5 * ipd / (0.5 * fov).tan()
}

/// `IPD * cot(fov / 2)` in metres: 0.130 m for IPD 75 mm and 60 degrees, the paper's stated 0.129 m. At this
/// distance the disparity is half the image's width.
pub fn full_overlap_distance(ipd: f32, fov: f32) -> f32 {
    ipd / (0.5 * fov).tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minimum_distances_are_the_papers_two_readings() {
        let fov = 60f32.to_radians();
        assert!((minimum_object_distance(0.075, fov) - 0.065).abs() < 1e-3);
        assert!((full_overlap_distance(0.075, fov) - 0.129).abs() < 2e-3);
    }
}
