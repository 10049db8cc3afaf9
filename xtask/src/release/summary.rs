//! `RELEASE.md`: what each file is for, how it was tested, what no device has run.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::Context as _;

use crate::notices;
use crate::package::VERSION;

use super::SUMS;
use super::bills::{ENDING, FORMAT};
use super::items::Description;

/// Returns the text for the files in a folder, which were built from a commit.
pub fn text(out: &Path, commit: &str) -> anyhow::Result<String> {
    let mut text = format!(
        "# yoro {VERSION}\n\
         \n\
         {} `sha256sum --check {SUMS}` checks the files. What contains code of others has its `{}`\n\
         inside, and beside it, as `FILE{ENDING}`, a list of that code in CycloneDX {FORMAT}.\n\
         \n\
         **No phone and no headset has run any of it.** *Tested by* says what took a device's place.\n\
         \n\
         | file | bytes | for | tested by | not tested on | same bytes again |\n\
         |---|---|---|---|---|---|\n",
        origin(commit),
        notices::FILE
    );
    for path in super::files(out)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.ends_with(ENDING) {
            continue;
        }
        let size = fs::metadata(&path).with_context(|| format!("{} cannot be read", path.display()))?.len();
        let Description(cells) = Description::of(&path)?;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| `{name}` | {size} | {cells} |");
    }
    text.push_str(
        "\n\"Same bytes again\": whether the same commit gives the same file. With *the same compilers*: rustc, cargo, npm, and\n\
         clang or gcc, of the same versions. A key signs APKs (`CARGO_APK_RELEASE_KEYSTORE`); without one it is a new key\n\
         for debugging, which no store accepts.\n",
    );
    Ok(text)
}

/// Returns the sentence that says of which commit the files are.
pub fn origin(commit: &str) -> String {
    format!("Built from {commit}.")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_for_each_file() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["yoro-0.1.0.apk", "yoro-0.1.0.apk.cdx.json", "yoro-0.1.0.crate", SUMS] {
            fs::write(folder.path().join(name), "four").unwrap();
        }
        let text = text(folder.path(), "abc").unwrap();
        assert!(
            text.contains("Built from abc.") && text.contains("| `yoro-0.1.0.apk` | 4 | phones"),
            "{text}"
        );
        assert_eq!(text.matches("\n| `").count(), 2, "{text}");
        fs::write(folder.path().join("unknown"), "four").unwrap();
        assert!(super::text(folder.path(), "abc").is_err());
    }
}
