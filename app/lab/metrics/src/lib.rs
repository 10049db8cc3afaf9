//! Similarity of two images, and a stand-in for the [frames between renders](SubmittedEye) that a headset's runtime makes.
//!
//! All figures are computed in f64 from display-referred 8-bit values, with a data range of 255. PSNR and SSIM agree
//! with scikit-image's `peak_signal_noise_ratio` and `structural_similarity`, FLIP with its authors' program.

mod error_map;
mod flicker;
mod flip;
mod frame_synthesis;
mod input;
mod psnr;
mod ssim;

pub use error_map::{error_color, error_map};
pub use flicker::{Flicker, FlickerMeter};
pub use flip::{FLIP_PIXELS_PER_DEGREE, flip, flip_map};
pub use frame_synthesis::{EyeCamera, EyePose, SubmittedEye};
use input::check_mask;
pub use input::{Channels, MetricsError};
pub use psnr::{Psnr, psnr, psnr_where};
pub use ssim::{SsimWindow, dissimilarity_map, ssim, ssim_where};
use ssim::{mean_inside, ssim_map};

use image::{GrayImage, RgbImage};
use serde::{Deserialize, Serialize};

/// The similarity of two images.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Peak signal-to-noise ratio.
    pub psnr: Psnr,
    /// SSIM with the window [`SsimWindow::Gaussian11`].
    pub ssim_gaussian: f64,
    /// SSIM with the window [`SsimWindow::Uniform7`].
    pub ssim_uniform: f64,
}

impl Quality {
    /// Measures `a` against `b`.
    ///
    /// # Errors
    /// [`MetricsError::SizesDiffer`] and [`MetricsError::TooSmall`].
    pub fn of(a: &RgbImage, b: &RgbImage, channels: Channels) -> Result<Quality, MetricsError> {
        Ok(Quality {
            psnr: psnr(a, b, channels)?,
            ssim_gaussian: ssim(a, b, SsimWindow::Gaussian11, channels)?,
            ssim_uniform: ssim(a, b, SsimWindow::Uniform7, channels)?,
        })
    }

    /// Returns the mean of each figure; `None` if there are none. Identical pairs have no finite PSNR: they are left
    /// out of its mean (which is infinite if all pairs are identical), but not out of the means of SSIM.
    pub fn mean<'a>(all: impl IntoIterator<Item = &'a Quality>) -> Option<Quality> {
        let all: Vec<&Quality> = all.into_iter().collect();
        let mean_of = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
        if all.is_empty() {
            return None;
        }
        Some(Quality {
            psnr: Psnr::mean(all.iter().map(|q| q.psnr)),
            ssim_gaussian: mean_of(all.iter().map(|q| q.ssim_gaussian).collect()),
            ssim_uniform: mean_of(all.iter().map(|q| q.ssim_uniform).collect()),
        })
    }
}

/// The similarity of two images in the part that a mask selects.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartQuality {
    /// The share of the image's pixels that are selected, 0 to 1.
    pub share: f64,
    /// PSNR over these pixels (RGB); `None` if there are none.
    pub psnr: Option<Psnr>,
    /// Mean of the gaussian SSIM map (RGB) over these pixels, without the border; `None` if there are none.
    pub ssim_gaussian: Option<f64>,
    /// Mean of the FLIP map over these pixels; `None` if there are none.
    pub flip: Option<f64>,
}

/// Everything that `yoro compare` reports about a pair.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// True if no sample differs. The PSNR is then infinite.
    pub identical: bool,
    /// The similarity of red, green and blue.
    pub rgb: Quality,
    /// The similarity of luma.
    pub luma: Quality,
    /// LDR-FLIP, mean over the image, from 0 (equal) to 1; see [`flip_map`].
    pub flip: f64,
    /// Quality in the disoccluded pixels, if a mask was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holes: Option<PartQuality>,
    /// Quality in all other pixels, if a mask was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elsewhere: Option<PartQuality>,
}

