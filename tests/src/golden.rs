//! Golden images: PNGs in `tests/golden` that rendered images are compared with.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use image::RgbImage;
use yoro_metrics::{Channels, SsimWindow, ssim};

/// The variable that renews the golden images instead of comparing with them.
pub const BLESS: &str = "YORO_BLESS";

/// Maximum difference of samples that may result from another compiler's rounding.
const TOLERANCE: u8 = 2;
/// Minimum fraction of pixels within this tolerance.
const SHARE: f64 = 0.995;
/// Minimum Gaussian SSIM, as the mean of red, green and blue.
const SSIM: f64 = 0.995;

/// Compares two images with these tolerances.
///
/// # Errors
/// Fails with the figures that are too low.
pub fn compare(image: &RgbImage, reference: &RgbImage) -> anyhow::Result<()> {
    let (size, wanted) = (image.dimensions(), reference.dimensions());
    ensure!(size == wanted, "{size:?} pixels instead of {wanted:?}");
    let within = image
        .pixels()
        .zip(reference.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).all(|(a, b)| a.abs_diff(b) <= TOLERANCE))
        .count();
    let share = within as f64 / f64::from(size.0 * size.1);
    let ssim = ssim(image, reference, SsimWindow::Gaussian11, Channels::Rgb)?;
    ensure!(
        share >= SHARE && ssim >= SSIM,
        "{:.2} % of the pixels within {TOLERANCE}/255 (at least {:.1} %), SSIM {ssim:.4} (at least {SSIM})",
        share * 100.0,
        SHARE * 100.0
    );
    Ok(())
}

/// Compares an image with the golden image of this name, or replaces the golden image if [`BLESS`] is set.
///
/// # Errors
/// Those of [`compare`], with the path of the difference image.
pub fn check(name: &str, image: &RgbImage) -> anyhow::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = root.parent().unwrap_or(root);
    let golden = root.join("golden").join(name).with_extension("png");
    if std::env::var_os(BLESS).is_some() {
        return Ok(yoro_media::save_color(&golden, image)?);
    }
    let reference =
        yoro_media::load_color(&golden).context("`cargo xtask test --bless` makes missing golden images")?;
    compare(image, &reference).or_else(|error| {
        let target =
            std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.join("target"), PathBuf::from);
        let path = target.join("golden-diff").join(name);
        let (difference, new) = (path.with_extension("png"), path.with_extension("new.png"));
        yoro_media::save_color(&new, image)?;
        if let Ok(image) = yoro_media::difference(image, &reference) {
            yoro_media::save_color(&difference, &image)?;
        }
        Err(error.context(format!(
            "{name} is not as it was: see {} and {}; if it is better, `cargo xtask test --bless`",
            difference.display(),
            new.display()
        )))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn the_tolerances_hold_on_both_sides() {
        let image = RgbImage::from_fn(100, 100, |x, y| Rgb([(x * 2) as u8, (y * 2) as u8, 90]));
        let changed = |every: usize, by: u8| {
            let mut image = image.clone();
            image.pixels_mut().step_by(every).for_each(|pixel| pixel.0 = pixel.0.map(|c| c.wrapping_add(by)));
            image
        };
        compare(&changed(1, 2), &image).unwrap();
        compare(&changed(203, 3), &image).unwrap();
        assert!(compare(&changed(199, 3), &image).is_err(), "51 pixels are too many");
        assert!(compare(&changed(203, 150), &image).is_err(), "50 are too many when they stand out");
        assert!(compare(&RgbImage::new(100, 99), &image).is_err());
    }
}
