//! ANativeActivity: its structure, its callbacks and the application's folders.

#![allow(non_snake_case)]

use std::collections::BTreeMap;
use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::sync::atomic::Ordering;

use anyhow::{Context, Result};
use jni_sys::{JNIEnv, JavaVM, jobject};
use tempfile::TempDir;

use crate::android::input::AInputQueue;
use crate::android::window::Window;
use crate::exports::{Export, System, exports};
use crate::host::host;

/// `ARect`.
#[repr(C)]
#[derive(Debug)]
pub struct ARect {
    /// Pixels.
    pub left: i32,
    /// Pixels.
    pub top: i32,
    /// Pixels.
    pub right: i32,
    /// Pixels.
    pub bottom: i32,
}

/// A callback that takes only the activity.
pub type Event = Option<unsafe extern "C" fn(*mut ANativeActivity)>;
/// A callback that takes the window.
pub type WindowEvent = Option<unsafe extern "C" fn(*mut ANativeActivity, *const Window)>;
/// A callback that takes the input queue.
pub type QueueEvent = Option<unsafe extern "C" fn(*mut ANativeActivity, *const AInputQueue)>;

/// `ANativeActivityCallbacks`.
#[repr(C)]
#[derive(Default)]
pub struct Callbacks {
    pub onStart: Event,
    pub onResume: Event,
    pub onSaveInstanceState: Option<unsafe extern "C" fn(*mut ANativeActivity, *mut usize) -> *mut c_void>,
    pub onPause: Event,
    pub onStop: Event,
    pub onDestroy: Event,
    pub onWindowFocusChanged: Option<unsafe extern "C" fn(*mut ANativeActivity, c_int)>,
    pub onNativeWindowCreated: WindowEvent,
    pub onNativeWindowResized: WindowEvent,
    pub onNativeWindowRedrawNeeded: WindowEvent,
    pub onNativeWindowDestroyed: WindowEvent,
    pub onInputQueueCreated: QueueEvent,
    pub onInputQueueDestroyed: QueueEvent,
    pub onContentRectChanged: Option<unsafe extern "C" fn(*mut ANativeActivity, *const ARect)>,
    pub onConfigurationChanged: Event,
    pub onLowMemory: Event,
}

/// `ANativeActivity`.
#[repr(C)]
#[derive(Debug)]
pub struct ANativeActivity {
    pub callbacks: *mut Callbacks,
    pub vm: *mut JavaVM,
    pub env: *mut JNIEnv,
    pub clazz: jobject,
    pub internalDataPath: *const c_char,
    pub externalDataPath: *const c_char,
    pub sdkVersion: i32,
    pub instance: *mut c_void,
    pub assetManager: *const c_void,
    pub obbPath: *const c_char,
}

/// `ANativeActivity_onCreate`.
pub type OnCreate = unsafe extern "C" fn(*mut ANativeActivity, *const c_void, usize);

/// The application's folders, which are removed at the end.
pub struct Directories {
    /// The path that `getFilesDir` gives.
    pub internal: CString,
    /// The path that `getExternalFilesDir(null)` gives.
    pub external: CString,
    // Only removed if the process exits normally. The host calls `_exit`, so it removes the folder itself.
    root: TempDir,
}

impl Directories {
    /// Creates the folders, and writes the script's files into the external one.
    ///
    /// # Errors
    /// Fails if they cannot be written.
    pub fn new(files: &BTreeMap<String, String>) -> Result<Self> {
        let root = tempfile::Builder::new()
            .prefix("yoro-android-host-")
            .tempdir()
            .context("no temporary folder for the application's files")?;
        let folder = |name: &str| -> Result<CString> {
            let path = root.path().join(name);
            std::fs::create_dir_all(&path).with_context(|| format!("cannot make {}", path.display()))?;
            Ok(CString::new(path.into_os_string().into_encoded_bytes())?)
        };
        let (internal, external) = (folder("internal")?, folder("external")?);
        for (path, text) in files {
            let path = root.path().join("external").join(path);
            std::fs::create_dir_all(path.parent().unwrap_or(Path::new("/")))
                .and_then(|()| std::fs::write(&path, text))
                .with_context(|| format!("cannot write {}", path.display()))?;
        }
        Ok(Self { internal, external, root })
    }

    /// Removes the folders.
    pub fn remove(&self) {
        // Ignores errors: the folder is in the system's temporary folder.
        _ = std::fs::remove_dir_all(self.root.path());
    }
}

/// Returns the functions of this module that libandroid.so exports.
pub fn exports() -> Vec<Export> {
    exports![System::Android, 1: [
        ANativeActivity_finish, ANativeActivity_setWindowFlags,

    ]]
}

extern "C" fn ANativeActivity_finish(_activity: *mut ANativeActivity) {
    host().finish_asked.store(true, Ordering::Release);
    host().frames.event.signal();
}

extern "C" fn ANativeActivity_setWindowFlags(_activity: *mut ANativeActivity, _add: u32, _remove: u32) {}
