//! A colour and a depth picture of somebody's own: the other eye, with the depth settings of `yoro synthesize`.

use std::io::Cursor;

use image::{DynamicImage, ImageReader};
use serde::Deserialize;
use yoro::eyes::{DepthConvention, DepthRange, Eye};
use yoro::synthesis::{Nearness, StoredDepth, StoredDepthError};

/// Longest edge of a picture in pixels.
const MAX_EDGE: u32 = 8192;

/// What the values of the depth picture mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Encoding {
    /// Depth buffer, 0 near to 1 far.
    #[default]
    StandardZ,
    /// Depth buffer, 1 near to 0 far.
    ReversedZ,
    /// Distance, times [`PictureOptions::metres_at_white`].
    Metres,
    /// Pixels: [`PictureOptions::disparity_offset`] and [`PictureOptions::disparity_scale`].
    Disparity,
}

/// Which eye the pictures show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SourceEye {
    /// The right one is synthesized.
    Left,
    /// The left one is synthesized.
    #[default]
    Right,
    /// None: both are synthesized.
    Center,
}

impl SourceEye {
    /// The eyes to synthesize, and the share of the IPD that each is away.
    pub fn targets(self) -> &'static [(Eye, f64)] {
        match self {
            SourceEye::Right => &[(Eye::Left, 1.0)],
            SourceEye::Left => &[(Eye::Right, 1.0)],
            SourceEye::Center => &[(Eye::Left, 0.5), (Eye::Right, 0.5)],
        }
    }
}

/// The options of `yoro synthesize` with its defaults.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PictureOptions {
    /// Which eye the pictures show.
    pub source: SourceEye,
    /// What the depth values mean.
    pub encoding: Encoding,
    /// The stored value is raised to this power first.
    pub gamma: f32,
    /// Near plane in metres.
    pub near: f32,
    /// Far plane in metres.
    pub far: f32,
    /// Distance of the largest value in metres.
    pub metres_at_white: f32,
    /// Pixels at value 0.
    pub disparity_offset: f64,
    /// Pixels from value 0 to 1.
    pub disparity_scale: f64,
    /// Vertical field of view in degrees.
    pub fov_y_degrees: f64,
}

impl Default for PictureOptions {
    fn default() -> PictureOptions {
        PictureOptions {
            source: SourceEye::default(),
            encoding: Encoding::default(),
            gamma: 1.0,
            near: DepthRange::PAPER.near,
            far: DepthRange::PAPER.far,
            metres_at_white: 1.0,
            disparity_offset: 0.0,
            disparity_scale: 1.0,
            fov_y_degrees: 60.0,
        }
    }
}

