//! ANativeWindow: a single window, drawn by Mesa.

#![allow(non_snake_case)]

use std::ffi::{c_int, c_void};
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicI64, Ordering};

use crate::exports::{Export, System, exports};
use crate::host::host;

/// The activity's window.
pub struct Window {
    width: AtomicI32,
    height: AtomicI32,
    references: AtomicI64,
    alive: AtomicBool,
}

impl Window {
    /// Creates the window, which does not exist yet for the application.
    pub fn new(width: i32, height: i32) -> Self {
        Self {
            width: width.into(),
            height: height.into(),
            references: AtomicI64::new(0),
            alive: AtomicBool::new(false),
        }
    }

    /// Returns width and height in pixels.
    pub fn size(&self) -> (i32, i32) {
        (self.width.load(Ordering::Acquire), self.height.load(Ordering::Acquire))
    }

    /// Changes the size. Surfaces are resized at their next swap.
    pub fn resize(&self, width: i32, height: i32) {
        self.width.store(width, Ordering::Release);
        self.height.store(height, Ordering::Release);
    }

    /// True between `onNativeWindowCreated` and the end of `onNativeWindowDestroyed`.
    pub fn is_alive(&self) -> bool {
        self.alive.load(Ordering::Acquire)
    }

    /// Makes the window exist or not.
    pub fn set_alive(&self, alive: bool) {
        self.alive.store(alive, Ordering::Release);
    }

    /// Returns the number of references held by the application and its surfaces.
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
        System::Android, 1: [ANativeWindow_acquire, ANativeWindow_release];
        System::Android, 30: [ANativeWindow_setFrameRate];
    ]
}

/// True if this is the window's address.
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

extern "C" fn ANativeWindow_setFrameRate(window: &Window, rate: f32, _compatibility: i8) -> c_int {
    known(window);
    host().request(format!("{rate} Hz"));
    0
}
