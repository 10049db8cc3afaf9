//! The functions for OpenGL and OpenGL ES.

mod check;
mod compose;
mod entry_points;

use std::any::Any;
use std::ffi::{CStr, c_char, c_void};
use std::num::NonZeroU32;
use std::rc::Rc;

use yoro::opengl::{
    self, AnyView, Composer, Context, Destination, Gather, GlApi, GlState, Motion, Options, Outputs, Part,
    PassTime, Pipeline, Profiling, Source,
};
use yoro::synthesis::backend::WarpKind;

use crate::context::{
    Backend, YORO_API_OPENGL, YORO_API_OPENGL_ES, YoroCapabilities, YoroContext, YoroTimes, create, enter_as,
    write_bytes,
};
use crate::motion::YoroMotionWarp;
use crate::pose::YoroPoseWarp;
use crate::result::{
    Failure, YORO_ERROR_DRIVER, YORO_ERROR_NO_CONTEXT, YORO_ERROR_NULL, YORO_ERROR_TOO_LARGE, YoroMessages,
    YoroResult,
};
use crate::types::{
    Kind, YORO_OUTPUT_DEPTH, YORO_OUTPUT_OPEN_DEPTH, YORO_OUTPUT_OPEN_STENCIL, YORO_OUTPUT_SRGB,
    YoroOutputFlags, YoroWarpKind, holes, other_kind, warp_kind,
};
use crate::versioned::{self, Given, given, versioned};
use crate::views::YoroWarp;

pub use compose::*;
#[doc(hidden)]
pub use entry_points::needed_functions;

/// An entry point of any type.
pub type YoroGlProc = Option<unsafe extern "C" fn()>;
/// Returns an entry point by its name, or NULL if it does not exist: eglGetProcAddress, glfwGetProcAddress and others.
/// Cast loaders of other types: (YoroGlLoader)SDL_GL_GetProcAddress.
pub type YoroGlLoader = Option<unsafe extern "C" fn(name: *const c_char) -> YoroGlProc>;

/// What happens to GL state that a call changes.
pub type YoroGlState = u32;
/// Some of it stays changed: program, vertex array, framebuffers, the first viewport, the textures of units 0 to 3 (two
/// of them array textures for sources that are layers), their samplers, and the active unit. Depth mask and depth
/// function are on and ALWAYS, the depth range is 0 to 1, the colour mask is open. Scissor, stencil and depth test, face
/// culling, blending, dithering, polygon offset, rasterizer discard, primitive restart, coverage, clip distances and
/// logic operation are off. For engines that set all the state they draw with.
pub const YORO_GL_STATE_LEAVE: YoroGlState = 0;
/// All of it is restored, except that a program that was deleted while it was current goes at the first call, as GL
/// requires. None is current then.
pub const YORO_GL_STATE_PRESERVE: YoroGlState = 1;

/// Bits that describe where sources lie in their textures.
pub type YoroGlSourceFlags = u32;
/// The rendered image is a part of larger textures, and its size may change in each frame: for dynamic resolution.
/// Buffers then only grow, so that nothing is allocated after yoro_gl_prepare with the largest sizes. These textures
/// cannot be the framebuffer's, not even other parts of them: if both eyes are shown from one texture, render into
/// others, synthesize into that one at x and y of YoroGlImages, and blit the rendered eye's part beside it.
pub const YORO_GL_SOURCE_PARTS: YoroGlSourceFlags = 1;
/// The rendered image is a layer of a GL_TEXTURE_2D_ARRAY, in colour and in depth: for the textures of GL_OVR_multiview
/// and the OpenXR swapchains used with it.
pub const YORO_GL_SOURCE_LAYERS: YoroGlSourceFlags = 2;

/// The options of a context for OpenGL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroGlInfo {
    /// sizeof(YoroGlInfo).
    pub struct_size: u32,
    /// YORO_OUTPUT_ bits.
    pub outputs: YoroOutputFlags,
    /// What happens to GL state.
    pub state: YoroGlState,
    /// 1: each call checks the textures, the framebuffer and GL's error flag, which it clears. This waits for the
    /// driver, so use it in development only. 0: mistakes are undefined behaviour, as in GL.
    pub check: u32,
    /// YORO_GL_SOURCE_ bits.
    pub sources: YoroGlSourceFlags,
    /// 1: measures the passes for yoro_times with GL_TIME_ELAPSED queries. The engine must have no such query active
    /// during a call. 0: measures nothing.
    pub timed: u32,
    /// The kind of warp. 0 is YORO_WARP_KIND_EYES.
    pub warp_kind: YoroWarpKind,
    /// 1: compiles the composer, too, for yoro_gl_compose. 0: it is not used.
    pub composes: u32,
    /// The loader of entry points.
    pub loader: YoroGlLoader,
    /// Receives error messages, including those of later calls.
    pub messages: YoroMessages,
}

