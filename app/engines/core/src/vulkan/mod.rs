//! Synthesis on Vulkan: recorded into the caller's command buffer.
//!
//! [`Gather`] draws a parallel eye from a [`Warp`], and [`AnyView`] draws a view in any pose near the source's from a
//! [`PoseWarp`]. [`Motion`] makes the other eye's motion vectors. Each is a [`Pipeline`], runs the shaders that OpenGL
//! runs, and draws the same picture. A [`Composer`] combines the layers of a foveated view into the eye that is shown.
//! [`Pipeline::new`], [`Pipeline::register_source`] and [`Pipeline::register_target`] allocate and compile everything,
//! so that [`Pipeline::record`] only records: it allocates nothing, submits nothing and waits for nothing.
//!
//! Source and target images have Vulkan's own orientation, with row 0 at the top. Pass the [`Warp`] as
//! [`EyePair::synthesis_views`](crate::eyes::EyePair::synthesis_views) returns it, with rows counted from the bottom;
//! recording converts them. [`View::vulkan_projection`](crate::eyes::View::vulkan_projection) renders the source in this
//! orientation, and [`SynthesisViews::dominant_crop_from_top`](crate::eyes::SynthesisViews::dominant_crop_from_top) is
//! the corner of the dominant eye's own image in it.
//!
//! ```no_run
//! use yoro::eyes::SynthesisViews;
//! use yoro::vulkan::{Frame, Gather, Host, ImageState, LayerImage, Options, SourceImages, TargetImages, ash::vk};
//!
//! # unsafe fn example(
//! #     host: &Host, views: &SynthesisViews, commands: vk::CommandBuffer, [color, depth, target]: [vk::Image; 3],
//! # ) -> Result<(), yoro::vulkan::VulkanError> {
//! // Once: pipelines for the target's format, buffers for the largest sizes.
//! let mut gather = unsafe {
//!     Gather::new(host, &Options {
//!         color_format: vk::Format::R8G8B8A8_SRGB,
//!         max_source_size: views.source.size,
//!         max_target_size: views.target.size,
//!         ..Options::default()
//!     })?
//! };
//! // Once for each pair of images that is rendered to, and for each image of a swapchain: views and descriptors.
//! let image = |image, format, state| LayerImage { image, format, layer: 0, before: state, after: state };
//! let color = image(color, vk::Format::R8G8B8A8_SRGB, ImageState::COLOR_ATTACHMENT);
//! let depth = image(depth, vk::Format::D32_SFLOAT, ImageState::DEPTH_ATTACHMENT);
//! let target = image(target, vk::Format::R8G8B8A8_SRGB, ImageState::COLOR_ATTACHMENT);
//! let source = unsafe { gather.register_source(&SourceImages::new(color, depth, views.source.size))? };
//! let target = unsafe { gather.register_target(&TargetImages::new(target, views.target.size))? };
//! // Each frame, outside of render passes:
//! unsafe { gather.record(commands, &Frame::new(source, target), &views.warp)? };
//! # Ok(())
//! # }
//! ```

mod adapter;
mod barriers;
mod commands;
mod composer;
mod formats;
mod images;
mod objects;
mod passes;
mod pipeline;
mod pipelines;
mod shaders;
mod targets;
mod timer;

pub use ash;
use ash::vk;

use crate::eyes::{PoseWarp, Warp};
use crate::synthesis::backend::{WarpKind, map_sizes};
use crate::synthesis::{ArgumentError, Holes};

pub use composer::{ComposedFrame, Composer, InsetImage, LevelImage, LevelImages};
pub use pipeline::{AnyView, Gather, Motion, Pipeline};

