//! A context that is lent to somebody else, such as an OpenXR runtime.

use std::ffi::c_void;

/// The EGL handles of a GL context.
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

/// An owner of a GL context.
///
/// # Safety
/// The binding is valid, and its context is current on the calling thread, for as long as the value is borrowed.
pub unsafe trait Graphics {
    /// Returns the context's EGL handles.
    fn binding(&self) -> Binding;

    /// Makes the context current again, in case the runtime has changed it.
    ///
    /// # Errors
    /// EGL's reason.
    fn make_current(&self) -> Result<(), String>;
}
