//! The GL functions that this library calls. glow loads every function that it knows, and panics when one that the
//! loader did not return is called.

use std::ffi::{CStr, c_void};

use glow::HasContext as _;

use crate::result::{Failure, YORO_ERROR_NO_CONTEXT};

/// The functions that glow calls to find out the version.
const FIRST: [&CStr; 3] = [c"glGetString", c"glGetStringi", c"glGetIntegerv"];
/// Functions of OpenGL ES 3.0.
const ES_3_0: [&CStr; 64] = [
    c"glActiveTexture",
    c"glAttachShader",
    c"glBindFramebuffer",
    c"glBindSampler",
    c"glBeginQuery",
    c"glBindTexture",
    c"glBindVertexArray",
    c"glCheckFramebufferStatus",
    c"glColorMask",
    c"glCompileShader",
    c"glCreateProgram",
    c"glCreateShader",
    c"glDeleteFramebuffers",
    c"glDeleteProgram",
    c"glDeleteQueries",
    c"glDeleteSamplers",
    c"glDeleteShader",
    c"glDeleteTextures",
    c"glDeleteVertexArrays",
    c"glDepthFunc",
    c"glDepthMask",
    c"glDepthRangef",
    c"glDisable",
    c"glDrawArrays",
    c"glDrawBuffers",
    c"glEnable",
    c"glEndQuery",
    c"glFramebufferTexture2D",
    c"glGenFramebuffers",
    c"glGenQueries",
    c"glGenSamplers",
    c"glGenTextures",
    c"glGenVertexArrays",
    c"glGetActiveUniform",
    c"glGetBooleanv",
    c"glGetError",
    c"glGetFloatv",
    c"glGetFramebufferAttachmentParameteriv",
    c"glGetInternalformativ",
    c"glGetProgramInfoLog",
    c"glGetProgramiv",
    c"glGetQueryObjectuiv",
    c"glGetShaderInfoLog",
    c"glGetShaderiv",
    c"glGetTexParameteriv",
    c"glGetUniformLocation",
    c"glIsEnabled",
    c"glIsProgram",
    c"glIsRenderbuffer",
    c"glIsTexture",
    c"glLinkProgram",
    c"glSamplerParameteri",
    c"glShaderSource",
    c"glTexParameteri",
    c"glTexStorage2D",
    c"glUniform1f",
    c"glUniform1i",
    c"glUniform1ui",
    c"glUniform2f",
    c"glUniform2i",
    c"glUniform4f",
    c"glUniform4i",
    c"glUseProgram",
    c"glViewport",
];
/// Functions of OpenGL ES 3.1 and of desktop OpenGL.
const ES_3_1: [&CStr; 1] = [c"glGetTexLevelParameteriv"];
/// Functions of OpenGL ES 3.2 and of desktop OpenGL.
const ES_3_2: [&CStr; 3] = [c"glEnablei", c"glDisablei", c"glColorMaski"];
/// Functions of OpenGL ES only.
const ES: [&CStr; 1] = [c"glInvalidateSubFramebuffer"];
const DESKTOP: [&CStr; 3] = [c"glPolygonMode", c"glViewportArrayv", c"glDepthRangeArrayv"];
/// Functions that a context with GL_KHR_debug has under one name or the other.
const DEBUG: [[&CStr; 2]; 2] =
    [[c"glPushDebugGroup", c"glPushDebugGroupKHR"], [c"glPopDebugGroup", c"glPopDebugGroupKHR"]];

/// Returns the functions that a context must have. For tests.
#[doc(hidden)]
pub fn needed_functions(desktop: bool) -> impl Iterator<Item = &'static CStr> {
    let of_one = if desktop { &DESKTOP[..] } else { &ES[..] };
    let debug = DEBUG.iter().map(|names| &names[0]);
    FIRST.iter().chain(&ES_3_0).chain(&ES_3_1).chain(&ES_3_2).chain(of_one).chain(debug).copied()
}

/// Wraps the current context.
///
/// # Safety
/// `load` returns the entry points of the names it is given, or null.
pub(super) unsafe fn wrap(load: impl Fn(&CStr) -> *const c_void) -> Result<glow::Context, Failure> {
    let is_here = |name: &&CStr| !load(name).is_null();
    check(&FIRST, is_here)?;
    // SAFETY: the caller returns the entry point of this name.
    if !unsafe { is_current(load(c"glGetString")) } {
        return Err(Failure::new(
            YORO_ERROR_NO_CONTEXT,
            "no GL context is current on this thread: make it current before yoro_gl_create",
        ));
    }
    // SAFETY: a context is current, and the caller returns its entry points.
    let gl = unsafe { glow::Context::from_loader_function_cstr(&load) };
    let version = gl.version();
    let (desktop, number) = (!version.is_embedded, (version.major, version.minor));
    check(&ES_3_0, is_here)?;
    if desktop || number >= (3, 1) {
        check(&ES_3_1, is_here)?;
    }
    if desktop || number >= (3, 2) {
        check(&ES_3_2, is_here)?;
    }
    check(if desktop { &DESKTOP[..] } else { &ES }, is_here)?;
    if gl.supports_debug() {
        for names in DEBUG {
            check(&names[..1], |_| names.iter().any(is_here))?;
        }
    }
    Ok(gl)
}

fn check(names: &[&CStr], is_here: impl Fn(&&CStr) -> bool) -> Result<(), Failure> {
    let Some(name) = names.iter().find(|name| !is_here(name)) else { return Ok(()) };
    Err(Failure::new(
        YORO_ERROR_NO_CONTEXT,
        format!(
            "the loader does not return {}: give the loader of the GL context, such as eglGetProcAddress",
            name.to_string_lossy()
        ),
    ))
}

/// True if a context is current. glow assumes this without checking.
///
/// # Safety
/// The pointer is the entry point of glGetString.
pub(super) unsafe fn is_current(get_string: *const c_void) -> bool {
    type GetString = unsafe extern "system" fn(u32) -> *const u8;
    // SAFETY: the caller passes the function of this signature. Without a context it returns null.
    unsafe { !std::mem::transmute::<*const c_void, GetString>(get_string)(glow::VERSION).is_null() }
}
