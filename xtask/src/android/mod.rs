//! The Android application: what builds it, the building, and the check of the result.

mod arm64;
mod build;
pub mod check;
mod keystore;
mod loader;
mod stand_in;
mod symbols;
mod toolchain;

use std::path::PathBuf;

use anyhow::Context as _;

pub use arm64::host_for_tests;
pub use build::{Options, apk, for_tests};
pub use toolchain::doctor;

/// The oldest Android that the application runs on (Android 10), as in android/Cargo.toml.
const MIN_API: u32 = 29;

/// The processors that the APK carries libraries for, as in android/Cargo.toml.
const ARCHITECTURES: [Architecture; 2] = [
    Architecture {
        triple: "aarch64-linux-android",
        abi: "arm64-v8a",
        machine: goblin::elf::header::EM_AARCH64,
    },
    Architecture { triple: "x86_64-linux-android", abi: "x86_64", machine: goblin::elf::header::EM_X86_64 },
];

/// A processor, by its names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Architecture {
    /// Rust's and LLVM's name.
    triple: &'static str,
    /// Android's name: the folder in the APK.
    abi: &'static str,
    /// ELF's number.
    machine: u16,
}

/// Android requires it of new applications: devices may have pages as large as this.
const PAGE: u64 = 16 * 1024;

/// Cargo's target folder, which this program lies in: `target/debug/xtask`.
///
/// # Errors
/// When this program lies elsewhere.
pub fn target_folder() -> anyhow::Result<PathBuf> {
    let program = std::env::current_exe().context("this program does not know where it lies")?;
    let folder = program.ancestors().nth(2).context("this program lies in no target folder")?;
    Ok(folder.to_owned())
}
