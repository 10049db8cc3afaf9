//! The program `yoro-publish`, whose dependencies only those compile who publish or lint.

use anyhow::{Context as _, bail};

use crate::cargo;

/// Runs the program, and returns its output, and true if it found no fault.
///
/// # Errors
/// Fails with the program's own message.
pub fn run(arguments: &[&str]) -> anyhow::Result<(String, bool)> {
    let mut command = cargo::program("yoro-publish")?;
    let output = command.args(arguments).output().context("yoro-publish cannot be started")?;
    match output.status.code() {
        Some(code @ (0 | 1)) => Ok((String::from_utf8_lossy(&output.stdout).into_owned(), code == 0)),
        _ => {
            let said = String::from_utf8_lossy(&output.stderr);
            bail!("{}", said.trim().trim_start_matches("error: "))
        }
    }
}
