//! The structures for Vulkan, and their conversion to the core's types.

use std::ffi::c_char;

use yoro::synthesis::ArgumentError;
use yoro::vulkan::ash::vk;
use yoro::vulkan::{ImageState, LayerImage, Options, Use, Uses, VulkanError};

use crate::result::{
    Failure, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER, YORO_ERROR_FORMAT, YORO_ERROR_MEMORY,
    YORO_ERROR_NOT_REGISTERED, YORO_ERROR_NULL, YORO_ERROR_TOO_LARGE, YORO_ERROR_UNSUPPORTED,
    YORO_ERROR_VALUE, YoroMessages,
};
use crate::types::{
    Kind, YORO_OUTPUT_OPEN_DEPTH, YORO_OUTPUT_OPEN_STENCIL, YoroOutputFlags, YoroWarpKind, holes, warp_kind,
};
use crate::versioned::{check_reserved, versioned};

/// vkGetInstanceProcAddr of the Vulkan loader, or of a layer that replaces it.
pub type YoroVkLoader = Option<
    unsafe extern "C" fn(instance: vk::Instance, name: *const c_char) -> Option<unsafe extern "C" fn()>,
>;

/// The options of a context for Vulkan.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkInfo {
    /// sizeof(YoroVkInfo).
    pub struct_size: u32,
    /// Family of the queue that executes the command buffers; it must support graphics.
    pub queue_family: u32,
    /// The loader of entry points.
    pub loader: YoroVkLoader,
    /// The instance, of version 1.1 or later; no extension is needed.
    pub instance: vk::Instance,
    /// The physical device of `device`.
    pub physical_device: vk::PhysicalDevice,
    /// The device, of version 1.1 or later; no extension and no feature is needed.
    pub device: vk::Device,
    /// 1 if the feature dynamicRendering of Vulkan 1.3 or VK_KHR_dynamic_rendering is enabled, which is then used. 0:
    /// render passes and framebuffers are used, with the same result.
    pub dynamic_rendering: u32,
    /// Format of the targets' colour: any format that the device can render to. Choose an sRGB format if the source is
    /// sampled as sRGB.
    pub color_format: vk::Format,
    /// Format of the targets' depth, which is written in the source's encoding. VK_FORMAT_UNDEFINED for no depth.
    pub depth_format: vk::Format,
    /// Largest width of a source in pixels. The source's size follows from the eyes' distance and angles: take it from
    /// eyes with the largest distance, and add a margin.
    pub max_source_width: u32,
    /// Largest height of a source in pixels.
    pub max_source_height: u32,
    /// Largest width of a synthesized image in pixels.
    pub max_target_width: u32,
    /// Largest height of a synthesized image in pixels.
    pub max_target_height: u32,
    /// For yoro_times: the number of frames after which the times of a frame are returned, at least the number of
    /// frames in flight. 0: nothing is measured.
    pub timed_frames: u32,
    /// The kind of warp. 0 is YORO_WARP_KIND_EYES.
    pub warp_kind: YoroWarpKind,
    /// 1: makes a composer, too, for yoro_vk_compose. 0: it is not used.
    pub composes: u32,
    /// With YORO_WARP_KIND_EYES and a depth_format: YORO_OUTPUT_OPEN_STENCIL, if that has stencil, or YORO_OUTPUT_OPEN_DEPTH:
    /// the mark then replaces the synthesized depth. 0: holes are filled.
    pub holes: YoroOutputFlags,
    /// Must be 0.
    pub reserved: u32,
    /// A pipeline cache, or VK_NULL_HANDLE.
    pub pipeline_cache: vk::PipelineCache,
    /// Receives error messages, including those of later calls.
    pub messages: YoroMessages,
}

versioned!(YoroVkInfo);

/// A use of an image: one side of a barrier.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkState {
    /// The layout of the image. Before a call, that of a target may be VK_IMAGE_LAYOUT_UNDEFINED if its contents are
    /// not needed: with VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT and access 0 if it was
    /// drawn to, sampled or copied from before.
    pub layout: vk::ImageLayout,
    /// The stages that use the image. 0: nothing is waited for before the call, or nothing waits after it, for example
    /// because a semaphore does this. Before a call, where a semaphore hands the image over, name the stage at which
    /// that semaphore is waited for.
    pub stages: vk::PipelineStageFlags,
    /// The kinds of access of these stages; 0 if there are none.
    pub access: vk::AccessFlags,
}

