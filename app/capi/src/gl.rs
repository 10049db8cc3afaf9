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

/// An entry point, whatever its own type is.
pub type YoroGlProc = Option<unsafe extern "C" fn()>;
/// Gives an entry point by its name, NULL for those that do not exist: eglGetProcAddress, glfwGetProcAddress and others.
pub type YoroGlLoader = Option<unsafe extern "C" fn(name: *const c_char) -> YoroGlProc>;

/// What becomes of the GL state that a call changes.
pub type YoroGlState = u32;
/// Some of it is left changed (docs/library.md has the table): for engines that set what they draw with.
pub const YORO_GL_STATE_LEAVE: YoroGlState = 0;
/// All of it is as it was before the call.
pub const YORO_GL_STATE_PRESERVE: YoroGlState = 1;

/// How to create a context for OpenGL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroGlInfo {
    /// sizeof(YoroGlInfo).
    pub struct_size: u32,
    /// Zero. It once chose a pipeline: other numbers are refused.
    pub reserved: u32,
    /// YORO_OUTPUT_ bits.
    pub outputs: YoroOutputFlags,
    /// What becomes of GL state.
    pub state: YoroGlState,
    /// 1: each call looks whether textures and framebuffer are as they must be, and whether GL has errors, which it takes.
    /// Costs a wait for the driver: for development. 0: such mistakes are undefined, as in GL.
    pub check: u32,
    /// What the source knows of its edges; 0 is YORO_EDGES_HARD. YORO_EDGES_MULTISAMPLE needs
    /// OpenGL ES 3.1.
    pub edges: YoroEdges,
    /// Entry points.
    pub loader: YoroGlLoader,
    /// Where the sentences of errors go, those of later calls, too.
    pub messages: YoroMessages,
}

versioned!(YoroGlInfo);

/// Creates a context for OpenGL ES 3.0 or later, or desktop OpenGL 4.5 or later, and compiles its shaders: at start, not in
/// a frame.
///
/// On the thread on which the GL context is current. GL state as YoroGlInfo says, without a change of the error flag.
///
/// @param info    How.
/// @param context Gets the new context, NULL after an error. Destroy it with yoro_destroy.
/// @pre The GL context is current, and stays alive as long as the YoroContext.
/// @return YORO_ERROR_NO_CONTEXT, YORO_ERROR_UNSUPPORTED, YORO_ERROR_DRIVER, YORO_ERROR_VALUE, YORO_ERROR_NULL,
///         YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_create(
    info: *const YoroGlInfo,
    context: *mut *mut YoroContext,
) -> YoroResult {
    // SAFETY: the header asks the caller for pointers to what they name, and for a current GL context and its loader.
    unsafe { create(info, context, |info| info.messages, |info| Gl::new(info)) }
}

/// Textures and framebuffer of one synthesis.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroGlImages {
    /// sizeof(YoroGlImages).
    pub struct_size: u32,
    /// The rendered eye: name of a GL_TEXTURE_2D of the source's size and any filterable format, without samples. All four
    /// channels are carried over, in whatever encoding. Filters and sampler objects do not matter. Other than with
    /// YORO_EDGES_HARD it is resolved, and lies between 0 and 1.
    pub color_texture: u32,
    /// Its depth: name of a GL_TEXTURE_2D of the same size with a depth, depth-stencil (sampled as depth) or red float format;
    /// with YORO_EDGES_MULTISAMPLE of a GL_TEXTURE_2D_MULTISAMPLE of 2 or 4 samples.
    pub depth_texture: u32,
    /// The framebuffer to draw into, 0 for the window's. It has neither of the textures; its first colour attachment is
    /// written, and with YORO_OUTPUT_DEPTH its depth attachment.
    pub framebuffer: u32,
    /// Column of the framebuffer where the synthesized image begins.
    pub x: u32,
    /// Row of the framebuffer where it begins, from the lowest.
    pub y: u32,
    /// With YORO_EDGES_MULTISAMPLE, name of the GL_TEXTURE_2D_MULTISAMPLE that color_texture was resolved from, where it is
    /// still there; otherwise 0.
    pub sample_color_texture: u32,
}

versioned!(YoroGlImages);

/// Allocates what images of these sizes take, so that the first yoro_gl_synthesize does not. Costs nothing when the sizes
/// are as before.
///
/// Thread, GL state and results as yoro_gl_synthesize.
///
/// @param context The context.
/// @param warp    Of a frame of these sizes.
/// @pre The GL context is current.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_prepare(context: *mut YoroContext, warp: *const YoroWarp) -> YoroResult {
    // SAFETY: the header asks the caller for it.
    unsafe {
        enter_gl(context, |gl| {
            let warp = gl.fitting(warp)?;
            Ok(gl.synthesis.prepare(&warp)?)
        })
    }
}

/// Synthesizes the other eye into a rectangle of warp's target size, all of which is overwritten. Call it after the opaque
/// objects of the rendered eye, before transparent objects and effects that are drawn for each eye.
///
/// On the thread on which the GL context is current. GL state as YoroGlInfo says. While sizes stay the same nothing is
/// allocated or compiled, and nothing waits for the GPU. Transform feedback and conditional rendering are not active.
///
/// @param context The context.
/// @param warp    From YoroViews.
/// @param images  What to read and where to draw.
/// @pre The GL context is current; the textures and the framebuffer are its own and fit what YoroGlImages says.
/// @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE, YORO_ERROR_DRIVER; with `check` YORO_ERROR_FORMAT, too;
///         YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_synthesize(
    context: *mut YoroContext,
    warp: *const YoroWarp,
    images: *const YoroGlImages,
) -> YoroResult {
    // SAFETY: the header asks the caller for it.
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

/// A pipeline in a GL context.
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
                "reserved is {}: give 0; it once chose a pipeline, and only that of the number 0 is left",
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
        // SAFETY: promised by the caller.
        let context = unsafe {
            check_current(load)?;
            Context::with_loader(glow::Context::from_loader_function_cstr(load), load)?
        };
        let options = SynthesisOptions { edges, gl_state };
        let synthesis = synthesis::create(&context, &options, outputs)?;
        Ok(Gl { context, synthesis, edges, outputs, check: info.check == 1 })
    }

    /// The warp, of sizes that the driver can render.
    ///
    /// # Safety
    /// `warp` is null or leads to one.
    unsafe fn fitting(&self, warp: *const YoroWarp) -> Result<Warp, Failure> {
        if warp.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "warp is NULL: give that of YoroViews"));
        }
        // SAFETY: promised by the caller.
        let warp = unsafe { warp.read_unaligned() }.checked()?;
        let limit = self.context.capabilities().max_texture_size;
        let largest = warp.source_size.into_iter().chain(warp.target_size).max().unwrap_or(0);
        if largest > limit {
            return Err(Failure::new(
                YORO_ERROR_TOO_LARGE,
                format!(
                    "an image of {largest} pixels on a side is beyond this driver's {limit}: choose a smaller size"
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
                "sample_color_texture is for YORO_EDGES_MULTISAMPLE alone: leave it 0, or choose these",
            ));
        }
        let source = Source { samples, ..Source::new(color, depth) };
        let limit = self.context.capabilities().max_texture_size;
        if images.x > limit || images.y > limit {
            return Err(Failure::value(format!(
                "x and y are {}, {}: beyond all framebuffers",
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

/// Looks whether a context is current at all, before glow takes it for granted.
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
                "the loader does not give {name}: give that of the GL context, such as eglGetProcAddress"
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
