//! Errors of planning and analysing studies.

use std::path::PathBuf;

use yoro_files::FileError;
use yoro_files::interrupt::Interrupted;

/// The error when a study cannot be planned or analysed: one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table lacks a column.
    #[error("{} has no column \"{column}\": it needs participant, method, scene, question and rating", path.display())]
    Column {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
    },
    /// A row of a table is damaged.
    #[error("{}, line {line}: {what}", path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: u64,
        /// The mistake and the remedy.
        what: String,
    },
    /// There is nothing to analyse.
    #[error("{}: {what}", path.display())]
    Nothing {
        /// The file.
        path: PathBuf,
        /// The missing part and the remedy.
        what: String,
    },
    /// No line of the logs is a rating.
    #[error(
        "there is no rating in {0}: ratings are lines of the viewer's log that begin with rating,v=1, and name a participant"
    )]
    NoRating(String),
    /// The user has asked for the end.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}
