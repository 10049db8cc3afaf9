//! Vulkan.

use std::ffi::{CStr, c_char};

use yoro::vulkan::ash::{Device, Instance, StaticFn, vk};
use yoro::vulkan::{
    Frame, Gather, Host, ImageState, LayerImage, Options, SourceId, SourceImages, TargetId, TargetImages,
    VulkanError,
};

use crate::context::{Backend, YORO_API_VULKAN, YoroCapabilities, YoroContext, create, enter_as};
use crate::result::{
    Failure, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER, YORO_ERROR_FORMAT, YORO_ERROR_MEMORY,
    YORO_ERROR_NO_CONTEXT, YORO_ERROR_NOT_REGISTERED, YORO_ERROR_NULL, YORO_ERROR_TOO_LARGE,
    YORO_ERROR_UNSUPPORTED, YORO_ERROR_VALUE, YoroMessages, YoroResult,
};
use crate::types::{YoroEdges, edges};
use crate::versioned::{self, Versioned, versioned};
use crate::views::YoroWarp;

/// vkGetInstanceProcAddr of the Vulkan loader, or of a layer in its place.
pub type YoroVkLoader = Option<
    unsafe extern "C" fn(instance: vk::Instance, name: *const c_char) -> Option<unsafe extern "C" fn()>,
>;

/// The options of a context for Vulkan.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkInfo {
    /// sizeof(YoroVkInfo).
    pub struct_size: u32,
    /// Family of the queue that executes the command buffers; it has graphics.
    pub queue_family: u32,
    /// The loader of entry points.
    pub loader: YoroVkLoader,
    /// The instance, of version 1.1 or later; no extension is needed.
    pub instance: vk::Instance,
    /// The physical device of `device`.
    pub physical_device: vk::PhysicalDevice,
    /// The device, of version 1.1 or later; no extension and no feature is needed.
    pub device: vk::Device,
    /// 1 if the feature dynamicRendering of Vulkan 1.3 or VK_KHR_dynamic_rendering is enabled; it is then used. 0: render
    /// passes and framebuffers are used, with the same result.
    pub dynamic_rendering: u32,
    /// Format of the targets' colour, any that the device can render to. Choose an sRGB format if the source is sampled as sRGB.
    pub color_format: vk::Format,
    /// Format of the targets' depth, which is written in the source's encoding; VK_FORMAT_UNDEFINED for no depth.
    pub depth_format: vk::Format,
    /// Largest width of a source in pixels.
    pub max_source_width: u32,
    /// Largest height of a source in pixels.
    pub max_source_height: u32,
    /// Largest width of a synthesized image in pixels.
    pub max_target_width: u32,
    /// Largest height of a synthesized image in pixels.
    pub max_target_height: u32,
    /// The kind of source images; 0 is YORO_EDGES_HARD.
    pub edges: YoroEdges,
    /// For YORO_EDGES_MULTISAMPLE, samples in each pixel of a source's depth: 2 or 4. Otherwise ignored.
    pub samples: u32,
    /// Zero.
    pub reserved: u32,
    /// A pipeline cache, or VK_NULL_HANDLE.
    pub pipeline_cache: vk::PipelineCache,
    /// The receiver of the sentences of errors, also in later calls.
    pub messages: YoroMessages,
}

versioned!(YoroVkInfo);

/// A use of an image: one side of a barrier.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkState {
    /// Its layout.
    pub layout: vk::ImageLayout,
    /// The stages that use it.
    pub stages: vk::PipelineStageFlags,
    /// Their kinds of access.
    pub access: vk::AccessFlags,
}

/// One layer of a 2-D image: mip level 0, without multisampling unless stated otherwise.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkImage {
    /// The image. Its usage has VK_IMAGE_USAGE_SAMPLED_BIT for a source, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT or
    /// VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT for a target.
    pub image: vk::Image,
    /// The image's format, or a compatible one if the image has VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT.
    pub format: vk::Format,
    /// The layer of the image, for example the eye's; 0 for an image with one layer.
    pub layer: u32,
    /// Its use before yoro_vk_record: its layout then, and the stages to wait for.
    pub before: YoroVkState,
    /// Its use afterwards, for which it is made ready.
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
    /// Zero.
    pub reserved: u32,
    /// Colour of the rendered eye, in any format that can be filtered. All four channels are carried over. Unless
    /// YORO_EDGES_HARD is chosen it is resolved, with values between 0 and 1.
    pub color: YoroVkImage,
    /// Depth of the rendered eye: VK_FORMAT_D16_UNORM, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT or R32_SFLOAT. For
    /// YORO_EDGES_MULTISAMPLE it has YoroVkInfo's samples.
    pub depth: YoroVkImage,
    /// For YORO_EDGES_MULTISAMPLE, the image with as many samples that the colour was resolved from. Its image is
    /// VK_NULL_HANDLE if it does not exist any more, and for all other edges.
    pub sample_color: YoroVkImage,
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
    /// Zero.
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

