//! EGL. The display is Mesa's surfaceless one. The surface of a window is a pbuffer of the window's size, which is
//! replaced at a swap if the window's size has changed. For this purpose, the handles of surfaces are the host's own;
//! those of displays, configurations and contexts are Mesa's.

#![allow(non_snake_case)]

use std::cell::Cell;
use std::ffi::{CStr, c_char, c_void};
use std::sync::atomic::Ordering;

use anyhow::{Context, Result};
use khronos_egl::{
    ALPHA_SIZE, BAD_ALLOC, BAD_MATCH, BAD_NATIVE_WINDOW, BAD_SURFACE, Boolean, CONTEXT_LOST,
    CONTEXT_MAJOR_VERSION, CONTEXT_MINOR_VERSION, GL_COLORSPACE, HEIGHT, NATIVE_VISUAL_ID, NONE,
    OPENGL_ES3_BIT, PBUFFER_BIT, RENDERABLE_TYPE, SUCCESS, SURFACE_TYPE, TRUE, WIDTH, WINDOW_BIT,
};

use crate::android::window::{Window, is_window};
use crate::exports::{Export, System, exports};
use crate::graphics::gl;
use crate::host::{host, lock};

type Handle = usize;

/// `EGL_PLATFORM_SURFACELESS_MESA`.
const PLATFORM_SURFACELESS: u32 = 0x31dd;
/// `EGL_RECORDABLE_ANDROID` and `EGL_FRAMEBUFFER_TARGET_ANDROID`, which only Android's drivers support.
const ANDROID_ONLY: [i32; 2] = [0x3142, 0x3147];

/// Declares Mesa's functions: those that the host calls, and those that are passed through to the application.
macro_rules! mesa {
    (
        called { $($name:ident($($argument:ident: $type:ty),*) -> $result:ty;)* }
        passed_on { $($other:ident($($given:ident: $kind:ty),*) -> $answer:ty;)* }
    ) => {
        /// Mesa's functions.
        pub struct Real {
            $($name: unsafe extern "C" fn($($type),*) -> $result,)*
            $($other: unsafe extern "C" fn($($kind),*) -> $answer,)*
            _library: libloading::Library,
        }

        impl Real {
            /// Opens libEGL.
            ///
            /// # Errors
            /// Fails if libEGL is missing, or lacks a function.
            pub fn load() -> Result<Self> {
                // SAFETY: libEGL's constructors have no side effects that matter here.
                let library = unsafe { libloading::Library::new("libEGL.so.1") }?;
                macro_rules! get {
                    ($symbol:ident) => {
                        // SAFETY: the types are those of egl.h.
                        *unsafe { library.get(stringify!($symbol).as_bytes()) }.context(stringify!($symbol))?
                    };
                }
                Ok(Self { $($name: get!($name),)* $($other: get!($other),)* _library: library })
            }
        }

        $(unsafe extern "C" fn $other($($given: $kind),*) -> $answer {
            ERROR.set(SUCCESS);
            // SAFETY: the application's arguments are passed to Mesa unchanged.
            unsafe { (real().$other)($($given),*) }
        })*
    };
}

mesa! {
    called {
        eglChooseConfig(display: Handle, attributes: *const i32, configs: *mut Handle, size: i32, count: *mut i32) -> Boolean;
        eglCreateContext(display: Handle, config: Handle, share: Handle, attributes: *const i32) -> Handle;
        eglCreatePbufferSurface(display: Handle, config: Handle, attributes: *const i32) -> Handle;
        eglDestroyContext(display: Handle, context: Handle) -> Boolean;
        eglDestroySurface(display: Handle, surface: Handle) -> Boolean;
        eglGetConfigAttrib(display: Handle, config: Handle, attribute: i32, value: *mut i32) -> Boolean;
        eglGetError() -> i32;
        eglGetPlatformDisplay(platform: u32, native: *mut c_void, attributes: *const isize) -> Handle;
        eglGetProcAddress(name: *const c_char) -> *const c_void;
        eglMakeCurrent(display: Handle, draw: Handle, read: Handle, context: Handle) -> Boolean;
        eglQuerySurface(display: Handle, surface: Handle, attribute: i32, value: *mut i32) -> Boolean;
        eglReleaseThread() -> Boolean;
        eglSwapBuffers(display: Handle, surface: Handle) -> Boolean;
    }
    passed_on {
        eglBindAPI(api: u32) -> Boolean;
        eglInitialize(display: Handle, major: *mut i32, minor: *mut i32) -> Boolean;
        eglSwapInterval(display: Handle, interval: i32) -> Boolean;
    }
}

