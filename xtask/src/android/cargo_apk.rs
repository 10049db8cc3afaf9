//! cargo-apk, which builds the application.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::folders::target_folder;

use super::keystore;

const CARGO_APK: &str = "0.10.0";

/// Installs the required version of cargo-apk in the project's own folder, and returns its path.
///
/// # Errors
/// Fails if cargo-apk cannot be installed.
pub fn ensure() -> anyhow::Result<PathBuf> {
    let folder = folder()?;
    let program = program(&folder);
    if is_cargo_apk(&program) {
        return Ok(program);
    }
    // A debug build: cargo-apk only starts other programs, so optimizing it would take longer than it saves.
    let mut install = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    install
        .args(["install", "cargo-apk", "--version", CARGO_APK, "--locked", "--debug", "--force", "--quiet"])
        .args(["--no-track", "--root"])
        .arg(&folder)
        // A target folder of its own, so that the workspace's has no files that only the APK needs.
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

/// Describes what the build provides itself: cargo-apk and the key.
///
/// # Errors
/// Fails if the target folder is unknown.
pub fn extras() -> anyhow::Result<[(&'static str, String); 2]> {
    let program = program(&folder()?);
    let tool = if is_cargo_apk(&program) {
        program.display().to_string()
    } else {
        format!("version {CARGO_APK} will be installed: {}", program.display())
    };
    Ok([("cargo-apk", tool), ("release key", keystore::describe())])
}
