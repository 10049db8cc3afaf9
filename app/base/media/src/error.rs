//! Errors of reading, writing and composing pictures.

use std::fmt::Display;
use std::path::Path;

use yoro_files::FileError;

/// Errors of reading, writing and composing pictures.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The file itself could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The content is damaged, or not what is needed; one sentence with the remedy.
    #[error("{0}")]
    Unusable(String),
}

impl PictureError {
    /// There is no encoder for the extension of a file that is to be written.
    pub fn extension(path: &Path, allowed: &str) -> PictureError {
        PictureError::Unusable(format!("cannot write {}: use the extension {allowed}", path.display()))
    }

    /// The message is the file, followed by `what`.
    pub(crate) fn unusable(path: &Path, what: impl Display) -> PictureError {
        PictureError::Unusable(format!("{} {what}", path.display()))
    }

    pub(crate) fn damaged(path: &Path, reason: impl Display) -> PictureError {
        PictureError::unusable(path, format!("is damaged ({reason}): write or copy it again"))
    }
}
