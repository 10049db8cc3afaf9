//! How much wider than its eye the dominant view is rendered.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// How much wider than its eye the dominant view is rendered, so that the other eye finds its outer border.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum GuardBand {
    /// No guard band: as in the paper; the outer border of the other eye is a hole.
    None,
    /// As many pixels as it takes for surfaces at this distance (metres, in [`GuardBand::DISTANCES`]) or farther.
    Distance(f32),
    /// A number of pixels, up to [`GuardBand::MAX_PIXELS`].
    Pixels(u32),
}

impl GuardBand {
    /// The widest band.
    pub const MAX_PIXELS: u32 = 1024;
    /// Distances in metres from which a band can be complete.
    pub const DISTANCES: RangeInclusive<f32> = 0.05..=1000.0;

    /// Whether the value lies in its range.
    pub fn is_valid(&self) -> bool {
        match self {
            GuardBand::None => true,
            GuardBand::Distance(z) => GuardBand::DISTANCES.contains(z),
            GuardBand::Pixels(n) => *n <= GuardBand::MAX_PIXELS,
        }
    }

    /// Width in pixels, for a focal length in pixels and a distance between the eyes in metres.
    pub(super) fn pixels(self, focal_length: f32, ipd: f32) -> u32 {
        match self {
            GuardBand::None => 0,
            GuardBand::Pixels(n) => n,
            GuardBand::Distance(z) => (focal_length * ipd / z - 1e-3).ceil().max(0.0) as u32,
        }
    }
}

/// A text that is no [`GuardBand`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("give none, pixels such as 40px, or metres such as 1.0")]
pub struct ParseGuardBandError;

/// `none`, pixels (`40px`) up to [`GuardBand::MAX_PIXELS`], or metres (`1.0`) within [`GuardBand::DISTANCES`].
impl FromStr for GuardBand {
    type Err = ParseGuardBandError;

    fn from_str(text: &str) -> Result<GuardBand, ParseGuardBandError> {
        match (text, text.strip_suffix("px")) {
            ("none", _) => Some(GuardBand::None),
            (_, Some(pixels)) => pixels.parse().ok().map(GuardBand::Pixels),
            (metres, None) => metres.parse().ok().map(GuardBand::Distance),
        }
        .filter(GuardBand::is_valid)
        .ok_or(ParseGuardBandError)
    }
}

/// As [`FromStr`] reads it.
impl Display for GuardBand {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            GuardBand::None => f.write_str("none"),
            GuardBand::Pixels(n) => write!(f, "{n}px"),
            GuardBand::Distance(z) => write!(f, "{z}"),
        }
    }
}
