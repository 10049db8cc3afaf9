//! cargo-apk, which builds the application.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};
use yoro_tools::folders::target_folder;

use super::keystore;

const CARGO_APK: &str = "0.10.0";

/// Installs cargo-apk, of the one version that this works with, in the project's own folder. Returns its path.
///
/// # Errors
/// When it cannot be installed.
pub fn ensure() -> anyhow::Result<PathBuf> {
    let folder = folder()?;
    let program = program(&folder);
    if is_cargo_apk(&program) {
        return Ok(program);
    }
    // It only starts other programs: optimising it would take longer than it saves.
    let mut install = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    install
        .args(["install", "cargo-apk", "--version", CARGO_APK, "--locked", "--debug", "--force", "--quiet"])
        .args(["--no-track", "--root"])
        .arg(&folder)
        // The target folder of the workspace keeps what only the APK needs out.
        .env_remove("CARGO_TARGET_DIR");
    eprintln!("$ cargo install cargo-apk --version {CARGO_APK} --locked --root {}", folder.display());
    let status = install.status().context("cargo cannot be started")?;
    if !status.success() {
        bail!("cargo-apk {CARGO_APK} cannot be installed: see above");
    }
    Ok(program)
}

fn folder() -> anyhow::Result<PathBuf> {
    Ok(target_folder()?.join("tools"))
}

fn program(folder: &Path) -> PathBuf {
    folder.join("bin/cargo-apk")
}

fn is_cargo_apk(program: &Path) -> bool {
    let version = Command::new(program).args(["apk", "version"]).output();
    let wanted = format!("cargo-apk {CARGO_APK}");
    version.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim() == wanted)
}

/// Describes what the build brings along: cargo-apk and the key.
///
/// # Errors
/// When the target folder is not known.
pub fn extras() -> anyhow::Result<[(&'static str, String); 2]> {
    let program = program(&folder()?);
    let tool = if is_cargo_apk(&program) {
        program.display().to_string()
    } else {
        format!("version {CARGO_APK} will be installed: {}", program.display())
    };
    Ok([("cargo-apk", tool), ("release key", keystore::describe())])
}
