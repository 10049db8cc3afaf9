//! The package for three.js, as `npm publish` would send it.

use std::path::{Path, PathBuf};

use anyhow::ensure;

use super::{VERSION, copy_licences};
use crate::console::run;
use crate::folders::{copy_folder, read_text, remove, root};
use crate::web::npm;

const SOURCE: &str = "app/engines/three";

/// Packs `yoro-three-VERSION.tgz`, and returns its path.
pub fn tarball(folder: &Path) -> anyhow::Result<PathBuf> {
    let staged = folder.join("three");
    remove(&staged)?;
    copy_folder(&root().join(SOURCE), &staged)?;
    copy_licences(&staged)?;
    let manifest = read_text(&staged.join("package.json"))?;
    let version = format!("\"version\": \"{VERSION}\"");
    ensure!(manifest.contains(&version), "{SOURCE}/package.json does not say {version}");
    let mut command = npm();
    command.args(["pack", "--silent", "--pack-destination"]).arg(folder).current_dir(&staged);
    run(&mut command)?;
    remove(&staged)?;
    let file = folder.join(format!("yoro-three-{VERSION}.tgz"));
    println!("{}", file.display());
    Ok(file)
}
