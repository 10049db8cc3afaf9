//! `RELEASE.md`: what each file is for, how it was tested, what no device has run.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::Context as _;

use crate::package::texts::filled;

use super::items::description;

/// Returns the text for the files in a folder, which were built from a commit.
pub fn text(out: &Path, commit: &str) -> anyhow::Result<String> {
    let mut rows = String::new();
    for path in super::files(out)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let size = fs::metadata(&path).with_context(|| format!("{} cannot be read", path.display()))?.len();
        // Writing to a string cannot fail.
        let _ = writeln!(rows, "| `{name}` | {size} | {} |", description(&path)?);
    }
    let values = [("ORIGIN", &*origin(commit)), ("ROWS", &rows)];
    Ok(filled(include_str!("RELEASE.md"), &values))
}

/// Returns the sentence that says of which commit the files are.
pub fn origin(commit: &str) -> String {
    format!("Built from {commit}.")
}
