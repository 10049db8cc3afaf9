//! The functions of GL that this library calls. glow loads all that there are, and panics in a call of one that its
//! loader did not return.

use std::ffi::{CStr, c_void};

use glow::HasContext as _;

use crate::result::{Failure, YORO_ERROR_NO_CONTEXT};

/// Those that glow calls to find out the version.
const FIRST: [&CStr; 3] = [c"glGetString", c"glGetStringi", c"glGetIntegerv"];
/// Those of OpenGL ES 3.0.
const ES_3_0: [&CStr; 63] = [
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
/// Those of OpenGL ES 3.1 and the desktop.
const ES_3_1: [&CStr; 1] = [c"glGetTexLevelParameteriv"];
/// Those of OpenGL ES 3.2 and the desktop.
const ES_3_2: [&CStr; 3] = [c"glEnablei", c"glDisablei", c"glColorMaski"];
/// Those of OpenGL ES alone.
const ES: [&CStr; 1] = [c"glInvalidateSubFramebuffer"];
const DESKTOP: [&CStr; 3] = [c"glPolygonMode", c"glViewportArrayv", c"glDepthRangeArrayv"];
/// Of which contexts with GL_KHR_debug have one name or the other.
const DEBUG: [[&CStr; 2]; 2] =
    [[c"glPushDebugGroup", c"glPushDebugGroupKHR"], [c"glPopDebugGroup", c"glPopDebugGroupKHR"]];

/// Returns the functions that a context must have, for tests.
#[doc(hidden)]
pub fn needed_functions(desktop: bool) -> impl Iterator<Item = &'static CStr> {
    let of_one = if desktop { &DESKTOP[..] } else { &ES[..] };
    let debug = DEBUG.iter().map(|names| &names[0]);
    FIRST.iter().chain(&ES_3_0).chain(&ES_3_1).chain(&ES_3_2).chain(of_one).chain(debug).copied()
}

/// Wraps the current context.
///
/// # Safety
/// `load` returns entry points of these names, or null.
pub(super) unsafe fn wrap(load: impl Fn(&CStr) -> *const c_void) -> Result<glow::Context, Failure> {
    let is_here = |name: &&CStr| !load(name).is_null();
    check(&FIRST, is_here)?;
    // SAFETY: the caller gives the entry point of this name.
    if !unsafe { is_current(load(c"glGetString")) } {
        return Err(Failure::new(
            YORO_ERROR_NO_CONTEXT,
            "no GL context is current on this thread: make it current before yoro_gl_create",
        ));
    }
    // SAFETY: a context is current, and the caller gives its entry points.
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

/// True if a context is current, which glow takes for granted.
///
/// # Safety
/// The pointer is glGetString.
pub(super) unsafe fn is_current(get_string: *const c_void) -> bool {
    type GetString = unsafe extern "system" fn(u32) -> *const u8;
    // SAFETY: the caller gives the function of this signature. Without a context it returns null.
    unsafe { !std::mem::transmute::<*const c_void, GetString>(get_string)(glow::VERSION).is_null() }
}
