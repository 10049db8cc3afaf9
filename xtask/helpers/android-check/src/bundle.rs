//! Application bundles (.aab) in the layout that Google's bundletool reads: a single module, `base`, with manifest and
//! resources as protocol buffers, and files with settings for bundletool.

use std::fs;
use std::io::{Cursor, Read as _, Write as _};
use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail, ensure};
use xtask::folders::write;
use xtask::ndk::sdk;
use xtask::ndk::target::ARCHITECTURES;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::report::Report;

/// `BundleConfig`: the bundletool version, and that libraries are uncompressed and aligned to 16 KiB pages.
const CONFIG: &str = "BundleConfig.pb";
/// `NativeLibraries`: the folder of each architecture.
const NATIVE: &str = "base/native.pb";
const MANIFEST: &str = "base/manifest/AndroidManifest.xml";
/// The bundletool version that has this layout.
const LAYOUT: &str = "1.15.6";

/// Encodes a number as a field of a protocol buffer.
fn number(field: u8, value: u8) -> Vec<u8> {
    vec![field << 3, value]
}

/// Encodes a text or message of less than 128 bytes as a field of a protocol buffer.
fn message(field: u8, content: &[u8]) -> Vec<u8> {
    [&[field << 3 | 2, content.len() as u8], content].concat()
}

/// Encodes `BundleConfig { bundletool { version }, optimizations { uncompress_native_libraries { enabled,
/// alignment: 16K } } }`.
fn config() -> Vec<u8> {
    let uncompressed = [number(1, 1), number(2, 2)].concat();
    [message(1, &message(2, LAYOUT.as_bytes())), message(2, &message(2, &uncompressed))].concat()
}

/// Encodes `NativeLibraries { directory { path, targeting { abi { alias } } } ... }`.
fn native() -> Vec<u8> {
    let directory = |abi: &str| {
        let alias = if abi == "arm64-v8a" { 3 } else { 5 };
        let targeting = message(1, &number(1, alias));
        message(1, &[message(1, format!("lib/{abi}").as_bytes()), message(2, &targeting)].concat())
    };
    ARCHITECTURES.iter().flat_map(|architecture| directory(architecture.abi)).collect()
}

/// Returns where a file of an APK is in a bundle's module, or `None` if bundles do not contain it.
fn place(name: &str) -> Option<String> {
    match name {
        "AndroidManifest.xml" => Some(MANIFEST.into()),
        "resources.pb" => Some("base/resources.pb".into()),
        _ if name.starts_with("META-INF/") => None,
        _ => ["res/", "lib/", "assets/"]
            .iter()
            .any(|folder| name.starts_with(folder))
            .then(|| format!("base/{name}")),
    }
}

fn aapt2(arguments: &[&str], from: &Path, to: &Path) -> anyhow::Result<()> {
    let aapt2 = sdk::build_tool("aapt2")?;
    let output = Command::new(&aapt2).args(arguments).arg("-o").arg(to).arg(from).output();
    let output = output.with_context(|| format!("{} cannot be started", aapt2.display()))?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "aapt2 cannot convert {}: {}", from.display(), said.trim());
    Ok(())
}

/// Copies the files of an archive, each to the path that `place` returns.
fn copy(
    from: &Path,
    zip: &mut ZipWriter<Cursor<Vec<u8>>>,
    place: impl Fn(&str) -> Option<String>,
) -> anyhow::Result<()> {
    let bytes = fs::read(from).with_context(|| format!("{} cannot be read", from.display()))?;
    let mut archive = ZipArchive::new(Cursor::new(bytes))?;
    for index in 0..archive.len() {
        let mut file = archive.by_index(index)?;
        if let Some(name) = place(&file.name()?) {
            let mut content = Vec::new();
            file.read_to_end(&mut content)?;
            zip.start_file(name, SimpleFileOptions::default())?;
            zip.write_all(&content)?;
        }
    }
    Ok(())
}

