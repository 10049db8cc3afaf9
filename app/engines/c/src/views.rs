//! The view to render for two eyes, and the mapping of its pixels to the other eye.

use glam::{DMat4, DVec4};
use yoro::eyes::{
    DepthRange, DisparityMap, EyePair, EyesError, Frustum, GuardBand, Pose, SynthesisViews, View, Warp,
};

use crate::result::{Failure, YoroMessages, YoroResult, catch_errors};
use crate::types::{
    Clip, YORO_DEPTH_REVERSED, YORO_DEPTH_STANDARD, YoroDepth, YoroEye, YoroFov, YoroPose, depth, eye,
};
use crate::versioned::{self, Given, Versioned, check_reserved, versioned};

/// One image: its size, the pose of its eye, its frustum, and the matrices that render it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroView {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Pose of the eye. For matrices of a left-handed world, the Z axis of the world is negated.
    pub pose: YoroPose,
    /// Angles to the outer edges of the image.
    pub fov: YoroFov,
    /// World to eye, column-major, for column vectors: the translation is in elements 12 to 14.
    pub view: [f32; 16],
    /// Eye to clip space, column-major.
    pub projection: [f32; 16],
}

/// The mapping of pixels from the rendered image to the other eye's. yoro_views_from_eyes and yoro_views_from_matrices
/// fill it. It can be copied and kept.
///
/// The pixel in column x and row y lands in column x + offset + scale * depth and row y + row_offset, where depth is
/// the value in the depth buffer.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroWarp {
    /// Width of the rendered colour and depth in pixels.
    pub source_width: u32,
    /// Height of the rendered colour and depth in pixels.
    pub source_height: u32,
    /// Width of the synthesized image in pixels.
    pub target_width: u32,
    /// Height of the synthesized image in pixels.
    pub target_height: u32,
    /// Displacement in columns at depth 0.
    pub offset: f64,
    /// Displacement in columns per unit of depth.
    pub scale: f64,
    /// Displacement in rows: target row minus source row.
    pub row_offset: i32,
    /// The eye that is synthesized.
    pub target_eye: YoroEye,
    /// The meaning of the depth buffer's values.
    pub depth: YoroDepth,
    /// Must be 0.
    pub reserved: u32,
}

/// The images of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroViews {
    /// sizeof(YoroViews), set by the caller.
    pub struct_size: u32,
    /// First column of the rendered eye's own image in the source.
    pub crop_x: u32,
    /// First row of the rendered eye's own image in the source, counted as YoroRows says.
    pub crop_y: u32,
    /// Zero.
    pub reserved: u32,
    /// The view to render: the rendered eye's view, widened by the guard band. Render colour and depth of this size.
    pub source: YoroView,
    /// The rendered eye's own image: the part of the source, of this size, that begins at crop_x and crop_y.
    pub rendered: YoroView,
    /// The synthesized image.
    pub synthesized: YoroView,
    /// The mapping of pixels, which synthesis takes.
    pub warp: YoroWarp,
}

versioned!(YoroViews);

impl YoroWarp {
    pub(crate) fn new(warp: &Warp) -> YoroWarp {
        YoroWarp {
            source_width: warp.source_size[0],
            source_height: warp.source_size[1],
            target_width: warp.target_size[0],
            target_height: warp.target_size[1],
            offset: warp.law.offset,
            scale: warp.law.scale,
            row_offset: warp.row_offset,
            target_eye: warp.target_eye.index() as YoroEye,
            depth: match warp.convention {
                yoro::eyes::DepthConvention::Standard => YORO_DEPTH_STANDARD,
                yoro::eyes::DepthConvention::Reversed => YORO_DEPTH_REVERSED,
            },
            reserved: 0,
        }
    }
}

impl Given for YoroWarp {
    type Core = Warp;
    const MISSING: &'static str = "warp is NULL: give the one of YoroViews";