versioned!(YoroGlInfo);

/// Creates a context for OpenGL ES 3.0 or later, or desktop OpenGL 4.5 or later (4.3 with GL_ARB_ES3_1_compatibility),
/// and compiles its shaders. Call it at startup, not in a frame.
///
/// Call it on the thread on which the GL context is current. YoroGlInfo says how GL state is treated; the error flag is
/// left as it is.
///
/// @param info    The options.
/// @param context Receives the new context, or NULL after an error. Destroy it with yoro_destroy.
/// @pre The GL context is current, and lives as long as the YoroContext.
/// @return YORO_ERROR_NO_CONTEXT, YORO_ERROR_UNSUPPORTED, YORO_ERROR_MEMORY, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
///         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_create(
    info: *const YoroGlInfo,
    context: *mut *mut YoroContext,
) -> YoroResult {
    // SAFETY: the header requires valid pointers, a current GL context, and its loader.
    unsafe { create(info, context, |info| info.messages, |info| Gl::new(info)) }
}

/// Returns how many bytes of GPU memory the buffers of a context will take, computed from the sizes of a frame. Drivers add
/// padding. For an existing context, call yoro_capabilities. Fails for YORO_WARP_KIND_POSE, whose buffers take 16 bytes for
/// each 16 x 8 pixels of the source and of the target. For YORO_WARP_KIND_MOTION, give the `warp` of YoroMotionWarp: both
/// kinds have the same buffers.
///
/// Call it from any thread. It needs neither a loader nor a GL context.
///
/// @param info  The options.
/// @param warp  The warp of a frame of the largest size.
/// @param bytes Receives the number of bytes.
/// @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_buffer_bytes(
    info: *const YoroGlInfo,
    warp: *const YoroWarp,
    bytes: *mut u64,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        write_bytes(
            info,
            bytes,
            |info| info.messages,
            |info| match warp_kind(info.warp_kind)? {
                Kind::AnyView => Err(Failure::value(
                    "the buffers for YORO_WARP_KIND_POSE have 16 bytes for each 16 x 8 pixels of the source, and of the target",
                )),
                Kind::Gather | Kind::Motion => Ok(opengl::buffer_bytes(&given(warp)?)),
            },
        )
    }
}

/// The textures and the framebuffer of one synthesis.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroGlImages {
    /// sizeof(YoroGlImages).
    pub struct_size: u32,
    /// Colour of the rendered eye: name of a GL_TEXTURE_2D of the source's size in any filterable format (another
    /// target or size with YORO_GL_SOURCE_ bits). All four channels are carried over, in any encoding. Texture filters
    /// and samplers have no effect. Of a multisampled image, give the resolved one.
    pub color_texture: u32,
    /// Depth of the rendered eye: name of a GL_TEXTURE_2D of the same size with a depth, depth-stencil (sampled as
    /// depth) or red float format. Of a multisampled image, give the depth of each pixel's nearest sample. Averaged
    /// depth belongs to no surface, and causes halos.
    pub depth_texture: u32,
    /// The framebuffer to draw into, or 0 for the window's. Its first colour attachment is written, and with
    /// YORO_OUTPUT_DEPTH or an OPEN flag its depth attachment, with stencil for YORO_OUTPUT_OPEN_STENCIL. None of the textures above may be attached to it.
    pub framebuffer: u32,
    /// First column of the synthesized image in the framebuffer.
    pub x: u32,
    /// First row of the synthesized image in the framebuffer, counted from the bottom.
    pub y: u32,
    /// First column of the rendered part in its textures. This field and the next three are for YORO_GL_SOURCE_PARTS,
    /// and otherwise 0.
    pub source_x: u32,
    /// First row of the rendered part, counted from the bottom.
    pub source_y: u32,
    /// Width of the textures in pixels.
    pub image_width: u32,
    /// Height of the textures in pixels.
    pub image_height: u32,
    /// The layer of both textures for YORO_GL_SOURCE_LAYERS, otherwise 0. To draw into a layer, attach it to the
    /// framebuffer with glFramebufferTextureLayer.
    pub layer: u32,
}

versioned!(YoroGlImages);

