//! Functions of libandroid that not every version of Android has.

use std::ffi::{CStr, c_void};
use std::mem;

/// libandroid, which is loaded anyway and never unloaded.
pub struct Library(*mut c_void);

impl Library {
    /// Opens libandroid.
    pub fn open() -> Library {
        // SAFETY: a name that ends in zero; the library is a part of every process with an activity.
        Library(unsafe { libc::dlopen(c"libandroid.so".as_ptr(), libc::RTLD_NOW) })
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
