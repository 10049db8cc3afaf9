//! OpenGL ES on the window of an Android activity.

use std::ffi::{CStr, c_void};
use std::ptr;
use std::rc::Rc;

use glow::HasContext as _;
use khronos_egl as egl;
use ndk::native_window::NativeWindow;

use yoro_gl::{Context, GlError};

use crate::{Binding, Graphics};

// khronos-egl does not link the library unless it uses pkg-config.
#[link(name = "EGL")]
unsafe extern "C" {}

type Egl = egl::Instance<egl::Static>;

const OPENGL_ES3_BIT: egl::Int = 0x40;
const CONTEXT_MINOR_VERSION: egl::Int = 0x30FB;
/// The largest number of configurations to search for one of exactly 8 bits.
const MAX_CONFIGS: usize = 64;

/// Errors of contexts and windows.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// EGL provides no context.
    #[error("no OpenGL ES on this device: {0}; yoro needs OpenGL ES 3.0, 3.1 for all of its methods")]
    Unavailable(String),
    /// The window cannot be drawn on; Android may provide another one.
    #[error("the window cannot be drawn on ({0}); the next one will be tried")]
    Surface(String),
    /// The driver has lost the context and its objects: open a new context.
    #[error("the driver has lost the OpenGL ES context: everything in it is made again")]
    ContextLost,
}

/// A display with a current context and, at times, a window.
///
/// The context stays current on the thread that opened it until this value is dropped. Without a window, its surface is
/// a single pixel, so that objects in the context can be dropped at any time. Drop all of them before this value.
pub struct Window {
    egl: Egl,
    display: egl::Display,
    config: egl::Config,
    context: egl::Context,
    placeholder: egl::Surface,
    shown: Option<Shown>,
}

/// A window and its surface, which must be destroyed first.
struct Shown {
    surface: egl::Surface,
    window: NativeWindow,
}

impl Window {
    /// Opens a context of the newest available OpenGL ES, even if that is too old for [`Window::gl`], and makes it
    /// current on this thread.
    ///
    /// # Errors
    /// [`WindowError::Unavailable`].
    pub fn open() -> Result<Window, WindowError> {
        let egl = Egl::new(egl::Static);
        let unavailable = |what: &str| WindowError::Unavailable(what.into());
        let failed = |what: &'static str| move |e| WindowError::Unavailable(format!("{what} failed ({e})"));
        // SAFETY: the default display needs no native handle.
        let display =
            unsafe { egl.get_display(egl::DEFAULT_DISPLAY) }.ok_or_else(|| unavailable("no EGL display"))?;
        egl.initialize(display).map_err(failed("eglInitialize"))?;
        egl.bind_api(egl::OPENGL_ES_API).map_err(failed("eglBindAPI"))?;
        let config = choose(&egl, display, OPENGL_ES3_BIT)
            .or_else(|| choose(&egl, display, egl::OPENGL_ES2_BIT))
            .ok_or_else(|| unavailable("EGL has no configuration of 8 bits per channel for windows"))?;
        // EGL 1.4 does not have minor versions.
        let versions: [&[egl::Int]; 3] = [
            &[egl::CONTEXT_CLIENT_VERSION, 3, CONTEXT_MINOR_VERSION, 1, egl::NONE],
            &[egl::CONTEXT_CLIENT_VERSION, 3, egl::NONE],
            &[egl::CONTEXT_CLIENT_VERSION, 2, egl::NONE],
        ];
        let context = versions
            .into_iter()
            .find_map(|version| egl.create_context(display, config, None, version).ok())
            .ok_or_else(|| unavailable("EGL makes no context of OpenGL ES 2 or 3"))?;
        let size = [egl::WIDTH, 1, egl::HEIGHT, 1, egl::NONE];
        let placeholder = match egl.create_pbuffer_surface(display, config, &size) {
            Ok(surface) => surface,
            Err(e) => {
                let _ = egl.destroy_context(display, context);
                return Err(failed("eglCreatePbufferSurface")(e));
            }
        };
        let window = Window { egl, display, config, context, placeholder, shown: None };
        window.make_current(placeholder).map_err(failed("eglMakeCurrent"))?;
        Ok(window)
    }

    /// Returns the GL context. Call it once, and drop everything that holds the context before this value.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if it is older than OpenGL ES 3.0.
    pub fn gl(&self) -> Result<Rc<Context>, GlError> {
        let load = |name: &CStr| name.to_str().map_or(ptr::null(), |name| self.entry_point(name));
        // SAFETY: the entry points are those of the context, which is current.
        unsafe { Context::with_loader(self.functions(), load) }
    }

    fn functions(&self) -> glow::Context {
        // SAFETY: the context is current, and entry points live as long as the library itself.
        unsafe { glow::Context::from_loader_function(|name| self.entry_point(name)) }
    }

    fn entry_point(&self, name: &str) -> *const c_void {
        self.egl.get_proc_address(name).map_or(ptr::null(), |p| p as *const c_void)
    }

