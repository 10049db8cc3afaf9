//! The application's graphics: Vulkan, or OpenGL ES in an EGL context.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;

use glow::HasContext as _;
use openxr_sys as sys;
use sys::pfn;
use yoro::opengl::Context;
use yoro::vulkan::ash::vk;
use yoro::vulkan::ash::vk::Handle as _;
use yoro_context::{Backend, Binding, Graphics as _, Headless, HeadlessGraphics};

use crate::client::Part;
use crate::harness::{self, Gpu};
use crate::world;

#[derive(Clone, Copy)]
pub enum Drawing<'a> {
    Vulkan(&'a Gpu),
    Gles(&'a Gles<'a>),
}

/// A context that is current on this thread.
pub struct Gles<'a> {
    gl: &'a Context,
    binding: Binding,
}

/// Runs a test with a context and the tests' settings.
pub fn with_gles(body: impl FnOnce(&Gles)) {
    world::settle();
    let headless = Headless::open(Backend::Egl).unwrap();
    let binding = HeadlessGraphics::new(&headless).unwrap().binding();
    body(&Gles { gl: headless.gl(), binding });
    assert_eq!(headless.gl().take_errors().map(|errors| errors.to_string()), None);
}

impl Gles<'_> {
    /// Counts the objects of each kind. Drivers number objects consecutively.
    fn objects(&self) -> Vec<(&'static CStr, usize)> {
        const KINDS: [&CStr; 9] = [
            c"glIsBuffer",
            c"glIsFramebuffer",
            c"glIsProgram",
            c"glIsQuery",
            c"glIsRenderbuffer",
            c"glIsSampler",
            c"glIsShader",
            c"glIsTexture",
            c"glIsVertexArray",
        ];
        const NAMES: std::ops::Range<u32> = 1..10_000;
        let count = |kind: &CStr| {
            // SAFETY: EGL's function, and queries of this type; the context is current.
            unsafe {
                type Load = unsafe extern "C" fn(*const c_char) -> Option<unsafe extern "C" fn(u32) -> u8>;
                let load = std::mem::transmute::<*const c_void, Load>(self.binding.get_proc_address);
                let is = load(kind.as_ptr()).unwrap();
                NAMES.filter(|name| is(*name) != 0).count()
            }
        };
        // Without a current context the counts would be 0.
        assert!(count(c"glIsTexture") > 0);
        KINDS.into_iter().map(|kind| (kind, count(kind))).collect()
    }

    /// Fills a part of a texture. If the layer is not the first, the texture is an array.
    fn upload(&self, texture: u64, part: Part, [format, kind]: [u32; 2], bytes: &[u8]) {
        let texture = u32::try_from(texture).ok().and_then(std::num::NonZeroU32::new);
        let ([x, y], [width, height]) = (part.origin.map(|n| n as i32), part.size.map(|n| n as i32));
        let (gl, layer) = (self.gl.raw(), part.layer as i32);
        let target = if layer == 0 { glow::TEXTURE_2D } else { glow::TEXTURE_2D_ARRAY };
        // SAFETY: the application's own context, one of its textures, and bytes for the whole part.
        unsafe {
            gl.bind_texture(target, texture.map(glow::NativeTexture));
            let pixels = glow::PixelUnpackData::Slice(Some(bytes));
            match layer {
                0 => gl.tex_sub_image_2d(target, 0, x, y, width, height, format, kind, pixels),
                _ => gl.tex_sub_image_3d(target, 0, x, y, layer, width, height, 1, format, kind, pixels),
            }
            gl.bind_texture(target, None);
        }
    }

    pub fn upload_color(&self, texture: u64, part: Part, rgba: &[u8]) {
        self.upload(texture, part, [glow::RGBA, glow::UNSIGNED_BYTE], rgba);
    }

    pub fn upload_depth(&self, texture: u64, part: Part, stored: &[f32]) {
        let bytes: Vec<u8> = stored.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        self.upload(texture, part, [glow::DEPTH_COMPONENT, glow::FLOAT], &bytes);
    }
}

impl<'a> From<&'a Gpu> for Drawing<'a> {
    fn from(gpu: &'a Gpu) -> Drawing<'a> {
        Drawing::Vulkan(gpu)
    }
}

impl<'a> From<&'a Gles<'a>> for Drawing<'a> {
    fn from(gles: &'a Gles<'a>) -> Drawing<'a> {
        Drawing::Gles(gles)
    }
}

