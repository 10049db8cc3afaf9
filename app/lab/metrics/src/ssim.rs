//! SSIM: structural similarity.

use image::RgbImage;
use rayon::prelude::*;

use super::input::{Channels, MetricsError, check_mask, check_sizes};

/// The two variants of SSIM in common use. Figures of different variants cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SsimWindow {
    /// 11x11 gaussian, sigma 1.5, population covariance: Wang et al. 2004, and scikit-image with
    /// `gaussian_weights=True, sigma=1.5, use_sample_covariance=False`.
    Gaussian11,
    /// 7x7 uniform, sample covariance: scikit-image's default.
    Uniform7,
}

impl SsimWindow {
    /// Returns the width of the window in pixels.
    pub fn size(self) -> u32 {
        2 * self.border() as u32 + 1
    }

    /// Returns the width in pixels of the border that the mean leaves out.
    fn border(self) -> usize {
        match self {
            SsimWindow::Gaussian11 => 5,
            SsimWindow::Uniform7 => 3,
        }
    }

    /// Returns the factor that turns the plain mean of the products into the covariance.
    fn covariance_factor(self) -> f64 {
        match self {
            SsimWindow::Gaussian11 => 1.0,
            SsimWindow::Uniform7 => 49.0 / 48.0,
        }
    }
}

/// Returns the mean structural similarity over the image without a border of half a window.
///
/// # Errors
/// [`MetricsError::SizesDiffer`] and [`MetricsError::TooSmall`].
pub fn ssim(a: &RgbImage, b: &RgbImage, window: SsimWindow, channels: Channels) -> Result<f64, MetricsError> {
    let map = ssim_map(a, b, window, channels)?;
    Ok(mean_inside(&map, a, window, |_| true).expect("an image as large as the window has a middle"))
}

/// Returns the mean of the SSIM map (RGB) over the pixels where `selected`, row by row from the top, is true, without
/// the border; `None` if there are none. The window of a selected pixel also covers its neighbours.
///
/// # Errors
/// [`MetricsError::SizesDiffer`], [`MetricsError::TooSmall`] and [`MetricsError::MaskSize`].
pub fn ssim_where(
    a: &RgbImage,
    b: &RgbImage,
    window: SsimWindow,
    selected: &[bool],
) -> Result<Option<f64>, MetricsError> {
    check_mask(a, selected)?;
    let map = ssim_map(a, b, window, Channels::Rgb)?;
    Ok(mean_inside(&map, a, window, |at| selected[at]))
}

/// Returns 1 - SSIM at each pixel, row by row from the top: gaussian window, mean of red, green and blue, with the
/// image mirrored at its border. 0 means equal, 1 nothing in common, and values up to 2 the opposite.
///
/// # Errors
/// [`MetricsError::SizesDiffer`] and [`MetricsError::TooSmall`].
pub fn dissimilarity_map(a: &RgbImage, b: &RgbImage) -> Result<Vec<f64>, MetricsError> {
    let mut map = ssim_map(a, b, SsimWindow::Gaussian11, Channels::Rgb)?;
    map.par_iter_mut().for_each(|value| *value = 1.0 - *value);
    Ok(map)
}

/// Returns the mean of an SSIM map over the pixels that `take` selects, without the border; `None` if there are none.
pub(super) fn mean_inside(
    map: &[f64],
    image: &RgbImage,
    window: SsimWindow,
    take: impl Fn(usize) -> bool,
) -> Option<f64> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let border = window.border();
    let (mut sum, mut count) = (0.0, 0usize);
    for y in border..height - border {
        for at in (y * width + border..(y + 1) * width - border).filter(|at| take(*at)) {
            sum += map[at];
            count += 1;
        }
    }
    (count > 0).then(|| sum / count as f64)
}

