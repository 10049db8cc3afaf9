//! The displacement of pixels from a view to another one near it, and how much wider the source must be for it.

use glam::{DMat3, DVec2, DVec3};

use super::{EyesError, View};

/// What synthesis needs to know about two views in any poses.
///
/// The point at inverse distance k from the target's eye, along its viewing axis, that the target shows at the pixel p
/// lies in the source at the pixel `homography * p + k * epipole`: homogeneous pixels, counted from the lower left
/// corner, with the third component `source distance / target distance` (Hartley and Zisserman, Multiple View Geometry,
/// equation 9.7). `opengl::AnyView` draws the target on OpenGL, `vulkan::AnyView` on Vulkan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseWarp {
    /// Size of the source in pixels.
    pub source_size: [u32; 2],
    /// Size of the target in pixels.
    pub target_size: [u32; 2],
    /// The homography of the rotation between the views, from target to source.
    pub homography: DMat3,
    /// The target eye's position in the source image. The third component is the distance in metres by which that eye
    /// is further ahead.
    pub epipole: DVec3,
    /// `(c, m)` of the source's `1 / distance = c + m * depth`.
    pub source_law: [f64; 2],
    /// The same for the target.
    pub target_law: [f64; 2],
    /// Stored depth, in the source, of the nearest surface that the target may show.
    pub nearest: f64,
    /// Stored depth of the source's far plane.
    pub far_depth: f64,
}

/// The cosine of 80 degrees, the largest angle between the source's axis and a direction that the target shows.
const LEAST_COSINE: f64 = 0.173_648;

impl PoseWarp {
    /// Returns the warp from a rendered view to another one. The views may differ in pose, frustum, size and depth
    /// planes.
    ///
    /// # Errors
    /// [`EyesError::Apart`] if the target sees further than 80 degrees from the source's axis, or only what is beyond
    /// the source's far plane; [`EyesError::Invalid`], [`EyesError::NoPixels`], [`EyesError::Empty`] or
    /// [`EyesError::Planes`] for an invalid view.
    pub fn new(source: &View, target: &View) -> Result<PoseWarp, EyesError> {
        source.check()?;
        target.check()?;
        let turn = |view: &View| DMat3::from_quat(view.pose.orientation.as_dquat().normalize());
        let to_source = turn(source).transpose();
        let rotation = to_source * turn(target);
        for corner in target.corners() {
            if -(rotation * corner.normalize()).z < LEAST_COSINE {
                return Err(EyesError::Apart);
            }
        }
        // Subtract the positions first: their difference is small even where positions are large.
        let moved = to_source * (target.pose.position.as_dvec3() - source.pose.position.as_dvec3());
        let pixels = pixels_of(source);
        // Between views of the same orientation, frustum and size, the identity avoids rounding: pixels that do not
        // move keep their values exactly.
        let homography = if (source.pose.orientation, source.frustum, source.size)
            == (target.pose.orientation, target.frustum, target.size)
        {
            DMat3::IDENTITY
        } else {
            pixels * rotation * pixels_of(target).inverse()
        };
        let (c, m) = source.depth.inverse_distance_law();
        let (target_c, target_m) = target.depth.inverse_distance_law();
        // Nearer surfaces are in front of a near plane or, where the target is ahead, behind its eye.
        let near = f64::from(source.depth.near).max(LEAST_COSINE * f64::from(target.depth.near) - moved.z);
        if near >= f64::from(source.depth.far) {
            return Err(EyesError::Apart);
        }
        Ok(PoseWarp {
            source_size: source.size,
            target_size: target.size,
            homography,
            epipole: pixels * moved,
            source_law: [c, m],
            target_law: [target_c, target_m],
            nearest: (1.0 / near - c) / m,
            far_depth: f64::from(source.depth.clear_value()),
        })
    }

    /// Returns the warp that moves pixels by rotation alone, as if all surfaces were infinitely far away: the best
    /// possible without depth.
    pub fn rotation_only(&self) -> PoseWarp {
        PoseWarp { epipole: DVec3::ZERO, ..*self }
    }

    /// Returns the warp for images with row 0 at the top. `vulkan::Pipeline::record` and `yoro-wgpu` convert it
    /// themselves.
    pub fn rows_from_top(&self) -> PoseWarp {
        let turn = |size: [u32; 2]| {
            DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::new(0.0, f64::from(size[1]), 1.0))
        };
        let (source, target) = (turn(self.source_size), turn(self.target_size));
        PoseWarp { homography: source * self.homography * target, epipole: source * self.epipole, ..*self }
    }

    /// Returns the source pixel of the surface that the target shows at a pixel, given the inverse of its distance from
    /// the target's eye. Pixels are counted from the lower left corner and have their centres at +0.5.
    pub fn source_pixel(&self, target: DVec2, inverse_distance: f64) -> DVec2 {
        let at = self.homography * target.extend(1.0) + inverse_distance * self.epipole;
        at.truncate() / at.z
    }
}

