//! Errors of reading, writing and composing pictures.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use yoro_files::FileError;

/// Errors of reading, writing and composing pictures.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The file itself could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The content is damaged, or not what is needed; one sentence that names the file and the remedy.
    #[error("{0}")]
    Unusable(String),
    /// There is no encoder for the extension.
    #[error("cannot write {}: use the extension {allowed}", path.display())]
    Extension {
        /// The file to be written.
        path: PathBuf,
        /// The possible extensions.
        allowed: &'static str,
    },
    /// Two eyes have different sizes.
    #[error("the two images differ in size ({}x{} and {}x{}): give two of one size", a.0, a.1, b.0, b.1)]
    SizesDiffer {
        /// Size of the first in pixels.
        a: (u32, u32),
        /// Size of the second in pixels.
        b: (u32, u32),
    },
}

impl PictureError {
    /// The message is the file, followed by `what`.
    pub(crate) fn unusable(path: &Path, what: impl Display) -> PictureError {
        PictureError::Unusable(format!("{} {what}", path.display()))
    }

    pub(crate) fn damaged(path: &Path, reason: impl Display) -> PictureError {
        PictureError::unusable(path, format!("is damaged ({reason}): write or copy it again"))
    }
}
