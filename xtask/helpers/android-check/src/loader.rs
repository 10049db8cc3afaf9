//! OpenXR loaders of others, carried in an APK.

use std::fs;
use std::path::Path;

use anyhow::{Context as _, bail};
use goblin::elf::{Elf, header};
use xtask::ndk::target::ARCHITECTURES;

/// The function that every loader exports.
pub const ENTRY: &str = "xrGetInstanceProcAddr";

/// Returns the architecture of a loader as its folder name in an APK.
///
/// # Errors
/// Fails if the file is not a loader, or is for an architecture that the APK has no libraries for.
pub fn abi(file: &Path) -> anyhow::Result<&'static str> {
    let content =
        fs::read(file).with_context(|| format!("the OpenXR loader {} cannot be read", file.display()))?;
    let advice = "take libopenxr_loader.so of Khronos' openxr_loader_for_android, jni/arm64-v8a in its AAR";
    let elf = Elf::parse(&content).with_context(|| format!("{} is no library: {advice}", file.display()))?;
    let architecture = ARCHITECTURES.iter().find(|architecture| {
        elf.is_64 && elf.header.e_type == header::ET_DYN && elf.header.e_machine == architecture.machine
    });
    match architecture {
        Some(architecture) if exports(&elf) => Ok(architecture.abi),
        Some(_) => bail!("{} is no OpenXR loader, since it exports no {ENTRY}: {advice}", file.display()),
        None => bail!("{} is for none of the APK's processors: {advice}", file.display()),
    }
}

/// True if a library exports what a loader must export.
pub fn exports(elf: &Elf<'_>) -> bool {
    let mut names = elf
        .dynsyms
        .iter()
        .filter(|symbol| symbol.st_shndx != 0)
        .filter_map(|symbol| elf.dynstrtab.get_at(symbol.st_name));
    names.any(|name| name == ENTRY)
}
