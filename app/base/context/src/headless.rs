//! GL contexts without a window, for the desktop program.

use std::ffi::{CStr, c_void};
use std::rc::Rc;

use yoro_gl::{Capabilities, Context, GlError};

use crate::{Binding, Graphics, egl, osmesa};

/// The source of the GL context.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// EGL, or OSMesa if EGL fails.
    #[default]
    Auto,
    /// OpenGL ES without a window, by EGL.
    Egl,
    /// Desktop GL on the CPU, by Mesa's off-screen library.
    Osmesa,
}

impl Backend {
    /// All backends.
    pub const ALL: [Backend; 3] = [Backend::Auto, Backend::Egl, Backend::Osmesa];

    /// Returns the backend's name in settings.
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
pub enum ContextError {
    /// libEGL is missing, or none of its platforms provides a context.
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
        "no OpenGL here: EGL: {egl}; OSMesa: {osmesa}; install libEGL and a driver (Debian: apt install libegl1 libgl1-mesa-dri)"
    )]
    None {
        /// EGL's reason.
        egl: String,
        /// OSMesa's reason.
        osmesa: String,
    },
    /// The context is from OSMesa, but one from EGL is needed.
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

impl Holder {
    fn entry_point(&self, name: &CStr) -> *const c_void {
        match self {
            Holder::Egl(egl) => egl.entry_point(name),
            Holder::Osmesa(osmesa) => osmesa.entry_point(name),
        }
    }
}

/// A GL context without a window, current on the calling thread. It lives as long as this value or any object in it.
///
/// Several contexts may exist on one thread. With Mesa's llvmpipe (seen with 22.3), contexts of two threads must not
/// draw at the same time: a driver bug then crashes the process now and then.
pub struct Headless {
    context: Rc<Context>,
    backend: Backend,
    holder: Rc<Holder>,
}

impl Headless {
    /// Opens a context with the given backend.
    ///
    /// # Errors
    /// [`ContextError`], as one sentence that names the missing library and the remedy.
    pub fn open(backend: Backend) -> Result<Headless, ContextError> {
        Headless::open_limited(backend, |_| {})
    }

    /// Like [`Headless::open`]; `limit` takes capabilities away, to see what a driver with fewer features does. For tests and
    /// estimates.
    ///
    /// # Errors
    /// Those of [`Headless::open`].
    pub fn open_limited(backend: Backend, limit: fn(&mut Capabilities)) -> Result<Headless, ContextError> {
        match backend {
            Backend::Egl => {
                let (holder, raw) = egl::EglContext::open().map_err(ContextError::Egl)?;
                Headless::new(Backend::Egl, Holder::Egl(Box::new(holder)), raw, limit)
            }
            Backend::Osmesa => {
                let (holder, raw) = osmesa::OsmesaContext::open(false).map_err(ContextError::Osmesa)?;
                Headless::new(Backend::Osmesa, Holder::Osmesa(holder), raw, limit)
            }
            Backend::Auto => Headless::open_limited(Backend::Egl, limit).or_else(|egl| {
                Headless::open_limited(Backend::Osmesa, limit).map_err(|osmesa| match (egl, osmesa) {
                    (ContextError::Egl(egl), ContextError::Osmesa(osmesa)) => {
                        ContextError::None { egl, osmesa }
                    }
                    (egl, ContextError::Osmesa(_)) => egl,
                    (_, osmesa) => osmesa,
                })
            }),
        }
    }

    /// Opens a context of OSMesa's compatibility profile, which is the default of GLFW and SDL; for tests.
    ///
    /// # Errors
    /// Those of [`Headless::open`].
    #[doc(hidden)]
    pub fn compatibility() -> Result<Headless, ContextError> {
        let (holder, raw) = osmesa::OsmesaContext::open(true).map_err(ContextError::Osmesa)?;
        Headless::new(Backend::Osmesa, Holder::Osmesa(holder), raw, |_| {})
    }

    fn new(
        backend: Backend,
        holder: Holder,
        raw: glow::Context,
        limit: fn(&mut Capabilities),
    ) -> Result<Headless, ContextError> {
        let holder = Rc::new(holder);
        let load = |name: &CStr| holder.entry_point(name);
        // SAFETY: both loaders return the entry points of the context that they have made current.
        let context = unsafe { Context::owned(raw, load, holder.clone(), limit) }?;
        Ok(Headless { context, backend, holder })
    }

    /// Returns the GL context.
    pub fn gl(&self) -> &Rc<Context> {
        &self.context
    }

    /// Returns the EGL context, if the backend is EGL.
    fn egl(&self) -> Option<&egl::EglContext> {
        match &*self.holder {
            Holder::Egl(context) => Some(context),
            Holder::Osmesa(_) => None,
        }
    }

    /// Returns a GL function by its name, or null; for tests of functions that glow does not wrap.
    #[doc(hidden)]
    pub fn entry_point(&self, name: &CStr) -> *const c_void {
        self.holder.entry_point(name)
    }

    /// Returns the backend that was opened, never [`Backend::Auto`].
    pub fn backend(&self) -> Backend {
        self.backend
    }
}

/// A context without a window, for OpenXR runtimes with XR_MNDX_egl_enable.
pub struct HeadlessGraphics<'a> {
    headless: &'a Headless,
    binding: Binding,
    /// The library that contains eglGetProcAddress.
    _library: libloading::Library,
}

impl<'a> HeadlessGraphics<'a> {
    /// Borrows a context, which must come from EGL.
    ///
    /// # Errors
    /// [`ContextError::NotEgl`], or [`ContextError::Egl`] if the library has no eglGetProcAddress.
    pub fn new(headless: &'a Headless) -> Result<HeadlessGraphics<'a>, ContextError> {
        let egl = headless.egl().ok_or(ContextError::NotEgl)?;
        // SAFETY: the context comes from this library, which is loaded already.
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
