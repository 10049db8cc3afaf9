//! Direct3D 11 and 12 on Vulkan, for tests of the shader kit: DXVK, and vkd3d with its compiler of HLSL.
//!
//! They come from Debian packages, which are only unpacked. Debian has DXVK's native libraries in sid alone, which moves
//! and keeps no earlier versions, so none is pinned. `run PROGRAM ...` runs a program with these libraries.

use std::path::{Path, PathBuf};

use anyhow::bail;

use super::monado::{unpack_with_needs, write_launcher};
use crate::folders::{make_once, target_folder};

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
    if !cfg!(target_arch = "x86_64") {
        bail!("it is fetched for x86_64 only");
    }
    let folder = target_folder()?.join("direct3d");
    let root = folder.join("root");
    make_once(&folder, &format!("{RELEASE} {}\n", PACKAGES.join(" ")), || {
        eprintln!("fetching vkd3d and DXVK for the tests: 110 MB, once");
        unpack_with_needs(&folder, &root, RELEASE, &PACKAGES.map(str::to_owned))
    })?;
    let launcher = include_str!("launchers/direct3d.sh");
    write_launcher(&folder.join("run"), launcher, &root, &[], Path::new(""))?;
    Ok(folder)
}
