//! The application's contexts, created with EGL or GLX.

#[cfg(not(target_os = "android"))]
use std::ffi::c_ulong;
use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::sync::OnceLock;

use libloading::Library;
use openxr_sys as sys;

use crate::reason::Reason;

/// A function that returns an entry point of GL, EGL or GLX by its name.
type Load = unsafe extern "system" fn(*const c_char) -> *const c_void;

const EGL_OPENGL_API: c_uint = 0x30A2;
const EGL_CONTEXT_CLIENT_TYPE: c_int = 0x3097;
const EGL_DRAW: c_int = 0x3059;
const EGL_READ: c_int = 0x305A;

/// The libraries that may have the function that finds all others, and its name, if the application does not pass it.
#[cfg(target_os = "android")]
const SYSTEM_LOADER: (&[&str], &[u8]) = (&["libEGL.so"], b"eglGetProcAddress\0");
#[cfg(not(target_os = "android"))]
const SYSTEM_LOADER: (&[&str], &[u8]) = (&["libGLX.so.0", "libGL.so.1"], b"glXGetProcAddressARB\0");

/// The context of a session. Its pointers are only passed to EGL or GLX.
#[derive(Clone, Copy)]
pub enum Binding {
    Egl(Egl),
    #[cfg(not(target_os = "android"))]
    Glx(Glx),
}

// SAFETY: handles and functions, which EGL and GLX allow any thread to use.
unsafe impl Send for Binding {}
// SAFETY: as above.
unsafe impl Sync for Binding {}

impl Binding {
    /// Returns the context that a structure in the chain of XrSessionCreateInfo names, or `None` for other structures
    /// and if EGL or GLX cannot be found.
    ///
    /// # Safety
    /// The structure has the type that it states, and was passed to a successful call of xrCreateSession.
    pub unsafe fn of(header: &sys::BaseInStructure) -> Option<Binding> {
        let structure = std::ptr::from_ref(header);
        // SAFETY: the type tells which structure it is, and the runtime has accepted it.
        unsafe {
            match header.ty {
                sys::GraphicsBindingEGLMNDX::TYPE => {
                    let info = &*structure.cast::<sys::GraphicsBindingEGLMNDX>();
                    // Both types are nullable functions that return a nullable function.
                    let load = std::mem::transmute::<Option<sys::pfn::EglGetProcAddressMNDX>, Option<Load>>(
                        info.get_proc_address,
                    );
                    Egl::new(load?, info.display, info.context).map(Binding::Egl)
                }
                #[cfg(target_os = "android")]
                sys::GraphicsBindingOpenGLESAndroidKHR::TYPE => {
                    let info = &*structure.cast::<sys::GraphicsBindingOpenGLESAndroidKHR>();
                    Egl::new(system_loader()?, info.display, info.context).map(Binding::Egl)
                }
                #[cfg(not(target_os = "android"))]
                sys::GraphicsBindingOpenGLXlibKHR::TYPE => {
                    let info = &*structure.cast::<sys::GraphicsBindingOpenGLXlibKHR>();
                    Glx::new(info).map(Binding::Glx)
                }
                _ => None,
            }
        }
    }

    /// Returns the type of structure that xrEnumerateSwapchainImages fills.
    pub fn image_type(&self) -> sys::StructureType {
        match self {
            Binding::Egl(egl) if egl.api != EGL_OPENGL_API => sys::SwapchainImageOpenGLESKHR::TYPE,
            _ => sys::SwapchainImageOpenGLKHR::TYPE,
        }
    }

    /// Returns an entry point of GL, or null if it does not exist.
    pub fn load(&self, name: &CStr) -> *const c_void {
        let load = match self {
            Binding::Egl(egl) => egl.load,
            #[cfg(not(target_os = "android"))]
            Binding::Glx(glx) => glx.load,
        };
        // SAFETY: a null-terminated name.
        unsafe { load(name.as_ptr()) }
    }