impl Drawing<'_> {
    /// Counts OpenGL objects.
    pub fn objects(self) -> Vec<(&'static CStr, usize)> {
        match self {
            Drawing::Vulkan(_) => Vec::new(),
            Drawing::Gles(gles) => gles.objects(),
        }
    }

    pub fn extensions(self) -> &'static [&'static CStr] {
        match self {
            Drawing::Vulkan(_) => &[c"XR_KHR_vulkan_enable2"],
            Drawing::Gles(_) => &[c"XR_KHR_opengl_es_enable", c"XR_MNDX_egl_enable"],
        }
    }

    /// Makes the call that is required before a session is created. Returns its name and its result.
    pub fn ask_requirements(
        self,
        get: pfn::GetInstanceProcAddr,
        instance: sys::Instance,
        system: sys::SystemId,
    ) -> (&'static str, sys::Result) {
        let (name, ty) = match self {
            Drawing::Vulkan(_) => {
                (c"xrGetVulkanGraphicsRequirements2KHR", sys::GraphicsRequirementsVulkanKHR::TYPE)
            }
            Drawing::Gles(_) => {
                (c"xrGetOpenGLESGraphicsRequirementsKHR", sys::GraphicsRequirementsOpenGLESKHR::TYPE)
            }
        };
        // Both structures have the same members, and both functions the same parameters.
        let mut requirements = sys::GraphicsRequirementsVulkanKHR {
            ty,
            next: ptr::null_mut(),
            min_api_version_supported: sys::Version::new(0, 0, 0),
            max_api_version_supported: sys::Version::new(0, 0, 0),
        };
        let mut function = None;
        // SAFETY: a live instance, and functions of these names have this type.
        let result = unsafe {
            assert_eq!(get(instance, name.as_ptr(), &mut function), sys::Result::SUCCESS);
            let ask = std::mem::transmute::<pfn::VoidFunction, pfn::GetVulkanGraphicsRequirements2KHR>(
                function.unwrap(),
            );
            ask(instance, system, &mut requirements)
        };
        (name.to_str().unwrap(), result)
    }

    /// Calls `work` with the graphics binding of a session.
    pub fn with_binding<T>(self, work: impl FnOnce(*const c_void) -> T) -> T {
        match self {
            Drawing::Vulkan(gpu) => {
                let host = gpu.host();
                let binding = sys::GraphicsBindingVulkanKHR {
                    ty: sys::GraphicsBindingVulkanKHR::TYPE,
                    next: ptr::null(),
                    instance: host.instance.handle().as_raw() as *const c_void,
                    physical_device: host.physical_device.as_raw() as *const c_void,
                    device: host.device.handle().as_raw() as *const c_void,
                    queue_family_index: host.queue_family,
                    queue_index: 0,
                };
                work((&raw const binding).cast())
            }
            Drawing::Gles(Gles { binding, .. }) => {
                let binding = sys::GraphicsBindingEGLMNDX {
                    ty: sys::GraphicsBindingEGLMNDX::TYPE,
                    next: ptr::null(),
                    // SAFETY: eglGetProcAddress has this type.
                    get_proc_address: unsafe {
                        std::mem::transmute::<*const c_void, Option<pfn::EglGetProcAddressMNDX>>(
                            binding.get_proc_address,
                        )
                    },
                    display: binding.display,
                    config: binding.config,
                    context: binding.context,
                };
                work((&raw const binding).cast())
            }
        }
    }

    /// Returns the number of a format, as in XrSwapchainCreateInfo.
    pub fn format(self, format: vk::Format) -> i64 {
        match self {
            Drawing::Vulkan(_) => format.as_raw().into(),
            Drawing::Gles(_) if harness::is_depth(format) => glow::DEPTH_COMPONENT32F.into(),
            Drawing::Gles(_) => glow::SRGB8_ALPHA8.into(),
        }
    }

    /// Returns the images of a swapchain: VkImages, or names of textures.
    pub fn images(
        self,
        enumerate: pfn::EnumerateSwapchainImages,
        swapchain: sys::Swapchain,
    ) -> (sys::Result, Vec<u64>) {
        const MAX_IMAGES: usize = 8;
        let mut count = 0;
        let ask = |images: *mut sys::SwapchainImageBaseHeader, count: &mut u32| {
            // SAFETY: room for as many elements as stated.
            unsafe { enumerate(swapchain, MAX_IMAGES as u32, count, images) }
        };
        match self {
            Drawing::Vulkan(_) => {
                let ty = sys::SwapchainImageVulkanKHR::TYPE;
                let mut images =
                    [sys::SwapchainImageVulkanKHR { ty, next: ptr::null_mut(), image: 0 }; MAX_IMAGES];
                let result = ask(images.as_mut_ptr().cast(), &mut count);
                (result, images[..count as usize].iter().map(|image| image.image).collect())
            }
            Drawing::Gles(_) => {
                let ty = sys::SwapchainImageOpenGLESKHR::TYPE;
                let mut images =
                    [sys::SwapchainImageOpenGLESKHR { ty, next: ptr::null_mut(), image: 0 }; MAX_IMAGES];
                let result = ask(images.as_mut_ptr().cast(), &mut count);
                (result, images[..count as usize].iter().map(|image| image.image.into()).collect())
            }
        }
    }
}