impl Comparison {
    /// Measures `a` against `b`. `holes` has the rows from the top, true where a pixel was disoccluded.
    ///
    /// # Errors
    /// [`MetricsError::SizesDiffer`], [`MetricsError::TooSmall`] and [`MetricsError::MaskSize`].
    pub fn of(a: &RgbImage, b: &RgbImage, holes: Option<&[bool]>) -> Result<Comparison, MetricsError> {
        let window = SsimWindow::Gaussian11;
        let structure = ssim_map(a, b, window, Channels::Rgb)?;
        let appearance = flip_map(a, b, FLIP_PIXELS_PER_DEGREE)?;
        let mean_where = |selected: &dyn Fn(usize) -> bool| {
            let chosen: Vec<f64> =
                (0..appearance.len()).filter(|i| selected(*i)).map(|i| f64::from(appearance[i])).collect();
            (!chosen.is_empty()).then(|| chosen.iter().sum::<f64>() / chosen.len() as f64)
        };
        let part = |wanted: bool| -> Result<Option<PartQuality>, MetricsError> {
            let Some(holes) = holes else { return Ok(None) };
            check_mask(a, holes)?;
            let selected: Vec<bool> = holes.iter().map(|hole| *hole == wanted).collect();
            let count = selected.iter().filter(|selected| **selected).count();
            Ok(Some(PartQuality {
                share: count as f64 / selected.len() as f64,
                psnr: psnr_where(a, b, &selected)?,
                ssim_gaussian: mean_inside(&structure, a, window, |at| selected[at]),
                flip: mean_where(&|at| selected[at]),
            }))
        };
        let ssim_gaussian = mean_inside(&structure, a, window, |_| true);
        Ok(Comparison {
            identical: a == b,
            rgb: Quality {
                psnr: psnr(a, b, Channels::Rgb)?,
                ssim_gaussian: ssim_gaussian.expect("an image as large as the window has a middle"),
                ssim_uniform: ssim(a, b, SsimWindow::Uniform7, Channels::Rgb)?,
            },
            luma: Quality::of(a, b, Channels::Luma)?,
            flip: mean_where(&|_| true).expect("an image has pixels"),
            holes: part(true)?,
            elsewhere: part(false)?,
        })
    }
}

