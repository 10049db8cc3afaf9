//! Versions, and the small types that the structures consist of.

use yoro::eyes::{DepthConvention, Eye};
use yoro::synthesis::{HoleMark, Holes};

use crate::result::Failure;

/// Major version of this header.
pub const YORO_VERSION_MAJOR: u32 = 0;
/// Minor version of this header.
pub const YORO_VERSION_MINOR: u32 = 1;
/// Patch version of this header.
pub const YORO_VERSION_PATCH: u32 = 0;
/// The version as one number that grows: major * 1000000 + minor * 1000 + patch.
pub const YORO_VERSION: u32 = YORO_VERSION_MAJOR * 1000000 + YORO_VERSION_MINOR * 1000 + YORO_VERSION_PATCH;

/// Returns the version of the library, in the form of YORO_VERSION, which is the version of the header.
///
/// Call it from any thread.
#[unsafe(no_mangle)]
pub extern "C" fn yoro_version() -> u32 {
    YORO_VERSION
}

/// A guard band, in metres, that is complete for everything farther away than an arm's length.
pub const YORO_GUARD_BAND: f32 = 1.0;

/// One of the two eyes. The value is also its index in arrays of two.
pub type YoroEye = u32;
/// The left eye.
pub const YORO_EYE_LEFT: YoroEye = 0;
/// The right eye.
pub const YORO_EYE_RIGHT: YoroEye = 1;

/// The meaning of the values 0 to 1 in a depth buffer. It is independent of the API's clip volume.
pub type YoroDepth = u32;
/// 0 at the near plane, 1 at the far plane: tested with LESS, cleared to 1.
pub const YORO_DEPTH_STANDARD: YoroDepth = 0;
/// 1 at the near plane, 0 at the far plane: tested with GREATER, cleared to 0.
pub const YORO_DEPTH_REVERSED: YoroDepth = 1;

/// The clip volume of projection matrices. X points to the right in all of them.
pub type YoroClip = u32;
/// OpenGL: y up, z from -1 to 1.
pub const YORO_CLIP_OPENGL: YoroClip = 0;
/// Vulkan: y down, z from 0 to 1.
pub const YORO_CLIP_VULKAN: YoroClip = 1;
/// y up, z from 0 to 1: OpenGL with glClipControl, Vulkan with a viewport of negative height, Direct3D, Metal.
pub const YORO_CLIP_Y_UP_Z_0_1: YoroClip = 2;

/// The order of an image's rows in memory and in texture coordinates.
pub type YoroRows = u32;
/// Row 0 is at the bottom: OpenGL.
pub const YORO_ROWS_UP: YoroRows = 0;
/// Row 0 is at the top: Vulkan, Direct3D, image files.
pub const YORO_ROWS_DOWN: YoroRows = 1;

/// The kind of warp that a context is created for.
pub type YoroWarpKind = u32;
/// Between two parallel eyes, with a YoroWarp.
pub const YORO_WARP_KIND_EYES: YoroWarpKind = 0;
/// To a view in any pose near the rendered one, with a YoroPoseWarp. If both views are parallel eyes, YORO_WARP_KIND_EYES gives the same image and is faster.
pub const YORO_WARP_KIND_POSE: YoroWarpKind = 1;

/// Motion vectors between two parallel eyes, with a YoroMotionWarp. The colour is RGBA16F, and each texel a vector.
pub const YORO_WARP_KIND_MOTION: YoroWarpKind = 2;

/// A kind of warp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Gather,
    Motion,
    AnyView,
}

/// Returns the kind of a constant.
pub(crate) fn warp_kind(kind: YoroWarpKind) -> Result<Kind, Failure> {
    match kind {
        YORO_WARP_KIND_EYES => Ok(Kind::Gather),
        YORO_WARP_KIND_POSE => Ok(Kind::AnyView),
        YORO_WARP_KIND_MOTION => Ok(Kind::Motion),
        other => Err(Failure::value(format!("{other} is no kind of warp: give a YORO_WARP_KIND_ constant"))),
    }
}

/// Returns the error for a warp of a kind that the context was not created for.
pub(crate) fn other_kind(made_for: Kind) -> Failure {
    Failure::value(match made_for {
        Kind::AnyView => "the context was made for YORO_WARP_KIND_POSE: call the function that ends in _pose",
        Kind::Motion => {
            "the context was made for YORO_WARP_KIND_MOTION: call the function that ends in _motion"
        }
        Kind::Gather => "the context was made for YORO_WARP_KIND_EYES: create one with the other warp_kind",
    })
}

