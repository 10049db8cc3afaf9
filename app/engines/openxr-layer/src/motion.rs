//! Motion vectors, of which runtimes make frames (XR_EXT_frame_synthesis, XR_FB_space_warp): what the application chains
//! to its view, and what both eyes get instead.
//!
//! The application's vectors refer to its whole view, so each eye's are longer by the factor by which the eye is narrower.
//! XR_EXT_frame_synthesis multiplies vectors by a scale, which takes the factor: the dominant eye's vectors are then a part of
//! the application's image. XR_FB_space_warp has no scale, so both eyes' vectors are written anew.

use std::ffi::c_void;

use openxr_sys as sys;
use yoro::eyes::{EyePair, EyesError, GuardBand, MotionMap, MotionWarp, Ndc, VectorSpace, VectorsOf, Warp};
use yoro::synthesis::ArgumentError;

use crate::geometry::{Rectangle, Split, SubmittedDepth};
use crate::reason::Reason;
use crate::structures;

/// The formats with two components: RG16F and RG32F of OpenGL, R16G16_SFLOAT and R32G32_SFLOAT of Vulkan.
const TWO_COMPONENTS: [i64; 4] = [0x822F, 0x8230, 83, 103];

/// The change of a submitted view's edges between frames, in widths of an eye, that is rounding to pixels.
const ROUNDING: f32 = 1e-3;

/// The structure for the vectors of a view.
#[derive(Clone, Copy)]
pub enum MotionInfo {
    FrameSynthesis(sys::FrameSynthesisInfoEXT),
    SpaceWarp(sys::CompositionLayerSpaceWarpInfoFB),
}

/// Reads or writes a member that both structures have.
macro_rules! member {
    ($info:expr, $member:ident) => {
        match $info {
            MotionInfo::FrameSynthesis(info) => &info.$member,
            MotionInfo::SpaceWarp(info) => &info.$member,
        }
    };
    ($info:expr, $member:ident = $value:expr) => {
        match $info {
            MotionInfo::FrameSynthesis(info) => info.$member = $value,
            MotionInfo::SpaceWarp(info) => info.$member = $value,
        }
    };
}

impl MotionInfo {
    /// Returns the structure in a view's chain, if it contains one.
    ///
    /// # Safety
    /// The view belongs to a submitted layer.
    pub unsafe fn of(view: &sys::CompositionLayerProjectionView) -> Option<MotionInfo> {
        // SAFETY: the view's chain, and the structures of these types.
        unsafe {
            let info = structures::find(view.next, sys::FrameSynthesisInfoEXT::TYPE);
            let warp = || structures::find(view.next, sys::CompositionLayerSpaceWarpInfoFB::TYPE);
            info.map(|info| MotionInfo::FrameSynthesis(*info))
                .or_else(|| warp().map(|info| MotionInfo::SpaceWarp(*info)))
        }
    }

    /// Returns the images of vectors and of their depth.
    pub fn images(&self) -> [&sys::SwapchainSubImage; 2] {
        [member!(self, motion_vector_sub_image), member!(self, depth_sub_image)]
    }

    pub fn depth(&self) -> SubmittedDepth {
        SubmittedDepth {
            near: *member!(self, near_z),
            far: *member!(self, far_z),
            min: *member!(self, min_depth),
            max: *member!(self, max_depth),
        }
    }

    /// Returns what a vector's x, y and z are multiplied by, and what is added then.
    pub fn scaling(&self) -> Scaling {
        match self {
            MotionInfo::FrameSynthesis(info) => {
                let xyz = |v: sys::Vector4f| [v.x, v.y, v.z];
                Scaling { scale: xyz(info.motion_vector_scale), offset: xyz(info.motion_vector_offset) }
            }
            MotionInfo::SpaceWarp(_) => Scaling { scale: [1.0; 3], offset: [0.0; 3] },
        }
    }

