//! EGL on the activity's window.

use std::ptr;

use glow::HasContext as _;
use khronos_egl as egl;
use log::info;
use ndk::native_window::NativeWindow;

// khronos-egl names no library when it does not ask pkg-config.
#[link(name = "EGL")]
unsafe extern "C" {}

type Egl = egl::Instance<egl::Static>;

/// The device's display with an OpenGL ES 3 context.
pub struct Display {
    egl: Egl,
    display: egl::Display,
    config: egl::Config,
    context: egl::Context,
}

impl Display {
    /// Opens the default display and makes a context, the newest ES 3 that there is.
    ///
    /// # Errors
    /// What EGL says, when there is no display, no fitting format or no ES 3.
    pub fn open() -> Result<Self, String> {
        let egl = Egl::new(egl::Static);
        let failed = |what: &'static str| move |error: egl::Error| format!("{what} failed: {error}");
        // SAFETY: the default display is no pointer to anything of ours.
        let display = unsafe { egl.get_display(egl::DEFAULT_DISPLAY) }.ok_or("this device has no EGL display")?;
        egl.initialize(display).map_err(failed("eglInitialize"))?;
        egl.bind_api(egl::OPENGL_ES_API).map_err(failed("eglBindAPI"))?;
        let attributes = [
            egl::SURFACE_TYPE,
            egl::WINDOW_BIT,
            egl::RENDERABLE_TYPE,
            egl::OPENGL_ES3_BIT,
            egl::RED_SIZE,
            8,
            egl::GREEN_SIZE,
            8,
            egl::BLUE_SIZE,
            8,
            egl::NONE,
        ];
        let config = egl
            .choose_first_config(display, &attributes)
            .map_err(failed("eglChooseConfig"))?
            .ok_or("this device has no OpenGL ES 3 for a window")?;
        let context = egl
            .create_context(display, config, None, &[egl::CONTEXT_CLIENT_VERSION, 3, egl::NONE])
            .map_err(failed("eglCreateContext"))?;
        Ok(Self { egl, display, config, context })
    }

    /// Makes the window what GL draws on.
    ///
    /// # Errors
    /// What EGL says.
    pub fn surface(&self, window: NativeWindow) -> Result<Surface<'_>, String> {
        // SAFETY: the window is held by the surface that is made here, and outlives it.
        let handle = unsafe {
            self.egl.create_window_surface(self.display, self.config, window.ptr().as_ptr().cast(), None)
        }
        .map_err(|error| format!("eglCreateWindowSurface failed: {error}"))?;
        self.egl
            .make_current(self.display, Some(handle), Some(handle), Some(self.context))
            .map_err(|error| format!("eglMakeCurrent failed: {error}"))?;
        // SAFETY: the context is current, and the functions are asked of its own EGL.
        let gl = unsafe {
            glow::Context::from_loader_function(|name| {
                self.egl.get_proc_address(name).map_or(ptr::null(), |function| function as *const _)
            })
        };
        // SAFETY: the context is current.
        let (version, renderer) =
            unsafe { (gl.get_parameter_string(glow::VERSION), gl.get_parameter_string(glow::RENDERER)) };
        info!("{version}, {renderer}, {}x{}", window.width(), window.height());
        Ok(Surface { display: self, handle, gl, window })
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // Nothing can be done about an error here.
        let _ = self.egl.destroy_context(self.display, self.context);
        let _ = self.egl.terminate(self.display);
    }
}

/// A window with the context current on it, until it is dropped.
pub struct Surface<'d> {
    display: &'d Display,
    handle: egl::Surface,
    gl: glow::Context,
    window: NativeWindow,
}

impl Surface<'_> {
    /// One frame of one colour (RGBA, as stored).
    ///
    /// # Errors
    /// What EGL says when the picture cannot be shown.
    pub fn clear(&self, [r, g, b, a]: [f32; 4]) -> Result<(), String> {
        // SAFETY: the context is current as long as this surface lives.
        unsafe {
            self.gl.viewport(0, 0, self.window.width(), self.window.height());
            self.gl.clear_color(r, g, b, a);
            self.gl.clear(glow::COLOR_BUFFER_BIT);
        }
        self.display
            .egl
            .swap_buffers(self.display.display, self.handle)
            .map_err(|error| format!("eglSwapBuffers failed: {error}"))
    }
}

impl Drop for Surface<'_> {
    fn drop(&mut self) {
        let Display { egl, display, .. } = self.display;
        // Nothing can be done about an error here.
        let _ = egl.make_current(*display, None, None, None);
        let _ = egl.destroy_surface(*display, self.handle);
    }
}
