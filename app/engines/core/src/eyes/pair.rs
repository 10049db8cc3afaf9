//! The two eyes of a frame, and the views and displacements for synthesizing one from the other.

use glam::{Quat, Vec3};

use super::{DepthRange, DisparityMap, Eye, EyesError, Frustum, GuardBand, MEAN_IPD, Pose, View, Warp};

/// The largest width or height of an image in pixels. No driver renders larger ones.
const MAX_SIDE: f64 = 65536.0;

/// Options of two parallel eyes of equal size, as in the paper: they give an [`EyePair`] for any pose of the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeOptions {
    /// Size of each eye's image in pixels.
    pub size: [u32; 2],
    /// Vertical field of view in radians.
    pub fov_y: f32,
    /// Distance between the eyes in metres.
    pub ipd: f32,
    /// The eye that is rendered.
    pub dominant: Eye,
    /// Depth planes and encoding.
    pub depth: DepthRange,
    /// Outer and inner half-angle in radians, for asymmetric frusta; `None` for the width that follows from `fov_y`.
    pub outer_inner: Option<[f32; 2]>,
}

impl Default for EyeOptions {
    /// The paper's values: 60 degrees, 63 mm, the right eye, [`DepthRange::PAPER`].
    fn default() -> EyeOptions {
        EyeOptions {
            size: [1024; 2],
            fov_y: 60f32.to_radians(),
            ipd: MEAN_IPD,
            dominant: Eye::Right,
            depth: DepthRange::PAPER,
            outer_inner: None,
        }
    }
}

impl EyeOptions {
    /// Returns the two eyes around a head pose.
    pub fn pair(&self, head: Pose) -> EyePair {
        let symmetric = Frustum::symmetric(self.fov_y, self.size[0] as f32 / self.size[1] as f32);
        let mut pair = EyePair::parallel(head, symmetric, self.ipd, self.depth, self.size, self.dominant);
        if let Some([outer, inner]) = self.outer_inner.map(|angles| angles.map(f32::tan)) {
            pair.frusta[0] = Frustum { left: -outer, right: inner, ..symmetric };
            pair.frusta[1] = Frustum { left: -inner, right: outer, ..symmetric };
        }
        pair
    }
}

/// The two eyes of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EyePair {
    /// Pose of each eye in the world, indexed by [`Eye::index`].
    pub poses: [Pose; 2],
    /// Frustum of each eye.
    pub frusta: [Frustum; 2],
    /// Depth planes and encoding, the same for both.
    pub depth: DepthRange,
    /// Size in pixels of each eye's image.
    pub size: [u32; 2],
    /// The eye that is rendered.
    pub dominant: Eye,
}

impl EyePair {
    /// Returns parallel eyes around a head pose, with one frustum for both.
    pub fn parallel(
        head: Pose,
        frustum: Frustum,
        ipd: f32,
        depth: DepthRange,
        size: [u32; 2],
        dominant: Eye,
    ) -> EyePair {
        let poses = Eye::BOTH.map(|eye| head.translated_local(Vec3::X * (eye.side() * ipd * 0.5)));
        EyePair { poses, frusta: [frustum; 2], depth, size, dominant }
    }

    /// Returns the view of one eye.
    pub fn view(&self, eye: Eye) -> View {
        View {
            pose: self.poses[eye.index()],
            frustum: self.frusta[eye.index()],
            depth: self.depth,
            size: self.size,
        }
    }

    /// Returns the point halfway between the eyes.
    pub fn middle(&self) -> Vec3 {
        (self.poses[0].position + self.poses[1].position) * 0.5
    }

    /// Returns the distance between the eyes along their X axis, in metres.
    pub fn ipd(&self) -> f32 {
        (self.poses[1].position - self.poses[0].position).dot(self.poses[0].right())
    }