/// Allocates the buffers for images of these sizes, so that the first yoro_gl_synthesize need not. Does nothing if the
/// sizes have not changed.
///
/// Thread, GL state and results are as for yoro_gl_synthesize.
///
/// @param context The context.
/// @param warp    The warp of a frame of these sizes.
/// @pre The GL context is current.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_prepare(context: *mut YoroContext, warp: *const YoroWarp) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { prepare(context, warp) }
}

/// Does what yoro_gl_prepare does, in a context of YORO_WARP_KIND_POSE.
///
/// @param context The context.
/// @param warp    The warp of a frame of these sizes.
/// @pre The GL context is current.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_prepare_pose(
    context: *mut YoroContext,
    warp: *const YoroPoseWarp,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { prepare(context, warp) }
}

/// Does what yoro_gl_prepare does, in a context of YORO_WARP_KIND_MOTION.
///
/// @param context The context.
/// @param warp    The warp of a frame of these sizes.
/// @pre The GL context is current.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_prepare_motion(
    context: *mut YoroContext,
    warp: *const YoroMotionWarp,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { prepare(context, warp) }
}

/// Synthesizes the other eye into a rectangle of the warp's target size, and overwrites all of it except for open holes.
/// Call it after the rendered eye's opaque objects, and before transparent objects and effects that are drawn for each
/// eye.
///
/// Call it on the thread on which the GL context is current. YoroGlInfo says how GL state is treated. While sizes stay
/// the same it allocates and compiles nothing, and does not wait for the GPU.
///
/// @param context The context.
/// @param warp    The warp of YoroViews.
/// @param images  The images to read and where to draw.
/// @pre The GL context is current. The textures and the framebuffer belong to it and are as YoroGlImages says.
///      Transform feedback and conditional rendering are not active.
/// @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DRIVER; with `check` also
///         YORO_ERROR_FORMAT and YORO_ERROR_NO_CONTEXT; YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL,
///         YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_synthesize(
    context: *mut YoroContext,
    warp: *const YoroWarp,
    images: *const YoroGlImages,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { synthesize(context, warp, images) }
}

/// Synthesizes a view in any pose near the rendered one, in a context of YORO_WARP_KIND_POSE. Otherwise it is like
/// yoro_gl_synthesize.
///
/// @param context The context.
/// @param warp    The warp of yoro_pose_warp.
/// @param images  The images to read and where to draw.
/// @pre As for yoro_gl_synthesize.
/// @return As for yoro_gl_synthesize.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_synthesize_pose(
    context: *mut YoroContext,
    warp: *const YoroPoseWarp,
    images: *const YoroGlImages,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { synthesize(context, warp, images) }
}

/// Makes motion vectors of an eye, in a context of YORO_WARP_KIND_MOTION. Otherwise it is like yoro_gl_synthesize. The
/// colour that is read and the one that is written are vectors in RGBA16F; vectors of two components are not enough.
///
/// @param context The context.
/// @param warp    The warp of yoro_motion_warp.
/// @param images  The images to read and where to draw.
/// @pre As for yoro_gl_synthesize.
/// @return As for yoro_gl_synthesize.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_synthesize_motion(
    context: *mut YoroContext,
    warp: *const YoroMotionWarp,
    images: *const YoroGlImages,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe { synthesize(context, warp, images) }
}

/// # Safety
/// Both pointers are null or point to live objects.
unsafe fn prepare<T: Given>(context: *mut YoroContext, warp: *const T) -> YoroResult
where
    T::Core: WarpKind,
{
    // SAFETY: same contract.
    unsafe {
        enter_gl(context, |gl| {
            let warp = gl.fitting(warp)?;
            Ok(gl.passes.of()?.prepare(&warp)?)
        })
    }
}

/// # Safety
/// All pointers are null or point to live objects.
unsafe fn synthesize<T: Given>(
    context: *mut YoroContext,
    warp: *const T,
    images: *const YoroGlImages,
) -> YoroResult
where
    T::Core: WarpKind,
{
    // SAFETY: same contract.
    unsafe {
        enter_gl(context, |gl| {
            gl.passes.of::<T::Core>()?;
            let warp = gl.fitting(warp)?;
            gl.synthesize(&warp, &versioned::read(images, "images")?)
        })
    }
}

/// # Safety
/// `context` is null or points to a live context.
unsafe fn enter_gl(
    context: *mut YoroContext,
    body: impl FnOnce(&mut Gl) -> Result<(), Failure>,
) -> YoroResult {
    // SAFETY: same contract.
    unsafe { enter_as(context, "yoro_gl_create", body) }
}