    /// Returns the application's structure with an eye's images and scaling.
    pub fn with(&self, [vectors, depth]: [sys::SwapchainSubImage; 2], scaling: &Scaling) -> MotionInfo {
        let mut info = *self;
        member!(&mut info, motion_vector_sub_image = vectors);
        member!(&mut info, depth_sub_image = depth);
        if let MotionInfo::FrameSynthesis(info) = &mut info {
            let four = |[x, y, z]: [f32; 3], w| sys::Vector4f { x, y, z, w };
            info.motion_vector_scale = four(scaling.scale, info.motion_vector_scale.w);
            info.motion_vector_offset = four(scaling.offset, info.motion_vector_offset.w);
        }
        info
    }

    /// Chains another structure to this one, and returns it as a chain.
    pub fn chain(&mut self, next: *const c_void) -> *const c_void {
        member!(&mut *self, next = next);
        match self {
            MotionInfo::FrameSynthesis(info) => std::ptr::from_ref(info).cast(),
            MotionInfo::SpaceWarp(info) => std::ptr::from_ref(info).cast(),
        }
    }

    /// Checks that the vectors have three components. `format` is that of their swapchain.
    ///
    /// # Errors
    /// [`Reason::Vectors`].
    pub fn check(&self, format: i64) -> Result<(), Reason> {
        let flat = sys::FrameSynthesisInfoFlagsEXT::USE_2D_MOTION_VECTOR;
        let is_flat = matches!(self, MotionInfo::FrameSynthesis(info) if info.layer_flags.contains(flat));
        if is_flat || TWO_COMPONENTS.contains(&format) {
            return Err(Reason::Vectors(ArgumentError::TwoComponents));
        }
        Ok(())
    }
}

/// What a runtime makes of stored vectors: x, y and z are multiplied by `scale`, then `offset` is added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    pub scale: [f32; 3],
    pub offset: [f32; 3],
}

/// The place of vectors in a frame, to which those of the next frame point.
#[derive(Clone, Copy)]
pub struct Place {
    /// The eyes, with the depth planes of the vectors.
    eyes: EyePair,
    /// Corner and size of the submitted view relative to the dominant eye's part, in widths and heights of that part.
    whole: [f32; 4],
}

/// How the application's vectors become those of the eyes. Rectangles count from the upper left corner of the vectors' own.
pub struct MotionSplit {
    /// The dominant eye's part. Its edges are those of the eye to half a texel. The other eye's image has the same size.
    pub crop: Rectangle,
    /// From the application's whole image to the dominant eye's, and to the other's.
    pub warps: [MotionWarp; 2],
    /// Those of the vectors that the warps write, in the same order. The first also applies to a crop of the application's
    /// image, unless the vectors cannot be scaled.
    pub scalings: [Scaling; 2],
    pub place: Place,
}

