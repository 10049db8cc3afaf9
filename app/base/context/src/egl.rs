//! OpenGL ES without a window: EGL on a device, on the surfaceless platform, or on the default display.

use std::ffi::{CStr, c_int, c_uint, c_void};

use khronos_egl as egl;

type Egl = egl::DynamicInstance<egl::EGL1_5>;

const PLATFORM_SURFACELESS_MESA: egl::Enum = 0x31DD;
const PLATFORM_DEVICE_EXT: egl::Enum = 0x313F;
const OPENGL_ES3_BIT: egl::Int = 0x40;
const MAX_DEVICES: usize = 16;

type QueryDevices = extern "system" fn(c_int, *mut *mut c_void, *mut c_int) -> c_uint;

/// A current EGL context; destroyed when dropped.
pub(super) struct EglContext {
    egl: Egl,
    display: egl::Display,
    config: egl::Config,
    context: egl::Context,
    surface: Option<egl::Surface>,
}

impl EglContext {
    /// Tries each device (GPUs come before a CPU rasterizer), then Mesa's surfaceless platform, then the default
    /// display. The error lists the reason of each.
    pub(super) fn open() -> Result<(EglContext, glow::Context), String> {
        // SAFETY: loads the system's libEGL, whose initialisers are trusted like the driver's.
        let load = || unsafe { Egl::load_required() };
        load().map_err(|e| format!("libEGL.so.1 could not be loaded ({e})"))?;
        let mut failures = Vec::new();
        type Find = fn(&Egl, usize) -> Result<Option<egl::Display>, String>;
        let platforms: [(&str, Find); 3] = [
            ("device", device_display),
            ("surfaceless", surfaceless_display),
            ("default display", default_display),
        ];
        for (name, find) in platforms {
            for i in 0..MAX_DEVICES {
                let egl = load().map_err(|e| e.to_string())?;
                let opened = match find(&egl, i) {
                    Ok(None) => break,
                    Ok(Some(display)) => EglContext::on_display(egl, display),
                    Err(e) => Err(e),
                };
                match opened {
                    Ok(pair) => return Ok(pair),
                    Err(e) => failures.push(format!("{name}: {}", e.trim_end_matches('.'))),
                }
            }
        }
        Err(failures.join(", "))
    }

    fn on_display(egl: Egl, display: egl::Display) -> Result<(EglContext, glow::Context), String> {
        egl.initialize(display).map_err(|e| format!("cannot be initialised ({e})"))?;
        egl.bind_api(egl::OPENGL_ES_API).map_err(|e| format!("no OpenGL ES ({e})"))?;
        let attributes = [
            egl::SURFACE_TYPE,
            egl::PBUFFER_BIT,
            egl::RENDERABLE_TYPE,
            OPENGL_ES3_BIT,
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
            .map_err(|e| e.to_string())?
            .ok_or("no configuration for OpenGL ES 3")?;
        let context = [(3, 1), (3, 0)]
            .into_iter()
            .find_map(|(major, minor)| {
                let version =
                    [egl::CONTEXT_MAJOR_VERSION, major, egl::CONTEXT_MINOR_VERSION, minor, egl::NONE];
                egl.create_context(display, config, None, &version).ok()
            })
            .ok_or("no OpenGL ES 3 context")?;
        let mut this = EglContext { egl, display, config, context, surface: None };
        if this.egl.make_current(display, None, None, Some(context)).is_err() {
            let size = [egl::WIDTH, 16, egl::HEIGHT, 16, egl::NONE];
            let surface =
                this.egl.create_pbuffer_surface(display, config, &size).map_err(|e| e.to_string())?;
            this.surface = Some(surface);
            this.egl
                .make_current(display, Some(surface), Some(surface), Some(context))
                .map_err(|e| format!("cannot be made current ({e})"))?;
        }
        // SAFETY: the context is current, and entry points live as long as libEGL, which `this` holds.
        let gl = unsafe {
            glow::Context::from_loader_function(|name| {
                this.egl.get_proc_address(name).map_or(std::ptr::null(), |p| p as *const c_void)
            })
        };
        Ok((this, gl))
    }
}

impl EglContext {
    /// Makes the context current on this thread again.
    pub(super) fn make_current(&self) -> Result<(), String> {
        if self.egl.get_current_context() == Some(self.context) {
            return Ok(());
        }
        self.egl
            .make_current(self.display, self.surface, self.surface, Some(self.context))
            .map_err(|e| format!("eglMakeCurrent failed ({e})"))
    }

    /// Returns EGLDisplay, EGLConfig and EGLContext.
    pub(super) fn handles(&self) -> [*mut c_void; 3] {
        [self.display.as_ptr(), self.config.as_ptr(), self.context.as_ptr()]
    }

    /// Returns a GL function by name, or null.
    pub(super) fn entry_point(&self, name: &CStr) -> *const c_void {
        let function = name.to_str().ok().and_then(|name| self.egl.get_proc_address(name));
        function.map_or(std::ptr::null(), |f| f as *const c_void)
    }
}

impl Drop for EglContext {
    fn drop(&mut self) {
        // The display stays initialised: it is shared by all contexts of the process.
        let _ = self.egl.make_current(self.display, None, None, None);
        if let Some(surface) = self.surface {
            let _ = self.egl.destroy_surface(self.display, surface);
        }
        let _ = self.egl.destroy_context(self.display, self.context);
    }
}

fn platform_display(egl: &Egl, platform: egl::Enum, native: *mut c_void) -> Result<egl::Display, String> {
    // SAFETY: null or a device handle from eglQueryDevicesEXT, as the platform asks for.
    unsafe { egl.get_platform_display(platform, native, &[egl::ATTRIB_NONE]) }.map_err(|e| e.to_string())
}

fn surfaceless_display(egl: &Egl, i: usize) -> Result<Option<egl::Display>, String> {
    if i > 0 {
        return Ok(None);
    }
    platform_display(egl, PLATFORM_SURFACELESS_MESA, std::ptr::null_mut()).map(Some)
}

fn device_display(egl: &Egl, i: usize) -> Result<Option<egl::Display>, String> {
    let Some(query) = egl.get_proc_address("eglQueryDevicesEXT") else {
        return if i == 0 { Err("no EGL_EXT_device_enumeration".into()) } else { Ok(None) };
    };
    // SAFETY: the entry point has this signature by EGL_EXT_device_enumeration.
    let query: QueryDevices = unsafe { std::mem::transmute(query) };
    let mut devices = [std::ptr::null_mut(); MAX_DEVICES];
    let mut count = 0;
    query(MAX_DEVICES as c_int, devices.as_mut_ptr(), &mut count);
    if i >= count.max(0) as usize {
        return Ok(None);
    }
    platform_display(egl, PLATFORM_DEVICE_EXT, devices[i]).map(Some)
}

fn default_display(egl: &Egl, i: usize) -> Result<Option<egl::Display>, String> {
    if i > 0 {
        return Ok(None);
    }
    // SAFETY: the default display needs no native handle.
    unsafe { egl.get_display(egl::DEFAULT_DISPLAY) }.map(Some).ok_or_else(|| "no default display".into())
}
