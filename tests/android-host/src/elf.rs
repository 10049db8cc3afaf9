//! Parses a library of a package by goblin, and rejects libraries that Android or the host cannot load. Packed
//! relocations, which no library of ours has, are not supported.

use anyhow::{Context, Result, bail, ensure};
use goblin::elf::dynamic::{DF_TEXTREL, DT_REL};
use goblin::elf::header::ET_DYN;
use goblin::elf::program_header::{PT_LOAD, PT_TLS, ProgramHeader, program_header64};
use goblin::elf::{Elf, Sym};

/// The page size of newer Android devices.
pub const PAGE: u64 = 0x4000;

/// The number of the machine, and the types of relocations that the host supports.
#[cfg(target_arch = "x86_64")]
pub mod machine {
    pub use goblin::elf::header::EM_X86_64 as NUMBER;
    pub use goblin::elf::reloc::{
        R_X86_64_64 as ABSOLUTE, R_X86_64_GLOB_DAT as GLOB_DAT, R_X86_64_JUMP_SLOT as JUMP_SLOT,
        R_X86_64_RELATIVE as RELATIVE,
    };
}
/// The number of the machine, and the types of relocations that the host supports.
#[cfg(target_arch = "aarch64")]
pub mod machine {
    pub use goblin::elf::header::EM_AARCH64 as NUMBER;
    pub use goblin::elf::reloc::{
        R_AARCH64_ABS64 as ABSOLUTE, R_AARCH64_GLOB_DAT as GLOB_DAT, R_AARCH64_JUMP_SLOT as JUMP_SLOT,
        R_AARCH64_RELATIVE as RELATIVE,
    };
}

/// `DT_RELR` and Android's tags of packed relocations.
const PACKED: [u64; 4] = [36, 0x6000_000f, 0x6000_0011, 0x6fff_e000];

/// Returns a segment's pages as offsets from the library's start: the start of the first, and the end of the last.
pub fn pages(segment: &ProgramHeader) -> Result<(u64, u64)> {
    let end = segment.p_vaddr.checked_add(segment.p_memsz);
    let end = end.and_then(|end| end.checked_next_multiple_of(PAGE)).context("a segment wraps around")?;
    Ok((segment.p_vaddr & !(PAGE - 1), end))
}

/// The description of a shared library in its file, which has been checked.
pub struct Image<'a> {
    /// The content of the file.
    pub file: &'a [u8],
    /// The names and entries of the dynamic symbol table, by index. The first one has no name and stands for none.
    pub symbols: Vec<(&'a str, Sym)>,
    /// The parsed file.
    pub elf: Elf<'a>,
}

impl<'a> Image<'a> {
    /// Parses and checks a file.
    ///
    /// # Errors
    /// Fails if the file is damaged, or Android or the host would reject it.
    pub fn parse(file: &'a [u8]) -> Result<Self> {
        let elf = Elf::parse(file).context("it is no sound ELF file")?;
        let header = &elf.header;
        ensure!(elf.is_64 && elf.little_endian, "it is no 64-bit little-endian ELF file");
        ensure!(header.e_type == ET_DYN, "it is no shared library");
        ensure!(header.e_machine == machine::NUMBER, "it is for another machine ({})", header.e_machine);
        let size = program_header64::SIZEOF_PHDR;
        ensure!(usize::from(header.e_phentsize) == size, "program headers have {} bytes", header.e_phentsize);
        check_segments(file, &elf.program_headers)?;
        let dynamic = elf.dynamic.as_ref().context("it has no dynamic section")?;
        if dynamic.info.textrel || dynamic.info.flags & DF_TEXTREL != 0 {
            bail!("it has text relocations, which Android refuses");
        }
        let name = |symbol: Sym| {
            let name = elf.dynstrtab.get_at(symbol.st_name);
            Ok((name.context("a name lies outside of the string table")?, symbol))
        };
        let symbols = elf.dynsyms.iter().map(name).collect::<Result<_>>()?;
        let image = Self { file, symbols, elf };
        let has_other = [DT_REL].iter().chain(&PACKED).any(|tag| image.tag(*tag).is_some());
        ensure!(
            !has_other,
            "it has packed relocations or some without addends, which the host does not read"
        );
        Ok(image)
    }

    /// Returns the LOAD segments.
    pub fn loads(&self) -> impl Iterator<Item = &ProgramHeader> {
        self.elf.program_headers.iter().filter(|segment| segment.p_type == PT_LOAD)
    }

    /// Returns the last value of a tag in the dynamic section.
    pub fn tag(&self, tag: u64) -> Option<u64> {
        let entries = &self.elf.dynamic.as_ref()?.dyns;
        entries.iter().rev().find(|entry| entry.d_tag == tag).map(|entry| entry.d_val)
    }
}

fn check_segments(file: &[u8], segments: &[ProgramHeader]) -> Result<()> {
    let loads: Vec<_> = segments.iter().filter(|segment| segment.p_type == PT_LOAD).collect();
    ensure!(!loads.is_empty(), "it has no LOAD segment");
    let mut end = 0;
    for (index, load) in loads.into_iter().enumerate() {
        ensure!(
            load.p_align >= PAGE && load.p_align.is_power_of_two(),
            "LOAD segment {index} is aligned to {:#x}: devices with 16 KiB pages cannot load it",
            load.p_align
        );
        ensure!(
            load.p_vaddr % PAGE == load.p_offset % PAGE,
            "LOAD segment {index} cannot be mapped: its address and its offset differ within a page"
        );
        ensure!(load.p_filesz <= load.p_memsz, "LOAD segment {index} is larger in the file than in memory");
        ensure!(
            load.p_offset.checked_add(load.p_filesz).is_some_and(|end| end <= file.len() as u64),
            "the file ends within LOAD segment {index}"
        );
        let (first, last) = pages(load)?;
        ensure!(first >= end, "LOAD segment {index} shares a page with the one before it");
        ensure!(last < 1 << 32, "LOAD segment {index} is unreasonably large");
        end = last;
    }
    for segment in segments {
        ensure!(
            segment.p_type != PT_TLS,
            "it has ELF thread-local storage: Android before API level 29 cannot load it, and the host has none"
        );
    }
    Ok(())
}
