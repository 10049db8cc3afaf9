//! The trait of patchers, with its input, output and errors.

use std::time::Duration;

use image::{GrayImage, Luma, Rgb, RgbImage};

use crate::picture::{DepthImage, rgb_image};
use yoro::eyes::{DepthConvention, Eye, Warp};
use yoro::synthesis::SourceMapEntry;
use yoro_files::FileError;
use yoro_gl::GlError;
use yoro_render::stereo::SynthesizedImage;

/// Value of a mask where nothing of the source is seen.
pub const HOLE: u8 = 0;
/// Value of a mask everywhere else.
pub const VALID: u8 = 255;

/// The error when holes cannot be filled.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InpaintError {
    /// Colour, mask and disparity differ in size.
    #[error(
        "the reprojected image is {}x{} pixels, its mask {}x{} and its disparity {}x{}: give three of one size",
        color[0], color[1], mask[0], mask[1], disparity[0], disparity[1]
    )]
    SizesDiffer {
        /// Size of the colour image in pixels.
        color: [u32; 2],
        /// Size of the mask in pixels.
        mask: [u32; 2],
        /// Size of the disparity in pixels.
        disparity: [u32; 2],
    },
    /// No valid pixel.
    #[error(
        "all pixels are holes, nothing is there to fill them from: check the depth, or leave the image out"
    )]
    NothingValid,
    /// The model's file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The model is not what the neural patcher can run.
    #[error(
        "{model} is not a model for this patcher ({reason}): give an ONNX file made by training/train.py"
    )]
    Model {
        /// The file, or "the built-in model".
        model: String,
        /// The mistake in it.
        reason: String,
    },
    /// The neural patcher is a feature of the build.
    #[error("this build has no neural patcher: build with the feature neural, or choose another patcher")]
    NotBuilt,
    /// GL refused.
    #[error(transparent)]
    Gl(#[from] GlError),
}

/// The patchers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PatcherKind {
    /// Algorithm 3 of the paper, as corrected
    Paper,
    /// The fill of the pipeline gather: five rows of the background's edge
    Gather,
    /// Median of the valid ones of 5x5 neighbours (Noori et al.)
    Median,
    /// Background filter of 29x29 pixels (Xiao et al. 2022)
    Xiao,
    /// Fast marching (Telea 2004), on the CPU
    Telea,
    /// Isophotes carried on (Bertalmio et al. 2001), on the CPU
    NavierStokes,
    /// A small neural network from an ONNX file, on the CPU
    Neural,
}

impl PatcherKind {
    /// All patchers.
    pub const ALL: [PatcherKind; 7] = [
        PatcherKind::Paper,
        PatcherKind::Gather,
        PatcherKind::Median,
        PatcherKind::Xiao,
        PatcherKind::Telea,
        PatcherKind::NavierStokes,
        PatcherKind::Neural,
    ];

    /// Returns its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            PatcherKind::Paper => "paper",
            PatcherKind::Gather => "gather",
            PatcherKind::Median => "median",
            PatcherKind::Xiao => "xiao",
            PatcherKind::Telea => "telea",
            PatcherKind::NavierStokes => "navier-stokes",
            PatcherKind::Neural => "neural",
        }
    }
}

/// An image of one eye made from the other, with holes where nothing is known. Row 0 is the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Reprojected {
    pub(super) color: RgbImage,
    pub(super) mask: GrayImage,
    pub(super) disparity: DepthImage,
    pub(super) eye: Eye,
}

impl Reprojected {
    /// Makes an image of display-referred colour, a mask ([`HOLE`] and [`VALID`]; anything but 0 is valid), and
    /// disparity in pixels, larger for nearer surfaces, all as seen from `eye`. What colour and disparity say in holes
    /// is thrown away: both are 0 there afterwards.
    ///
    /// # Errors
    /// [`InpaintError::SizesDiffer`]; [`InpaintError::NothingValid`] when nothing but holes is given.
    pub fn new(
        mut color: RgbImage,
        mut mask: GrayImage,
        mut disparity: DepthImage,
        eye: Eye,
    ) -> Result<Reprojected, InpaintError> {
        let sizes = [color.dimensions(), mask.dimensions(), disparity.dimensions()];
        if sizes.iter().any(|&size| size != sizes[0]) {
            let [color, mask, disparity] = sizes.map(<[u32; 2]>::from);
            return Err(InpaintError::SizesDiffer { color, mask, disparity });
        }
        let pixels = color.pixels_mut().zip(mask.pixels_mut()).zip(disparity.pixels_mut());
        for ((color, mask), disparity) in pixels {
            if mask.0[0] == HOLE {
                (*color, *disparity) = (Rgb([0; 3]), Luma([0.0]));
            } else {
                *mask = Luma([VALID]);
            }
        }
        if mask.pixels().all(|m| m.0[0] == HOLE) {
            return Err(InpaintError::NothingValid);
        }
        Ok(Reprojected { color, mask, disparity, eye })
    }