/// Returns the SSIM at each pixel as the mean over the channels.
pub(super) fn ssim_map(
    a: &RgbImage,
    b: &RgbImage,
    window: SsimWindow,
    channels: Channels,
) -> Result<Vec<f64>, MetricsError> {
    check_sizes(a, b)?;
    let (width, height) = a.dimensions();
    if width.min(height) < window.size() {
        return Err(MetricsError::TooSmall { width, height, window: window.size() });
    }
    let factor = window.covariance_factor();
    Ok(match window {
        SsimWindow::Gaussian11 => windowed(a, b, &gaussian_half(), factor, channels),
        SsimWindow::Uniform7 => windowed(a, b, &[1.0 / 7.0; 4], factor, channels),
    })
}

/// Returns the centre and one side of the gaussian with sigma 1.5, cut off at 5 pixels, such that both sides sum to 1.
fn gaussian_half() -> [f64; 6] {
    let half: [f64; 6] = std::array::from_fn(|k| (-0.5 * (k as f64 / 1.5).powi(2)).exp());
    let sum = half[0] + 2.0 * half[1..].iter().sum::<f64>();
    half.map(|weight| weight / sum)
}

/// Returns the SSIM map for the separable window whose centre and one side are `half`.
fn windowed<const N: usize>(
    a: &RgbImage,
    b: &RgbImage,
    half: &[f64; N],
    factor: f64,
    channels: Channels,
) -> Vec<f64> {
    const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
    const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);
    let width = a.width() as usize;
    let planes = channels.planes();
    let weight = 1.0 / planes.len() as f64;
    let mut map = vec![0.0; width * a.height() as usize];
    for plane in planes {
        let value = |rgb: &[u8]| (0..3).map(|c| plane[c] * f64::from(rgb[c])).sum::<f64>();
        let [a, b] = [a, b].map(|image| image.par_chunks_exact(3).map(value).collect::<Vec<f64>>());
        let mean = |of: fn(f64, f64) -> f64| {
            means(a.par_iter().zip(&b).map(|(a, b)| of(*a, *b)).collect(), width, half)
        };
        // Of the variances only their sum occurs.
        let (mean_a, mean_b) = (mean(|a, _| a), mean(|_, b| b));
        let (squares, products) = (mean(|a, b| a * a + b * b), mean(|a, b| a * b));
        map.par_iter_mut().enumerate().for_each(|(i, out)| {
            let (ab, aa_bb) = (mean_a[i] * mean_b[i], mean_a[i] * mean_a[i] + mean_b[i] * mean_b[i]);
            let (covariance, variances) = (factor * (products[i] - ab), factor * (squares[i] - aa_bb));
            *out += weight * ((2.0 * ab + C1) * (2.0 * covariance + C2)) / ((aa_bb + C1) * (variances + C2));
        });
    }
    map
}

/// Returns the windowed mean around each value of a plane: along its rows, then across them.
fn means<const N: usize>(mut plane: Vec<f64>, width: usize, half: &[f64; N]) -> Vec<f64> {
    let (height, radius) = (plane.len() / width, N as isize - 1);
    let mut rows = vec![0.0; plane.len()];
    rows.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each(|(out, row)| {
        let padded: Vec<f64> = (-radius..width as isize + radius).map(|x| row[mirror(x, width)]).collect();
        for (out, window) in out.iter_mut().zip(padded.windows(2 * N - 1)) {
            *out = half[0] * window[N - 1];
            for k in 1..N {
                *out += half[k] * (window[N - 1 - k] + window[N - 1 + k]);
            }
        }
    });
    plane.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        let row = |offset: isize| &rows[mirror(y as isize + offset, height) * width..][..width];
        out.copy_from_slice(row(0));
        out.iter_mut().for_each(|out| *out *= half[0]);
        for (k, weight) in half.iter().enumerate().skip(1) {
            for ((out, above), below) in out.iter_mut().zip(row(-(k as isize))).zip(row(k as isize)) {
                *out += weight * (above + below);
            }
        }
    });
    plane
}

/// Returns the row or column that is shown at a position outside of `0..size`: the border pixel is repeated once, then
/// the image runs backwards.
fn mirror(position: isize, size: usize) -> usize {
    let size = size as isize;
    (if position < 0 { -1 - position } else { position.min(2 * size - 1 - position) }) as usize
}