/// Errors of creating a pipeline, of registering images, and of recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum VulkanError {
    /// The host or the device has no memory left.
    #[error("{call}: {}; free memory, or choose smaller sizes", reason(.result))]
    OutOfMemory {
        /// The Vulkan command that failed.
        call: &'static str,
        /// ERROR_OUT_OF_HOST_MEMORY, ERROR_OUT_OF_DEVICE_MEMORY or ERROR_OUT_OF_POOL_MEMORY.
        result: vk::Result,
    },
    /// The device is lost: create it and all of its objects again.
    #[error("{call}: the Vulkan device is lost; create it and all of its objects again")]
    DeviceLost {
        /// The Vulkan command that failed.
        call: &'static str,
    },
    /// Any other error of a command.
    #[error("{call} failed with {result:?}; run with Vulkan's validation layer to learn more")]
    Call {
        /// The Vulkan command.
        call: &'static str,
        /// Its result.
        result: vk::Result,
    },
    /// The device cannot use this format in this role.
    #[error("the Vulkan device cannot use {format:?} as {role}; choose another format")]
    Format {
        /// The format.
        format: vk::Format,
        /// The role of the image.
        role: &'static str,
    },
    /// A registered image does not have the format of [`Options`].
    #[error(
        "a target of {found:?} does not fit pipelines that were made for {expected:?}; register images of that format, or make pipelines for the other"
    )]
    OtherFormat {
        /// The format of [`Options`], UNDEFINED for no depth.
        expected: vk::Format,
        /// The format of [`TargetImages`], UNDEFINED for no depth.
        found: vk::Format,
    },
    /// The queue family has no graphics.
    #[error("queue family {0} has no graphics; give the family of the queue that draws")]
    QueueFamily(u32),
    /// [`Host::dynamic_rendering`] is set, but the device does not have vkCmdBeginRendering.
    #[error(
        "the device has no vkCmdBeginRendering; enable the feature dynamicRendering, or leave dynamic_rendering off"
    )]
    DynamicRendering,
    /// These options do not go with [`Options::holes`].
    #[error("holes cannot be left open here: {0}")]
    Holes(&'static str),
    /// A size or a rectangle does not fit the images, [`Options`] or the device.
    #[error(transparent)]
    Argument(#[from] ArgumentError),
    /// A [`SourceId`] or [`TargetId`] was never registered, or was released.
    #[error("these images are not registered; register them, and use the id until they are released")]
    NotRegistered,
}

fn reason(result: &vk::Result) -> &'static str {
    match *result {
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => "out of host memory",
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => "out of device memory",
        _ => "out of pool memory",
    }
}

impl VulkanError {
    fn new(call: &'static str, result: vk::Result) -> VulkanError {
        match result {
            vk::Result::ERROR_OUT_OF_HOST_MEMORY
            | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY
            | vk::Result::ERROR_OUT_OF_POOL_MEMORY => VulkanError::OutOfMemory { call, result },
            vk::Result::ERROR_DEVICE_LOST => VulkanError::DeviceLost { call },
            _ => VulkanError::Call { call, result },
        }
    }
}

/// The device that the caller lends, of Vulkan 1.1 or later, and the features that are enabled on it.
#[derive(Clone, Copy)]
pub struct Host<'a> {
    /// The instance, with its entry points.
    pub instance: &'a ash::Instance,
    /// The physical device of `device`.
    pub physical_device: vk::PhysicalDevice,
    /// The device, with its entry points, which are copied.
    pub device: &'a ash::Device,
    /// The family of the queue to which the command buffers are submitted; it must support graphics.
    pub queue_family: u32,
    /// True if the feature `dynamicRendering` of Vulkan 1.3 or VK_KHR_dynamic_rendering is enabled. Otherwise render
    /// passes and framebuffers are used, with the same result.
    pub dynamic_rendering: bool,
    /// True if VK_EXT_debug_utils is enabled in the instance: passes then have labels in debuggers. The device's entry
    /// points do not show this, since validation layers return them even without the extension.
    pub debug_utils: bool,
}

/// The formats and sizes for which pipelines and buffers are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Format of the targets' colour: any format that the device can render to.
    pub color_format: vk::Format,
    /// Format of the targets' depth, which is written in the source's encoding; `None` for colour only.
    pub depth_format: Option<vk::Format>,
    /// What becomes of holes, which only a [`Gather`] can leave open. With
    /// [`HoleMark::Depth`](crate::synthesis::HoleMark::Depth), the depth format is that of the mark, and depth is no output.
    pub holes: Holes,
    /// The largest size of a source in pixels. Smaller sources need no new pipelines or buffers. The source's size
    /// follows from the eyes' distance and frusta: take it from a pair with the largest distance, and add a margin.
    pub max_source_size: [u32; 2],
    /// The largest size of a target in pixels.
    pub max_target_size: [u32; 2],
    /// The number of frames after which [`Pipeline::pass_times`] returns a frame's times: at least the number of frames
    /// in flight. 0 disables timing.
    pub timed_frames: u32,
    /// A pipeline cache, or a null handle.
    pub pipeline_cache: vk::PipelineCache,
}