/// The images and places of one synthesis.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroVkFrame {
    /// sizeof(YoroVkFrame).
    pub struct_size: u32,
    /// The images to read.
    pub source: YoroVkSourceId,
    /// First column of the rendered part.
    pub source_x: u32,
    /// First row of the rendered part; row 0 is the first in memory.
    pub source_y: u32,
    /// The images to write.
    pub target: YoroVkTargetId,
    /// First column of the synthesized image.
    pub target_x: u32,
    /// First row of the synthesized image.
    pub target_y: u32,
}

versioned!(YoroVkFrame);

/// Creates a context for Vulkan: pipelines, and buffers for the largest sizes. Call it at start, not in a frame.
///
/// Call it from any thread.
///
/// @param info    The options.
/// @param context Receives the new context, NULL after an error. Destroy it with yoro_destroy.
/// @pre The handles are valid, belong together, and live until the YoroContext is destroyed.
/// @return YORO_ERROR_NO_CONTEXT for a loader without Vulkan's commands, YORO_ERROR_UNSUPPORTED, YORO_ERROR_FORMAT,
///         YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
///         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_create(
    info: *const YoroVkInfo,
    context: *mut *mut YoroContext,
) -> YoroResult {
    // SAFETY: the header asks for valid pointers, and for handles that belong together.
    unsafe { create(info, context, |info| info.messages, |info| Vulkan::new(info)) }
}

/// Creates views and descriptors of images to read. Call it once for each set of images that you render to.
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
    // SAFETY: the header asks for pointers that are NULL or lead to live objects of their types.
    unsafe {
        register_images(context, source, "source", id, |vulkan, source| {
            let images = SourceImages {
                color: source.color.checked("color", true)?,
                depth: source.depth.checked("depth", true)?,
                sample_color: if source.sample_color.image == vk::Image::null() {
                    None
                } else {
                    Some(source.sample_color.checked("sample_color", true)?)
                },
                size: [source.width, source.height],
            };
            Ok(vulkan.gather.register_source(&images)?.to_raw())
        })
    }
}

/// Creates views of images to write. Call it once for each image of a swapchain.
///
/// Thread, preconditions and results are those of yoro_vk_register_source.
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
    // SAFETY: the header asks for pointers that are NULL or lead to live objects of their types.
    unsafe {
        register_images(context, target, "target", id, |vulkan, target| {
            let images = TargetImages {
                color: target.color.checked("color", false)?,
                depth: vulkan.writes_depth.then(|| target.depth.checked("depth", false)).transpose()?,
                size: [target.width, target.height],
            };
            Ok(vulkan.gather.register_target(&images)?.to_raw())
        })
    }
}

/// Releases the views and descriptors of images to read. Ignores an id that is not registered.
///
/// Call it on the thread that may use the context.
///
/// @param context The context.
/// @param id      The id from yoro_vk_register_source.
/// @pre No command that was recorded with the id is pending.
/// @return YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_release_source(context: *mut YoroContext, id: YoroVkSourceId) -> YoroResult {
    // SAFETY: the header asks for pointers that are NULL or lead to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            vulkan.gather.release_source(SourceId::from_raw(id));
            Ok(())
        })
    }
}

/// Releases the views of images to write. Thread and results are those of yoro_vk_release_source.
///
/// @param context The context.
/// @param id      The id from yoro_vk_register_target.
/// @pre No command that was recorded with the id is pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_release_target(context: *mut YoroContext, id: YoroVkTargetId) -> YoroResult {
    // SAFETY: the header asks for pointers that are NULL or lead to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            vulkan.gather.release_target(TargetId::from_raw(id));
            Ok(())
        })
    }
}

