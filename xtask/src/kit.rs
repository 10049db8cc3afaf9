//! The shader kit: the synthesis shaders, the layout of their uniforms, and a header that fills them.

use std::path::PathBuf;

use anyhow::bail;

use crate::cargo;
use crate::folders::{copy, root, target_folder};

/// The passes for three.js in its package.
const THREE: &str = "app/engines/three/src/shaders.js";

/// Writes the kit to `target/kit`, and returns the folder.
///
/// # Errors
/// Fails if the program that writes it does not compile, or the folder cannot be written.
pub fn kit() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("kit");
    let path = folder.display().to_string();
    if !cargo::succeeds(&["run", "--quiet", "--package", "yoro-c", "--example", "kit", "--", &path], &[]) {
        bail!("the kit cannot be written: see above");
    }
    println!("{path}");
    Ok(folder)
}

/// Renews the shaders of the package for three.js, and returns a text on what to check next.
///
/// # Errors
/// Those of [`kit`]; fails if the file cannot be written.
pub fn three() -> anyhow::Result<String> {
    copy(&kit()?.join("three/shaders.js"), &root().join(THREE))?;
    Ok(format!("written: look at `git diff {THREE}`\n"))
}
