//! The archive: the files in it, and their offsets.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, Read as _, Write as _};
use std::path::Path;

use anyhow::Context as _;
use xtask::folders::write;
use xtask::ndk::target::PAGE;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::report::{Report, some};
use super::store::Store;

/// Android maps this file out of the APK.
const RESOURCES: &str = "resources.arsc";

/// The content of an APK.
#[derive(Debug, Default)]
pub struct Archive {
    entries: BTreeMap<String, Entry>,
    libraries: BTreeMap<String, Vec<u8>>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Offset of the content in the archive, in bytes.
    offset: u64,
    stored: bool,
}

impl Archive {
    /// Reads the whole archive, which detects damage anywhere in it.
    ///
    /// # Errors
    /// Fails if the bytes are not a zip archive, or are damaged.
    pub fn read(bytes: &[u8]) -> anyhow::Result<Self> {
        let mut zip = ZipArchive::new(Cursor::new(bytes))?;
        let mut archive = Self::default();
        for index in 0..zip.len() {
            let mut file = zip.by_index(index)?;
            let name = file.name()?.into_owned();
            let offset = file.data_start().context("an entry has no content")?;
            let entry = Entry { offset, stored: file.compression() == CompressionMethod::Stored };
            let mut content = Vec::new();
            file.read_to_end(&mut content).with_context(|| format!("{name} in it is damaged"))?;
            if name.starts_with("lib/") {
                archive.libraries.insert(name.clone(), content);
            }
            archive.entries.insert(name, entry);
        }
        Ok(archive)
    }

    /// True if the archive has a file with this name.
    pub fn has(&self, name: &str) -> bool {
        self.entries.contains_key(name)
    }

    /// Returns the names and contents of the native libraries. The names include the folders.
    pub fn libraries(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.libraries.iter().map(|(name, content)| (name.as_str(), content.as_slice()))
    }

    /// True if a native library is compressed.
    pub fn compresses_libraries(&self) -> bool {
        self.entries.iter().any(|(name, entry)| name.starts_with("lib/") && !entry.stored)
    }

    /// Adds rows for the architectures, and for the alignment of the files that Android maps out of the archive. These
    /// include the libraries unless they are `unpacked` at installation.
    pub fn check(&self, store: Store, unpacked: bool, report: &mut Report) {
        let mut found: Vec<&str> = self.libraries.keys().filter_map(|name| name.split('/').nth(1)).collect();
        found.dedup();
        report.equal("architectures", &found.join(" "), &store.abis().join(" "));

        let stored: Vec<_> = self.entries.iter().filter(|(_, entry)| entry.stored).collect();
        let wrong: Vec<&str> = stored
            .iter()
            .filter(|(name, entry)| {
                let mapped_library = !unpacked && name.starts_with("lib/");
                !entry.offset.is_multiple_of(if mapped_library { PAGE } else { 4 })
            })
            .map(|(name, _)| name.as_str())
            .collect();
        let problem = if !wrong.is_empty() {
            Some(format!("{} must lie at a multiple of 4 bytes, mapped libraries of 16 KiB", some(&wrong)))
        } else {
            let compressed = self.entries.get(RESOURCES).is_some_and(|entry| !entry.stored);
            compressed.then(|| format!("{RESOURCES} is compressed: Android 11 and later refuse it"))
        };
        let (total, count) = (self.entries.len(), stored.len());
        report.row("alignment", format!("{total} files, {count} of them uncompressed"), problem);
    }
}

/// Packs the files of a folder, sorted by name so that the same files result in the same archive.
///
/// # Errors
/// Fails if a file cannot be read or written.
pub fn pack(folder: &Path, packed: &Path) -> anyhow::Result<()> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    add(&mut zip, folder, "")?;
    write(packed, zip.finish()?.into_inner())
}

