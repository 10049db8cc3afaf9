//! PSNR: the peak signal-to-noise ratio.

use std::fmt;

use image::RgbImage;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::input::{Channels, MetricsError, check_mask, check_sizes};

/// Peak signal-to-noise ratio in dB; infinite for identical images. In JSON, which has no infinity, it is then `null`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Psnr(pub f64);

impl Psnr {
    fn from_mean_square(error: f64) -> Psnr {
        Psnr(if error == 0.0 { f64::INFINITY } else { 10.0 * (255.0 * 255.0 / error).log10() })
    }

    /// True if no sample differs.
    pub fn is_infinite(self) -> bool {
        self.0.is_infinite()
    }

    /// Returns the mean of the finite values; infinite if there are none.
    pub fn mean(all: impl IntoIterator<Item = Psnr>) -> Psnr {
        let finite: Vec<f64> = all.into_iter().map(|p| p.0).filter(|p| p.is_finite()).collect();
        Psnr(if finite.is_empty() { f64::INFINITY } else { finite.iter().sum::<f64>() / finite.len() as f64 })
    }
}

/// Writes two decimals unless a precision is given, or `inf`; right-aligned in the width.
impl fmt::Display for Psnr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(2);
        let text = if self.is_infinite() { "inf".to_string() } else { format!("{:.digits$}", self.0) };
        write!(f, "{text:>width$}", width = f.width().unwrap_or(0))
    }
}

impl Serialize for Psnr {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.is_finite().then_some(self.0).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Psnr {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Psnr, D::Error> {
        Ok(Psnr(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::INFINITY)))
    }
}

/// Returns the PSNR over the whole image.
///
/// # Errors
/// [`MetricsError::SizesDiffer`].
pub fn psnr(a: &RgbImage, b: &RgbImage, channels: Channels) -> Result<Psnr, MetricsError> {
    check_sizes(a, b)?;
    let planes = channels.planes();
    let mut sum = 0.0;
    for (a, b) in a.as_raw().chunks_exact(3).zip(b.as_raw().chunks_exact(3)) {
        for weights in planes {
            sum += square_error(a, b, weights);
        }
    }
    Ok(Psnr::from_mean_square(sum / (a.as_raw().len() / 3 * planes.len()) as f64))
}

/// Returns the PSNR (RGB) over the pixels where `selected`, row by row from the top, is true; `None` if there are none.
///
/// # Errors
/// [`MetricsError::SizesDiffer`] and [`MetricsError::MaskSize`].
pub fn psnr_where(a: &RgbImage, b: &RgbImage, selected: &[bool]) -> Result<Option<Psnr>, MetricsError> {
    check_sizes(a, b)?;
    check_mask(a, selected)?;
    let (mut sum, mut count) = (0.0, 0usize);
    let pixels = a.as_raw().chunks_exact(3).zip(b.as_raw().chunks_exact(3));
    for ((a, b), _) in pixels.zip(selected).filter(|(_, selected)| **selected) {
        sum += Channels::Rgb.planes().iter().map(|weights| square_error(a, b, weights)).sum::<f64>();
        count += 3;
    }
    Ok((count > 0).then(|| Psnr::from_mean_square(sum / count as f64)))
}

fn square_error(a: &[u8], b: &[u8], weights: &[f64; 3]) -> f64 {
    let error: f64 = (0..3).map(|c| weights[c] * (f64::from(a[c]) - f64::from(b[c]))).sum();
    error * error
}
