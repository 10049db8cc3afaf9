//! A headset: the answers of the runtime broker, and the library that they name.
//!
//! The library is the simulated runtime of `tests/openxr-stub`. It is a library for this machine rather than for
//! Android, but the application can load it, since its functions are called in the same way. Frames pass the same gate
//! as a window's.

use std::ffi::{CStr, CString, c_char, c_void};
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, OnceLock};

use anyhow::{Context, Result};

use crate::host::{ABI, host};
use crate::jni::{Cursor, Data, Object};
use crate::script::OpenXr;

const FILE: &str = "libyoro_openxr_stub.so";
const PACKAGE: &str = "org.yoro.simulated.runtime";
const USER_BROKER: &str = "org.khronos.openxr.runtime_broker";
const SYSTEM_BROKER: &str = "org.khronos.openxr.system_runtime_broker";
/// The environment variable with the path of the library's script.
const SCRIPT: &str = "YORO_OPENXR_STUB";

/// The folder of the library, once it has been found.
static FOLDER: OnceLock<PathBuf> = OnceLock::new();
/// The handle of the library, once it has been loaded.
static LIBRARY: OnceLock<usize> = OnceLock::new();

/// Attaches the headset to the device.
///
/// # Errors
/// Fails if the library is not where cargo puts it, which is beside this program or in `deps`.
///
/// # Safety
/// No other thread may read the environment.
pub unsafe fn install(openxr: &OpenXr) -> Result<()> {
    let program = std::env::current_exe().context("this program does not know where it lies")?;
    let folder = program.parent().context("this program lies in no folder")?;
    // Cargo updates the library in `deps`; the other one may be left over from an earlier build.
    let found =
        [folder.join("deps"), folder.to_owned()].into_iter().find(|folder| folder.join(FILE).is_file());
    let found = found.with_context(|| {
        format!("{FILE} is not beside {}: build it by `cargo build -p yoro-openxr-stub`", program.display())
    })?;
    FOLDER.get_or_init(|| found);
    // SAFETY: guaranteed by the caller.
    unsafe { std::env::set_var(SCRIPT, &openxr.script) };
    Ok(())
}

/// Returns the answer of a content provider, or `None` if the provider does not exist.
pub fn query(uri: &str, columns: Vec<String>) -> Option<Arc<Object>> {
    let openxr = host().device.openxr.as_ref()?;
    let (broker, path) = uri.strip_prefix("content://")?.split_once('/')?;
    if broker != if openxr.system { SYSTEM_BROKER } else { USER_BROKER } {
        return None;
    }
    let folder = FOLDER.get()?.display().to_string();
    let known = [
        ("package_name", PACKAGE),
        ("native_lib_dir", &folder),
        ("so_filename", FILE),
        ("has_functions", "0"),
    ];
    let is_active = path == format!("openxr/1/abi/{ABI}/runtimes/active/");
    let row = columns.iter().map(|name| {
        known
            .iter()
            .find(|(column, _)| column == name)
            .map_or(String::new(), |(_, value)| (*value).to_owned())
    });
    let rows = if is_active { vec![row.collect()] } else { Vec::new() };
    let cursor = Cursor { columns: columns.clone(), rows, moves: AtomicUsize::new(0) };
    Some(Object::new("android/database/Cursor", Data::Cursor(cursor)))
}

/// Returns the runtime's library for the path that the broker has returned, or `None` for any other path.
pub fn open(path: &str) -> Option<*mut c_void> {
    if Path::new(path) == FOLDER.get()?.join(FILE) { library() } else { None }
}

/// Returns the runtime's library, or `None` without a headset.
pub fn library() -> Option<*mut c_void> {
    let file = FOLDER.get()?.join(FILE);
    let handle = *LIBRARY.get_or_init(|| {
        let path = CString::new(file.into_os_string().into_vec()).unwrap_or_default();
        // SAFETY: this library of the project has no constructors.
        let handle = unsafe { libc::dlopen(path.as_ptr(), libc::RTLD_NOW | libc::RTLD_LOCAL) };
        // SAFETY: the handle is a library's or null, for which nothing is found.
        let pace = unsafe { libc::dlsym(handle, c"yoro_openxr_stub_pace".as_ptr()) };
        if !handle.is_null() && !pace.is_null() {
            // SAFETY: the library's function has this type.
            let set: extern "C" fn(extern "C" fn()) = unsafe { std::mem::transmute(pace) };
            set(frame);
        }
        handle as usize
    });
    (handle != 0).then_some(handle as *mut c_void)
}

/// Returns a symbol of the runtime's library, or `None` if the handle is another library's.
pub fn symbol(handle: *mut c_void, name: &CStr) -> Option<*mut c_void> {
    if LIBRARY.get() != Some(&(handle as usize)) {
        return None;
    }
    // SAFETY: the handle is a library's.
    let address = unsafe { libc::dlsym(handle, name.as_ptr().cast::<c_char>()) };
    Some(address)
}

/// Called by the runtime before each frame of the headset.
extern "C" fn frame() {
    host().frames.present(|| Err("a headset shows no window: its script has `pictures`".into()));
}
