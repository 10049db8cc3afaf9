//! The meaning of the values in a depth buffer.

/// The direction of the values in a depth buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum DepthConvention {
    /// 0 at the near plane, 1 at the far plane; tested with LESS.
    Standard,
    /// 1 at the near plane, 0 at the far plane; tested with GREATER.
    Reversed,
}

impl DepthConvention {
    /// Returns the stored values of the near plane and of the far plane.
    pub fn planes(self) -> [f32; 2] {
        match self {
            DepthConvention::Standard => [0.0, 1.0],
            DepthConvention::Reversed => [1.0, 0.0],
        }
    }
}

/// Near and far plane (metres, along the viewing axis) and the encoding of depth between them. `far` may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DepthRange {
    /// Distance of the near plane in metres.
    pub near: f32,
    /// Distance of the far plane in metres, possibly infinite.
    pub far: f32,
    /// Direction of the stored values.
    pub convention: DepthConvention,
}

impl DepthRange {
    /// Unity's default planes, which the paper uses (0.3 m and 1000 m), in standard depth.
    pub const PAPER: DepthRange =
        DepthRange { near: 0.3, far: 1000.0, convention: DepthConvention::Standard };

    /// Returns the range of a depth buffer that holds 0 at one distance and 1 at another, in metres: OpenXR's `nearZ`
    /// and `farZ`. The larger distance, which may be infinite, is the far plane.
    pub fn from_distances(at_0: f32, at_1: f32) -> DepthRange {
        if at_0 <= at_1 {
            DepthRange { near: at_0, far: at_1, convention: DepthConvention::Standard }
        } else {
            DepthRange { near: at_1, far: at_0, convention: DepthConvention::Reversed }
        }
    }

    /// Returns `(c, m)` of the affine law `1 / z = c + m * depth`, z in metres.
    pub fn inverse_distance_law(&self) -> (f64, f64) {
        let (near, far) = (1.0 / self.near as f64, 1.0 / self.far as f64);
        match self.convention {
            DepthConvention::Standard => (near, far - near),
            DepthConvention::Reversed => (far, near - far),
        }
    }

    /// Returns the distance along the viewing axis, in metres, of a stored value.
    pub fn distance(&self, depth: f32) -> f32 {
        let (c, m) = self.inverse_distance_law();
        (1.0 / (c + m * depth as f64)) as f32
    }

    /// Returns the stored value of a distance along the viewing axis, in metres.
    pub fn depth(&self, distance: f32) -> f32 {
        let (c, m) = self.inverse_distance_law();
        ((1.0 / distance as f64 - c) / m) as f32
    }

    /// Returns the stored value of the far plane, to which the depth buffer is cleared.
    pub fn clear_value(&self) -> f32 {
        self.convention.planes()[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_first_distance_means_reversed_depth() {
        for (at_0, at_1) in [(0.1f32, 50.0f32), (50.0, 0.1), (f32::INFINITY, 0.1), (0.1, f32::INFINITY)] {
            let range = DepthRange::from_distances(at_0, at_1);
            assert_eq!((range.near, range.far), (0.1, at_0.max(at_1)));
            assert!((1.0 / range.distance(0.0) - 1.0 / at_0).abs() < 1e-4);
            assert!((1.0 / range.distance(1.0) - 1.0 / at_1).abs() < 1e-4);
        }
    }

    #[test]
    fn depth_and_distance_are_inverse() {
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            for far in [1000.0, f32::INFINITY] {
                let range = DepthRange { near: 0.1, far, convention };
                for z in [0.1f32, 0.5, 3.0, 80.0] {
                    assert!((range.distance(range.depth(z)) / z - 1.0).abs() < 1e-3);
                }
            }
        }
    }
}
