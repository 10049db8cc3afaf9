//! User studies: the plan of trials, the ratings and their analysis.
//!
//! ```text
//! plan (orders from a seed) ──> the viewer, or paper ──> ratings (CSV, or lines of the log) ──> analysis
//! ```

mod analysis;
mod error;
mod page;
mod plan;
mod ratings;

use std::path::Path;

use yoro_report::{ReportError, ReportFiles};

pub use analysis::{Excluded, Options, Question, Scale, Study, Verdict};
pub use error::StudyError;
pub use plan::{Condition, Plan, Trial, Trials, read_trials};
pub use ratings::{Collected, Ratings, Row};

impl Study {
    /// Returns the files that [`Study::write`] writes into `folder`.
    pub fn files(folder: &Path) -> ReportFiles {
        ReportFiles::of(folder, "study")
    }

    /// Returns the analysis as a self-contained HTML page.
    ///
    /// # Errors
    /// [`ReportError`] if a figure cannot be drawn.
    pub fn to_html(&self) -> Result<String, ReportError> {
        page::html(self)
    }

    /// Returns the verdicts and all tables as Markdown.
    pub fn to_markdown(&self) -> String {
        page::markdown(self)
    }

    /// Returns the verdicts for a terminal.
    pub fn to_text(&self) -> String {
        page::text(self)
    }

    /// Writes `study.html`, `study.md` and `study.json` into `folder`.
    ///
    /// # Errors
    /// [`ReportError`]. All three are made before the first one is written.
    pub fn write(&self, folder: &Path) -> Result<ReportFiles, ReportError> {
        let files = Study::files(folder);
        files.write(&self.to_html()?, &self.to_markdown(), &serde_json::to_string_pretty(self)?)?;
        Ok(files)
    }
}