    fn checked(&self) -> Result<Warp, Failure> {
        /// The largest width and height. No driver renders larger images.
        const MAX_SIDE: u32 = 1 << 16;
        let sides = [self.source_width, self.source_height, self.target_width, self.target_height];
        if !sides.iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            let [w, h, tw, th] = sides;
            return Err(Failure::value(format!(
                "a warp from {w}x{h} to {tw}x{th} pixels is impossible: take it from yoro_views_from_eyes"
            )));
        }
        check_reserved("warp", &[self.reserved])?;
        let warp = Warp {
            source_size: [self.source_width, self.source_height],
            target_size: [self.target_width, self.target_height],
            law: DisparityMap { offset: self.offset, scale: self.scale },
            row_offset: self.row_offset,
            target_eye: eye(self.target_eye)?,
            convention: depth(self.depth)?,
        };
        // Written so that NaN fails too.
        let in_reach = self.row_offset.unsigned_abs() <= MAX_SIDE && warp.check().is_ok();
        in_reach.then_some(warp).ok_or_else(|| {
            Failure::value("the warp has a displacement beyond all images: take it from yoro_views_from_eyes")
        })
    }
}

/// Runs the body of a function that fills in [`YoroViews`]. `messages` returns the callback in `eyes`, and `work_out`
/// computes the views.
///
/// # Safety
/// Both pointers are null or point to as many bytes as they state.
pub(crate) unsafe fn fill_views<T: Versioned>(
    eyes: *const T,
    what: &'static str,
    views: *mut YoroViews,
    messages: impl FnOnce(&T) -> YoroMessages,
    work_out: impl FnOnce(&T) -> Result<YoroViews, Failure>,
) -> YoroResult {
    catch_errors(|told| {
        // SAFETY: the caller passes a pointer to as many bytes as the structure states.
        let eyes = unsafe { versioned::read(eyes, what) }?;
        *told = messages(&eyes);
        // SAFETY: as above.
        unsafe { versioned::check_output(views, "views") }?;
        let result = work_out(&eyes)?;
        // SAFETY: as above.
        unsafe { versioned::write(views, "views", &result) }
    })
}

/// Returns the guard band that is complete beyond this distance in metres, or none for 0.
pub(crate) fn guard_band(metres: f32) -> GuardBand {
    if metres == 0.0 { GuardBand::None } else { GuardBand::Distance(metres) }
}

/// Mirrors a frustum vertically. The core counts rows from the bottom: rows from the top are those of mirrored eyes.
fn mirrored(frustum: Frustum) -> Frustum {
    Frustum { bottom: -frustum.top, top: -frustum.bottom, ..frustum }
}

/// Returns the eyes whose rows from the bottom are those of images with row 0 at the top, if `down` is true.
pub(crate) fn turned(pair: EyePair, down: bool) -> EyePair {
    if down { EyePair { frusta: pair.frusta.map(mirrored), ..pair } } else { pair }
}

/// Returns the views of a pair, without matrices. `down` is true if row 0 is at the top.
pub(crate) fn views(pair: EyePair, guard: GuardBand, down: bool) -> Result<YoroViews, Failure> {
    views_by(pair, down, |pair| pair.synthesis_views(guard))
}

/// Returns the views of a pair that `find` finds, without matrices.
pub(crate) fn views_by(
    pair: EyePair,
    down: bool,
    find: impl FnOnce(&EyePair) -> Result<SynthesisViews, EyesError>,
) -> Result<YoroViews, Failure> {
    let pair = turned(pair, down);
    let views = find(&pair)?;
    Ok(YoroViews {
        struct_size: size_of::<YoroViews>() as u32,
        crop_x: views.dominant_crop[0],
        crop_y: views.dominant_crop[1],
        reserved: 0,
        source: image(&views.source, down),
        rendered: image(&pair.view(pair.dominant), down),
        synthesized: image(&views.target, down),
        warp: YoroWarp::new(&views.warp),
    })
}

fn pose(pose: &Pose) -> YoroPose {
    YoroPose { orientation: pose.orientation.to_array(), position: pose.position.to_array() }
}

fn fov(frustum: &Frustum) -> YoroFov {
    YoroFov {
        angle_left: frustum.left.atan(),
        angle_right: frustum.right.atan(),
        angle_up: frustum.top.atan(),
        angle_down: frustum.bottom.atan(),
    }
}

