//! OpenGL and OpenGL ES.

mod check;

use std::ffi::{CStr, c_char, c_void};
use std::num::NonZeroU32;
use std::rc::Rc;

use yoro::eyes::Warp;
use yoro::gl::{Context, Destination, GlApi};
use yoro::synthesis::{self, Edges, GlState, Outputs, Source, Synthesis, SynthesisOptions};

use crate::context::{
    Backend, YORO_API_OPENGL, YORO_API_OPENGL_ES, YoroCapabilities, YoroContext, create, enter_as,
};
use crate::result::{
    Failure, YORO_ERROR_DRIVER, YORO_ERROR_NO_CONTEXT, YORO_ERROR_NULL, YORO_ERROR_TOO_LARGE, YoroMessages,
    YoroResult,
};
use crate::types::{YORO_OUTPUT_DEPTH, YORO_OUTPUT_SRGB, YoroEdges, YoroOutputFlags, edges};
use crate::versioned::{self, versioned};
use crate::views::YoroWarp;

/// An entry point of any type.
pub type YoroGlProc = Option<unsafe extern "C" fn()>;
/// Returns an entry point by its name, NULL for one that does not exist: eglGetProcAddress, glfwGetProcAddress and others.
pub type YoroGlLoader = Option<unsafe extern "C" fn(name: *const c_char) -> YoroGlProc>;

/// The treatment of GL state that a call changes.
pub type YoroGlState = u32;
/// Some of it stays changed (docs/library.md has the table): for engines that set all state that they draw with.
pub const YORO_GL_STATE_LEAVE: YoroGlState = 0;
/// All of it is restored.
pub const YORO_GL_STATE_PRESERVE: YoroGlState = 1;

/// The options of a context for OpenGL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroGlInfo {
    /// sizeof(YoroGlInfo).
    pub struct_size: u32,
    /// Zero. Earlier versions chose a pipeline here; other numbers are refused.
    pub reserved: u32,
    /// YORO_OUTPUT_ bits.
    pub outputs: YoroOutputFlags,
    /// The treatment of GL state.
    pub state: YoroGlState,
    /// 1: each call checks textures, framebuffer and GL's error flag, which it clears. This waits for the driver: use it in
    /// development. 0: mistakes are undefined behaviour, as in GL.
    pub check: u32,
    /// The kind of source images; 0 is YORO_EDGES_HARD. YORO_EDGES_MULTISAMPLE needs OpenGL ES 3.1.
    pub edges: YoroEdges,
    /// The loader of entry points.
    pub loader: YoroGlLoader,
    /// The receiver of the sentences of errors, also in later calls.
    pub messages: YoroMessages,
}

versioned!(YoroGlInfo);

/// Creates a context for OpenGL ES 3.0 or later, or desktop OpenGL 4.5 or later, and compiles its shaders. Call it at start,
/// not in a frame.
///
/// Call it on the thread on which the GL context is current. GL state is treated as YoroGlInfo says; the error flag stays.
///
/// @param info    The options.
/// @param context Receives the new context, NULL after an error. Destroy it with yoro_destroy.
/// @pre The GL context is current, and lives as long as the YoroContext.
/// @return YORO_ERROR_NO_CONTEXT, YORO_ERROR_UNSUPPORTED, YORO_ERROR_DRIVER, YORO_ERROR_VALUE, YORO_ERROR_NULL,
///         YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_create(
    info: *const YoroGlInfo,
    context: *mut *mut YoroContext,
) -> YoroResult {
    // SAFETY: the header asks for valid pointers, a current GL context, and its loader.
    unsafe { create(info, context, |info| info.messages, |info| Gl::new(info)) }
}

/// Textures and framebuffer of one synthesis.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroGlImages {
    /// sizeof(YoroGlImages).
    pub struct_size: u32,
    /// Colour of the rendered eye: name of a GL_TEXTURE_2D of the source's size in any filterable format. All four channels
    /// are carried over, in any encoding. Filters and sampler objects do not matter. Unless YORO_EDGES_HARD is chosen it is
    /// resolved, with values between 0 and 1.
    pub color_texture: u32,
    /// Depth of the rendered eye: name of a GL_TEXTURE_2D of the same size with a depth, depth-stencil (sampled as depth) or
    /// red float format. For YORO_EDGES_MULTISAMPLE a GL_TEXTURE_2D_MULTISAMPLE of 2 or 4 samples.
    pub depth_texture: u32,
    /// The framebuffer to draw into, 0 for the window's. Its first colour attachment is written, and with YORO_OUTPUT_DEPTH
    /// its depth attachment. None of the textures above may be attached to it.
    pub framebuffer: u32,
    /// First column of the synthesized image in the framebuffer.
    pub x: u32,
    /// First row of the synthesized image in the framebuffer, counted from the bottom.
    pub y: u32,
    /// For YORO_EDGES_MULTISAMPLE, name of the GL_TEXTURE_2D_MULTISAMPLE that color_texture was resolved from, or 0 if it
    /// does not exist any more. Otherwise 0.
    pub sample_color_texture: u32,
}