/// Makes an unsigned bundle from a finished APK.
///
/// # Errors
/// Fails if aapt2 is missing or rejects the APK, or a file cannot be read or written.
pub fn make(apk: &Path, bundle: &Path) -> anyhow::Result<()> {
    let converted = bundle.with_extension("proto.apk");
    aapt2(&["convert", "--output-format", "proto"], apk, &converted)?;
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in [(CONFIG, config()), (NATIVE, native())] {
        zip.start_file(name, SimpleFileOptions::default())?;
        zip.write_all(&content)?;
    }
    copy(&converted, &mut zip, place)?;
    fs::remove_file(&converted).with_context(|| format!("{} cannot be removed", converted.display()))?;
    write(bundle, zip.finish()?.into_inner())
}

/// True if an archive with these file names is a bundle.
pub fn is_bundle(names: impl Fn(&str) -> bool) -> bool {
    names(CONFIG)
}

/// Adds rows for the layout. Converts the module to an unsigned APK for the other checks, as bundletool would.
///
/// # Errors
/// Fails if aapt2 is missing, or cannot read the manifest or the resources.
pub fn check(bundle: &Path, apk: &Path, report: &mut Report) -> anyhow::Result<()> {
    let bytes = fs::read(bundle).with_context(|| format!("{} cannot be read", bundle.display()))?;
    let mut archive = ZipArchive::new(Cursor::new(bytes))?;
    let mut content = |name: &str| {
        let mut content = Vec::new();
        let read = archive.by_name(name).ok()?.read_to_end(&mut content);
        read.ok().map(|_| content)
    };
    if content(MANIFEST).is_none() || content("base/resources.pb").is_none() {
        bail!(
            "{} has no {MANIFEST} or no base/resources.pb: build it anew by `cargo xtask apk --release --bundle`",
            bundle.display()
        );
    }
    let told = |name: &str, wanted: Vec<u8>, found: Option<Vec<u8>>| {
        (found != Some(wanted)).then(|| format!("{name} is not as bundletool wants it"))
    };
    let problem = told(CONFIG, config(), content(CONFIG)).or_else(|| told(NATIVE, native(), content(NATIVE)));
    report.row("layout", format!("bundletool {LAYOUT}: one module, a folder for each processor"), problem);
    let strange: Vec<String> = archive
        .file_names()
        .filter_map(|name| name.ok().map(std::borrow::Cow::into_owned))
        .filter(|name| {
            !["base/", "META-INF/"].iter().any(|folder| name.starts_with(folder)) && name != CONFIG
        })
        .collect();
    let problem = (!strange.is_empty()).then(|| format!("bundletool refuses {}", strange.join(" ")));
    report.row("modules", "base", problem);

    let converted = apk.with_extension("proto.apk");
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    copy(bundle, &mut zip, |name| {
        if name == MANIFEST {
            return Some("AndroidManifest.xml".into());
        }
        name.strip_prefix("base/").filter(|name| *name != "native.pb").map(str::to_owned)
    })?;
    write(&converted, zip.finish()?.into_inner())?;
    aapt2(&["convert", "--output-format", "binary"], &converted, apk)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_protocol_buffers_are_those_of_bundletool() {
        // Encoded by hand from config.proto and files.proto.
        let config_bytes = b"\x0a\x08\x12\x061.15.6\x12\x06\x12\x04\x08\x01\x10\x02";
        assert_eq!(config(), config_bytes);
        let native_bytes =
            b"\x0a\x15\x0a\x0dlib/arm64-v8a\x12\x04\x0a\x02\x08\x03\x0a\x12\x0a\x0alib/x86_64\x12\x04\x0a\x02\x08\x05";
        assert_eq!(native(), native_bytes);
        assert_eq!(place("AndroidManifest.xml").as_deref(), Some(MANIFEST));
        assert_eq!(place("lib/x86_64/liba.so").as_deref(), Some("base/lib/x86_64/liba.so"));
        assert_eq!((place("META-INF/CERT.SF"), place("other.txt")), (None, None));
    }
}
