//! AAssetManager: the assets of the APK.

#![allow(non_snake_case)]

use std::collections::BTreeMap;
use std::ffi::{CString, c_char, c_int, c_long, c_void};

use crate::bionic::text;
use crate::exports::{Export, System, exports};
use crate::host::host;

/// The files.
pub struct Assets(BTreeMap<String, Vec<u8>>);

impl Assets {
    /// Returns the assets with these contents, by path below `assets/`.
    pub fn new(files: BTreeMap<String, Vec<u8>>) -> Self {
        Self(files)
    }
}

/// An open file.
pub struct AAsset {
    bytes: &'static [u8],
    at: usize,
}

/// An open folder.
pub struct AAssetDir {
    names: Vec<CString>,
    next: usize,
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![System::Android, 1: [
        AAssetDir_close, AAssetDir_getNextFileName, AAssetDir_rewind, AAssetManager_fromJava, AAssetManager_open, AAssetManager_openDir,
        AAsset_close, AAsset_getBuffer, AAsset_getLength, AAsset_getLength64, AAsset_getRemainingLength, AAsset_getRemainingLength64,
        AAsset_isAllocated, AAsset_openFileDescriptor, AAsset_read, AAsset_seek, AAsset_seek64,
    ]]
}

extern "C" fn AAssetManager_fromJava(_env: *const c_void, object: *const c_void) -> *const Assets {
    if object.is_null() { std::ptr::null() } else { &raw const host().assets }
}

unsafe extern "C" fn AAssetManager_open(
    _manager: *const Assets,
    name: *const c_char,
    _mode: c_int,
) -> *mut AAsset {
    let host = host();
    // SAFETY: a terminated name by contract.
    let Some(bytes) = host.assets.0.get(&unsafe { text(name) }) else { return std::ptr::null_mut() };
    host.count("assets", 1);
    Box::into_raw(Box::new(AAsset { bytes, at: 0 }))
}

/// Opens a folder. Like Android's, it lists only files, not folders.
unsafe extern "C" fn AAssetManager_openDir(_manager: *const Assets, name: *const c_char) -> *mut AAssetDir {
    let host = host();
    // SAFETY: a terminated name by contract.
    let folder = unsafe { text(name) };
    let names = host.assets.0.keys().filter_map(|path| {
        let (parent, file) = path.rsplit_once('/').unwrap_or(("", path));
        (parent == folder.trim_end_matches('/')).then(|| CString::new(file).unwrap_or_default())
    });
    host.count("asset folders", 1);
    Box::into_raw(Box::new(AAssetDir { names: names.collect(), next: 0 }))
}

extern "C" fn AAssetDir_getNextFileName(folder: &mut AAssetDir) -> *const c_char {
    folder.next += 1;
    folder.names.get(folder.next - 1).map_or(std::ptr::null(), |name| name.as_ptr())
}

extern "C" fn AAssetDir_rewind(folder: &mut AAssetDir) {
    folder.next = 0;
}

unsafe extern "C" fn AAssetDir_close(folder: *mut AAssetDir) {
    host().count("asset folders", -1);
    // SAFETY: made by openDir and closed once by contract.
    drop(unsafe { Box::from_raw(folder) });
}

unsafe extern "C" fn AAsset_read(asset: &mut AAsset, buffer: *mut u8, count: usize) -> c_int {
    let count = count.min(asset.bytes.len() - asset.at);
    // SAFETY: the caller gives room for `count` bytes, and the asset has as many from `at` on.
    unsafe { std::ptr::copy_nonoverlapping(asset.bytes.as_ptr().add(asset.at), buffer, count) };
    asset.at += count;
    count as c_int
}

extern "C" fn AAsset_seek64(asset: &mut AAsset, offset: i64, whence: c_int) -> i64 {
    let from = match whence {
        libc::SEEK_SET => 0,
        libc::SEEK_CUR => asset.at as i64,
        libc::SEEK_END => asset.bytes.len() as i64,
        _ => return -1,
    };
    match from.checked_add(offset).and_then(|at| usize::try_from(at).ok()) {
        Some(at) if at <= asset.bytes.len() => {
            asset.at = at;
            at as i64
        }
        _ => -1,
    }
}

extern "C" fn AAsset_seek(asset: &mut AAsset, offset: c_long, whence: c_int) -> c_long {
    AAsset_seek64(asset, offset, whence)
}

extern "C" fn AAsset_getLength64(asset: &AAsset) -> i64 {
    asset.bytes.len() as i64
}

extern "C" fn AAsset_getLength(asset: &AAsset) -> c_long {
    AAsset_getLength64(asset)
}

extern "C" fn AAsset_getRemainingLength64(asset: &AAsset) -> i64 {
    (asset.bytes.len() - asset.at) as i64
}

extern "C" fn AAsset_getRemainingLength(asset: &AAsset) -> c_long {
    AAsset_getRemainingLength64(asset)
}

extern "C" fn AAsset_getBuffer(asset: &AAsset) -> *const u8 {
    asset.bytes.as_ptr()
}

extern "C" fn AAsset_isAllocated(_asset: &AAsset) -> c_int {
    1
}

/// Fails like compressed assets on Android.
extern "C" fn AAsset_openFileDescriptor(_asset: &AAsset, _start: *mut c_long, _length: *mut c_long) -> c_int {
    -1
}

unsafe extern "C" fn AAsset_close(asset: *mut AAsset) {
    host().count("assets", -1);
    // SAFETY: made by open and closed once by contract.
    drop(unsafe { Box::from_raw(asset) });
}
