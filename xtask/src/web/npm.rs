//! npm packages that check the page: an emulated headset for its tests, and a type checker.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::folders::{make_once, root, target_folder};

/// Returns the script of the Immersive Web Emulation Runtime, which emulates a headset in the page's tests.
///
/// # Errors
/// Fails if npm is missing, or cannot fetch the package.
pub fn emulator() -> anyhow::Result<PathBuf> {
    fetch("iwer", "iwer@2.5.0", "build/iwer.min.js")
}

/// Checks the types of the page's scripts by their JSDoc comments. Returns true if no fault was found. If the type
/// checker is not available, prints a message and returns true.
///
/// # Errors
/// Fails if Node cannot be started.
pub fn check_types() -> anyhow::Result<bool> {
    let compiler = match fetch("typescript", "typescript@5.9.3", "lib/tsc.js") {
        Ok(compiler) => compiler,
        Err(error) => {
            println!("the types of the page's scripts were not checked: {error:#}");
            return Ok(true);
        }
    };
    let project = root().join("app/vr/web/tsconfig.json");
    let status = Command::new("node").arg(compiler).arg("--project").arg(project).status();
    Ok(status.context("node cannot be started: apt-get install nodejs")?.success())
}

/// Fetches a package without its dependencies unless it exists, and returns the path of one of its scripts.
fn fetch(name: &str, package: &str, script: &str) -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join(name);
    let script = folder.join("package").join(script);
    make_once(&folder, package, || {
        fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
        let mut npm = Command::new("npm");
        npm.args(["pack", "--silent", package]).current_dir(&folder);
        let output = npm.output().context("npm cannot be started: apt-get install npm")?;
        if !output.status.success() {
            bail!("npm cannot fetch {package}: {}", String::from_utf8_lossy(&output.stderr).trim());
        }
        let archive = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        let unpacked = Command::new("tar").args(["-xzf", &archive]).current_dir(&folder).status();
        if !unpacked.context("tar cannot be started")?.success() || !script.is_file() {
            bail!("{package} has not the script that was expected");
        }
        Ok(())
    })?;
    Ok(script)
}
