//! The output of a program: its text, and its exit code.

use std::io::{self, Write as _};
use std::process::ExitCode;

/// Prints a text to the standard output. A reader such as `head` may have gone before the end.
pub fn print(text: &str) {
    let _ = io::stdout().write_all(text.as_bytes());
}

/// Returns 0 if all was well, 1 for `false`, and 2 for an error, which is printed to the standard error output.
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
