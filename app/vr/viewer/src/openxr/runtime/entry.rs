//! Adapts the runtime's `xrGetInstanceProcAddr` to what the crate `openxr` expects.
//!
//! Khronos's loader itself provides the functions that need no instance, so a runtime may never have been asked for
//! them with an instance. The crate does ask for them with one after it has created it, and assumes that success always
//! comes with a function. The function here, between the two, handles both.

use std::ffi::{CStr, c_char};
use std::mem;
use std::sync::atomic::{AtomicUsize, Ordering};

use openxr::sys::{self, Handle as _, pfn};

/// Functions that need no instance ("xrGetInstanceProcAddr", table of the null instance).
const GLOBAL: [&CStr; 3] =
    [c"xrCreateInstance", c"xrEnumerateApiLayerProperties", c"xrEnumerateInstanceExtensionProperties"];

/// The address of the `xrGetInstanceProcAddr` in use; 0 if there is none. It is global because a process has one active
/// runtime, and functions of the API carry no context.
static RUNTIME: AtomicUsize = AtomicUsize::new(0);

/// Returns an entry to the API through a runtime's function.
///
/// # Safety
/// `runtime` must be the `xrGetInstanceProcAddr` of a runtime or loader that is never unloaded.
pub(super) unsafe fn open(runtime: pfn::GetInstanceProcAddr) -> openxr::Result<openxr::Entry> {
    RUNTIME.store(runtime as usize, Ordering::Release);
    // SAFETY: `get` answers as the runtime does, and as the specification requires where the runtime does not.
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
    // SAFETY: the caller passes a null-terminated string.
    let wanted = unsafe { CStr::from_ptr(name) };
    if wanted == c"xrGetInstanceProcAddr" {
        // SAFETY: the caller provides room for a function pointer, and casts it to the type that belongs to the name.
        unsafe { *function = Some(mem::transmute::<pfn::GetInstanceProcAddr, pfn::VoidFunction>(get)) };
        return sys::Result::SUCCESS;
    }
    let instance = if GLOBAL.contains(&wanted) { sys::Instance::NULL } else { instance };
    // SAFETY: the arguments are the caller's, except that functions of `GLOBAL` get the null instance.
    let result = unsafe { runtime(instance, name, function) };
    // SAFETY: the caller's room for the function is valid, as above.
    if result == sys::Result::SUCCESS && unsafe { (*function).is_none() } {
        return sys::Result::ERROR_FUNCTION_UNSUPPORTED;
    }
    result
}
