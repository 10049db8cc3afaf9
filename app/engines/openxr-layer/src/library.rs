//! The layer's library as a file.

use std::ffi::{CStr, c_char};
use std::path::{Path, PathBuf};

use libloading::Library;

/// A file that is not the layer's library. Loaders that find it cannot create any instance.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// The file is not a library for this system.
    #[error("{}: it cannot be loaded ({reason}); give libyoro_openxr_layer.so of the package yoro-openxr-layer", path.display())]
    NotLoaded {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: String,
    },
    /// The library has no function for the OpenXR loader.
    #[error("{}: it is a library, but no OpenXR API layer; give libyoro_openxr_layer.so of the package yoro-openxr-layer", path.display())]
    NoLayer {
        /// The file.
        path: PathBuf,
    },
    /// The library is a different layer.
    #[error("{}: it is another OpenXR API layer; give libyoro_openxr_layer.so of the package yoro-openxr-layer", path.display())]
    AnotherLayer {
        /// The file.
        path: PathBuf,
    },
}

/// Returns the layer's version as a null-terminated string.
#[unsafe(no_mangle)]
pub extern "C" fn yoro_layer_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Loads the layer's library from an absolute path, and returns its version.
///
/// # Errors
/// [`LibraryError`] if the file is not the layer's library.
pub fn version(path: &Path) -> Result<String, LibraryError> {
    // SAFETY: the layer's library does nothing when it is loaded. If the file is another library, the user has named it
    // as the layer's, and every OpenXR program would load it as well.
    let library = unsafe { Library::new(path) }.map_err(|error| {
        let (reason, path) = (error.to_string(), path.to_owned());
        let reason = reason.strip_prefix(&format!("{}: ", path.display())).unwrap_or(&reason).to_owned();
        LibraryError::NotLoaded { path, reason }
    })?;
    // SAFETY: the symbol is only looked up.
    let negotiate = unsafe { library.get::<extern "C" fn()>(b"xrNegotiateLoaderApiLayerInterface\0") };
    negotiate.map_err(|_| LibraryError::NoLayer { path: path.to_owned() })?;
    // SAFETY: the layer's function of this name has this type, and returns a null-terminated string.
    unsafe {
        let version = library.get::<extern "C" fn() -> *const c_char>(b"yoro_layer_version\0");
        let version = version.map_err(|_| LibraryError::AnotherLayer { path: path.to_owned() })?;
        Ok(CStr::from_ptr(version()).to_string_lossy().into_owned())
    }
}
