//! Loaders without some functions, drivers without memory, and threads without a context.

mod common;

use std::cell::{Cell, RefCell};
use std::ffi::{CStr, c_char, c_void};
use std::mem::transmute;
use std::ptr::null_mut;

use common::{gl_info, good_eyes, views_of};
use yoro_c::*;
use yoro_context::{Backend, Headless};

type Noted = Vec<(YoroResult, String)>;

thread_local! {
    static CONTEXT: RefCell<Option<Headless>> = const { RefCell::new(None) };
    /// True for the names that [`load_some`] returns.
    static IS_LOADED: Cell<fn(&CStr) -> bool> = const { Cell::new(|_| true) };
    static HIDDEN: Cell<Option<&'static CStr>> = const { Cell::new(None) };
}

unsafe extern "C" fn load_some(name: *const c_char) -> YoroGlProc {
    // SAFETY: a C string, as the caller promises.
    let name = unsafe { CStr::from_ptr(name) };
    // Some functions also have a name that ends in KHR.
    let is =
        |hidden: &CStr| name.to_bytes().strip_suffix(b"KHR").unwrap_or(name.to_bytes()) == hidden.to_bytes();
    if !IS_LOADED.get()(name) || HIDDEN.get().is_some_and(is) {
        return None;
    }
    CONTEXT.with_borrow(|context| {
        let function = context.as_ref().unwrap().entry_point(name);
        // SAFETY: a function, or null.
        unsafe { transmute::<*const c_void, YoroGlProc>(function) }
    })
}

/// Runs `body` with a current context.
fn with_context(backend: Backend, body: impl FnOnce(&glow::Context, bool)) {
    CONTEXT.set(Some(Headless::open(backend).unwrap()));
    let gl = CONTEXT.with_borrow(|context| context.as_ref().unwrap().gl().clone());
    body(gl.raw(), backend == Backend::Osmesa);
    drop(gl);
    CONTEXT.set(None);
}

fn backends() -> &'static [Backend] {
    // `cargo xtask test` prints this on systems without OSMesa.
    if std::env::var_os("YORO_TEST_WITHOUT_OSMESA").is_some() {
        &[Backend::Egl]
    } else {
        &[Backend::Egl, Backend::Osmesa]
    }
}

/// Creates a context, or returns the code and the message of the failure.
fn create(info: &YoroGlInfo, noted: &mut Noted) -> Result<*mut YoroContext, (YoroResult, String)> {
    let mut context = null_mut();
    // SAFETY: a complete structure, and a context is current.
    match unsafe { yoro_gl_create(info, &mut context) } {
        YORO_OK => Ok(context),
        _ => Err(noted.pop().unwrap()),
    }
}

/// Returns views, and images of their sizes.
fn views_and_images(gl: &glow::Context) -> (YoroViews, YoroGlImages) {
    let views = views_of(&good_eyes()).unwrap();
    let size = [views.source.width, views.source.height];
    (views, common::images(gl, glow::RGBA8, size, [160, 120]))
}

/// Only functions that are checked for at first are called. glow would panic otherwise.
#[test]
fn the_needed_functions_are_enough() {
    fn is_needed<const DESKTOP: bool>(name: &CStr) -> bool {
        needed_functions(DESKTOP).any(|needed| needed == name)
    }
    for &backend in backends() {
        with_context(backend, |gl, desktop| {
            IS_LOADED.set(if desktop { is_needed::<true> } else { is_needed::<false> });
            let (views, images) = views_and_images(gl);
            for state in [YORO_GL_STATE_LEAVE, YORO_GL_STATE_PRESERVE] {
                let mut noted = Vec::new();
                let outputs = YORO_OUTPUT_DEPTH | YORO_OUTPUT_SRGB;
                let info = YoroGlInfo { state, outputs, loader: Some(load_some), ..gl_info(&mut noted) };
                let context = create(&info, &mut noted).unwrap();
                // SAFETY: alive until the last line, complete structures, a current context.
                unsafe {
                    assert_eq!(yoro_gl_prepare(context, &views.warp), YORO_OK, "{noted:?}");
                    assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_OK, "{noted:?}");
                    assert_eq!(yoro_destroy(context), YORO_OK);
                }
            }
        });
    }
}