versioned!(YoroGlImages);

/// Allocates the buffers for images of these sizes, so that the first yoro_gl_synthesize does not. Does nothing if the sizes
/// are as before.
///
/// Thread, GL state and results are those of yoro_gl_synthesize.
///
/// @param context The context.
/// @param warp    The warp of a frame of these sizes.
/// @pre The GL context is current.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_prepare(context: *mut YoroContext, warp: *const YoroWarp) -> YoroResult {
    // SAFETY: the header asks for pointers that are NULL or lead to live objects of their types.
    unsafe {
        enter_gl(context, |gl| {
            let warp = gl.fitting(warp)?;
            Ok(gl.synthesis.prepare(&warp)?)
        })
    }
}

/// Synthesizes the other eye into a rectangle of warp's target size, and overwrites all of it. Call it after the opaque
/// objects of the rendered eye, and before transparent objects and effects that are drawn for each eye.
///
/// Call it on the thread on which the GL context is current. GL state is treated as YoroGlInfo says. While sizes stay the same
/// it allocates and compiles nothing, and does not wait for the GPU.
///
/// @param context The context.
/// @param warp    The warp of YoroViews.
/// @param images  The images to read and the place to draw.
/// @pre The GL context is current. The textures and the framebuffer belong to it and are as YoroGlImages says. Transform
///      feedback and conditional rendering are not active.
/// @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE, YORO_ERROR_DRIVER; with `check` also YORO_ERROR_FORMAT;
///         YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_synthesize(
    context: *mut YoroContext,
    warp: *const YoroWarp,
    images: *const YoroGlImages,
) -> YoroResult {
    // SAFETY: the header asks for pointers that are NULL or lead to live objects of their types.
    unsafe {
        enter_gl(context, |gl| {
            let warp = gl.fitting(warp)?;
            gl.synthesize(&warp, &versioned::read(images, "images")?)
        })
    }
}

/// # Safety
/// `context` is null or alive.
unsafe fn enter_gl(
    context: *mut YoroContext,
    body: impl FnOnce(&mut Gl) -> Result<(), Failure>,
) -> YoroResult {
    // SAFETY: the contract is the same.
    unsafe { enter_as(context, "yoro_gl_create", body) }
}

/// The synthesis in a GL context.
pub(crate) struct Gl {
    context: Rc<Context>,
    synthesis: Box<dyn Synthesis>,
    edges: Edges,
    outputs: Outputs,
    check: bool,
}

impl Gl {
    /// # Safety
    /// A GL context is current, and the loader gives its entry points.
    unsafe fn new(info: &YoroGlInfo) -> Result<Gl, Failure> {
        if info.reserved != 0 {
            return Err(Failure::value(format!(
                "reserved is {}: give 0; earlier versions chose a pipeline here, and only number 0 is left",
                info.reserved
            )));
        }
        let gl_state = match info.state {
            YORO_GL_STATE_LEAVE => GlState::Leave,
            YORO_GL_STATE_PRESERVE => GlState::Preserve,
            other => {
                return Err(Failure::value(format!(
                    "{other} is no GL state: give a YORO_GL_STATE_ constant"
                )));
            }
        };
        let (outputs, edges) = (outputs(info.outputs)?, edges(info.edges)?);
        if info.check > 1 {
            return Err(Failure::value(format!("check is {}: give 0 or 1", info.check)));
        }
        let Some(loader) = info.loader else {
            return Err(Failure::new(YORO_ERROR_NULL, "loader is NULL: give eglGetProcAddress or its like"));
        };
        // SAFETY: the loader takes a name; a function and a nullable pointer are of one size.
        let load =
            |name: &CStr| unsafe { std::mem::transmute::<YoroGlProc, *const c_void>(loader(name.as_ptr())) };
        // SAFETY: the caller says that a context is current and that the loader gives its entry points.
        let context = unsafe {
            check_current(load)?;
            Context::with_loader(glow::Context::from_loader_function_cstr(load), load)?
        };
        let options = SynthesisOptions { edges, gl_state };
        let synthesis = synthesis::create(&context, &options, outputs)?;
        Ok(Gl { context, synthesis, edges, outputs, check: info.check == 1 })
    }

