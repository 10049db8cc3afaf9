//! Errors of videos.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use yoro_files::FileError;

/// An error of a video.
#[derive(Debug, thiserror::Error)]
pub enum VideoError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file contains no readable video.
    #[error("{0}")]
    Format(String),
    /// The video has no depth.
    #[error("{} has no depth: give a file that `yoro render --video` has written", .0.display())]
    NoDepth(PathBuf),
    /// The encoder or the decoder failed.
    #[error("H.264: {0}")]
    Codec(String),
}

impl VideoError {
    pub(crate) fn format(path: &Path, what: impl Display) -> VideoError {
        let path = path.display();
        VideoError::Format(format!("{path} cannot be read as a video ({what}): give an MP4 file with H.264"))
    }
}