    /// Makes the context current on this thread until the result is dropped.
    ///
    /// # Errors
    /// [`Reason::NotCurrent`], for example if the context is current on another thread.
    ///
    /// # Safety
    /// The context exists.
    pub unsafe fn make_current(&self) -> Result<Current, Reason> {
        // SAFETY: the context exists.
        let current = unsafe {
            match self {
                Binding::Egl(egl) => egl.make_current(),
                #[cfg(not(target_os = "android"))]
                Binding::Glx(glx) => glx.make_current(),
            }
        };
        current.ok_or(Reason::NotCurrent)
    }
}

/// The context that was current before. Dropping this makes it current again, whatever is current by then.
pub enum Current {
    Egl(Egl, EglState),
    #[cfg(not(target_os = "android"))]
    Glx(Glx, GlxState),
}

impl Drop for Current {
    fn drop(&mut self) {
        // SAFETY: the state of this thread at `make_current`. A call that fails here would also fail for the
        // application.
        unsafe {
            match self {
                Current::Egl(egl, state) => egl.restore(state),
                #[cfg(not(target_os = "android"))]
                Current::Glx(glx, state) => glx.restore(state),
            }
        }
    }
}

/// Returns the system's loader function. Its library is never unloaded.
fn system_loader() -> Option<Load> {
    let (libraries, name) = SYSTEM_LOADER;
    static LIBRARY: OnceLock<Option<Library>> = OnceLock::new();
    // SAFETY: a system library, which the application has already loaded.
    let open = || libraries.iter().find_map(|library| unsafe { Library::new(library).ok() });
    let library = LIBRARY.get_or_init(open).as_ref()?;
    // SAFETY: a function of this name has this type.
    unsafe { library.get::<Load>(name).ok().map(|load| *load) }
}

