//! A user's own colour and depth picture, with the depth options of `yoro synthesize`.

use std::path::Path;

use serde::Deserialize;
use yoro::eyes::{DepthConvention, DepthRange, Eye};
use yoro_media::{DepthSamples, Nearness, StoredDepth, StoredDepthError, load_color, load_depth};

/// The meaning of the values of a depth picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Encoding {
    /// Depth buffer, 0 near to 1 far.
    #[default]
    StandardZ,
    /// Depth buffer, 1 near to 0 far.
    ReversedZ,
    /// Distance in metres: in an EXR file as stored, in other files multiplied by [`PictureOptions::metres_at_white`].
    Metres,
    /// Disparity in pixels, by [`PictureOptions::disparity_offset`] and [`PictureOptions::disparity_scale`].
    Disparity,
}

/// The eye that the pictures show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SourceEye {
    /// The left eye; the right one is synthesized.
    Left,
    /// The right eye; the left one is synthesized.
    #[default]
    Right,
    /// Neither eye: both are synthesized.
    Center,
}

impl SourceEye {
    /// Returns the eyes to synthesize, each with its distance from the pictures' viewpoint as a share of the IPD.
    pub fn targets(self) -> &'static [(Eye, f64)] {
        match self {
            SourceEye::Right => &[(Eye::Left, 1.0)],
            SourceEye::Left => &[(Eye::Right, 1.0)],
            SourceEye::Center => &[(Eye::Left, 0.5), (Eye::Right, 0.5)],
        }
    }
}

/// The options of `yoro synthesize`, with its defaults.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PictureOptions {
    /// The eye that the pictures show.
    pub source: SourceEye,
    /// The meaning of the depth values.
    pub encoding: Encoding,
    /// The exponent that is applied to stored values first.
    pub gamma: f32,
    /// Near plane in metres.
    pub near: f32,
    /// Far plane in metres.
    pub far: f32,
    /// Distance in metres of the largest value, in a file of integers.
    pub metres_at_white: f32,
    /// Disparity in pixels at value 0.
    pub disparity_offset: f64,
    /// Increase of the disparity in pixels from value 0 to 1.
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

/// A reason why two pictures cannot be used, as a sentence.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// An option is out of range, or the pictures differ in size.
    #[error("{0}")]
    Unusable(String),
    /// A file is not a picture, or not of the required kind.
    #[error(transparent)]
    File(#[from] yoro_media::PictureError),
    /// The depth values do not fit their encoding.
    #[error("the depth picture does not fit its encoding: {0}")]
    Values(#[from] StoredDepthError),
}

/// Decoded pictures, rows from the bottom.
#[derive(Debug)]
pub struct PicturePair {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Colour, 4 bytes per pixel.
    pub rgba: Vec<u8>,
    /// Depth values as stored.
    stored: Vec<f32>,
    samples: DepthSamples,
}

impl PicturePair {
    /// Decodes two files, as `yoro synthesize` does.
    pub fn load(color: &Path, depth: &Path) -> Result<PicturePair, PictureError> {
        let (color, depth) = (load_color(color)?, load_depth(depth)?);
        let ([width, height], [w, h]) = (color.dimensions().into(), depth.image.dimensions().into());
        if [width, height] != [w, h] {
            return Err(PictureError::Unusable(format!(
                "the colour picture is {width}x{height} pixels and the depth picture {w}x{h}: both must have one size"
            )));
        }
        Ok(PicturePair {
            size: [width, height],
            rgba: color.rows().rev().flatten().flat_map(|p| [p.0[0], p.0[1], p.0[2], 255]).collect(),
            stored: depth.image.rows().rev().flatten().map(|p| p.0[0]).collect(),
            samples: depth.samples,
        })
    }

    /// Returns the pixels' nearness for eyes `ipd` metres apart.
    ///
    /// # Errors
    /// [`PictureError`] for invalid options, and for values that do not fit them.
    pub fn nearness(&self, options: &PictureOptions, ipd: f32) -> Result<Nearness, PictureError> {
        let refuse = |condition: bool, text: &str| {
            if condition { Err(PictureError::Unusable(text.into())) } else { Ok(()) }
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
            Encoding::Metres => StoredDepth::Distance {
                unit: match self.samples {
                    DepthSamples::Normalized { .. } => options.metres_at_white,
                    DepthSamples::Float => 1.0,
                },
            },
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
    use image::{GrayImage, Luma, Rgb, RgbImage};
    use yoro_media::{DepthImage, save_color, save_depth, save_gray};

    #[test]
    fn a_pair_is_decoded_from_the_bottom() {
        let folder = tempfile::tempdir().unwrap();
        let [color, gray, metres, taller] =
            ["c.png", "d.png", "d.exr", "e.png"].map(|name| folder.path().join(name));
        save_color(&color, &RgbImage::from_fn(4, 2, |x, y| Rgb([x as u8, y as u8, 7]))).unwrap();
        let depth = GrayImage::from_fn(4, 2, |x, y| Luma([if y == 1 { 255 } else { x as u8 }]));
        save_gray(&gray, &depth).unwrap();
        let pair = PicturePair::load(&color, &gray).unwrap();
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

        // The distance of white does not affect metres in EXR files.
        save_depth(&metres, &DepthImage::from_pixel(4, 2, Luma([2.0]))).unwrap();
        let pair = PicturePair::load(&color, &metres).unwrap();
        let options = PictureOptions { encoding: Encoding::Metres, metres_at_white: 9.0, ..options };
        assert_eq!(pair.nearness(&options, 0.063).unwrap().values, [0.5; 8]);

        save_gray(&taller, &GrayImage::new(4, 3)).unwrap();
        let error = PicturePair::load(&color, &taller).unwrap_err().to_string();
        assert!(error.contains("4x2") && error.contains("4x3"), "{error}");
    }
}