impl MotionSplit {
    /// Returns how vectors in an image of this size become those of the eyes of a submitted view, whose own size is `whole`.
    /// `gl` is true if NDC are those of OpenGL, unless the extension says otherwise. `former` is the place in the last frame,
    /// or `None` if that had no vectors.
    ///
    /// # Errors
    /// [`Reason::Geometry`], and [`Reason::Views`] if the vectors of the two frames have no law in common.
    pub fn new(
        info: &MotionInfo,
        split: &Split,
        whole: [u32; 2],
        size: [u32; 2],
        gl: bool,
        former: Option<Place>,
    ) -> Result<MotionSplit, Reason> {
        let (can_scale, ndc) = match info {
            MotionInfo::FrameSynthesis(_) => (true, Ndc::ZeroToOne),
            MotionInfo::SpaceWarp(_) if gl => (false, Ndc::MinusOneToOne),
            MotionInfo::SpaceWarp(_) => (false, Ndc::ZeroToOne),
        };
        let depth = info.depth();
        let range = depth.range().map_err(Reason::Geometry)?;
        let crop = in_texels(split.crop, whole, size);
        let eyes = EyePair { depth: range, size: crop.size, ..split.eyes };
        let pixels =
            |i: usize| [split.crop.origin[i], whole[i]].map(|n| n as f32 / split.crop.size[i] as f32);
        let ([left, width], [top, height]) = (pixels(0), pixels(1));
        let place = Place { eyes, whole: [left, top, width, height] };
        let former = former.unwrap_or(place);
        if place.whole.iter().zip(former.whole).any(|(now, then)| (now - then).abs() > ROUNDING) {
            return Err(Reason::Views(EyesError::OtherFrame { what: "the submitted field of view" }));
        }

        // The guard band does not matter: the warp is then one from the whole image.
        let views = |eyes: EyePair| eyes.synthesis_views(GuardBand::None).map_err(Reason::Views);
        let (now, then) = (views(eyes)?, views(EyePair { size: crop.size, ..former.eyes })?);
        let space = VectorSpace { ndc, of: VectorsOf::Eye };
        let law = now.motion(&then, space).map_err(Reason::Views)?.law;

        // The texel in the whole image at which the source of the warp begins, from the left and from the bottom.
        let corner = [
            f64::from(crop.origin[0]) - f64::from(now.dominant_crop[0]),
            f64::from(size[1] - crop.origin[1] - crop.size[1]) - f64::from(now.dominant_crop[1]),
        ];
        let mut warp = Warp { source_size: size, ..now.warp };
        warp.row_offset -= corner[1] as i32;
        warp.law.scale /= f64::from(depth.max - depth.min);
        warp.law.offset -= warp.law.scale * f64::from(depth.min) + corner[0];
        let mut own = warp;
        own.law.scale = 0.0;
        own.law.offset = -f64::from(crop.origin[0]);
        own.row_offset = -((size[1] - crop.origin[1] - crop.size[1]) as i32);

        let given = info.scaling();
        let mut scaling = given;
        if can_scale {
            for (i, factor) in [width, height].into_iter().enumerate() {
                scaling.scale[i] *= factor;
                scaling.offset[i] *= factor;
            }
        }
        // What is added to x is multiplied by the scale afterwards.
        let unscaled = 1.0 / f64::from(scaling.scale[0]);
        if !unscaled.is_finite() {
            return Err(Reason::Scale);
        }
        let of = if can_scale { VectorsOf::Eye } else { VectorsOf::Source };
        let per_depth = law.per_depth / f64::from(depth.max - depth.min);
        let other = MotionMap {
            per_z: law.per_z * f64::from(given.scale[2]) * unscaled,
            per_depth: per_depth * unscaled,
            constant: (law.constant - per_depth * f64::from(depth.min)) * unscaled,
            of,
        };
        let still = MotionMap { per_z: 0.0, per_depth: 0.0, constant: 0.0, of };
        let mut others = scaling;
        others.offset[0] += law.per_z as f32 * given.offset[2];
        Ok(MotionSplit {
            crop,
            warps: [MotionWarp { warp: own, law: still }, MotionWarp { warp, law: other }],
            scalings: [scaling, others],
            place,
        })
    }
}

