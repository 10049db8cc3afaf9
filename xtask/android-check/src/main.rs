//! Archives and libraries for Android. `check APK` checks that Android will install and start it, `loader LIBRARY` prints
//! the processor that an OpenXR loader is for, and `pack AAR FOLDER` packs the files of a folder.
//!
//! A program of its own, so that only those who build for Android wait for its dependencies.

mod archive;
mod check;
mod library;
mod loader;
mod manifest;
mod public;
mod report;
mod signature;

use std::io::{self, Write as _};
use std::path::Path;
use std::process::ExitCode;

use anyhow::bail;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match perform(&arguments) {
        Ok((text, passed)) => {
            // A reader such as `head` may have gone before the end.
            let _ = io::stdout().write_all(text.as_bytes());
            if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Returns what to print, and false if the APK is not as it should be.
fn perform(arguments: &[&str]) -> anyhow::Result<(String, bool)> {
    Ok(match arguments {
        ["check", apk] => {
            let report = check::check(Path::new(apk))?;
            (report.to_string(), report.passed())
        }
        ["loader", library] => (loader::abi(Path::new(library))?.to_owned(), true),
        ["pack", packed, folder] => {
            archive::pack(Path::new(folder), Path::new(packed))?;
            (String::new(), true)
        }
        _ => bail!("usage: check APK, loader LIBRARY, or pack AAR FOLDER"),
    })
}
