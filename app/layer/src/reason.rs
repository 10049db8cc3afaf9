//! Why a frame is not synthesized.

use std::sync::Arc;

use ash::vk;
use openxr_sys as sys;
use yoro::eyes::EyesError;
use yoro::gl::GlError;
use yoro::vulkan::VulkanError;

use crate::geometry::GeometryError;

/// The same image is shown to both eyes, for this reason.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Reason {
    /// No XrCompositionLayerDepthInfoKHR.
    #[error("it submits no depth; let it enable XR_KHR_composition_layer_depth and submit its depth buffer")]
    NoDepth,
    /// The session is bound to something else.
    #[error("its session is bound to neither Vulkan, OpenGL by Xlib or EGL, nor OpenGL ES by EGL")]
    NoGraphics,
    /// The system's library is not there.
    #[error("{0} cannot be loaded")]
    NoLibrary(&'static str),
    /// No view was located yet, or none could be offered.
    #[error("the headset's views are not known")]
    NoViews,
    /// The runtime's eyes fit no synthesis.
    #[error("{0}")]
    Views(EyesError),
    /// What was submitted fits no synthesis.
    #[error("{0}")]
    Geometry(GeometryError),
    /// The swapchain's images cannot be read.
    #[error("{0} is in a swapchain that cannot be read (multisampled, protected, or a cube)")]
    Unreadable(&'static str),
    /// The image was not released in this frame.
    #[error("{0} was not released since the last frame")]
    Old(&'static str),
    /// Colour and depth lie in different places.
    #[error("colour and depth have different sizes or rectangles")]
    Apart,
    /// A rectangle or an array index beyond the swapchain.
    #[error("a rectangle or an array index lies beyond its swapchain")]
    Beyond,
    /// More than one layer of one view in a frame.
    #[error("it submits more than one projection layer; only the first with depth is synthesized")]
    Another,
    /// The GPU, or the runtime, does not get ready.
    #[error("the GPU or the runtime is late by half a second")]
    Late,
    /// A command of Vulkan.
    #[error("Vulkan fails with {0:?}")]
    Vulkan(vk::Result),
    /// A command of the synthesis.
    #[error("{0}")]
    Synthesis(VulkanError),
    /// The application's context of OpenGL.
    #[error(
        "its OpenGL context cannot be made current in xrEndFrame; let it be current there, or on no thread"
    )]
    NotCurrent,
    /// The image is one that OpenGL before 4.3, or OpenGL ES before 3.2, cannot copy.
    #[error("it submits a part of an image or of an array, which needs OpenGL 4.3 or OpenGL ES 3.2")]
    Part,
    /// OpenGL, or its synthesis. Shared, since it is told in each frame if there is no pipeline.
    #[error("{0}")]
    Gl(Arc<GlError>),
    /// A call of the runtime.
    #[error("{0} fails with {1:?}")]
    Runtime(&'static str, sys::Result),
    /// A mistake in the layer.
    #[error("the layer has failed in an unexpected way")]
    Panic,
}

impl From<GlError> for Reason {
    fn from(error: GlError) -> Reason {
        Reason::Gl(Arc::new(error))
    }
}
