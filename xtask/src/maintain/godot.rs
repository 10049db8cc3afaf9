//! Godot, a game engine, with the runtime and the Vulkan driver that its tests need.
//!
//! The Debian release that [Monado](super::monado) comes from has an older Godot. This one comes from Debian's
//! development release, in whatever version it has, with all of its dependencies: the C library, Monado and Mesa of the
//! same day. The packages are only unpacked. There are two programs: `godot`, and `monado-service`, its OpenXR runtime.
//! They find each other through XDG_RUNTIME_DIR.

use std::path::PathBuf;

use super::monado;

const RELEASE: &str = "sid";
/// The runtime and the application must have the same version.
const PACKAGES: [&str; 4] = ["godot", "monado-service", "libopenxr1-monado", "mesa-vulkan-drivers"];

/// Sets up Godot, and returns how to use it.
pub fn usage() -> anyhow::Result<String> {
    let folder = make()?.display().to_string();
    Ok(format!(
        "{folder}/godot --path app/engines/godot --xr-mode off                 # needs a display: xvfb-run without one\n\
         export XDG_RUNTIME_DIR=$(mktemp -d)\n\
         {folder}/monado-service &\n\
         {folder}/godot --path app/engines/godot --xr-mode on\n"
    ))
}

/// Returns the folder with the programs `godot` and `monado-service`. Fetches and unpacks what is missing.
pub fn make() -> anyhow::Result<PathBuf> {
    let (folder, root) = monado::fetch("godot", RELEASE, &PACKAGES, "Godot for its tests: 200 MB")?;
    let program = root.join("usr/bin/godot");
    monado::write_launcher(&folder.join("godot"), monado::APPLICATION, &root, &[], &program)?;
    monado::write_service(&folder, &root)?;
    Ok(folder)
}
