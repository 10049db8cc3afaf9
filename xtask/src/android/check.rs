//! `yoro-android-check`, which knows archives and libraries. It is a program of its own, so that only those who build for
//! Android wait for its dependencies.

use std::ffi::OsStr;
use std::path::{Path, absolute};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};
use yoro_tools::cargo;

fn command(arguments: &[&dyn AsRef<OsStr>]) -> anyhow::Result<Command> {
    let mut command = cargo::program("yoro-android-check")?;
    command.args(arguments);
    Ok(command)
}

/// Prints whether an APK is as Android wants it; true if it is.
///
/// # Errors
/// When the file is missing or no APK, or a tool for looking at it is missing.
pub fn check(apk: &Path) -> anyhow::Result<bool> {
    let apk = absolute(apk).context("the current folder is gone: change to another")?;
    match command(&[&"check", &apk])?.status().context("it cannot be started")?.code() {
        Some(0) => Ok(true),
        Some(1) => Ok(false),
        _ => bail!("{} cannot be checked: see above", apk.display()),
    }
}

/// Returns the processor that an OpenXR loader is for, by its folder in an APK.
///
/// # Errors
/// When it is no loader for a processor that the APK has libraries for.
pub fn loader_abi(file: &Path) -> anyhow::Result<String> {
    let file = absolute(file).context("the current folder is gone: change to another")?;
    let output = command(&[&"loader", &file])?.stderr(Stdio::inherit()).output();
    let output = output.context("it cannot be started")?;
    if !output.status.success() {
        bail!("{} cannot be taken along: see above", file.display());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Packs the files of a folder as an AAR.
///
/// # Errors
/// When it cannot be written.
pub fn pack(packed: &Path, folder: &Path) -> anyhow::Result<()> {
    let status = command(&[&"pack", &packed, &folder])?.status().context("it cannot be started")?;
    if !status.success() {
        bail!("{} cannot be packed: see above", packed.display());
    }
    Ok(())
}
