//! Archives: those of folders, and application bundles (.aab) in the layout that Google's bundletool reads: a single
//! module, `base`, with manifest and resources as protocol buffers, and files with settings for bundletool.

use std::fs::{self, File};
use std::io::{Cursor, Read as _, Write as _};
use std::path::Path;
use std::process::Command;

use anyhow::Context as _;
use xtask::console::run;
use xtask::folders::{files, write};
use xtask::ndk::sdk;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::check::Report;

/// `BundleConfig`: the version of bundletool that has this layout.
pub const CONFIG: &str = "BundleConfig.pb";
const NATIVE: &str = "base/native.pb";
const MANIFEST: &str = "base/manifest/AndroidManifest.xml";
/// The files for bundletool: `BundleConfig { bundletool { version: "1.15.6" }, optimizations { uncompress_native_libraries {
/// enabled, alignment: 16K } } }`, and `NativeLibraries { directory { path, targeting { abi { alias } } } ... }` with a folder
/// for each architecture. A field is its number times 8, plus 2 for a text or a message, which follows its length.
const SETTINGS: [(&str, &[u8]); 2] = [
    (CONFIG, b"\x0a\x08\x12\x061.15.6\x12\x06\x12\x04\x08\x01\x10\x02"),
    (
        NATIVE,
        b"\x0a\x15\x0a\x0dlib/arm64-v8a\x12\x04\x0a\x02\x08\x03\x0a\x12\x0a\x0alib/x86_64\x12\x04\x0a\x02\x08\x05",
    ),
];

/// The names and contents of files.
pub type Files = Vec<(String, Vec<u8>)>;

/// Packs the files of a folder, sorted by name so that the same files result in the same archive.
pub fn pack(folder: &Path, packed: &Path) -> anyhow::Result<()> {
    let read = |(name, path): (String, _)| {
        let content = fs::read(&path).with_context(|| format!("{name} cannot be read"))?;
        anyhow::Ok((name, content))
    };
    zip(&files(folder)?.into_iter().map(read).collect::<anyhow::Result<Files>>()?, packed)
}

fn zip(files: &Files, packed: &Path) -> anyhow::Result<()> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in files {
        zip.start_file(name, SimpleFileOptions::default())?;
        zip.write_all(content)?;
    }
    write(packed, zip.finish()?.into_inner())
}

/// Returns the files in an archive.
pub fn unzip(packed: &Path) -> anyhow::Result<Files> {
    let zip = ZipArchive::new(File::open(packed)?);
    let mut zip = zip.with_context(|| format!("{} is damaged, or no archive", packed.display()))?;
    let mut files = Files::new();
    for index in 0..zip.len() {
        let mut file = zip.by_index(index)?;
        let mut content = Vec::new();
        file.read_to_end(&mut content)?;
        files.push((file.name()?.into_owned(), content));
    }
    Ok(files)
}

/// Makes an unsigned bundle from a finished APK.
pub fn make(apk: &Path, bundle: &Path) -> anyhow::Result<()> {
    let converted = bundle.with_extension("proto.apk");
    convert("proto", apk, &converted)?;
    let settings = SETTINGS.map(|(name, content)| (name.to_owned(), content.to_owned()));
    let placed = unzip(&converted)?.into_iter().filter_map(|(name, content)| Some((place(&name)?, content)));
    zip(&settings.into_iter().chain(placed).collect(), bundle)?;
    fs::remove_file(&converted).with_context(|| format!("{} cannot be removed", converted.display()))
}

/// Returns where a file of an APK is in a bundle's module, or `None` if bundles do not contain it.
fn place(name: &str) -> Option<String> {
    match name {
        "AndroidManifest.xml" => Some(MANIFEST.into()),
        "resources.pb" => Some("base/resources.pb".into()),
        _ => {
            ["res/", "lib/", "assets/"].iter().any(|it| name.starts_with(it)).then(|| format!("base/{name}"))
        }
    }
}

/// Adds a row for the layout. Converts the module to an unsigned APK for the other checks, as bundletool would.
pub fn check(files: Files, apk: &Path, report: &mut Report) -> anyhow::Result<()> {
    let is_in = |(wanted, bytes): &(&str, &[u8])| {
        files.iter().any(|(name, content)| name == wanted && content == bytes)
    };
    let is_known = |name: &str| name.starts_with("base/") || name.starts_with("META-INF/") || name == CONFIG;
    let wrong = SETTINGS.iter().filter(|setting| !is_in(setting)).map(|(name, _)| *name);
    let strange = files.iter().map(|(name, _)| name.as_str()).filter(|name| !is_known(name));
    let wrong: Vec<&str> = wrong.chain(strange).collect();
    let problem = (!wrong.is_empty()).then(|| format!("bundletool wants no such {}", wrong.join(", ")));
    report.row("layout", "one module, a folder for each processor", problem);

    let module = files.into_iter().filter_map(|(name, content)| match name.as_str() {
        MANIFEST => Some(("AndroidManifest.xml".to_owned(), content)),
        NATIVE => None,
        _ => Some((name.strip_prefix("base/")?.to_owned(), content)),
    });
    let converted = apk.with_extension("proto.apk");
    zip(&module.collect(), &converted)?;
    convert("binary", &converted, apk)?;
    fs::remove_file(&converted).with_context(|| format!("{} cannot be removed", converted.display()))
}

fn convert(format: &str, from: &Path, to: &Path) -> anyhow::Result<()> {
    let mut aapt2 = Command::new(sdk::build_tool("aapt2")?);
    run(aapt2.args(["convert", "--output-format", format, "-o"]).arg(to).arg(from)).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_packed_with_its_paths_and_to_the_same_bytes_again() {
        let names = ["AndroidManifest.xml", "jni/x86_64/lib.so"];
        let packed = |names: [&str; 2]| {
            let folder = tempfile::tempdir().unwrap();
            for name in names {
                write(&folder.path().join("content").join(name), name).unwrap();
            }
            let packed = folder.path().join("packed.aar");
            pack(&folder.path().join("content"), &packed).unwrap();
            (fs::read(&packed).unwrap(), unzip(&packed).unwrap())
        };
        let first = packed(names);
        assert!(first == packed([names[1], names[0]]));
        assert_eq!(first.1, names.map(|name| (name.to_owned(), name.as_bytes().to_owned())));
    }
}