/// One layer of a 2-D image: mip level 0, without multisampling.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkImage {
    /// The image. Its usage must include VK_IMAGE_USAGE_SAMPLED_BIT for a source, and
    /// VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT or VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT for a target.
    pub image: vk::Image,
    /// The image's format, or a compatible one if the image has VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT.
    pub format: vk::Format,
    /// The layer of the image, for example that of the eye. 0 for an image with one layer.
    pub layer: u32,
    /// Its use before yoro_vk_record: its layout at that time, and the stages to wait for.
    pub before: YoroVkState,
    /// Its use after yoro_vk_record, for which it is made ready.
    pub after: YoroVkState,
}

/// Images to read.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkSource {
    /// sizeof(YoroVkSource).
    pub struct_size: u32,
    /// Width of the images in pixels; the rendered part may be smaller.
    pub width: u32,
    /// Height of the images in pixels.
    pub height: u32,
    /// Must be 0.
    pub reserved: u32,
    /// Colour of the rendered eye, in any filterable format. All four channels are carried over. Of a
    /// multisampled image, give the resolved one.
    pub color: YoroVkImage,
    /// Depth of the rendered eye: VK_FORMAT_D16_UNORM, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT, R16_UNORM or
    /// R32_SFLOAT. Of a multisampled image, give the depth of each pixel's nearest sample (VK_RESOLVE_MODE_MIN_BIT, or
    /// MAX for reversed depth). Averaged depth belongs to no surface, and causes halos.
    pub depth: YoroVkImage,
}

versioned!(YoroVkSource);

/// Images to write.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkTarget {
    /// sizeof(YoroVkTarget).
    pub struct_size: u32,
    /// Width of the images in pixels; the synthesized part may be smaller.
    pub width: u32,
    /// Height of the images in pixels.
    pub height: u32,
    /// Must be 0.
    pub reserved: u32,
    /// Colour, in YoroVkInfo's color_format.
    pub color: YoroVkImage,
    /// Depth, in YoroVkInfo's depth_format; ignored if that is VK_FORMAT_UNDEFINED.
    pub depth: YoroVkImage,
}

versioned!(YoroVkTarget);

/// The id of a registered source, never 0.
pub type YoroVkSourceId = u32;
/// The id of a registered target, never 0.
pub type YoroVkTargetId = u32;

/// The images of one synthesis, and the rectangles in them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkFrame {
    /// sizeof(YoroVkFrame).
    pub struct_size: u32,
    /// The images to read.
    pub source: YoroVkSourceId,
    /// First column of the rendered part.
    pub source_x: u32,
    /// First row of the rendered part. Row 0 is the first in memory.
    pub source_y: u32,
    /// The images to write.
    pub target: YoroVkTargetId,
    /// First column of the synthesized image.
    pub target_x: u32,
    /// First row of the synthesized image.
    pub target_y: u32,
    /// Must be 0.
    pub reserved: u32,
    /// The uses of the images around this call, which replace those given at registration. May be NULL.
    pub uses: *const YoroVkUses,
}

versioned!(YoroVkFrame);

/// The uses of an image before and after one call.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkUse {
    /// Its use before yoro_vk_record: its layout at that time, and the stages to wait for.
    pub before: YoroVkState,
    /// Its use after yoro_vk_record, for which it is made ready.
    pub after: YoroVkState,
}

/// The uses of all images in one call, for engines whose images come from different passes and go to different ones in
/// each frame. Those of images that were not registered are ignored. A source is still sampled in the layout that it
/// was registered with: the registered `before` layout if it can be sampled, otherwise
/// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkUses {
    /// sizeof(YoroVkUses).
    pub struct_size: u32,
    /// The use of the source's colour.
    pub source_color: YoroVkUse,
    /// The use of the source's depth.
    pub source_depth: YoroVkUse,
    /// The use of the target's colour.
    pub target_color: YoroVkUse,
    /// The use of the target's depth.
    pub target_depth: YoroVkUse,
}

versioned!(YoroVkUses);

impl YoroVkInfo {
    pub(super) fn options(&self) -> Result<Options, Failure> {
        check_reserved("info", &[self.reserved])?;
        if self.holes & !(YORO_OUTPUT_OPEN_STENCIL | YORO_OUTPUT_OPEN_DEPTH) != 0 {
            let holes = self.holes;
            return Err(Failure::value(format!("holes is {holes}: give a YORO_OUTPUT_OPEN_ flag or 0")));
        }
        let writes_depth = self.depth_format != vk::Format::UNDEFINED;
        Ok(Options {
            color_format: self.color_format,
            depth_format: writes_depth.then_some(self.depth_format),
            holes: holes(self.holes)?,
            max_source_size: [self.max_source_width, self.max_source_height],
            max_target_size: [self.max_target_width, self.max_target_height],
            timed_frames: self.timed_frames,
            pipeline_cache: self.pipeline_cache,
        })
    }

