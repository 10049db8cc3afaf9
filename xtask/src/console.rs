//! Other programs' output, this program's, and exit codes.

use std::io::{self, Write as _};
use std::process::{Command, ExitCode};

use anyhow::{Context as _, bail};

/// Prints a text to standard output. Ignores errors, since a reader such as `head` may have exited.
pub fn print(text: &str) {
    let _ = io::stdout().write_all(text.as_bytes());
}

/// Runs a helper with the command line's arguments. `perform` returns the text to print, and false if a check has failed.
pub fn main(perform: impl FnOnce(&[&str]) -> anyhow::Result<(String, bool)>) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    exit_code(perform(&arguments).map(|(text, passed)| {
        print(&text);
        passed
    }))
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

/// Runs a program, and returns its standard output.
pub fn run(command: &mut Command) -> anyhow::Result<String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("{program} cannot be started: install it"))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if !output.status.success() {
        bail!("{program} failed: {} {}", text(&output.stderr).trim(), text(&output.stdout).trim());
    }
    Ok(text(&output.stdout))
}