    /// Draws on this window from now on. Colours are stored without conversion: they are already display-referred sRGB.
    ///
    /// # Errors
    /// [`WindowError::Surface`] and [`WindowError::ContextLost`].
    pub fn attach(&mut self, window: NativeWindow) -> Result<(), WindowError> {
        self.detach();
        // SAFETY: the handle is a live ANativeWindow, which `Shown` holds for as long as the surface exists.
        let surface = unsafe {
            self.egl.create_window_surface(self.display, self.config, window.ptr().as_ptr().cast(), None)
        }
        .map_err(|e| self.error("eglCreateWindowSurface", e))?;
        self.shown = Some(Shown { surface, window });
        if let Err(e) = self.make_current(surface) {
            self.detach();
            return Err(self.error("eglMakeCurrent", e));
        }
        // Frames wait for the display, even if the driver's default is another interval.
        let _ = self.egl.swap_interval(self.display, 1);
        Ok(())
    }

    /// Releases the window; the context stays current.
    pub fn detach(&mut self) {
        if let Some(Shown { surface, window }) = self.shown.take() {
            // A lost context cannot be made current; it is replaced at the next attempt to draw.
            if self.make_current(self.placeholder).is_err() {
                let _ = self.egl.make_current(self.display, None, None, None);
            }
            let _ = self.egl.destroy_surface(self.display, surface);
            drop(window);
        }
    }

    /// True if there is a window to draw on.
    pub fn is_attached(&self) -> bool {
        self.shown.is_some()
    }

    /// Returns the window's current size in pixels, or `None` without a window.
    pub fn size(&self) -> Option<[u32; 2]> {
        let shown = self.shown.as_ref()?;
        let side = |attribute| {
            let length = self.egl.query_surface(self.display, shown.surface, attribute).ok()?;
            u32::try_from(length).ok().filter(|n| *n > 0)
        };
        Some([side(egl::WIDTH)?, side(egl::HEIGHT)?])
    }

    /// Shows what was drawn. May wait until the display can take another frame.
    ///
    /// # Errors
    /// [`WindowError::Surface`] and [`WindowError::ContextLost`].
    pub fn present(&self) -> Result<(), WindowError> {
        let Some(shown) = &self.shown else { return Ok(()) };
        self.egl.swap_buffers(self.display, shown.surface).map_err(|e| self.error("eglSwapBuffers", e))
    }

    /// Shows one colour (RGB, display-referred), with any version of OpenGL ES.
    ///
    /// # Errors
    /// Those of [`Window::present`].
    pub fn show_color(&self, [r, g, b]: [f32; 3]) -> Result<(), WindowError> {
        let gl = self.functions();
        // SAFETY: the context is current; these calls exist in every version.
        unsafe {
            gl.clear_color(r, g, b, 1.0);
            gl.clear(glow::COLOR_BUFFER_BIT);
        }
        self.present()
    }

    fn make_current(&self, surface: egl::Surface) -> Result<(), egl::Error> {
        self.egl.make_current(self.display, Some(surface), Some(surface), Some(self.context))
    }

    fn error(&self, what: &str, error: egl::Error) -> WindowError {
        match error {
            egl::Error::ContextLost => WindowError::ContextLost,
            error => WindowError::Surface(format!("{what} failed: {error}")),
        }
    }
}

// SAFETY: the context lives as long as the window object, on the thread that opened it.
unsafe impl Graphics for Window {
    fn binding(&self) -> Binding {
        Binding {
            display: self.display.as_ptr(),
            config: self.config.as_ptr(),
            context: self.context.as_ptr(),
            get_proc_address: ptr::null(),
        }
    }

    fn make_current(&self) -> Result<(), String> {
        if self.egl.get_current_context() == Some(self.context) {
            return Ok(());
        }
        let surface = self.shown.as_ref().map_or(self.placeholder, |shown| shown.surface);
        Window::make_current(self, surface).map_err(|e| format!("eglMakeCurrent failed ({e})"))
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        self.detach();
        // Errors are ignored here, since nothing can be done about them. The display stays initialised: it belongs to
        // the process, and another activity may have opened it already.
        let _ = self.egl.make_current(self.display, None, None, None);
        let _ = self.egl.destroy_surface(self.display, self.placeholder);
        let _ = self.egl.destroy_context(self.display, self.context);
        let _ = self.egl.release_thread();
    }
}

/// Returns a configuration of exactly 8 bits per channel: EGL lists those with more bits first, which cost more
/// bandwidth and look the same for an 8-bit picture. Prefers one without alpha, since nothing shines through the
/// window.
fn choose(egl: &Egl, display: egl::Display, renderable: egl::Int) -> Option<egl::Config> {
    let attributes = [
        egl::SURFACE_TYPE,
        egl::WINDOW_BIT | egl::PBUFFER_BIT,
        egl::RENDERABLE_TYPE,
        renderable,
        egl::RED_SIZE,
        8,
        egl::GREEN_SIZE,
        8,
        egl::BLUE_SIZE,
        8,
        egl::NONE,
    ];
    let mut configs = Vec::with_capacity(MAX_CONFIGS);
    egl.choose_config(display, &attributes, &mut configs).ok()?;
    let bits = |config, attribute| egl.get_config_attrib(display, config, attribute).unwrap_or(0);
    let exact = |config: &&egl::Config| {
        [egl::RED_SIZE, egl::GREEN_SIZE, egl::BLUE_SIZE].into_iter().all(|c| bits(**config, c) == 8)
    };
    let spare = |config: &&egl::Config| {
        [egl::ALPHA_SIZE, egl::DEPTH_SIZE, egl::STENCIL_SIZE, egl::SAMPLES]
            .into_iter()
            .map(|a| bits(**config, a))
            .sum::<egl::Int>()
    };
    configs.iter().filter(exact).min_by_key(spare).copied()
}
