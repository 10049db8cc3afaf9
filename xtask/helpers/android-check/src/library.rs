//! Checks whether Android's linker will load a native library and find every symbol that it needs.

use std::collections::BTreeSet;

use goblin::elf::program_header::{PF_W, PF_X, PT_GNU_RELRO, PT_LOAD, PT_TLS};
use goblin::elf::section_header::SHN_UNDEF;
use goblin::elf::sym::STB_WEAK;
use goblin::elf::{Elf, Sym, dynamic, header};
use xtask::ndk::target::{ARCHITECTURES, Architecture, LOADER, MIN_API, PAGE};

use super::loader;
use super::public::Public;
use super::report::{Report, some};

/// The function that NativeActivity calls.
const ENTRY: &str = "ANativeActivity_onCreate";

/// Adds rows for a library with this name in the APK.
///
/// # Errors
/// Fails if the public symbols cannot be determined.
pub fn check(name: &str, content: &[u8], public: &Public, report: &mut Report) -> anyhow::Result<()> {
    let mut parts = name.split('/').skip(1);
    let (folder, file) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let Some(&architecture) = ARCHITECTURES.iter().find(|architecture| architecture.abi == folder) else {
        report.row(
            name,
            "a processor that this project does not build for",
            Some("should not be there".into()),
        );
        return Ok(());
    };
    let elf = match Elf::parse(content) {
        Ok(elf) => elf,
        Err(error) => {
            report.row(name, "no ELF file", Some(error.to_string()));
            return Ok(());
        }
    };
    let size = content.len() as f64 / 1e6;
    let fits =
        elf.is_64 && elf.header.e_type == header::ET_DYN && elf.header.e_machine == architecture.machine;
    let problem = (!fits).then(|| format!("should be a shared library for {folder}"));
    if file == LOADER {
        // Libraries of others follow other build rules.
        let problem = problem.or_else(|| (!loader::exports(&elf)).then(|| "is no OpenXR loader".to_owned()));
        report.row(format!("{folder} loader"), format!("{file}, {size:.2} MB, API layers"), problem);
        return Ok(());
    }
    report.row(format!("{folder} library"), format!("{file}, {size:.2} MB"), problem);
    pages(&elf, folder, report);
    protection(&elf, folder, report);
    symbols(&elf, architecture, public, report)?;
    let exported = defined(&elf).any(|symbol| symbol == ENTRY);
    let problem = (!exported).then(|| "NativeActivity cannot start it".to_owned());
    report.row(format!("{folder} entry"), if exported { ENTRY } else { "none" }, problem);
    Ok(())
}

fn pages(elf: &Elf<'_>, folder: &str, report: &mut Report) {
    let segments: Vec<_> = elf.program_headers.iter().filter(|segment| segment.p_type == PT_LOAD).collect();
    let mut problems = Vec::new();
    for segment in &segments {
        let fits = segment.p_align.is_power_of_two()
            && segment.p_align >= PAGE
            && segment.p_vaddr % PAGE == segment.p_offset % PAGE;
        if !fits {
            problems
                .push(format!("the segment at {:#x} is aligned to {:#x}", segment.p_vaddr, segment.p_align));
        }
    }
    if segments.is_empty() {
        problems.push("nothing is to be loaded".to_owned());
    }
    // The linker protects whole pages. If the end is not at a page boundary, either a part of the segment stays
    // writable, or data behind it becomes read-only.
    let relro = elf.program_headers.iter().find(|segment| segment.p_type == PT_GNU_RELRO);
    match relro.map(|segment| segment.p_vaddr + segment.p_memsz) {
        Some(end) if !end.is_multiple_of(PAGE) => {
            problems.push(format!("the read-only part after relocation ends at {end:#x}"));
        }
        Some(_) => {}
        None => problems.push("no part becomes read-only after relocation".to_owned()),
    }
    let least = segments.iter().map(|segment| segment.p_align / 1024).min().unwrap_or(0);
    let problem = (!problems.is_empty()).then(|| problems.join(", "));
    report.row(format!("{folder} pages"), format!("{} segments, {least} KiB", segments.len()), problem);
}

