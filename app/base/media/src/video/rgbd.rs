//! The description of an RGBD video's depth, as a box in the MP4 file.

use image::{GrayImage, Luma, RgbImage};
use serde::{Deserialize, Serialize};
use yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyeOptions, EyePair, EyesError, GuardBand, Pose, SynthesisViews,
};

use super::Planes;

/// The type of the `uuid` box in a video's `avc1` sample entry that contains an [`Rgbd`] as JSON.
pub const DEPTH_BOX: [u8; 16] = *b"yoro RGBD video1";

/// The longest side of a picture in pixels.
const LARGEST: u32 = 16384;

/// The description of an RGBD video. Its pictures have the rendered eye's colour on the left and its depth, as luma, on
/// the right. Depth has 8 bits, from 0 at [`Rgbd::farthest`] to 255 at [`Rgbd::nearest`], uniform in 1/z: a reversed
/// depth buffer between these planes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rgbd {
    /// Width and height of each eye in pixels. The picture of the rendered eye is wider by `guard_columns` and
    /// `outer_columns`, and by nothing else.
    pub size: [u32; 2],
    /// The rendered eye.
    pub eye: Eye,
    /// Columns that the picture has beyond the rendered eye's frustum, on the side of the other eye.
    pub guard_columns: u32,
    /// The same on the other side, where the other eye sees farther than the rendered one; 0 if the file says nothing.
    #[serde(default)]
    pub outer_columns: u32,
    /// Vertical field of view in radians.
    pub fov_y: f32,
    /// Outer and inner half-angle of the rendered eye in radians, for an asymmetric frustum.
    pub outer_inner: Option<[f32; 2]>,
    /// True if the other eye's frustum is the mirror image of the rendered eye's, as in headsets and if the file says
    /// nothing; false if it is the same, as for the picture of a single camera.
    #[serde(default = "yes")]
    pub mirrored: bool,
    /// Distance between the eyes in metres.
    pub ipd: f32,
    /// Distance in metres of the value 255.
    pub nearest: f32,
    /// Distance in metres of the value 0.
    pub farthest: f32,
}

fn yes() -> bool {
    true
}

impl Rgbd {
    /// Returns the views by which the other eye is synthesized from a picture. The source is what the picture covers: the
    /// rendered eye's frustum and the additional columns, whatever the other eye sees beyond.
    ///
    /// # Errors
    /// [`EyesError`] if the numbers do not describe a valid pair of eyes.
    pub fn views(&self) -> Result<SynthesisViews, EyesError> {
        let pair = self.pair();
        let mut views = pair.synthesis_views(GuardBand::None)?;
        let rendered = pair.view(self.eye);
        let [left, right] = match self.eye {
            Eye::Left => [self.outer_columns, self.guard_columns],
            Eye::Right => [self.guard_columns, self.outer_columns],
        };
        // Those views begin where either eye does. From other columns to the left, the target is as many pixels away.
        views.warp.law.offset += f64::from(views.dominant_crop[0]) - f64::from(left);
        let column = rendered.frustum.width() / self.size[0] as f32;
        let sides = [(rendered.frustum.left, -1.0, left), (rendered.frustum.right, 1.0, right)];
        let [left_side, right_side] =
            sides.map(|(side, sign, columns)| side + sign * columns as f32 * column);
        views.source = rendered;
        (views.source.frustum.left, views.source.frustum.right) = (left_side, right_side);
        views.source.size = self.picture();
        (views.warp.source_size, views.warp.row_offset) = (views.source.size, 0);
        (views.dominant_crop, views.guard_columns) = ([left, 0], self.guard_columns);
        views.warp.check()?;
        Ok(views)
    }

    /// Returns width and height in pixels of the rendered eye's picture.
    pub fn picture(&self) -> [u32; 2] {
        let [width, height] = self.size;
        [width.saturating_add(self.guard_columns).saturating_add(self.outer_columns), height]
    }

    /// Returns width and height in pixels of the video: picture and depth, each padded to an even size.
    pub(crate) fn coded(&self) -> [usize; 2] {
        let [width, height] = self.picture().map(|side| (side as usize).next_multiple_of(2));
        [2 * width, height]
    }

