//! The Immersive Web Emulation Runtime, which plays a headset to the page's tests: one script of an npm package.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, bail};
use yoro_tools::folders::{make_once, target_folder};

const PACKAGE: &str = "iwer@2.5.0";

/// Fetches it, unless it is here, and returns the script.
///
/// # Errors
/// When there is no npm, or it cannot fetch.
pub fn emulator() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("iwer");
    let script = folder.join("package/build/iwer.min.js");
    make_once(&folder, PACKAGE, || {
        fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
        let mut npm = Command::new("npm");
        npm.args(["pack", "--silent", PACKAGE]).current_dir(&folder);
        let output = npm.output().context("npm cannot be started: apt-get install npm")?;
        if !output.status.success() {
            bail!("npm cannot fetch {PACKAGE}: {}", String::from_utf8_lossy(&output.stderr).trim());
        }
        let archive = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        let unpacked = Command::new("tar").args(["-xzf", &archive]).current_dir(&folder).status();
        if !unpacked.context("tar cannot be started")?.success() || !script.is_file() {
            bail!("{PACKAGE} has not the script that was expected");
        }
        Ok(())
    })?;
    Ok(script)
}