fn protection(elf: &Elf<'_>, folder: &str, report: &mut Report) {
    let mut problems = Vec::new();
    let mixed = PF_W | PF_X;
    if elf.program_headers.iter().any(|segment| segment.p_type == PT_LOAD && segment.p_flags & mixed == mixed)
    {
        problems.push("a segment is writable and executable");
    }
    let entries = elf.dynamic.as_ref().map(|dynamic| dynamic.dyns.as_slice()).unwrap_or_default();
    let relocates_text = entries.iter().any(|entry| {
        entry.d_tag == dynamic::DT_TEXTREL
            || entry.d_tag == dynamic::DT_FLAGS && entry.d_val & dynamic::DF_TEXTREL != 0
    });
    if relocates_text {
        problems.push("code is relocated");
    }
    if elf.program_headers.iter().any(|segment| segment.p_type == PT_TLS) {
        problems.push("thread-local storage is in a segment of its own, which Android 9 and older refuse");
    }
    let problem = (!problems.is_empty()).then(|| problems.join(", "));
    report.row(format!("{folder} protection"), "code is read-only and position-independent", problem);
}

fn symbols(
    elf: &Elf<'_>,
    architecture: Architecture,
    public: &Public,
    report: &mut Report,
) -> anyhow::Result<()> {
    let folder = architecture.abi;
    let mut offered = BTreeSet::new();
    let mut private = Vec::new();
    for library in &elf.libraries {
        match public.symbols(library, architecture)? {
            Some(symbols) => offered.extend(symbols),
            None => private.push(*library),
        }
    }
    let problem = if elf.libraries.is_empty() {
        Some("it would find no function of the system".to_owned())
    } else {
        (!private.is_empty()).then(|| format!("{} is not public", private.join(", ")))
    };
    report.row(format!("{folder} needs"), elf.libraries.join(" "), problem);

    // A weak symbol may be undefined: the program checks its address before use.
    let undefined: Vec<&str> = elf
        .dynsyms
        .iter()
        .filter(|symbol| is_undefined(symbol) && symbol.st_bind() != STB_WEAK)
        .filter_map(|symbol| elf.dynstrtab.get_at(symbol.st_name))
        .filter(|name| !name.is_empty())
        .collect();
    let unknown: Vec<&str> = undefined.iter().filter(|name| !offered.contains(**name)).copied().collect();
    let problem = (!unknown.is_empty()).then(|| {
        let lists = match public {
            Public::Lists => " (or missing in xtask/ndk/symbols)",
            Public::Stubs(_) => "",
        };
        format!("{} not public since API {MIN_API} in what it needs{lists}", some(&unknown))
    });
    report.row(format!("{folder} symbols"), format!("{} of the system", undefined.len()), problem);
    Ok(())
}

fn is_undefined(symbol: &Sym) -> bool {
    symbol.st_shndx == SHN_UNDEF as usize
}

