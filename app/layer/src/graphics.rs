//! Synthesis on whatever the application draws with.

use std::time::Duration;

use openxr_sys as sys;
use yoro::eyes::Warp;

use crate::dispatch::{Dispatch, XrResult};
use crate::geometry::Rectangle;
use crate::reason::Reason;
use crate::{gl, vulkan};

/// How long an image of the runtime's, or the GPU, is waited for.
pub const PATIENCE: Duration = Duration::from_millis(500);

/// An image of a swapchain, or one layer of its array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image {
    /// A VkImage, or the name of a texture.
    pub image: u64,
    /// As in XrSwapchainCreateInfo: a VkFormat, or an internal format of OpenGL.
    pub format: i64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Which one of the array.
    pub layer: u32,
    /// How many there are in it; an image of one is no array in OpenGL.
    pub layers: u32,
}

/// What is synthesized in a frame. Rectangles begin at the image's row 0: the top in Vulkan, the bottom in OpenGL.
pub struct Job<'a> {
    pub color: Image,
    pub depth: Image,
    /// What is read of both.
    pub source: Rectangle,
    /// How it becomes the other eye.
    pub warp: &'a Warp,
    /// The other eye begins at its first column and row.
    pub target: Image,
    /// Its depth, stored as the source's is.
    pub target_depth: Option<Image>,
}

/// The pipeline and what it needs, for one session.
pub trait Synthesizer {
    /// Has the GPU synthesize one frame, after what the application has it do, and does not wait for it. What the
    /// synthesis of an earlier frame took on the GPU, if that is known by now.
    ///
    /// # Safety
    /// The images are the session's, and the application's side has them: in Vulkan the source's are in the layouts of
    /// attachments, and so are the target's left. Nobody else uses the queue or the context.
    unsafe fn synthesize(&mut self, job: &Job) -> Result<Option<Duration>, Reason>;

    /// Forgets a swapchain's images, which are about to be destroyed.
    fn forget(&mut self, images: &[u64]);

    /// A rectangle of a colour image, red, green and blue, from the top; waits for it. For tests.
    ///
    /// # Errors
    /// Why it cannot be read.
    ///
    /// # Safety
    /// As for [`Synthesizer::synthesize`].
    unsafe fn read(&mut self, image: Image, part: Rectangle) -> Result<Vec<u8>, String>;
}

/// What the application binds its session to.
#[derive(Clone, Copy)]
pub enum Binding {
    Vulkan(vulkan::Binding),
    Gl(gl::Binding),
}

impl Binding {
    /// Of a session; none where it is bound to something else.
    ///
    /// # Safety
    /// The structure is that of a call of xrCreateSession that has succeeded.
    pub unsafe fn of(info: &sys::SessionCreateInfo) -> Option<Binding> {
        let mut structure = info.next.cast::<sys::BaseInStructure>();
        // SAFETY: promised by the caller; the type tells the structure.
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

    /// A pipeline for the session.
    ///
    /// # Errors
    /// When the driver lacks something.
    ///
    /// # Safety
    /// What the session is bound to exists until the pipeline is dropped.
    pub unsafe fn synthesizer(&self) -> Result<Box<dyn Synthesizer>, Reason> {
        // SAFETY: promised by the caller.
        unsafe {
            Ok(match self {
                Binding::Vulkan(binding) => Box::new(vulkan::Synthesizer::new(*binding)?),
                Binding::Gl(binding) => Box::new(gl::Synthesizer::new(*binding)?),
            })
        }
    }

    /// The images of a swapchain of the session.
    ///
    /// # Errors
    /// What xrEnumerateSwapchainImages returns.
    pub fn images(&self, next: &Dispatch, swapchain: sys::Swapchain) -> XrResult<Vec<u64>> {
        match self {
            Binding::Vulkan(_) => {
                let empty = sys::SwapchainImageVulkanKHR {
                    ty: sys::SwapchainImageVulkanKHR::TYPE,
                    next: std::ptr::null_mut(),
                    image: 0,
                };
                // SAFETY: the structure for images of a session on Vulkan.
                let images = unsafe { next.swapchain_images(swapchain, empty)? };
                Ok(images.iter().map(|image| image.image).collect())
            }
            Binding::Gl(binding) => {
                // That of OpenGL ES has the same members.
                let empty = sys::SwapchainImageOpenGLKHR {
                    ty: binding.image_type(),
                    next: std::ptr::null_mut(),
                    image: 0,
                };
                // SAFETY: the structure for images of a session on OpenGL.
                let images = unsafe { next.swapchain_images(swapchain, empty)? };
                Ok(images.iter().map(|image| u64::from(image.image)).collect())
            }
        }
    }

    /// Sees to it that what is current in OpenGL now is so again when the result is dropped, whatever runtimes do in between.
    ///
    /// # Safety
    /// The session is live.
    pub unsafe fn hold(&self) -> Option<gl::Current> {
        match self {
            Binding::Vulkan(_) => None,
            // SAFETY: promised by the caller. What cannot be made current is told of where it is needed.
            Binding::Gl(binding) => unsafe { binding.make_current().ok() },
        }
    }

    /// Whether rows of images are counted from the top.
    pub fn rows_from_top(&self) -> bool {
        matches!(self, Binding::Vulkan(_))
    }
}