    /// Returns the eyes with frusta of equal width over the same rows, so that rows of pixels are aligned. Each frustum
    /// contains the original one.
    pub fn row_aligned(&self) -> EyePair {
        let [l, r] = self.frusta;
        let width = l.width().max(r.width());
        let (bottom, top) = (l.bottom.min(r.bottom), l.top.max(r.top));
        let grown = |f: Frustum| {
            let more = (width - f.width()) / 2.0;
            Frustum { left: f.left - more, right: f.right + more, bottom, top }
        };
        EyePair { frusta: self.frusta.map(grown), ..*self }
    }

    /// True if these eyes have the frusta of others, to a hundredth of a pixel.
    pub fn has_same_frusta(&self, other: &EyePair) -> bool {
        Eye::BOTH.iter().all(|eye| {
            let [own, other] = [self, other].map(|pair| pair.frusta[eye.index()]);
            let pixel = (own.width() / self.size[0] as f32).min(own.height() / self.size[1] as f32);
            let sides = [
                own.left - other.left,
                own.right - other.right,
                own.bottom - other.bottom,
                own.top - other.top,
            ];
            sides.iter().all(|side| side.abs() < 0.01 * pixel)
        })
    }

    /// Returns the rectified eyes: at the same positions, parallel, perpendicular to the line between them, with frusta
    /// that contain the original ones. Use them for canted eyes: since both have the same centre, a view of a parallel
    /// eye can be turned exactly into that of the canted eye. `None` if an eye sees further than 80 degrees from the
    /// common direction.
    pub fn rectified(&self) -> Option<EyePair> {
        let between = self.poses[1].position - self.poses[0].position;
        let x = between.try_normalize().unwrap_or(self.poses[0].right());
        let ahead = self.poses[0].forward() + self.poses[1].forward();
        let z = -(ahead - x * ahead.dot(x)).try_normalize()?;
        let orientation = Quat::from_mat3(&glam::Mat3::from_cols(x, z.cross(x), z));
        let mut eyes = *self;
        for (pose, frustum) in eyes.poses.iter_mut().zip(&mut eyes.frusta) {
            let turn = orientation.inverse() * pose.orientation;
            let corners = [
                (frustum.left, frustum.bottom),
                (frustum.right, frustum.bottom),
                (frustum.left, frustum.top),
                (frustum.right, frustum.top),
            ];
            let mut seen = Frustum { left: f32::MAX, right: f32::MIN, bottom: f32::MAX, top: f32::MIN };
            for (x, y) in corners {
                let direction = (turn * Vec3::new(x, y, -1.0)).normalize();
                if -direction.z < 80f32.to_radians().cos() {
                    return None;
                }
                let tangent = direction.truncate() / -direction.z;
                seen.left = seen.left.min(tangent.x);
                seen.right = seen.right.max(tangent.x);
                seen.bottom = seen.bottom.min(tangent.y);
                seen.top = seen.top.max(tangent.y);
            }
            (pose.orientation, *frustum) = (orientation, seen);
        }
        Some(eyes.row_aligned())
    }

    /// Returns the focal length along X in pixels.
    pub fn focal_length_pixels(&self) -> f32 {
        self.size[0] as f32 / self.frusta[self.dominant.index()].width()
    }

    /// Returns the view to render, and how its pixels move to the other eye.
    ///
    /// The source view is the dominant eye's frustum, extended to the union of both frusta and by the guard band. It is
    /// extended by whole pixels, so that the dominant eye's own image is a crop of it.
    ///
    /// # Errors
    /// [`EyesError`] if a view or the guard band is invalid, the source too large, or if pixels do not move along rows
    /// only or move too far.
    pub fn synthesis_views(&self, guard: GuardBand) -> Result<SynthesisViews, EyesError> {
        self.views(guard, |f_px, _| guard.pixels(f_px, self.ipd().max(0.0)))
    }

