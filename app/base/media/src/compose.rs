//! Pictures made of two eyes.

use image::{Rgb, RgbImage};

use crate::{DepthImage, PictureError, srgb};

/// The factor by which [`difference`] multiplies.
pub const DIFFERENCE_GAIN: u8 = 4;

/// Returns the image of RGBA bytes whose rows run from the bottom, as GL reads them back. Alpha is dropped.
pub fn rgb_image(rgba: &[u8], size: [u32; 2]) -> RgbImage {
    let row = size[0] as usize * 4;
    RgbImage::from_fn(size[0], size[1], |x, y| {
        let i = (size[1] - 1 - y) as usize * row + x as usize * 4;
        Rgb([rgba[i], rgba[i + 1], rgba[i + 2]])
    })
}

/// Returns the image of depth whose rows run from the bottom, as GL reads it back.
pub fn depth_image(depth: &[f32], [width, height]: [u32; 2]) -> DepthImage {
    let flipped = depth.chunks_exact(width as usize).rev().flatten().copied().collect();
    DepthImage::from_raw(width, height, flipped).expect("one value for each pixel")
}

/// Places both eyes side by side with the left eye on the left, for parallel viewing.
pub fn side_by_side(left: &RgbImage, right: &RgbImage) -> Result<RgbImage, PictureError> {
    check_sizes(left, right)?;
    let mut both = RgbImage::new(left.width() * 2, left.height());
    image::imageops::replace(&mut both, left, 0, 0);
    image::imageops::replace(&mut both, right, i64::from(left.width()), 0);
    Ok(both)
}

/// Places both eyes side by side with the right eye on the left, for viewing with crossed eyes and no device.
pub fn cross_eyed(left: &RgbImage, right: &RgbImage) -> Result<RgbImage, PictureError> {
    side_by_side(right, left)
}

/// Returns an anaglyph for red (left) and cyan (right) glasses, by the least-squares projection of linear light from E.
/// Dubois, "A projection method to generate anaglyph stereo images", ICASSP 2001.
pub fn anaglyph(left: &RgbImage, right: &RgbImage) -> Result<RgbImage, PictureError> {
    const LEFT: [[f32; 3]; 3] = [[0.456, 0.500, 0.176], [-0.040, -0.038, -0.016], [-0.015, -0.021, -0.005]];
    const RIGHT: [[f32; 3]; 3] = [[-0.043, -0.088, -0.002], [0.378, 0.734, -0.018], [-0.072, -0.113, 1.226]];
    check_sizes(left, right)?;
    let linear: [f32; 256] = std::array::from_fn(|v| srgb::to_linear(v as u8));
    Ok(RgbImage::from_fn(left.width(), left.height(), |x, y| {
        let l = left.get_pixel(x, y).0.map(|v| linear[usize::from(v)]);
        let r = right.get_pixel(x, y).0.map(|v| linear[usize::from(v)]);
        let dot = |row: [f32; 3], v: [f32; 3]| row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
        Rgb(std::array::from_fn(|c| srgb::from_linear(dot(LEFT[c], l) + dot(RIGHT[c], r))))
    }))
}

/// Returns |a - b| in each channel, times [`DIFFERENCE_GAIN`].
pub fn difference(a: &RgbImage, b: &RgbImage) -> Result<RgbImage, PictureError> {
    check_sizes(a, b)?;
    let samples = a.as_raw().iter().zip(b.as_raw());
    let samples = samples.map(|(a, b)| a.abs_diff(*b).saturating_mul(DIFFERENCE_GAIN)).collect();
    Ok(RgbImage::from_raw(a.width(), a.height(), samples).expect("as many samples as the inputs have"))
}

fn check_sizes(a: &RgbImage, b: &RgbImage) -> Result<(), PictureError> {
    let ((aw, ah), (bw, bh)) = (a.dimensions(), b.dimensions());
    if (aw, ah) != (bw, bh) {
        let what = format!("the two images differ in size ({aw}x{ah} and {bw}x{bh}): give two of one size");
        return Err(PictureError::Unusable(what));
    }
    Ok(())
}
