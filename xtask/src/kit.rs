//! The shader kit: the synthesis shaders, the layout of their uniforms, and a header that fills them.

use std::path::PathBuf;

use crate::cargo;
use crate::folders::target_folder;

/// Writes the kit to `target/kit`, and returns the folder.
pub fn kit() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("kit");
    let path = folder.display().to_string();
    let arguments = ["run", "--quiet", "--package", "yoro-c", "--example", "kit", "--", &path];
    cargo::perform(cargo::cargo().args(arguments), "the kit cannot be written")?;
    println!("{path}");
    Ok(folder)
}
