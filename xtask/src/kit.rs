//! The shader kit: the synthesis shaders, the layout of their uniforms, and a header that fills them.

use std::path::PathBuf;

use anyhow::bail;

use crate::cargo;
use crate::folders::target_folder;

/// Writes the kit to `target/kit`, and returns the folder.
pub fn kit() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("kit");
    let path = folder.display().to_string();
    if !cargo::succeeds(&["run", "--quiet", "--package", "yoro-c", "--example", "kit", "--", &path], &[]) {
        bail!("the kit cannot be written: see above");
    }
    println!("{path}");
    Ok(folder)
}