impl YoroPose {
    pub(crate) fn pose(&self) -> Pose {
        Pose { position: self.position.into(), orientation: glam::Quat::from_array(self.orientation) }
    }
}

impl YoroFov {
    pub(crate) fn frustum(&self) -> Frustum {
        Frustum::from_fov(self.angle_left, self.angle_right, self.angle_up, self.angle_down)
    }
}

/// Returns the depth planes of views that are given one by one.
pub(crate) fn depth_range(near: f32, far: f32, convention: YoroDepth) -> Result<DepthRange, Failure> {
    let range = DepthRange { near, far, convention: depth(convention)? };
    // Written so that NaN fails too.
    if near > 0.0 && near < far && near.is_finite() {
        Ok(range)
    } else {
        Err(Failure::value("near_z or far_z is impossible: give 0 < near_z < far_z, those of the eyes"))
    }
}

/// Returns an image without matrices. `turned` is true if the view belongs to an image with row 0 at the top.
pub(crate) fn image(view: &View, turned: bool) -> YoroView {
    let frustum = if turned { mirrored(view.frustum) } else { view.frustum };
    YoroView {
        width: view.size[0],
        height: view.size[1],
        pose: pose(&view.pose),
        fov: fov(&frustum),
        ..YoroView::default()
    }
}

impl YoroView {
    /// Returns the core's view, with size, pose and angles of this view, and these depth planes.
    pub(crate) fn core(&self, depth: DepthRange) -> Result<View, Failure> {
        let (pose, frustum) = (self.pose.pose(), self.fov.frustum());
        let view = View { pose, frustum, depth, size: [self.width, self.height] };
        let angles = [frustum.left, frustum.right, frustum.bottom, frustum.top];
        let is_whole = view.size.iter().all(|side| (1..=1 << 16).contains(side))
            && angles.iter().all(|tangent| tangent.is_finite())
            && frustum.left < frustum.right
            && frustum.bottom < frustum.top
            && pose.position.is_finite()
            && (pose.orientation.length_squared() - 1.0).abs() < 1e-2;
        is_whole.then_some(view).ok_or_else(|| {
            Failure::value("a view has an impossible size, pose or angle: take it from yoro_views_from_eyes")
        })
    }

    /// Returns the x and y rows of the projection for an eye that looks along -Z.
    pub(crate) fn projection_xy(&self, clip: &Clip) -> [DVec4; 2] {
        let [left, right, top, bottom] =
            [self.fov.angle_left, self.fov.angle_right, self.fov.angle_up, self.fov.angle_down]
                .map(|angle| f64::from(angle).tan());
        let (width, height) = (right - left, clip.up * (top - bottom));
        [
            DVec4::new(2.0 / width, 0.0, (right + left) / width, 0.0),
            DVec4::new(0.0, 2.0 / height, clip.up * (top + bottom) / height.abs(), 0.0),
        ]
    }

    /// Sets the matrices for an eye that looks along -Z.
    pub(crate) fn set_matrices(&mut self, range: &DepthRange, clip: &Clip) {
        let (c, m) = range.inverse_distance_law();
        // depth = (1 / z - c) / m, where z is the distance; the clip volume's z = scale * depth + offset, times z.
        let along = DVec4::new(0.0, 0.0, clip.scale * c / m - clip.offset, clip.scale / m);
        let [x, y] = self.projection_xy(clip);
        let projection = DMat4::from_cols(x, y, along, DVec4::new(0.0, 0.0, -1.0, 0.0)).transpose();
        self.projection = projection.as_mat4().to_cols_array();
        let Pose { position, orientation } = self.pose.pose();
        let placed =
            DMat4::from_rotation_translation(orientation.as_dquat().normalize(), position.as_dvec3());
        self.view = placed.inverse().as_mat4().to_cols_array();
    }
}

/// The images of [`YoroViews`].
pub(crate) fn images(views: &mut YoroViews) -> [&mut YoroView; 3] {
    [&mut views.source, &mut views.rendered, &mut views.synthesized]
}