    /// Returns the two eyes, with the head at the origin.
    pub fn pair(&self) -> EyePair {
        let depth =
            DepthRange { near: self.nearest, far: self.farthest, convention: DepthConvention::Reversed };
        let &Rgbd { size, fov_y, ipd, eye: dominant, outer_inner, .. } = self;
        let mut pair = EyeOptions { size, fov_y, ipd, dominant, depth, outer_inner }.pair(Pose::IDENTITY);
        if !self.mirrored {
            pair.frusta = [pair.frusta[dominant.index()]; 2];
        }
        pair
    }

    /// True if all numbers are in the range that a renderer can produce.
    pub(crate) fn is_valid(&self) -> bool {
        let sides = self.size.iter().all(|side| (1..=LARGEST).contains(side));
        let angles = [Some(self.fov_y), self.outer_inner.map(|a| a[0] + a[1])];
        let angles = angles.into_iter().flatten().all(|angle| angle > 0.0 && angle < std::f32::consts::PI);
        let planes = 0.0 < self.nearest && self.nearest < self.farthest && self.farthest.is_finite();
        let fits = self.picture()[0] <= LARGEST;
        sides && fits && angles && (0.0..1000.0).contains(&self.ipd) && planes
    }

    /// Packs colour and depth into one picture. `distance` returns the distances of the colour's pixels in metres along
    /// the viewing axis, rows from the top.
    pub fn pack(&self, color: &RgbImage, distance: impl Fn(u32, u32) -> f32) -> Planes {
        let depth =
            GrayImage::from_fn(color.width(), color.height(), |x, y| Luma([self.quantize(distance(x, y))]));
        Planes::of_rgb(color).beside(&Planes::of_gray(&depth))
    }

    /// Splits a picture into colour and depth, both of the size of the rendered eye's picture.
    #[cfg(feature = "codec")]
    pub(crate) fn unpack(&self, picture: &Planes) -> (RgbImage, GrayImage) {
        let [color, depth] = picture.halves();
        let size = self.picture().into();
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
        outer_columns: 0,
        fov_y: 1.0,
        outer_inner: None,
        mirrored: true,
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

    #[test]
    fn the_source_is_what_the_picture_covers() {
        for (eye, angles, mirrored) in
            [(Eye::Right, [0.9, 0.7], true), (Eye::Left, [0.7, 0.9], true), (Eye::Left, [0.9, 0.7], false)]
        {
            let rgbd = Rgbd { eye, outer_columns: 6, outer_inner: Some(angles), mirrored, ..RGBD };
            let pair = rgbd.pair();
            let (views, own) = (rgbd.views().unwrap(), pair.view(eye).frustum);
            let column = own.width() / 60.0;
            let [left, right] = if eye == Eye::Left { [6.0, 4.0] } else { [4.0, 6.0] };
            assert_eq!((views.source.size, views.dominant_crop), ([70, 32], [left as u32, 0]));
            let source = views.source.frustum;
            assert!((source.left - (own.left - left * column)).abs() < 1e-5);
            assert!((source.right - (own.right + right * column)).abs() < 1e-5);
            // A surface at the distance z is at the same place in the target as by the two projections.
            for z in [0.5f32, 2.0, 100.0] {
                let tangent = 0.1f32;
                let from = (tangent - source.left) / column;
                let moved = eye.other().side() * rgbd.ipd / z;
                let target = pair.frusta[eye.other().index()];
                let to = (tangent - moved - target.left) / column;
                let share = (1.0 / z - 0.01) / (1.0 / rgbd.nearest - 0.01);
                let shift = views.warp.law.displacement(f64::from(share));
                assert!(
                    (f64::from(from) + shift - f64::from(to)).abs() < 1e-2,
                    "{eye:?} {z} m: {from} {to} {shift}"
                );
            }
        }
    }

    #[test]
    fn a_file_that_says_nothing_of_newer_keys_is_as_before() {
        let old = r#"{"size":[60,32],"eye":"right","guard_columns":4,"fov_y":1.0,"outer_inner":null,"ipd":0.063,
            "nearest":0.5,"farthest":100.0}"#;
        assert_eq!(serde_json::from_str::<Rgbd>(old).unwrap(), RGBD);
    }
}
