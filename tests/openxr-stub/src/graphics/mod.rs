//! The application's graphics: OpenGL ES in its context, or Vulkan on its device.

mod gles;
mod vulkan;

use std::ffi::c_void;

use glam::Vec3;
use openxr_sys as sys;
use sys::Result as Code;

use crate::world::{Refusal, forbid_if, forbidden};

/// The extensions for graphics.
pub const OPENGL_ES: &str = "XR_KHR_opengl_es_enable";
pub const VULKAN: [&str; 2] = ["XR_KHR_vulkan_enable", "XR_KHR_vulkan_enable2"];

/// An image of a swapchain: the name of a GL texture, or a VkImage. It is an array if it has several layers.
#[derive(Clone, Copy)]
pub struct Texture {
    pub raw: u64,
    pub layers: u32,
}

/// The graphics that a session is bound to.
pub trait Graphics: Send {
    /// True if the runtime may use the graphics on this thread.
    fn is_current(&self) -> bool;

    /// Makes no context current.
    fn unbind(&self);

    /// Returns the type of structure in which the application receives an image.
    fn image_type(&self) -> sys::StructureType;

    /// Creates an image of a swapchain.
    fn texture(&mut self, info: &sys::SwapchainCreateInfo) -> Option<Texture>;

    /// Deletes textures, if that is possible.
    fn delete(&mut self, textures: &[Texture]);

    /// Fills every layer with [`POISON`](crate::script::POISON).
    fn poison(&mut self, texture: Texture);

    /// Reads a rectangle of stored colour values as RGBA, beginning with the lowest row.
    fn read(&mut self, texture: Texture, layer: u32, rect: [i32; 4]) -> Option<Vec<u8>>;

    /// Reads a rectangle of motion vectors, beginning with the lowest row. No test submits them on Vulkan.
    fn read_vectors(&mut self, _: Texture, _: u32, _rect: [i32; 4]) -> Option<Vec<Vec3>> {
        None
    }

    /// Reads a rectangle of the depth of motion vectors, which are floats, beginning with the lowest row.
    fn read_depth(&mut self, _: Texture, _: u32, _rect: [i32; 4]) -> Option<Vec<f32>> {
        None
    }
}

/// Returns the graphics binding in a chain of structures, and its name.
///
/// # Safety
/// `next` begins a chain of structures of the types that they state.
pub unsafe fn bind(
    next: *const c_void,
    extensions: &[String],
) -> Result<(&'static str, Box<dyn Graphics>), Refusal> {
    let enabled = |name: &str| extensions.iter().any(|extension| extension == name);
    let vulkan = VULKAN.into_iter().any(enabled);
    forbid_if(
        !enabled(OPENGL_ES) && !vulkan,
        Code::ERROR_GRAPHICS_DEVICE_INVALID,
        "no extension for graphics is enabled",
    )?;
    let mut next = next.cast::<sys::BaseInStructure>();
    while !next.is_null() {
        // SAFETY: every structure of a chain begins with this header.
        let structure = unsafe { &*next };
        if enabled(OPENGL_ES) {
            // SAFETY: of the type that it states.
            if let Some((name, display, context)) = unsafe { gles::binding(structure, enabled) }? {
                return Ok((name, Box::new(gles::Gles::new(display, context)?)));
            }
        }
        if vulkan && structure.ty == sys::GraphicsBindingVulkanKHR::TYPE {
            // SAFETY: the structure has this type.
            let binding = unsafe { &*next.cast::<sys::GraphicsBindingVulkanKHR>() };
            return Ok(("vulkan", Box::new(vulkan::Vulkan::new(binding)?)));
        }
        next = structure.next;
    }
    Err(forbidden(Code::ERROR_GRAPHICS_DEVICE_INVALID, "there is no graphics binding"))
}
