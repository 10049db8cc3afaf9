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

/// The number of values whose local means SSIM needs: a, b, a^2 + b^2 (only the sum of both variances occurs), a b.
const MOMENTS: usize = 4;

/// Returns the SSIM map for the separable window whose centre and one side are `half`. Each thread processes a band of
/// rows from top to bottom and keeps the horizontal means of the rows that the window covers.
fn windowed<const N: usize>(
    a: &RgbImage,
    b: &RgbImage,
    half: &[f64; N],
    factor: f64,
    channels: Channels,
) -> Vec<f64> {
    const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
    const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);
    let (width, height) = (a.width() as usize, a.height() as usize);
    let radius = N - 1;
    let taps = 2 * N - 1;
    let planes = channels.planes();
    let weight = 1.0 / planes.len() as f64;
    let band = height.div_ceil(4 * rayon::current_num_threads()).max(2 * taps);
    let mut map = vec![0.0; width * height];
    map.par_chunks_mut(band * width).enumerate().for_each(|(index, out)| {
        let top = index * band;
        let mut padded = vec![0.0; width + 2 * radius];
        let mut pixels = [vec![0.0; width], vec![0.0; width]];
        let mut means: [Vec<f64>; MOMENTS] = std::array::from_fn(|_| vec![0.0; width]);
        let mut ring: [Vec<f64>; MOMENTS] = std::array::from_fn(|_| vec![0.0; width * taps]);
        for plane in planes {
            let mut enter = |row: isize, ring: &mut [Vec<f64>; MOMENTS]| {
                let y = mirror(row, height);
                for (pixels, image) in pixels.iter_mut().zip([a, b]) {
                    let row = &image.as_raw()[y * width * 3..(y + 1) * width * 3];
                    for (value, rgb) in pixels.iter_mut().zip(row.chunks_exact(3)) {
                        *value = plane[0] * f64::from(rgb[0])
                            + plane[1] * f64::from(rgb[1])
                            + plane[2] * f64::from(rgb[2]);
                    }
                }
                let slot = row.rem_euclid(taps as isize) as usize * width;
                for (moment, ring) in ring.iter_mut().enumerate() {
                    let middle = &mut padded[radius..radius + width];
                    for ((value, a), b) in middle.iter_mut().zip(&pixels[0]).zip(&pixels[1]) {
                        *value = match moment {
                            0 => *a,
                            1 => *b,
                            2 => a * a + b * b,
                            _ => a * b,
                        };
                    }
                    for k in 0..radius {
                        padded[radius - 1 - k] = padded[radius + k];
                        padded[radius + width + k] = padded[radius + width - 1 - k];
                    }
                    mean_along_row(half, &padded, &mut ring[slot..slot + width]);
                }
            };
            for row in top as isize - radius as isize..(top + radius) as isize {
                enter(row, &mut ring);
            }
            for (y, out) in out.chunks_exact_mut(width).enumerate() {
                let y = (top + y) as isize;
                enter(y + radius as isize, &mut ring);
                for (ring, mean) in ring.iter().zip(&mut means) {
                    mean_across_rows(half, ring, y, mean);
                }
                let [mean_a, mean_b, squares, products] = &means;
                for ((((out, ma), mb), s), p) in
                    out.iter_mut().zip(mean_a).zip(mean_b).zip(squares).zip(products)
                {
                    let (ab, aa_bb) = (ma * mb, ma * ma + mb * mb);
                    let (covariance, variances) = (factor * (p - ab), factor * (s - aa_bb));
                    *out += weight * ((2.0 * ab + C1) * (2.0 * covariance + C2))
                        / ((aa_bb + C1) * (variances + C2));
                }
            }
        }
    });
    map
}

/// Returns the row or column that is shown at a position outside of `0..size`: the border pixel is repeated once, then
/// the image runs backwards.
fn mirror(position: isize, size: usize) -> usize {
    let size = size as isize;
    (if position < 0 { -1 - position } else { position.min(2 * size - 1 - position) }) as usize
}

fn mean_along_row<const N: usize>(half: &[f64; N], padded: &[f64], out: &mut [f64]) {
    for (out, window) in out.iter_mut().zip(padded.windows(2 * N - 1)) {
        let mut sum = half[0] * window[N - 1];
        for k in 1..N {
            sum += half[k] * (window[N - 1 - k] + window[N - 1 + k]);
        }
        *out = sum;
    }
}

fn mean_across_rows<const N: usize>(half: &[f64; N], ring: &[f64], y: isize, out: &mut [f64]) {
    let width = out.len();
    let row = |offset: isize| {
        let slot = (y + offset).rem_euclid(2 * N as isize - 1) as usize;
        &ring[slot * width..(slot + 1) * width]
    };
    let above: [&[f64]; N] = std::array::from_fn(|k| row(-(k as isize)));
    let below: [&[f64]; N] = std::array::from_fn(|k| row(k as isize));
    for (x, out) in out.iter_mut().enumerate() {
        let mut sum = half[0] * above[0][x];
        for k in 1..N {
            sum += half[k] * (above[k][x] + below[k][x]);
        }
        *out = sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::image;

    /// Computes one window directly from the definition.
    fn plain(a: &RgbImage, b: &RgbImage, x0: usize, y0: usize, channel: usize) -> f64 {
        let half = gaussian_half();
        let [mut ma, mut mb, mut aa, mut bb, mut ab] = [0.0; 5];
        for dy in -5isize..=5 {
            for dx in -5isize..=5 {
                let x = mirror(x0 as isize + dx, a.width() as usize) as u32;
                let y = mirror(y0 as isize + dy, a.height() as usize) as u32;
                let w = half[dx.unsigned_abs()] * half[dy.unsigned_abs()];
                let (va, vb) =
                    (f64::from(a.get_pixel(x, y).0[channel]), f64::from(b.get_pixel(x, y).0[channel]));
                ma += w * va;
                mb += w * vb;
                aa += w * va * va;
                bb += w * vb * vb;
                ab += w * va * vb;
            }
        }
        let (c1, c2) = (6.5025, 58.5225);
        (2.0 * ma * mb + c1) * (2.0 * (ab - ma * mb) + c2)
            / ((ma * ma + mb * mb + c1) * (aa - ma * ma + bb - mb * mb + c2))
    }

    #[test]
    fn bands_meet_without_a_seam() {
        // The image is taller than the bands of any thread count, so that the window crosses all borders between bands.
        let (a, b) = (image(23, 301, 5), image(23, 301, 6));
        let map = ssim_map(&a, &b, SsimWindow::Gaussian11, Channels::Rgb).unwrap();
        for y in 0..301 {
            for x in [0, 4, 11, 22] {
                let expected = (0..3).map(|c| plain(&a, &b, x, y, c)).sum::<f64>() / 3.0;
                assert!((map[y * 23 + x] - expected).abs() < 1e-9, "at {x}, {y}");
            }
        }
    }
}
