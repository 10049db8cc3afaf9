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

use yoro_report::{Report, ReportError, ReportFiles};

pub use analysis::{Excluded, Opinion, Question, Study};
pub use error::StudyError;
pub use plan::{Condition, Plan, Trial, Trials, read_trials};
pub use ratings::{Collected, Ratings, Row};

impl Study {
    /// Returns the files that [`Study::write`] writes into `folder`.
    pub fn files(folder: &Path) -> ReportFiles {
        ReportFiles::of(folder, "study", true)
    }

    /// Returns the analysis as readers see it.
    pub fn report(&self) -> Report {
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
