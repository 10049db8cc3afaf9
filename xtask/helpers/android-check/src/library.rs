//! What Android's tools do not see of a native library: whether pages of 16 KiB suit it, and what it exports. Whether
//! Android has all names that it needs, the linker has seen to when it was built.

use std::fs;
use std::path::Path;

use anyhow::{Context as _, bail};
use goblin::elf::program_header::{PT_GNU_RELRO, PT_LOAD};
use goblin::elf::{Elf, header, sym};
use xtask::ndk::target::{ARCHITECTURES, Architecture, LOADER, PAGE};

use crate::check::Report;

/// The function that NativeActivity calls, and the one that every OpenXR loader exports.
const ENTRY: &str = "ANativeActivity_onCreate";
const LOADER_ENTRY: &str = "xrGetInstanceProcAddr";

/// Adds a row for a library `ABI/FILE`, which should be for one of these processors.
pub fn check(name: &str, content: &[u8], architectures: &[Architecture], report: &mut Report) {
    let (folder, file) = name.split_once('/').unwrap_or_default();
    let problems = match (architectures.iter().find(|known| known.abi == folder), Elf::parse(content)) {
        (None, _) => vec!["for a processor that this APK is not built for".to_owned()],
        (_, Err(error)) => vec![format!("no ELF file: {error}")],
        (Some(&architecture), Ok(elf)) if !is_for(&elf, architecture) => {
            vec![format!("no shared library for {folder}")]
        }
        // Libraries of others follow other build rules.
        (Some(_), Ok(elf)) if file == LOADER => lacks(&elf, LOADER_ENTRY).into_iter().collect(),
        (Some(_), Ok(elf)) => pages(&elf).into_iter().chain(lacks(&elf, ENTRY)).collect(),
    };
    let found = format!("{file}, {:.2} MB", content.len() as f64 / 1e6);
    report.row(&format!("{folder} library"), &found, (!problems.is_empty()).then(|| problems.join("; ")));
}

/// Returns the folder of an OpenXR loader in an APK.
pub fn loader_abi(file: &Path) -> anyhow::Result<&'static str> {
    const ADVICE: &str =
        "take libopenxr_loader.so of Khronos' openxr_loader_for_android, jni/arm64-v8a in its AAR";
    let content = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    let elf = Elf::parse(&content).with_context(|| format!("{} is no library: {ADVICE}", file.display()))?;
    if let Some(problem) = lacks(&elf, LOADER_ENTRY) {
        bail!("{} is no OpenXR loader: {problem}; {ADVICE}", file.display());
    }
    let architecture = ARCHITECTURES.iter().find(|architecture| is_for(&elf, **architecture));
    let none = || format!("{} is for none of the APK's processors: {ADVICE}", file.display());
    Ok(architecture.with_context(none)?.abi)
}

fn is_for(elf: &Elf<'_>, architecture: Architecture) -> bool {
    elf.is_64 && elf.header.e_type == header::ET_DYN && elf.header.e_machine == architecture.machine
}

fn lacks(elf: &Elf<'_>, entry: &str) -> Option<String> {
    let is_entry =
        |symbol: &sym::Sym| symbol.st_shndx != 0 && elf.dynstrtab.get_at(symbol.st_name) == Some(entry);
    (!elf.dynsyms.iter().any(|symbol| is_entry(&symbol))).then(|| format!("it does not export {entry}"))
}

fn pages(elf: &Elf<'_>) -> Vec<String> {
    let segments = elf.program_headers.iter().filter(|segment| segment.p_type == PT_LOAD);
    let is_wrong = |segment: &&goblin::elf::ProgramHeader| {
        !segment.p_align.is_power_of_two()
            || segment.p_align < PAGE
            || segment.p_vaddr % PAGE != segment.p_offset % PAGE
    };
    let mut problems: Vec<String> = segments
        .filter(is_wrong)
        .map(|segment| format!("the segment at {:#x} is aligned to {:#x}", segment.p_vaddr, segment.p_align))
        .collect();
    // The linker protects whole pages. If the end is not at a page boundary, either a part of the segment stays
    // writable, or data behind it becomes read-only.
    let relro = elf.program_headers.iter().find(|segment| segment.p_type == PT_GNU_RELRO);
    let end = relro.map_or(1, |segment| segment.p_vaddr + segment.p_memsz);
    if !end.is_multiple_of(PAGE) {
        problems.push(format!("what is read-only after relocation ends at {end:#x}"));
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Made with clang 14 and LLD of a C file that exports `ANativeActivity_onCreate`, and takes the addresses of
    /// `malloc`, of `eglSwapBuffers` and of a weak symbol; `-nostdlib -Wl,-s,-z,max-page-size=16384,-z,common-page-size=16384`.
    const GOOD: &[u8] = include_bytes!("../testdata/library.so");

    /// Replaces bytes, which are in the library once.
    fn with(from: &[u8], to: &[u8]) -> Vec<u8> {
        let mut bytes = GOOD.to_vec();
        let at = bytes.windows(from.len()).position(|window| window == from).unwrap();
        bytes[at..at + to.len()].copy_from_slice(to);
        bytes
    }

    fn loader() -> Vec<u8> {
        with(ENTRY.as_bytes(), format!("{LOADER_ENTRY}\0").as_bytes())
    }

    fn report(name: &str, content: &[u8]) -> String {
        let mut report = Report::default();
        check(name, content, &ARCHITECTURES, &mut report);
        report.text
    }

    #[test]
    fn each_fault_of_a_library_is_found() {
        let of = |content: &[u8]| report("arm64-v8a/libyoro.so", content);
        assert_eq!(of(GOOD), "  ok    arm64-v8a library  libyoro.so, 0.00 MB\n");
        let mut aligned = GOOD.to_vec();
        // The last eight bytes of the second program header are its alignment.
        aligned[64 + 2 * 56 - 8 + 1] = 0x10;
        let faults: [(Vec<u8>, &str); 5] = [
            (aligned, "aligned to 0x1000"),
            (with(&0x3bd8_u64.to_le_bytes(), &0x2bd8_u64.to_le_bytes()), "ends at 0xb000"),
            (loader(), "it does not export ANativeActivity_onCreate"),
            (with(&[183, 0, 1], &[62]), "no shared library for arm64-v8a"),
            (GOOD[..100].to_vec(), "no ELF file"),
        ];
        for (content, fault) in faults {
            assert!(of(&content).contains(fault), "{fault}: {}", of(&content));
        }
        assert!(report("armeabi-v7a/libyoro.so", GOOD).contains("not built for"));
    }

    #[test]
    fn a_loader_is_known_by_what_it_exports_and_its_processor() {
        let name = "arm64-v8a/libopenxr_loader.so";
        assert!(report(name, &loader()).starts_with("  ok"));
        assert!(report(name, GOOD).contains("it does not export xrGetInstanceProcAddr"));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("loader.so");
        let abi = |content: &[u8]| {
            fs::write(&file, content).unwrap();
            loader_abi(&file).map_err(|error| error.to_string())
        };
        assert_eq!(abi(&loader()), Ok("arm64-v8a"));
        assert!(abi(b"text").unwrap_err().contains("is no library"));
        assert!(abi(GOOD).unwrap_err().contains("no OpenXR loader"));
        let mut other = loader();
        other[18] = 40;
        assert!(abi(&other).unwrap_err().contains("none of the APK's"));
    }
}
