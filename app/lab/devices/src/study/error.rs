//! The error of planning and analysing studies.

use std::path::PathBuf;

use yoro_files::FileError;
use yoro_files::interrupt::Interrupted;

/// The error of planning or analysing a study: one sentence.
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
        /// The line, counted from 1.
        line: u64,
        /// The mistake and the remedy.
        what: String,
    },
    /// There is nothing to analyse.
    #[error("{}: {what}", path.display())]
    Nothing {
        /// The file.
        path: PathBuf,
        /// What is missing, and the remedy.
        what: String,
    },
    /// The logs contain no rating.
    #[error(
        "there is no rating in {0}: ratings are lines of the viewer's log that begin with rating,v=2, and name a participant"
    )]
    NoRating(String),
    /// The user has interrupted the program.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}
