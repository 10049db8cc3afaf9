//! Objects over glow: programs, textures, framebuffers, meshes, timers, capabilities.
//!
//! Objects delete themselves when dropped and are counted in their [`Context`], so that leaks show in a test.

mod capabilities;
mod framebuffer;
mod mesh;
mod pixel_buffer;
mod profiler;
mod program;
mod state;
mod texture;

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::ffi::{CStr, c_void};
use std::rc::Rc;

use glow::HasContext;

pub use capabilities::{Capabilities, GlApi};
pub use framebuffer::{Destination, ForeignTarget, RenderTarget};
pub use mesh::Mesh;
pub use pixel_buffer::PixelBuffer;
pub use profiler::{PassTime, Profiling};
pub use program::{Program, ShaderSource, UniformValue, shader_files};
pub use state::{Blend, DepthTest, RasterState};
pub use texture::{Filter, Format, Texture};

/// What can go wrong with GL.
#[derive(Debug, thiserror::Error)]
pub enum GlError {
    /// The context is too old or lacks what is needed.
    #[error("{0}")]
    Unsupported(String),
    /// A shader file that is not part of the program, or an include that does not exist.
    #[error("shader file {0} does not exist")]
    MissingShader(String),
    /// A shader did not compile or a program did not link.
    #[error("{stage} {file} failed: {log}")]
    Shader {
        /// Vertex, fragment or compute shader, or program.
        stage: &'static str,
        /// Shader file.
        file: String,
        /// The driver's log, with file names in place of source string numbers.
        log: String,
    },
    /// The driver refused to create or accept an object.
    #[error("the GL driver could not create {what}: {reason}")]
    Object {
        /// What was to be created.
        what: String,
        /// What the driver said.
        reason: String,
    },
    /// An image size beyond the driver's limits.
    #[error(
        "an image of {width}x{height} pixels is beyond what this GL driver can render ({limit}x{limit}); choose a smaller size"
    )]
    TooLarge {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
        /// GL_MAX_TEXTURE_SIZE.
        limit: u32,
    },
}

/// glFramebufferTextureMultiviewOVR: target, attachment, texture, level, first view, number of views.
type FramebufferTextureMultiview = unsafe extern "system" fn(u32, u32, u32, i32, i32, i32);

/// A GL context with what is known of it. Shared by everything that lives in it.
pub struct Context {
    raw: glow::Context,
    framebuffer_texture_multiview: Option<FramebufferTextureMultiview>,
    capabilities: Capabilities,
    profiler: RefCell<profiler::Profiler>,
    objects: Cell<usize>,
    texture_bytes: Cell<usize>,
    shader_files: RefCell<BTreeSet<String>>,
    empty_vertex_array: glow::VertexArray,
}

impl Context {
    /// Takes a current glow context, checks that it can run the shaders, and sets the state that all passes
    /// rely on (no dithering, sRGB encoding off, tightly packed pixels).
    ///
    /// # Errors
    /// [`GlError::Unsupported`] when the context is older than OpenGL ES 3.0, or desktop GL that does not
    /// compile GLSL ES 3.10.
    pub fn new(raw: glow::Context) -> Result<Rc<Context>, GlError> {
        Context::with_multiview(raw, None)
    }

    /// As [`Context::new`], with what glow has no wrapper for: multiview. `load` gives entry points by name, null
    /// for those that do not exist.
    ///
    /// # Errors
    /// As [`Context::new`].
    ///
    /// # Safety
    /// The pointers that `load` gives are the context's entry points of these names.
    pub unsafe fn with_loader(
        raw: glow::Context,
        load: impl FnOnce(&CStr) -> *const c_void,
    ) -> Result<Rc<Context>, GlError> {
        let pointer = load(c"glFramebufferTextureMultiviewOVR");
        // SAFETY: null is `None`; otherwise the caller promises an entry point, which has this signature by
        // GL_OVR_multiview.
        let multiview =
            unsafe { std::mem::transmute::<*const c_void, Option<FramebufferTextureMultiview>>(pointer) };
        Context::with_multiview(raw, multiview)
    }

    fn with_multiview(
        raw: glow::Context,
        framebuffer_texture_multiview: Option<FramebufferTextureMultiview>,
    ) -> Result<Rc<Context>, GlError> {
        let capabilities = Capabilities::query(&raw, framebuffer_texture_multiview.is_some())?;
        // SAFETY: the context is current; plain state calls with valid enums.
        let empty_vertex_array = unsafe {
            raw.disable(glow::DITHER);
            raw.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
            raw.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
            if capabilities.api == GlApi::Desktop {
                raw.disable(glow::FRAMEBUFFER_SRGB);
                raw.enable(glow::TEXTURE_CUBE_MAP_SEAMLESS);
            }
            raw.create_vertex_array()
                .map_err(|reason| GlError::Object { what: "a vertex array".into(), reason })?
        };
        let profiler = RefCell::new(profiler::Profiler::new(&capabilities));
        let shader_files = RefCell::default();
        Ok(Rc::new(Context {
            raw,
            framebuffer_texture_multiview,
            capabilities,
            profiler,
            objects: Cell::new(0),
            texture_bytes: Cell::new(0),
            shader_files,
            empty_vertex_array,
        }))
    }

