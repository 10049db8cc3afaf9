//! The runtime's `xrGetInstanceProcAddr` as the crate `openxr` needs it.
//!
//! Khronos's loader answers for the functions that need no instance by itself, so that a runtime may never have been
//! asked for them with one. The crate does ask so when it has made an instance, and takes a success without a function
//! for impossible. Between them stands a function of our own.

use std::ffi::{CStr, c_char};
use std::mem;
use std::sync::atomic::{AtomicUsize, Ordering};

use openxr::sys::{self, Handle as _, pfn};

/// Functions that need no instance ("xrGetInstanceProcAddr", table of the null instance).
const GLOBAL: [&CStr; 3] =
    [c"xrCreateInstance", c"xrEnumerateApiLayerProperties", c"xrEnumerateInstanceExtensionProperties"];

/// `xrGetInstanceProcAddr` of the runtime in use, as an address; 0 for none. A process has one active runtime, and
/// functions in the API carry no context.
static RUNTIME: AtomicUsize = AtomicUsize::new(0);

/// Returns an entry to the API by a runtime's function.
///
/// # Safety
/// It is the `xrGetInstanceProcAddr` of a runtime or loader that is never unloaded.
pub(super) unsafe fn open(runtime: pfn::GetInstanceProcAddr) -> openxr::Result<openxr::Entry> {
    RUNTIME.store(runtime as usize, Ordering::Release);
    // SAFETY: it answers as the runtime does, and where it does not, as the specification says.
    unsafe { openxr::Entry::from_get_instance_proc_addr(get, &()) }
}

unsafe extern "system" fn get(
    instance: sys::Instance,
    name: *const c_char,
    function: *mut Option<pfn::VoidFunction>,
) -> sys::Result {
    let address = RUNTIME.load(Ordering::Acquire);
    if address == 0 || name.is_null() || function.is_null() {
        return sys::Result::ERROR_VALIDATION_FAILURE;
    }
    // SAFETY: `open` has stored a function of this type.
    let runtime = unsafe { mem::transmute::<usize, pfn::GetInstanceProcAddr>(address) };
    // SAFETY: the caller gives a text that ends with 0.
    let wanted = unsafe { CStr::from_ptr(name) };
    if wanted == c"xrGetInstanceProcAddr" {
        // SAFETY: the caller gives room for a function, which callers cast to the type that belongs to its name.
        unsafe { *function = Some(mem::transmute::<pfn::GetInstanceProcAddr, pfn::VoidFunction>(get)) };
        return sys::Result::SUCCESS;
    }
    let instance = if GLOBAL.contains(&wanted) { sys::Instance::NULL } else { instance };
    // SAFETY: the caller's arguments, but for an instance that these functions do not need.
    let result = unsafe { runtime(instance, name, function) };
    // SAFETY: the runtime has been given the same room.
    if result == sys::Result::SUCCESS && unsafe { (*function).is_none() } {
        return sys::Result::ERROR_FUNCTION_UNSUPPORTED;
    }
    result
}
