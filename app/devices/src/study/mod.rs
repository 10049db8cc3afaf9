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

use std::path::{Path, PathBuf};

use yoro_figures::ReportError;
use yoro_files as files;

pub use analysis::{Excluded, Options, Question, Scale, Study, Verdict};
pub use error::StudyError;
pub use plan::{Condition, Plan, Trial, Trials, read_trials};
pub use ratings::{Collected, Ratings, Row};

/// The files that were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The HTML page.
    pub page: PathBuf,
    /// The tables as Markdown.
    pub markdown: PathBuf,
    /// All figures as JSON.
    pub json: PathBuf,
}

impl Written {
    /// Returns the files of a report in `folder`.
    pub fn of(folder: &Path) -> Written {
        Written {
            page: folder.join("study.html"),
            markdown: folder.join("study.md"),
            json: folder.join("study.json"),
        }
    }
}

impl Study {
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
    pub fn write(&self, folder: &Path) -> Result<Written, ReportError> {
        let written = Written::of(folder);
        let (page, json) = (self.to_html()?, serde_json::to_string_pretty(self)?);
        files::write(&written.json, json.as_bytes())?;
        files::write(&written.markdown, self.to_markdown().as_bytes())?;
        files::write(&written.page, page.as_bytes())?;
        Ok(written)
    }
}
