//! The functions for Vulkan.

mod compose;
mod device;
mod types;

use yoro::eyes::{MotionWarp, PoseWarp, Warp};
use yoro::synthesis::backend::WarpKind;
use yoro::vulkan::ash::vk;
use yoro::vulkan::{Frame, SourceId, SourceImages, TargetId, TargetImages, Uses};

use crate::context::{YoroContext, create, enter_as, write_bytes};
use crate::motion::YoroMotionWarp;
use crate::pose::YoroPoseWarp;
use crate::result::{Failure, YORO_ERROR_NULL, YoroResult};
use crate::versioned::{self, Given, Versioned, check_reserved, given};
use crate::views::YoroWarp;
use device::{Passes, Vulkan, of_passes};

pub use compose::*;
pub use types::*;

/// Creates a context for Vulkan: pipelines, and buffers for the largest sizes. Call it at startup, not in a frame.
///
/// Call it from any thread.
///
/// @param info    The options.
/// @param context Receives the new context, or NULL after an error. Destroy it with yoro_destroy.
/// @pre The handles are valid, belong together, and live until the YoroContext is destroyed.
/// @return YORO_ERROR_NO_CONTEXT for a loader without Vulkan's commands, YORO_ERROR_UNSUPPORTED, YORO_ERROR_FORMAT,
///         YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
///         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_create(
    info: *const YoroVkInfo,
    context: *mut *mut YoroContext,
) -> YoroResult {
    // SAFETY: the header requires valid pointers, and handles that belong together.
    unsafe { create(info, context, |info| info.messages, |info| Vulkan::new(info)) }
}

/// Returns how many bytes of GPU memory the buffers of a context will take, computed from the sizes in its
/// options. Drivers add padding. For an existing context, call yoro_capabilities.
///
/// Call it from any thread. It needs none of the handles in the options.
///
/// @param info  The options.
/// @param bytes Receives the number of bytes.
/// @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_buffer_bytes(info: *const YoroVkInfo, bytes: *mut u64) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { write_bytes(info, bytes, |info| info.messages, |info| info.buffer_bytes()) }
}

/// Creates views and descriptors for images to read. Call it once for each set of images that you render to.
///
/// Call it on the thread that may use the context.
///
/// @param context The context.
/// @param source  The images.
/// @param id      Receives their id.
/// @pre The images live until the id is released or the context is destroyed.
/// @return YORO_ERROR_FORMAT, YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER,
///         YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_register_source(
    context: *mut YoroContext,
    source: *const YoroVkSource,
    id: *mut YoroVkSourceId,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        register_images(context, source, "source", id, |vulkan, source| {
            check_reserved("source", &[source.reserved])?;
            let images = SourceImages {
                color: source.color.checked("color", true)?,
                depth: source.depth.checked("depth", true)?,
                size: [source.width, source.height],
            };
            Ok(of_passes!(&mut vulkan.passes, register_source(&images))?.to_raw())
        })
    }
}

/// Creates views for images to write. Call it once for each image of a swapchain.
///
/// Thread, preconditions and results are as for yoro_vk_register_source.
///
/// @param context The context.
/// @param target  The images.
/// @param id      Receives their id.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_register_target(
    context: *mut YoroContext,
    target: *const YoroVkTarget,
    id: *mut YoroVkTargetId,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        register_images(context, target, "target", id, |vulkan, target| {
            check_reserved("target", &[target.reserved])?;
            let images = TargetImages {
                color: target.color.checked("color", false)?,
                depth: vulkan.writes_depth.then(|| target.depth.checked("depth", false)).transpose()?,
                size: [target.width, target.height],
            };
            Ok(of_passes!(&mut vulkan.passes, register_target(&images))?.to_raw())
        })
    }
}

/// Releases the views and descriptors of images to read. Does nothing if the id is not registered.
///
/// Call it on the thread that may use the context.
///
/// @param context The context.
/// @param id      The id from yoro_vk_register_source.
/// @pre No command that was recorded with the id is pending.
/// @return YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_release_source(context: *mut YoroContext, id: YoroVkSourceId) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            of_passes!(&mut vulkan.passes, release_source(SourceId::from_raw(id)));
            Ok(())
        })
    }
}

/// Releases the views of images to write. Thread and results are as for yoro_vk_release_source.
///
/// @param context The context.
/// @param id      The id from yoro_vk_register_target.
/// @pre No command that was recorded with the id is pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_release_target(context: *mut YoroContext, id: YoroVkTargetId) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            of_passes!(&mut vulkan.passes, release_target(TargetId::from_raw(id)));
            Ok(())
        })
    }
}

/// Records the synthesis of the other eye into a rectangle of the warp's target size, and overwrites all of it except
/// for open holes. Records barriers and three draws. Call it after recording the opaque objects of the rendered eye, and
/// before transparent objects and effects that are drawn for each eye. It allocates, compiles and submits nothing, and
/// does not wait.
///
/// Changes the command buffer's graphics pipeline, descriptor set 0, push constants, viewport and scissor. Transitions
/// the images from their state `before` to their state `after`.
///
/// Call it on the thread that may use the context and that records the command buffer.
///
/// @param context  The context.
/// @param commands A command buffer of the device.
/// @param warp     The warp of YoroViews, with rows ordered as in the images.
/// @param frame    The images to read and where to draw.
/// @pre The command buffer is in the recording state, outside render passes and dynamic rendering, and is submitted to
///      the queue family of YoroVkInfo. The images are in the state `before` when it is executed. Conditional rendering
///      is not active.
/// @return YORO_ERROR_NOT_REGISTERED, YORO_ERROR_TOO_LARGE for sizes beyond those of YoroVkInfo or rectangles beyond
///         their images, YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
///         After an error nothing has been recorded.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_record(
    context: *mut YoroContext,
    commands: vk::CommandBuffer,
    warp: *const YoroWarp,
    frame: *const YoroVkFrame,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { record(context, commands, warp, frame, Warp::rows_from_top) }
}

