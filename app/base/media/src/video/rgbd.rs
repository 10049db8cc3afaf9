//! The description of an RGBD video's depth, as a box in the MP4 file.

use image::{GrayImage, Luma, RgbImage};
use serde::{Deserialize, Serialize};
use yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyeOptions, EyePair, EyesError, GuardBand, Pose, SynthesisViews,
};

use super::Planes;

/// The type of the `uuid` box in a video's `avc1` sample entry that contains an [`Rgbd`] as JSON.
pub const DEPTH_BOX: [u8; 16] = *b"yoro RGBD video1";

/// The description of an RGBD video. Its pictures have the rendered eye's colour on the left and its depth, as luma, on
/// the right. Depth has 8 bits, from 0 at [`Rgbd::farthest`] to 255 at [`Rgbd::nearest`], uniform in 1/z: a reversed
/// depth buffer between these planes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rgbd {
    /// Width and height of each eye in pixels. The rendered eye is wider by its guard band.
    pub size: [u32; 2],
    /// The rendered eye.
    pub eye: Eye,
    /// Additional columns of the rendered eye, on the side of the other eye.
    pub guard_columns: u32,
    /// Vertical field of view in radians.
    pub fov_y: f32,
    /// Outer and inner half-angle in radians, for asymmetric frusta.
    pub outer_inner: Option<[f32; 2]>,
    /// Distance between the eyes in metres.
    pub ipd: f32,
    /// Distance in metres of the value 255.
    pub nearest: f32,
    /// Distance in metres of the value 0.
    pub farthest: f32,
}

impl Rgbd {
    /// Returns the views by which the other eye is synthesized from a picture.
    ///
    /// # Errors
    /// [`EyesError`] if the numbers do not describe a valid pair of eyes.
    pub fn views(&self) -> Result<SynthesisViews, EyesError> {
        self.pair().synthesis_views(GuardBand::Pixels(self.guard_columns))
    }

    /// Returns the two eyes, with the head at the origin.
    pub fn pair(&self) -> EyePair {
        let depth =
            DepthRange { near: self.nearest, far: self.farthest, convention: DepthConvention::Reversed };
        let &Rgbd { size, fov_y, ipd, eye: dominant, outer_inner, .. } = self;
        EyeOptions { size, fov_y, ipd, dominant, depth, outer_inner }.pair(Pose::IDENTITY)
    }

    /// True if all numbers are in the range that a renderer can produce.
    pub(crate) fn is_valid(&self) -> bool {
        let sides = self.size.iter().all(|side| (1..=16384).contains(side));
        let angles = [Some(self.fov_y), self.outer_inner.map(|a| a[0] + a[1])];
        let angles = angles.into_iter().flatten().all(|angle| angle > 0.0 && angle < std::f32::consts::PI);
        let planes = 0.0 < self.nearest && self.nearest < self.farthest && self.farthest.is_finite();
        sides && self.guard_columns <= self.size[0] && angles && (0.0..1000.0).contains(&self.ipd) && planes
    }

    /// Packs colour and depth into one picture. `distance` returns the distances of the colour's pixels in metres along
    /// the viewing axis, rows from the top.
    pub fn pack(&self, color: &RgbImage, distance: impl Fn(u32, u32) -> f32) -> Planes {
        let depth =
            GrayImage::from_fn(color.width(), color.height(), |x, y| Luma([self.quantize(distance(x, y))]));
        Planes::of_rgb(color).beside(&Planes::of_gray(&depth))
    }

    /// Splits a picture into colour and depth, both of the size of the rendered eye with its guard band.
    #[cfg(feature = "codec")]
    pub(crate) fn unpack(&self, picture: &Planes) -> (RgbImage, GrayImage) {
        let [color, depth] = picture.halves();
        let size = (self.size[0] + self.guard_columns, self.size[1]);
        (color.rgb(size), depth.gray(size))
    }

    pub(crate) fn quantize(&self, distance: f32) -> u8 {
        depth_luma(distance, [self.nearest, self.farthest])
    }
}

/// Returns the luma for a distance in metres: uniform in 1/z, from 255 at the nearest to 0 at the farthest.
pub fn depth_luma(distance: f32, span: [f32; 2]) -> u8 {
    let [near, far] = span.map(f32::recip);
    ((distance.recip() - far) / (near - far) * 255.0).round().clamp(0.0, 255.0) as u8
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use image::Rgb;
    use yoro::eyes::MEAN_IPD;

    pub(crate) const RGBD: Rgbd = Rgbd {
        size: [60, 32],
        eye: Eye::Right,
        guard_columns: 4,
        fov_y: 1.0,
        outer_inner: None,
        ipd: MEAN_IPD,
        nearest: 0.5,
        farthest: 100.0,
    };

    #[test]
    fn depth_is_uniform_in_inverse_distance_and_its_ends_are_exact() {
        for value in 0..=255u8 {
            let share = f32::from(value) / 255.0;
            let distance = 1.0 / (share / RGBD.nearest + (1.0 - share) / RGBD.farthest);
            assert_eq!(RGBD.quantize(distance), value);
        }
        assert_eq!([0.1, 1e6, f32::INFINITY].map(|distance| RGBD.quantize(distance)), [255, 0, 0]);
    }

    #[test]
    fn a_picture_is_as_wide_as_the_rendered_eye_and_its_depth() {
        let views = RGBD.views().unwrap();
        assert_eq!(views.source.size, [64, 32]);
        let color = RgbImage::from_pixel(64, 32, Rgb([90, 90, 90]));
        let picture = RGBD.pack(&color, |x, _| 1.0 + x as f32);
        assert_eq!(picture.size, [128, 32]);
        let (back, depth) = RGBD.unpack(&picture);
        assert_eq!(back, color);
        assert_eq!(depth.get_pixel(7, 3).0, [RGBD.quantize(8.0)]);
    }
}
