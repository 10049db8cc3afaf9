//! Runs `yoro-android-check`, which works with archives and libraries.

use std::path::{Path, absolute};

use clap::ValueEnum;

use super::toolchain;
use crate::{apt, cargo, console};

/// A store that an APK or a bundle is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Store {
    /// Meta Horizon Store
    Quest,
    /// Google Play
    Play,
}

fn run(arguments: &[&str]) -> anyhow::Result<(String, bool)> {
    cargo::helper("yoro-android-check", arguments)
}

fn text(path: &Path) -> anyhow::Result<String> {
    // The helper runs in the workspace's root.
    Ok(absolute(path)?.display().to_string())
}

/// Checks whether Android will install and start an APK, or whether a store takes it, and prints the result. Returns true
/// if so, `apart_from` the rules `any-key` (it may be signed for debugging) and `any-size`. Installs Android's own tools if
/// they are missing.
pub fn check(apk: &Path, store: Option<Store>, apart_from: &[&str]) -> anyhow::Result<bool> {
    apt::install_missing(toolchain::check_tools, true)?;
    let store = match store {
        None => "-",
        Some(Store::Quest) => "quest",
        Some(Store::Play) => "play",
    };
    let apk = text(apk)?;
    let (report, passed) = run(&[&["check", &apk, store][..], apart_from].concat())?;
    console::print(&report);
    Ok(passed)
}

/// Returns the architecture of an OpenXR loader as its folder name in an APK.
pub fn loader_abi(file: &Path) -> anyhow::Result<String> {
    Ok(run(&["loader", &text(file)?])?.0)
}

/// Makes an unsigned bundle from an APK.
pub fn bundle(apk: &Path, bundle: &Path) -> anyhow::Result<()> {
    run(&["bundle", &text(apk)?, &text(bundle)?]).map(drop)
}

/// Packs the files of a folder as a zip.
pub fn pack(packed: &Path, folder: &Path) -> anyhow::Result<()> {
    run(&["pack", &text(packed)?, &text(folder)?]).map(drop)
}