fn defined<'a>(elf: &'a Elf<'_>) -> impl Iterator<Item = &'a str> {
    let symbols = elf.dynsyms.iter().filter(|symbol| !is_undefined(symbol));
    symbols.filter_map(|symbol| elf.dynstrtab.get_at(symbol.st_name))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small library made by a test.
    #[derive(Clone)]
    struct Made {
        machine: u16,
        alignment: u64,
        flags: u32,
        relro_end: u64,
        textrel: bool,
        thread_local: bool,
        needed: Vec<&'static str>,
        undefined: Vec<&'static str>,
        weak: Vec<&'static str>,
        exported: Vec<&'static str>,
    }

    fn good() -> Made {
        Made {
            machine: header::EM_AARCH64,
            alignment: PAGE,
            flags: PF_X | 4,
            relro_end: 2 * PAGE,
            textrel: false,
            thread_local: false,
            needed: vec!["libc.so", "libEGL.so"],
            undefined: vec!["malloc", "eglSwapBuffers"],
            weak: vec!["of_a_later_api"],
            exported: vec![ENTRY],
        }
    }

    /// Makes an OpenXR loader for arm64.
    fn loader() -> Vec<u8> {
        Made { exported: vec![loader::ENTRY], ..good() }.bytes()
    }

    impl Made {
        /// Returns an ELF file with program headers, dynamic section, string table, symbol table and hash table.
        fn bytes(&self) -> Vec<u8> {
            let mut strings = vec![0u8];
            let mut string = |text: &str| {
                let at = strings.len() as u64;
                strings.extend(text.as_bytes());
                strings.push(0);
                at
            };
            let mut symbols = vec![0u8; 24];
            let undefined = self.undefined.iter().map(|name| (*name, 1u8, 0u16));
            let weak = self.weak.iter().map(|name| (*name, STB_WEAK, 0));
            let exported = self.exported.iter().map(|name| (*name, 1, 1));
            for (name, binding, section) in undefined.chain(weak).chain(exported) {
                symbols.extend((string(name) as u32).to_le_bytes());
                symbols.extend([binding << 4 | 2, 0]);
                symbols.extend(section.to_le_bytes());
                symbols.extend([0; 16]);
            }
            let count = (symbols.len() / 24) as u32;
            let mut hash = Vec::new();
            // One bucket with an empty chain.
            for word in [1, count, 0].into_iter().chain((0..count).map(|_| 0)) {
                hash.extend(word.to_le_bytes());
            }
            let mut entries: Vec<(u64, u64)> =
                self.needed.iter().map(|name| (dynamic::DT_NEEDED, string(name))).collect();
            if self.textrel {
                entries.push((dynamic::DT_TEXTREL, 0));
            }

            let segments = 3 + u64::from(self.thread_local);
            let dynamic_at = 64 + 56 * segments;
            let dynamic_size = 16 * (entries.len() as u64 + 6);
            let symbols_at = dynamic_at + dynamic_size;
            let hash_at = symbols_at + symbols.len() as u64;
            let strings_at = hash_at + hash.len() as u64;
            let end = strings_at + strings.len() as u64;
            entries.extend([
                (dynamic::DT_SYMTAB, symbols_at),
                (dynamic::DT_SYMENT, 24),
                (dynamic::DT_HASH, hash_at),
                (dynamic::DT_STRTAB, strings_at),
                (dynamic::DT_STRSZ, strings.len() as u64),
                (dynamic::DT_NULL, 0),
            ]);

            let mut out = vec![0x7f, b'E', b'L', b'F', 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0];
            out.extend(header::ET_DYN.to_le_bytes());
            out.extend(self.machine.to_le_bytes());
            out.extend(1u32.to_le_bytes());
            out.extend(0u64.to_le_bytes());
            out.extend(64u64.to_le_bytes());
            out.extend(0u64.to_le_bytes());
            out.extend(0u32.to_le_bytes());
            for half in [64, 56, segments as u16, 64, 0, 0] {
                out.extend(half.to_le_bytes());
            }
            let mut segment = |kind: u32, flags: u32, at: u64, size: u64, alignment: u64| {
                out.extend(kind.to_le_bytes());
                out.extend(flags.to_le_bytes());
                for word in [at, at, at, size, size, alignment] {
                    out.extend(word.to_le_bytes());
                }
            };
            segment(PT_LOAD, self.flags, 0, end, self.alignment);
            segment(goblin::elf::program_header::PT_DYNAMIC, 6, dynamic_at, dynamic_size, 8);
            segment(PT_GNU_RELRO, 4, dynamic_at, self.relro_end - dynamic_at, 1);
            if self.thread_local {
                segment(PT_TLS, 4, 0, 8, 8);
            }
            for (tag, value) in entries {
                out.extend(tag.to_le_bytes());
                out.extend(value.to_le_bytes());
            }
            out.extend(symbols);
            out.extend(hash);
            out.extend(strings);
            assert_eq!(out.len() as u64, end);
            out
        }

        fn report(&self) -> Report {
            let mut report = Report::default();
            check("lib/arm64-v8a/libyoro.so", &self.bytes(), &Public::Lists, &mut report).unwrap();
            report
        }

        #[track_caller]
        fn fails(&self, what: &str, word: &str) {
            let report = self.report();
            assert_eq!(report.problems(), [what], "{report}");
            assert!(report.to_string().contains(word), "{report}");
        }
    }

    #[test]
    fn a_good_library_passes() {
        let report = good().report();
        assert!(report.passed(), "{report}");
        assert_eq!(report.rows.len(), 6);
    }

    #[test]
    fn a_loader_need_not_be_an_application() {
        let name = "lib/arm64-v8a/libopenxr_loader.so";
        let mut report = Report::default();
        check(name, &loader(), &Public::Lists, &mut report).unwrap();
        assert!(report.passed(), "{report}");
        let mut report = Report::default();
        check(name, &good().bytes(), &Public::Lists, &mut report).unwrap();
        assert_eq!(report.problems(), ["arm64-v8a loader"], "{report}");
    }

    #[test]
    fn a_loader_is_known_by_what_it_exports_and_its_processor() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("loader.so");
        let abi = |content: &[u8]| {
            std::fs::write(&file, content).unwrap();
            loader::abi(&file).map_err(|error| error.to_string())
        };
        assert_eq!(abi(&loader()), Ok("arm64-v8a"));
        assert!(abi(b"text").unwrap_err().contains("is no library"));
        assert!(abi(&good().bytes()).unwrap_err().contains("no OpenXR loader"));
        let other = Made { machine: 40, exported: vec![loader::ENTRY], ..good() };
        assert!(abi(&other.bytes()).unwrap_err().contains("none of the APK's"));
        std::fs::remove_file(&file).unwrap();
        assert!(loader::abi(&file).unwrap_err().to_string().contains("loader.so cannot be read"));
    }

    #[test]
    fn the_processor_fits_the_folder() {
        Made { machine: header::EM_X86_64, ..good() }
            .fails("arm64-v8a library", "shared library for arm64-v8a");
    }

    #[test]
    fn pages_of_4_kib_are_too_small() {
        Made { alignment: 4096, ..good() }.fails("arm64-v8a pages", "aligned to 0x1000");
    }

    #[test]
    fn the_read_only_part_ends_with_a_page() {
        Made { relro_end: PAGE + 4096, ..good() }.fails("arm64-v8a pages", "0x5000");
    }

    #[test]
    fn code_is_never_written() {
        Made { flags: PF_W | PF_X | 4, ..good() }.fails("arm64-v8a protection", "writable and executable");
        Made { textrel: true, ..good() }.fails("arm64-v8a protection", "code is relocated");
    }

    #[test]
    fn thread_locals_have_no_segment() {
        Made { thread_local: true, ..good() }.fails("arm64-v8a protection", "thread-local");
    }

    #[test]
    fn only_public_libraries_are_needed() {
        let needed = vec!["libc.so", "libEGL.so", "libcutils.so"];
        Made { needed, ..good() }.fails("arm64-v8a needs", "libcutils.so is not public");
    }

    #[test]
    fn every_symbol_is_in_a_needed_library() {
        let undefined = vec!["malloc", "no_such_function"];
        Made { undefined, ..good() }.fails("arm64-v8a symbols", "no_such_function not public");
        // A public symbol of a library that is not among the needed ones.
        Made { needed: vec!["libc.so"], ..good() }.fails("arm64-v8a symbols", "eglSwapBuffers not public");
        // A symbol that only later versions of Android have.
        let undefined = vec!["malloc", "_Unwind_Resume"];
        Made { undefined, ..good() }.fails("arm64-v8a symbols", "_Unwind_Resume not public");
    }

    #[test]
    fn the_entry_is_exported() {
        Made { exported: vec!["android_main"], ..good() }.fails("arm64-v8a entry", "cannot start");
    }

    #[test]
    fn what_is_no_library_fails() {
        for content in [&b""[..], b"\x7fELF", b"text", &good().bytes()[..100]] {
            let mut report = Report::default();
            check("lib/x86_64/libyoro.so", content, &Public::Lists, &mut report).unwrap();
            assert!(!report.passed());
        }
    }
}
