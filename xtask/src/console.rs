//! Text output and exit codes of programs.

use std::io::{self, Write as _};
use std::process::ExitCode;

/// Prints a text to standard output. Ignores errors, since a reader such as `head` may have exited.
pub fn print(text: &str) {
    let _ = io::stdout().write_all(text.as_bytes());
}

/// Returns 0 for `true`, 1 for `false`, and 2 for an error, which is printed to standard error.
pub fn exit_code(outcome: anyhow::Result<bool>) -> ExitCode {
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}
