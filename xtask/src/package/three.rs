//! The package for three.js, as `npm publish` would send it.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};

use super::VERSION;
use crate::folders::{copy, copy_folder, remove, root};
use crate::web::npm;

const SOURCE: &str = "app/engines/three";

/// Packs `yoro-three-VERSION.tgz`, and returns its path.
pub fn tarball(folder: &Path) -> anyhow::Result<PathBuf> {
    let staged = folder.join("three");
    remove(&staged)?;
    copy_folder(&root().join(SOURCE), &staged)?;
    for name in ["LICENSE-APACHE", "LICENSE-MIT"] {
        copy(&root().join(name), &staged.join(name))?;
    }
    let manifest = fs::read_to_string(staged.join("package.json")).context("package.json cannot be read")?;
    if !manifest.contains(&format!("\"version\": \"{VERSION}\"")) {
        bail!("{SOURCE}/package.json does not say \"version\": \"{VERSION}\"");
    }
    let mut command = npm();
    command.args(["pack", "--silent", "--pack-destination"]).arg(folder).current_dir(&staged);
    let output = command.output().context("npm cannot be started: apt-get install npm")?;
    if !output.status.success() {
        bail!("npm cannot pack {SOURCE}: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    remove(&staged)?;
    let file = folder.join(format!("yoro-three-{VERSION}.tgz"));
    println!("{}", file.display());
    Ok(file)
}
