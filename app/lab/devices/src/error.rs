//! The error of reading and writing data.

use yoro_files::FileError;

/// The error of files of runs, farms, experiments and studies: one sentence with the remedy.
#[derive(Debug, thiserror::Error)]
pub enum DataError {
    /// A file cannot be read or written.
    #[error("{0}")]
    File(#[from] FileError),
    /// A file of a run is damaged, so the run may be measured again.
    #[error("{0}")]
    Damaged(String),
    /// The files are not what they should be, or hold nothing.
    #[error("{0}")]
    Unusable(String),
}
