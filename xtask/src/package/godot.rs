//! The add-on for Godot: a zip with the folders of a project, as the Asset Library and the editor's import require.

use std::path::{Path, PathBuf};

use anyhow::ensure;

use crate::folders::{copy, read_text, remove};
use crate::godot::{ADDON, files};

use super::{VERSION, copy_licences};

/// Packs `yoro-godot-VERSION.zip`, and returns its path.
pub fn zip(folder: &Path) -> anyhow::Result<PathBuf> {
    let packed = folder.join(format!("yoro-godot-{VERSION}.zip"));
    let content = packed.with_extension("files");
    remove(&content)?;
    for (name, file) in files()?.into_iter().filter(|(name, _)| name.starts_with(ADDON)) {
        copy(&file, &content.join(name))?;
    }
    let version = format!("version=\"{VERSION}\"");
    let plugin = read_text(&content.join(ADDON).join("plugin.cfg"))?;
    ensure!(plugin.contains(&version), "app/engines/godot/{ADDON}/plugin.cfg does not say {version}");
    copy_licences(&content.join(ADDON))?;
    super::zip(&content, packed)
}
