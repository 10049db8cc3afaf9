//! The OpenXR API layer for Android: an AAR with the library, and with its manifest in the folder in which loaders look
//! for an application's layers.

use std::env::consts::ARCH;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context as _;

use crate::folders::{root, target_folder};
use crate::ndk::target::{ARCHITECTURES, Architecture};

use super::android::{android_manifest, licences, pack, read};
use super::{VERSION, compile};

use crate::android::library_cargo;

const LIBRARY: &str = "libyoro_openxr_layer.so";
const MANIFEST: &str = "XR_APILAYER_YORO_one_view.json";

/// Builds and packs `yoro-openxr-layer-VERSION.aar`, and returns its path.
pub fn aar(folder: &Path) -> anyhow::Result<PathBuf> {
    aar_for(&ARCHITECTURES, folder)
}

/// Makes the AAR in a folder of its own for this machine's processor only, for the simulated Android host.
///
/// # Errors
/// Fails if it does not compile.
pub fn aar_for_tests() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("android/layer");
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let own = ARCHITECTURES.into_iter().find(|architecture| architecture.triple.starts_with(ARCH));
    aar_for(own.as_slice(), &folder)
}

fn aar_for(architectures: &[Architecture], folder: &Path) -> anyhow::Result<PathBuf> {
    let manifest = read(&root().join("app/engines/openxr-layer/android").join(MANIFEST))?;
    let mut files = vec![
        ("AndroidManifest.xml".to_owned(), android_manifest("org.yoro.layer").into()),
        (format!("assets/openxr/1/api_layers/implicit.d/{MANIFEST}"), manifest),
    ];
    files.extend(licences("yoro-openxr-layer")?);
    // Shared with the C library, which has the same dependencies.
    let build_folder = target_folder()?.join("android/capi");
    for &architecture in architectures {
        let cargo = library_cargo(architecture)?;
        let target = Some(architecture.triple);
        let (built, _) = compile(cargo, "yoro-openxr-layer", "cdylib", target, LIBRARY, &[], &build_folder)?;
        files.push((format!("jni/{}/{LIBRARY}", architecture.abi), read(&built.join(LIBRARY))?));
    }
    let packed = folder.join(format!("yoro-openxr-layer-{VERSION}.aar"));
    pack(&files, &packed)?;
    Ok(packed)
}