/// Returns which pixels of a mask image are holes: the dark ones (below 128) if `dark_is_hole`, as in the paper's data
/// set, or else the bright ones.
pub fn holes_of_mask(mask: &GrayImage, dark_is_hole: bool) -> Vec<bool> {
    mask.as_raw().iter().map(|value| (*value < 128) == dark_is_hole).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use image::Rgb;

    /// A deterministic image: curved ramps with noise from a linear congruential generator.
    pub(crate) fn image(width: u32, height: u32, seed: u32) -> RgbImage {
        let mut state = seed;
        RgbImage::from_fn(width, height, |x, y| {
            Rgb(std::array::from_fn(|c| {
                let c = c as u32;
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                ((x * x / 3 + y * 5 * (c + 1) + x * y * c / 4) % 200 + (state >> 24) % 56) as u8
            }))
        })
    }

    /// Two images whose upper third is equal.
    pub(crate) fn pair(width: u32, height: u32) -> (RgbImage, RgbImage) {
        let (a, mut b) = (image(width, height, 1), image(width, height, 2));
        for y in 0..height / 3 {
            for x in 0..width {
                b.put_pixel(x, y, *a.get_pixel(x, y));
            }
        }
        (a, b)
    }

    fn near(ours: f64, reference: f64) {
        assert!((ours - reference).abs() < 1e-9, "{ours} is not {reference}");
    }

    /// A size of the pair above, and scikit-image 0.26.0's results for it.
    struct Reference {
        size: (u32, u32),
        /// RGB, luma.
        psnr: [f64; 2],
        /// RGB, luma: gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255.
        gaussian: [f64; 2],
        /// RGB, luma: data_range=255, everything else by default.
        uniform: [f64; 2],
        /// 1 - the mean over the channels of the full gaussian map at (0, h - 1), (5, 5), (w - 1, h / 2).
        map: [f64; 3],
    }

    const SCIKIT_IMAGE_0_26_0: [Reference; 3] = [
        Reference {
            size: (11, 11),
            psnr: [22.436064937286627, 25.5520034376151],
            gaussian: [0.6315887840681788, 0.7739511834064171],
            uniform: [0.7290220082400328, 0.8511770855005183],
            map: [0.7967303481905438, 0.36841121593182125, 0.41685734196112734],
        },
        Reference {
            size: (37, 29),
            psnr: [22.63676727865191, 26.22265739787936],
            gaussian: [0.8608354980372629, 0.8952099254609682],
            uniform: [0.8952734827572782, 0.9257179020852229],
            map: [0.3231752776669259, 0.005744667808455617, 0.16642644066096712],
        },
        Reference {
            size: (64, 48),
            psnr: [22.905875909725136, 26.447811319976402],
            gaussian: [0.9178394903630238, 0.9322869859396969],
            uniform: [0.9318994575348345, 0.9446394648830406],
            map: [0.553440771315032, 0.0, 0.06366941743673571],
        },
    ];

    #[test]
    fn agrees_with_scikit_image() {
        for reference in &SCIKIT_IMAGE_0_26_0 {
            let (w, h) = reference.size;
            let (a, b) = pair(w, h);
            for (i, channels) in [Channels::Rgb, Channels::Luma].into_iter().enumerate() {
                let quality = Quality::of(&a, &b, channels).unwrap();
                near(quality.psnr.0, reference.psnr[i]);
                near(quality.ssim_gaussian, reference.gaussian[i]);
                near(quality.ssim_uniform, reference.uniform[i]);
            }
            let map = dissimilarity_map(&a, &b).unwrap();
            for ((x, y), expected) in [(0, h - 1), (5, 5), (w - 1, h / 2)].into_iter().zip(reference.map) {
                near(map[(y * w + x) as usize], expected);
            }
        }
    }

    #[test]
    fn identical_images() {
        let a = image(20, 20, 3);
        let same = Comparison::of(&a, &a, None).unwrap();
        assert!(same.identical);
        assert_eq!(same.rgb, Quality { psnr: Psnr(f64::INFINITY), ssim_gaussian: 1.0, ssim_uniform: 1.0 });
        let json = serde_json::to_string(&same).unwrap();
        assert!(json.contains(r#""identical":true,"rgb":{"psnr":null,"#), "{json}");
        assert_eq!(serde_json::from_str::<Comparison>(&json).unwrap(), same);
    }

    #[test]
    fn a_mask_splits_the_error() {
        let (a, mut b) = (image(32, 24, 1), image(32, 24, 1));
        let mut mask = GrayImage::from_pixel(32, 24, image::Luma([255]));
        for (x, y) in [(8, 9), (9, 9), (20, 12)] {
            b.get_pixel_mut(x, y).0[1] ^= 16;
            mask.put_pixel(x, y, image::Luma([0]));
        }
        let holes = holes_of_mask(&mask, true);
        let parts = Comparison::of(&a, &b, Some(&holes)).unwrap();
        let (inside, outside) = (parts.holes.unwrap(), parts.elsewhere.unwrap());
        // One of three channels differs by 16.
        near(inside.psnr.unwrap().0, 10.0 * (255.0f64 * 255.0 * 3.0 / 256.0).log10());
        assert_eq!(outside.psnr, Some(Psnr(f64::INFINITY)));
        near(inside.share, 3.0 / 768.0);
        assert!(inside.ssim_gaussian.unwrap() < outside.ssim_gaussian.unwrap());

        let nothing = Comparison::of(&a, &b, Some(&[false; 768])).unwrap();
        assert_eq!(nothing.holes.unwrap().psnr, None);
        assert_eq!(nothing.holes.unwrap().ssim_gaussian, None);
        near(nothing.elsewhere.unwrap().psnr.unwrap().0, nothing.rgb.psnr.0);
        near(nothing.elsewhere.unwrap().ssim_gaussian.unwrap(), nothing.rgb.ssim_gaussian);
        assert_eq!(
            Comparison::of(&a, &b, Some(&[true; 5])).unwrap_err(),
            MetricsError::MaskSize { mask: 5, image: 768 }
        );
    }

    #[test]
    fn sizes_are_checked() {
        let a = image(20, 20, 1);
        let error = Quality::of(&a, &image(20, 21, 1), Channels::Rgb).unwrap_err();
        assert_eq!(error, MetricsError::SizesDiffer { a: (20, 20), b: (20, 21) });
        let small = image(10, 30, 1);
        let error = Quality::of(&small, &small, Channels::Rgb).unwrap_err();
        assert_eq!(error, MetricsError::TooSmall { width: 10, height: 30, window: 11 });
        assert!(ssim(&small, &small, SsimWindow::Uniform7, Channels::Rgb).is_ok());
    }

    #[test]
    fn the_mean_leaves_identical_pairs_out_of_the_psnr_only() {
        let quality = |psnr, ssim| Quality { psnr: Psnr(psnr), ssim_gaussian: ssim, ssim_uniform: ssim };
        let all = [quality(30.0, 0.8), quality(f64::INFINITY, 1.0), quality(34.0, 0.9)];
        let mean = Quality::mean(&all).unwrap();
        near(mean.psnr.0, 32.0);
        near(mean.ssim_gaussian, 0.9);
        assert_eq!(Quality::mean(&all[1..2]).unwrap().psnr, Psnr(f64::INFINITY));
        assert_eq!(Quality::mean(&[]), None);
    }
}
