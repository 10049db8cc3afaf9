//! OpenGL ES in the application's context.

use std::ffi::{CStr, CString, c_void};
use std::num::NonZeroU32;
use std::ptr;

use glam::Vec3;
use glow::HasContext as _;
use openxr_sys as sys;
use sys::Result as Code;

use super::{Graphics, Texture};
use crate::script::POISON;
use crate::world::{Refusal, forbid_if};

const EGL_LIBRARIES: [&str; 2] = ["libEGL.so.1", "libEGL.so"];

type GetProcAddress = unsafe extern "system" fn(*const i8) -> *const c_void;
type GetCurrentContext = unsafe extern "system" fn() -> *const c_void;
type MakeCurrent =
    unsafe extern "system" fn(*const c_void, *const c_void, *const c_void, *const c_void) -> u32;

/// The context that a session is bound to.
pub struct Gles {
    /// The functions of GL, once they have been needed.
    gl: Option<glow::Context>,
    get_proc_address: GetProcAddress,
    get_current_context: GetCurrentContext,
    make_current: MakeCurrent,
    display: *const c_void,
    context: *const c_void,
}

// SAFETY: it is only used on threads that have made the context current, of which there is at most one at a time.
unsafe impl Send for Gles {}

/// The binding of `XR_KHR_opengl_es_enable`, which openxr-sys declares only on Android.
#[repr(C)]
struct AndroidBinding {
    ty: sys::StructureType,
    next: *const c_void,
    display: *const c_void,
    config: *const c_void,
    context: *const c_void,
}

/// Returns name, display and context, if the structure is a binding.
///
/// # Safety
/// The structure is of the type that it states.
pub unsafe fn binding(
    structure: &sys::BaseInStructure,
    enabled: impl Fn(&str) -> bool,
) -> Result<Option<(&'static str, *const c_void, *const c_void)>, Refusal> {
    let start: *const sys::BaseInStructure = structure;
    let (name, display, context) = match structure.ty {
        sys::StructureType::GRAPHICS_BINDING_EGL_MNDX if enabled("XR_MNDX_egl_enable") => {
            // SAFETY: the structure has this type.
            let binding = unsafe { &*start.cast::<sys::GraphicsBindingEGLMNDX>() };
            forbid_if(
                binding.get_proc_address.is_none(),
                Code::ERROR_VALIDATION_FAILURE,
                "the binding has no getProcAddress",
            )?;
            ("egl", binding.display as *const c_void, binding.context as *const c_void)
        }
        sys::StructureType::GRAPHICS_BINDING_OPENGL_ES_ANDROID_KHR => {
            // SAFETY: the structure has this type.
            let binding = unsafe { &*start.cast::<AndroidBinding>() };
            ("android", binding.display, binding.context)
        }
        _ => return Ok(None),
    };
    forbid_if(
        display.is_null() || context.is_null(),
        Code::ERROR_GRAPHICS_DEVICE_INVALID,
        "display or context is null",
    )?;
    Ok(Some((name, display, context)))
}

impl Gles {
    pub fn new(display: *const c_void, context: *const c_void) -> Result<Gles, Refusal> {
        // SAFETY: the application already uses this library.
        let library = EGL_LIBRARIES.iter().find_map(|name| unsafe { libloading::Library::new(name).ok() });
        let library = library.ok_or(Code::ERROR_RUNTIME_FAILURE)?;
        // SAFETY: EGL's functions have these types, and the library stays loaded.
        let functions = unsafe {
            (
                library.get(b"eglGetProcAddress").map(|f| *f),
                library.get(b"eglGetCurrentContext").map(|f| *f),
                library.get(b"eglMakeCurrent").map(|f| *f),
            )
        };
        std::mem::forget(library);
        let (Ok(get_proc_address), Ok(get_current_context), Ok(make_current)) = functions else {
            return Err(Code::ERROR_RUNTIME_FAILURE.into());
        };
        Ok(Gles { gl: None, get_proc_address, get_current_context, make_current, display, context })
    }

