//! User studies: the plan of trials, the ratings and their analysis.
//!
//! ```text
//! plan (orders from a seed) ──> the viewer, or paper ──> ratings (CSV, or lines of the log) ──> analysis
//! ```

mod analysis;
mod page;
mod plan;
mod ratings;

use std::path::{Path, PathBuf};

use yoro_files::FileError;
use yoro_files::interrupt::Interrupted;
use yoro_report::{Report, ReportError, ReportFiles};

pub use analysis::Study;
pub use plan::{Condition, Plan, Trials, read_trials};
pub use ratings::{Collected, Ratings};

/// The error of planning or analysing a study: one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table is damaged, or there is nothing to analyse.
    #[error("{}{}: {what}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
    Table {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1, if it is about one.
        line: Option<u64>,
        /// The mistake and the remedy.
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

impl Study {
    fn report(&self) -> Report {
        page::report(self)
    }

    /// Returns the means and differences for a terminal.
    pub fn to_text(&self) -> String {
        page::text(self)
    }

    /// Writes `study.html`, `study.md` and `study.json` into `folder`.
    ///
    /// # Errors
    /// [`ReportError`]. All three are made before the first one is written.
    pub fn write(&self, folder: &Path) -> Result<ReportFiles, ReportError> {
        self.report().write(folder, "study", Some(&serde_json::to_string_pretty(self)?))
    }
}