/// Returns the matrix from a view's local space to its homogeneous pixels, with the distance as third component.
fn pixels_of(view: &View) -> DMat3 {
    let f = view.frustum;
    let [x, y] =
        [f64::from(view.size[0]) / f64::from(f.width()), f64::from(view.size[1]) / f64::from(f.height())];
    DMat3::from_cols(
        DVec3::new(x, 0.0, 0.0),
        DVec3::new(0.0, y, 0.0),
        DVec3::new(f64::from(f.left) * x, f64::from(f.bottom) * y, -1.0),
    )
}

/// The bounds of the head's motion between the render of a frame and its display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadMotion {
    /// Largest angle of rotation, about any axis, in radians.
    pub rotation: f32,
    /// Largest distance that an eye moves, in metres.
    pub translation: f32,
}

/// A view with a guard band on all four sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardedView {
    /// The wider view, which is to be rendered.
    pub view: View,
    /// Lower left corner of the original view, in pixels of the wider one.
    pub crop: [u32; 2],
}

impl GuardedView {
    /// Returns the upper left corner of the original view, which has this size, in pixels of the wider one, for images
    /// with row 0 at the top.
    pub fn crop_from_top(&self, original: [u32; 2]) -> [u32; 2] {
        [self.crop[0], self.view.size[1].saturating_sub(self.crop[1] + original[1])]
    }
}

impl HeadMotion {
    /// Returns the view widened on all four sides, by whole pixels, to contain whatever the view can show after such a
    /// motion, of surfaces at a distance of at least `nearest` metres from its eye. With the angle `a` by which a
    /// direction turns, the tangent T of a side becomes `tan(atan T + asin(sin a * |(T, U, 1)| / |(T, 1)|))`, where U
    /// is the larger tangent of the other two sides. Translation turns directions by at most
    /// `asin(translation / nearest)`.
    ///
    /// # Errors
    /// [`EyesError::Apart`] if the view would reach further than 80 degrees to a side; those of [`PoseWarp::new`] for
    /// an invalid view.
    pub fn guarded(&self, view: &View, nearest: f32) -> Result<GuardedView, EyesError> {
        view.check()?;
        let shift = f64::from(self.translation) / f64::from(nearest);
        if !(0.0..1.0).contains(&shift) || !(0.0..1.0).contains(&self.rotation) {
            return Err(EyesError::Apart);
        }
        let angle = f64::from(self.rotation) + shift.asin();
        if angle >= std::f64::consts::FRAC_PI_2 {
            return Err(EyesError::Apart);
        }
        let turn = angle.sin();
        let f = view.frustum;
        let [[left, right], [bottom, top]] =
            [[-f.left, f.right], [-f.bottom, f.top]].map(|sides| sides.map(f64::from));
        // Pixels beyond a side, for tangents outwards.
        let beyond = |side: f64, beside: f64, per_pixel: f64| {
            let slant = turn * (side * side + beside * beside + 1.0).sqrt() / (side * side + 1.0).sqrt();
            let angle = side.atan() + slant.asin();
            // Written so that NaN fails, too.
            if angle.cos() > LEAST_COSINE {
                Ok(((angle.tan() - side) / per_pixel - 1e-3).ceil().max(0.0) as u32)
            } else {
                Err(EyesError::Apart)
            }
        };
        let density = [f.width() / view.size[0] as f32, f.height() / view.size[1] as f32];
        let (tall, wide) = (bottom.abs().max(top.abs()), left.abs().max(right.abs()));
        let [x, y] = density.map(f64::from);
        let (left, right) = (beyond(left, tall, x)?, beyond(right, tall, x)?);
        let (bottom, top) = (beyond(bottom, wide, y)?, beyond(top, wide, y)?);
        let frustum = super::Frustum {
            left: f.left - left as f32 * density[0],
            right: f.right + right as f32 * density[0],
            bottom: f.bottom - bottom as f32 * density[1],
            top: f.top + top as f32 * density[1],
        };
        let sum =
            |parts: [u32; 3]| parts.into_iter().try_fold(0u32, u32::checked_add).ok_or(EyesError::Apart);
        let size = [sum([view.size[0], left, right])?, sum([view.size[1], bottom, top])?];
        Ok(GuardedView { view: View { frustum, size, ..*view }, crop: [left, bottom] })
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::super::{DepthRange, Frustum, Pose};
    use super::*;

    fn view(position: Vec3, orientation: Quat) -> View {
        View {
            pose: Pose { position, orientation },
            frustum: Frustum { left: -0.9, right: 0.7, bottom: -0.6, top: 0.65 },
            depth: DepthRange { near: 0.1, ..DepthRange::PAPER },
            size: [640, 480],
        }
    }

    fn project(view: &View, local: Vec3) -> DVec2 {
        let clip = view.projection().as_dmat4() * local.as_dvec3().extend(1.0);
        let [w, h] = view.size.map(f64::from);
        DVec2::new((clip.x / clip.w * 0.5 + 0.5) * w, (clip.y / clip.w * 0.5 + 0.5) * h)
    }

    #[test]
    fn pixels_are_where_the_matrices_project_them() {
        let base = Quat::from_rotation_y(0.3);
        let source = view(Vec3::new(300.0, 1.6, -80.0), base);
        let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.1, -0.05, 0.2);
        let mut target = view(Vec3::new(300.05, 1.58, -80.25), base * turn);
        target.frustum.right = 0.8;
        target.size = [512, 500];
        let warp = PoseWarp::new(&source, &target).unwrap();
        for z in [0.4f32, 1.5, 30.0] {
            let local = Vec3::new(0.2 * z, -0.1 * z, -z);
            let moved = target.pose.position - source.pose.position;
            let seen = base.inverse() * (moved + target.pose.orientation * local);
            let (there, here, k) = (project(&source, seen), project(&target, local), 1.0 / f64::from(z));
            let got = warp.source_pixel(here, k);
            assert!((got - there).length() < 2e-3, "{got}");
            let from_top = warp.rows_from_top().source_pixel(DVec2::new(here.x, 500.0 - here.y), k);
            let turned = DVec2::new(there.x, 480.0 - there.y);
            assert!((from_top - turned).length() < 2e-3, "{from_top}");
        }
        let still = PoseWarp::new(&source, &source).unwrap();
        assert_eq!((still.homography, still.rows_from_top().homography), (DMat3::IDENTITY, DMat3::IDENTITY));
        let behind = view(Vec3::ZERO, base * Quat::from_rotation_y(1.5));
        assert_eq!(PoseWarp::new(&source, &behind), Err(EyesError::Apart));
        let beyond = source.pose.translated_local(Vec3::NEG_Z * (source.depth.far + 1.0));
        assert_eq!(PoseWarp::new(&source, &View { pose: beyond, ..source }), Err(EyesError::Apart));
        let none = View { size: [0, 9], ..source };
        assert_eq!(PoseWarp::new(&none, &source), Err(EyesError::NoPixels));
    }