    /// Returns the same for an inset that moves in the eyes' images, complete for all surfaces at the distance `nearest`
    /// or farther. Where the two frusta converge, they are apart in the direction of the disparity, and so much less
    /// guard band is needed: the source has the same size for all frusta of one size that converge at `nearest`, at
    /// infinity or between. Frusta that diverge make it wider.
    ///
    /// # Errors
    /// Those of [`EyePair::synthesis_views`].
    pub fn inset_views(&self, nearest: f32) -> Result<SynthesisViews, EyesError> {
        self.views(GuardBand::Distance(nearest), |f_px, beyond| {
            let disparity = f_px * self.ipd().max(0.0) / nearest;
            let [near_side, far_side] = match self.dominant.other() {
                Eye::Left => beyond,
                Eye::Right => [beyond[1], beyond[0]],
            };
            let needed = whole(near_side + disparity).saturating_add(whole(far_side));
            // The union may take a column more, as it begins between two columns.
            let columns = needed.max(whole(disparity).saturating_add(1));
            columns.saturating_sub(whole(near_side).saturating_add(whole(far_side)))
        })
    }

    /// Returns the view to render with a guard band. `columns` returns its width, from the focal length in pixels and
    /// from how many columns the target's frustum reaches beyond the source's on the left and on the right.
    fn views(
        &self,
        guard: GuardBand,
        columns: impl FnOnce(f32, [f32; 2]) -> u32,
    ) -> Result<SynthesisViews, EyesError> {
        Eye::BOTH.iter().try_for_each(|&eye| self.view(eye).check())?;
        if !guard.is_possible() {
            return Err(EyesError::GuardBand(guard));
        }
        self.check_alignment()?;
        let target_eye = self.dominant.other();
        let (s, t) = (self.view(self.dominant), self.view(target_eye));
        let density = self.tangents_per_pixel(self.dominant);
        let (ipd, f_px) = (self.ipd(), 1.0 / density[0]);
        let beyond = [s.frustum.left - t.frustum.left, t.frustum.right - s.frustum.right]
            .map(|tangents| tangents / density[0]);
        let guard = columns(f_px, beyond);
        // Surfaces lie further right in the left eye's image than in the right eye's, so its left border shows what is
        // beyond the right eye's left border.
        let (guard_left, guard_right) = match target_eye {
            Eye::Left => (guard, 0),
            Eye::Right => (0, guard),
        };
        let [left, right] = beyond.map(whole);
        let bottom = whole((s.frustum.bottom - t.frustum.bottom) / density[1]);
        let top = whole((t.frustum.top - s.frustum.top) / density[1]);
        let sum = |parts: &[u32]| parts.iter().map(|n| f64::from(*n)).sum::<f64>();
        let (width, height) = (sum(&[self.size[0], left, right, guard]), sum(&[self.size[1], bottom, top]));
        if width.max(height) > MAX_SIDE {
            return Err(EyesError::TooLarge { width, height });
        }
        let (left, right) = (left + guard_left, right + guard_right);
        let frustum = Frustum {
            left: s.frustum.left - left as f32 * density[0],
            right: s.frustum.right + right as f32 * density[0],
            bottom: s.frustum.bottom - bottom as f32 * density[1],
            top: s.frustum.top + top as f32 * density[1],
        };
        let source = View { frustum, size: [self.size[0] + left + right, self.size[1] + bottom + top], ..s };
        // x_t = (tan_t - left_t) f, tan_t = tan_s + side * IPD / z, x_s = (tan_s - left_s) f.
        let (c, m) = self.depth.inverse_distance_law();
        let shift = (-target_eye.side() * ipd * f_px) as f64;
        let law = DisparityMap {
            offset: (frustum.left as f64 - t.frustum.left as f64) * f_px as f64 + shift * c,
            scale: shift * m,
        };
        let row_offset = ((frustum.bottom - t.frustum.bottom) / density[1]).round() as i32;
        let warp = Warp {
            source_size: source.size,
            target_size: self.size,
            law,
            row_offset,
            target_eye,
            convention: self.depth.convention,
        };
        warp.check()?;
        Ok(SynthesisViews { source, target: t, dominant_crop: [left, bottom], guard_columns: guard, warp })
    }

