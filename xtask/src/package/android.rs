//! An AAR with prefab, which is how Gradle provides native libraries to CMake and ndk-build.

use std::path::{Path, PathBuf};

use crate::android::{LIBRARY_API, library_cargo};
use crate::folders::{copy, remove, root, target_folder, write};
use crate::ndk::target::ARCHITECTURES;
use crate::notices;

use super::texts::filled;
use super::{VERSION, build, copy_licences, zip};

/// The soname and file name. Android packages do not version libraries.
const LIBRARY: &str = "libyoro.so";

/// Builds and packs `yoro-VERSION.aar`, and returns its path.
pub fn aar(folder: &Path) -> anyhow::Result<PathBuf> {
    let packed = folder.join(format!("yoro-{VERSION}.aar"));
    let content = begin(&packed, "org.yoro.library", "yoro-c")?;
    let prefab = content.join("prefab");
    let module = prefab.join("modules/yoro");
    write(&prefab.join("prefab.json"), filled(include_str!("templates/prefab.json"), &[]))?;
    write(&module.join("module.json"), include_str!("templates/module.json"))?;
    copy(&root().join("app/engines/c/include/yoro.h"), &module.join("include/yoro.h"))?;
    let build_folder = target_folder()?.join("android/capi");
    for architecture in ARCHITECTURES {
        let cargo = library_cargo(architecture)?;
        let built = build(cargo, Some(architecture.triple), LIBRARY, &[], &build_folder)?;
        let place = module.join("libs").join(format!("android.{}", architecture.abi));
        let values = [("ABI", architecture.abi), ("API", &LIBRARY_API.to_string())];
        write(&place.join("abi.json"), filled(include_str!("templates/abi.json"), &values))?;
        copy(&built.shared, &place.join(LIBRARY))?;
        // Applications take libraries from here.
        copy(&built.shared, &content.join("jni").join(architecture.abi).join(LIBRARY))?;
    }
    zip(&content, packed)
}

/// Writes what every AAR has to a folder, and returns the folder: its manifest, the licences, and the notices of what a
/// package contains, where Java archives have them.
pub fn begin(packed: &Path, name: &str, package: &str) -> anyhow::Result<PathBuf> {
    let content = packed.with_extension("files");
    remove(&content)?;
    let values = [("PACKAGE", name), ("API", &LIBRARY_API.to_string())];
    let manifest = filled(include_str!("templates/AndroidManifest.xml"), &values);
    write(&content.join("AndroidManifest.xml"), manifest)?;
    let documents = content.join("META-INF");
    write(&documents.join(notices::FILE), notices::text(package, ARCHITECTURES[0].triple, &[])?)?;
    copy_licences(&documents)?;
    Ok(content)
}
