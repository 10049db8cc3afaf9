//! The GL context that a session draws with.

use std::ffi::c_void;

use openxr as xr;
use xr::sys;
use xr::sys::Handle as _;

use yoro_context::Graphics;

use super::error::{XrError, call, check};

/// Makes the context current again. Runtimes may change the current context in any call concerning images or frames.
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
    /// Creates it from a `JavaVM*` and a global JNI reference to the `android.app.Activity`.
    ///
    /// # Safety
    /// Both pointers must remain valid for as long as this value, or anything created from it, is used.
    pub unsafe fn new(vm: *mut c_void, activity: *mut c_void) -> Android {
        Android { vm, activity }
    }

    pub(super) fn platform(&self) -> xr::AndroidPlatformInfo {
        // SAFETY: the caller of `new` guarantees valid pointers that outlive this value.
        unsafe { xr::AndroidPlatformInfo::new(self.vm, self.activity) }
    }
}

/// The result of xrCreateSession.
pub(super) type NewSession = (xr::Session<xr::OpenGlEs>, xr::FrameWaiter, xr::FrameStream<xr::OpenGlEs>);

/// Calls xrCreateSession.
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
        // SAFETY: by the contract of `Graphics` this is eglGetProcAddress, which has this type; null is `None`.
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
    // SAFETY: the handle is a new session of this instance, created for OpenGL ES.
    Ok(unsafe { xr::Session::from_raw(instance.clone(), handle, Box::new(())) })
}

/// Calls xrGetOpenGLESGraphicsRequirementsKHR, which must precede a session. `present` is the context's version.
pub(super) fn check_version(
    instance: &xr::Instance,
    system: xr::SystemId,
    present: (u32, u32),
) -> Result<(), XrError> {
    let needed =
        call("xrGetOpenGLESGraphicsRequirementsKHR", instance.graphics_requirements::<xr::OpenGlEs>(system))?;
    let least = needed.min_api_version_supported;
    if (u32::from(least.major()), u32::from(least.minor())) > present {
        return Err(XrError::Unusable(format!(
            "the OpenXR runtime needs OpenGL ES {}.{} and this driver has {}.{}: update the driver or the runtime",
            least.major(),
            least.minor(),
            present.0,
            present.1
        )));
    }
    Ok(())
}
