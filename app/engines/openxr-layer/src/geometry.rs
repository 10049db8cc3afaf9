//! The view that is offered to the application, and the parts of its image for the two eyes.

use openxr_sys as sys;
use yoro::eyes::{DepthRange, Eye, EyePair, EyesError, Frustum, GuardBand, Pose, Warp};

/// The fraction of a pixel by which edges may miss the pixel grid, because angles are rounded in transit.
const ROUNDING: f32 = 2e-3;

/// The reason why an image cannot be split into two.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// Nothing can be synthesized between the eyes, or from the submitted view.
    #[error(transparent)]
    Eyes(#[from] EyesError),
    /// minDepth and maxDepth are out of order.
    #[error(
        "the depth's minDepth {min} and maxDepth {max} are out of order: need 0 <= minDepth < maxDepth <= 1"
    )]
    Depth {
        /// minDepth as submitted.
        min: f32,
        /// maxDepth as submitted.
        max: f32,
    },
    /// The rectangle to read lies outside the image, because of rounding.
    #[error("the eyes' rectangles do not fit the submitted image of {}x{} pixels", size[0], size[1])]
    Rectangle {
        /// Width and height of the submitted rectangle.
        size: [u32; 2],
    },
}

/// The pose of a space's origin.
pub const IDENTITY: sys::Posef = sys::Posef {
    orientation: sys::Quaternionf { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
    position: sys::Vector3f { x: 0.0, y: 0.0, z: 0.0 },
};

/// Converts a pose from OpenXR.
pub fn pose(pose: sys::Posef) -> Pose {
    let (p, q) = (pose.position, pose.orientation);
    Pose { position: glam::Vec3::new(p.x, p.y, p.z), orientation: glam::Quat::from_xyzw(q.x, q.y, q.z, q.w) }
}

/// Converts a pose to OpenXR.
pub fn xr_pose(pose: Pose) -> sys::Posef {
    let (p, q) = (pose.position, pose.orientation);
    sys::Posef {
        orientation: sys::Quaternionf { x: q.x, y: q.y, z: q.z, w: q.w },
        position: sys::Vector3f { x: p.x, y: p.y, z: p.z },
    }
}

/// Converts a field of view from OpenXR to tangents.
pub fn frustum(fov: sys::Fovf) -> Frustum {
    Frustum::from_fov(fov.angle_left, fov.angle_right, fov.angle_up, fov.angle_down)
}

/// Converts tangents to an OpenXR field of view.
pub fn xr_fov(frustum: Frustum) -> sys::Fovf {
    sys::Fovf {
        angle_left: frustum.left.atan(),
        angle_right: frustum.right.atan(),
        angle_up: frustum.top.atan(),
        angle_down: frustum.bottom.atan(),
    }
}

/// The one view that the application is offered, and the eyes that it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offer {
    /// The eyes that will be shown: the runtime's own or, if those are canted or unequal, parallel eyes of one size
    /// that contain them. They are submitted with their poses and fields of view, so the compositor reprojects them.
    pub eyes: EyePair,
    /// The dominant eye's pose.
    pub pose: Pose,
    /// The union of both frusta, extended by the guard band.
    pub frustum: Frustum,
    /// Width and height in pixels. The dominant eye's part has the size that the runtime recommends for an eye.
    pub size: [u32; 2],
}

