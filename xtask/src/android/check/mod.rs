//! Is an APK as Android wants it? The file itself is asked, not what it was built from.

mod archive;
pub(super) mod library;
mod manifest;
mod signature;

use std::fmt;
use std::fs;
use std::path::Path;

use anyhow::{Context as _, bail};

use super::symbols::Public;
use super::toolchain::Surroundings;
use archive::Archive;

/// A release with its built-in scenes is smaller than this, in bytes.
const SIZE_LIMIT: u64 = 8_000_000;

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// What was looked at.
    what: String,
    /// What is there.
    found: String,
    /// What is wrong with it.
    problem: Option<String>,
}

/// The result of a check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    rows: Vec<Row>,
}

impl Report {
    /// Nothing is wrong.
    pub fn passed(&self) -> bool {
        self.rows.iter().all(|row| row.problem.is_none())
    }

    fn row(&mut self, what: impl Into<String>, found: impl Into<String>, problem: Option<String>) {
        self.rows.push(Row { what: what.into(), found: found.into(), problem });
    }

    /// A row that is wrong unless what is found is what is wanted.
    fn equal(&mut self, what: impl Into<String>, found: &str, wanted: &str) {
        let problem = (found != wanted).then(|| format!("should be {wanted}"));
        self.row(what, if found.is_empty() { "none" } else { found }, problem);
    }

    #[cfg(test)]
    fn problems(&self) -> Vec<&str> {
        let wrong = self.rows.iter().filter(|row| row.problem.is_some());
        wrong.map(|row| row.what.as_str()).collect()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.rows.iter().map(|row| row.what.len()).max().unwrap_or(0);
        for Row { what, found, problem } in &self.rows {
            match problem {
                None => writeln!(f, "  ok    {what:width$}  {found}")?,
                Some(problem) => writeln!(f, "  FAIL  {what:width$}  {found}: {problem}")?,
            }
        }
        Ok(())
    }
}

/// A list, cut where nobody would read on.
fn some(names: &[&str]) -> String {
    const SHOWN: usize = 5;
    match names.len().checked_sub(SHOWN) {
        Some(more @ 1..) => format!("{} and {more} more", names[..SHOWN].join(", ")),
        _ => names.join(", "),
    }
}

/// Looks at everything.
///
/// # Errors
/// When the file is missing or no APK, or a tool for looking at it is missing.
pub fn check(path: &Path) -> anyhow::Result<Report> {
    let shown = path.display();
    let bytes = fs::read(path)
        .with_context(|| format!("{shown} cannot be read (`cargo xtask apk` says where it puts an APK)"))?;
    let archive = Archive::read(&bytes).with_context(|| {
        format!("{shown} is damaged or no APK: build it anew by `cargo xtask apk --release`")
    })?;
    if !archive.has("AndroidManifest.xml") {
        bail!("{shown} is an archive without AndroidManifest.xml, and so no APK: name the .apk file");
    }
    let mut report = Report::default();
    let manifest = manifest::Manifest::read(path)?;
    let size = bytes.len() as u64;
    let too_large = (size > SIZE_LIMIT && !manifest.is_debuggable())
        .then(|| format!("a release must be under {} MB", SIZE_LIMIT / 1_000_000));
    report.row("size", format!("{:.2} MB", size as f64 / 1e6), too_large);
    manifest.check(&archive, &mut report);
    signature::check(path, &mut report)?;
    archive.check(manifest.unpacks_libraries(), &mut report);
    let public = Public::of(Surroundings::here().ndk());
    for (name, content) in archive.libraries() {
        library::check(name, content, &public, &mut report)?;
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut() {
        assert_eq!(some(&["a", "b"]), "a, b");
        assert_eq!(some(&["a", "b", "c", "d", "e"]), "a, b, c, d, e");
        assert_eq!(some(&["a", "b", "c", "d", "e", "f", "g"]), "a, b, c, d, e and 2 more");
    }

    #[test]
    fn what_is_no_apk_is_refused_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("some.apk");
        let refusal = || check(&path).unwrap_err().to_string();
        assert!(refusal().contains("some.apk cannot be read"));
        fs::write(&path, "no archive").unwrap();
        assert!(refusal().contains("some.apk is damaged or no APK"));
        let files = archive::tests::archive(&["a.txt"], zip::CompressionMethod::Stored, 1);
        fs::write(&path, files).unwrap();
        assert!(refusal().contains("without AndroidManifest.xml"));
    }

    #[test]
    fn one_problem_is_enough() {
        let mut report = Report::default();
        report.equal("first", "as it should be", "as it should be");
        assert!(report.passed());
        report.equal("second", "", "something");
        assert!(!report.passed());
        assert_eq!(
            report.to_string(),
            "  ok    first   as it should be\n  FAIL  second  none: should be something\n"
        );
    }
}