/// Why two pictures are of no use, in a sentence.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// An option.
    #[error("{0}")]
    Option(String),
    /// No picture.
    #[error("{name} is no picture that can be read ({reason}): give a PNG, or a JPEG for colour")]
    Unreadable {
        /// The file.
        name: String,
        /// The decoder's reason.
        reason: String,
    },
    /// Larger than any GPU takes.
    #[error("{name} has {width}x{height} pixels, {MAX_EDGE}x{MAX_EDGE} at most: scale it down")]
    TooLarge {
        /// The file.
        name: String,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// They do not belong together.
    #[error("the colour picture is {}x{} pixels and the depth picture {}x{}: both must have one size", .0[0], .0[1], .1[0], .1[1])]
    Sizes([u32; 2], [u32; 2]),
    /// Colour instead of depth.
    #[error("{0} is a colour picture: depth has equal red, green and blue")]
    NotGrey(String),
    /// Values that mean nothing.
    #[error("the depth picture does not fit its encoding: {0}")]
    Values(#[from] StoredDepthError),
}

/// Decoded pictures, rows from the bottom.
#[derive(Debug)]
pub struct PicturePair {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Colour, 4 bytes a pixel.
    pub rgba: Vec<u8>,
    /// Depth as stored, 0 to 1.
    stored: Vec<f32>,
}

fn decode(name: &str, bytes: &[u8]) -> Result<DynamicImage, PictureError> {
    let unreadable = |reason: String| PictureError::Unreadable { name: name.into(), reason };
    let reader = || {
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        reader.map_err(|error| unreadable(error.to_string()))
    };
    let size = reader()?.into_dimensions().map_err(|error| unreadable(error.to_string()))?;
    if size.0.max(size.1) > MAX_EDGE {
        return Err(PictureError::TooLarge { name: name.into(), width: size.0, height: size.1 });
    }
    reader()?.decode().map_err(|error| unreadable(error.to_string()))
}

impl PicturePair {
    /// Decodes two files.
    ///
    /// # Errors
    /// [`PictureError`].
    pub fn decode(color: (&str, &[u8]), depth: (&str, &[u8])) -> Result<PicturePair, PictureError> {
        let (color, (name, depth)) =
            (decode(color.0, color.1)?.into_rgba8(), (depth.0, decode(depth.0, depth.1)?));
        let (size, depth_size) = (color.dimensions().into(), [depth.width(), depth.height()]);
        if size != depth_size {
            return Err(PictureError::Sizes(size, depth_size));
        }
        if depth.color().has_color()
            && depth.to_rgb16().pixels().any(|p| p.0[0] != p.0[1] || p.0[0] != p.0[2])
        {
            return Err(PictureError::NotGrey(name.into()));
        }
        let depth = match depth.color().has_color() {
            // Of equal channels the first is the grey, to the bit.
            true => depth.to_rgb16().rows().rev().flatten().map(|p| p.0[0]).collect::<Vec<_>>(),
            false => depth.into_luma16().rows().rev().flatten().map(|p| p.0[0]).collect(),
        };
        let rgba = color.rows().rev().flatten().flat_map(|p| [p.0[0], p.0[1], p.0[2], 255]).collect();
        Ok(PicturePair { size, rgba, stored: depth.into_iter().map(|v| f32::from(v) / 65535.0).collect() })
    }

    /// What the depth stands for, for eyes `ipd` metres apart.
    ///
    /// # Errors
    /// [`PictureError`] for options that cannot be, and for values that they do not fit.
    pub fn nearness(&self, options: &PictureOptions, ipd: f32) -> Result<Nearness, PictureError> {
        let refuse = |condition: bool, text: &str| match condition {
            true => Err(PictureError::Option(text.into())),
            false => Ok(()),
        };
        refuse(
            !(options.near > 0.0 && options.near < options.far),
            "the near plane must be nearer than the far plane",
        )?;
        refuse(!(options.gamma > 0.0 && options.gamma.is_finite()), "the power must be greater than 0")?;
        refuse(
            options.metres_at_white.is_nan() || options.metres_at_white <= 0.0,
            "the distance at white must be greater than 0",
        )?;
        refuse(
            options.disparity_scale.is_nan() || options.disparity_scale < 0.0,
            "the disparity's scale must be 0 or more: larger values are nearer",
        )?;
        refuse(
            !(1.0..=170.0).contains(&options.fov_y_degrees),
            "the field of view must be between 1 and 170 degrees",
        )?;
        let focal_length = 0.5 * f64::from(self.size[1]) / (0.5 * options.fov_y_degrees.to_radians()).tan();
        let range = |convention| DepthRange { near: options.near, far: options.far, convention };
        let encoding = match options.encoding {
            Encoding::StandardZ => StoredDepth::Window(range(DepthConvention::Standard)),
            Encoding::ReversedZ => StoredDepth::Window(range(DepthConvention::Reversed)),
            Encoding::Metres => StoredDepth::Distance { unit: options.metres_at_white },
            Encoding::Disparity => {
                StoredDepth::Disparity { offset: options.disparity_offset, scale: options.disparity_scale }
            }
        };
        let stored = self.stored.iter().map(|v| v.powf(options.gamma));
        Ok(encoding.decode(stored, focal_length * f64::from(ipd))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, ImageFormat, Luma, Rgb, RgbImage};

    fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    fn color(w: u32, h: u32) -> Vec<u8> {
        png(RgbImage::from_fn(w, h, |x, y| Rgb([x as u8, y as u8, 7])))
    }

    #[test]
    fn a_pair_is_decoded_from_the_bottom() {
        let depth = png(GrayImage::from_fn(4, 2, |x, y| Luma([if y == 1 { 255 } else { x as u8 }])));
        let pair = PicturePair::decode(("c.png", &color(4, 2)), ("d.png", &depth)).unwrap();
        assert_eq!(pair.size, [4, 2]);
        assert_eq!(pair.rgba[..8], [0, 1, 7, 255, 1, 1, 7, 255]);
        assert_eq!(pair.stored[..4], [1.0; 4]);
        let options =
            PictureOptions { encoding: Encoding::Disparity, disparity_scale: 3.0, ..Default::default() };
        let nearness = pair.nearness(&options, 0.063).unwrap();
        assert_eq!((nearness.law.scale, nearness.values[0]), (3.0, 1.0));
        for wrong in [
            PictureOptions { near: 5.0, far: 1.0, ..options },
            PictureOptions { gamma: 0.0, ..options },
            PictureOptions { fov_y_degrees: f64::NAN, ..options },
            PictureOptions { disparity_scale: -1.0, ..options },
        ] {
            assert!(pair.nearness(&wrong, 0.063).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn files_that_are_none() {
        let (good, gray) = (color(4, 2), png(GrayImage::new(4, 3)));
        let error = |c: &[u8], d: &[u8]| PicturePair::decode(("c", c), ("d", d)).unwrap_err().to_string();
        assert!(error(&good, &gray).contains("4x2") && error(&good, &gray).contains("4x3"));
        assert!(error(&good, b"text").starts_with("d is no picture"));
        assert!(error(&good[..40], &gray).starts_with("c is no picture"));
        assert!(error(&good, &good).contains("colour picture"));
    }
}
