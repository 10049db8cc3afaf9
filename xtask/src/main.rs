//! Everything a person or CI types: `cargo xtask setup`, `run`, `test`, `lint`.

mod cargo;
mod setup;

use std::process::ExitCode;

use anyhow::bail;
use clap::{Parser, Subcommand};

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
    /// Formatting, clippy, documentation, and the library without the desktop program
    Lint,
}

fn main() -> ExitCode {
    match perform(Arguments::parse().task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn perform(task: Task) -> anyhow::Result<()> {
    match task {
        Task::Setup => {
            if setup::ensure()?.complete() {
                println!("everything is there");
            }
            Ok(())
        }
        Task::Run { arguments } => {
            setup::ensure()?;
            cargo::run(&["run", "--release", "--package", "yoro", "--", "run"], &arguments)
        }
        Task::Test { filters, bless } => {
            let libraries = setup::ensure()?;
            cargo::test(&filters, bless, &libraries)
        }
        Task::Lint => lint(),
    }
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