/// An EGL surface of the application.
pub struct Surface {
    pbuffer: Handle,
    /// True if this is the window's surface.
    pub is_window: bool,
    size: (i32, i32),
    config: Handle,
    colorspace: Option<i32>,
}

/// An EGL context of the application.
pub struct ContextState {
    /// The share group, which is the same for contexts that share objects.
    pub group: usize,
    lost: bool,
    seen: bool,
}

#[derive(Clone, Copy, Default)]
struct Current {
    draw: Handle,
    read: Handle,
    context: Handle,
}

thread_local! {
    static CURRENT: Cell<Current> = const { Cell::new(Current { draw: 0, read: 0, context: 0 }) };
    /// An error set by the host, which takes precedence over Mesa's.
    static ERROR: Cell<i32> = const { Cell::new(SUCCESS) };
}

/// Returns the share group of the current context, or 0 if there is none.
pub fn current_group() -> usize {
    let context = CURRENT.get().context;
    lock(&host().graphics.contexts).get(&context).map_or(0, |context| context.group)
}

fn real() -> &'static Real {
    &host().graphics.real
}

fn fail<T: Default>(error: i32) -> T {
    ERROR.set(error);
    T::default()
}

/// Returns the attribute pairs before `EGL_NONE`.
///
/// # Safety
/// `attributes` must be null or pairs that end with `EGL_NONE`.
unsafe fn pairs(mut attributes: *const i32) -> Vec<(i32, i32)> {
    let mut pairs = Vec::new();
    // SAFETY: the pointer is not null, and the list has not ended.
    while !attributes.is_null() && unsafe { *attributes } != NONE {
        // SAFETY: a name is followed by its value.
        unsafe {
            pairs.push((*attributes, *attributes.add(1)));
            attributes = attributes.add(2);
        }
    }
    pairs
}

fn list(pairs: &[(i32, i32)]) -> Vec<i32> {
    pairs.iter().flat_map(|(name, value)| [*name, *value]).chain([NONE]).collect()
}

fn value(pairs: &[(i32, i32)], name: i32) -> Option<i32> {
    pairs.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
}

/// Returns the functions that libEGL.so exports.
pub fn exports() -> Vec<Export> {
    exports![System::Egl, 1: [
        eglBindAPI, eglChooseConfig, eglCreateContext, eglCreatePbufferSurface, eglCreateWindowSurface, eglDestroyContext,
        eglDestroySurface, eglGetConfigAttrib, eglGetCurrentContext, eglGetDisplay, eglGetError, eglGetProcAddress, eglInitialize,
        eglMakeCurrent, eglQuerySurface, eglReleaseThread, eglSwapBuffers, eglSwapInterval,
    ]]
}

extern "C" fn eglGetError() -> i32 {
    match ERROR.replace(SUCCESS) {
        // SAFETY: takes nothing.
        SUCCESS => unsafe { (real().eglGetError)() },
        error => error,
    }
}

extern "C" fn eglGetDisplay(_native: *mut c_void) -> Handle {
    // SAFETY: the platform takes no native display and no attributes.
    unsafe { (real().eglGetPlatformDisplay)(PLATFORM_SURFACELESS, std::ptr::null_mut(), std::ptr::null()) }
}