/// Returns the rectangle of texels, in an image of this size, that is nearest to a rectangle of pixels in `whole`.
fn in_texels(part: Rectangle, whole: [u32; 2], size: [u32; 2]) -> Rectangle {
    let axis = |i: usize| {
        let texels = size[i] as f32 / whole[i] as f32;
        let extent = ((part.size[i] as f32 * texels).round() as u32).clamp(1, size[i]);
        let middle = (part.origin[i] as f32 + part.size[i] as f32 / 2.0) * texels;
        let first = (middle - extent as f32 / 2.0).round() as u32;
        [first.min(size[i] - extent), extent]
    };
    let [[x, width], [y, height]] = [axis(0), axis(1)];
    Rectangle { origin: [x, y], size: [width, height] }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use yoro::eyes::{Eye, Frustum, Pose};

    use super::*;
    use crate::geometry::{Offer, Submitted};
    use crate::mirror;

    const DEPTH: SubmittedDepth = SubmittedDepth { near: 20.0, far: 0.1, min: 0.1, max: 0.9 };
    const VELOCITY: Vec3 = Vec3::new(0.05, -0.03, 0.2);

    /// Returns the structure of an extension, with an unusual scale if it has one.
    fn info(can_scale: bool) -> MotionInfo {
        // SAFETY: plain data.
        let (mut synthesis, mut warp): (sys::FrameSynthesisInfoEXT, sys::CompositionLayerSpaceWarpInfoFB) =
            unsafe { (std::mem::zeroed(), std::mem::zeroed()) };
        let four = |x, y, z| sys::Vector4f { x, y, z, w: 7.0 };
        synthesis.motion_vector_scale = four(0.5, -1.0, 2.0);
        synthesis.motion_vector_offset = four(0.01, 0.02, -0.03);
        (synthesis.near_z, synthesis.far_z) = (DEPTH.near, DEPTH.far);
        (synthesis.min_depth, synthesis.max_depth) = (DEPTH.min, DEPTH.max);
        (warp.near_z, warp.far_z) = (DEPTH.near, DEPTH.far);
        (warp.min_depth, warp.max_depth) = (DEPTH.min, DEPTH.max);
        if can_scale { MotionInfo::FrameSynthesis(synthesis) } else { MotionInfo::SpaceWarp(warp) }
    }

    /// Returns the view of a frame as the application submits it, and how it is split. The frusta are asymmetric.
    fn frame(dominant: Eye, ipd: f32, head: Pose, flips: [bool; 2]) -> (Submitted, Split) {
        let views = Eye::BOTH.map(|eye| {
            let frustum = match eye {
                Eye::Left => Frustum { left: -1.1, right: 0.9, bottom: -0.8, top: 1.0 },
                Eye::Right => Frustum { left: -0.9, right: 1.1, bottom: -0.8, top: 1.0 },
            };
            (head.translated_local(Vec3::X * (eye.side() * ipd / 2.0)), frustum)
        });
        let offer = Offer::new(views, [640, 560], dominant, GuardBand::Pixels(48)).unwrap();
        let Frustum { left, right, bottom, top } = offer.frustum;
        let [left, right] = if flips[0] { [right, left] } else { [left, right] };
        let [bottom, top] = if flips[1] { [top, bottom] } else { [bottom, top] };
        let frustum = Frustum { left, right, bottom, top };
        let submitted = Submitted { pose: offer.pose, frustum, size: offer.size, depth: DEPTH };
        let split = mirror::split(&offer.eyes, &submitted, false).unwrap();
        (submitted, split)
    }

    /// Returns NDC, with z from 0 to 1.
    fn ndc(pose: Pose, frustum: Frustum, point: Vec3) -> [f64; 3] {
        let seen = (pose.orientation.inverse() * (point - pose.position)).as_dvec3();
        let across = |low: f32, high: f32, at: f64| 2.0 * (at - f64::from(low)) / f64::from(high - low) - 1.0;
        let z = (1.0 / -seen.z - 1.0 / f64::from(DEPTH.near)) / f64::from(1.0 / DEPTH.far - 1.0 / DEPTH.near);
        [
            across(frustum.left, frustum.right, seen.x / -seen.z),
            across(frustum.bottom, frustum.top, seen.y / -seen.z),
            z,
        ]
    }

    /// Of moving points, seen by a moving head in two frames between which the wearer changes the distance of the eyes.
    #[test]
    fn the_vectors_of_both_eyes_are_those_of_the_points_that_they_show() {
        let then = Pose { position: Vec3::new(0.1, 1.6, 0.0), orientation: Quat::from_rotation_y(0.2) };
        let now = Pose { position: Vec3::new(0.15, 1.58, -0.1), orientation: Quat::from_rotation_y(0.23) };
        let mut compared = 0;
        for dominant in Eye::BOTH {
            for flips in [[false, false], [true, false], [false, true]] {
                for (can_scale, gl) in [(true, true), (false, true), (false, false)] {
                    let (old, old_split) = frame(dominant, 0.063, then, flips);
                    let (new, split) = frame(dominant, 0.066, now, flips);
                    let size = new.size.map(|n| n / 4);
                    let motion = |split, former| {
                        MotionSplit::new(&info(can_scale), split, new.size, size, gl, former).unwrap()
                    };
                    let motion = motion(&split, Some(motion(&old_split, None).place));
                    let unit = if gl && !can_scale { 2.0 } else { 1.0 };
                    let given = info(can_scale).scaling();
                    for i in 0..60u8 {
                        let [x, y, z] = [i % 5, i / 5 % 4, i / 20].map(f32::from);
                        let seen = Vec3::new(0.35 * x - 0.6, 0.3 * y - 0.4, -1.0) * (0.5 + 0.9 * z);
                        let point = now.position + now.orientation * seen;
                        let former = point - VELOCITY;
                        // As the application stores it.
                        let wide = ndc(new.pose, new.frustum, point);
                        let wide_then = ndc(old.pose, old.frustum, former);
                        let stored = [0, 1, 2].map(|i| {
                            let vector = (wide[i] - wide_then[i]) * if i == 2 { unit } else { 1.0 };
                            (vector - f64::from(given.offset[i])) / f64::from(given.scale[i])
                        });
                        let depth = f64::from(DEPTH.min) + wide[2] * f64::from(DEPTH.max - DEPTH.min);
                        for (which, eye) in [dominant, dominant.other()].into_iter().enumerate() {
                            let place = ndc(split.poses[eye.index()], split.frusta[eye.index()], point);
                            let place_then =
                                ndc(old_split.poses[eye.index()], old_split.frusta[eye.index()], former);
                            let (warp, scaling) = (&motion.warps[which], &motion.scalings[which]);
                            let made = warp.vector(stored, depth);
                            // A part of a crop's texel is lost where no scale can take it.
                            let lost = if can_scale { 1e-4 } else { 0.003 };
                            for axis in 0..3 {
                                let vector =
                                    (place[axis] - place_then[axis]) * if axis == 2 { unit } else { 1.0 };
                                let [scale, offset] =
                                    [scaling.scale, scaling.offset].map(|n| f64::from(n[axis]));
                                let seen = made[axis] * scale + offset;
                                let error = (seen - vector).abs();
                                assert!(
                                    error < 1e-4 + lost * vector.abs(),
                                    "{dominant:?} {flips:?} {can_scale} {gl}: {eye:?}, axis {axis}: {seen}, {vector}"
                                );
                            }
                            // It is written where the eye shows the point.
                            let column = |ndc: f64, size: [u32; 2]| (ndc + 1.0) / 2.0 * f64::from(size[0]);
                            let landed = column(wide[0], size) + warp.warp.law.displacement(depth);
                            let shown = column(place[0], motion.crop.size);
                            assert!((landed - shown).abs() < 0.75, "{eye:?}: {landed}, {shown}");
                            compared += 1;
                        }
                    }
                }
            }
        }
        assert_eq!(compared, 2 * 3 * 3 * 60 * 2);
    }

    #[test]
    fn a_view_that_has_widened_since_the_last_frame_has_no_law() {
        let head = Pose { position: Vec3::ZERO, orientation: Quat::IDENTITY };
        let (view, split) = frame(Eye::Right, 0.063, head, [false; 2]);
        let motion = |size, former| MotionSplit::new(&info(true), &split, size, [160, 140], true, former);
        let place = motion(view.size, None).unwrap().place;
        assert!(motion(view.size, Some(place)).is_ok());
        let wider = motion([view.size[0] + 40, view.size[1]], Some(place));
        assert!(matches!(wider, Err(Reason::Views(EyesError::OtherFrame { .. }))));
    }

    #[test]
    fn two_components_are_refused_and_so_is_a_scale_of_nothing() {
        let MotionInfo::FrameSynthesis(mut synthesis) = info(true) else { unreachable!() };
        assert!(MotionInfo::FrameSynthesis(synthesis).check(0x881A).is_ok());
        assert!(matches!(MotionInfo::FrameSynthesis(synthesis).check(0x822F), Err(Reason::Vectors(_))));
        synthesis.layer_flags = sys::FrameSynthesisInfoFlagsEXT::USE_2D_MOTION_VECTOR;
        assert!(matches!(MotionInfo::FrameSynthesis(synthesis).check(97), Err(Reason::Vectors(_))));
        synthesis.motion_vector_scale.x = 0.0;
        let head = Pose { position: Vec3::ZERO, orientation: Quat::IDENTITY };
        let (view, split) = frame(Eye::Right, 0.063, head, [false; 2]);
        let info = MotionInfo::FrameSynthesis(synthesis);
        let motion = MotionSplit::new(&info, &split, view.size, [160, 140], true, None);
        assert!(matches!(motion, Err(Reason::Scale)));
    }
}
