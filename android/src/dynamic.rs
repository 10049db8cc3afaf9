//! Functions that are found by name: those of libandroid that not every version of Android has, and whole libraries
//! that are rarely used.

use std::ffi::{CStr, c_void};
use std::mem;

/// One of Android's own libraries, which is never unloaded.
pub struct Library(*mut c_void);

impl Library {
    /// Opens a library by its name; without it, it has no functions.
    pub fn open(name: &CStr) -> Library {
        // SAFETY: a name that ends in zero; Android's libraries may be loaded on any thread.
        Library(unsafe { libc::dlopen(name.as_ptr(), libc::RTLD_NOW) })
    }

    /// Opens libandroid, which every process with an activity has.
    pub fn android() -> Library {
        Library::open(c"libandroid.so")
    }

    /// Returns a function by its name; none if this Android does not have it.
    ///
    /// # Safety
    /// `F` must be a function pointer of the type that the NDK declares for the name.
    pub unsafe fn function<F: Copy>(&self, name: &CStr) -> Option<F> {
        const { assert!(size_of::<F>() == size_of::<*mut c_void>()) };
        if self.0.is_null() {
            return None;
        }
        // SAFETY: the handle is live and the name ends in zero.
        let address = unsafe { libc::dlsym(self.0, name.as_ptr()) };
        // SAFETY: not null; the caller names the type that the NDK declares.
        (!address.is_null()).then(|| unsafe { mem::transmute_copy::<*mut c_void, F>(&address) })
    }
}