    #[test]
    fn the_guard_band_holds_what_motion_brings_in_and_little_more() {
        let own = view(Vec3::ZERO, Quat::IDENTITY);
        let crop = |crop| GuardedView { view: View { size: [90, 80], ..own }, crop };
        assert_eq!(crop([7, 11]).crop_from_top([50, 60]), [7, 9]);
        let large = HeadMotion { rotation: 0.99, translation: 0.99 };
        assert_eq!(large.guarded(&own, 1.0), Err(EyesError::Apart));
        let motion = HeadMotion { rotation: 0.08, translation: 0.03 };
        let guarded = motion.guarded(&own, 0.6).unwrap();
        let wide = guarded.view;
        let per_pixel = own.frustum.width() / 640.0;
        assert!((wide.frustum.left + guarded.crop[0] as f32 * per_pixel - own.frustum.left).abs() < 1e-5);
        let [mut low, mut high] = [DVec2::MAX, DVec2::MIN];
        let corners = own.corners().map(|corner| corner.as_vec3().normalize());
        let axes = corners.iter().flat_map(|c| [c.cross(Vec3::X), c.cross(Vec3::Y)]).chain(corners);
        for (axis, sense) in axes.flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
            let turn = Quat::from_axis_angle(axis.normalize(), sense * motion.rotation);
            for i in 0..27 {
                let way = Vec3::new((i % 3) as f32 - 1.0, (i / 3 % 3) as f32 - 1.0, (i / 9) as f32 - 1.0);
                let target = view(way.normalize_or_zero() * motion.translation, turn);
                let warp = PoseWarp::new(&wide, &target).unwrap();
                for (x, y) in [(0.0, 0.0), (640.0, 0.0), (0.0, 480.0), (640.0, 480.0)] {
                    let at = warp.source_pixel(DVec2::new(x, y), 1.0 / 0.6);
                    (low, high) = (low.min(at), high.max(at));
                }
            }
        }
        let size = DVec2::new(f64::from(wide.size[0]), f64::from(wide.size[1]));
        assert!(low.min_element() > -0.01 && (size - high).min_element() > -0.01, "{low} {high} of {size}");
        // The bound uses the distance along the axis as that to the eye, and assumes the worst of both motions.
        assert!(low.max_element() < 30.0 && (size - high).max_element() < 30.0, "{low} {high} of {size}");
        let still = HeadMotion { rotation: 0.0, translation: 0.0 };
        assert_eq!(still.guarded(&own, 1.0).unwrap(), GuardedView { view: own, crop: [0, 0] });
        assert_eq!(HeadMotion { rotation: 0.9, ..still }.guarded(&own, 1.0), Err(EyesError::Apart));
        assert_eq!(HeadMotion { translation: 2.0, ..still }.guarded(&own, 1.0), Err(EyesError::Apart));
    }
}