unsafe extern "C" fn eglChooseConfig(
    display: Handle,
    attributes: *const i32,
    configs: *mut Handle,
    size: i32,
    count: *mut i32,
) -> Boolean {
    ERROR.set(SUCCESS);
    // SAFETY: the caller fulfils EGL's contract.
    let mut wanted = unsafe { pairs(attributes) };
    wanted.retain(|(name, _)| !ANDROID_ONLY.contains(name));
    for (name, value) in &mut wanted {
        if *name == SURFACE_TYPE && *value & WINDOW_BIT != 0 {
            *value = *value & !WINDOW_BIT | PBUFFER_BIT;
        }
        if *name == RENDERABLE_TYPE && *value & OPENGL_ES3_BIT != 0 && host().graphics.newest.numbers().0 < 3
        {
            // SAFETY: the caller gives room for one int.
            unsafe { count.write(0) };
            return TRUE;
        }
    }
    let wanted = list(&wanted);
    // SAFETY: the list ends with EGL_NONE. The other arguments are the caller's.
    unsafe { (real().eglChooseConfig)(display, wanted.as_ptr(), configs, size, count) }
}

unsafe extern "C" fn eglGetConfigAttrib(
    display: Handle,
    config: Handle,
    attribute: i32,
    value: *mut i32,
) -> Boolean {
    ERROR.set(SUCCESS);
    // SAFETY: the caller fulfils EGL's contract.
    let result = unsafe { (real().eglGetConfigAttrib)(display, config, attribute, value) };
    if result == TRUE {
        // SAFETY: the call has written the value.
        let value = unsafe { &mut *value };
        match attribute {
            SURFACE_TYPE if *value & PBUFFER_BIT != 0 => *value |= WINDOW_BIT,
            NATIVE_VISUAL_ID => {
                let mut alpha = 0;
                // SAFETY: as above. The value is written to a local variable.
                unsafe { (real().eglGetConfigAttrib)(display, config, ALPHA_SIZE, &raw mut alpha) };
                // WINDOW_FORMAT_RGBA_8888 and _RGBX_8888.
                *value = if alpha > 0 { 1 } else { 2 };
            }
            _ => {}
        }
    }
    result
}

unsafe extern "C" fn eglCreateContext(
    display: Handle,
    config: Handle,
    share: Handle,
    attributes: *const i32,
) -> Handle {
    ERROR.set(SUCCESS);
    let graphics = &host().graphics;
    // SAFETY: the caller fulfils EGL's contract.
    let wanted = unsafe { pairs(attributes) };
    let version = (
        value(&wanted, CONTEXT_MAJOR_VERSION).unwrap_or(1),
        value(&wanted, CONTEXT_MINOR_VERSION).unwrap_or(0),
    );
    if version > graphics.newest.numbers() {
        return fail(BAD_MATCH);
    }
    // SAFETY: the caller fulfils EGL's contract.
    let context = unsafe { (real().eglCreateContext)(display, config, share, attributes) };
    if context != 0 {
        let mut contexts = lock(&graphics.contexts);
        let group = contexts.get(&share).map_or_else(
            || graphics.last_handle.fetch_add(1, Ordering::Relaxed) as usize + 1,
            |context| context.group,
        );
        contexts.insert(context, ContextState { group, lost: false, seen: false });
    }
    context
}

unsafe extern "C" fn eglDestroyContext(display: Handle, context: Handle) -> Boolean {
    ERROR.set(SUCCESS);
    let graphics = &host().graphics;
    let removed = lock(&graphics.contexts).remove(&context);
    if let Some(state) = removed
        && !lock(&graphics.contexts).values().any(|other| other.group == state.group)
    {
        graphics.group_gone(state.group);
    }
    // SAFETY: the caller fulfils EGL's contract.
    unsafe { (real().eglDestroyContext)(display, context) }
}

fn new_pbuffer(display: Handle, config: Handle, size: (i32, i32), colorspace: Option<i32>) -> Handle {
    let mut attributes = vec![(WIDTH, size.0), (HEIGHT, size.1)];
    attributes.extend(colorspace.map(|value| (GL_COLORSPACE, value)));
    let attributes = list(&attributes);
    // SAFETY: the list ends with EGL_NONE.
    unsafe { (real().eglCreatePbufferSurface)(display, config, attributes.as_ptr()) }
}

fn add_surface(surface: Surface) -> Handle {
    if surface.pbuffer == 0 {
        return 0;
    }
    let graphics = &host().graphics;
    let handle = 0x5000_0000 + 16 * (graphics.last_handle.fetch_add(1, Ordering::Relaxed) as usize + 1);
    lock(&graphics.surfaces).insert(handle, surface);
    handle
}

