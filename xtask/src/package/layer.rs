//! The OpenXR API layer. For Android an AAR with the library, and with its manifest in the folder in which loaders look for
//! an application's layers; for Linux an archive with the library and the manifest by which loaders find it.

use std::env::consts::ARCH;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::android::library_cargo;
use crate::folders::{copy, make, read_text, root, target_folder, write};
use crate::ndk::target::{ARCHITECTURES, Architecture};

use super::android::begin;
use super::linux::Machine;
use super::portable::needed_glibc;
use super::texts::readme;
use super::{VERSION, compile, zip};

/// The file name of the library.
pub const LIBRARY: &str = "libyoro_openxr_layer.so";
const PACKAGE: &str = "yoro-openxr-layer";
/// The manifest of an application's own layer, which also fits an installed one, apart from the library's path.
pub const MANIFEST: &str = "XR_APILAYER_YORO_one_view.json";
/// The folder of the manifest in the archive.
const PLACE: &str = "share/openxr/1/api_layers/explicit.d";

fn manifest() -> PathBuf {
    root().join("app/engines/openxr-layer/android").join(MANIFEST)
}

/// Builds and packs `yoro-openxr-layer-VERSION.aar`, and returns its path.
pub fn aar(folder: &Path) -> anyhow::Result<PathBuf> {
    // Shared with the C library, which has the same dependencies.
    let build_folder = target_folder()?.join("android/capi");
    aar_for(&ARCHITECTURES, folder, &build_folder, |_| ())
}

/// Makes the AAR in a folder of its own for this machine's processor only, for the simulated Android host. It is hardly
/// optimized.
pub fn aar_for_tests() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("android/layer");
    make(&folder)?;
    let own = ARCHITECTURES.into_iter().find(|architecture| architecture.triple.starts_with(ARCH));
    aar_for(own.as_slice(), &folder, &folder.join("build"), |cargo| {
        cargo.envs([("CARGO_PROFILE_CAPI_LTO", "off"), ("CARGO_PROFILE_CAPI_OPT_LEVEL", "1")]);
        cargo.env("CARGO_PROFILE_CAPI_CODEGEN_UNITS", "16");
    })
}

fn aar_for(
    architectures: &[Architecture],
    folder: &Path,
    build_folder: &Path,
    adapt: fn(&mut Command),
) -> anyhow::Result<PathBuf> {
    let packed = folder.join(format!("yoro-openxr-layer-{VERSION}.aar"));
    let content = begin(&packed, "org.yoro.layer", PACKAGE)?;
    copy(&manifest(), &content.join("assets/openxr/1/api_layers/implicit.d").join(MANIFEST))?;
    for &architecture in architectures {
        let mut cargo = library_cargo(architecture)?;
        adapt(&mut cargo);
        let target = Some(architecture.triple);
        let (built, _) = compile(cargo, PACKAGE, "cdylib", target, LIBRARY, &[], build_folder)?;
        copy(&built.join(LIBRARY), &content.join("jni").join(architecture.abi).join(LIBRARY))?;
    }
    zip(&content, packed)
}

/// Builds the library for Linux, and returns its path.
pub fn library(machine: Machine) -> anyhow::Result<PathBuf> {
    let (target, folder) = (machine.target(), machine.folder()?);
    let (built, _) = compile(machine.cargo()?, PACKAGE, "cdylib", target, LIBRARY, &[], &folder)?;
    Ok(built.join(LIBRARY))
}

/// Makes the archive for Linux, and returns its path.
pub fn archive(machine: Machine, folder: &Path) -> anyhow::Result<PathBuf> {
    let library = library(machine)?;
    machine.pack(folder, PACKAGE, PACKAGE, "", |content| {
        let copied = content.join("lib").join(LIBRARY);
        copy(&library, &copied)?;
        machine.strip(&[], &copied)?;
        write(&content.join(PLACE).join(MANIFEST), installed(&read_text(&manifest())?))?;
        let template = include_str!("templates/README.layer.txt");
        Ok(readme(template, machine.architecture(), needed_glibc(&copied)?))
    })
}

/// Returns the manifest of an explicit layer, whose library is in `lib` of the same archive. A loader takes the path as
/// relative to the manifest.
fn installed(manifest: &str) -> String {
    let up = "../".repeat(PLACE.split('/').count());
    explicit_manifest(manifest, &format!("{up}lib/{LIBRARY}"))
}

/// Returns the manifest of an explicit layer with the library at this path.
pub fn explicit_manifest(manifest: &str, library: &str) -> String {
    let lines = manifest.lines().filter(|line| !line.contains("disable_environment"));
    let text = lines.collect::<Vec<_>>().join("\n").replace(LIBRARY, library);
    text.replace("\n    ],\n  }", "\n    ]\n  }") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manifest_leads_to_the_library() {
        let text = installed(&read_text(&manifest()).unwrap());
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let path = json["api_layer"]["library_path"].as_str().unwrap();
        let folder = tempfile::tempdir().unwrap();
        write(&folder.path().join("lib").join(LIBRARY), "").unwrap();
        write(&folder.path().join(PLACE).join(MANIFEST), &text).unwrap();
        assert!(folder.path().join(PLACE).join(path).is_file(), "{path}");
        assert!(json["api_layer"].get("disable_environment").is_none());
    }
}
