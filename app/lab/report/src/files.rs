//! The files of a report.

use std::fmt;
use std::path::{Path, PathBuf};

use yoro_files::FileError;

/// The files of a report: a page, its tables and its figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportFiles {
    /// The HTML page.
    pub page: PathBuf,
    /// The tables as Markdown.
    pub markdown: PathBuf,
    /// All figures as JSON.
    pub json: PathBuf,
}

impl ReportFiles {
    /// Returns the files `NAME.html`, `NAME.md` and `NAME.json` in `folder`.
    pub fn of(folder: &Path, name: &str) -> ReportFiles {
        let [page, markdown, json] =
            ["html", "md", "json"].map(|ending| folder.join(format!("{name}.{ending}")));
        ReportFiles { page, markdown, json }
    }

    /// Returns the three paths.
    pub fn paths(&self) -> [&PathBuf; 3] {
        [&self.page, &self.markdown, &self.json]
    }

    /// Writes all three; the page last, since it is what people open.
    ///
    /// # Errors
    /// [`FileError`] for the first file that cannot be written.
    pub fn write(&self, page: &str, markdown: &str, json: &str) -> Result<(), FileError> {
        yoro_files::write(&self.json, json.as_bytes())?;
        yoro_files::write(&self.markdown, markdown.as_bytes())?;
        yoro_files::write(&self.page, page.as_bytes())
    }
}

impl fmt::Display for ReportFiles {
    /// Writes a line for each file: what it is, and its path.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "page:   {}", self.page.display())?;
        writeln!(f, "tables: {}", self.markdown.display())?;
        writeln!(f, "json:   {}", self.json.display())
    }
}