impl Offer {
    /// Returns the offer for the runtime's two views and the size in pixels that it recommends for each.
    ///
    /// # Errors
    /// [`EyesError`] if nothing can be synthesized between the eyes.
    pub fn new(
        views: [(Pose, Frustum); 2],
        size: [u32; 2],
        dominant: Eye,
        guard_band: GuardBand,
    ) -> Result<Offer, EyesError> {
        let own = EyePair {
            poses: views.map(|(pose, _)| pose),
            frusta: views.map(|(_, frustum)| frustum),
            // The depth range is known only once the application submits it. It does not affect the view.
            depth: DepthRange::PAPER,
            size,
            dominant,
        };
        let even = own.row_aligned();
        let sized = |eyes: EyePair| {
            // Larger frusta with the same number of pixels per tangent.
            let (old, new) = (own.frusta[dominant.index()], eyes.frusta[dominant.index()]);
            let grow = |size: u32, by: f32| {
                if by > 1.0001 && by < 16.0 { (size as f32 * by).ceil() as u32 } else { size }
            };
            let size = [grow(size[0], new.width() / old.width()), grow(size[1], new.height() / old.height())];
            EyePair { size, ..eyes }
        };
        let eyes = sized(even);
        let (eyes, views) = match eyes.synthesis_views(guard_band) {
            Ok(views) => (eyes, views),
            Err(error @ (EyesError::Canted { .. } | EyesError::OffAxis { .. })) => {
                let eyes = sized(own.rectified().ok_or(error)?);
                (eyes, eyes.synthesis_views(guard_band)?)
            }
            Err(error) => return Err(error),
        };
        Ok(Offer { eyes, pose: views.source.pose, frustum: views.source.frustum, size: views.source.size })
    }
}

/// One view as the application submitted it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Submitted {
    /// The pose that it was rendered with, in the space of its composition layer.
    pub pose: Pose,
    /// Its field of view.
    pub frustum: Frustum,
    /// Width and height of the rectangle in pixels.
    pub size: [u32; 2],
    /// The meaning of its depth buffer.
    pub depth: SubmittedDepth,
}

/// The numbers of XrCompositionLayerDepthInfoKHR.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubmittedDepth {
    /// The distance in metres that is stored as `min`. It exceeds `far` if depth is reversed, and may be infinite.
    pub near: f32,
    /// The distance in metres that is stored as `max`.
    pub far: f32,
    /// minDepth, usually 0.
    pub min: f32,
    /// maxDepth, usually 1.
    pub max: f32,
}

impl SubmittedDepth {
    /// Returns the distances that 0 and 1 stand for, after depth was scaled from `min` to `max`.
    ///
    /// # Errors
    /// [`GeometryError::Depth`].
    pub fn range(&self) -> Result<DepthRange, GeometryError> {
        let SubmittedDepth { near, far, min, max } = *self;
        // Written so that NaN fails too.
        let ordered = 0.0 <= min && min < max && max <= 1.0;
        if ordered {
            Ok(DepthRange::from_distances(near, far))
        } else {
            Err(GeometryError::Depth { min, max })
        }
    }
}

/// A rectangle of whole pixels, counted from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Upper left corner.
    pub origin: [u32; 2],
    /// Width and height.
    pub size: [u32; 2],
}

impl Rectangle {
    /// Converts a part of this rectangle to a rectangle of the image. The part is relative to this rectangle's upper
    /// left corner. If the rows of the image are counted from the bottom, as in OpenGL, this rectangle and the result
    /// begin at their lower left corners.
    pub fn part(&self, part: Rectangle, rows_from_top: bool) -> Rectangle {
        let row = if rows_from_top { part.origin[1] } else { self.size[1] - part.origin[1] - part.size[1] };
        Rectangle { origin: [self.origin[0] + part.origin[0], self.origin[1] + row], size: part.size }
    }
}

/// The two eyes of a submitted view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    /// The dominant eye's part of the submitted rectangle, relative to that rectangle.
    pub crop: Rectangle,
    /// The poses to submit, by [`Eye::index`].
    pub poses: [Pose; 2],
    /// The fields of view to submit, by [`Eye::index`]. They end at pixel edges.
    pub frusta: [Frustum; 2],
    /// The part that is read, relative to the submitted rectangle.
    pub source: Rectangle,
    /// The warp to the other eye, whose image has the size of `crop`.
    pub warp: Warp,
}