impl Options {
    /// Returns the size in bytes of the intermediate buffers of a [`Gather`] with these options, for planning before a
    /// pipeline exists. Drivers add padding.
    pub fn buffer_bytes(&self) -> u64 {
        self.bytes::<Warp>()
    }

    /// Returns the same size for an [`AnyView`].
    pub fn any_view_buffer_bytes(&self) -> u64 {
        self.bytes::<PoseWarp>()
    }

    fn bytes<W: WarpKind>(&self) -> u64 {
        map_sizes::<W>([self.max_source_size, self.max_target_size]).map(formats::map_bytes).iter().sum()
    }
}

impl Default for Options {
    /// R8G8B8A8_UNORM without depth, 2048 x 2048 pixels, no times, no cache.
    fn default() -> Options {
        Options {
            color_format: vk::Format::R8G8B8A8_UNORM,
            depth_format: None,
            holes: Holes::Filled,
            max_source_size: [2048; 2],
            max_target_size: [2048; 2],
            timed_frames: 0,
            pipeline_cache: vk::PipelineCache::null(),
        }
    }
}

/// The use of an image, as one side of a barrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageState {
    /// Its layout.
    pub layout: vk::ImageLayout,
    /// The stages that use it. Empty if nothing needs to be waited for before, or if nothing waits afterwards, for
    /// example because a semaphore does this. Before a call, where a semaphore hands the image over, name the stage at
    /// which that semaphore is waited for.
    pub stages: vk::PipelineStageFlags,
    /// The kinds of access by these stages.
    pub access: vk::AccessFlags,
}

impl ImageState {
    /// Written as a colour attachment, in COLOR_ATTACHMENT_OPTIMAL.
    pub const COLOR_ATTACHMENT: ImageState = ImageState {
        layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        stages: vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
        access: vk::AccessFlags::from_raw(
            vk::AccessFlags::COLOR_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw(),
        ),
    };
    /// Tested and written as a depth attachment, in DEPTH_STENCIL_ATTACHMENT_OPTIMAL.
    pub const DEPTH_ATTACHMENT: ImageState = ImageState {
        layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        stages: vk::PipelineStageFlags::from_raw(
            vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
                | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
        ),
        access: vk::AccessFlags::from_raw(
            vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
        ),
    };
    /// Depth that a render pass resolved from samples into this image. In Vulkan, resolves are writes of the colour
    /// attachment stage, whatever the layout.
    pub const RESOLVED_DEPTH: ImageState = ImageState {
        layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        ..ImageState::COLOR_ATTACHMENT
    };
    /// Sampled by fragment shaders, in SHADER_READ_ONLY_OPTIMAL.
    pub const SAMPLED: ImageState = ImageState {
        layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        stages: vk::PipelineStageFlags::FRAGMENT_SHADER,
        access: vk::AccessFlags::SHADER_READ,
    };
    /// The contents are not needed, in UNDEFINED: for a target that is overwritten entirely, and that was drawn to,
    /// sampled or copied from before.
    pub const DISCARDED: ImageState = ImageState {
        layout: vk::ImageLayout::UNDEFINED,
        stages: vk::PipelineStageFlags::from_raw(
            vk::PipelineStageFlags::ALL_GRAPHICS.as_raw() | vk::PipelineStageFlags::TRANSFER.as_raw(),
        ),
        access: vk::AccessFlags::empty(),
    };
}

/// One layer of an image, at mip level 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerImage {
    /// A 2-D image, without multisampling. Its usage includes SAMPLED for a source,
    /// COLOR_ATTACHMENT or DEPTH_STENCIL_ATTACHMENT for a target.
    pub image: vk::Image,
    /// Format of the view: the image's own, or a compatible one if the image is MUTABLE_FORMAT.
    pub format: vk::Format,
    /// The layer of the image; 0 for an image with one layer.
    pub layer: u32,
    /// The image's use before [`Pipeline::record`].
    pub before: ImageState,
    /// The image's use afterwards; a barrier makes it ready for this.
    pub after: ImageState,
}

