//! Everything a person or CI types: `cargo xtask setup`, `run`, `test`, `lint`, `apk`, `doctor`, `check-apk`,
//! `monado`.

mod android;
mod apt;
mod cargo;
mod monado;
mod packages;
mod setup;

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::{Parser, Subcommand};

use cargo::{Equipment, Equipped};

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
        /// Only tests whose names contain one of these
        filters: Vec<String>,
        /// Renew the golden images of tests/golden instead of comparing with them
        #[arg(long)]
        bless: bool,
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
    /// Set up Monado, an OpenXR runtime with a simulated headset, beside the system, and say how to use it
    Monado,
    /// Formatting, clippy, documentation, and the library without the desktop program
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
            if setup::ensure()?.complete() {
                println!("everything is there");
            }
        }
        Task::Run { arguments } => {
            setup::ensure()?;
            cargo::run(&["run", "--release", "--package", "yoro", "--", "run"], &arguments)?;
        }
        Task::Test { filters, bless } => {
            let equipment = equip(&filters)?;
            cargo::test(&filters, bless, &equipment)?;
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
            let report = android::check::check(&file)?;
            show(&report.to_string());
            return Ok(report.passed());
        }
        Task::Monado => show(&monado::usage()?),
        Task::Lint => lint()?,
    }
    Ok(true)
}

/// Prints; a reader such as `head` may have gone before the end.
fn show(text: &str) {
    let _ = io::stdout().write_all(text.as_bytes());
}

/// Installs and builds what the tests need that have one of the filters in their names.
fn equip(filters: &[String]) -> anyhow::Result<Equipment> {
    let osmesa = setup::ensure()?.osmesa;
    let wants = |part| cargo::wants("yoro-android-host", filters, part);
    let apk = if wants("") { android::for_tests()? } else { Equipped::NotWanted };
    // A machine of arm64 runs that library by itself.
    let foreign = cfg!(target_arch = "x86_64");
    let arm64 = match apk {
        Equipped::At(_) if foreign && wants("arm64") => android::host_for_tests()?,
        _ => Equipped::NotWanted,
    };
    // A few chosen tests are not worth the wait for an installation.
    let all = filters.is_empty();
    let absent = if all { Equipped::Missing } else { Equipped::NotWanted };
    let browser = setup::browser(all).map_or(absent, Equipped::At);
    let monado =
        if cargo::wants("yoro", filters, "monado") { monado::for_tests() } else { Equipped::NotWanted };
    Ok(Equipment { osmesa, apk, arm64, browser, monado })
}

fn lint() -> anyhow::Result<()> {
    let checks: [&[&str]; 4] = [
        &["fmt", "--all", "--check"],
        &["clippy", "--workspace", "--all-targets", "--", "--deny", "warnings"],
        &["check", "--package", "yoro", "--lib", "--no-default-features"],
        &["doc", "--workspace", "--no-deps"],
    ];
    let failed: Vec<String> = checks
        .iter()
        .filter(|check| !cargo::succeeds(check, &[("RUSTDOCFLAGS", "--deny warnings")]))
        .map(|check| format!("cargo {}", check[0]))
        .collect();
    if !failed.is_empty() {
        bail!("{} found something: see above", failed.join(", "));
    }
    println!("lint: nothing to say");
    Ok(())
}
