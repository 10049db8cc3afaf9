//! The errors of videos.

use std::path::{Path, PathBuf};

use yoro_files::FileError;

/// Errors of videos.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VideoError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file holds no video that can be read.
    #[error("{} cannot be read as a video ({what}): give an MP4 file with H.264", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The mistake.
        what: String,
    },
    /// The video has no depth.
    #[error(
        "{} has no depth: give a file that `yoro render --video` or Record3D has written",
        path.display()
    )]
    NoDepth {
        /// The file.
        path: PathBuf,
    },
    /// The encoder or the decoder refused.
    #[error("H.264: {0}")]
    Codec(String),
}

impl VideoError {
    pub(crate) fn format(path: &Path, what: impl ToString) -> VideoError {
        VideoError::Format { path: path.into(), what: what.to_string() }
    }
}
