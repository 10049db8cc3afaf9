//! Functions that are looked up by name: those of libandroid that not every version of Android has, and whole libraries
//! that are rarely used.

use std::ffi::{CStr, c_void};
use std::mem;

/// One of Android's own libraries. It is never unloaded.
pub struct Library(*mut c_void);

impl Library {
    /// Opens a library by its name. If that fails, no function will be found in it.
    pub fn open(name: &CStr) -> Library {
        // SAFETY: the name is null-terminated; Android's libraries may be loaded on any thread.
        Library(unsafe { libc::dlopen(name.as_ptr(), libc::RTLD_NOW) })
    }

    /// Opens libandroid, which every process with an activity has.
    pub fn android() -> Library {
        Library::open(c"libandroid.so")
    }

    /// Returns a function by its name; `None` if this version of Android does not have it.
    ///
    /// # Safety
    /// `F` must be a function pointer of the type that the NDK declares for the name.
    pub unsafe fn function<F: Copy>(&self, name: &CStr) -> Option<F> {
        const { assert!(size_of::<F>() == size_of::<*mut c_void>()) };
        if self.0.is_null() {
            return None;
        }
        // SAFETY: the handle is live and the name null-terminated.
        let address = unsafe { libc::dlsym(self.0, name.as_ptr()) };
        // SAFETY: the address is not null, and the caller guarantees the type.
        (!address.is_null()).then(|| unsafe { mem::transmute_copy::<*mut c_void, F>(&address) })
    }
}