macro_rules! functions {
    ($($(#[$attribute:meta])+ $table:ident { $($field:ident: fn($($parameter:ty),*) $(-> $result:ty)? = $name:literal,)* })*) => {
        $(
            $(#[$attribute])+
            #[derive(Clone, Copy)]
            struct $table {
                $($field: unsafe extern "system" fn($($parameter),*) $(-> $result)?,)*
            }

            $(#[$attribute])+
            impl $table {
                /// Loads all functions. Returns `None` if one is missing.
                ///
                /// # Safety
                /// `load` returns the functions that have these names.
                unsafe fn new(load: Load) -> Option<$table> {
                    // SAFETY: functions of these names have these types; null is `None`.
                    unsafe {
                        Some($table {
                            $($field: std::mem::transmute::<
                                *const c_void,
                                Option<unsafe extern "system" fn($($parameter),*) $(-> $result)?>,
                            >(load($name.as_ptr()))?,)*
                        })
                    }
                }
            }
        )*
    };
}

functions! {
    /// Functions of EGL 1.5, or of earlier ones with EGL_KHR_get_all_proc_addresses.
    EglFunctions {
        query_api: fn() -> c_uint = c"eglQueryAPI",
        bind_api: fn(c_uint) -> c_uint = c"eglBindAPI",
        query_context: fn(*mut c_void, *mut c_void, c_int, *mut c_int) -> c_uint = c"eglQueryContext",
        current_context: fn() -> *mut c_void = c"eglGetCurrentContext",
        current_display: fn() -> *mut c_void = c"eglGetCurrentDisplay",
        current_surface: fn(c_int) -> *mut c_void = c"eglGetCurrentSurface",
        make_current: fn(*mut c_void, *mut c_void, *mut c_void, *mut c_void) -> c_uint = c"eglMakeCurrent",
    }
    /// Functions of GLX 1.3.
    #[cfg(not(target_os = "android"))]
    GlxFunctions {
        current_context: fn() -> *mut c_void = c"glXGetCurrentContext",
        current_display: fn() -> *mut c_void = c"glXGetCurrentDisplay",
        current_draw: fn() -> c_ulong = c"glXGetCurrentDrawable",
        current_read: fn() -> c_ulong = c"glXGetCurrentReadDrawable",
        make_current: fn(*mut c_void, c_ulong, c_ulong, *mut c_void) -> c_int = c"glXMakeContextCurrent",
    }
}

/// A context of EGL.
#[derive(Clone, Copy)]
pub struct Egl {
    load: Load,
    display: *mut c_void,
    context: *mut c_void,
    /// EGL_OPENGL_API or EGL_OPENGL_ES_API. Each has its own current context.
    api: c_uint,
    functions: EglFunctions,
}

/// EGL's current state on a thread.
pub struct EglState {
    /// The current API. The fields below belong to [`Egl::api`].
    api: c_uint,
    display: *mut c_void,
    draw: *mut c_void,
    read: *mut c_void,
    context: *mut c_void,
}

impl Egl {
    unsafe fn new(load: Load, display: *mut c_void, context: *mut c_void) -> Option<Egl> {
        // SAFETY: EGL's loader, a display and a context.
        unsafe {
            let functions = EglFunctions::new(load)?;
            let mut api = 0;
            let known = (functions.query_context)(display, context, EGL_CONTEXT_CLIENT_TYPE, &mut api);
            (known != 0).then_some(Egl { load, display, context, api: api as c_uint, functions })
        }
    }

    unsafe fn make_current(&self) -> Option<Current> {
        let functions = &self.functions;
        // SAFETY: queries, and the application's own context.
        unsafe {
            let api = (functions.query_api)();
            if api != self.api {
                (functions.bind_api)(self.api);
            }
            let state = EglState {
                api,
                display: (functions.current_display)(),
                draw: (functions.current_surface)(EGL_DRAW),
                read: (functions.current_surface)(EGL_READ),
                context: (functions.current_context)(),
            };
            let none = std::ptr::null_mut();
            let made = state.context == self.context
                || (functions.make_current)(self.display, none, none, self.context) != 0;
            let current = Current::Egl(*self, state);
            made.then_some(current)
        }
    }

    unsafe fn restore(&self, state: &EglState) {
        let functions = &self.functions;
        let display = if state.display.is_null() { self.display } else { state.display };
        // SAFETY: this was the state of this thread.
        unsafe {
            if (functions.query_api)() != self.api {
                (functions.bind_api)(self.api);
            }
            if (functions.current_context)() != state.context {
                (functions.make_current)(display, state.draw, state.read, state.context);
            }
            if state.api != self.api {
                (functions.bind_api)(state.api);
            }
        }
    }
}

/// A context of GLX.
#[cfg(not(target_os = "android"))]
#[derive(Clone, Copy)]
pub struct Glx {
    load: Load,
    display: *mut c_void,
    drawable: c_ulong,
    context: *mut c_void,
    functions: GlxFunctions,
}

/// GLX's current state on a thread.
#[cfg(not(target_os = "android"))]
pub struct GlxState {
    display: *mut c_void,
    draw: c_ulong,
    read: c_ulong,
    context: *mut c_void,
}

#[cfg(not(target_os = "android"))]
impl Glx {
    unsafe fn new(info: &sys::GraphicsBindingOpenGLXlibKHR) -> Option<Glx> {
        let load = system_loader()?;
        Some(Glx {
            load,
            display: info.x_display,
            drawable: info.glx_drawable,
            context: info.glx_context,
            // SAFETY: GLX's loader.
            functions: unsafe { GlxFunctions::new(load)? },
        })
    }

    unsafe fn make_current(&self) -> Option<Current> {
        let functions = &self.functions;
        // SAFETY: queries, and the application's own context and window.
        unsafe {
            let state = GlxState {
                display: (functions.current_display)(),
                draw: (functions.current_draw)(),
                read: (functions.current_read)(),
                context: (functions.current_context)(),
            };
            let made = state.context == self.context
                || (functions.make_current)(self.display, self.drawable, self.drawable, self.context) != 0;
            let current = Current::Glx(*self, state);
            made.then_some(current)
        }
    }

    unsafe fn restore(&self, state: &GlxState) {
        let display = if state.display.is_null() { self.display } else { state.display };
        // SAFETY: this was the state of this thread.
        unsafe {
            if (self.functions.current_context)() != state.context {
                (self.functions.make_current)(display, state.draw, state.read, state.context);
            }
        }
    }
}