/// Colour and depth of the rendered eye and its guard band. Of a multisampled image, give colour resolved from the
/// samples, and the depth of each pixel's nearest sample (VK_RESOLVE_MODE_MIN or MAX). Averaged depth belongs to no
/// surface and causes halos at all edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourceImages {
    /// Colour in any format that can be filtered, such as R8G8B8A8_UNORM or _SRGB, A2B10G10R10_UNORM or
    /// R16G16B16A16_SFLOAT. All four channels are synthesized. A source that is sampled as sRGB needs an sRGB target.
    pub color: LayerImage,
    /// Depth: D16_UNORM, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT, R16_UNORM or R32_SFLOAT. The stencil aspect
    /// is not read.
    pub depth: LayerImage,
    /// Width and height of the images in pixels; the source may be a part of them.
    pub size: [u32; 2],
}

impl SourceImages {
    /// Returns a source of two images of this size.
    pub fn new(color: LayerImage, depth: LayerImage, size: [u32; 2]) -> SourceImages {
        SourceImages { color, depth, size }
    }
}

/// The images that the other eye is written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TargetImages {
    /// Colour, in [`Options::color_format`].
    pub color: LayerImage,
    /// Depth, in [`Options::depth_format`]. A stencil aspect is not changed, unless holes are left open.
    pub depth: Option<LayerImage>,
    /// Width and height of the images in pixels; the target may be a part of them.
    pub size: [u32; 2],
}

impl TargetImages {
    /// Returns a target that is an image of this size, without depth.
    pub fn new(color: LayerImage, size: [u32; 2]) -> TargetImages {
        TargetImages { color, depth: None, size }
    }
}

/// The id of registered [`SourceImages`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SourceId(u32);

/// The id of registered [`LevelImages`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LevelsId(u32);

/// The id of registered [`TargetImages`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TargetId(u32);

macro_rules! raw_ids {
    ($($id:ident),*) => {$(
        impl $id {
            /// Returns the id as a number for interfaces in other languages. It is never 0.
            pub fn to_raw(self) -> u32 {
                self.0
            }

            /// Returns the id with this number. An id that was never registered gives [`VulkanError::NotRegistered`]
            /// when it is used.
            pub fn from_raw(raw: u32) -> $id {
                $id(raw)
            }
        }
    )*};
}

raw_ids!(SourceId, TargetId, LevelsId);

/// The images and rectangles of one call of [`Pipeline::record`]. The rectangles have the sizes of the warp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The images to read.
    pub source: SourceId,
    /// Upper left corner, in pixels, of the rectangle to read.
    pub source_origin: [u32; 2],
    /// The images to write.
    pub target: TargetId,
    /// Upper left corner, in pixels, of the rectangle to write. Pixels outside of it are not changed.
    pub target_origin: [u32; 2],
}

impl Frame {
    /// Returns a frame at the upper left corners of source and target.
    pub fn new(source: SourceId, target: TargetId) -> Frame {
        Frame { source, source_origin: [0, 0], target, target_origin: [0, 0] }
    }
}

/// The uses of an image before and after one call, which replace those of its [`LayerImage`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// The use before the call.
    pub before: ImageState,
    /// The use afterwards.
    pub after: ImageState,
}

/// The uses of all images in one call ([`Pipeline::record_with_uses`]). Those for images that are not registered are
/// ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Uses {
    /// The uses of [`SourceImages::color`].
    pub source_color: Use,
    /// The uses of [`SourceImages::depth`].
    pub source_depth: Use,
    /// The uses of [`TargetImages::color`].
    pub target_color: Use,
    /// The uses of [`TargetImages::depth`].
    pub target_depth: Use,
}

/// The GPU times of one frame's passes ([`Pipeline::pass_times`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassTimes {
    /// Finding the bounds of the displacements in each tile.
    pub tiles: std::time::Duration,
    /// Finding the part of the source to search for each tile of the target.
    pub spans: std::time::Duration,
    /// Searching, and writing the target.
    pub march: std::time::Duration,
}
