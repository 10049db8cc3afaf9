//! Writes the shader kit into a folder: `cargo xtask kit`.

mod files;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1) else {
        eprintln!("error: give the folder that the kit is to be written to");
        return ExitCode::from(2);
    };
    match files::write(Path::new(&folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {} cannot be written: {error}", Path::new(&folder).display());
            ExitCode::from(2)
        }
    }
}
