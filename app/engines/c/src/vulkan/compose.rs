//! The composer on Vulkan.

use yoro::vulkan::ash::vk;
use yoro::vulkan::{
    ComposedFrame, Composer, InsetImage, LevelImage, LevelImages, LevelsId, TargetId, TargetImages,
};

use super::types::{YoroVkImage, YoroVkTarget, YoroVkTargetId};
use super::{Vulkan, check_commands, enter_vulkan, register_images};
use crate::context::YoroContext;
use crate::levels::YoroComposition;
use crate::result::{Failure, YORO_ERROR_UNSUPPORTED, YoroResult};
use crate::versioned::{self, check_reserved, versioned};

/// The images of an eye's levels.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkLevels {
    /// sizeof(YoroVkLevels).
    pub struct_size: u32,
    /// Width of the wide level's image in pixels; the level may be a part of it.
    pub wide_width: u32,
    /// Height of the wide level's image in pixels.
    pub wide_height: u32,
    /// Width of the inset's images in pixels; 0 for one level.
    pub inset_width: u32,
    /// Height of the inset's images in pixels; 0 for one level.
    pub inset_height: u32,
    /// 1: `inset_depth` is given. 0: it is ignored.
    pub has_depth: u32,
    /// Colour of the wide level in any filterable format. Of the rendered eye it is the rendered image, in which the
    /// level begins at crop_x and crop_y; of the other, the synthesized one.
    pub wide: YoroVkImage,
    /// Colour of the inset, in the same way; ignored for one level.
    pub inset: YoroVkImage,
    /// Depth of the synthesized eye's inset. With it, holes at the border of what was rendered show the wide view.
    pub inset_depth: YoroVkImage,
}

versioned!(YoroVkLevels);

/// The id of registered levels, never 0.
pub type YoroVkLevelsId = u32;

/// The images of one call of yoro_vk_compose, and the rectangles in them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkComposed {
    /// sizeof(YoroVkComposed).
    pub struct_size: u32,
    /// The images to read.
    pub levels: YoroVkLevelsId,
    /// First column of the wide level.
    pub wide_x: u32,
    /// First row of the wide level. Row 0 is the first in memory.
    pub wide_y: u32,
    /// First column of the inset.
    pub inset_x: u32,
    /// First row of the inset.
    pub inset_y: u32,
    /// The image to write, of yoro_vk_register_composed.
    pub target: YoroVkTargetId,
    /// First column of the eye's image.
    pub target_x: u32,
    /// First row of the eye's image.
    pub target_y: u32,
}

versioned!(YoroVkComposed);

/// Creates views and descriptors for the levels of an eye, in a context that was created with `composes`. Otherwise it is
/// like yoro_vk_register_source.
///
/// @param context The context.
/// @param levels  The images.
/// @param id      Receives their id.
/// @pre The images live until the id is released or the context is destroyed.
/// @return YORO_ERROR_UNSUPPORTED without `composes`; those of yoro_vk_register_source.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_register_levels(
    context: *mut YoroContext,
    levels: *const YoroVkLevels,
    id: *mut YoroVkLevelsId,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        register_images(context, levels, "levels", id, |vulkan, levels| {
            let images = levels.images()?;
            Ok(composer(vulkan)?.register_levels(&images)?.to_raw())
        })
    }
}

/// Creates views for an image to compose eyes in: that of yoro_vk_register_target, but for yoro_vk_compose. Depth is
/// ignored.
///
/// @param context The context.
/// @param target  The image.
/// @param id      Receives its id.
/// @pre As for yoro_vk_register_target.
/// @return YORO_ERROR_UNSUPPORTED without `composes`; those of yoro_vk_register_target.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_register_composed(
    context: *mut YoroContext,
    target: *const YoroVkTarget,
    id: *mut YoroVkTargetId,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        register_images(context, target, "target", id, |vulkan, target| {
            check_reserved("target", &[target.reserved])?;
            let color = target.color.checked("color", false)?;
            let images = TargetImages::new(color, [target.width, target.height]);
            Ok(composer(vulkan)?.register_target(&images)?.to_raw())
        })
    }
}

/// Releases the objects of levels. Does nothing if the id is not registered. Thread and results are as for
/// yoro_vk_release_source.
///
/// @param context The context.
/// @param id      The id from yoro_vk_register_levels.
/// @pre No command that was recorded with the id is pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_release_levels(context: *mut YoroContext, id: YoroVkLevelsId) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            composer(vulkan)?.release_levels(LevelsId::from_raw(id));
            Ok(())
        })
    }
}

/// Releases the objects of an image to compose eyes in. Does nothing if the id is not registered. Thread and results are
/// as for yoro_vk_release_source.
///
/// @param context The context.
/// @param id      The id from yoro_vk_register_composed.
/// @pre No command that was recorded with the id is pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_release_composed(
    context: *mut YoroContext,
    id: YoroVkTargetId,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            composer(vulkan)?.release_target(TargetId::from_raw(id));
            Ok(())
        })
    }
}

/// Records the composition of an eye of its levels into a rectangle of its size, and overwrites all of it: the inset where
/// it covers the eye and has no hole at the border of what was rendered, else the wide view, bilinearly. Records barriers
/// and one draw. Otherwise it is like yoro_vk_record.
///
/// @param context     The context.
/// @param commands    A command buffer of the device.
/// @param composition The eye's composition, from yoro_levels_from_eyes with YORO_ROWS_DOWN.
/// @param frame       The images to read and where to draw.
/// @pre As for yoro_vk_record.
/// @return YORO_ERROR_UNSUPPORTED without `composes`; those of yoro_vk_record.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_compose(
    context: *mut YoroContext,
    commands: vk::CommandBuffer,
    composition: *const YoroComposition,
    frame: *const YoroVkComposed,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            check_commands(commands)?;
            // The core counts rows from the bottom, while row 0 of Vulkan's images is at the top.
            let composition = versioned::given(composition)?.rows_from_top();
            let frame = versioned::read(frame, "frame")?;
            let frame = ComposedFrame {
                levels: LevelsId::from_raw(frame.levels),
                wide_origin: [frame.wide_x, frame.wide_y],
                inset_origin: [frame.inset_x, frame.inset_y],
                target: TargetId::from_raw(frame.target),
                target_origin: [frame.target_x, frame.target_y],
            };
            Ok(composer(vulkan)?.record(commands, &frame, &composition)?)
        })
    }
}

fn composer(vulkan: &mut Vulkan) -> Result<&mut Composer, Failure> {
    vulkan.composer.as_mut().ok_or_else(|| {
        Failure::new(
            YORO_ERROR_UNSUPPORTED,
            "the context was made without a composer: set composes of YoroVkInfo to 1",
        )
    })
}

impl YoroVkLevels {
    fn images(&self) -> Result<LevelImages, Failure> {
        if self.has_depth > 1 {
            return Err(Failure::value(format!("has_depth is {}: give 0 or 1", self.has_depth)));
        }
        let level = |image: &YoroVkImage, what, size| {
            Ok::<_, Failure>(LevelImage { color: image.checked(what, true)?, size })
        };
        let size = [self.inset_width, self.inset_height];
        let inset = || {
            let depth = match self.has_depth {
                1 => Some(self.inset_depth.checked("inset_depth", true)?),
                _ => None,
            };
            Ok::<_, Failure>(InsetImage { image: level(&self.inset, "inset", size)?, depth })
        };
        let inset = (size != [0, 0]).then(inset).transpose()?;
        Ok(LevelImages { wide: level(&self.wide, "wide", [self.wide_width, self.wide_height])?, inset })
    }
}
