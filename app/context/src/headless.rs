//! GL contexts without a window, for the desktop program.

use std::ffi::{CStr, c_void};
use std::rc::Rc;

use yoro_gl::{Context, GlError};

use crate::{Binding, Graphics, egl, osmesa};

/// The source of the GL context.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// EGL, then OSMesa.
    #[default]
    Auto,
    /// OpenGL ES by EGL, without a window.
    Egl,
    /// Mesa's off-screen library, desktop GL on the CPU.
    Osmesa,
}

impl Backend {
    /// All of them.
    pub const ALL: [Backend; 3] = [Backend::Auto, Backend::Egl, Backend::Osmesa];

    /// Returns its name in settings.
    pub fn name(self) -> &'static str {
        match self {
            Backend::Auto => "auto",
            Backend::Egl => "egl",
            Backend::Osmesa => "osmesa",
        }
    }
}

/// Errors of opening a GL context.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ContextError {
    /// libEGL is missing or none of its platforms gives a context.
    #[error(
        "no OpenGL ES context by EGL: {0}; install libEGL and a driver (Debian: apt install libegl1 libgl1-mesa-dri), or take one by OSMesa"
    )]
    Egl(String),
    /// libOSMesa is missing or too old.
    #[error(
        "no OpenGL context by OSMesa: {0}; install it (Debian: apt install libosmesa6), or take one by EGL"
    )]
    Osmesa(String),
    /// Neither backend works.
    #[error(
        "no OpenGL here: EGL: {egl}; OSMesa: {osmesa}; install Mesa (Debian: apt install libegl1 libgl1-mesa-dri libosmesa6), or run `cargo xtask setup`"
    )]
    None {
        /// EGL's reason.
        egl: String,
        /// OSMesa's reason.
        osmesa: String,
    },
    /// The context is OSMesa's, but EGL's is needed.
    #[error("the GL context comes from OSMesa, but must come from EGL here: choose EGL")]
    NotEgl,
    /// The context cannot run the shaders.
    #[error(transparent)]
    Gl(#[from] GlError),
}

/// Keeps a context current on this thread until it is dropped.
enum Holder {
    Egl(Box<egl::EglContext>),
    Osmesa(osmesa::OsmesaContext),
}

/// A GL context without a window, current on the calling thread. It lives as long as this value or any object in it:
/// both own it.
///
/// Several may exist on one thread. With Mesa's llvmpipe (seen with 22.3) contexts of two threads must not draw at the
/// same time: a defect of the driver, which crashes now and then.
pub struct Headless {
    context: Rc<Context>,
    backend: Backend,
    holder: Rc<Holder>,
}

impl Headless {
    /// Opens a context by the given backend.
    ///
    /// # Errors
    /// [`ContextError`]: one sentence with the missing library and the remedy.
    pub fn open(backend: Backend) -> Result<Headless, ContextError> {
        match backend {
            Backend::Egl => {
                let (holder, raw) = egl::EglContext::open().map_err(ContextError::Egl)?;
                Headless::new(Backend::Egl, Holder::Egl(Box::new(holder)), raw)
            }
            Backend::Osmesa => {
                let (holder, raw) = osmesa::OsmesaContext::open(false).map_err(ContextError::Osmesa)?;
                Headless::new(Backend::Osmesa, Holder::Osmesa(holder), raw)
            }
            Backend::Auto => Headless::open(Backend::Egl).or_else(|egl| {
                Headless::open(Backend::Osmesa).map_err(|osmesa| match (egl, osmesa) {
                    (ContextError::Egl(egl), ContextError::Osmesa(osmesa)) => {
                        ContextError::None { egl, osmesa }
                    }
                    (egl, ContextError::Osmesa(_)) => egl,
                    (_, osmesa) => osmesa,
                })
            }),
        }
    }

    /// Opens a context of the compatibility profile by OSMesa, as GLFW and SDL do by default: for tests.
    ///
    /// # Errors
    /// Those of [`Headless::open`].
    #[doc(hidden)]
    pub fn compatibility() -> Result<Headless, ContextError> {
        let (holder, raw) = osmesa::OsmesaContext::open(true).map_err(ContextError::Osmesa)?;
        Headless::new(Backend::Osmesa, Holder::Osmesa(holder), raw)
    }

    fn new(backend: Backend, holder: Holder, raw: glow::Context) -> Result<Headless, ContextError> {
        let holder = Rc::new(holder);
        let load = |name: &CStr| match &*holder {
            Holder::Egl(egl) => egl.entry_point(name),
            Holder::Osmesa(osmesa) => osmesa.entry_point(name),
        };
        // SAFETY: both loaders give the entry points of the context that they have made current.
        let context = unsafe { Context::owned(raw, load, holder.clone()) }?;
        Ok(Headless { context, backend, holder })
    }

    /// The GL context.
    pub fn gl(&self) -> &Rc<Context> {
        &self.context
    }

    /// The EGL context, if it is one.
    fn egl(&self) -> Option<&egl::EglContext> {
        match &*self.holder {
            Holder::Egl(context) => Some(context),
            Holder::Osmesa(_) => None,
        }
    }

    /// Returns a GL function by its name, or null: for tests of functions that glow does not wrap.
    #[doc(hidden)]
    pub fn entry_point(&self, name: &CStr) -> *const c_void {
        match &*self.holder {
            Holder::Egl(egl) => egl.entry_point(name),
            Holder::Osmesa(osmesa) => osmesa.entry_point(name),
        }
    }

    /// The backend that was opened, never [`Backend::Auto`].
    pub fn backend(&self) -> Backend {
        self.backend
    }
}

/// A context without a window, for runtimes with XR_MNDX_egl_enable.
pub struct HeadlessGraphics<'a> {
    headless: &'a Headless,
    binding: Binding,
    /// The library that has eglGetProcAddress.
    _library: libloading::Library,
}

impl<'a> HeadlessGraphics<'a> {
    /// Needs a context by EGL, of OpenGL ES.
    ///
    /// # Errors
    /// [`ContextError::NotEgl`], and [`ContextError::Egl`] when the library gives no entry points.
    pub fn new(headless: &'a Headless) -> Result<HeadlessGraphics<'a>, ContextError> {
        let egl = headless.egl().ok_or(ContextError::NotEgl)?;
        // SAFETY: the library that the context comes from, and that is loaded already.
        let library = unsafe { libloading::Library::new("libEGL.so.1") }
            .map_err(|e| ContextError::Egl(e.to_string()))?;
        // SAFETY: the type is that of EGL's header.
        let get_proc_address = unsafe {
            library
                .get::<unsafe extern "C" fn(*const std::ffi::c_char) -> *const c_void>(b"eglGetProcAddress\0")
                .map(|function| *function as *const c_void)
                .map_err(|e| ContextError::Egl(e.to_string()))?
        };
        let [display, config, context] = egl.handles();
        let binding = Binding { display, config, context, get_proc_address };
        Ok(HeadlessGraphics { headless, binding, _library: library })
    }
}

// SAFETY: the context lives as long as `headless`, which is borrowed, and is current on its thread.
unsafe impl Graphics for HeadlessGraphics<'_> {
    fn binding(&self) -> Binding {
        self.binding
    }

    fn make_current(&self) -> Result<(), String> {
        self.headless.egl().map_or(Ok(()), |egl| egl.make_current())
    }
}
