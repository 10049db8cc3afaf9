//! `yoro-android-check`, which knows archives and libraries. It is a program of its own, so that only those who build
//! for Android wait for its dependencies.

use std::ffi::OsStr;
use std::path::{Path, PathBuf, absolute};

use anyhow::{Context as _, bail};
use yoro_tools::{cargo, console};

/// Returns the text that the program printed, and true if it found no fault.
///
/// # Errors
/// The program's own sentence.
fn run(arguments: &[&dyn AsRef<OsStr>]) -> anyhow::Result<(String, bool)> {
    let mut command = cargo::program("yoro-android-check")?;
    let output = command.args(arguments).output().context("yoro-android-check cannot be started")?;
    match output.status.code() {
        Some(code @ (0 | 1)) => Ok((String::from_utf8_lossy(&output.stdout).into_owned(), code == 0)),
        _ => {
            let said = String::from_utf8_lossy(&output.stderr);
            bail!("{}", said.trim().trim_start_matches("error: "))
        }
    }
}

fn absolute_path(path: &Path) -> anyhow::Result<PathBuf> {
    absolute(path).context("the current folder is gone: change to another")
}

/// Prints whether an APK is as Android wants it; true if it is.
///
/// # Errors
/// When the file is missing or no APK, or a tool for looking at it is missing.
pub fn check(apk: &Path) -> anyhow::Result<bool> {
    let (report, passed) = run(&[&"check", &absolute_path(apk)?])?;
    console::print(&report);
    Ok(passed)
}

/// Returns the processor that an OpenXR loader is for, by its folder in an APK.
///
/// # Errors
/// When it is no loader for a processor that the APK has libraries for.
pub fn loader_abi(file: &Path) -> anyhow::Result<String> {
    Ok(run(&[&"loader", &absolute_path(file)?])?.0)
}

/// Makes a bundle, not signed, of an APK.
///
/// # Errors
/// When aapt2 is missing or refuses the APK, or the bundle cannot be written.
pub fn bundle(apk: &Path, bundle: &Path) -> anyhow::Result<()> {
    run(&[&"bundle", &absolute_path(apk)?, &absolute_path(bundle)?])?;
    Ok(())
}

/// Packs the files of a folder as an AAR.
///
/// # Errors
/// When it cannot be written.
pub fn pack(packed: &Path, folder: &Path) -> anyhow::Result<()> {
    run(&[&"pack", &packed, &folder])?;
    Ok(())
}
