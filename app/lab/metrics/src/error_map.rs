//! Error maps: the error at each pixel as a colour.

use image::{Rgb, RgbImage};

use super::input::MetricsError;
use super::ssim::dissimilarity_map;

/// The colour map "magma" of matplotlib (N. Smith and S. van der Walt, CC0) at 17 equally spaced points, in sRGB.
/// Linear interpolation between them stays within 3/255 of all its 256 colours. Lightness grows evenly, so that lighter
/// means more error on any screen and for any kind of colour vision.
const MAGMA: [[u8; 3]; 17] = [
    [0, 0, 4],
    [10, 8, 34],
    [29, 17, 71],
    [54, 16, 107],
    [80, 18, 124],
    [105, 28, 129],
    [130, 38, 129],
    [156, 46, 127],
    [182, 54, 122],
    [207, 64, 112],
    [230, 81, 100],
    [244, 106, 92],
    [251, 136, 97],
    [254, 165, 113],
    [254, 194, 135],
    [253, 224, 161],
    [252, 253, 191],
];

/// Returns the colour of an error from 0 (black) to 1 (pale yellow), clamped.
pub fn error_color(error: f64) -> [u8; 3] {
    let at = error.clamp(0.0, 1.0) * (MAGMA.len() - 1) as f64;
    let below = (at as usize).min(MAGMA.len() - 2);
    let t = at - below as f64;
    std::array::from_fn(|c| {
        let (low, high) = (f64::from(MAGMA[below][c]), f64::from(MAGMA[below + 1][c]));
        (low + t * (high - low)).round() as u8
    })
}

/// Returns 1 - SSIM of `a` and `b` at each pixel (gaussian window, mean of red, green and blue) as colours on a fixed
/// scale from 0 (black) to 1 (pale yellow).
///
/// # Errors
/// [`MetricsError::SizesDiffer`] and [`MetricsError::TooSmall`].
pub fn error_map(a: &RgbImage, b: &RgbImage) -> Result<RgbImage, MetricsError> {
    let map = dissimilarity_map(a, b)?;
    let width = a.width();
    Ok(RgbImage::from_fn(width, a.height(), |x, y| {
        Rgb(error_color(map[y as usize * width as usize + x as usize]))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::image;

    #[test]
    fn colours_get_lighter_with_the_error() {
        let light = |e: f64| {
            error_color(e).iter().zip([0.2126, 0.7152, 0.0722]).map(|(v, w)| f64::from(*v) * w).sum::<f64>()
        };
        for i in 0..100 {
            assert!(light(i as f64 / 100.0) <= light((i + 1) as f64 / 100.0) + 0.5, "at {i}");
        }
        assert_eq!(error_color(-1.0), [0, 0, 4]);
        assert_eq!(error_color(2.0), [252, 253, 191]);
    }

    #[test]
    fn the_map_is_black_where_nothing_differs() {
        let a = image(64, 20, 1);
        let mut b = a.clone();
        for y in 0..20 {
            for x in 48..64 {
                b.put_pixel(x, y, Rgb([0, 0, 0]));
            }
        }
        let map = error_map(&a, &b).unwrap();
        assert_eq!(map.get_pixel(10, 10).0, [0, 0, 4]);
        assert!(map.get_pixel(60, 10).0[0] > 150);
    }
}