/// The synthesis in a GL context.
pub(crate) struct Gl {
    context: Rc<Context>,
    passes: Passes,
    composer: Option<Composer>,
    options: Options,
    outputs: Outputs,
    check: bool,
    timed: bool,
    /// The pass times of the newest frame whose times are known.
    times: Vec<PassTime>,
    /// The entry point of glGetString.
    get_string: *const c_void,
}

/// The passes for one kind of warp.
struct Passes {
    kind: Kind,
    pipeline: Box<dyn Any>,
}

impl Passes {
    /// Returns the pipeline, if it is for this kind of warp.
    fn of<W: WarpKind + 'static>(&mut self) -> Result<&mut Pipeline<W>, Failure> {
        self.pipeline.downcast_mut().ok_or_else(|| other_kind(self.kind))
    }
}

impl Gl {
    /// # Safety
    /// A GL context is current, and the loader returns its entry points.
    unsafe fn new(info: &YoroGlInfo) -> Result<Gl, Failure> {
        let gl_state = match info.state {
            YORO_GL_STATE_LEAVE => GlState::Leave,
            YORO_GL_STATE_PRESERVE => GlState::Preserve,
            other => {
                return Err(Failure::value(format!(
                    "{other} is no GL state: give a YORO_GL_STATE_ constant"
                )));
            }
        };
        let (outputs, kind) = (outputs(info.outputs)?, warp_kind(info.warp_kind)?);
        for (flag, what) in [(info.check, "check"), (info.timed, "timed"), (info.composes, "composes")] {
            if flag > 1 {
                return Err(Failure::value(format!("{what} is {flag}: give 0 or 1")));
            }
        }
        if info.sources & !(YORO_GL_SOURCE_PARTS | YORO_GL_SOURCE_LAYERS) != 0 {
            return Err(Failure::value(format!(
                "{} has bits that are no YORO_GL_SOURCE_ flags",
                info.sources
            )));
        }
        let Some(loader) = info.loader else {
            return Err(Failure::new(YORO_ERROR_NULL, "loader is NULL: give eglGetProcAddress or its like"));
        };
        // SAFETY: the loader takes a name; a nullable function pointer and a data pointer have the same size.
        let load =
            |name: &CStr| unsafe { std::mem::transmute::<YoroGlProc, *const c_void>(loader(name.as_ptr())) };
        // SAFETY: the caller guarantees that a context is current and that the loader returns its entry points.
        let context = unsafe { Context::with_loader(entry_points::wrap(load)?, load)? };
        let has = |bit| info.sources & bit != 0;
        let (parts, array_textures) = (has(YORO_GL_SOURCE_PARTS), has(YORO_GL_SOURCE_LAYERS));
        let options = Options { gl_state, parts, array_textures, ..Options::default() };
        let pipeline: Box<dyn Any> = match kind {
            Kind::AnyView => Box::new(AnyView::new(&context, &options, outputs)?),
            Kind::Gather => Box::new(Gather::new(&context, &options, outputs)?),
            Kind::Motion => Box::new(Motion::new(&context, &options, outputs)?),
        };
        let composes = info.composes == 1;
        let composer = composes.then(|| Composer::new(&context, gl_state, outputs.srgb)).transpose()?;
        let timed = info.timed == 1;
        if timed {
            context.set_profiling(Profiling::Queries);
        }
        let get_string = load(c"glGetString");
        let times = Vec::with_capacity(8);
        Ok(Gl {
            context,
            passes: Passes { kind, pipeline },
            composer,
            options,
            outputs,
            check: info.check == 1,
            timed,
            times,
            get_string,
        })
    }