/// Records the synthesis of the other eye into a rectangle of warp's target size, all of which is overwritten: barriers, and
/// three draws with YORO_EDGES_HARD, four with other edges. Record it after the opaque objects of the rendered eye, and before
/// transparent objects and effects that are drawn for each eye. It allocates, compiles and submits nothing, and does not wait.
///
/// Changes the command buffer's graphics pipeline, descriptor set 0, push constants, viewport and scissor. Brings images from
/// their state `before` to their state `after`.
///
/// Call it on the thread that may use the context and that records the command buffer.
///
/// @param context  The context.
/// @param commands A command buffer of the device.
/// @param warp     The warp of YoroViews, with rows as they lie in the images.
/// @param frame    The images to read and the place to draw.
/// @pre The command buffer is in the recording state, outside of render passes and dynamic rendering, and is submitted to
///      the queue family of YoroVkInfo. The images are in the state `before` when it is executed. Conditional rendering is
///      not active.
/// @return YORO_ERROR_NOT_REGISTERED, YORO_ERROR_TOO_LARGE for sizes beyond those of YoroVkInfo or rectangles beyond their
///         images, YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE. After an
///         error nothing was recorded.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_vk_record(
    context: *mut YoroContext,
    commands: vk::CommandBuffer,
    warp: *const YoroWarp,
    frame: *const YoroVkFrame,
) -> YoroResult {
    // SAFETY: the header asks for pointers that are NULL or lead to live objects of their types.
    unsafe {
        enter_vulkan(context, |vulkan| {
            if warp.is_null() || commands == vk::CommandBuffer::null() {
                return Err(Failure::new(YORO_ERROR_NULL, "warp or commands is NULL: give both"));
            }
            let mut warp = warp.read_unaligned().checked()?;
            // The core counts these rows from the bottom, and takes row 0 of Vulkan's images as the top.
            warp.row_offset = warp.target_size[1] as i32 - warp.source_size[1] as i32 - warp.row_offset;
            let frame = versioned::read(frame, "frame")?;
            let frame = Frame {
                source: SourceId::from_raw(frame.source),
                source_origin: [frame.source_x, frame.source_y],
                target: TargetId::from_raw(frame.target),
                target_origin: [frame.target_x, frame.target_y],
            };
            Ok(vulkan.gather.record(commands, &frame, &warp)?)
        })
    }
}

/// # Safety
/// `context` is null or alive.
unsafe fn enter_vulkan(
    context: *mut YoroContext,
    body: impl FnOnce(&mut Vulkan) -> Result<(), Failure>,
) -> YoroResult {
    // SAFETY: the contract is the same.
    unsafe { enter_as(context, "yoro_vk_create", body) }
}

/// Runs the body of a function that registers images; `register` returns their id.
///
/// # Safety
/// `context` is null or alive, `images` is null or leads to as many bytes as it states, and `id` is null or can be
/// written.
unsafe fn register_images<T: Versioned>(
    context: *mut YoroContext,
    images: *const T,
    what: &'static str,
    id: *mut u32,
    register: impl FnOnce(&mut Vulkan, &T) -> Result<u32, Failure>,
) -> YoroResult {
    let body = |vulkan: &mut Vulkan| {
        // SAFETY: the caller gives a pointer to as many bytes as they state.
        let images = unsafe { versioned::read(images, what) }?;
        if id.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "id is NULL: give a pointer that receives the id"));
        }
        let registered = register(vulkan, &images)?;
        // SAFETY: the caller gives a pointer that can be written.
        unsafe { id.write(registered) };
        Ok(())
    };
    // SAFETY: the caller gives a context that is alive, or null.
    unsafe { enter_vulkan(context, body) }
}

/// The synthesis on a device.
pub(crate) struct Vulkan {
    gather: Gather,
    writes_depth: bool,
    instance: Instance,
    physical_device: vk::PhysicalDevice,
}

