//! The graphics interface that the application binds its session to.

use openxr_sys as sys;

use crate::dispatch::{Dispatch, XrResult};
use crate::reason::Reason;
use crate::synthesizer::Synthesizer;
use crate::{gl, vulkan};

/// The device or the context of a session.
#[derive(Clone, Copy)]
pub enum Binding {
    Vulkan(vulkan::Binding),
    Gl(gl::Binding),
}

impl Binding {
    /// Returns the binding of a session, or `None` if the layer does not know its graphics interface.
    ///
    /// # Safety
    /// The structure was passed to a successful call of xrCreateSession.
    pub unsafe fn of(info: &sys::SessionCreateInfo) -> Option<Binding> {
        let mut structure = info.next.cast::<sys::BaseInStructure>();
        // SAFETY: the runtime has read the same chain, and the type of a structure tells what it is.
        unsafe {
            while let Some(header) = structure.as_ref() {
                if header.ty == sys::GraphicsBindingVulkanKHR::TYPE {
                    let binding = &*structure.cast::<sys::GraphicsBindingVulkanKHR>();
                    return Some(Binding::Vulkan(vulkan::Binding::new(binding)));
                }
                if let Some(binding) = gl::Binding::of(header) {
                    return Some(Binding::Gl(binding));
                }
                structure = header.next;
            }
        }
        None
    }

    /// Creates a synthesis pipeline of the session.
    ///
    /// # Errors
    /// A [`Reason`] if the driver lacks a feature.
    ///
    /// # Safety
    /// The device or the context exists until the pipeline is dropped.
    pub unsafe fn synthesizer(&self) -> Result<Box<dyn Synthesizer>, Reason> {
        // SAFETY: both require that the device or the context outlives the pipeline, as this function does.
        unsafe {
            Ok(match self {
                Binding::Vulkan(binding) => Box::new(vulkan::Synthesizer::new(*binding)?),
                Binding::Gl(binding) => Box::new(gl::Synthesizer::new(*binding)?),
            })
        }
    }

    /// Returns the images of one of the session's swapchains: VkImages, or names of textures.
    ///
    /// # Errors
    /// The result of xrEnumerateSwapchainImages.
    pub fn images(&self, next: &Dispatch, swapchain: sys::Swapchain) -> XrResult<Vec<u64>> {
        match self {
            Binding::Vulkan(_) => {
                let empty = sys::SwapchainImageVulkanKHR {
                    ty: sys::SwapchainImageVulkanKHR::TYPE,
                    next: std::ptr::null_mut(),
                    image: 0,
                };
                // SAFETY: this is the structure for images of a session on Vulkan.
                let images = unsafe { next.swapchain_images(swapchain, empty)? };
                Ok(images.iter().map(|image| image.image).collect())
            }
            Binding::Gl(binding) => {
                // The structure of OpenGL ES has the same members.
                let empty = sys::SwapchainImageOpenGLKHR {
                    ty: binding.image_type(),
                    next: std::ptr::null_mut(),
                    image: 0,
                };
                // SAFETY: this is the structure for images of a session on OpenGL.
                let images = unsafe { next.swapchain_images(swapchain, empty)? };
                Ok(images.iter().map(|image| u64::from(image.image)).collect())
            }
        }
    }

    /// Remembers the current OpenGL context. Dropping the result makes it current again, whatever the runtime has done
    /// in the meantime.
    ///
    /// # Safety
    /// The session is live.
    pub unsafe fn hold(&self) -> Option<gl::Current> {
        match self {
            Binding::Vulkan(_) => None,
            // SAFETY: the context of a live session exists. An error is reported where the context is needed.
            Binding::Gl(binding) => unsafe { binding.make_current().ok() },
        }
    }

    /// True if row 0 of an image is at its top.
    pub fn rows_from_top(&self) -> bool {
        matches!(self, Binding::Vulkan(_))
    }
}
