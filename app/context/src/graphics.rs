//! A context that somebody else, such as an OpenXR runtime, is to use.

use std::ffi::c_void;

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
/// The binding is valid, and its context current on the calling thread, for as long as the value is borrowed.
pub unsafe trait Graphics {
    /// The context.
    fn binding(&self) -> Binding;

    /// Makes the context current again, in case the runtime has changed that.
    ///
    /// # Errors
    /// EGL's reason.
    fn make_current(&self) -> Result<(), String>;
}