    /// Checks that pixels move along rows only: that the eyes are parallel, on one horizontal line, with rows on rows.
    fn check_alignment(&self) -> Result<(), EyesError> {
        let [left, right] = &self.poses;
        let angle = left.orientation.angle_between(right.orientation);
        // A tenth of a pixel at 2000 pixels and 90 degrees is 1e-4 rad; f32 acos alone is good to 5e-4.
        let direction =
            (left.forward() - right.forward()).length().max((left.right() - right.right()).length());
        if direction > 1e-4 {
            return Err(EyesError::Canted { degrees: angle.to_degrees() });
        }
        let ipd = self.ipd();
        let axis = self.poses[self.dominant.index()].right();
        let between = right.position - left.position;
        let off_axis = (between - axis * ipd).length();
        // Far from the origin, rounding displaces the eyes. Moving an eye by 1/400 of their distance moves a surface
        // three metres away by a tenth of a pixel at 2000 pixels and 90 degrees.
        if off_axis > self.rounding() + between.length() / 400.0 {
            return Err(EyesError::OffAxis { off_axis });
        }
        if ipd < -self.rounding() {
            return Err(EyesError::Swapped { distance: -ipd });
        }
        let [left, right] = Eye::BOTH.map(|eye| self.tangents_per_pixel(eye));
        for axis in 0..2 {
            // The error adds up over the image: allow a twentieth of a pixel in all.
            if ((left[axis] / right[axis] - 1.0).abs() * self.size[axis] as f32) > 0.05 {
                return Err(EyesError::Density { left: left[axis], right: right[axis] });
            }
        }
        let rows =
            (self.frusta[1].bottom - self.frusta[0].bottom) / self.tangents_per_pixel(self.dominant)[1];
        if (rows - rows.round()).abs() > 0.05 {
            return Err(EyesError::Rows { rows });
        }
        Ok(())
    }

    /// Returns the largest difference between the eyes' positions that comes from rounding to f32: half a unit in the
    /// last place for each coordinate, and as much again for the computation of a position.
    fn rounding(&self) -> f32 {
        4.0 * f32::EPSILON * self.poses.iter().map(|pose| pose.position.length()).fold(0.0, f32::max)
    }

    /// Returns the tangents that a pixel of an eye covers, along X and Y.
    pub(super) fn tangents_per_pixel(&self, eye: Eye) -> [f32; 2] {
        let frustum = &self.frusta[eye.index()];
        [frustum.width() / self.size[0] as f32, frustum.height() / self.size[1] as f32]
    }
}

/// Returns the whole pixels that cover this many.
fn whole(pixels: f32) -> u32 {
    (pixels - 1e-3).ceil().max(0.0) as u32
}

/// The result of [`EyePair::synthesis_views`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SynthesisViews {
    /// The view to render: the dominant eye, widened.
    pub source: View,
    /// The view that is synthesized.
    pub target: View,
    /// Lower left corner, in pixels of the source image, of the dominant eye's own image.
    pub dominant_crop: [u32; 2],
    /// Number of columns of the guard band: the source's leftmost for a synthesized left eye, its rightmost for a right
    /// eye.
    pub guard_columns: u32,
    /// The displacement of the source's pixels.
    pub warp: Warp,
}

impl SynthesisViews {
    /// Returns the upper left corner of the dominant eye's own image, in pixels of a source image with row 0 at the
    /// top.
    pub fn dominant_crop_from_top(&self) -> [u32; 2] {
        let [left, bottom] = self.dominant_crop;
        [left, self.source.size[1] - self.target.size[1] - bottom]
    }
}

#[cfg(test)]
mod tests {
    use super::super::DepthConvention;
    use super::*;

    fn pair(dominant: Eye) -> EyePair {
        let head = Pose::look_at(Vec3::new(0.3, 1.6, -2.0), Vec3::new(-1.0, 1.2, -9.0));
        EyePair::parallel(head, Frustum::symmetric(1.2, 1.0), 0.063, DepthRange::PAPER, [512, 512], dominant)
    }

