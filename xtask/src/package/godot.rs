//! The add-on for Godot: a zip with the folders of a project, as the Asset Library and the editor's import require.

use std::path::{Path, PathBuf};

use anyhow::bail;

use crate::folders::{read, root};

use super::VERSION;
use super::android::pack;

use crate::godot::{ADDON, files};

/// Packs `yoro-godot-VERSION.zip`, and returns its path.
pub fn zip(folder: &Path) -> anyhow::Result<PathBuf> {
    let mut packed = Vec::new();
    for (name, file) in files()?.into_iter().filter(|(name, _)| name.starts_with(ADDON)) {
        packed.push((name, read(&file)?));
    }
    let plugin = format!("version=\"{VERSION}\"");
    let names_version = |(name, content): &(String, Vec<u8>)| {
        name.ends_with("plugin.cfg") && String::from_utf8_lossy(content).contains(&plugin)
    };
    if !packed.iter().any(names_version) {
        bail!("app/engines/godot/{ADDON}/plugin.cfg does not say {plugin}");
    }
    for name in ["LICENSE-APACHE", "LICENSE-MIT"] {
        packed.push((format!("{ADDON}/{name}"), read(&root().join(name))?));
    }
    let file = folder.join(format!("yoro-godot-{VERSION}.zip"));
    pack(&packed, &file)?;
    Ok(file)
}
