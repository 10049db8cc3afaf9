//! Views in any pose near the rendered one: the mapping of pixels to them, and the larger view to render for them.

use glam::{DMat3, DVec3};
use yoro::eyes::{HeadMotion, PoseWarp, View};

use crate::result::{Failure, YORO_ERROR_NULL, YoroMessages, YoroResult, catch_errors};
use crate::types::{YoroClip, YoroDepth, YoroRows, clip, rows_down};
use crate::versioned::{self, Given, check_reserved, versioned};
use crate::views::{YoroView, depth_range, image};

/// Two views of a scene: a rendered one, and one in any pose near it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroPoses {
    /// sizeof(YoroPoses).
    pub struct_size: u32,
    /// The meaning of the depth buffers' values.
    pub depth: YoroDepth,
    /// Distance of the near plane of both views in metres, more than 0.
    pub near_z: f32,
    /// Distance of the far plane of both views in metres; may be INFINITY.
    pub far_z: f32,
    /// Order of rows in the images.
    pub rows: YoroRows,
    /// Must be 0.
    pub reserved: u32,
    /// The rendered view. Of this view and the target, the size, pose and angles are read, which may differ. The
    /// matrices are ignored.
    pub source: *const YoroView,
    /// The view to synthesize.
    pub target: *const YoroView,
    /// Receives error messages.
    pub messages: YoroMessages,
}

versioned!(YoroPoses);

/// The mapping of pixels from a rendered view to one in any pose near it, for yoro_gl_synthesize_pose and
/// yoro_vk_record_pose. yoro_pose_warp fills it. It can be copied and kept.
///
/// A surface that the target shows at the pixel (x, y), at the distance 1 / k along its viewing axis, lies in the
/// source at the homogeneous pixel homography * (x, y, 1) + k * epipole.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroPoseWarp {
    /// Width of the rendered colour and depth in pixels.
    pub source_width: u32,
    /// Height of the rendered colour and depth in pixels.
    pub source_height: u32,
    /// Width of the synthesized image in pixels.
    pub target_width: u32,
    /// Height of the synthesized image in pixels.
    pub target_height: u32,
    /// The homography of the rotation, column-major.
    pub homography: [f64; 9],
    /// Position of the target's eye in the source image. Set it to zeros to apply the rotation only, without depth.
    pub epipole: [f64; 3],
    /// The source's depth buffer holds values for which 1 / distance is `source_law[0] + source_law[1] * depth`.
    pub source_law: [f64; 2],
    /// The same for the target.
    pub target_law: [f64; 2],
    /// Depth value, in the source, of the nearest surface that the target may show.
    pub nearest: f64,
    /// Depth value of the source's far plane.
    pub far_depth: f64,
}

/// Computes the mapping of pixels from a rendered view to one in any pose near it.
///
/// Call it from any thread, without a context. It allocates and keeps nothing.
///
/// @param poses The views.
/// @param warp  Receives the mapping.
/// @pre The pointers point to structures, `poses` to one of the size that it states.
/// @return YORO_ERROR_VALUE for impossible views, and if the target sees more than 80 degrees away from the source's
///         axis; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_pose_warp(poses: *const YoroPoses, warp: *mut YoroPoseWarp) -> YoroResult {
    catch_errors(|told| {
        // SAFETY: the header requires a pointer to a structure of the size that it states.
        let poses = unsafe { versioned::read(poses, "poses") }?;
        *told = poses.messages;
        check_reserved("poses", &[poses.reserved])?;
        if poses.source.is_null() || poses.target.is_null() || warp.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "source, target or warp is NULL: give all"));
        }
        let range = depth_range(poses.near_z, poses.far_z, poses.depth)?;
        // SAFETY: the header requires pointers to views; the read needs no alignment.
        let read = |view: *const YoroView| unsafe { view.read_unaligned() }.core(range);
        let result = PoseWarp::new(&read(poses.source)?, &read(poses.target)?)?;
        // The core counts rows from the bottom.
        let result = if rows_down(poses.rows)? { result.rows_from_top() } else { result };
        // SAFETY: the header requires a pointer to a structure.
        unsafe { warp.write_unaligned(YoroPoseWarp::new(&result)) };
        Ok(())
    })
}

