//! Reasons why a frame is not synthesized.

use std::sync::Arc;

use ash::vk;
use openxr_sys as sys;
use yoro::eyes::EyesError;
use yoro::opengl::GlError;
use yoro::vulkan::VulkanError;

use crate::geometry::GeometryError;

/// The reason why both eyes are shown the same image.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Reason {
    /// The view has no XrCompositionLayerDepthInfoKHR.
    #[error("it submits no depth; let it enable XR_KHR_composition_layer_depth and submit its depth buffer")]
    NoDepth,
    /// The session is bound to an unsupported graphics interface.
    #[error("its session is bound to neither Vulkan, OpenGL by Xlib or EGL, nor OpenGL ES by EGL")]
    NoGraphics,
    /// A library of the system is missing.
    #[error("{0} cannot be loaded")]
    NoLibrary(&'static str),
    /// No views have been located yet.
    #[error("the headset's views are not known")]
    NoViews,
    /// Nothing can be synthesized between the runtime's eyes.
    #[error("{0}")]
    Views(EyesError),
    /// Nothing can be synthesized from the submitted view.
    #[error("{0}")]
    Geometry(GeometryError),
    /// The swapchain is null, or was created by a function of an extension.
    #[error("{0} is in no swapchain that xrCreateSwapchain has returned")]
    Unknown(&'static str),
    /// The swapchain's images cannot be read.
    #[error("{0} is in a swapchain that cannot be read (multisampled, subsampled, protected, or a cube)")]
    Unreadable(&'static str),
    /// The runtime owns the image: it was not released since the last frame, or was released too early.
    #[error("{0} was not released since the last frame")]
    Old(&'static str),
    /// Colour and depth have different sizes or rectangles.
    #[error("colour and depth have different sizes or rectangles")]
    Apart,
    /// A rectangle or an array index lies outside the swapchain.
    #[error("a rectangle or an array index lies beyond its swapchain")]
    Beyond,
    /// The frame has more than one layer to rewrite.
    #[error("it submits more than one projection layer; only the first with depth is synthesized")]
    Another,
    /// The GPU or the runtime was not ready in [`TIMEOUT`](crate::synthesizer::TIMEOUT).
    #[error("the GPU or the runtime is late by half a second")]
    Late,
    /// A Vulkan command has failed.
    #[error("Vulkan fails with {0:?}")]
    Vulkan(vk::Result),
    /// The synthesis on Vulkan has failed.
    #[error("{0}")]
    Synthesis(VulkanError),
    /// The application's OpenGL context is in use elsewhere.
    #[error(
        "its OpenGL context cannot be made current in xrEndFrame; let it be current there, or on no thread"
    )]
    NotCurrent,
    /// OpenGL before 4.3 and OpenGL ES before 3.2 cannot copy a part of an image.
    #[error("it submits a part of an image or of an array, which needs OpenGL 4.3 or OpenGL ES 3.2")]
    Part,
    /// OpenGL or the synthesis on it has failed. Shared, because without a pipeline every frame returns the error.
    #[error("{0}")]
    Gl(Arc<GlError>),
    /// A function of the runtime has failed.
    #[error("{0} fails with {1:?}")]
    Runtime(&'static str, sys::Result),
    /// A bug in the layer.
    #[error("the layer has failed in an unexpected way")]
    Panic,
}

impl From<GlError> for Reason {
    fn from(error: GlError) -> Reason {
        Reason::Gl(Arc::new(error))
    }
}
