//! `notices PACKAGE TARGET [CARGO ARGUMENT...]` prints the notices of what a package contains, and fails on a licence that
//! is not accepted. `site FOLDER [RELEASE]` completes a folder with the page and rustdoc to the site.
//!
//! This is a separate program so that only people who publish or lint have to compile its dependencies.

mod guides;
mod licences;
mod notices;
mod packages;
mod site;

use std::path::Path;
use std::process::ExitCode;

use anyhow::bail;
use xtask::console;

fn main() -> ExitCode {
    console::main(perform)
}

/// Returns the text to print, and false if a check has failed.
fn perform(arguments: &[&str]) -> anyhow::Result<(String, bool)> {
    match arguments {
        ["notices", package, target, features @ ..] => Ok((notices::text(package, target, features)?, true)),
        ["site", folder, release @ ..] => {
            site::complete(Path::new(folder), release.first().map(Path::new))?;
            Ok((String::new(), true))
        }
        _ => bail!("usage: notices PACKAGE TARGET [CARGO ARGUMENT...], or site FOLDER [RELEASE]"),
    }
}