    /// Projects a world point into a view, in pixels and stored depth.
    fn project(view: &View, p: Vec3) -> [f64; 3] {
        let clip = (view.view_projection() * p.extend(1.0)).as_dvec4();
        let ndc = clip / clip.w;
        [
            (ndc.x * 0.5 + 0.5) * view.size[0] as f64,
            (ndc.y * 0.5 + 0.5) * view.size[1] as f64,
            ndc.z * 0.5 + 0.5,
        ]
    }

    fn law_agrees_with_matrices(pair: &EyePair, guard: GuardBand) {
        let views = pair.synthesis_views(guard).unwrap();
        for (i, z) in [0.5f32, 0.9, 2.0, 7.0, 30.0, 500.0].into_iter().enumerate() {
            let local = Vec3::new((i as f32 * 0.13 - 0.3) * z, (0.2 - i as f32 * 0.09) * z, -z);
            let p = pair.poses[0].position + pair.poses[0].orientation * local;
            let (s, t) = (project(&views.source, p), project(&views.target, p));
            let x = s[0] + views.warp.law.displacement(s[2]);
            assert!((x - t[0]).abs() < 0.02, "z {z}: {x} against {}", t[0]);
            assert!((s[1] + views.warp.row_offset as f64 - t[1]).abs() < 0.02);
            assert!((s[2] - t[2]).abs() < 1e-5, "depth is the same in both eyes");
        }
    }

    #[test]
    fn the_law_is_what_the_matrices_do() {
        for dominant in Eye::BOTH {
            for convention in [DepthConvention::Standard, DepthConvention::Reversed] {
                let mut p = pair(dominant);
                p.depth.convention = convention;
                law_agrees_with_matrices(&p, GuardBand::None);
                law_agrees_with_matrices(&p, GuardBand::Distance(0.5));
                p.frusta[0] = Frustum::from_fov(-0.9, 0.7, 0.75, -0.8);
                p.frusta[1] = Frustum::from_fov(-0.7, 0.9, 0.75, -0.8);
                law_agrees_with_matrices(&p, GuardBand::Distance(0.5));
            }
        }
    }

    #[test]
    fn the_dominant_image_is_a_crop_and_the_union_covers_both() {
        let mut p = pair(Eye::Right);
        p.frusta[0] = Frustum::from_fov(-0.9, 0.7, 0.75, -0.8);
        p.frusta[1] = Frustum::from_fov(-0.7, 0.9, 0.75, -0.8);
        let v = p.synthesis_views(GuardBand::Pixels(10)).unwrap();
        let d = v.source.frustum.width() / v.source.size[0] as f32;
        assert!((v.source.frustum.left + v.dominant_crop[0] as f32 * d - p.frusta[1].left).abs() < 1e-5);
        assert!(v.source.frustum.left + 10.0 * d <= p.frusta[0].left + 1e-5);
        assert!(v.source.frustum.right >= p.frusta[0].right - 1e-5);
    }

    #[test]
    fn the_crop_is_found_from_the_top_as_well() {
        let mut p = pair(Eye::Right);
        let rows = p.frusta[1].height() / p.size[1] as f32;
        p.frusta[0].top += 3.0 * rows;
        p.frusta[0].bottom += 3.0 * rows;
        let v = p.synthesis_views(GuardBand::None).unwrap();
        assert_eq!((v.source.size[1], v.dominant_crop[1], v.dominant_crop_from_top()[1]), (515, 0, 3));
    }

    #[test]
    fn the_guard_band_reaches_its_distance() {
        for dominant in Eye::BOTH {
            let p = pair(dominant);
            let v = p.synthesis_views(GuardBand::Distance(0.5)).unwrap();
            let depth = p.depth.depth(0.5) as f64;
            // The outer column of the target must have its source inside the image.
            let x = match dominant.other() {
                Eye::Left => 0.0,
                Eye::Right => 511.0,
            };
            let source = x - v.warp.law.displacement(depth);
            assert!(source >= -1e-3 && source <= v.source.size[0] as f64 - 1.0 + 1e-3, "{source}");
        }
    }

