//! OpenXR loaders of somebody else's that an APK is to carry: they win over the application's own way to the runtime, and
//! bring API layers.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use goblin::elf::{Elf, header};
use yoro_tools::ndk::target::ARCHITECTURES;

/// The name that the application looks for.
pub const FILE: &str = "libopenxr_loader.so";
/// What makes a library a loader.
pub const ENTRY: &str = "xrGetInstanceProcAddr";

/// Copies in the folder that cargo-apk packs, one below it for each processor, until this is dropped.
pub struct Loaders(Vec<PathBuf>);

impl Loaders {
    /// Copies each file to where its processor's libraries are.
    ///
    /// # Errors
    /// When one is no loader for a processor that the APK has libraries for, or cannot be copied.
    pub fn place(files: &[PathBuf], folder: &Path) -> anyhow::Result<Self> {
        let mut placed = Loaders(Vec::new());
        for file in files {
            let content = fs::read(file)
                .with_context(|| format!("the OpenXR loader {} cannot be read", file.display()))?;
            let copy = folder.join(abi(file, &content)?).join(FILE);
            if placed.0.contains(&copy) {
                bail!("{} is the second OpenXR loader for one processor: name one of them", file.display());
            }
            fs::copy(file, &copy).with_context(|| format!("{} cannot be written", copy.display()))?;
            placed.0.push(copy);
        }
        Ok(placed)
    }
}

impl Drop for Loaders {
    fn drop(&mut self) {
        for copy in &self.0 {
            fs::remove_file(copy).ok();
        }
    }
}

/// The processor that a loader is for.
fn abi(file: &Path, content: &[u8]) -> anyhow::Result<&'static str> {
    let advice = "take libopenxr_loader.so of Khronos' openxr_loader_for_android, jni/arm64-v8a in its AAR";
    let elf = Elf::parse(content).with_context(|| format!("{} is no library: {advice}", file.display()))?;
    let architecture = ARCHITECTURES.iter().find(|architecture| {
        elf.is_64 && elf.header.e_type == header::ET_DYN && elf.header.e_machine == architecture.machine
    });
    match architecture {
        Some(architecture) if exports(&elf) => Ok(architecture.abi),
        Some(_) => bail!("{} is no OpenXR loader, since it exports no {ENTRY}: {advice}", file.display()),
        None => bail!("{} is for none of the APK's processors: {advice}", file.display()),
    }
}

/// Whether a library exports what a loader must.
pub fn exports(elf: &Elf<'_>) -> bool {
    let mut names = elf
        .dynsyms
        .iter()
        .filter(|symbol| symbol.st_shndx != 0)
        .filter_map(|symbol| elf.dynstrtab.get_at(symbol.st_name));
    names.any(|name| name == ENTRY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_loader_is_refused_and_nothing_stays() {
        let folder = tempfile::tempdir().unwrap();
        for architecture in ARCHITECTURES {
            fs::create_dir(folder.path().join(architecture.abi)).unwrap();
        }
        let refusal = |file: &Path| {
            let files = [file.to_owned()];
            Loaders::place(&files, folder.path()).err().expect("no loader").to_string()
        };
        assert!(refusal(Path::new("/absent.so")).contains("/absent.so cannot be read"));
        let text = folder.path().join("text.so");
        fs::write(&text, "text").unwrap();
        assert!(refusal(&text).contains("is no library"));
        // A program of this machine: for one of the APK's processors, perhaps, but no loader.
        let program = std::env::current_exe().unwrap();
        let sentence = refusal(&program);
        assert!(
            sentence.contains("no OpenXR loader") || sentence.contains("none of the APK's"),
            "{sentence}"
        );
        for architecture in ARCHITECTURES {
            assert_eq!(fs::read_dir(folder.path().join(architecture.abi)).unwrap().count(), 0);
        }
    }
}
