//! Runs cargo.

use std::env;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail, ensure};

use crate::folders::{root, target_folder, write};

/// Returns the cargo that runs this program, in the workspace's root.
pub fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// Returns cargo's arguments that select these packages, or the whole workspace if there are none.
pub fn choice(packages: &[String]) -> Vec<&str> {
    if packages.is_empty() {
        return vec!["--workspace"];
    }
    packages.iter().flat_map(|package| ["--package", package.as_str()]).collect()
}

/// Prints the cargo command that is about to run.
pub fn announce(arguments: &[&str]) {
    eprintln!("$ cargo {}", arguments.join(" "));
}

/// Runs cargo in the user's folder. If it fails, this process exits with the same code.
pub fn run(arguments: &[&str], more: &[String]) -> anyhow::Result<()> {
    // The user's paths are relative to the user's current folder.
    let here = env::current_dir().context("the current folder is gone: change to another")?;
    let status = cargo()
        .current_dir(here)
        .args(&arguments[..1])
        .arg("--manifest-path")
        .arg(root().join("Cargo.toml"))
        .args(&arguments[1..])
        .args(more)
        .status()
        .context("cargo cannot be started")?;
    match status.code() {
        Some(0) => Ok(()),
        code => std::process::exit(code.unwrap_or(130)),
    }
}

/// Builds a program of the workspace, and returns the command that runs it in the workspace's root.
pub fn program(name: &str) -> anyhow::Result<Command> {
    // The features of the whole workspace, so that dependencies shared with the tests are not compiled twice.
    let arguments = ["build", "--quiet", "--workspace", "--bin", name];
    perform(cargo().args(arguments), &format!("{name} does not compile"))?;
    let mut command = Command::new(target_folder()?.join("debug").join(name));
    command.current_dir(root());
    Ok(command)
}

/// Runs a helper, which is a program of its own so that only those compile its dependencies who need it. Returns its
/// output, and true if it found no fault.
pub fn helper(name: &str, arguments: &[&str]) -> anyhow::Result<(String, bool)> {
    let output = program(name)?.args(arguments).output();
    let output = output.with_context(|| format!("{name} cannot be started"))?;
    match output.status.code() {
        Some(code @ (0 | 1)) => Ok((String::from_utf8_lossy(&output.stdout).into_owned(), code == 0)),
        _ => bail!("{}", String::from_utf8_lossy(&output.stderr).trim().trim_start_matches("error: ")),
    }
}

/// Installs a version of a program that cargo runs as `cargo NAME` in the project's own folder, and returns its path.
pub fn install(name: &str, version: &str) -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("tools");
    let (program, stamp) = (folder.join("bin").join(name), folder.join(name).with_extension(version));
    if program.is_file() && stamp.is_file() {
        return Ok(program);
    }
    let place = folder.display().to_string();
    // A debug build: it runs for seconds, so that optimizing it would take longer than it saves.
    let arguments = ["install", name, "--version", version, "--locked", "--debug", "--force", "--quiet"];
    let arguments = [&arguments[..], &["--no-track", "--root", &place]].concat();
    // A target folder of its own, so that the workspace's has no files that only this program needs.
    let mut command = cargo();
    command.args(arguments).env_remove("CARGO_TARGET_DIR");
    perform(&mut command, &format!("{name} {version} cannot be installed"))?;
    write(&stamp, "")?;
    Ok(program)
}

/// Runs cargo, and returns true if it succeeds.
pub fn succeeds(arguments: &[&str], environment: &[(&str, &str)]) -> bool {
    let mut command = cargo();
    perform(command.args(arguments).envs(environment.iter().copied()), "").is_ok()
}

/// Prints and runs a command of cargo's.
pub fn perform(command: &mut Command, failure: &str) -> anyhow::Result<()> {
    let arguments: Vec<_> = command.get_args().map(|argument| argument.to_string_lossy()).collect();
    announce(&arguments.iter().map(|argument| &**argument).collect::<Vec<_>>());
    let status = command.status().context("cargo cannot be started")?;
    ensure!(status.success(), "{failure}: see above");
    Ok(())
}

/// Runs cargo, and returns its standard output. Its messages go to standard error.
pub fn output(arguments: &[&str]) -> anyhow::Result<String> {
    let output = cargo().args(arguments).stdin(Stdio::null()).stderr(Stdio::inherit()).output();
    let output = output.context("cargo cannot be started")?;
    if !output.status.success() {
        bail!("cargo {} failed: see above", arguments[0]);
    }
    String::from_utf8(output.stdout).context("cargo prints something that is not text")
}
