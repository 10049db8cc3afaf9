//! Objects over [`glow`]: programs, textures, framebuffers, meshes, timers, capabilities.
//!
//! A [`Context`] wraps the context that the caller lends. All other objects are created in it, delete themselves when
//! dropped, and are counted, so that tests can detect leaks.
//!
//! The crate knows one thing about synthesis: the state that synthesis sets, saves and restores in a host's context
//! ([`Context::begin_synthesis`], [`HostState`]). It knows neither how anything is synthesized, nor a scene or a
//! window.

mod capabilities;
mod framebuffer;
mod host;
mod mesh;
mod multisample;
mod observer;
mod pixel_buffer;
mod profiler;
mod program;
mod sample_mask;
mod state;
mod texture;

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::ffi::{CStr, c_void};
use std::rc::Rc;

use glow::HasContext;

pub use capabilities::{Capabilities, GlApi};
pub use framebuffer::{Destination, ForeignTarget, RenderTarget};
pub use host::{HostState, Touched};
pub use mesh::Mesh;
pub use multisample::{MultisampleTarget, TileTarget};
pub use observer::{Declaration, Draw, Image, Observer, Pass, Read, Shape, Write};
pub use pixel_buffer::PixelBuffer;
pub use profiler::{PassTime, Profiling};
pub use program::{Program, ProgramRecipe, ShaderSource, UniformValue};
pub use state::{Blend, DepthTest, RasterState, StencilTest};
pub use texture::{Filter, Format, Texture};

