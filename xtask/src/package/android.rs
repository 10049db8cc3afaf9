//! An AAR with prefab, which is how Gradle provides native libraries to CMake and ndk-build.

use std::path::{Path, PathBuf};

use crate::folders::{read, remove, root, target_folder, write};
use crate::ndk::target::{ARCHITECTURES, Architecture};
use crate::notices;

use super::{VERSION, build};

use crate::android::{LIBRARY_API, check, library_cargo};

/// The soname and file name. Android packages do not version libraries.
const LIBRARY: &str = "libyoro.so";

/// Builds and packs `yoro-VERSION.aar`, and returns its path.
pub fn aar(folder: &Path) -> anyhow::Result<PathBuf> {
    let header = read(&root().join("app/engines/c/include/yoro.h"))?;
    let mut files: Vec<(String, Vec<u8>)> = vec![
        ("AndroidManifest.xml".into(), android_manifest("org.yoro.library").into()),
        ("prefab/prefab.json".into(), prefab().into()),
        ("prefab/modules/yoro/module.json".into(), module().into()),
        ("prefab/modules/yoro/include/yoro.h".into(), header),
    ];
    files.extend(licences("yoro-c")?);
    let build_folder = target_folder()?.join("android/capi");
    for architecture in ARCHITECTURES {
        let cargo = library_cargo(architecture)?;
        let built = build(cargo, Some(architecture.triple), LIBRARY, &[], &build_folder)?;
        let library = read(&built.shared)?;
        let place = format!("prefab/modules/yoro/libs/android.{}", architecture.abi);
        files.push((format!("{place}/abi.json"), abi(architecture).into()));
        files.push((format!("{place}/{LIBRARY}"), library.clone()));
        // Applications take libraries from here.
        files.push((format!("jni/{}/{LIBRARY}", architecture.abi), library));
    }
    let packed = folder.join(format!("yoro-{VERSION}.aar"));
    pack(&files, &packed)?;
    Ok(packed)
}

/// Writes an AAR with these files.
pub fn pack(files: &[(String, Vec<u8>)], packed: &Path) -> anyhow::Result<()> {
    let content = packed.with_extension("files");
    remove(&content)?;
    for (name, bytes) in files {
        write(&content.join(name), bytes)?;
    }
    check::pack(packed, &content)?;
    remove(&content)?;
    println!("{}", packed.display());
    Ok(())
}

/// Returns the licences, and the notices of what a package contains, under the names that Java archives use.
pub fn licences(package: &str) -> anyhow::Result<Vec<(String, Vec<u8>)>> {
    let mut files = vec![(
        format!("META-INF/{}", notices::FILE),
        notices::text(package, ARCHITECTURES[0].triple, &[])?.into_bytes(),
    )];
    for name in ["LICENSE-APACHE", "LICENSE-MIT"] {
        files.push((format!("META-INF/{name}"), read(&root().join(name))?));
    }
    Ok(files)
}

/// Returns the manifest of an AAR.
pub fn android_manifest(package: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n\
         <manifest xmlns:android=\"http://schemas.android.com/apk/res/android\" package=\"{package}\">\n\
         \x20 <uses-sdk android:minSdkVersion=\"{LIBRARY_API}\"/>\n\
         </manifest>\n"
    )
}

fn prefab() -> String {
    let text = serde_json::json!({
        "schema_version": 2, "name": "yoro", "version": VERSION, "dependencies": []
    });
    format!("{text:#}\n")
}

fn module() -> String {
    format!("{:#}\n", serde_json::json!({ "export_libraries": [], "library_name": "libyoro" }))
}

fn abi(architecture: Architecture) -> String {
    let text = serde_json::json!({
        "abi": architecture.abi, "api": LIBRARY_API, "ndk": 27, "stl": "none", "static": false
    });
    format!("{text:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefab_has_the_version_and_the_api_level() {
        assert!(prefab().contains(&format!("\"version\": \"{VERSION}\"")));
        assert!(android_manifest("org.yoro.library").contains("minSdkVersion=\"30\""));
        assert!(abi(ARCHITECTURES[0]).contains("\"api\": 30"));
    }
}
