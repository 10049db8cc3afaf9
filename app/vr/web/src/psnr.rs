//! The similarity of two images.

/// Returns the peak signal-to-noise ratio of two RGBA images of one size, without alpha, in dB; infinite for equal
/// images.
pub fn psnr(a: &[u8], b: &[u8]) -> f64 {
    debug_assert_eq!(a.len(), b.len());
    let colors = a.iter().zip(b).enumerate().filter(|(i, _)| i % 4 != 3);
    let sum: f64 = colors.map(|(_, (a, b))| f64::from(a.abs_diff(*b)).powi(2)).sum();
    let mean_square = sum / (a.len() / 4 * 3).max(1) as f64;
    if mean_square == 0.0 { f64::INFINITY } else { 10.0 * (255.0 * 255.0 / mean_square).log10() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn psnr_is_that_of_the_colours() {
        assert_eq!(psnr(&[1, 2, 3, 4], &[1, 2, 3, 255]), f64::INFINITY);
        // Black and white: the error is the full range.
        assert_eq!(psnr(&[0, 0, 0, 255], &[255; 4]), 0.0);
        // A mean square error of 1, relative to 255^2 = 65025.
        assert!((psnr(&[10, 20, 30, 0], &[11, 19, 31, 0]) - 48.1308).abs() < 1e-4);
    }
}