/// A GL error.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GlError {
    /// The context is too old or lacks a required feature.
    #[error("{0}")]
    Unsupported(String),
    /// The shader file is not part of the program, or an included file does not exist.
    #[error("shader file {0} does not exist")]
    MissingShader(String),
    /// A shader did not compile or a program did not link.
    #[error("{stage} {file} failed: {log}")]
    Shader {
        /// Vertex, fragment or compute shader, or program.
        stage: &'static str,
        /// Shader file.
        file: String,
        /// The driver's log, with file names instead of source string numbers.
        log: String,
    },
    /// The driver refused to create or accept an object.
    #[error("the GL driver could not create {what}: {reason}")]
    Object {
        /// The object.
        what: String,
        /// The driver's reason.
        reason: String,
    },
    /// The driver has no memory left.
    #[error(
        "the GL driver has no memory for a {width}x{height} texture; choose a smaller size, or free some"
    )]
    OutOfMemory {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// The image is larger than the driver supports.
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

/// glGetQueryiv: target, parameter, pointer to the value.
type GetQuery = unsafe extern "system" fn(u32, u32, *mut i32);

/// Entry points without a wrapper in glow; `None` if the driver lacks them.
#[derive(Clone, Copy, Default)]
struct EntryPoints {
    framebuffer_texture_multiview: Option<FramebufferTextureMultiview>,
    sample_masks: Option<sample_mask::SampleMasks>,
    get_query: Option<GetQuery>,
    indexed: Option<host::IndexedQueries>,
}

impl EntryPoints {
    /// True if the driver's timer queries measure anything: QUERY_COUNTER_BITS may be 0. The context must be current
    /// and have timer queries.
    fn counts_time(&self) -> bool {
        let Some(get_query) = self.get_query else { return true };
        let mut bits = 1;
        // SAFETY: a target and a parameter of timer queries, which exist; one integer is written.
        unsafe { get_query(glow::TIME_ELAPSED, QUERY_COUNTER_BITS, &mut bits) };
        bits != 0
    }
}

/// GL_QUERY_COUNTER_BITS, which is not in glow.
const QUERY_COUNTER_BITS: u32 = 0x8864;

/// A GL context and its capabilities, shared by all objects that live in it.
pub struct Context {
    raw: glow::Context,
    /// Browsers provide the function without an entry point.
    #[cfg(not(target_arch = "wasm32"))]
    framebuffer_texture_multiview: Option<FramebufferTextureMultiview>,
    sample_masks: Option<sample_mask::SampleMasks>,
    capabilities: Capabilities,
    host: host::Host,
    profiler: RefCell<profiler::Profiler>,
    objects: Cell<usize>,
    texture_bytes: Cell<usize>,
    /// The number of textures that were deleted: their names may come again.
    deleted_textures: Cell<u64>,
    /// True while passes draw into images that stay in a tile.
    is_in_tile: Cell<bool>,
    empty_vertex_array: glow::VertexArray,
    observed: RefCell<Option<observer::Observed>>,
    /// The last field, since fields are dropped in order of declaration.
    _owner: Option<Rc<dyn Any>>,
}

impl Context {
    /// Wraps a glow context, which must be current, and checks that it can run the shaders. Does not change its state.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the context is older than OpenGL ES 3.0, or is desktop GL that does not compile GLSL
    /// ES 3.10.
    pub fn new(raw: glow::Context) -> Result<Rc<Context>, GlError> {
        Context::with_entry_points(raw, EntryPoints::default(), None, |_| {})
    }

    /// Like [`Context::new`], with functions that glow does not wrap: multiview, sample masks, the bits of timer queries,
    /// and the state of single draw buffers. Without the latter, [`Context::restore_state`] gives the second draw buffer the
    /// state of the first. `load` returns an entry point by its name, or null.
    ///
    /// # Errors
    /// Those of [`Context::new`].
    ///
    /// # Safety
    /// `load` must return null or this context's entry point of that name.
    pub unsafe fn with_loader(
        raw: glow::Context,
        load: impl FnMut(&CStr) -> *const c_void,
    ) -> Result<Rc<Context>, GlError> {
        // SAFETY: the contract of this function is the same.
        unsafe { Context::loaded(raw, load, None, |_| {}) }
    }

    /// Like [`Context::with_loader`], for a context and a library that `owner` destroys when it is dropped. The owner
    /// is kept until the last object of the context is deleted. `limit` takes capabilities away, to see what a lesser
    /// driver would do.
    ///
    /// # Errors
    /// Those of [`Context::new`].
    ///
    /// # Safety
    /// Those of [`Context::with_loader`]; `limit` only takes away.
    pub unsafe fn owned(
        raw: glow::Context,
        load: impl FnMut(&CStr) -> *const c_void,
        owner: Rc<dyn Any>,
        limit: impl FnOnce(&mut Capabilities),
    ) -> Result<Rc<Context>, GlError> {
        // SAFETY: the contract of this function is the same.
        unsafe { Context::loaded(raw, load, Some(owner), limit) }
    }

    /// # Safety
    /// Those of [`Context::with_loader`].
    unsafe fn loaded(
        raw: glow::Context,
        mut load: impl FnMut(&CStr) -> *const c_void,
        owner: Option<Rc<dyn Any>>,
        limit: impl FnOnce(&mut Capabilities),
    ) -> Result<Rc<Context>, GlError> {
        // SAFETY: null becomes `None`; any other pointer is the entry point of that name, whose signature
        // GL_OVR_multiview, OpenGL 3.0 and OpenGL ES 3.0 and 3.2 define.
        let entry_points = unsafe {
            let is_enabled =
                std::mem::transmute::<*const c_void, Option<host::IsEnabledIndexed>>(load(c"glIsEnabledi"));
            let get_boolean = std::mem::transmute::<*const c_void, Option<host::GetBooleanIndexed>>(load(
                c"glGetBooleani_v",
            ));
            let set_mask =
                std::mem::transmute::<*const c_void, Option<sample_mask::SetMask>>(load(c"glSampleMaski"));
            let get_sample = std::mem::transmute::<*const c_void, Option<sample_mask::GetSample>>(load(
                c"glGetMultisamplefv",
            ));
            EntryPoints {
                framebuffer_texture_multiview: std::mem::transmute::<
                    *const c_void,
                    Option<FramebufferTextureMultiview>,
                >(load(c"glFramebufferTextureMultiviewOVR")),
                get_query: std::mem::transmute::<*const c_void, Option<GetQuery>>(load(c"glGetQueryiv")),
                sample_masks: set_mask
                    .zip(get_sample)
                    .map(|(set_mask, get_sample)| sample_mask::SampleMasks { set_mask, get_sample }),
                indexed: is_enabled
                    .zip(get_boolean)
                    .map(|(is_enabled, get_boolean)| host::IndexedQueries { is_enabled, get_boolean }),
            }
        };
        Context::with_entry_points(raw, entry_points, owner, limit)
    }

    fn with_entry_points(
        raw: glow::Context,
        entry_points: EntryPoints,
        owner: Option<Rc<dyn Any>>,
        limit: impl FnOnce(&mut Capabilities),
    ) -> Result<Rc<Context>, GlError> {
        let has_multiview =
            cfg!(target_arch = "wasm32") || entry_points.framebuffer_texture_multiview.is_some();
        let loaded = capabilities::Loaded {
            multiview: has_multiview,
            sample_masks: entry_points.sample_masks.is_some(),
        };
        let mut capabilities = Capabilities::query(&raw, loaded, || entry_points.counts_time())?;
        limit(&mut capabilities);
        let host = host::Host::new(&raw, &capabilities, entry_points.indexed)?;
        // SAFETY: creates an object, which `Context` deletes when it is dropped.
        let empty_vertex_array = unsafe { raw.create_vertex_array() }
            .map_err(|reason| GlError::Object { what: "a vertex array".into(), reason })?;
        let profiler = RefCell::new(profiler::Profiler::new(&capabilities));
        Ok(Rc::new(Context {
            raw,
            #[cfg(not(target_arch = "wasm32"))]
            framebuffer_texture_multiview: entry_points.framebuffer_texture_multiview,
            sample_masks: entry_points.sample_masks,
            capabilities,
            host,
            profiler,
            objects: Cell::new(0),
            texture_bytes: Cell::new(0),
            deleted_textures: Cell::new(0),
            is_in_tile: Cell::new(false),
            empty_vertex_array,
            observed: RefCell::new(None),
            _owner: owner,
        }))
    }

    /// Returns the glow context, for calls that have no wrapper here.
    pub fn raw(&self) -> &glow::Context {
        &self.raw
    }

    /// Returns the driver's version, limits and extensions.
    pub fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    /// Returns the number of this library's live textures, renderbuffers, framebuffers, programs, buffers and vertex
    /// arrays.
    pub fn object_count(&self) -> usize {
        self.objects.get()
    }

    fn count(&self, change: isize) {
        self.objects.set(self.objects.get().wrapping_add_signed(change));
    }

    /// Returns the size in bytes of this library's live textures and render targets, computed from their formats.
    /// Drivers may add padding.
    pub fn texture_bytes(&self) -> usize {
        self.texture_bytes.get()
    }

    fn count_texture_bytes(&self, change: isize) {
        self.texture_bytes.set(self.texture_bytes.get().wrapping_add_signed(change));
    }

    /// Runs `body` inside a KHR_debug group called `name` and, while profiling, with a timer of that name.
    fn grouped<R>(&self, name: &'static str, body: impl FnOnce() -> R) -> R {
        let debug = self.capabilities.debug_groups;
        // SAFETY: the entry points exist if the capability is set; the group is popped below.
        unsafe {
            if debug {
                self.raw.push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 0, name);
            }
        }
        self.profiler.borrow_mut().begin(&self.raw, name);
        let result = body();
        self.profiler.borrow_mut().end(&self.raw);
        // SAFETY: pops the group pushed above.
        unsafe {
            if debug {
                self.raw.pop_debug_group();
            }
        }
        result
    }

    /// Starts or stops timing passes. [`Profiling::Finish`] waits for the GPU before and after each pass.
    pub fn set_profiling(&self, profiling: Profiling) {
        self.profiler.borrow_mut().set(&self.raw, profiling);
    }

    /// Returns the pass times since the last call, in the order in which the passes ran; none if timer queries are
    /// undefined for one of them ([`Capabilities::multiview_timer_queries`]). Waits for the GPU.
    pub fn take_pass_times(&self) -> Vec<PassTime> {
        self.profiler.borrow_mut().take(&self.raw)
    }

    /// Ends a frame, to time every frame without waiting ([`Profiling::Queries`]). Adds the pass times of an earlier
    /// frame to `times`, and returns how many calls ago that frame ended; `None` if no times are available. A frame is
    /// left out if the clock was disturbed or if timer queries are undefined for one of its passes.
    pub fn end_timed_frame(&self, times: &mut Vec<PassTime>) -> Option<u32> {
        self.profiler.borrow_mut().end_frame(&self.raw, times)
    }

    /// Notes that several views are drawn at once from now on. If timer queries are undefined for this, the frame gets
    /// no pass times.
    fn note_multiview(&self) {
        if !self.capabilities.multiview_timer_queries {
            self.profiler.borrow_mut().make_undefined(&self.raw);
        }
    }

    /// Blocks until the GPU has finished all commands.
    pub fn finish(&self) {
        // SAFETY: touches no memory of ours.
        unsafe { self.raw.finish() }
    }

    /// Blocks until the GPU has drawn into `to`. In browsers, where glFinish has little effect, it reads a pixel of
    /// each.
    pub fn finish_drawing(&self, to: &[Destination]) {
        #[cfg(target_arch = "wasm32")]
        for to in to {
            self.read_rgba8(&Destination { size: [1, 1], ..*to });
        }
        #[cfg(not(target_arch = "wasm32"))]
        {
            let _ = to;
            self.finish();
        }
    }

    /// True if passes are being timed, by timer queries or by waiting for the GPU.
    pub fn times_passes(&self) -> bool {
        self.profiler.borrow().is_on()
    }

    /// Attaches the first two layers of an array texture to the bound framebuffer, to draw to both at once.
    ///
    /// # Safety
    /// The context must have multiview, and the texture must be an array of at least two layers.
    #[cfg(not(target_arch = "wasm32"))]
    unsafe fn framebuffer_texture_layers(&self, attachment: u32, texture: glow::Texture) {
        if let Some(attach) = self.framebuffer_texture_multiview {
            // SAFETY: the entry point of GL_OVR_multiview; the caller's texture has two layers.
            unsafe { attach(glow::FRAMEBUFFER, attachment, texture.0.get(), 0, 0, 2) }
        }
    }

    /// Attaches the first two layers of an array texture to the bound framebuffer, in WebGL.
    ///
    /// # Safety
    /// The texture must be an array of at least two layers.
    #[cfg(target_arch = "wasm32")]
    unsafe fn framebuffer_texture_layers(&self, attachment: u32, texture: glow::Texture) {
        let (gl, target) = (&self.raw, glow::FRAMEBUFFER);
        // SAFETY: the caller's texture has two layers.
        unsafe { gl.framebuffer_texture_multiview_ovr(target, attachment, Some(texture), 0, 0, 2) }
    }

    /// Draws one triangle that covers the viewport. The vertex shader `screen.vert` computes it from gl_VertexID.
    pub fn draw_screen(&self) {
        // SAFETY: the vertex array has no attributes, so nothing is read from buffers.
        self.drawing(Shape::Screen, || unsafe {
            self.raw.bind_vertex_array(Some(self.empty_vertex_array));
            self.raw.draw_arrays(glow::TRIANGLES, 0, 3);
        });
    }

    /// Returns the GL errors since the last call, separated by commas. For tests and debugging.
    pub fn take_errors(&self) -> Option<String> {
        let mut names = Vec::new();
        // A lost context keeps returning errors.
        while names.len() < 16 {
            // SAFETY: reads and clears the error flag.
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
        self.host.delete(&self.raw);
        // SAFETY: created in `new`, deleted once.
        unsafe { self.raw.delete_vertex_array(self.empty_vertex_array) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    unsafe extern "system" fn no_bits(target: u32, parameter: u32, bits: *mut i32) {
        assert_eq!((target, parameter), (0x88BF, 0x8864));
        // SAFETY: one integer, as the signature says.
        unsafe { *bits = 0 };
    }

    unsafe extern "system" fn many_bits(_: u32, _: u32, bits: *mut i32) {
        // SAFETY: as above.
        unsafe { *bits = 36 };
    }

    #[test]
    fn timer_queries_of_zero_bits_are_not_used() {
        let with = |get_query| EntryPoints { get_query, ..EntryPoints::default() };
        assert!(!with(Some(no_bits as GetQuery)).counts_time());
        assert!(with(Some(many_bits as GetQuery)).counts_time());
        assert!(with(None).counts_time());
    }
}
