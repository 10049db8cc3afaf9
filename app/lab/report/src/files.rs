//! The files of a report.

use std::fmt;
use std::path::{Path, PathBuf};

use yoro_files::FileError;

/// The files of a report: a page, its tables and perhaps its figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportFiles {
    /// The HTML page.
    pub page: PathBuf,
    /// Texts and tables as Markdown.
    pub markdown: PathBuf,
    /// All figures as JSON, for a report that is not made from such a file.
    pub json: Option<PathBuf>,
}

impl ReportFiles {
    /// Returns the files `NAME.html`, `NAME.md` and perhaps `NAME.json` in `folder`.
    pub fn of(folder: &Path, name: &str, with_json: bool) -> ReportFiles {
        let [page, markdown, json] =
            ["html", "md", "json"].map(|ending| folder.join(format!("{name}.{ending}")));
        ReportFiles { page, markdown, json: with_json.then_some(json) }
    }

    /// Writes all files; the page last, since it is what people open.
    ///
    /// # Errors
    /// [`FileError`] for the first file that cannot be written.
    pub fn write(&self, page: &str, markdown: &str, json: Option<&str>) -> Result<(), FileError> {
        if let Some((path, json)) = self.json.as_ref().zip(json) {
            yoro_files::write(path, json.as_bytes())?;
        }
        yoro_files::write(&self.markdown, markdown.as_bytes())?;
        yoro_files::write(&self.page, page.as_bytes())
    }
}

impl fmt::Display for ReportFiles {
    /// Writes a line for each file: what it is, and its path.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "page:   {}", self.page.display())?;
        writeln!(f, "tables: {}", self.markdown.display())?;
        if let Some(json) = &self.json {
            writeln!(f, "json:   {}", json.display())?;
        }
        Ok(())
    }
}
