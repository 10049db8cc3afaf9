//! ANativeWindow: one window, whose surface is drawn by Mesa.

#![allow(non_snake_case)]

use std::ffi::{c_int, c_void};
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicI64, Ordering};

use crate::exports::{Export, System, exports};
use crate::host::host;

/// The window of the activity.
pub struct Window {
    width: AtomicI32,
    height: AtomicI32,
    format: AtomicI32,
    data_space: AtomicI32,
    references: AtomicI64,
    alive: AtomicBool,
}

impl Window {
    /// A window that is not there yet.
    pub fn new(width: i32, height: i32) -> Self {
        Self {
            width: width.into(),
            height: height.into(),
            format: AtomicI32::new(1),
            data_space: AtomicI32::new(0),
            references: AtomicI64::new(0),
            alive: AtomicBool::new(false),
        }
    }

    /// Pixels.
    pub fn size(&self) -> (i32, i32) {
        (self.width.load(Ordering::Acquire), self.height.load(Ordering::Acquire))
    }

    /// Changes the size; surfaces follow at their next swap.
    pub fn resize(&self, width: i32, height: i32) {
        self.width.store(width, Ordering::Release);
        self.height.store(height, Ordering::Release);
    }

    /// Between `onNativeWindowCreated` and the end of `onNativeWindowDestroyed`.
    pub fn is_alive(&self) -> bool {
        self.alive.load(Ordering::Acquire)
    }

    /// Makes the window appear or go.
    pub fn set_alive(&self, alive: bool) {
        self.alive.store(alive, Ordering::Release);
    }

    /// References that the application and its surfaces hold.
    pub fn references(&self) -> i64 {
        self.references.load(Ordering::Acquire)
    }

    /// Adds `change` references, or removes them if it is negative.
    pub fn reference(&self, change: i64) {
        if self.references.fetch_add(change, Ordering::AcqRel) + change < 0 {
            host().violation("ANativeWindow_release without a reference");
        }
    }
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 1: [
            ANativeWindow_acquire, ANativeWindow_getFormat, ANativeWindow_getHeight, ANativeWindow_getWidth, ANativeWindow_release,
            ANativeWindow_setBuffersGeometry,
        ];
        System::Android, 28: [ANativeWindow_getBuffersDataSpace, ANativeWindow_setBuffersDataSpace];
        System::Android, 30: [ANativeWindow_setFrameRate];
        System::Android, 31: [ANativeWindow_setFrameRateWithChangeStrategy];
    ]
}

/// True if the pointer is the window's.
pub fn is_window(window: *const c_void) -> bool {
    std::ptr::eq(window, (&raw const host().window).cast())
}

fn known(window: &Window) {
    if !is_window(std::ptr::from_ref(window).cast()) {
        crate::host::fatal("the application passed a native window that the host never gave it");
    }
}

extern "C" fn ANativeWindow_acquire(window: &Window) {
    known(window);
    window.reference(1);
}

extern "C" fn ANativeWindow_release(window: &Window) {
    known(window);
    window.reference(-1);
}

extern "C" fn ANativeWindow_getWidth(window: &Window) -> i32 {
    known(window);
    window.size().0
}

extern "C" fn ANativeWindow_getHeight(window: &Window) -> i32 {
    known(window);
    window.size().1
}

extern "C" fn ANativeWindow_getFormat(window: &Window) -> i32 {
    known(window);
    window.format.load(Ordering::Relaxed)
}

/// Zero for both sizes is the window's own; a smaller buffer that the display scales is not simulated.
extern "C" fn ANativeWindow_setBuffersGeometry(window: &Window, width: i32, height: i32, format: i32) -> i32 {
    known(window);
    if (width, height) != (0, 0) && (width, height) != window.size() {
        host().violation(format!(
            "ANativeWindow_setBuffersGeometry({width}, {height}): the host does not simulate scaled buffers"
        ));
    }
    if format != 0 {
        window.format.store(format, Ordering::Relaxed);
    }
    0
}

extern "C" fn ANativeWindow_setBuffersDataSpace(window: &Window, data_space: i32) -> i32 {
    known(window);
    window.data_space.store(data_space, Ordering::Relaxed);
    0
}

extern "C" fn ANativeWindow_getBuffersDataSpace(window: &Window) -> i32 {
    known(window);
    window.data_space.load(Ordering::Relaxed)
}

extern "C" fn ANativeWindow_setFrameRate(window: &Window, rate: f32, _compatibility: i8) -> c_int {
    known(window);
    host().request(format!("{rate} Hz"));
    0
}

extern "C" fn ANativeWindow_setFrameRateWithChangeStrategy(
    window: &Window,
    rate: f32,
    compatibility: i8,
    _strategy: i8,
) -> c_int {
    ANativeWindow_setFrameRate(window, rate, compatibility)
}
