//! GL contexts without a window, for the desktop program.

use std::ffi::CStr;
use std::rc::Rc;

use super::{egl, osmesa};
use crate::gl::{Context, GlError};

/// Where to take the GL context from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Backend {
    /// EGL, then OSMesa.
    #[default]
    Auto,
    /// OpenGL ES by EGL, without a window.
    Egl,
    /// Mesa's off-screen library, desktop GL on the CPU.
    Osmesa,
}

/// Why there is no GL context.
#[derive(Debug, thiserror::Error)]
pub enum PlatformError {
    /// libEGL is missing or none of its platforms gives a context.
    #[error(
        "no OpenGL ES context by EGL: {0}; install libEGL and a driver (Debian: apt install libegl1 libgl1-mesa-dri), or try --gl osmesa"
    )]
    Egl(String),
    /// libOSMesa is missing or too old.
    #[error("no OpenGL context by OSMesa: {0}; install it (Debian: apt install libosmesa6), or try --gl egl")]
    Osmesa(String),
    /// Neither backend works.
    #[error(
        "no OpenGL here: EGL: {egl}; OSMesa: {osmesa}; install Mesa (Debian: apt install libegl1 libgl1-mesa-dri libosmesa6), or run `cargo xtask setup`"
    )]
    None {
        /// What EGL said.
        egl: String,
        /// What OSMesa said.
        osmesa: String,
    },
    /// The context cannot run the shaders.
    #[error(transparent)]
    Gl(#[from] GlError),
}

/// Keeps a context current on this thread until it is dropped.
#[allow(dead_code, reason = "OSMesa is held for its Drop")]
enum Holder {
    Egl(Box<egl::EglContext>),
    Osmesa(osmesa::OsmesaContext),
}

/// A GL context without a window, current on the calling thread.
///
/// Several may exist on one thread. With Mesa's llvmpipe (seen with 22.3) contexts of two threads must not draw at the
/// same time: a defect of the driver, which crashes now and then.
pub struct Headless {
    context: Option<Rc<Context>>,
    backend: Backend,
    holder: Holder,
}

impl Headless {
    /// Opens a context by the given backend.
    ///
    /// # Errors
    /// [`PlatformError`]: one sentence that says what is missing and what to install.
    pub fn open(backend: Backend) -> Result<Headless, PlatformError> {
        match backend {
            Backend::Egl => {
                let (holder, raw) = egl::EglContext::open().map_err(PlatformError::Egl)?;
                Headless::new(Backend::Egl, Holder::Egl(Box::new(holder)), raw)
            }
            Backend::Osmesa => {
                let (holder, raw) = osmesa::OsmesaContext::open().map_err(PlatformError::Osmesa)?;
                Headless::new(Backend::Osmesa, Holder::Osmesa(holder), raw)
            }
            Backend::Auto => Headless::open(Backend::Egl).or_else(|egl| {
                Headless::open(Backend::Osmesa).map_err(|osmesa| match (egl, osmesa) {
                    (PlatformError::Egl(egl), PlatformError::Osmesa(osmesa)) => {
                        PlatformError::None { egl, osmesa }
                    }
                    (egl, PlatformError::Osmesa(_)) => egl,
                    (_, osmesa) => osmesa,
                })
            }),
        }
    }

    fn new(backend: Backend, holder: Holder, raw: glow::Context) -> Result<Headless, PlatformError> {
        let load = |name: &CStr| match &holder {
            Holder::Egl(egl) => egl.entry_point(name),
            Holder::Osmesa(osmesa) => osmesa.entry_point(name),
        };
        // SAFETY: both loaders give the entry points of the context that they have made current.
        let context = unsafe { Context::with_loader(raw, load) }?;
        Ok(Headless { context: Some(context), backend, holder })
    }

    /// The GL context.
    pub fn gl(&self) -> &Rc<Context> {
        self.context.as_ref().expect("present until dropped")
    }

    /// The EGL context, if it is one.
    pub(super) fn egl(&self) -> Option<&egl::EglContext> {
        match &self.holder {
            Holder::Egl(context) => Some(context),
            Holder::Osmesa(_) => None,
        }
    }

    /// The backend that was opened, never [`Backend::Auto`].
    pub fn backend(&self) -> Backend {
        self.backend
    }
}

impl Drop for Headless {
    fn drop(&mut self) {
        // GL objects go before the context that holds them.
        self.context = None;
    }
}
