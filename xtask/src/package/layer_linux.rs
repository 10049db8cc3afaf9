//! The OpenXR API layer for Linux: an archive with the library and the manifest by which loaders find it.

use std::env::consts::ARCH;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::arm64;
use crate::cargo::cargo;
use crate::folders::{copy, remove, root, target_folder, write};
use crate::notices;

use super::linux::{run, tar};
use super::portable::{self, needed_glibc};
use super::{VERSION, compile};

/// The file name of the library.
pub const LIBRARY: &str = "libyoro_openxr_layer.so";
/// The manifest of an application's own layer, which also fits an installed one, apart from the library's path.
const MANIFEST: &str = "XR_APILAYER_YORO_one_view.json";
/// The folder of the manifest in the archive.
const PLACE: &str = "share/openxr/1/api_layers/explicit.d";

/// Makes the archive for this machine's processor.
pub fn native(folder: &Path) -> anyhow::Result<PathBuf> {
    pack(&native_library()?, ARCH, "strip", folder)
}

/// Makes the archive for arm64.
pub fn aarch64(folder: &Path) -> anyhow::Result<PathBuf> {
    pack(&aarch64_library()?, "aarch64", "llvm-strip", folder)
}

/// Builds the library for this machine's processor, and returns its path.
pub fn native_library() -> anyhow::Result<PathBuf> {
    build(cargo(), None, &target_folder()?)
}

/// Builds the library for arm64, and returns its path.
pub fn aarch64_library() -> anyhow::Result<PathBuf> {
    build(arm64::cargo()?, Some(arm64::TRIPLE), &target_folder()?.join("android/arm64/capi"))
}

fn build(mut cargo: Command, target: Option<&str>, folder: &Path) -> anyhow::Result<PathBuf> {
    portable::set_flags(&mut cargo);
    let (built, _) = compile(cargo, "yoro-openxr-layer", "cdylib", target, LIBRARY, &[], folder)?;
    Ok(built.join(LIBRARY))
}

fn pack(library: &Path, architecture: &str, strip: &str, folder: &Path) -> anyhow::Result<PathBuf> {
    let name = format!("yoro-openxr-layer-{VERSION}-linux-{architecture}");
    let content = folder.join(&name);
    remove(&content)?;
    let copied = content.join("lib").join(LIBRARY);
    copy(library, &copied)?;
    run(Command::new(strip).arg(&copied))?;
    let manifest = root().join("app/engines/openxr-layer/android").join(MANIFEST);
    let text = String::from_utf8(super::android::read(&manifest)?)?;
    write(&content.join(PLACE).join(MANIFEST), installed(&text))?;
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        copy(&root().join(licence), &content.join(licence))?;
    }
    let target = format!("{architecture}-unknown-linux-gnu");
    write(&content.join(notices::FILE), notices::text("yoro-openxr-layer", &target, &[])?)?;
    write(&content.join("README.md"), readme(architecture, needed_glibc(&copied)?))?;
    tar(folder, &name)
}

/// Returns the manifest of an explicit layer, whose library is in `lib` of the same archive. A loader takes the path as
/// relative to the manifest.
fn installed(manifest: &str) -> String {
    let up = "../".repeat(PLACE.split('/').count());
    let lines = manifest.lines().filter(|line| !line.contains("disable_environment"));
    let text = lines.collect::<Vec<_>>().join("\n").replace(LIBRARY, &format!("{up}lib/{LIBRARY}"));
    text.replace("\n    ],\n  }", "\n    ]\n  }") + "\n"
}

fn readme(architecture: &str, (major, minor): (u32, u32)) -> String {
    format!(
        "# yoro's OpenXR API layer {VERSION} for Linux on {architecture}\n\
         \n\
         An application that renders one view with depth is seen in stereo. Needs glibc {major}.{minor} or newer, and\n\
         OpenXR's loader. From this folder:\n\
         \n\
         ```sh\n\
         export XR_API_LAYER_PATH=$PWD/{PLACE}\n\
         XR_ENABLE_API_LAYERS=XR_APILAYER_YORO_one_view hello_xr -g Vulkan2 -vc Mono\n\
         ```\n\
         \n\
         Settings: `$XDG_CONFIG_HOME/yoro/layer.toml`, or variables such as `YORO_LAYER_DOMINANT=left`. The program yoro has\n\
         the same library, and installs it by `yoro layer install`.\n\
         \n\
         MIT or Apache 2.0, at your option; {} has the notices of others' code.\n",
        notices::FILE
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manifest_leads_to_the_library() {
        let manifest = root().join("app/engines/openxr-layer/android").join(MANIFEST);
        let text = installed(&std::fs::read_to_string(manifest).unwrap());
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let path = json["api_layer"]["library_path"].as_str().unwrap();
        let folder = tempfile::tempdir().unwrap();
        write(&folder.path().join("lib").join(LIBRARY), "").unwrap();
        write(&folder.path().join(PLACE).join(MANIFEST), &text).unwrap();
        assert!(folder.path().join(PLACE).join(path).is_file(), "{path}");
        assert!(json["api_layer"].get("disable_environment").is_none());
    }
}