    /// Returns the functions of GL. The context must be current.
    fn gl(&mut self) -> &glow::Context {
        let get = self.get_proc_address;
        self.gl.get_or_insert_with(|| {
            // SAFETY: the context is current, and GL's library stays loaded.
            unsafe {
                glow::Context::from_loader_function_cstr(|name: &CStr| {
                    let name = CString::from(name);
                    get(name.as_ptr().cast())
                })
            }
        })
    }

    /// Runs `work` with a layer of a texture in a framebuffer. Restores the application's state.
    fn with_layer<T>(
        &mut self,
        texture: Texture,
        layer: u32,
        attachment: u32,
        work: impl Fn(&glow::Context) -> T,
    ) -> Option<T> {
        if !self.is_current() {
            return None;
        }
        let gl = self.gl();
        // SAFETY: plain GL calls in the context that the texture belongs to.
        unsafe {
            let read = gl.get_parameter_framebuffer(glow::READ_FRAMEBUFFER_BINDING);
            let draw = gl.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING);
            let framebuffer = gl.create_framebuffer().ok()?;
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            let raw = name(texture);
            if texture.layers > 1 {
                gl.framebuffer_texture_layer(glow::FRAMEBUFFER, attachment, raw, 0, layer as i32);
            } else {
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, raw, 0);
            }
            let complete = gl.check_framebuffer_status(glow::FRAMEBUFFER) == glow::FRAMEBUFFER_COMPLETE;
            let result = complete.then(|| work(gl));
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, read);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, draw);
            gl.delete_framebuffer(framebuffer);
            result
        }
    }
}

/// Reads a rectangle of the bound framebuffer in a format and of a type, with this many bytes a pixel.
fn read_pixels(
    gl: &glow::Context,
    [x, y, width, height]: [i32; 4],
    format: u32,
    kind: u32,
    bytes: i32,
) -> Vec<u8> {
    let mut pixels = vec![0; (width * height * bytes) as usize];
    // SAFETY: the array has room for all pixels, and the application's pack state is restored.
    unsafe {
        let buffer = gl.get_parameter_buffer(glow::PIXEL_PACK_BUFFER_BINDING);
        let settings =
            [glow::PACK_ALIGNMENT, glow::PACK_ROW_LENGTH, glow::PACK_SKIP_ROWS, glow::PACK_SKIP_PIXELS];
        let before = settings.map(|setting| gl.get_parameter_i32(setting));
        gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        for (setting, value) in settings.into_iter().zip([4, 0, 0, 0]) {
            gl.pixel_store_i32(setting, value);
        }
        let target = glow::PixelPackData::Slice(Some(&mut pixels));
        gl.read_pixels(x, y, width, height, format, kind, target);
        for (setting, value) in settings.into_iter().zip(before) {
            gl.pixel_store_i32(setting, value);
        }
        gl.bind_buffer(glow::PIXEL_PACK_BUFFER, buffer);
    }
    pixels
}

/// Returns the texture's name in GL.
fn name(texture: Texture) -> Option<glow::Texture> {
    u32::try_from(texture.raw).ok().and_then(NonZeroU32::new).map(glow::NativeTexture)
}

impl Graphics for Gles {
    fn is_current(&self) -> bool {
        // SAFETY: the call has no preconditions.
        let current = unsafe { (self.get_current_context)() };
        !current.is_null() && current == self.context
    }

    fn unbind(&self) {
        // SAFETY: the display is the application's.
        unsafe { (self.make_current)(self.display, ptr::null(), ptr::null(), ptr::null()) };
    }

    fn image_type(&self) -> sys::StructureType {
        sys::SwapchainImageOpenGLESKHR::TYPE
    }

