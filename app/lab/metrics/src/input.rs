//! The channels that are compared, and the errors of comparing.

use image::RgbImage;

/// The error when two images cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MetricsError {
    /// The sizes differ.
    #[error("the two images differ in size ({}x{} and {}x{}): compare images of one size", a.0, a.1, b.0, b.1)]
    SizesDiffer {
        /// Size of the first in pixels.
        a: (u32, u32),
        /// Size of the second in pixels.
        b: (u32, u32),
    },
    /// The image is smaller than the window of SSIM.
    #[error("an image of {width}x{height} pixels is too small: SSIM needs at least {window}x{window}")]
    TooSmall {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Width of the window in pixels.
        window: u32,
    },
    /// The mask does not belong to these images.
    #[error("the mask has {mask} pixels and the images have {image}: give the mask of these images")]
    MaskSize {
        /// Pixels of the mask.
        mask: usize,
        /// Pixels of an image.
        image: usize,
    },
}

/// The channels of an image that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Red, green and blue: PSNR of the error over all three channels, SSIM as the mean of the three.
    Rgb,
    /// Luma of ITU-R BT.601, not rounded: .299 R + .587 G + .114 B.
    Luma,
}

impl Channels {
    /// Returns the weights of red, green and blue for each plane.
    pub(super) fn planes(self) -> &'static [[f64; 3]] {
        match self {
            Channels::Rgb => &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            Channels::Luma => &[[0.299, 0.587, 0.114]],
        }
    }
}

/// Checks that two images have the same size.
pub(super) fn check_sizes(a: &RgbImage, b: &RgbImage) -> Result<(), MetricsError> {
    if a.dimensions() != b.dimensions() {
        return Err(MetricsError::SizesDiffer { a: a.dimensions(), b: b.dimensions() });
    }
    Ok(())
}

/// Checks that a mask has as many pixels as an image.
pub(super) fn check_mask(image: &RgbImage, mask: &[bool]) -> Result<(), MetricsError> {
    let pixels = image.width() as usize * image.height() as usize;
    if mask.len() != pixels {
        return Err(MetricsError::MaskSize { mask: mask.len(), image: pixels });
    }
    Ok(())
}