/// Splits a submitted view into two eyes with the relative poses and frusta of the offer's eyes. The view's pose, field
/// of view and size may differ from those offered. The eyes show as much as the image contains.
///
/// # Errors
/// [`GeometryError`]. The image can still be shown unchanged.
pub fn split(eyes: &EyePair, submitted: &Submitted) -> Result<Split, GeometryError> {
    let SubmittedDepth { min, max, .. } = submitted.depth;
    let depth = submitted.depth.range()?;
    let (whole, size) = (submitted.frustum, submitted.size);
    let sound = [whole.left, whole.right, whole.bottom, whole.top].iter().all(|edge| edge.is_finite());
    if !sound || whole.width() <= 0.0 || whole.height() <= 0.0 || size.contains(&0) {
        return Err(EyesError::Empty.into());
    }
    let tangents = [whole.width() / size[0] as f32, whole.height() / size[1] as f32];
    // Returns the first pixel, from the left or the top, that an interval of tangents touches, and the number of them.
    let touched = |from: f32, to: f32, axis: usize| {
        let first = (from / tangents[axis] + ROUNDING).floor();
        (first, (to / tangents[axis] - ROUNDING).ceil() - first)
    };
    let (dominant, other) = (eyes.dominant.index(), eyes.dominant.other().index());
    let [own, others] = [eyes.frusta[dominant], eyes.frusta[other]];
    let columns = touched(own.left - whole.left, own.right - whole.left, 0);
    let rows = touched(whole.top - own.top, whole.top - own.bottom, 1);
    // Casts from float to int saturate, and turn NaN into 0.
    let extent = |pixels: f32, axis: usize| (pixels as u32).clamp(1, size[axis]);
    let part = [extent(columns.1, 0), extent(rows.1, 1)];
    let start = |first: f32, axis: usize| (first as u32).min(size[axis] - part[axis]);
    let crop = Rectangle { origin: [start(columns.0, 0), start(rows.0, 1)], size: part };
    // The other eye's image need not begin at a whole column of the dominant eye's.
    let first = ((others.left - whole.left) / tangents[0]).clamp(0.0, (size[0] - part[0]) as f32);
    let [left, top] = crop.origin.map(|pixels| pixels as f32);
    let [width, height] = part.map(|pixels| pixels as f32);
    let begins_at = |left: f32| Frustum {
        left: whole.left + left * tangents[0],
        right: whole.left + (left + width) * tangents[0],
        bottom: whole.top - (top + height) * tangents[1],
        top: whole.top - top * tangents[1],
    };
    let mut frusta = [begins_at(left); 2];
    frusta[other] = begins_at(first);

    let offered = eyes.poses[dominant];
    let between = offered.orientation.inverse() * (eyes.poses[other].position - offered.position);
    let mut poses = [submitted.pose; 2];
    poses[other] = submitted.pose.translated_local(between);
    let pair = EyePair { poses, frusta, depth, size: part, dominant: eyes.dominant };
    // The guard band is the part of the image, on that side, beyond both eyes.
    let beyond = |columns: f32| (columns - ROUNDING).ceil().max(0.0) as u32;
    let guard = match eyes.dominant.other() {
        Eye::Left => crop.origin[0].saturating_sub(beyond(left - first)),
        Eye::Right => (size[0] - part[0] - crop.origin[0]).saturating_sub(beyond(first - left)),
    };
    let views = pair.synthesis_views(GuardBand::Pixels(guard.min(GuardBand::MAX_PIXELS)))?;
    let inside = views.dominant_crop_from_top();
    let origin = crop.origin[0].checked_sub(inside[0]).zip(crop.origin[1].checked_sub(inside[1]));
    let fits = |origin: &(u32, u32)| {
        origin.0 + views.source.size[0] <= size[0] && origin.1 + views.source.size[1] <= size[1]
    };
    let origin = origin.filter(fits).ok_or(GeometryError::Rectangle { size })?;
    let source = Rectangle { origin: [origin.0, origin.1], size: views.source.size };
    // The law expects depth from 0 to 1, while the stored depth is between minDepth and maxDepth.
    let mut warp = views.warp;
    warp.law.scale /= f64::from(max - min);
    warp.law.offset -= warp.law.scale * f64::from(min);
    Ok(Split { crop, poses, frusta, source, warp })
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use yoro::eyes::{DepthConvention, SynthesisViews};

    use super::*;

    const SIZE: [u32; 2] = [1000, 900];

    /// The outer edges of the eyes of common headsets are farther out than the inner ones.
    fn views(cant_degrees: f32) -> [(Pose, Frustum); 2] {
        let head = Quat::from_euler(glam::EulerRot::YXZ, 0.7, -0.2, 0.1);
        [-1.0f32, 1.0].map(|side| {
            let (outer, inner) = (0.92, 0.72);
            let (left, right) = if side < 0.0 { (outer, inner) } else { (inner, outer) };
            let pose = Pose {
                position: Vec3::new(1.0, 1.6, -2.0) + head * Vec3::X * (side * 0.032),
                orientation: head * Quat::from_rotation_y(-side * cant_degrees.to_radians()),
            };
            (pose, Frustum::from_fov(-left, right, 0.75, -0.85))
        })
    }

    fn offer(dominant: Eye, cant_degrees: f32) -> Offer {
        Offer::new(views(cant_degrees), SIZE, dominant, GuardBand::Distance(0.5)).unwrap()
    }

    fn submitted(offer: &Offer) -> Submitted {
        let depth = SubmittedDepth { near: 0.1, far: 100.0, min: 0.0, max: 1.0 };
        Submitted { pose: offer.pose, frustum: offer.frustum, size: offer.size, depth }
    }

    fn expected(offer: &Offer, depth: DepthRange) -> SynthesisViews {
        EyePair { depth, ..offer.eyes }.synthesis_views(GuardBand::Distance(0.5)).unwrap()
    }

    fn close(a: &Warp, b: &Warp) {
        assert_eq!(
            (a.source_size, a.target_size, a.row_offset),
            (b.source_size, b.target_size, b.row_offset)
        );
        assert_eq!((a.target_eye, a.convention), (b.target_eye, b.convention));
        let same = |a: f64, b: f64| (a - b).abs() < 0.01;
        assert!(same(a.law.offset, b.law.offset) && same(a.law.scale, b.law.scale), "{a:?} {b:?}");
    }

    #[test]
    fn the_offered_view_contains_both_eyes_and_the_guard_band() {
        for dominant in Eye::BOTH {
            let offer = offer(dominant, 0.0);
            let own = views(0.0);
            assert_eq!(offer.pose, own[dominant.index()].0);
            for (_, frustum) in own {
                let f = offer.frustum;
                assert!(f.left <= frustum.left + 1e-5 && f.right >= frustum.right - 1e-5, "{f:?}");
                assert!(f.bottom <= frustum.bottom + 1e-5 && f.top >= frustum.top - 1e-5, "{f:?}");
            }
            assert!(offer.size[0] > SIZE[0] && offer.size[1] == SIZE[1], "{:?}", offer.size);
        }
    }

    #[test]
    fn what_is_rendered_as_offered_is_split_as_the_core_synthesizes() {
        for (dominant, cant) in [(Eye::Left, 0.0), (Eye::Right, 0.0), (Eye::Right, 5.0)] {
            let offer = offer(dominant, cant);
            let split = split(&offer.eyes, &submitted(&offer)).unwrap();
            let depth = DepthRange { near: 0.1, far: 100.0, convention: DepthConvention::Standard };
            let views = expected(&offer, depth);
            assert_eq!(split.source, Rectangle { origin: [0; 2], size: offer.size });
            assert_eq!(split.crop.origin, views.dominant_crop_from_top());
            close(&split.warp, &views.warp);
            for eye in Eye::BOTH {
                let (pose, own) = (split.poses[eye.index()], offer.eyes.poses[eye.index()]);
                assert!((pose.position - own.position).length() < 1e-5);
                assert!(pose.orientation.angle_between(own.orientation) < 1e-3);
                let (f, own) = (split.frusta[eye.index()], offer.eyes.frusta[eye.index()]);
                assert!((f.left - own.left).abs() < 1e-4 && (f.top - own.top).abs() < 1e-4, "{f:?} {own:?}");
            }
        }
    }

    #[test]
    fn the_submitted_pose_field_of_view_and_size_are_trusted() {
        let offer = offer(Eye::Right, 0.0);
        let moved = Pose { position: Vec3::new(-3.0, 0.5, 0.0), orientation: Quat::from_rotation_y(2.0) };
        let mut submitted = Submitted { pose: moved, size: [777, 501], ..submitted(&offer) };
        // Narrower on the left than offered: the eyes show what the image contains.
        submitted.frustum.left *= 0.8;
        let split = split(&offer.eyes, &submitted).unwrap();
        assert_eq!(split.poses[1], moved);
        assert!(
            (split.poses[0].position - moved.translated_local(Vec3::X * -0.064).position).length() < 1e-5
        );
        for frustum in split.frusta {
            let width = split.crop.size[0] as f32 * submitted.frustum.width() / 777.0;
            assert!((frustum.width() - width).abs() < 1e-5);
            assert!(frustum.left >= submitted.frustum.left - 1e-6, "{frustum:?}");
        }
        assert!(split.source.origin[0] + split.source.size[0] <= 777);
        assert!(split.crop.size[1] <= 501);
    }

    /// A point at a distance lands in the same column, however its depth is stored.
    #[test]
    fn depth_may_be_reversed_infinite_and_in_a_part_of_its_range() {
        let offer = offer(Eye::Right, 0.0);
        let displacement = |near: f32, far: f32, min: f32, max: f32| {
            let depth = SubmittedDepth { near, far, min, max };
            let split = split(&offer.eyes, &Submitted { depth, ..submitted(&offer) }).unwrap();
            let (near, far, z) = (f64::from(near), f64::from(far), 2.0);
            let stored =
                f64::from(min) + (1.0 / z - 1.0 / near) / (1.0 / far - 1.0 / near) * f64::from(max - min);
            (split.warp.law.displacement(stored), split.warp.convention)
        };
        let (plain, convention) = displacement(0.1, 100.0, 0.0, 1.0);
        assert_eq!(convention, DepthConvention::Standard);
        for (near, far, min, max) in [
            (100.0, 0.1, 0.0, 1.0),
            (f32::INFINITY, 0.1, 0.0, 1.0),
            (0.1, f32::INFINITY, 0.0, 1.0),
            (0.05, 50.0, 0.25, 0.75),
            (f32::INFINITY, 0.1, 0.5, 1.0),
        ] {
            let (moved, convention) = displacement(near, far, min, max);
            assert!((moved - plain).abs() < 0.02, "{near} {far} {min} {max}: {moved} {plain}");
            assert_eq!(convention == DepthConvention::Reversed, near > far);
        }
    }

    #[test]
    fn nonsense_is_refused() {
        let offer = offer(Eye::Right, 0.0);
        let spoilt: [fn(&mut Submitted); 8] = [
            |s| s.depth.near = 0.0,
            |s| s.depth.near = f32::NAN,
            |s| s.depth.max = s.depth.min,
            |s| s.depth.max = f32::NAN,
            |s| (s.depth.near, s.depth.far) = (f32::INFINITY, f32::INFINITY),
            |s| s.frustum.left = f32::NAN,
            |s| (s.frustum.top, s.frustum.bottom) = (s.frustum.bottom, s.frustum.top),
            |s| s.size[0] = 0,
        ];
        for (i, spoil) in spoilt.into_iter().enumerate() {
            let mut submitted = submitted(&offer);
            spoil(&mut submitted);
            assert!(split(&offer.eyes, &submitted).is_err(), "case {i}");
        }
        let mut blind = submitted(&offer);
        blind.pose.orientation = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        assert_eq!(split(&offer.eyes, &blind), Err(EyesError::Invalid.into()));
    }

    #[test]
    fn rows_are_counted_from_where_the_image_begins() {
        let submitted = Rectangle { origin: [100, 50], size: [300, 200] };
        let part = Rectangle { origin: [10, 20], size: [280, 150] };
        assert_eq!(submitted.part(part, true), Rectangle { origin: [110, 70], size: [280, 150] });
        assert_eq!(submitted.part(part, false), Rectangle { origin: [110, 80], size: [280, 150] });
    }

    #[test]
    fn angles_go_there_and_back() {
        let fov = sys::Fovf { angle_left: -0.9, angle_right: 0.7, angle_up: 0.6, angle_down: -0.8 };
        let back = xr_fov(frustum(fov));
        for (a, b) in [(fov.angle_left, back.angle_left), (fov.angle_up, back.angle_up)] {
            assert!((a - b).abs() < 1e-6);
        }
        let there = views(5.0)[0].0;
        assert_eq!(pose(xr_pose(there)), there);
    }
}
