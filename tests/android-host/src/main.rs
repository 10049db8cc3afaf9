//! The simulated Android host as a program.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use yoro_android_host::script::Script;

/// Runs an APK's own library on Linux, by a script. Everything is simulated: no device is involved.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// The APK.
    apk: PathBuf,
    /// The device and what happens to it (TOML); see the folder `scripts`.
    script: PathBuf,
    /// Folder for `summary.json` and the pictures.
    #[arg(long, default_value = "out/android-host")]
    out: PathBuf,
    /// Shows the application's log.
    #[arg(short, long)]
    verbose: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = Script::read(&arguments.script).and_then(|script| {
        yoro_android_host::run(&arguments.apk, &script, &arguments.out, arguments.verbose)
    });
    match result {
        Ok(never) => match never {},
        Err(error) => {
            eprintln!("simulated Android host: {error:#}");
            ExitCode::from(2)
        }
    }
}
