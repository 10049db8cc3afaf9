//! Motion vectors of the other eye, for runtimes that make frames between those that are rendered.

use yoro::eyes::{MotionMap, MotionWarp, Ndc, VectorSpace, VectorsOf};

use crate::eyes::YoroEyes;
use crate::result::{Failure, YORO_ERROR_NULL, YoroMessages, YoroResult, catch_errors};
use crate::types::{YORO_CLIP_OPENGL, YORO_ROWS_DOWN};
use crate::versioned::{self, Given, check_reserved, versioned};
use crate::views::{YoroWarp, guard_band, turned};

/// The image in whose normalized device coordinates motion vectors are given. A vector is the place of a surface minus its
/// place in the previous frame, each with the view of its own frame, so that the head's motion is in it. It has three
/// components: two do not tell how a surface that comes nearer moves in the other eye.
pub type YoroVectors = u32;
/// The rendered view with its guard band: what an engine writes with the projection of YoroViews::source.
pub const YORO_VECTORS_SOURCE: YoroVectors = 0;
/// The rendered eye without the guard band: its own vectors are a part of the image.
pub const YORO_VECTORS_EYE: YoroVectors = 1;

/// Two frames, of which the vectors of the newer one point to the previous.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroMotion {
    /// sizeof(YoroMotion).
    pub struct_size: u32,
    /// The image that the vectors refer to.
    pub vectors: YoroVectors,
    /// The eyes of this frame. Their size is that of an eye's vectors, as a runtime recommends it, not that of the image.
    /// The clip volume is that of the vectors.
    pub eyes: *const YoroEyes,
    /// The eyes of the previous frame, of the same size. Distance, angles and planes may have changed.
    pub previous: *const YoroEyes,
    /// Receives error messages.
    pub messages: YoroMessages,
}

versioned!(YoroMotion);

/// What yoro_gl_synthesize_motion and yoro_vk_record_motion need to know of two frames. yoro_motion_warp fills it. It can be
/// copied and kept.
///
/// A surface with the vector v and the stored depth d in the source has the vector
/// `(a * v.x + per_z * v.z + per_depth * d + constant, b * v.y, v.z)` in the eye; a and b are 1, or for YORO_VECTORS_SOURCE
/// the source's size over the eye's.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YoroMotionWarp {
    /// The mapping of pixels, at the vectors' size.
    pub warp: YoroWarp,
    /// X per unit of the vector's z.
    pub per_z: f64,
    /// X per unit of stored depth.
    pub per_depth: f64,
    /// X that is added.
    pub constant: f64,
    /// The image that the vectors refer to.
    pub vectors: YoroVectors,
    /// Must be 0.
    pub reserved: u32,
}

/// Computes how motion vectors of the rendered eye become those of the other eye, and its own without the guard band.
///
/// Call it from any thread, without a context. It allocates and keeps nothing.
///
/// @param motion The two frames.
/// @param other  Receives the mapping to the other eye.
/// @param own    Receives the mapping to the rendered eye; NULL if it is not needed, because vectors can be scaled, or
///               cropped.
/// @pre The pointers point to structures of the sizes that they state.
/// @return YORO_ERROR_VALUE if the frames have no law in common: then tell the runtime not to extrapolate this one. As for
///         yoro_views_from_eyes for each pair of eyes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_motion_warp(
    motion: *const YoroMotion,
    other: *mut YoroMotionWarp,
    own: *mut YoroMotionWarp,
) -> YoroResult {
    catch_errors(|told| {
        // SAFETY: the header requires a pointer to a structure of the size that it states.
        let motion = unsafe { versioned::read(motion, "motion") }?;
        *told = motion.messages;
        if other.is_null() {
            return Err(Failure::new(
                YORO_ERROR_NULL,
                "other is NULL: give a pointer that receives the warp",
            ));
        }
        // SAFETY: as above.
        let [eyes, previous] = unsafe {
            [versioned::read(motion.eyes, "eyes")?, versioned::read(motion.previous, "previous eyes")?]
        };
        let views = |eyes: &YoroEyes| {
            let checked = eyes.checked()?;
            let pair = turned(checked.pair, eyes.rows == YORO_ROWS_DOWN);
            Ok::<_, Failure>(pair.synthesis_views(guard_band(eyes.guard_band))?)
        };
        let (now, then) = (views(&eyes)?, views(&previous)?);
        let ndc = if eyes.clip == YORO_CLIP_OPENGL { Ndc::MinusOneToOne } else { Ndc::ZeroToOne };
        let space = VectorSpace { ndc, of: vectors_of(motion.vectors)? };
        let result = YoroMotionWarp::new(&now.motion(&then, space)?);
        // SAFETY: the header requires pointers to structures.
        unsafe {
            other.write_unaligned(result);
            if !own.is_null() {
                own.write_unaligned(YoroMotionWarp::new(&now.own_motion(&then, space)?));
            }
        }
        Ok(())
    })
}

fn vectors_of(value: YoroVectors) -> Result<VectorsOf, Failure> {
    match value {
        YORO_VECTORS_SOURCE => Ok(VectorsOf::Source),
        YORO_VECTORS_EYE => Ok(VectorsOf::Eye),
        _ => Err(Failure::value(format!("{value} is no kind of vectors: give a YORO_VECTORS_ constant"))),
    }
}

impl YoroMotionWarp {
    fn new(motion: &MotionWarp) -> YoroMotionWarp {
        let MotionMap { per_z, per_depth, constant, of } = motion.law;
        YoroMotionWarp {
            warp: YoroWarp::new(&motion.warp),
            per_z,
            per_depth,
            constant,
            vectors: match of {
                VectorsOf::Source => YORO_VECTORS_SOURCE,
                VectorsOf::Eye => YORO_VECTORS_EYE,
            },
            reserved: 0,
        }
    }
}

impl Given for YoroMotionWarp {
    type Core = MotionWarp;
    const MISSING: &'static str = "warp is NULL: give the one of yoro_motion_warp";

    fn checked(&self) -> Result<MotionWarp, Failure> {
        check_reserved("warp", &[self.reserved])?;
        let YoroMotionWarp { per_z, per_depth, constant, .. } = *self;
        // Written so that NaN fails too.
        if ![per_z, per_depth, constant].iter().all(|number| number.abs() < 1e9) {
            return Err(Failure::value("a motion warp is impossible: take it from yoro_motion_warp"));
        }
        let law = MotionMap { per_z, per_depth, constant, of: vectors_of(self.vectors)? };
        Ok(MotionWarp { warp: self.warp.checked()?, law })
    }
}
