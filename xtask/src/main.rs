//! Everything a person or CI types: `cargo xtask setup`, `run`, `test`, `lint`, `apk`, `doctor`, `check-apk`,
//! `package`, `kit`, `web`. What maintainers run is in tools/.

mod android;
mod kit;
mod lint;
mod package;
mod setup;
mod testing;
mod web;

use std::io::{self, Write as _};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use yoro_tools::cargo;

/// Set up, run and test yoro
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Find out which system libraries are missing and install them (apt), or say what to install
    Setup,
    /// Set up, then `yoro run`: the built-in scenes, conventional against synthesized, with a report
    Run {
        /// Passed on to `yoro run`
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Set up, then run all tests
    Test {
        /// Only tests whose names contain one of these; in documentation, if there is no other
        filters: Vec<String>,
        /// Only tests of these packages, without those in documentation
        #[arg(long = "package", short, value_name = "NAME")]
        packages: Vec<String>,
        /// Renew the golden images of tests/golden instead of comparing with them
        #[arg(long)]
        bless: bool,
        /// Processes of tests at a time [default: one for each processor]
        #[arg(long, value_name = "N")]
        jobs: Option<NonZeroUsize>,
    },
    /// Build, sign and check the Android application
    Apk {
        /// Small and fast, instead of debuggable
        #[arg(long)]
        release: bool,
        /// Install missing packages (apt) without asking
        #[arg(long)]
        yes: bool,
        /// An OpenXR loader for the APK: the file that somebody else's libopenxr_loader.so lies in; once for each processor
        #[arg(long = "openxr-loader", value_name = "FILE")]
        openxr_loaders: Vec<PathBuf>,
    },
    /// What the Android application would be built with, what is missing, and how to get it
    Doctor,
    /// Look whether an APK is as Android wants it
    CheckApk {
        /// The APK
        file: PathBuf,
    },
    /// Make packages of the C library, in target/package: for Linux with pkg-config and CMake files, for Android an AAR
    Package {
        /// Only these [default: all]
        #[arg(long = "target", value_name = "NAME", value_delimiter = ',')]
        targets: Vec<package::Target>,
    },
    /// Write the shader kit to target/kit: synthesis for engines that want no library
    Kit,
    /// The page: every method in a browser's WebGL 2, as files for any static host
    Web {
        /// Then serve them on this machine, to browsers here and, by `adb reverse tcp:8080 tcp:8080`, on a phone or headset
        #[arg(long)]
        serve: bool,
        /// As they were built before
        #[arg(long, requires = "serve")]
        as_built: bool,
        /// Where to serve; 0 for any free port
        #[arg(long, default_value_t = 8080, value_name = "NUMBER")]
        port: u16,
    },
    /// Formatting, clippy, documentation, each library by itself without its default features, and what would be published
    Lint,
}

fn main() -> ExitCode {
    match perform(Arguments::parse().task) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// False when what was looked at is not as it should be.
fn perform(task: Task) -> anyhow::Result<bool> {
    match task {
        Task::Setup => {
            if setup::ensure()?.complete() & setup::vulkan() {
                println!("everything is there");
            }
        }
        Task::Run { arguments } => {
            setup::ensure()?;
            cargo::run(
                &["run", "--release", "--package", "yoro-app", "--bin", "yoro", "--", "run"],
                &arguments,
            )?;
        }
        Task::Test { filters, packages, bless, jobs } => {
            testing::test(&testing::Options { filters, packages, bless, jobs })?;
        }
        Task::Apk { release, yes, openxr_loaders } => {
            android::apk(&android::Options { release, yes, openxr_loaders })?;
        }
        Task::Doctor => {
            let (text, complete) = android::doctor()?;
            show(&text);
            return Ok(complete);
        }
        Task::CheckApk { file } => {
            return android::check::check(&file);
        }
        Task::Package { targets } => drop(package::package(&targets)?),
        Task::Kit => drop(kit::kit()?),
        Task::Web { serve, as_built, port } => {
            let folder = if as_built { web::built()? } else { web::build()? };
            if serve {
                web::serve(&folder, port)?;
            }
        }
        Task::Lint => lint::lint()?,
    }
    Ok(true)
}

/// Prints; a reader such as `head` may have gone before the end.
fn show(text: &str) {
    let _ = io::stdout().write_all(text.as_bytes());
}