    /// Returns the size of the buffers of a context with these options, in bytes.
    pub(super) fn buffer_bytes(&self) -> Result<u64, Failure> {
        let options = self.options()?;
        Ok(match warp_kind(self.warp_kind)? {
            Kind::AnyView => options.any_view_buffer_bytes(),
            Kind::Gather | Kind::Motion => options.buffer_bytes(),
        })
    }
}

/// Checks that a format is known. Drivers look formats up in tables, and some do not check the bounds.
pub(super) fn check_format(format: vk::Format, what: &str) -> Result<(), Failure> {
    let last_of_version_1_0 = vk::Format::ASTC_12X12_SRGB_BLOCK.as_raw();
    if (1..=last_of_version_1_0).contains(&format.as_raw()) {
        return Ok(());
    }
    Err(Failure::new(
        YORO_ERROR_FORMAT,
        format!(
            "{what} is {}, which is not a format that can be rendered to: see the header",
            format.as_raw()
        ),
    ))
}

impl YoroVkUses {
    pub(super) fn checked(&self, writes_depth: bool) -> Result<Uses, Failure> {
        let target_color = self.target_color.checked("color", false)?;
        Ok(Uses {
            source_color: self.source_color.checked("color", true)?,
            source_depth: self.source_depth.checked("depth", true)?,
            target_color,
            // The use of an absent image is not checked.
            target_depth: match writes_depth {
                true => self.target_depth.checked("depth", false)?,
                false => target_color,
            },
        })
    }
}

impl YoroVkUse {
    fn checked(&self, what: &str, is_read: bool) -> Result<Use, Failure> {
        if is_read && self.before.layout == vk::ImageLayout::UNDEFINED {
            return Err(Failure::value(format!(
                "the {what} image is read, but its layout before is VK_IMAGE_LAYOUT_UNDEFINED, which discards its contents"
            )));
        }
        if self.after.layout == vk::ImageLayout::UNDEFINED {
            return Err(Failure::value(format!(
                "the {what} image's layout after is VK_IMAGE_LAYOUT_UNDEFINED: give the layout that follows"
            )));
        }
        Ok(Use { before: self.before.checked(what)?, after: self.after.checked(what)? })
    }
}

impl YoroVkState {
    fn checked(&self, what: &str) -> Result<ImageState, Failure> {
        if self.stages.is_empty() && !self.access.is_empty() {
            return Err(Failure::value(format!(
                "a state of the {what} image has access but no stages: give the stages, or no access"
            )));
        }
        Ok(ImageState { layout: self.layout, stages: self.stages, access: self.access })
    }
}

impl YoroVkImage {
    pub(super) fn checked(&self, what: &str, is_read: bool) -> Result<LayerImage, Failure> {
        if self.image == vk::Image::null() {
            return Err(Failure::new(
                YORO_ERROR_NULL,
                format!("the {what} image is VK_NULL_HANDLE: give one"),
            ));
        }
        check_format(self.format, what)?;
        let Use { before, after } =
            YoroVkUse { before: self.before, after: self.after }.checked(what, is_read)?;
        Ok(LayerImage { image: self.image, format: self.format, layer: self.layer, before, after })
    }
}

impl From<VulkanError> for Failure {
    fn from(error: VulkanError) -> Failure {
        let code = match error {
            VulkanError::OutOfMemory { .. } => YORO_ERROR_MEMORY,
            VulkanError::DeviceLost { .. } => YORO_ERROR_DEVICE_LOST,
            VulkanError::Format { .. } | VulkanError::OtherFormat { .. } => YORO_ERROR_FORMAT,
            VulkanError::QueueFamily(_) | VulkanError::DynamicRendering | VulkanError::Holes(_) => {
                YORO_ERROR_UNSUPPORTED
            }
            VulkanError::Argument(ArgumentError::Size { size, .. }) if size.contains(&0) => YORO_ERROR_VALUE,
            VulkanError::Argument(ArgumentError::TwoComponents) => YORO_ERROR_FORMAT,
            VulkanError::Argument(_) => YORO_ERROR_TOO_LARGE,
            VulkanError::NotRegistered => YORO_ERROR_NOT_REGISTERED,
            _ => YORO_ERROR_DRIVER,
        };
        Failure::new(code, error.to_string())
    }
}