    #[test]
    fn unsuitable_pairs_are_refused() {
        let mut p = pair(Eye::Left);
        p.poses[0].orientation *= Quat::from_rotation_y(0.087);
        let e = p.synthesis_views(GuardBand::None).unwrap_err();
        assert!(matches!(e, EyesError::Canted { degrees } if (degrees - 5.0).abs() < 0.1), "{e}");
        let mut p = pair(Eye::Left);
        p.poses[0].position.y += 0.01;
        assert!(matches!(p.synthesis_views(GuardBand::None), Err(EyesError::OffAxis { .. })));
        let mut p = pair(Eye::Left);
        p.poses.swap(0, 1);
        assert!(matches!(p.synthesis_views(GuardBand::None), Err(EyesError::Swapped { .. })));
        let mut p = pair(Eye::Left);
        p.frusta[0] = Frustum::symmetric(1.0, 1.0);
        assert!(matches!(p.synthesis_views(GuardBand::None), Err(EyesError::Density { .. })));
        p.depth.near = 0.0;
        assert_eq!(p.synthesis_views(GuardBand::None), Err(EyesError::Planes));
        let p = EyePair { size: [512, 0], ..pair(Eye::Left) };
        assert_eq!(p.synthesis_views(GuardBand::None), Err(EyesError::NoPixels));
    }

    #[test]
    fn eyes_far_from_the_origin_are_displaced_by_rounding_alone() {
        for distance in [100.0, 700.0, 1500.0, 4000.0, 8000.0] {
            for turn in 0..200 {
                let orientation = Quat::from_euler(glam::EulerRot::YXZ, turn as f32 * 0.7, 0.3, 0.1);
                let position = Quat::from_rotation_y(turn as f32) * Vec3::new(distance, 1.6, 0.0);
                let own = pair(Eye::Right);
                let head = Pose { position, orientation };
                let far = EyePair::parallel(head, own.frusta[0], 0.064, own.depth, own.size, Eye::Right);
                let warp =
                    far.synthesis_views(GuardBand::None).unwrap_or_else(|e| panic!("{distance} m: {e}")).warp;
                let near =
                    EyePair::parallel(Pose::IDENTITY, own.frusta[0], 0.064, own.depth, own.size, Eye::Right);
                let expected = near.synthesis_views(GuardBand::None).unwrap().warp;
                let rounding = f64::from(distance * f32::EPSILON / 0.064);
                assert!((warp.law.scale / expected.law.scale - 1.0).abs() < rounding + 1e-5, "{distance} m");
            }
        }
        // A displacement beyond rounding is refused at any distance.
        for distance in [0.0, 1000.0] {
            let mut off = pair(Eye::Right);
            off.poses.iter_mut().for_each(|pose| pose.position.x += distance);
            off.poses[0].position.y += 0.001;
            assert!(
                matches!(off.synthesis_views(GuardBand::None), Err(EyesError::OffAxis { .. })),
                "{distance} m"
            );
        }
    }

    #[test]
    fn rows_between_rows_have_their_own_error() {
        let mut p = pair(Eye::Right);
        let own = p.frusta[0];
        let row = own.height() / 512.0;
        let shifted =
            |rows: f32| Frustum { bottom: own.bottom + rows * row, top: own.top + rows * row, ..own };
        p.frusta[1] = shifted(3.0);
        assert_eq!(p.synthesis_views(GuardBand::None).unwrap().warp.row_offset, 0);
        p.frusta[1] = shifted(2.4);
        let error = p.synthesis_views(GuardBand::None).unwrap_err();
        assert!(matches!(error, EyesError::Rows { rows } if (rows - 2.4).abs() < 0.01), "{error}");
        p.row_aligned().synthesis_views(GuardBand::None).unwrap();
    }