fn add(zip: &mut ZipWriter<Cursor<Vec<u8>>>, folder: &Path, prefix: &str) -> anyhow::Result<()> {
    let unreadable = |path: &Path| format!("{} cannot be read", path.display());
    let entries = fs::read_dir(folder).with_context(|| unreadable(folder))?;
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        let name = format!("{prefix}{}", path.file_name().unwrap_or_default().to_string_lossy());
        if path.is_dir() {
            add(zip, &path, &format!("{name}/"))?;
        } else {
            zip.start_file(name, SimpleFileOptions::default())?;
            zip.write_all(&fs::read(&path).with_context(|| unreadable(&path))?)?;
        }
    }
    Ok(())
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Makes an archive of files with this content. Uncompressed files are at multiples of `alignment`.
    pub fn archive(names: &[&str], method: CompressionMethod, alignment: u16) -> Vec<u8> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().compression_method(method).with_alignment(alignment);
        for name in names {
            zip.start_file(*name, options).unwrap();
            zip.write_all(b"something that can be compressed, compressed, compressed").unwrap();
        }
        zip.finish().unwrap().into_inner()
    }

    const LIBRARIES: [&str; 2] = ["lib/arm64-v8a/libyoro.so", "lib/x86_64/libyoro.so"];

    fn problems(bytes: &[u8]) -> Vec<String> {
        let mut report = Report::default();
        Archive::read(bytes).unwrap().check(Store::None, false, &mut report);
        report.problems().into_iter().map(str::to_owned).collect()
    }

    #[test]
    fn compressed_libraries_lie_anywhere() {
        let none: [&str; 0] = [];
        assert_eq!(problems(&archive(&LIBRARIES, CompressionMethod::Deflated, 1)), none);
    }

    #[test]
    fn uncompressed_libraries_lie_on_pages() {
        let none: [&str; 0] = [];
        assert_eq!(problems(&archive(&LIBRARIES, CompressionMethod::Stored, 16384)), none);
        assert_eq!(problems(&archive(&LIBRARIES, CompressionMethod::Stored, 4096)), ["alignment"]);
    }

    #[test]
    fn libraries_that_are_unpacked_lie_on_words() {
        let passes = |alignment| {
            let mut report = Report::default();
            let bytes = archive(&LIBRARIES, CompressionMethod::Stored, alignment);
            Archive::read(&bytes).unwrap().check(Store::None, true, &mut report);
            report.passed()
        };
        assert!(passes(4));
    }

    #[test]
    fn uncompressed_files_lie_on_words() {
        // With one of these name lengths, the last file's content is at an offset that is not aligned.
        let odd = (0..4).any(|n| {
            let long = format!("{}{RESOURCES}", "x".repeat(n));
            problems(&archive(&[long.as_str()], CompressionMethod::Stored, 1))
                .contains(&"alignment".to_owned())
        });
        assert!(odd);
    }

    #[test]
    fn resources_are_not_compressed() {
        let mut names = LIBRARIES.to_vec();
        names.push(RESOURCES);
        assert_eq!(problems(&archive(&names, CompressionMethod::Deflated, 1)), ["alignment"]);
    }

    #[test]
    fn both_architectures_are_wanted() {
        assert_eq!(problems(&archive(&LIBRARIES[..1], CompressionMethod::Deflated, 1)), ["architectures"]);
        let more = [LIBRARIES[0], "lib/armeabi-v7a/libyoro.so", LIBRARIES[1]];
        assert_eq!(problems(&archive(&more, CompressionMethod::Deflated, 1)), ["architectures"]);
        for (libraries, passes) in [(&LIBRARIES[..1], true), (&LIBRARIES[..], false)] {
            let mut report = Report::default();
            let bytes = archive(libraries, CompressionMethod::Deflated, 1);
            Archive::read(&bytes).unwrap().check(Store::Quest, true, &mut report);
            assert_eq!(report.passed(), passes, "{report}");
        }
    }

    #[test]
    fn a_folder_is_packed_with_its_paths_and_to_the_same_bytes_again() {
        let files = ["jni/x86_64/lib.so", "AndroidManifest.xml"];
        let packed = |names: [&str; 2]| {
            let folder = tempfile::tempdir().unwrap();
            for name in names {
                write(&folder.path().join("content").join(name), name).unwrap();
            }
            let packed = folder.path().join("packed.aar");
            pack(&folder.path().join("content"), &packed).unwrap();
            fs::read(packed).unwrap()
        };
        let bytes = packed(files);
        assert!(bytes == packed([files[1], files[0]]));
        let mut zip = ZipArchive::new(Cursor::new(bytes)).unwrap();
        let names: Vec<String> =
            (0..2).map(|i| zip.by_index(i).unwrap().name().unwrap().into_owned()).collect();
        assert_eq!(names, ["AndroidManifest.xml", "jni/x86_64/lib.so"]);
    }

    #[test]
    fn damage_is_found_anywhere() {
        let bytes = archive(&LIBRARIES, CompressionMethod::Deflated, 1);
        assert!(Archive::read(&bytes).is_ok());
        assert!(Archive::read(b"").is_err());
        assert!(Archive::read(b"no archive at all").is_err());
        assert!(Archive::read(&bytes[..bytes.len() / 2]).is_err());
        let mut damaged = bytes;
        // Change a byte in the first file's compressed content, which follows its header of 30 bytes and its name.
        damaged[30 + LIBRARIES[0].len() + 10] ^= 0x55;
        assert!(Archive::read(&damaged).is_err());
    }
}