unsafe extern "C" fn eglCreatePbufferSurface(
    display: Handle,
    config: Handle,
    attributes: *const i32,
) -> Handle {
    ERROR.set(SUCCESS);
    // SAFETY: the caller fulfils EGL's contract.
    let wanted = unsafe { pairs(attributes) };
    let size = (value(&wanted, WIDTH).unwrap_or(0), value(&wanted, HEIGHT).unwrap_or(0));
    let colorspace = value(&wanted, GL_COLORSPACE);
    // SAFETY: the caller fulfils EGL's contract.
    let pbuffer = unsafe { (real().eglCreatePbufferSurface)(display, config, attributes) };
    add_surface(Surface { pbuffer, is_window: false, size, config, colorspace })
}

unsafe extern "C" fn eglCreateWindowSurface(
    display: Handle,
    config: Handle,
    window: *const Window,
    attributes: *const i32,
) -> Handle {
    ERROR.set(SUCCESS);
    let host = host();
    if !is_window(window.cast()) || !host.window.is_alive() {
        host.violation("eglCreateWindowSurface with a window that is not there");
        return fail(BAD_NATIVE_WINDOW);
    }
    if host.graphics.live_window_surfaces() > 0 {
        host.violation("eglCreateWindowSurface while another surface of the window exists");
        return fail(BAD_ALLOC);
    }
    // SAFETY: the caller fulfils EGL's contract.
    let colorspace = value(&unsafe { pairs(attributes) }, GL_COLORSPACE);
    let size = host.window.size();
    let handle = add_surface(Surface {
        pbuffer: new_pbuffer(display, config, size, colorspace),
        is_window: true,
        size,
        config,
        colorspace,
    });
    if handle != 0 {
        host.window.reference(1);
    }
    handle
}

unsafe extern "C" fn eglDestroySurface(display: Handle, surface: Handle) -> Boolean {
    ERROR.set(SUCCESS);
    let host = host();
    let Some(surface) = lock(&host.graphics.surfaces).remove(&surface) else {
        host.violation("eglDestroySurface of a surface that does not exist");
        return fail(BAD_SURFACE);
    };
    if surface.is_window {
        host.window.reference(-1);
    }
    // SAFETY: the pbuffer belongs to the host and is destroyed once.
    unsafe { (real().eglDestroySurface)(display, surface.pbuffer) }
}

unsafe extern "C" fn eglMakeCurrent(display: Handle, draw: Handle, read: Handle, context: Handle) -> Boolean {
    ERROR.set(SUCCESS);
    let graphics = &host().graphics;
    let pbuffer = |handle: Handle| {
        if handle == 0 {
            Some(0)
        } else {
            lock(&graphics.surfaces).get(&handle).map(|surface| surface.pbuffer)
        }
    };
    let (Some(draw_buffer), Some(read_buffer)) = (pbuffer(draw), pbuffer(read)) else {
        host().violation("eglMakeCurrent with a surface that does not exist");
        return fail(BAD_SURFACE);
    };
    if lock(&graphics.contexts).get(&context).is_some_and(|context| context.lost) {
        return fail(CONTEXT_LOST);
    }
    // SAFETY: the same contract as this function's, with the surfaces' real handles.
    let result = unsafe { (real().eglMakeCurrent)(display, draw_buffer, read_buffer, context) };
    if result == TRUE {
        CURRENT.set(Current { draw, read, context });
        let first = lock(&graphics.contexts)
            .get_mut(&context)
            .is_some_and(|context| !std::mem::replace(&mut context.seen, true));
        if first {
            gl::watch_context();
        }
    }
    result
}

unsafe extern "C" fn eglReleaseThread() -> Boolean {
    ERROR.set(SUCCESS);
    CURRENT.set(Current::default());
    // SAFETY: takes nothing.
    unsafe { (real().eglReleaseThread)() }
}

extern "C" fn eglGetCurrentContext() -> Handle {
    CURRENT.get().context
}

