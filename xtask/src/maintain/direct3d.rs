//! Direct3D 11 and 12 on Vulkan, for tests of the shader kit: DXVK, and vkd3d with its compiler of HLSL.
//!
//! They come from Debian packages, which are only unpacked. Debian has DXVK's native libraries in sid alone, which moves
//! and keeps no earlier versions, so none is pinned. `run PROGRAM ...` runs a program with these libraries.

use std::path::{Path, PathBuf};

use super::monado::{fetch, write_launcher};

const RELEASE: &str = "sid";
const PACKAGES: [&str; 6] = [
    "vkd3d-compiler",
    "libvkd3d-dev",
    "libdxvk-native-dev",
    "libdxvk-d3d11-0",
    "libdxvk-dxgi0",
    "mesa-vulkan-drivers",
];

/// Returns the folder of the launcher and of the root. Fetches and unpacks them unless the folder is complete.
pub(crate) fn make() -> anyhow::Result<PathBuf> {
    let (folder, root) = fetch("direct3d", RELEASE, &PACKAGES, "vkd3d and DXVK for the tests: 110 MB")?;
    let launcher = include_str!("launchers/direct3d.sh");
    write_launcher(&folder.join("run"), launcher, &root, &[], Path::new(""))?;
    Ok(folder)
}