    /// Reads a warp, and checks that the driver can render its sizes.
    ///
    /// # Safety
    /// `warp` is null or points to a warp.
    unsafe fn fitting<T: Given>(&self, warp: *const T) -> Result<T::Core, Failure>
    where
        T::Core: WarpKind,
    {
        // SAFETY: the context was created with this entry point.
        if self.check && !unsafe { entry_points::is_current(self.get_string) } {
            return Err(Failure::new(
                YORO_ERROR_NO_CONTEXT,
                "no GL context is current on this thread: call on the thread on which yoro_gl_create was called",
            ));
        }
        // SAFETY: same contract.
        let warp = unsafe { given(warp) }?;
        let limit = self.context.capabilities().max_texture_size;
        let largest = warp.sizes().into_iter().flatten().max().unwrap_or(0);
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

    /// Checks the images of a call, and draws.
    fn synthesize<W: WarpKind + 'static>(&mut self, warp: &W, images: &YoroGlImages) -> Result<(), Failure> {
        let [source_size, target_size] = warp.sizes();
        let color = texture(images.color_texture, "color_texture")?;
        let depth = texture(images.depth_texture, "depth_texture")?;
        let part = self.part(source_size, images)?;
        if images.layer != 0 && !self.options.array_textures {
            return Err(Failure::value(
                "layer is for YORO_GL_SOURCE_LAYERS only: set it to 0, or choose array textures",
            ));
        }
        let source = Source { part, layer: images.layer, ..Source::new(color, depth) };
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
            size: target_size,
        };
        if self.check {
            check::check_images(&self.context, &self.options, self.outputs, source, source_size, &target)?;
        }
        self.passes.of()?.synthesize(source, warp, &target)?;
        self.end_call("yoro_gl_synthesize")
    }

    /// Ends a call of this function: keeps the times of an earlier frame if they have become known, and checks for GL's
    /// errors if they are to be checked.
    fn end_call(&mut self, function: &str) -> Result<(), Failure> {
        let known = self.times.len();
        if self.timed && self.context.end_timed_frame(&mut self.times).is_some() {
            self.times.drain(..known);
        }
        match self.check.then(|| self.context.take_errors()).flatten() {
            Some(errors) => Err(Failure::new(
                YORO_ERROR_DRIVER,
                format!("GL says {errors}: see the preconditions of {function}"),
            )),
            None => Ok(()),
        }
    }

    /// Returns the part of the textures that was rendered, or `None` for all of them.
    fn part(&self, size: [u32; 2], images: &YoroGlImages) -> Result<Option<Part>, Failure> {
        let (origin, image_size) =
            ([images.source_x, images.source_y], [images.image_width, images.image_height]);
        if !self.options.parts {
            return match origin.into_iter().chain(image_size).all(|n| n == 0) {
                true => Ok(None),
                false => Err(Failure::value(
                    "source_x, source_y, image_width and image_height are for YORO_GL_SOURCE_PARTS only: set them to 0, or \
                     choose that",
                )),
            };
        }
        let end = |i: usize| u64::from(origin[i]) + u64::from(size[i]);
        if (0..2).any(|i| end(i) > u64::from(image_size[i])) {
            let ([x, y], [w, h], [iw, ih]) = (origin, size, image_size);
            return Err(Failure::new(
                YORO_ERROR_TOO_LARGE,
                format!(
                    "the rendered part of {w}x{h} pixels at ({x}, {y}) reaches beyond its textures of {iw}x{ih} pixels"
                ),
            ));
        }
        Ok(Some(Part { origin, image_size }))
    }
}

impl Backend for Gl {
    fn times(&mut self) -> Result<Option<YoroTimes>, Failure> {
        let of = |pass: &str| {
            let passes = self.times.iter().filter(|time| time.name.ends_with(pass));
            passes.map(|time| time.time.as_nanos() as u64).sum()
        };
        Ok((!self.times.is_empty()).then(|| YoroTimes {
            tiles_ns: of("tiles"),
            spans_ns: of("spans"),
            march_ns: of("march"),
            ..YoroTimes::UNKNOWN
        }))
    }

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
            software: own.software.into(),
            max_image_size: own.max_texture_size,
            buffer_bytes: self.context.texture_bytes() as u64,
            device: [0; 128],
        };
        capabilities.set_device(&own.renderer);
        capabilities
    }
}

fn texture(name: u32, what: &str) -> Result<glow::NativeTexture, Failure> {
    let name = NonZeroU32::new(name).map(glow::NativeTexture);
    name.ok_or_else(|| Failure::value(format!("{what} is 0: give the name of a texture")))
}

pub(crate) fn outputs(bits: YoroOutputFlags) -> Result<Outputs, Failure> {
    let open = YORO_OUTPUT_OPEN_STENCIL | YORO_OUTPUT_OPEN_DEPTH;
    if bits & !(YORO_OUTPUT_DEPTH | YORO_OUTPUT_SRGB | open) != 0 {
        return Err(Failure::value(format!("{bits} has bits that are no YORO_OUTPUT_ flags")));
    }
    let has = |bit| bits & bit != 0;
    let holes = holes(bits)?;
    Ok(Outputs { depth: has(YORO_OUTPUT_DEPTH), srgb: has(YORO_OUTPUT_SRGB), holes, ..Outputs::default() })
}