    fn texture(&mut self, info: &sys::SwapchainCreateInfo) -> Option<Texture> {
        let (format, layers) = (info.format as u32, info.array_size);
        let (width, height) = (info.width, info.height);
        let gl = self.gl();
        let (target, binding) = if layers > 1 {
            (glow::TEXTURE_2D_ARRAY, glow::TEXTURE_BINDING_2D_ARRAY)
        } else {
            (glow::TEXTURE_2D, glow::TEXTURE_BINDING_2D)
        };
        // SAFETY: plain GL calls; the application's binding is restored.
        unsafe {
            let before = gl.get_parameter_texture(binding);
            let texture = gl.create_texture().ok()?;
            gl.bind_texture(target, Some(texture));
            if layers > 1 {
                gl.tex_storage_3d(target, 1, format, width as i32, height as i32, layers as i32);
            } else {
                gl.tex_storage_2d(target, 1, format, width as i32, height as i32);
            }
            let error = gl.get_error();
            gl.bind_texture(target, before);
            (error == glow::NO_ERROR).then_some(Texture { raw: texture.0.get().into(), layers })
        }
    }

    fn delete(&mut self, textures: &[Texture]) {
        if self.is_current() {
            let gl = self.gl();
            for texture in textures {
                // SAFETY: created in this context.
                unsafe { name(*texture).map(|name| gl.delete_texture(name)) };
            }
        }
    }

    fn poison(&mut self, texture: Texture) {
        for layer in 0..texture.layers {
            self.with_layer(texture, layer, glow::COLOR_ATTACHMENT0, |gl| {
                // SAFETY: plain GL calls; the state that restricts a clear is restored.
                unsafe {
                    let scissor = gl.is_enabled(glow::SCISSOR_TEST);
                    let mask = gl.get_parameter_bool_array::<4>(glow::COLOR_WRITEMASK);
                    gl.disable(glow::SCISSOR_TEST);
                    gl.color_mask(true, true, true, true);
                    gl.clear_buffer_f32_slice(glow::COLOR, 0, &POISON.map(|c| f32::from(c) / 255.0));
                    gl.color_mask(mask[0], mask[1], mask[2], mask[3]);
                    if scissor {
                        gl.enable(glow::SCISSOR_TEST);
                    }
                }
            });
        }
    }

    fn read(&mut self, texture: Texture, layer: u32, rect: [i32; 4]) -> Option<Vec<u8>> {
        self.with_layer(texture, layer, glow::COLOR_ATTACHMENT0, |gl| {
            read_pixels(gl, rect, glow::RGBA, glow::UNSIGNED_BYTE, 4)
        })
    }

    fn read_vectors(&mut self, texture: Texture, layer: u32, rect: [i32; 4]) -> Option<Vec<Vec3>> {
        let bytes = self.with_layer(texture, layer, glow::COLOR_ATTACHMENT0, |gl| {
            read_pixels(gl, rect, glow::RGBA, glow::FLOAT, 16)
        })?;
        Some(floats(&bytes).chunks_exact(4).map(Vec3::from_slice).collect())
    }

    /// Uses GL_NV_read_depth, which Mesa has. It reads depth of floats as such, and any other as unsigned integers.
    fn read_depth(&mut self, texture: Texture, layer: u32, rect: [i32; 4]) -> Option<Vec<f32>> {
        self.with_layer(texture, layer, glow::DEPTH_ATTACHMENT, |gl| {
            let read = |kind: u32| {
                let bytes = read_pixels(gl, rect, glow::DEPTH_COMPONENT, kind, 4);
                // SAFETY: a query.
                (unsafe { gl.get_error() } == glow::NO_ERROR).then_some(bytes)
            };
            let part = |four: &[u8]| {
                u32::from_ne_bytes([four[0], four[1], four[2], four[3]]) as f32 / u32::MAX as f32
            };
            let parts = |bytes: Vec<u8>| bytes.chunks_exact(4).map(part).collect();
            read(glow::UNSIGNED_INT).map(parts).or_else(|| Some(floats(&read(glow::FLOAT)?)))
        })?
    }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|four| f32::from_ne_bytes([four[0], four[1], four[2], four[3]])).collect()
}