/// Records the synthesis of a view in any pose near the rendered one, in a context of YORO_WARP_KIND_POSE: barriers and
/// three draws. Otherwise it is like yoro_vk_record.
///
/// @param context  The context.
/// @param commands A command buffer of the device.
/// @param warp     The warp of yoro_pose_warp, with rows ordered as in the images.
/// @param frame    The images to read and where to draw.
/// @pre As for yoro_vk_record.
/// @return As for yoro_vk_record.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_record_pose(
    context: *mut YoroContext,
    commands: vk::CommandBuffer,
    warp: *const YoroPoseWarp,
    frame: *const YoroVkFrame,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { record(context, commands, warp, frame, PoseWarp::rows_from_top) }
}

/// Records motion vectors of an eye, in a context of YORO_WARP_KIND_MOTION: barriers and three draws. Otherwise it is like
/// yoro_vk_record. Colours are vectors, VK_FORMAT_R16G16B16A16_SFLOAT; images with two components are refused with
/// YORO_ERROR_FORMAT when they are registered.
///
/// @param context  The context.
/// @param commands A command buffer of the device.
/// @param warp     The warp of yoro_motion_warp, with rows ordered as in the images.
/// @param frame    The images to read and where to draw.
/// @pre As for yoro_vk_record.
/// @return As for yoro_vk_record.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_record_motion(
    context: *mut YoroContext,
    commands: vk::CommandBuffer,
    warp: *const YoroMotionWarp,
    frame: *const YoroVkFrame,
) -> YoroResult {
    let from_top = |motion: &MotionWarp| MotionWarp { warp: motion.warp.rows_from_top(), ..*motion };
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { record(context, commands, warp, frame, from_top) }
}

fn check_commands(commands: vk::CommandBuffer) -> Result<(), Failure> {
    if commands == vk::CommandBuffer::null() {
        return Err(Failure::new(YORO_ERROR_NULL, "commands is NULL: give a command buffer"));
    }
    Ok(())
}

/// Records the passes. The core counts a warp's rows from the bottom, while row 0 of Vulkan's images is at the top:
/// `from_top` turns them.
///
/// # Safety
/// The pointers are null or point to live objects. Otherwise as for `Pipeline::record`.
unsafe fn record<T: Given>(
    context: *mut YoroContext,
    commands: vk::CommandBuffer,
    warp: *const T,
    frame: *const YoroVkFrame,
    from_top: impl FnOnce(&T::Core) -> T::Core,
) -> YoroResult
where
    T::Core: WarpKind,
{
    // SAFETY: same contract.
    unsafe {
        enter_vulkan(context, |vulkan| {
            check_commands(commands)?;
            let warp = from_top(&given(warp)?);
            let (frame, uses) = vulkan.frame(frame)?;
            let passes = vulkan.passes.of()?;
            match uses {
                Some(uses) => passes.record_with_uses(commands, &frame, &warp, &uses)?,
                None => passes.record(commands, &frame, &warp)?,
            }
            Ok(())
        })
    }
}

impl Vulkan {
    /// Reads a frame. Returns the uses of its images only if the frame has them.
    ///
    /// # Safety
    /// `frame` is null or points to as many bytes as it states, and so do the pointers in it.
    unsafe fn frame(&self, frame: *const YoroVkFrame) -> Result<(Frame, Option<Uses>), Failure> {
        // SAFETY: same contract.
        unsafe {
            let frame = versioned::read(frame, "frame")?;
            check_reserved("frame", &[frame.reserved])?;
            let uses = if frame.uses.is_null() {
                None
            } else {
                Some(versioned::read(frame.uses, "uses")?.checked(self.writes_depth)?)
            };
            let frame = Frame {
                source: SourceId::from_raw(frame.source),
                source_origin: [frame.source_x, frame.source_y],
                target: TargetId::from_raw(frame.target),
                target_origin: [frame.target_x, frame.target_y],
            };
            Ok((frame, uses))
        }
    }
}

/// # Safety
/// `context` is null or points to a live context.
unsafe fn enter_vulkan(
    context: *mut YoroContext,
    body: impl FnOnce(&mut Vulkan) -> Result<(), Failure>,
) -> YoroResult {
    // SAFETY: same contract.
    unsafe { enter_as(context, "yoro_vk_create", body) }
}

/// Runs the body of a function that registers images. `register` returns their id.
///
/// # Safety
/// `context` is null or points to a live context, `images` is null or points to as many bytes as it states, and `id` is
/// null or writable.
unsafe fn register_images<T: Versioned>(
    context: *mut YoroContext,
    images: *const T,
    what: &'static str,
    id: *mut u32,
    register: impl FnOnce(&mut Vulkan, &T) -> Result<u32, Failure>,
) -> YoroResult {
    let body = |vulkan: &mut Vulkan| {
        // SAFETY: the caller passes a pointer to as many bytes as the structure states.
        let images = unsafe { versioned::read(images, what) }?;
        if id.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "id is NULL: give a pointer that receives the id"));
        }
        let registered = register(vulkan, &images)?;
        // SAFETY: the caller passes a writable pointer.
        unsafe { id.write(registered) };
        Ok(())
    };
    // SAFETY: the caller passes a live context or null.
    unsafe { enter_vulkan(context, body) }
}
