//! Errors of videos.

use std::path::{Path, PathBuf};

use yoro_files::FileError;

/// An error of a video.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VideoError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file contains no readable video.
    #[error("{} cannot be read as a video ({what}): give an MP4 file with H.264", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The mistake.
        what: String,
    },
    /// The video has no depth.
    #[error("{} has no depth: give a file that `yoro render --video` has written", path.display())]
    NoDepth {
        /// The file.
        path: PathBuf,
    },
    /// The encoder or the decoder failed.
    #[error("H.264: {0}")]
    Codec(String),
}

impl VideoError {
    pub(crate) fn format(path: &Path, what: impl ToString) -> VideoError {
        VideoError::Format { path: path.into(), what: what.to_string() }
    }
}
