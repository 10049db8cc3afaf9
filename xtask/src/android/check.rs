//! Runs `yoro-android-check`, which works with archives and libraries. It is a separate program so that only people who
//! build for Android have to compile its dependencies.

use std::ffi::OsStr;
use std::path::{Path, PathBuf, absolute};

use anyhow::{Context as _, bail};
use clap::ValueEnum;

use crate::{cargo, console};

/// Returns the program's output, and true if it found no fault.
///
/// # Errors
/// Fails with the program's own message.
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

/// A store that an APK or a bundle is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Store {
    /// Meta Horizon Store
    Quest,
    /// Google Play
    Play,
}

/// Checks whether Android will install and start an APK, or whether a store takes it, and prints the result. Returns true
/// if so. With `any_key`, it may be signed for debugging.
///
/// # Errors
/// Fails if the file is missing or not an APK, or a tool for the checks is missing.
pub fn check(apk: &Path, store: Option<Store>, any_key: bool) -> anyhow::Result<bool> {
    let store = match store {
        None => "-",
        Some(Store::Quest) => "quest",
        Some(Store::Play) => "play",
    };
    let apk = absolute_path(apk)?;
    let mut arguments: Vec<&dyn AsRef<OsStr>> = vec![&"check", &apk, &store];
    if any_key {
        arguments.push(&"any-key");
    }
    let (report, passed) = run(&arguments)?;
    console::print(&report);
    Ok(passed)
}

/// Returns the architecture of an OpenXR loader as its folder name in an APK.
///
/// # Errors
/// Fails if the file is not a loader, or is for an architecture that the APK has no libraries for.
pub fn loader_abi(file: &Path) -> anyhow::Result<String> {
    Ok(run(&[&"loader", &absolute_path(file)?])?.0)
}

/// Makes an unsigned bundle from an APK.
///
/// # Errors
/// Fails if aapt2 is missing or rejects the APK, or the bundle cannot be written.
pub fn bundle(apk: &Path, bundle: &Path) -> anyhow::Result<()> {
    run(&[&"bundle", &absolute_path(apk)?, &absolute_path(bundle)?])?;
    Ok(())
}

/// Packs the files of a folder as an AAR.
///
/// # Errors
/// Fails if the AAR cannot be written.
pub fn pack(packed: &Path, folder: &Path) -> anyhow::Result<()> {
    run(&[&"pack", &packed, &folder])?;
    Ok(())
}
