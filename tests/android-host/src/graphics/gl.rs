//! OpenGL ES: Mesa's functions, wrappers of those that create and delete objects, and functions for the host itself.

#![allow(non_snake_case)]

use std::cell::Cell;
use std::ffi::{CStr, CString, c_char, c_void};
use std::sync::{Mutex, OnceLock};

use glow::{
    COLOR_BUFFER_BIT, COLOR_CLEAR_VALUE, COLOR_WRITEMASK, DEBUG_OUTPUT, DEBUG_OUTPUT_SYNCHRONOUS,
    DEBUG_TYPE_ERROR, DRAW_FRAMEBUFFER, DRAW_FRAMEBUFFER_BINDING, PACK_ALIGNMENT, PACK_ROW_LENGTH,
    PACK_SKIP_PIXELS, PACK_SKIP_ROWS, PIXEL_PACK_BUFFER, PIXEL_PACK_BUFFER_BINDING, RASTERIZER_DISCARD,
    READ_FRAMEBUFFER, READ_FRAMEBUFFER_BINDING, RENDERER, RGBA, SCISSOR_TEST, UNSIGNED_BYTE, VERSION,
};
use image::RgbaImage;

use crate::bionic::text;
use crate::graphics::egl::{current_group, real_function};
use crate::host::{fatal, host, lock};

/// Returns a function of Mesa that the host itself needs. Ends the run if it is missing.
fn real(name: &CStr) -> *const c_void {
    let address = real_function(name);
    if address.is_null() {
        fatal(format!("Mesa has no {}", name.to_string_lossy()));
    }
    address
}

/// Declares functions of Mesa for the host's own calls.
macro_rules! mesa {
    ($($name:ident as $symbol:literal($($argument:ident: $type:ty),*) $(-> $result:ty)?;)*) => {
        $(unsafe fn $name($($argument: $type),*) $(-> $result)? {
            static ADDRESS: OnceLock<usize> = OnceLock::new();
            let address = *ADDRESS.get_or_init(|| real($symbol) as usize);
            // SAFETY: the type is that in gl3.h.
            let function: unsafe extern "C" fn($($type),*) $(-> $result)? = unsafe { std::mem::transmute(address) };
            // SAFETY: the caller has a current context, and passes pointers that GL accepts.
            unsafe { function($($argument),*) }
        })*
    };
}

mesa! {
    bind_framebuffer as c"glBindFramebuffer"(target: u32, name: u32);
    bind_buffer as c"glBindBuffer"(target: u32, name: u32);
    clear as c"glClear"(bits: u32);
    clear_color as c"glClearColor"(r: f32, g: f32, b: f32, a: f32);
    color_mask as c"glColorMask"(r: u8, g: u8, b: u8, a: u8);
    debug_message_callback as c"glDebugMessageCallbackKHR"(callback: DebugCallback, data: *const c_void);
    disable as c"glDisable"(what: u32);
    enable as c"glEnable"(what: u32);
    get_error as c"glGetError"() -> u32;
    get_float as c"glGetFloatv"(name: u32, out: *mut f32);
    get_integer as c"glGetIntegerv"(name: u32, out: *mut i32);
    get_string as c"glGetString"(name: u32) -> *const c_char;
    is_enabled as c"glIsEnabled"(what: u32) -> u8;
    pixel_store as c"glPixelStorei"(name: u32, value: i32);
    read_pixels as c"glReadPixels"(x: i32, y: i32, width: i32, height: i32, format: u32, kind: u32, out: *mut c_void);
}

type DebugCallback = extern "C" fn(
    source: u32,
    kind: u32,
    id: u32,
    severity: u32,
    length: i32,
    message: *const c_char,
    data: *const c_void,
);

/// The application's debug callback with its share group and data.
static APPLICATION_CALLBACK: Mutex<Option<(usize, DebugCallback, usize)>> = Mutex::new(None);

thread_local! {
    /// True if the driver has described an error since the last check.
    static DESCRIBED: Cell<bool> = const { Cell::new(false) };
}

extern "C" fn debug_message(
    source: u32,
    kind: u32,
    id: u32,
    severity: u32,
    length: i32,
    message: *const c_char,
    _data: *const c_void,
) {
    if kind == DEBUG_TYPE_ERROR {
        DESCRIBED.set(true);
        // SAFETY: KHR_debug's messages are terminated.
        host().graphics.error(unsafe { text(message) }.trim());
    }
    let callback = *lock(&APPLICATION_CALLBACK);
    if let Some((_, callback, data)) = callback.filter(|(group, ..)| *group == current_group()) {
        callback(source, kind, id, severity, length, message, data as *const c_void);
    }
}

extern "C" fn glDebugMessageCallback(callback: Option<DebugCallback>, data: *const c_void) {
    *lock(&APPLICATION_CALLBACK) = callback.map(|callback| (current_group(), callback, data as usize));
}

