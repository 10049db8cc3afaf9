//! The add-on for Godot: its development project, and its tests.

mod pictures;
pub(crate) mod session;
mod test;

use std::path::PathBuf;

use clap::Subcommand;

use crate::folders::{self, copy, remove, root, target_folder};
use crate::kit;

pub use test::test;

/// The add-on's folder in a project.
pub const ADDON: &str = "addons/yoro";

#[derive(Subcommand)]
pub enum Task {
    /// Write the demo project with the add-on into target/godot-project, to be opened in Godot
    Project,
    /// Run the demo in both renderers, on a screen and on Monado, and compare both eyes with Godot's own
    Test,
}

/// Writes the project with the kit's shaders, and returns its folder. Keeps the files that Godot has imported there.
pub fn project() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("godot-project");
    for part in ["addons", "demo", "test"] {
        remove(&folder.join(part))?;
    }
    for (name, file) in files()? {
        copy(&file, &folder.join(name))?;
    }
    println!("{}", folder.display());
    Ok(folder)
}

/// Returns the project's files, with their names in the project.
pub fn files() -> anyhow::Result<Vec<(String, PathBuf)>> {
    let mut files = folders::files(&root().join("app/engines/godot"))?;
    // Of the hidden files, only those that make Godot ignore a folder.
    files.retain(|(name, _)| name.split('/').all(|part| !part.starts_with('.') || part == ".gdignore"));
    for (name, file) in folders::files(&kit::kit()?.join("godot"))? {
        // The add-on uses three passes. The others are only tested to compile.
        let used = ["tiles.glsl", "spans.glsl", "march.glsl"].contains(&name.as_str());
        let folder = if used { format!("{ADDON}/shaders") } else { "test/kit".to_owned() };
        files.push((format!("{folder}/{name}"), file));
    }
    Ok(files)
}
