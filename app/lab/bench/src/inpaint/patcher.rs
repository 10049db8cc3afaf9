//! The trait of patchers, with its input and output.

use std::time::Duration;

use anyhow::ensure;
use image::{GrayImage, Luma, Rgb, RgbImage};

use yoro::eyes::{DepthConvention, Eye, Warp};
use yoro::synthesis::SourceMapEntry;
use yoro_media::{DepthImage, rgb_image};
use yoro_render::stereo::SynthesizedImage;

/// The mask's value where nothing of the source is visible.
pub const HOLE: u8 = 0;
/// The mask's value everywhere else.
pub const VALID: u8 = 255;

/// The kinds of patchers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PatcherKind {
    /// Algorithm 3 of the paper, as corrected.
    Paper,
    /// The fill of the pipeline gather: five rows of the background's edge.
    Gather,
    /// Median of the valid neighbours in 5x5 pixels (Noori et al.).
    Median,
    /// Background filter of 29x29 pixels (Xiao et al. 2022).
    Xiao,
    /// Fast marching (Telea 2004), on the CPU.
    Telea,
    /// Continued isophotes (Bertalmio et al. 2001), on the CPU.
    NavierStokes,
    /// A small neural network from an ONNX file, on the CPU.
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

    /// Returns the name on the command line.
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

/// An image of one eye made from the other, with holes where nothing is known. Row 0 is at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Reprojected {
    pub(super) color: RgbImage,
    pub(super) mask: GrayImage,
    /// In pixels, larger for nearer surfaces and affine in inverse depth; 0 in holes, where it has no meaning.
    pub(crate) disparity: DepthImage,
    pub(super) eye: Eye,
}

impl Reprojected {
    /// Creates an image from display-referred colour, a mask ([`HOLE`] and [`VALID`]; anything but 0 is valid), and
    /// disparity in pixels, larger for nearer surfaces, all as seen by `eye`. Colour and disparity are set to 0 in
    /// holes.
    ///
    /// # Errors
    /// If the sizes differ, or all pixels are holes.
    pub fn new(
        mut color: RgbImage,
        mut mask: GrayImage,
        mut disparity: DepthImage,
        eye: Eye,
    ) -> anyhow::Result<Reprojected> {
        let sizes = [color.dimensions(), mask.dimensions(), disparity.dimensions()];
        let [of_color, of_mask, of_disparity] = sizes.map(|(width, height)| format!("{width}x{height}"));
        ensure!(
            sizes.iter().all(|&size| size == sizes[0]),
            "the reprojected image is {of_color} pixels, its mask {of_mask} and its disparity {of_disparity}: give three of one size"
        );
        let pixels = color.pixels_mut().zip(mask.pixels_mut()).zip(disparity.pixels_mut());
        for ((color, mask), disparity) in pixels {
            if mask.0[0] == HOLE {
                (*color, *disparity) = (Rgb([0; 3]), Luma([0.0]));
            } else {
                *mask = Luma([VALID]);
            }
        }
        ensure!(
            mask.pixels().any(|m| m.0[0] != HOLE),
            "all pixels are holes, nothing is there to fill them from: check the depth, or leave the image out"
        );
        Ok(Reprojected { color, mask, disparity, eye })
    }

    /// Creates an image from the output of a synthesis pipeline, without the pixels that the pipeline has filled.
    /// Disparity is 0 at the far plane.
    ///
    /// # Errors
    /// If nothing of the source is visible.
    pub fn from_synthesis(result: &SynthesizedImage, warp: &Warp) -> anyhow::Result<Reprojected> {
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

    /// Returns the mask, with [`HOLE`] and [`VALID`].
    pub fn mask(&self) -> &GrayImage {
        &self.mask
    }

    /// Returns the width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.color.dimensions().into()
    }

    /// True if the pixel is a hole.
    pub fn is_hole(&self, x: u32, y: u32) -> bool {
        self.mask.get_pixel(x, y).0[0] == HOLE
    }

    /// Returns the share of the pixels that are holes, 0 to 1.
    pub fn hole_share(&self) -> f64 {
        let holes = self.mask.pixels().filter(|m| m.0[0] == HOLE).count();
        holes as f64 / self.mask.len() as f64
    }
}

/// The wall-clock time of patching.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PatchTime {
    /// The time for filling the holes of an image that is where the patcher works: in textures, with the GPU idle
    /// before and after, or in memory.
    pub patching: Duration,
    /// The time for upload and readback; 0 on the CPU. In a real frame, CPU patchers would be the ones to need
    /// transfers.
    pub transfer: Duration,
}

/// An image without holes.
#[derive(Clone, Debug, PartialEq)]
pub struct Patched {
    /// The reprojected image with its holes filled.
    pub image: RgbImage,
    /// The time that patching took.
    pub time: PatchTime,
}

/// A way to fill holes.
pub trait Patcher {
    /// Fills every hole; all other pixels stay as they are, bit for bit.
    ///
    /// # Errors
    /// For an image beyond the driver's limits, and when a model cannot be run.
    fn patch(&mut self, image: &Reprojected) -> anyhow::Result<Patched>;
}

/// Returns for each row the nearest row that is `known`, which may be itself; the upper one if two are equally near.
pub(super) fn nearest_rows(height: u32, known: impl Fn(u32) -> bool) -> Vec<u32> {
    let nearest = |y: u32| {
        let around = |d: u32| [y.checked_sub(d), (y + d < height).then_some(y + d)];
        (0..height).flat_map(around).flatten().find(|&y| known(y)).unwrap_or(y)
    };
    (0..height).map(nearest).collect()
}

/// Returns the indices, row by row, of a pixel and of those around it.
pub(super) fn around(i: usize, size: [u32; 2]) -> impl Iterator<Item = usize> {
    let [width, height] = size.map(|n| n as usize);
    let (x, y) = (i % width, i / width);
    let columns = x.saturating_sub(1)..(x + 2).min(width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    rows.flat_map(move |v| columns.clone().map(move |u| v * width + u))
}
