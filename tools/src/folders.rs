//! Where the workspace and its target folder are.

use std::path::{Path, PathBuf};

use anyhow::Context as _;

/// The workspace's folder.
pub fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_owned()
}

/// Cargo's target folder, which this program lies in: `target/debug/xtask`.
///
/// # Errors
/// When this program lies elsewhere.
pub fn target_folder() -> anyhow::Result<PathBuf> {
    let program = std::env::current_exe().context("this program does not know where it lies")?;
    let folder = program.ancestors().nth(2).context("this program lies in no target folder")?;
    Ok(folder.to_owned())
}