#[test]
fn a_function_that_the_loader_lacks_is_named() {
    for &backend in backends() {
        with_context(backend, |_, desktop| {
            for name in needed_functions(desktop) {
                let mut noted = Vec::new();
                let info = YoroGlInfo { loader: Some(load_some), ..gl_info(&mut noted) };
                HIDDEN.set(Some(name));
                let made = create(&info, &mut noted);
                HIDDEN.set(None);
                let (code, sentence) = made.unwrap_err();
                assert_eq!(code, YORO_ERROR_NO_CONTEXT, "{name:?}: {sentence}");
                assert!(sentence.contains(name.to_str().unwrap()), "{sentence}");
            }
        });
    }
}

#[test]
fn a_driver_without_memory_has_its_own_code() {
    thread_local! {
        static IS_FULL: Cell<bool> = const { Cell::new(false) };
    }
    unsafe extern "system" fn no_storage(target: u32, levels: i32, format: u32, w: i32, h: i32) {
        let name = if IS_FULL.get() { c"glEnable" } else { c"glTexStorage2D" };
        let function = CONTEXT.with_borrow(|context| context.as_ref().unwrap().entry_point(name));
        // SAFETY: the entry point of this name. The call without storage raises an error as a driver would.
        unsafe {
            if IS_FULL.get() {
                transmute::<*const c_void, unsafe extern "system" fn(u32)>(function)(0x1234);
            } else {
                transmute::<*const c_void, unsafe extern "system" fn(u32, i32, u32, i32, i32)>(function)(
                    target, levels, format, w, h,
                );
            }
        }
    }
    unsafe extern "system" fn error() -> u32 {
        let function = CONTEXT.with_borrow(|context| context.as_ref().unwrap().entry_point(c"glGetError"));
        // SAFETY: the entry point of this name.
        match unsafe { transmute::<*const c_void, unsafe extern "system" fn() -> u32>(function)() } {
            glow::INVALID_ENUM => glow::OUT_OF_MEMORY,
            other => other,
        }
    }
    unsafe extern "C" fn load_full(name: *const c_char) -> YoroGlProc {
        // SAFETY: a C string; functions of the signatures that GL gives them.
        unsafe {
            match CStr::from_ptr(name).to_str().unwrap() {
                "glTexStorage2D" => transmute::<*const (), YoroGlProc>(no_storage as *const ()),
                "glGetError" => transmute::<*const (), YoroGlProc>(error as *const ()),
                _ => load_some(name),
            }
        }
    }
    with_context(Backend::Egl, |gl, _| {
        let mut noted = Vec::new();
        let info = YoroGlInfo { loader: Some(load_full), check: 0, ..gl_info(&mut noted) };
        let context = create(&info, &mut noted).unwrap();
        let (views, images) = views_and_images(gl);
        // SAFETY: alive until the last line, complete structures, a current context.
        unsafe {
            IS_FULL.set(true);
            assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_ERROR_MEMORY, "{noted:?}");
            IS_FULL.set(false);
            assert_eq!(yoro_gl_synthesize(context, &views.warp, &images), YORO_OK, "{noted:?}");
            assert_eq!(yoro_destroy(context), YORO_OK);
        }
    });
}

/// With `check`, the error is about the thread, not about a texture that is right.
#[test]
fn a_thread_without_a_context_is_told() {
    struct Shared(*mut YoroContext, YoroViews, YoroGlImages);
    // SAFETY: a context may be called from any thread, one at a time. The call is refused.
    unsafe impl Send for Shared {}
    with_context(Backend::Egl, |gl, _| {
        let mut noted = Vec::new();
        let info = YoroGlInfo { loader: Some(load_some), ..gl_info(&mut noted) };
        let context = create(&info, &mut noted).unwrap();
        let (views, images) = views_and_images(gl);
        let shared = Shared(context, views, images);
        let codes = std::thread::spawn(move || {
            let Shared(context, views, images) = { shared };
            // SAFETY: alive, and complete structures.
            unsafe {
                [yoro_gl_prepare(context, &views.warp), yoro_gl_synthesize(context, &views.warp, &images)]
            }
        })
        .join()
        .unwrap();
        assert_eq!(codes, [YORO_ERROR_NO_CONTEXT; 2]);
        // SAFETY: alive.
        unsafe { assert_eq!(yoro_destroy(context), YORO_OK) };
        assert!(noted.iter().all(|(_, sentence)| sentence.contains("thread")), "{noted:?}");
    });
}