    /// The glow context, for calls that have no wrapper here.
    pub fn raw(&self) -> &glow::Context {
        &self.raw
    }

    /// What the driver offers.
    pub fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    /// Number of live textures, framebuffers, programs, buffers and vertex arrays of this library.
    pub fn object_count(&self) -> usize {
        self.objects.get()
    }

    /// The shader files, includes among them, that programs were made of so far, as [`shader_files`] names them.
    pub fn used_shader_files(&self) -> Vec<String> {
        self.shader_files.borrow().iter().cloned().collect()
    }

    fn count(&self, change: isize) {
        self.objects.set(self.objects.get().wrapping_add_signed(change));
    }

    /// Bytes of all live textures of this library, render targets among them, by their formats; drivers may pad.
    pub fn texture_bytes(&self) -> usize {
        self.texture_bytes.get()
    }

    fn count_texture_bytes(&self, change: isize) {
        self.texture_bytes.set(self.texture_bytes.get().wrapping_add_signed(change));
    }

    /// Runs one pass inside a KHR_debug group and, while profiling, a timer, both called `name`.
    pub fn pass<R>(&self, name: &'static str, body: impl FnOnce() -> R) -> R {
        let debug = self.capabilities.debug_groups;
        // SAFETY: the entry points exist when the capability says so; groups are balanced below.
        unsafe {
            if debug {
                self.raw.push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 0, name);
            }
        }
        self.profiler.borrow_mut().begin(&self.raw, name);
        let result = body();
        self.profiler.borrow_mut().end(&self.raw);
        // SAFETY: as above.
        unsafe {
            if debug {
                self.raw.pop_debug_group();
            }
        }
        result
    }

    /// Starts or stops timing passes. Costs a full pipeline drain per pass with [`Profiling::Finish`].
    pub fn set_profiling(&self, profiling: Profiling) {
        self.profiler.borrow_mut().set(&self.raw, profiling);
    }

    /// The pass times since the last call, in the order in which they ran. Waits for the GPU.
    pub fn take_pass_times(&self) -> Vec<PassTime> {
        self.profiler.borrow_mut().take(&self.raw)
    }

    /// Ends a frame for those who time every frame without waiting ([`Profiling::Queries`]): adds the pass times of
    /// one frame, some frames ago, to `times`, and returns the number of frames added, 1 or 0.
    pub fn end_timed_frame(&self, times: &mut Vec<PassTime>) -> u32 {
        self.profiler.borrow_mut().end_frame(&self.raw, times)
    }

    /// Blocks until the GPU has done everything.
    pub fn finish(&self) {
        // SAFETY: no arguments.
        unsafe { self.raw.finish() }
    }

    /// Draws one triangle that covers the viewport; shaders make it from gl_VertexID
    /// (`screen.vert`).
    pub fn draw_screen(&self) {
        // SAFETY: an empty vertex array has no attributes to read out of bounds.
        unsafe {
            self.raw.bind_vertex_array(Some(self.empty_vertex_array));
            self.raw.draw_arrays(glow::TRIANGLES, 0, 3);
        }
    }

    /// The GL errors since the last call, as one sentence; for tests and debugging.
    pub fn take_errors(&self) -> Option<String> {
        let mut names = Vec::new();
        // A lost context returns errors for ever, hence the bound.
        while names.len() < 16 {
            // SAFETY: no arguments.
            match unsafe { self.raw.get_error() } {
                glow::NO_ERROR => break,
                glow::INVALID_ENUM => names.push("INVALID_ENUM"),
                glow::INVALID_VALUE => names.push("INVALID_VALUE"),
                glow::INVALID_OPERATION => names.push("INVALID_OPERATION"),
                glow::OUT_OF_MEMORY => names.push("OUT_OF_MEMORY"),
                glow::INVALID_FRAMEBUFFER_OPERATION => names.push("INVALID_FRAMEBUFFER_OPERATION"),
                _ => names.push("unknown error"),
            }
        }
        (!names.is_empty()).then(|| names.join(", "))
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        self.profiler.borrow_mut().delete(&self.raw);
        // SAFETY: created in `new`, deleted once.
        unsafe { self.raw.delete_vertex_array(self.empty_vertex_array) }
    }
}
