//! AAssetManager: the files in the APK's folder `assets`, read from the beginning to the end.

#![allow(non_snake_case)]

use std::ffi::{CStr, c_char, c_int, c_void};

use crate::exports::{Export, System, exports};
use crate::host::host;

/// An open asset.
struct Asset {
    content: &'static [u8],
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![
        System::Android, 1: [AAssetManager_fromJava, AAssetManager_open, AAsset_close, AAsset_read];
    ]
}

extern "C" fn AAssetManager_fromJava(_env: *const c_void, object: *const c_void) -> *const c_void {
    if object.is_null() { std::ptr::null() } else { std::ptr::dangling() }
}

unsafe extern "C" fn AAssetManager_open(
    _manager: *const c_void,
    name: *const c_char,
    _mode: c_int,
) -> *mut Asset {
    // SAFETY: by contract the name is a text that ends with zero.
    let name = unsafe { CStr::from_ptr(name) }.to_string_lossy();
    let Some(content) = host().assets.get(&*name) else { return std::ptr::null_mut() };
    host().count("assets", 1);
    Box::into_raw(Box::new(Asset { content }))
}

unsafe extern "C" fn AAsset_read(asset: &mut Asset, to: *mut u8, count: usize) -> c_int {
    let (now, later) = asset.content.split_at(count.min(asset.content.len()));
    // SAFETY: the caller gives room for `count` bytes.
    unsafe { std::ptr::copy_nonoverlapping(now.as_ptr(), to, now.len()) };
    asset.content = later;
    now.len() as c_int
}

unsafe extern "C" fn AAsset_close(asset: *mut Asset) {
    host().count("assets", -1);
    // SAFETY: by contract the asset was opened by `AAssetManager_open` and is closed once.
    drop(unsafe { Box::from_raw(asset) });
}