unsafe extern "C" fn eglQuerySurface(
    display: Handle,
    surface: Handle,
    attribute: i32,
    value: *mut i32,
) -> Boolean {
    ERROR.set(SUCCESS);
    let Some(pbuffer) = lock(&host().graphics.surfaces).get(&surface).map(|surface| surface.pbuffer) else {
        return fail(BAD_SURFACE);
    };
    // SAFETY: the same contract as this function's, with the surface's real handle.
    unsafe { (real().eglQuerySurface)(display, pbuffer, attribute, value) }
}

unsafe extern "C" fn eglSwapBuffers(display: Handle, surface: Handle) -> Boolean {
    ERROR.set(SUCCESS);
    let host = host();
    let graphics = &host.graphics;
    let current = CURRENT.get();
    let Some((pbuffer, is_window, size)) = lock(&graphics.surfaces)
        .get(&surface)
        .map(|surface| (surface.pbuffer, surface.is_window, surface.size))
    else {
        host.violation("eglSwapBuffers of a surface that does not exist");
        return fail(BAD_SURFACE);
    };
    if current.draw != surface {
        host.violation("eglSwapBuffers of a surface that is not current");
        return fail(BAD_SURFACE);
    }
    if is_window && !host.window.is_alive() {
        host.violation("eglSwapBuffers after onNativeWindowDestroyed");
        return fail(BAD_NATIVE_WINDOW);
    }
    {
        let mut contexts = lock(&graphics.contexts);
        if let Some(context) = contexts.get_mut(&current.context) {
            if graphics.loss_asked.swap(false, Ordering::AcqRel) {
                context.lost = true;
            }
            if context.lost {
                return fail(CONTEXT_LOST);
            }
        }
    }
    gl::check_errors();
    if is_window {
        host.frames.present(|| gl::read_default_framebuffer(size.0, size.1));
        gl::spoil_default_framebuffer();
    }
    // SAFETY: the surface is current on this thread.
    let result = unsafe { (real().eglSwapBuffers)(display, pbuffer) };
    if is_window && host.window.size() != size {
        resize(display, surface, current);
    }
    result
}

/// Gives a window's surface a new pbuffer after the window's size has changed, like the next buffer on Android.
fn resize(display: Handle, handle: Handle, current: Current) {
    let graphics = &host().graphics;
    let size = host().window.size();
    let mut surfaces = lock(&graphics.surfaces);
    let Some(surface) = surfaces.get_mut(&handle) else { return };
    let pbuffer = new_pbuffer(display, surface.config, size, surface.colorspace);
    if pbuffer == 0 {
        host().violation(format!("the host has no memory for a window of {}x{}", size.0, size.1));
        return;
    }
    let old = std::mem::replace(&mut surface.pbuffer, pbuffer);
    surface.size = size;
    let read = if current.read == handle {
        Some(pbuffer)
    } else {
        surfaces.get(&current.read).map(|surface| surface.pbuffer)
    };
    // SAFETY: the surfaces are live, and the context is current on this thread. The old pbuffer is destroyed once.
    unsafe {
        (real().eglMakeCurrent)(display, pbuffer, read.unwrap_or(pbuffer), current.context);
        (real().eglDestroySurface)(display, old);
    }
}

unsafe extern "C" fn eglGetProcAddress(name: *const c_char) -> *const c_void {
    ERROR.set(SUCCESS);
    // SAFETY: a terminated name by contract.
    let text = unsafe { CStr::from_ptr(name) }.to_str().unwrap_or("");
    if text.starts_with("egl") {
        if let Some(address) = crate::exports::find(System::Egl, text, host().device.sdk) {
            return address as *const c_void;
        }
        // SAFETY: the caller fulfils EGL's contract.
        return unsafe { (real().eglGetProcAddress)(name) };
    }
    gl::function(text).map_or(std::ptr::null(), |address| address as *const c_void)
}

/// Returns Mesa's function with this name, or null.
pub fn real_function(name: &CStr) -> *const c_void {
    // SAFETY: a terminated name.
    unsafe { (real().eglGetProcAddress)(name.as_ptr()) }
}