    /// Reads a warp and checks that the driver can render its sizes.
    ///
    /// # Safety
    /// `warp` is null or leads to one.
    unsafe fn fitting(&self, warp: *const YoroWarp) -> Result<Warp, Failure> {
        if warp.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "warp is NULL: give the one of YoroViews"));
        }
        // SAFETY: the pointer is not null, so it leads to a warp; alignment is not needed.
        let warp = unsafe { warp.read_unaligned() }.checked()?;
        let limit = self.context.capabilities().max_texture_size;
        let largest = warp.source_size.into_iter().chain(warp.target_size).max().unwrap_or(0);
        if largest > limit {
            return Err(Failure::new(
                YORO_ERROR_TOO_LARGE,
                format!(
                    "an image side of {largest} pixels is beyond this driver's {limit}: choose a smaller size"
                ),
            ));
        }
        Ok(warp)
    }

    fn synthesize(&mut self, warp: &Warp, images: &YoroGlImages) -> Result<(), Failure> {
        let texture = |name: u32, what: &str| {
            let name = NonZeroU32::new(name).map(glow::NativeTexture);
            name.ok_or_else(|| Failure::value(format!("{what} is 0: give the name of a texture")))
        };
        let color = texture(images.color_texture, "color_texture")?;
        let depth = texture(images.depth_texture, "depth_texture")?;
        let samples = NonZeroU32::new(images.sample_color_texture).map(glow::NativeTexture);
        if samples.is_some() && self.edges != Edges::Multisample {
            return Err(Failure::value(
                "sample_color_texture is for YORO_EDGES_MULTISAMPLE only: set it to 0, or choose those edges",
            ));
        }
        let source = Source { samples, ..Source::new(color, depth) };
        let limit = self.context.capabilities().max_texture_size;
        if images.x > limit || images.y > limit {
            return Err(Failure::value(format!(
                "x and y are {}, {}: larger than any framebuffer",
                images.x, images.y
            )));
        }
        let target = Destination {
            framebuffer: NonZeroU32::new(images.framebuffer).map(glow::NativeFramebuffer),
            origin: [images.x, images.y],
            size: warp.target_size,
        };
        if self.check {
            check::check_images(&self.context, self.edges, self.outputs, source, warp, &target)?;
        }
        self.synthesis.synthesize(source, warp, &target)?;
        match self.check.then(|| self.context.take_errors()).flatten() {
            Some(errors) => Err(Failure::new(
                YORO_ERROR_DRIVER,
                format!("GL says {errors}: see the preconditions of yoro_gl_synthesize"),
            )),
            None => Ok(()),
        }
    }
}

impl Backend for Gl {
    fn api(&self) -> &'static str {
        "OpenGL"
    }

    fn capabilities(&self) -> YoroCapabilities {
        let own = self.context.capabilities();
        let mut capabilities = YoroCapabilities {
            struct_size: size_of::<YoroCapabilities>() as u32,
            api: match own.api {
                GlApi::Es => YORO_API_OPENGL_ES,
                GlApi::Desktop => YORO_API_OPENGL,
            },
            api_major: own.version.0,
            api_minor: own.version.1,
            reserved: 0,
            compute: own.compute.into(),
            software: own.software.into(),
            max_image_size: own.max_texture_size,
            buffer_bytes: self.context.texture_bytes() as u64,
            device: [0; 128],
        };
        capabilities.set_device(&own.renderer);
        capabilities
    }
}

pub(crate) fn outputs(bits: YoroOutputFlags) -> Result<Outputs, Failure> {
    if bits & !(YORO_OUTPUT_DEPTH | YORO_OUTPUT_SRGB) != 0 {
        return Err(Failure::value(format!("{bits} has bits that are no YORO_OUTPUT_ flags")));
    }
    let has = |bit| bits & bit != 0;
    Ok(Outputs { depth: has(YORO_OUTPUT_DEPTH), source_map: false, srgb: has(YORO_OUTPUT_SRGB) })
}

/// Checks that a context is current, which glow takes for granted.
///
/// # Safety
/// `load` gives entry points of these names, or null.
unsafe fn check_current(load: impl Fn(&CStr) -> *const c_void) -> Result<(), Failure> {
    type GetString = unsafe extern "system" fn(u32) -> *const u8;
    let get_string = load(c"glGetString");
    let names = [c"glGetString", c"glGetStringi", c"glGetIntegerv", c"glCreateProgram", c"glDrawArrays"];
    if let Some(name) = names.into_iter().find(|name| load(name).is_null()) {
        let name = name.to_string_lossy();
        return Err(Failure::new(
            YORO_ERROR_NO_CONTEXT,
            format!(
                "the loader does not return {name}: give the loader of the GL context, such as eglGetProcAddress"
            ),
        ));
    }
    // SAFETY: the entry point has this signature.
    let version = unsafe { std::mem::transmute::<*const c_void, GetString>(get_string)(glow::VERSION) };
    if version.is_null() {
        return Err(Failure::new(
            YORO_ERROR_NO_CONTEXT,
            "no GL context is current on this thread: make it current before yoro_gl_create",
        ));
    }
    Ok(())
}