/// The limits of a head's motion between the render and its display, and the view that is rendered.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroHeadMotion {
    /// sizeof(YoroHeadMotion).
    pub struct_size: u32,
    /// Largest angle of rotation about any axis, in radians.
    pub rotation: f32,
    /// Largest distance that an eye moves, in metres.
    pub translation: f32,
    /// Distance from the eye, in metres, beyond which surfaces must stay in the image.
    pub nearest: f32,
    /// Distance of the near plane in metres, more than 0.
    pub near_z: f32,
    /// Distance of the far plane in metres; may be INFINITY.
    pub far_z: f32,
    /// The meaning of the depth buffer's values.
    pub depth: YoroDepth,
    /// Order of rows in the images.
    pub rows: YoroRows,
    /// The clip volume of the resulting matrices.
    pub clip: YoroClip,
    /// Must be 0.
    pub reserved: u32,
    /// The view to widen. Its size, pose and angles are read.
    pub view: *const YoroView,
    /// Receives error messages.
    pub messages: YoroMessages,
}

versioned!(YoroHeadMotion);

/// A view with a guard band on all four sides.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroGuardedView {
    /// sizeof(YoroGuardedView), set by the caller.
    pub struct_size: u32,
    /// First column of the original view's image in the wider one.
    pub crop_x: u32,
    /// First row of the original view's image in the wider one, counted as YoroRows says.
    pub crop_y: u32,
    /// Zero.
    pub reserved: u32,
    /// The wider view, which is the one to render.
    pub view: YoroView,
}

versioned!(YoroGuardedView);

/// Widens a view on all four sides, by whole pixels, so that it contains what the view shows after any such motion.
///
/// Call it from any thread, without a context. It allocates and keeps nothing.
///
/// @param motion  The limits and the view.
/// @param guarded Receives the wider view. The caller sets struct_size.
/// @pre The pointers point to structures of the sizes that they state.
/// @return YORO_ERROR_VALUE for an impossible view, or one that would have to see more than 80 degrees to a side;
///         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_guarded_view(
    motion: *const YoroHeadMotion,
    guarded: *mut YoroGuardedView,
) -> YoroResult {
    catch_errors(|told| {
        // SAFETY: the header requires a pointer to a structure of the size that it states.
        let motion = unsafe { versioned::read(motion, "motion") }?;
        *told = motion.messages;
        // SAFETY: as above.
        unsafe { versioned::check_output(guarded, "guarded") }?;
        check_reserved("motion", &[motion.reserved])?;
        if motion.view.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "view is NULL: give the view to widen"));
        }
        // SAFETY: the header requires a pointer to a view; the read needs no alignment.
        let result = motion.guarded(&unsafe { motion.view.read_unaligned() })?;
        // SAFETY: as above.
        unsafe { versioned::write(guarded, "guarded", &result) }
    })
}

impl YoroHeadMotion {
    fn guarded(&self, view: &YoroView) -> Result<YoroGuardedView, Failure> {
        let range = depth_range(self.near_z, self.far_z, self.depth)?;
        let (clip, down) = (clip(self.clip)?, rows_down(self.rows)?);
        let view: View = view.core(range)?;
        let motion = HeadMotion { rotation: self.rotation, translation: self.translation };
        let guarded = motion.guarded(&view, self.nearest)?;
        let [crop_x, crop_y] = if down { guarded.crop_from_top(view.size) } else { guarded.crop };
        let mut wider = image(&guarded.view, false);
        wider.set_matrices(&range, &clip);
        Ok(YoroGuardedView { struct_size: 0, crop_x, crop_y, reserved: 0, view: wider })
    }
}

