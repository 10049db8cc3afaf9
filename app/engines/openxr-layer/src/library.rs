//! The layer's library as a file.

use std::ffi::{CStr, c_char};
use std::path::{Path, PathBuf};

use libloading::Library;

/// A file that is not the layer's library. Loaders that find it cannot create any instance.
#[derive(Debug, thiserror::Error)]
#[error("{}: it {mistake}; give libyoro_openxr_layer.so of the package yoro-openxr-layer", path.display())]
pub struct LibraryError {
    path: PathBuf,
    /// What the file is or does instead.
    mistake: String,
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
    let error = |mistake: &str| LibraryError { path: path.to_owned(), mistake: mistake.to_owned() };
    // SAFETY: the layer's library does nothing when it is loaded. If the file is another library, the user has named it
    // as the layer's, and every OpenXR program would load it as well.
    let library = unsafe { Library::new(path) }.map_err(|reason| {
        let reason = reason.to_string();
        let reason = reason.strip_prefix(&format!("{}: ", path.display())).unwrap_or(&reason);
        error(&format!("cannot be loaded ({reason})"))
    })?;
    // SAFETY: the symbol is only looked up.
    unsafe { library.get::<extern "C" fn()>(b"xrNegotiateLoaderApiLayerInterface\0") }
        .map_err(|_| error("is a library, but no OpenXR API layer"))?;
    // SAFETY: the layer's function of this name has this type, and returns a null-terminated string.
    unsafe {
        let version = library.get::<extern "C" fn() -> *const c_char>(b"yoro_layer_version\0");
        let version = version.map_err(|_| error("is another OpenXR API layer"))?;
        Ok(CStr::from_ptr(version()).to_string_lossy().into_owned())
    }
}