/// Registers the debug callback in a context. Called once per context, when it first becomes current.
pub fn watch_context() {
    // SAFETY: a context is current; the callback lives as long as the process.
    unsafe {
        debug_message_callback(debug_message, std::ptr::null());
        enable(DEBUG_OUTPUT);
        enable(DEBUG_OUTPUT_SYNCHRONOUS);
        host().graphics.describe(text(get_string(VERSION)), text(get_string(RENDERER)));
    }
    check_errors();
}

/// Records errors that the application has not queried, except those that the driver has already described.
pub fn check_errors() {
    // SAFETY: a context is current.
    let error = unsafe { get_error() };
    if error != 0 && !DESCRIBED.replace(false) {
        host().graphics.error(&format!("glGetError gives {error:#x}"));
    }
}

fn integer(name: u32) -> i32 {
    let mut value = 0;
    // SAFETY: a context is current, and the parameter has one value.
    unsafe { get_integer(name, &raw mut value) };
    value
}

/// Returns the picture that is about to be shown, with row 0 at the top. Does not change the application's state.
///
/// # Errors
/// Fails if the driver returns an error.
pub fn read_default_framebuffer(width: i32, height: i32) -> Result<RgbaImage, String> {
    let store =
        [PACK_ALIGNMENT, PACK_ROW_LENGTH, PACK_SKIP_ROWS, PACK_SKIP_PIXELS].map(|name| (name, integer(name)));
    let (framebuffer, buffer) =
        (integer(READ_FRAMEBUFFER_BINDING) as u32, integer(PIXEL_PACK_BUFFER_BINDING) as u32);
    let mut pixels = vec![0_u8; width as usize * height as usize * 4];
    // SAFETY: a context is current. With an alignment of 1 and no row length, the picture exactly fills the buffer.
    let error = unsafe {
        bind_framebuffer(READ_FRAMEBUFFER, 0);
        bind_buffer(PIXEL_PACK_BUFFER, 0);
        for ((name, _), value) in store.iter().zip([1, 0, 0, 0]) {
            pixel_store(*name, value);
        }
        read_pixels(0, 0, width, height, RGBA, UNSIGNED_BYTE, pixels.as_mut_ptr().cast());
        let error = get_error();
        for (name, value) in store {
            pixel_store(name, value);
        }
        bind_buffer(PIXEL_PACK_BUFFER, buffer);
        bind_framebuffer(READ_FRAMEBUFFER, framebuffer);
        error
    };
    if error != 0 {
        return Err(format!("glReadPixels of the window gives {error:#x}"));
    }
    let image = RgbaImage::from_raw(width as u32, height as u32, pixels)
        .ok_or("the window's picture has another size")?;
    Ok(image::imageops::flip_vertical(&image))
}

/// Fills the window with magenta after a swap. On a device the content is then undefined; magenta shows if an
/// application relies on it.
pub fn spoil_default_framebuffer() {
    let framebuffer = integer(DRAW_FRAMEBUFFER_BINDING) as u32;
    let (mut color, mut mask) = ([0.0_f32; 4], [0_i32; 4]);
    // SAFETY: a context is current, and both parameters have four values.
    unsafe {
        get_float(COLOR_CLEAR_VALUE, color.as_mut_ptr());
        get_integer(COLOR_WRITEMASK, mask.as_mut_ptr());
        let enabled = [SCISSOR_TEST, RASTERIZER_DISCARD].map(|what| (what, is_enabled(what)));
        bind_framebuffer(DRAW_FRAMEBUFFER, 0);
        for (what, _) in enabled {
            disable(what);
        }
        color_mask(1, 1, 1, 1);
        clear_color(1.0, 0.0, 1.0, 1.0);
        clear(COLOR_BUFFER_BIT);
        clear_color(color[0], color[1], color[2], color[3]);
        let [r, g, b, a] = mask.map(|value| u8::from(value != 0));
        color_mask(r, g, b, a);
        for (what, was) in enabled {
            if was != 0 {
                enable(what);
            }
        }
        bind_framebuffer(DRAW_FRAMEBUFFER, framebuffer);
    }
}