impl YoroPoseWarp {
    fn new(warp: &PoseWarp) -> YoroPoseWarp {
        YoroPoseWarp {
            source_width: warp.source_size[0],
            source_height: warp.source_size[1],
            target_width: warp.target_size[0],
            target_height: warp.target_size[1],
            homography: warp.homography.to_cols_array(),
            epipole: warp.epipole.to_array(),
            source_law: warp.source_law,
            target_law: warp.target_law,
            nearest: warp.nearest,
            far_depth: warp.far_depth,
        }
    }
}

impl Given for YoroPoseWarp {
    type Core = PoseWarp;
    const MISSING: &'static str = "warp is NULL: give the one of yoro_pose_warp";

    fn checked(&self) -> Result<PoseWarp, Failure> {
        let sizes = [[self.source_width, self.source_height], [self.target_width, self.target_height]];
        let numbers = [&self.homography[..], &self.epipole, &self.source_law, &self.target_law];
        // Written so that NaN fails too.
        let bounded = |number: &f64| number.abs() < 1e9;
        let [width, height] = sizes[1].map(f64::from);
        let before_the_eye =
            |x: f64, y: f64| self.homography[2] * x + self.homography[5] * y + self.homography[8] > 1e-3;
        let is_whole = sizes.iter().flatten().all(|side| (1..=1 << 16).contains(side))
            && numbers.into_iter().flatten().all(bounded)
            && [self.nearest, self.far_depth].iter().all(|depth| (0.0..=1.0).contains(depth))
            && [self.source_law[1], self.target_law[1]].iter().all(|slope| *slope != 0.0)
            && [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)]
                .into_iter()
                .all(|(x, y)| before_the_eye(x, y));
        if !is_whole {
            return Err(Failure::value("a pose warp is impossible: take it from yoro_pose_warp"));
        }
        Ok(PoseWarp {
            source_size: sizes[0],
            target_size: sizes[1],
            homography: DMat3::from_cols_array(&self.homography),
            epipole: DVec3::from_array(self.epipole),
            source_law: self.source_law,
            target_law: self.target_law,
            nearest: self.nearest,
            far_depth: self.far_depth,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::{YORO_DEPTH_STANDARD, YORO_ROWS_DOWN, YoroFov, YoroPose};

    /// Checks what yoro_vk_record_pose does to the warp of images whose row 0 is at the top.
    #[test]
    fn turned_rows_are_turned_back_for_the_core() {
        let view = |y, orientation: glam::Quat, [width, height]: [u32; 2]| YoroView {
            width,
            height,
            pose: YoroPose { orientation: orientation.to_array(), position: [0.0, y, 0.0] },
            fov: YoroFov { angle_left: -0.7, angle_right: 0.6, angle_up: 0.5, angle_down: -0.55 },
            ..YoroView::default()
        };
        let source = view(1.6, glam::Quat::IDENTITY, [140, 100]);
        let target = view(1.7, glam::Quat::from_rotation_x(0.1), [120, 90]);
        let range = depth_range(0.1, 50.0, YORO_DEPTH_STANDARD).unwrap();
        let expected = PoseWarp::new(&source.core(range).unwrap(), &target.core(range).unwrap()).unwrap();
        let turned = YoroPoseWarp::new(&expected.rows_from_top());
        let poses = YoroPoses {
            struct_size: size_of::<YoroPoses>() as u32,
            depth: YORO_DEPTH_STANDARD,
            near_z: 0.1,
            far_z: 50.0,
            rows: YORO_ROWS_DOWN,
            reserved: 0,
            source: &source,
            target: &target,
            messages: YoroMessages::NONE,
        };
        let mut warp = YoroPoseWarp::default();
        // SAFETY: complete structures.
        assert_eq!(unsafe { yoro_pose_warp(&poses, &mut warp) }, crate::result::YORO_OK);
        assert_eq!(warp, turned);
        let back = warp.checked().unwrap().rows_from_top();
        assert!(back.homography.abs_diff_eq(expected.homography, 1e-12));
        assert!(back.epipole.abs_diff_eq(expected.epipole, 1e-12));
    }
}
