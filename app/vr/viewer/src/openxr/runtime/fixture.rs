//! A library that the finder's tests compile: good and bad runtimes in one file. A manifest chooses one of them by
//! renaming functions.

use std::ffi::{CStr, c_char, c_void};

const SUCCESS: i32 = 0;
const RUNTIME_FAILURE: i32 = -2;
const FUNCTION_UNSUPPORTED: i32 = -7;

#[repr(C)]
pub struct LoaderInfo {
    struct_type: u32,
    struct_version: u32,
    struct_size: usize,
    min_interface: u32,
    max_interface: u32,
    min_api: u64,
    max_api: u64,
}

#[repr(C)]
pub struct RuntimeRequest {
    struct_type: u32,
    struct_version: u32,
    struct_size: usize,
    interface: u32,
    api: u64,
    get: Option<Get>,
}

type Get = extern "C" fn(u64, *const c_char, *mut *const c_void) -> i32;

const fn version(major: u64, minor: u64, patch: u64) -> u64 {
    major << 48 | minor << 32 | patch
}

#[no_mangle]
pub extern "C" fn xrNegotiateLoaderRuntimeInterface(info: &LoaderInfo, request: &mut RuntimeRequest) -> i32 {
    let complete = info.struct_type == 1
        && info.struct_size == size_of::<LoaderInfo>()
        && request.struct_type == 3
        && request.struct_size == size_of::<RuntimeRequest>()
        && info.min_interface <= 1
        && info.max_interface >= 1
        && (info.min_api..=info.max_api).contains(&version(1, 1, 54));
    if !complete {
        return RUNTIME_FAILURE;
    }
    request.interface = 1;
    request.api = version(1, 1, 54);
    request.get = Some(xrGetInstanceProcAddr);
    SUCCESS
}

#[no_mangle]
pub extern "C" fn negotiate_refuse(_: &LoaderInfo, _: &mut RuntimeRequest) -> i32 {
    RUNTIME_FAILURE
}

#[no_mangle]
pub extern "C" fn negotiate_other_interface(info: &LoaderInfo, request: &mut RuntimeRequest) -> i32 {
    xrNegotiateLoaderRuntimeInterface(info, request);
    request.interface = 2;
    SUCCESS
}

#[no_mangle]
pub extern "C" fn negotiate_openxr_2(info: &LoaderInfo, request: &mut RuntimeRequest) -> i32 {
    xrNegotiateLoaderRuntimeInterface(info, request);
    request.api = version(2, 0, 0);
    SUCCESS
}

#[no_mangle]
pub extern "C" fn negotiate_nothing(info: &LoaderInfo, request: &mut RuntimeRequest) -> i32 {
    xrNegotiateLoaderRuntimeInterface(info, request);
    request.get = None;
    SUCCESS
}

#[repr(C)]
pub struct LoaderInit {
    ty: u32,
    next: *const c_void,
    vm: *const u32,
    activity: *const u32,
}

/// Reads through the two Java pointers, so that a test can see that they arrived.
#[no_mangle]
pub extern "C" fn initialize(init: &LoaderInit) -> i32 {
    let arrived = unsafe { init.ty == 1000089000 && *init.vm == 17 && *init.activity == 4 };
    if arrived { SUCCESS } else { RUNTIME_FAILURE }
}

#[no_mangle]
pub extern "C" fn initialize_refuse(_: &LoaderInit) -> i32 {
    RUNTIME_FAILURE
}

extern "C" fn create_instance(_: *const c_void, _: *mut u64) -> i32 {
    RUNTIME_FAILURE
}

extern "C" fn enumerate_extensions(_: *const c_char, _: u32, count: &mut u32, _: *mut c_void) -> i32 {
    *count = 0;
    SUCCESS
}

#[no_mangle]
pub extern "C" fn xrGetInstanceProcAddr(_: u64, name: *const c_char, function: *mut *const c_void) -> i32 {
    let name = unsafe { CStr::from_ptr(name) };
    let found = match name.to_bytes() {
        b"xrCreateInstance" => create_instance as *const c_void,
        b"xrEnumerateInstanceExtensionProperties" => enumerate_extensions as *const c_void,
        b"xrInitializeLoaderKHR" => initialize as *const c_void,
        _ => return FUNCTION_UNSUPPORTED,
    };
    unsafe { *function = found };
    SUCCESS
}