impl Vulkan {
    /// # Safety
    /// The handles are valid and belong together.
    unsafe fn new(info: &YoroVkInfo) -> Result<Vulkan, Failure> {
        let null = |what: &str| Failure::new(YORO_ERROR_NULL, format!("{what} is NULL: give it"));
        let loader = info.loader.ok_or_else(|| null("loader"))?;
        let handles = [
            (info.instance == vk::Instance::null(), "instance"),
            (info.physical_device == vk::PhysicalDevice::null(), "physical_device"),
            (info.device == vk::Device::null(), "device"),
        ];
        if let Some((_, what)) = handles.into_iter().find(|(is_null, _)| *is_null) {
            return Err(null(what));
        }
        if info.dynamic_rendering > 1 {
            return Err(Failure::value(format!(
                "dynamic_rendering is {}: give 0 or 1",
                info.dynamic_rendering
            )));
        }
        check_format(info.color_format, "color_format")?;
        let writes_depth = info.depth_format != vk::Format::UNDEFINED;
        if writes_depth {
            check_format(info.depth_format, "depth_format")?;
        }
        // ash panics in commands that were not found. These lead to all others, or are of the oldest version that is needed.
        let has = |name: &CStr| {
            // SAFETY: the header asks for a live instance; the name ends with 0.
            unsafe { loader(info.instance, name.as_ptr()) }.is_some()
        };
        let needed = [
            c"vkGetDeviceProcAddr",
            c"vkGetPhysicalDeviceProperties",
            c"vkGetPhysicalDeviceProperties2",
            c"vkCreateImage",
            c"vkCmdDraw",
        ];
        if !needed.into_iter().all(has) {
            return Err(Failure::new(
                YORO_ERROR_NO_CONTEXT,
                "the loader does not return the commands of Vulkan 1.1: give vkGetInstanceProcAddr, and an instance of \
                 version 1.1 or later",
            ));
        }
        // SAFETY: both types have the same signature, and "system" is C's calling convention on these platforms. The header
        // asks for handles that belong together.
        let (instance, device) = unsafe {
            let get_instance_proc_addr = std::mem::transmute::<
                unsafe extern "C" fn(vk::Instance, *const c_char) -> Option<unsafe extern "C" fn()>,
                vk::PFN_vkGetInstanceProcAddr,
            >(loader);
            let instance = Instance::load(&StaticFn { get_instance_proc_addr }, info.instance);
            let device = Device::load(instance.fp_v1_0(), info.device);
            (instance, device)
        };
        let host = Host {
            instance: &instance,
            physical_device: info.physical_device,
            device: &device,
            queue_family: info.queue_family,
            dynamic_rendering: info.dynamic_rendering == 1,
        };
        let options = Options {
            color_format: info.color_format,
            depth_format: writes_depth.then_some(info.depth_format),
            max_source_size: [info.max_source_width, info.max_source_height],
            max_target_size: [info.max_target_width, info.max_target_height],
            edges: edges(info.edges)?,
            samples: info.samples,
            timed_frames: 0,
            pipeline_cache: info.pipeline_cache,
        };
        // SAFETY: the header asks for handles that are valid, belong together, and outlive the context.
        let gather = unsafe { Gather::new(&host, &options) }?;
        Ok(Vulkan { gather, writes_depth, instance, physical_device: info.physical_device })
    }
}

impl Backend for Vulkan {
    fn api(&self) -> &'static str {
        "Vulkan"
    }

    fn capabilities(&self) -> YoroCapabilities {
        // SAFETY: the header asks for an instance that outlives the context.
        let properties = unsafe { self.instance.get_physical_device_properties(self.physical_device) };
        let mut capabilities = YoroCapabilities {
            struct_size: size_of::<YoroCapabilities>() as u32,
            api: YORO_API_VULKAN,
            api_major: vk::api_version_major(properties.api_version),
            api_minor: vk::api_version_minor(properties.api_version),
            reserved: 0,
            compute: 1,
            software: (properties.device_type == vk::PhysicalDeviceType::CPU).into(),
            max_image_size: properties.limits.max_image_dimension2_d,
            buffer_bytes: self.gather.buffer_bytes(),
            device: [0; 128],
        };
        if let Ok(name) = properties.device_name_as_c_str() {
            capabilities.set_device(&name.to_string_lossy());
        }
        capabilities
    }
}

/// Checks that a format is known: drivers look it up in tables, and some do not check their bounds.
fn check_format(format: vk::Format, what: &str) -> Result<(), Failure> {
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

impl YoroVkImage {
    fn checked(&self, what: &str, is_read: bool) -> Result<LayerImage, Failure> {
        if self.image == vk::Image::null() {
            return Err(Failure::new(
                YORO_ERROR_NULL,
                format!("the {what} image is VK_NULL_HANDLE: give one"),
            ));
        }
        check_format(self.format, what)?;
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
        let state = |state: &YoroVkState| ImageState {
            layout: state.layout,
            stages: state.stages,
            access: state.access,
        };
        Ok(LayerImage {
            image: self.image,
            format: self.format,
            layer: self.layer,
            before: state(&self.before),
            after: state(&self.after),
        })
    }
}

impl From<VulkanError> for Failure {
    fn from(error: VulkanError) -> Failure {
        let code = match error {
            VulkanError::OutOfMemory { .. } => YORO_ERROR_MEMORY,
            VulkanError::DeviceLost { .. } => YORO_ERROR_DEVICE_LOST,
            VulkanError::Format { .. } | VulkanError::OtherFormat { .. } => YORO_ERROR_FORMAT,
            VulkanError::QueueFamily(_) | VulkanError::DynamicRendering | VulkanError::Samples(_) => {
                YORO_ERROR_UNSUPPORTED
            }
            VulkanError::SampleColors => YORO_ERROR_VALUE,
            VulkanError::Size { .. } | VulkanError::Rectangle { .. } => YORO_ERROR_TOO_LARGE,
            VulkanError::NotRegistered => YORO_ERROR_NOT_REGISTERED,
            _ => YORO_ERROR_DRIVER,
        };
        Failure::new(code, error.to_string())
    }
}