/// Defines wrappers of functions that create and delete arrays of names.
macro_rules! names {
    ($($kind:literal: $generate:ident $generate_name:literal, $delete:ident $delete_name:literal;)*) => {
        $(
            unsafe extern "C" fn $generate(count: i32, names: *mut u32) {
                mesa! { call as $generate_name(count: i32, names: *mut u32); }
                // SAFETY: the application's arguments are passed to Mesa unchanged.
                unsafe { call(count, names) };
                let group = current_group();
                for index in 0..count.max(0) as usize {
                    // SAFETY: the caller provides room for `count` names, which have been written.
                    host().graphics.object_made(group, $kind, unsafe { *names.add(index) } as usize);
                }
            }

            unsafe extern "C" fn $delete(count: i32, names: *const u32) {
                mesa! { call as $delete_name(count: i32, names: *const u32); }
                let group = current_group();
                for index in 0..count.max(0) as usize {
                    // SAFETY: the caller passes `count` names.
                    let name = unsafe { *names.add(index) } as usize;
                    if name != 0 {
                        host().graphics.object_deleted(group, $kind, name);
                    }
                }
                // SAFETY: the application's arguments are passed to Mesa unchanged.
                unsafe { call(count, names) };
            }
        )*
    };
}

names! {
    "buffer": glGenBuffers c"glGenBuffers", glDeleteBuffers c"glDeleteBuffers";
    "framebuffer": glGenFramebuffers c"glGenFramebuffers", glDeleteFramebuffers c"glDeleteFramebuffers";
    "query": glGenQueries c"glGenQueries", glDeleteQueries c"glDeleteQueries";
    "renderbuffer": glGenRenderbuffers c"glGenRenderbuffers", glDeleteRenderbuffers c"glDeleteRenderbuffers";
    "texture": glGenTextures c"glGenTextures", glDeleteTextures c"glDeleteTextures";
    "vertex array": glGenVertexArrays c"glGenVertexArrays", glDeleteVertexArrays c"glDeleteVertexArrays";
}

/// Defines wrappers of functions that create and delete a single object.
macro_rules! objects {
    ($($kind:literal: $create:ident $create_name:literal($($argument:ident: $type:ty),*), $delete:ident $delete_name:literal;)*) => {
        $(
            extern "C" fn $create($($argument: $type),*) -> u32 {
                mesa! { call as $create_name($($argument: $type),*) -> u32; }
                // SAFETY: a context is current, or Mesa returns zero.
                let name = unsafe { call($($argument),*) };
                if name != 0 {
                    host().graphics.object_made(current_group(), $kind, name as usize);
                }
                name
            }

            extern "C" fn $delete(name: u32) {
                mesa! { call as $delete_name(name: u32); }
                if name != 0 {
                    host().graphics.object_deleted(current_group(), $kind, name as usize);
                }
                // SAFETY: a context is current, or Mesa does nothing.
                unsafe { call(name) };
            }
        )*
    };
}

objects! {
    "shader": glCreateShader c"glCreateShader"(kind: u32), glDeleteShader c"glDeleteShader";
    "program": glCreateProgram c"glCreateProgram"(), glDeleteProgram c"glDeleteProgram";
}

extern "C" fn glFenceSync(condition: u32, flags: u32) -> usize {
    mesa! { call as c"glFenceSync"(condition: u32, flags: u32) -> usize; }
    // SAFETY: a context is current, or Mesa returns zero.
    let sync = unsafe { call(condition, flags) };
    if sync != 0 {
        host().graphics.object_made(current_group(), "sync", sync);
    }
    sync
}

unsafe extern "C" fn glClientWaitSync(sync: usize, flags: u32, timeout: u64) -> u32 {
    mesa! { call as c"glClientWaitSync"(sync: usize, flags: u32, timeout: u64) -> u32; }
    host().graphics.waited();
    // SAFETY: the application's arguments are passed to Mesa unchanged.
    unsafe { call(sync, flags, timeout) }
}

unsafe extern "C" fn glDeleteSync(sync: usize) {
    mesa! { call as c"glDeleteSync"(sync: usize); }
    if sync != 0 {
        host().graphics.object_deleted(current_group(), "sync", sync);
    }
    // SAFETY: the application's arguments are passed to Mesa unchanged.
    unsafe { call(sync) };
}

/// Returns the address that the application gets for a function's name.
pub fn function(name: &str) -> Option<usize> {
    macro_rules! ours {
        ($($function:ident)*) => {
            // Mesa has the same functions under their extensions' names.
            match name.trim_end_matches("EXT").trim_end_matches("KHR") {
                $(stringify!($function) => Some($function as *const () as usize),)*
                _ => None,
            }
        };
    }
    if !name.starts_with("gl") {
        return None;
    }
    let ours = ours! {
        glGenBuffers glDeleteBuffers glGenFramebuffers glDeleteFramebuffers glGenQueries glDeleteQueries
        glGenRenderbuffers glDeleteRenderbuffers glGenTextures glDeleteTextures glGenVertexArrays glDeleteVertexArrays glCreateShader glDeleteShader glCreateProgram glDeleteProgram glFenceSync
        glClientWaitSync glDeleteSync glDebugMessageCallback
    };
    let symbol = CString::new(name).ok()?;
    let real = real_function(&symbol) as usize;
    if real == 0 { None } else { ours.or(Some(real)) }
}
