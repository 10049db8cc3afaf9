//! The guard band: the part of the dominant view beyond its own eye's image.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// How much wider than its eye's image the dominant view is rendered, so that it contains the other eye's outer border.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum GuardBand {
    /// No guard band, as in the paper: the outer border of the other eye is a hole.
    None,
    /// Wide enough for all surfaces at this distance or farther: more than 0, in the unit of the eyes' positions.
    Distance(f32),
    /// A number of pixels, up to [`GuardBand::MAX_PIXELS`].
    Pixels(u32),
}

impl GuardBand {
    /// The widest band.
    pub const MAX_PIXELS: u32 = 1024;
    /// The distances in metres that a text may have. In worlds of another scale other distances make sense.
    pub const DISTANCES: RangeInclusive<f32> = 0.05..=1000.0;

    /// True if the band can be given as text, for a world in metres.
    pub fn is_valid(&self) -> bool {
        match self {
            GuardBand::None => true,
            GuardBand::Distance(z) => GuardBand::DISTANCES.contains(z),
            GuardBand::Pixels(n) => *n <= GuardBand::MAX_PIXELS,
        }
    }

    /// True if such a band is possible, in a world of any scale.
    pub(super) fn is_possible(&self) -> bool {
        match self {
            GuardBand::None => true,
            GuardBand::Distance(z) => *z > 0.0 && z.is_finite(),
            GuardBand::Pixels(n) => *n <= GuardBand::MAX_PIXELS,
        }
    }

    /// Returns the width in pixels, for a focal length in pixels and a distance between the eyes in metres.
    pub(super) fn pixels(self, focal_length: f32, ipd: f32) -> u32 {
        match self {
            GuardBand::None => 0,
            GuardBand::Pixels(n) => n,
            GuardBand::Distance(z) => (focal_length * ipd / z - 1e-3).ceil().max(0.0) as u32,
        }
    }
}

/// The error for a text that is not a [`GuardBand`].
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

/// Writes the text that [`FromStr`] reads.
impl Display for GuardBand {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            GuardBand::None => f.write_str("none"),
            GuardBand::Pixels(n) => write!(f, "{n}px"),
            GuardBand::Distance(z) => write!(f, "{z}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_round_trip_and_others_are_refused() {
        for (text, band) in
            [("none", GuardBand::None), ("40px", GuardBand::Pixels(40)), ("0.5", GuardBand::Distance(0.5))]
        {
            assert_eq!((text.parse(), band.to_string().as_str()), (Ok(band), text));
        }
        for text in ["", "auto", "0", "0px1", "2000px", "-1", "Auto", "1 m"] {
            assert_eq!(text.parse::<GuardBand>(), Err(ParseGuardBandError), "{text}");
        }
    }
}
