//! Quantities with a range: the distance between the eyes, the size of a screen, the resolution of the ImBuffer.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use yoro::eyes::MEAN_IPD;

/// The distance between the eyes (interpupillary distance) in metres, 0 to [`Ipd::MAX`].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Ipd(f32);

/// A distance that eyes cannot have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("give metres from 0 to {}, such as {} for {:.0} mm", Ipd::MAX, Ipd::DEFAULT, Ipd::DEFAULT.0 * 1e3)]
pub struct IpdError;

impl Ipd {
    /// The largest distance, a little more than people have.
    pub const MAX: Ipd = Ipd(0.08);
    /// The default, which is the paper's distance.
    pub const DEFAULT: Ipd = Ipd(MEAN_IPD);

    /// Returns the valid distance nearest to `metres`; [`Ipd::MAX`] for NaN.
    pub fn nearest(metres: f32) -> Ipd {
        Ipd(if metres.is_nan() { Ipd::MAX.0 } else { metres.clamp(0.0, Ipd::MAX.0) })
    }

    /// Returns the distance in metres.
    pub fn metres(self) -> f32 {
        self.0
    }
}

impl TryFrom<f32> for Ipd {
    type Error = IpdError;

    fn try_from(metres: f32) -> Result<Ipd, IpdError> {
        if (0.0..=Ipd::MAX.0).contains(&metres) { Ok(Ipd(metres)) } else { Err(IpdError) }
    }
}

impl From<Ipd> for f32 {
    fn from(ipd: Ipd) -> f32 {
        ipd.0
    }
}

impl FromStr for Ipd {
    type Err = IpdError;

    fn from_str(text: &str) -> Result<Ipd, IpdError> {
        text.parse::<f32>().map_err(|_| IpdError)?.try_into()
    }
}

impl Display for Ipd {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The plausible lengths in millimetres of a side of a screen behind lenses.
const PLAUSIBLE_SCREEN: RangeInclusive<f32> = 30.0..=400.0;

/// Width and height of a screen in millimetres, in the orientation in which a viewer holds it: `158x71mm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenSize {
    millimetres: [f32; 2],
}

/// A text that is not a size of a screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "give width and height from {} to {} mm, such as 158x71mm, or auto for what the device says",
    PLAUSIBLE_SCREEN.start(),
    PLAUSIBLE_SCREEN.end()
)]
pub struct ScreenSizeError;

impl ScreenSize {
    /// Returns the width and height in metres.
    pub fn metres(self) -> [f32; 2] {
        self.millimetres.map(|length| length * 1e-3)
    }
}

impl FromStr for ScreenSize {
    type Err = ScreenSizeError;

    fn from_str(text: &str) -> Result<ScreenSize, ScreenSizeError> {
        fn length(text: &str) -> Option<f32> {
            text.trim().parse().ok().filter(|length| PLAUSIBLE_SCREEN.contains(length))
        }
        let lengths = text.trim().strip_suffix("mm").and_then(|lengths| lengths.split_once('x'));
        let (width, height) = lengths.ok_or(ScreenSizeError)?;
        let millimetres = length(width).zip(length(height)).map(<[f32; 2]>::from);
        millimetres.map(|millimetres| ScreenSize { millimetres }).ok_or(ScreenSizeError)
    }
}

impl Display for ScreenSize {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [width, height] = self.millimetres;
        write!(f, "{width}x{height}mm")
    }
}

/// The resolution of the ImBuffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ImBufferSize {
    /// One ImBuffer pixel per this many image pixels, on both axes: 1, 2, 4, 8 or 16 in the paper.
    Divisor(u32),
    /// A fixed size in pixels, whatever the image's size.
    Fixed([u32; 2]),
}

/// A text that is not an [`ImBufferSize`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("give a divisor from 1 to 64, such as 2, or a size, such as 512x512")]
pub struct ParseImBufferSizeError;

/// Reads a divisor from 1 to 64 (`2`), or a width and a height from 1 to 8192 (`512x512`).
impl FromStr for ImBufferSize {
    type Err = ParseImBufferSizeError;

    fn from_str(text: &str) -> Result<ImBufferSize, ParseImBufferSizeError> {
        let number = |t: &str| t.parse::<u32>().ok().filter(|n| (1..=8192).contains(n));
        match text.split_once('x') {
            Some((w, h)) => number(w).zip(number(h)).map(|(w, h)| ImBufferSize::Fixed([w, h])),
            None => number(text).filter(|n| *n <= 64).map(ImBufferSize::Divisor),
        }
        .ok_or(ParseImBufferSizeError)
    }
}

impl Display for ImBufferSize {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            ImBufferSize::Divisor(n) => write!(f, "{n}"),
            ImBufferSize::Fixed([w, h]) => write!(f, "{w}x{h}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_between_the_eyes_is_bounded_once() {
        assert_eq!("0.063".parse(), Ok(Ipd::DEFAULT));
        assert_eq!(Ipd::DEFAULT.to_string(), "0.063");
        for text in ["-0.001", "0.081", "63mm", "NaN", "inf", ""] {
            assert_eq!(text.parse::<Ipd>(), Err(IpdError), "{text}");
        }
        assert_eq!([-1.0, 0.05, 1.0, f32::NAN].map(|m| Ipd::nearest(m).metres()), [0.0, 0.05, 0.08, 0.08]);
        assert_eq!(serde_json::from_str::<Ipd>("0.07").unwrap(), Ipd(0.07));
        assert!(serde_json::from_str::<Ipd>("0.09").unwrap_err().to_string().contains("0 to 0.08"));
    }
}
