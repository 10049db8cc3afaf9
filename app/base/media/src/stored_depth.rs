//! Decoding other programs' depth images into depth for synthesis.

use yoro::eyes::{DepthConvention, DepthRange, DisparityMap, Eye, Warp};

/// The encoding of a depth image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoredDepth {
    /// Depth buffer values between the planes of this range, in its convention.
    Window(DepthRange),
    /// Distance along the viewing axis in metres, divided by `unit`; 0 where there is no depth.
    Distance {
        /// The distance in metres that the value 1 stands for.
        unit: f32,
    },
    /// Disparity in pixels for the whole IPD: `offset + scale * value`.
    Disparity {
        /// The disparity in pixels of the value 0.
        offset: f64,
        /// The additional disparity in pixels of the value 1, at least 0: larger values are nearer.
        scale: f64,
    },
}

/// Errors of decoding depth.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StoredDepthError {
    /// Some values are NaN, for example powers of negative values.
    #[error("some values are no numbers")]
    NotANumber,
    /// Some values are outside the range of the encoding.
    #[error("some values are outside of what the encoding allows ({smallest} to {largest})")]
    Range {
        /// The smallest nearness, at most 0.
        smallest: f32,
        /// The largest nearness.
        largest: f32,
    },
}

/// Depth in the form that synthesis uses.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearness {
    /// Values from 0, which is infinitely far or at the law's offset, to 1.
    pub values: Vec<f32>,
    /// The law that gives the disparity in pixels between two eyes that are a whole IPD apart.
    pub law: DisparityMap,
}

impl StoredDepth {
    /// Decodes values. `reach` is the focal length in pixels times the IPD in metres, which is the disparity in pixels
    /// at a distance of one metre.
    ///
    /// # Errors
    /// [`StoredDepthError`] for values that the encoding does not have.
    pub fn decode(self, stored: impl Iterator<Item = f32>, reach: f64) -> Result<Nearness, StoredDepthError> {
        let (values, law): (Vec<f32>, _) = match self {
            StoredDepth::Window(range) => {
                let reversed = DepthRange { convention: DepthConvention::Reversed, ..range };
                let (c, m) = reversed.inverse_distance_law();
                let law = DisparityMap { offset: reach * c, scale: reach * m };
                let standard = range.convention == DepthConvention::Standard;
                (stored.map(|v| if standard { 1.0 - v } else { v }).collect(), law)
            }
            StoredDepth::Distance { unit } => {
                // In many depth images zero means "no depth". It is taken as infinitely far.
                let inverse = |v: f32| if v > 0.0 { 1.0 / (v * unit).max(1e-3) } else { 0.0 };
                (stored.map(inverse).collect(), DisparityMap { offset: 0.0, scale: reach })
            }
            StoredDepth::Disparity { offset, scale } => (stored.collect(), DisparityMap { offset, scale }),
        };
        if values.iter().any(|v| v.is_nan()) {
            return Err(StoredDepthError::NotANumber);
        }
        let largest = values.iter().copied().fold(0.0, f32::max);
        let smallest = values.iter().copied().fold(0.0, f32::min);
        if !largest.is_finite() || smallest < 0.0 {
            return Err(StoredDepthError::Range { smallest, largest });
        }
        if largest <= 1.0 {
            return Ok(Nearness { values, law });
        }
        let law = DisparityMap { offset: law.offset, scale: law.scale * f64::from(largest) };
        Ok(Nearness { values: values.into_iter().map(|v| v / largest).collect(), law })
    }
}

impl Nearness {
    /// Returns the warp from an image of `size` pixels to an eye that is this share of the IPD away.
    pub fn warp(&self, size: [u32; 2], target_eye: Eye, share: f64) -> Warp {
        let sign = -f64::from(target_eye.side()) * share;
        Warp {
            source_size: size,
            target_size: size,
            law: DisparityMap { offset: self.law.offset * sign, scale: self.law.scale * sign },
            row_offset: 0,
            target_eye,
            convention: DepthConvention::Reversed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disparity(nearness: &Nearness, i: usize) -> f64 {
        nearness.law.offset + nearness.law.scale * f64::from(nearness.values[i])
    }

    #[test]
    fn every_encoding_of_one_distance_has_one_disparity() {
        let (reach, distance) = (64.0, 2.0f32);
        for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
            let range = DepthRange { convention, ..DepthRange::PAPER };
            let stored = [range.depth(distance)].into_iter();
            let nearness = StoredDepth::Window(range).decode(stored, reach).unwrap();
            assert!((disparity(&nearness, 0) - 32.0).abs() < 1e-2);
        }
        let nearness =
            StoredDepth::Distance { unit: 10.0 }.decode([0.2, 0.0, 0.01].into_iter(), reach).unwrap();
        assert!((disparity(&nearness, 0) - 32.0).abs() < 1e-4);
        assert_eq!(disparity(&nearness, 1), 0.0);
        assert!(nearness.values.iter().all(|v| (0.0..=1.0).contains(v)));
        let stored = StoredDepth::Disparity { offset: 2.0, scale: 60.0 };
        assert!((disparity(&stored.decode([0.5].into_iter(), reach).unwrap(), 0) - 32.0).abs() < 1e-6);
    }

    #[test]
    fn values_outside_of_the_encoding_are_refused() {
        let decode = |v: f32| StoredDepth::Window(DepthRange::PAPER).decode([v].into_iter(), 1.0);
        assert_eq!(decode(f32::NAN), Err(StoredDepthError::NotANumber));
        assert!(matches!(decode(1.5), Err(StoredDepthError::Range { .. })));
        assert!(matches!(decode(f32::NEG_INFINITY), Err(StoredDepthError::Range { .. })));
    }
}