    #[test]
    fn guard_bands_out_of_range_are_refused() {
        let bands = [0.0, -1.0, f32::NAN, f32::INFINITY].map(GuardBand::Distance);
        for band in bands.into_iter().chain([GuardBand::Pixels(1025), GuardBand::Pixels(u32::MAX)]) {
            let error = pair(Eye::Left).synthesis_views(band).unwrap_err();
            assert!(matches!(error, EyesError::GuardBand(_)), "{band:?}: {error}");
        }
        for band in [GuardBand::Distance(0.05), GuardBand::Distance(1000.0), GuardBand::Pixels(1024)] {
            pair(Eye::Left).synthesis_views(band).unwrap();
        }
        let error = pair(Eye::Left).synthesis_views(GuardBand::Distance(1e-30)).unwrap_err();
        assert!(matches!(error, EyesError::TooLarge { .. }), "{error}");
    }

    #[test]
    fn nan_and_infinite_values_are_refused() {
        type Spoil = fn(&mut EyePair);
        let spoilt: [(Spoil, EyesError); 9] = [
            (|p| (p.depth.near, p.depth.far) = (f32::MAX, f32::INFINITY), EyesError::Planes),
            (|p| p.depth.near = f32::NAN, EyesError::Planes),
            (|p| p.depth.far = f32::NAN, EyesError::Planes),
            (|p| p.depth.near = f32::INFINITY, EyesError::Planes),
            (|p| p.frusta[0].left = f32::NAN, EyesError::Invalid),
            (|p| p.frusta[1].top = f32::INFINITY, EyesError::Invalid),
            (|p| p.poses[0].position.x = f32::NAN, EyesError::Invalid),
            (|p| p.poses[1].orientation.w = f32::NAN, EyesError::Invalid),
            (|p| p.poses[1].orientation = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), EyesError::Invalid),
        ];
        for (i, (spoil, error)) in spoilt.into_iter().enumerate() {
            let mut p = pair(Eye::Right);
            spoil(&mut p);
            assert_eq!(p.synthesis_views(GuardBand::None), Err(error), "case {i}");
        }
    }

    #[test]
    fn views_with_more_pixels_than_drivers_render_are_refused() {
        let mut apart = pair(Eye::Right);
        apart.frusta = [0.0, -2000.0].map(|left| Frustum { left, right: left + 1.0, bottom: -0.5, top: 0.5 });
        let huge = EyePair { size: [u32::MAX; 2], ..pair(Eye::Right) };
        for eyes in [apart, huge] {
            let error = eyes.synthesis_views(GuardBand::Distance(0.05)).unwrap_err();
            assert!(matches!(error, EyesError::TooLarge { .. }), "{error}");
        }
    }

    #[test]
    fn units_of_length_do_not_matter() {
        let pair = |unit: f32| EyeOptions {
            ipd: 0.063 * unit,
            depth: DepthRange { near: 0.3 * unit, far: 100.0 * unit, ..DepthRange::PAPER },
            ..EyeOptions::default()
        };
        let warp =
            |unit| pair(unit).pair(Pose::IDENTITY).synthesis_views(GuardBand::Distance(unit)).unwrap().warp;
        let metres = warp(1.0);
        // Giants in metres, people in centimetres and in millimetres, mice.
        for unit in [0.01, 0.1, 30.0, 100.0, 1000.0] {
            let other = warp(unit);
            assert_eq!(Warp { law: metres.law, ..other }, metres);
            let [a, b] = [other, metres].map(|warp| [warp.law.offset, warp.law.scale]);
            assert!(a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-5), "{unit}: {a:?}, {b:?}");
            let mut off_axis = pair(unit).pair(Pose::IDENTITY);
            off_axis.poses[0].position.y += 0.001 * unit;
            let refused = off_axis.synthesis_views(GuardBand::None);
            assert!(matches!(refused, Err(EyesError::OffAxis { .. })), "{unit}: {refused:?}");
        }
    }

    #[test]
    fn displacements_beyond_the_shaders_are_refused() {
        let pair = |width: u32, near: f32, ipd: f32| {
            let depth = DepthRange { near, ..DepthRange::PAPER };
            EyeOptions { size: [width, width], ipd, depth, ..EyeOptions::default() }.pair(Pose::IDENTITY)
        };
        for dominant in Eye::BOTH {
            let synthesis = |eyes: EyePair| {
                EyePair { dominant, ..eyes }.synthesis_views(GuardBand::None).map(|views| views.warp)
            };
            synthesis(pair(8192, 0.3, 0.063)).unwrap();
            let error = synthesis(pair(8192, 0.05, 0.063)).unwrap_err();
            assert!(matches!(error, EyesError::Displacement { .. }), "{error}");
            assert!(
                error.to_string().contains("near plane") && error.to_string().contains("4095"),
                "{error}"
            );
            // A surface that moves across the whole image is not visible, however far it moves.
            synthesis(pair(2048, 0.005, 0.063)).unwrap();
            synthesis(pair(64, 0.3, 100.0)).unwrap();
            let error = synthesis(pair(64, 1e-7, 0.063)).unwrap_err();
            assert!(matches!(error, EyesError::Displacement { .. }), "{error}");
        }
    }

    #[test]
    fn row_aligned_eyes_contain_the_eyes_and_can_be_synthesized() {
        let mut eyes = pair(Eye::Right);
        eyes.frusta = [Frustum::from_fov(-0.9, 0.7, 0.75, -0.8), Frustum::from_fov(-0.5, 0.8, 0.7, -0.81)];
        assert!(matches!(eyes.synthesis_views(GuardBand::None), Err(EyesError::Density { .. })));
        let even = eyes.row_aligned();
        even.synthesis_views(GuardBand::None).unwrap();
        for (grown, own) in even.frusta.iter().zip(&eyes.frusta) {
            assert!(grown.left <= own.left + 1e-6 && grown.right >= own.right - 1e-6, "{grown:?}");
            assert!(grown.bottom <= own.bottom && grown.top >= own.top, "{grown:?}");
        }
    }

    #[test]
    fn rectified_eyes_contain_the_canted_ones() {
        let mut eyes = pair(Eye::Right);
        eyes.frusta = [Frustum::from_fov(-0.8, 0.7, 0.75, -0.75), Frustum::from_fov(-0.7, 0.8, 0.75, -0.75)];
        // Outwards by 5 degrees each, and the head askew.
        let head = Quat::from_euler(glam::EulerRot::YXZ, 0.4, -0.2, 0.1);
        for (pose, side) in eyes.poses.iter_mut().zip([1.0, -1.0]) {
            pose.position = head * Vec3::new(-side * 0.032, 0.0, 0.0);
            pose.orientation = head * Quat::from_rotation_y(side * 5f32.to_radians());
        }
        assert!(matches!(eyes.synthesis_views(GuardBand::None), Err(EyesError::Canted { .. })));
        let parallel = eyes.rectified().unwrap();
        parallel.synthesis_views(GuardBand::None).unwrap();
        assert!(
            (parallel.ipd() - 0.064).abs() < 1e-6 && parallel.poses[0].position == eyes.poses[0].position
        );
        for eye in Eye::BOTH {
            let (own, wide) = (eyes.view(eye), parallel.view(eye));
            for (x, y) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.5)] {
                let tangent = Vec3::new(
                    own.frustum.left + x * own.frustum.width(),
                    own.frustum.bottom + y * own.frustum.height(),
                    -1.0,
                );
                let clip =
                    wide.view_projection() * (own.pose.position + own.pose.orientation * tangent).extend(1.0);
                let seen = clip.truncate() / clip.w;
                assert!(seen.x.abs() < 1.0001 && seen.y.abs() < 1.0001, "{eye:?} {seen}");
            }
        }
        // The eyes look in nearly opposite directions.
        eyes.poses[1].orientation = Quat::from_rotation_y(-2.5);
        assert_eq!(eyes.rectified(), None);
    }
}
