//! Eyes given as poses and angles, as OpenXR locates them.

use yoro::eyes::{DepthRange, EyePair};

use crate::result::{Failure, YORO_ERROR_EYES_CANTED, YoroMessages, YoroResult};
use crate::types::{
    Clip, YoroClip, YoroDepth, YoroEye, YoroFov, YoroPose, YoroRows, clip, depth, eye, rows_down,
};
use crate::versioned::{check_reserved, versioned};
use crate::views::{YoroViews, fill_views, guard_band, images, views};

/// Bits that change eyes which cannot be synthesized as they are.
pub type YoroEyesFlags = u32;
/// Gives both eyes frusta of the same width and height over the same rows, large enough to contain their own. Display
/// the images with the resulting angles.
pub const YORO_EYES_EVEN: YoroEyesFlags = 1;
/// Turns both eyes, without moving them, to one direction at right angles to the line between them, and gives them
/// frusta of the same size that contain their own. For canted eyes, and for eyes that do not lie on one horizontal
/// line, such as those of a calibrated headset. Display the images with the resulting poses and angles: an OpenXR
/// runtime that receives these with the images rotates them back.
pub const YORO_EYES_PARALLEL: YoroEyesFlags = 2;

/// Returns the eyes with the changes that the flags request.
pub(crate) fn with_flags(mut pair: EyePair, flags: YoroEyesFlags) -> Result<EyePair, Failure> {
    if flags & !(YORO_EYES_EVEN | YORO_EYES_PARALLEL) != 0 {
        return Err(Failure::value(format!("{flags} has bits that are no YORO_EYES_ flags")));
    }
    if flags & YORO_EYES_PARALLEL != 0 {
        pair = pair.rectified().ok_or_else(|| {
            Failure::new(
                YORO_ERROR_EYES_CANTED,
                "the eyes see farther than 80 degrees from their common direction: render both",
            )
        })?;
    }
    Ok(if flags & YORO_EYES_EVEN != 0 { pair.row_aligned() } else { pair })
}

/// The two eyes of a frame, given as poses and angles.
///
/// Any unit of length may be used instead of metres, as long as it is the same for all lengths. The eyes may be any
/// distance apart, so a wearer can be a giant or a mouse. Positions are rounded to 32 bits: at 1 km from the origin to
/// 0.06 mm, a thousandth of the distance between the eyes. In larger worlds give poses relative to the head, and
/// translate the resulting view matrices by the head's position.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroEyes {
    /// sizeof(YoroEyes).
    pub struct_size: u32,
    /// The eye that is rendered.
    pub rendered: YoroEye,
    /// Width of each eye's image in pixels.
    pub width: u32,
    /// Height of each eye's image in pixels.
    pub height: u32,
    /// Poses, left eye first.
    pub poses: [YoroPose; 2],
    /// Angles, left eye first.
    pub fovs: [YoroFov; 2],
    /// Distance of the near plane in metres, more than 0.
    pub near_z: f32,
    /// Distance of the far plane in metres, more than near_z even for reversed depth; may be INFINITY.
    pub far_z: f32,
    /// The meaning of the depth buffer's values.
    pub depth: YoroDepth,
    /// The order of rows in the images.
    pub rows: YoroRows,
    /// The clip volume of the resulting matrices.
    pub clip: YoroClip,
    /// Guard band: the distance in metres beyond which the rendered image contains the whole outer border of the other
    /// eye. Smaller values cost more pixels. 0: no guard band, and the border is filled in.
    pub guard_band: f32,
    /// YORO_EYES_ bits.
    pub flags: YoroEyesFlags,
    /// Must be 0.
    pub reserved: u32,
    /// Receives error messages.
    pub messages: YoroMessages,
}

versioned!(YoroEyes);

/// Computes the view to render, and the mapping of its pixels to the other eye.
///
/// Call it from any thread, without a context. It allocates and keeps nothing.
///
/// @param eyes  The eyes.
/// @param views Receives the views. The caller sets struct_size.
/// @pre Both pointers point to structures of the sizes that they state.
/// @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE or a YORO_ERROR_EYES_ code for eyes that are impossible or cannot be
///         synthesized; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_views_from_eyes(eyes: *const YoroEyes, views: *mut YoroViews) -> YoroResult {
    // SAFETY: the header requires pointers to structures of the sizes that they state.
    unsafe { fill_views(eyes, "eyes", views, |eyes| eyes.messages, YoroEyes::views) }
}

/// Eyes that were checked, and turned and grown as their flags ask for.
pub(crate) struct CheckedEyes {
    pub(crate) pair: EyePair,
    /// The directions of the eyes' axes in the world, before they were turned.
    pub(crate) axes: [glam::Vec3; 2],
    pub(crate) clip: Clip,
    pub(crate) rows_down: bool,
}

impl CheckedEyes {
    /// Sets the matrices of views.
    pub(crate) fn with_matrices(&self, mut views: YoroViews) -> YoroViews {
        images(&mut views).into_iter().for_each(|image| image.set_matrices(&self.pair.depth, &self.clip));
        views
    }
}

impl YoroEyes {
    fn views(&self) -> Result<YoroViews, Failure> {
        let eyes = self.checked()?;
        Ok(eyes.with_matrices(views(eyes.pair, guard_band(self.guard_band), eyes.rows_down)?))
    }

    pub(crate) fn checked(&self) -> Result<CheckedEyes, Failure> {
        check_reserved("eyes", &[self.reserved])?;
        let right_angle = std::f32::consts::FRAC_PI_2;
        let angles = self.fovs.iter().flat_map(|f| [f.angle_left, f.angle_right, f.angle_up, f.angle_down]);
        // Written so that NaN fails too.
        if !angles.into_iter().all(|angle| angle.abs() < right_angle) {
            return Err(Failure::value(
                "an angle is not a number or not below a right angle: give signed angles from the axis in radians, as XrFovf",
            ));
        }
        let length = |pose: &YoroPose| pose.orientation.iter().map(|n| n * n).sum::<f32>();
        let is_pose = |pose: &YoroPose| {
            pose.position.iter().all(|n| n.is_finite()) && (length(pose) - 1.0).abs() < 1e-2
        };
        if !self.poses.iter().all(is_pose) {
            return Err(Failure::value(
                "a pose is invalid: give finite positions, and quaternions x, y, z, w of length 1",
            ));
        }
        let depth = DepthRange { near: self.near_z, far: self.far_z, convention: depth(self.depth)? };
        let clip = clip(self.clip)?;
        let pair = EyePair {
            poses: self.poses.each_ref().map(YoroPose::pose),
            frusta: self.fovs.each_ref().map(YoroFov::frustum),
            depth,
            size: [self.width, self.height],
            dominant: eye(self.rendered)?,
        };
        let axes = pair.axes();
        Ok(CheckedEyes { pair: with_flags(pair, self.flags)?, axes, clip, rows_down: rows_down(self.rows)? })
    }
}
