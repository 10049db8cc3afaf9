//! Checks whether Android will install and start an APK. Only looks at the file, not at its sources.

use std::fs;
use std::path::Path;

use anyhow::{Context as _, bail};
use xtask::ndk::sdk;

use crate::archive::Archive;
use crate::public::Public;
use crate::report::Report;
use crate::store::Store;
use crate::{bundle, library, manifest, signature};

/// Maximum size in bytes of a release with its built-in scenes.
const SIZE_LIMIT: u64 = 8_000_000;

/// Runs all checks. With `any_key`, stores take what was signed for debugging.
///
/// # Errors
/// Fails if the file is missing or not an APK, or a tool for the checks is missing.
pub fn check(path: &Path, store: Store, any_key: bool) -> anyhow::Result<Report> {
    let shown = path.display();
    let bytes = fs::read(path)
        .with_context(|| format!("{shown} cannot be read (`cargo xtask apk` says where it puts an APK)"))?;
    let archive = Archive::read(&bytes).with_context(|| {
        format!("{shown} is damaged or no APK: build it anew by `cargo xtask apk --release`")
    })?;
    if bundle::is_bundle(|name| archive.has(name)) {
        return check_bundle(path, store, any_key);
    }
    if !archive.has("AndroidManifest.xml") {
        bail!("{shown} is an archive without AndroidManifest.xml, and so no APK: name the .apk file");
    }
    let mut report = Report::default();
    if store == Store::Play {
        report.equal("form", "APK", "a bundle: cargo xtask apk --release --bundle");
    }
    let manifest = manifest::Manifest::read(path)?;
    let size = bytes.len() as u64;
    let too_large = (size > SIZE_LIMIT && !manifest.is_debuggable())
        .then(|| format!("a release must be under {} MB", SIZE_LIMIT / 1_000_000));
    report.row("size", format!("{:.2} MB", size as f64 / 1e6), too_large);
    manifest.check(&archive, store, &mut report);
    signature::check(path, store == Store::None || any_key, &mut report)?;
    archive.check(store, manifest.unpacks_libraries(), &mut report);
    check_libraries(&archive, &mut report)?;
    Ok(report)
}

/// Checks a bundle: its layout, and the APK made from it, without its alignment, which is up to the store.
fn check_bundle(path: &Path, store: Store, any_key: bool) -> anyhow::Result<Report> {
    let mut report = Report::default();
    if store == Store::Quest {
        report.equal("form", "bundle", "an APK: cargo xtask apk --release --quest");
    }
    let apk = path.with_extension("checked.apk");
    bundle::check(path, &apk, &mut report)?;
    signature::check_jar(path, store == Store::None || any_key, &mut report)?;
    let manifest = manifest::Manifest::read(&apk)?;
    let archive = Archive::read(&fs::read(&apk).context("aapt2 has written no APK")?)?;
    manifest.check(&archive, store, &mut report);
    check_libraries(&archive, &mut report)?;
    for left in [apk.with_extension("proto.apk"), apk] {
        fs::remove_file(&left).with_context(|| format!("{} cannot be removed", left.display()))?;
    }
    Ok(report)
}

fn check_libraries(archive: &Archive, report: &mut Report) -> anyhow::Result<()> {
    let public = Public::of(sdk::folder("ANDROID_NDK_ROOT").as_deref());
    for (name, content) in archive.libraries() {
        library::check(name, content, &public, report)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_apk_is_refused_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("some.apk");
        let refusal = || check(&path, Store::None, false).unwrap_err().to_string();
        assert!(refusal().contains("some.apk cannot be read"));
        fs::write(&path, "no archive").unwrap();
        assert!(refusal().contains("some.apk is damaged or no APK"));
        let files = crate::archive::tests::archive(&["a.txt"], zip::CompressionMethod::Stored, 1);
        fs::write(&path, files).unwrap();
        assert!(refusal().contains("without AndroidManifest.xml"));
    }
}