    /// Makes an image of the output of a synthesis pipeline, without what it has filled in. Disparity is 0 at the far
    /// plane.
    ///
    /// # Errors
    /// [`InpaintError::NothingValid`] when the source is not seen at all.
    pub fn from_synthesis(result: &SynthesizedImage, warp: &Warp) -> Result<Reprojected, InpaintError> {
        let [width, height] = warp.target_size;
        let entry = |x: u32, y: u32| {
            let i = (height - 1 - y) as usize * width as usize + x as usize;
            SourceMapEntry::decode(result.source_map[i], x, warp)
        };
        let far = match warp.convention {
            DepthConvention::Standard => warp.law.displacement(1.0),
            DepthConvention::Reversed => warp.law.displacement(0.0),
        };
        let mask =
            GrayImage::from_fn(width, height, |x, y| Luma([if entry(x, y).hole { HOLE } else { VALID }]));
        let disparity = DepthImage::from_fn(width, height, |x, y| {
            Luma([-warp.target_eye.side() * (entry(x, y).displacement - far as f32)])
        });
        Reprojected::new(rgb_image(&result.rgba, warp.target_size), mask, disparity, warp.target_eye)
    }

    /// Returns the colour, black in holes.
    pub fn color(&self) -> &RgbImage {
        &self.color
    }

    /// Returns the mask, [`HOLE`] or [`VALID`].
    pub fn mask(&self) -> &GrayImage {
        &self.mask
    }

    /// Returns disparity in pixels, larger for nearer surfaces; affine in inverse depth. 0 in holes, where it means
    /// nothing.
    pub fn disparity(&self) -> &DepthImage {
        &self.disparity
    }

    /// The eye that it shows.
    pub fn eye(&self) -> Eye {
        self.eye
    }

    /// Returns width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.color.dimensions().into()
    }

    /// True if the pixel is a hole.
    pub fn is_hole(&self, x: u32, y: u32) -> bool {
        self.mask.get_pixel(x, y).0[0] == HOLE
    }

    /// Returns the share of the pixels that are holes.
    pub fn hole_share(&self) -> f64 {
        let holes = self.mask.pixels().filter(|m| m.0[0] == HOLE).count();
        holes as f64 / self.mask.len() as f64
    }
}

/// The time that patching took, by the wall clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PatchTime {
    /// Filling the holes of an image that lies where the patcher works: in textures, with the GPU drained before
    /// and after, or in memory.
    pub patching: Duration,
    /// Upload and readback; none on the CPU. In a frame it would be the CPU patchers that have to pay for it.
    pub transfer: Duration,
}

/// An image without holes.
#[derive(Clone, Debug, PartialEq)]
pub struct Patched {
    /// The reprojected image with its holes filled.
    pub image: RgbImage,
    /// The time that it took.
    pub time: PatchTime,
}

/// A way to fill holes.
pub trait Patcher {
    /// Fills every hole; all other pixels stay as they are, bit for bit.
    ///
    /// # Errors
    /// [`InpaintError::Gl`] for an image beyond the driver's limits; [`InpaintError::Model`] when a model cannot be
    /// run.
    fn patch(&mut self, image: &Reprojected) -> Result<Patched, InpaintError>;
}

/// Returns for each row itself if it is `known`, or else the nearest known row; the upper one when two are equally
/// near.
pub(super) fn nearest_rows(height: u32, known: impl Fn(u32) -> bool) -> Vec<u32> {
    let nearest = |y: u32| {
        let around = |d: u32| [y.checked_sub(d), (y + d < height).then_some(y + d)];
        (0..height).flat_map(around).flatten().find(|&y| known(y)).unwrap_or(y)
    };
    (0..height).map(nearest).collect()
}
