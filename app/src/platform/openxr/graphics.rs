//! The GL context that a session draws with.

use std::ffi::c_void;

use openxr as xr;
use xr::sys;
use xr::sys::Handle as _;

use super::error::{XrError, call, check};

/// A GL context as EGL knows it.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// EGLDisplay.
    pub display: *mut c_void,
    /// EGLConfig.
    pub config: *mut c_void,
    /// EGLContext, of OpenGL ES.
    pub context: *mut c_void,
    /// eglGetProcAddress.
    pub get_proc_address: *const c_void,
}

/// Who owns the GL context.
///
/// # Safety
/// The binding is valid, and its context current on the calling thread, for as long as the value is borrowed by a
/// [`super::Headset`] that uses it.
pub unsafe trait Graphics {
    /// The context.
    fn binding(&self) -> Binding;

    /// Makes the context current again, in case the runtime has changed that.
    ///
    /// # Errors
    /// What EGL said.
    fn make_current(&self) -> Result<(), String>;
}

/// Makes the context current again; runtimes may change that in any call that has to do with images or frames.
pub(super) fn make_current(graphics: &dyn Graphics) -> Result<(), XrError> {
    graphics.make_current().map_err(XrError::Context)
}

/// The Java side of an Android application.
#[cfg(target_os = "android")]
#[derive(Clone, Copy, Debug)]
pub struct Android {
    vm: *mut c_void,
    activity: *mut c_void,
}

#[cfg(target_os = "android")]
impl Android {
    /// A `JavaVM*` and a global JNI reference to the `android.app.Activity`.
    ///
    /// # Safety
    /// Both are valid as long as the value, or what was made with it, is used.
    pub unsafe fn new(vm: *mut c_void, activity: *mut c_void) -> Android {
        Android { vm, activity }
    }

    /// For the search of a runtime.
    pub fn context(&self) -> super::runtime::JavaContext {
        // SAFETY: promised by whoever made this.
        unsafe { super::runtime::JavaContext::new(self.vm, self.activity) }
    }

    pub(super) fn platform(&self) -> xr::AndroidPlatformInfo {
        // SAFETY: promised by whoever made this.
        unsafe { xr::AndroidPlatformInfo::new(self.vm, self.activity) }
    }
}

/// What a session consists of at first.
pub(super) type NewSession = (xr::Session<xr::OpenGlEs>, xr::FrameWaiter, xr::FrameStream<xr::OpenGlEs>);

/// xrCreateSession.
pub(super) fn create_session(
    instance: &xr::Instance,
    system: xr::SystemId,
    graphics: &dyn Graphics,
) -> Result<NewSession, XrError> {
    let binding = graphics.binding();
    #[cfg(target_os = "android")]
    let graphics_binding = sys::GraphicsBindingOpenGLESAndroidKHR {
        ty: sys::GraphicsBindingOpenGLESAndroidKHR::TYPE,
        next: std::ptr::null(),
        display: binding.display,
        config: binding.config,
        context: binding.context,
    };
    #[cfg(not(target_os = "android"))]
    let graphics_binding = sys::GraphicsBindingEGLMNDX {
        ty: sys::GraphicsBindingEGLMNDX::TYPE,
        next: std::ptr::null(),
        // SAFETY: by the contract of `Graphics` this is eglGetProcAddress, of this type; null is `None`.
        get_proc_address: unsafe {
            std::mem::transmute::<*const c_void, Option<sys::pfn::EglGetProcAddressMNDX>>(
                binding.get_proc_address,
            )
        },
        display: binding.display,
        config: binding.config,
        context: binding.context,
    };
    let info = sys::SessionCreateInfo {
        ty: sys::SessionCreateInfo::TYPE,
        next: std::ptr::from_ref(&graphics_binding).cast(),
        create_flags: sys::SessionCreateFlags::EMPTY,
        system_id: system,
    };
    let mut handle = sys::Session::NULL;
    // SAFETY: the structures live through the call and the binding is valid by the contract of `Graphics`.
    let result = unsafe { (instance.fp().create_session)(instance.as_raw(), &info, &mut handle) };
    make_current(graphics)?;
    check("xrCreateSession", result)?;
    // SAFETY: a new session of this instance, made for OpenGL ES.
    Ok(unsafe { xr::Session::from_raw(instance.clone(), handle, Box::new(())) })
}

/// xrGetOpenGLESGraphicsRequirementsKHR, which must come before a session; `present` is the context's version.
pub(super) fn check_version(
    instance: &xr::Instance,
    system: xr::SystemId,
    present: (u32, u32),
) -> Result<(), XrError> {
    let needed =
        call("xrGetOpenGLESGraphicsRequirementsKHR", instance.graphics_requirements::<xr::OpenGlEs>(system))?;
    let least = needed.min_api_version_supported;
    if (u32::from(least.major()), u32::from(least.minor())) > present {
        return Err(XrError::Version {
            needed: format!("{}.{}", least.major(), least.minor()),
            present: format!("{}.{}", present.0, present.1),
        });
    }
    Ok(())
}

#[cfg(feature = "desktop")]
mod desktop {
    use std::ffi::c_void;

    use super::{Binding, Graphics, XrError};
    use crate::platform::Headless;

    /// A context without a window, for runtimes with XR_MNDX_egl_enable.
    pub struct HeadlessGraphics<'a> {
        headless: &'a Headless,
        binding: Binding,
        /// Where eglGetProcAddress is.
        _library: libloading::Library,
    }

    impl<'a> HeadlessGraphics<'a> {
        /// Needs a context by EGL, of OpenGL ES.
        ///
        /// # Errors
        /// [`XrError::Context`].
        pub fn new(headless: &'a Headless) -> Result<HeadlessGraphics<'a>, XrError> {
            let egl = headless.egl().ok_or_else(|| {
                XrError::Context("it must come from EGL, so leave out --gl, or give --gl egl".into())
            })?;
            // SAFETY: the library that the context comes from, and that is loaded already.
            let library = unsafe { libloading::Library::new("libEGL.so.1") }
                .map_err(|e| XrError::Context(e.to_string()))?;
            // SAFETY: the type is that of EGL's header.
            let get_proc_address = unsafe {
                library
                    .get::<unsafe extern "C" fn(*const std::ffi::c_char) -> *const c_void>(
                        b"eglGetProcAddress\0",
                    )
                    .map(|function| *function as *const c_void)
                    .map_err(|e| XrError::Context(e.to_string()))?
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
}

#[cfg(feature = "desktop")]
pub use desktop::HeadlessGraphics;