/// Bits for outputs besides colour, and for their encoding.
pub type YoroOutputFlags = u32;
/// Writes the depth of the synthesized eye to the target's depth attachment, in the source's encoding, so that
/// transparent objects can be drawn afterwards.
pub const YORO_OUTPUT_DEPTH: YoroOutputFlags = 1;
/// Source and target are both sRGB images: sampling decodes them, and writing encodes them.
pub const YORO_OUTPUT_SRGB: YoroOutputFlags = 2;
/// Leaves open what the rendered eye does not show, and silhouettes, for the caller's scene, drawn once more. The call
/// clears depth to the farthest and stencil to 0 in the target's rectangle, and sets stencil to 1 in each pixel that it
/// writes: draw the opaque scene for the other eye where stencil equals 0. Only for YORO_WARP_KIND_EYES.
pub const YORO_OUTPUT_OPEN_STENCIL: YoroOutputFlags = 4;
/// The same for materials without stencil: depth is the nearest in each pixel that is written, so that the scene passes
/// the depth test in open ones alone. Not together with YORO_OUTPUT_DEPTH.
pub const YORO_OUTPUT_OPEN_DEPTH: YoroOutputFlags = 8;

/// Returns what becomes of holes by the bits of some flags.
pub(crate) fn holes(bits: YoroOutputFlags) -> Result<Holes, Failure> {
    let open = YORO_OUTPUT_OPEN_STENCIL | YORO_OUTPUT_OPEN_DEPTH;
    match bits & (open | YORO_OUTPUT_DEPTH) {
        0 | YORO_OUTPUT_DEPTH => Ok(Holes::Filled),
        YORO_OUTPUT_OPEN_DEPTH => Ok(Holes::Open(HoleMark::Depth)),
        both if both & open == YORO_OUTPUT_OPEN_STENCIL => Ok(Holes::Open(HoleMark::Stencil)),
        _ => Err(Failure::value(
            "YORO_OUTPUT_OPEN_DEPTH goes neither with YORO_OUTPUT_DEPTH nor with YORO_OUTPUT_OPEN_STENCIL",
        )),
    }
}

/// The pose of an eye in a right-handed world with Y up. The eye looks along its own -Z axis, with X to the right. The
/// layout is that of XrPosef.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroPose {
    /// Rotation from the eye's axes to the world's, as the quaternion x, y, z, w, of length 1.
    pub orientation: [f32; 4],
    /// Position in metres.
    pub position: [f32; 3],
}

/// Angles in radians from the eye's axis to the edges of its image, each smaller than a right angle. The left and lower
/// angles are negative if the image contains the axis. The layout is that of XrFovf.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroFov {
    /// Angle to the left edge.
    pub angle_left: f32,
    /// Angle to the right edge.
    pub angle_right: f32,
    /// Angle to the upper edge.
    pub angle_up: f32,
    /// Angle to the lower edge.
    pub angle_down: f32,
}

/// Returns the eye of a constant.
pub(crate) fn eye(value: YoroEye) -> Result<Eye, Failure> {
    match value {
        YORO_EYE_LEFT => Ok(Eye::Left),
        YORO_EYE_RIGHT => Ok(Eye::Right),
        _ => Err(Failure::value(format!("{value} is no eye: give YORO_EYE_LEFT or YORO_EYE_RIGHT"))),
    }
}

pub(crate) fn depth(value: YoroDepth) -> Result<DepthConvention, Failure> {
    match value {
        YORO_DEPTH_STANDARD => Ok(DepthConvention::Standard),
        YORO_DEPTH_REVERSED => Ok(DepthConvention::Reversed),
        _ => Err(Failure::value(format!(
            "{value} is no depth convention: give YORO_DEPTH_STANDARD or YORO_DEPTH_REVERSED"
        ))),
    }
}

/// A clip volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clip {
    /// +1 when y points up, -1 when it points down.
    pub(crate) up: f64,
    /// The z of the clip volume is `scale * depth + offset`, for depth from 0 to 1.
    pub(crate) scale: f64,
    pub(crate) offset: f64,
}

pub(crate) fn clip(value: YoroClip) -> Result<Clip, Failure> {
    match value {
        YORO_CLIP_OPENGL => Ok(Clip { up: 1.0, scale: 2.0, offset: -1.0 }),
        YORO_CLIP_VULKAN => Ok(Clip { up: -1.0, scale: 1.0, offset: 0.0 }),
        YORO_CLIP_Y_UP_Z_0_1 => Ok(Clip { up: 1.0, scale: 1.0, offset: 0.0 }),
        _ => Err(Failure::value(format!("{value} is no clip volume: give a YORO_CLIP_ constant"))),
    }
}

/// True if row 0 is at the top.
pub(crate) fn rows_down(value: YoroRows) -> Result<bool, Failure> {
    match value {
        YORO_ROWS_UP => Ok(false),
        YORO_ROWS_DOWN => Ok(true),
        _ => Err(Failure::value(format!("{value} is no order of rows: give YORO_ROWS_UP or YORO_ROWS_DOWN"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_has_the_crates_version() {
        let version = format!("{YORO_VERSION_MAJOR}.{YORO_VERSION_MINOR}.{YORO_VERSION_PATCH}");
        assert_eq!(version, env!("CARGO_PKG_VERSION"));
    }
}
