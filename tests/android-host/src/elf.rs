//! Parses a library of a package, and rejects libraries that Android or the host cannot load. goblin parses the ELF
//! file; the two packed formats of relocations, which it does not support, are unpacked here.

use anyhow::{Context, Result, bail, ensure};
use goblin::elf::Elf;
use goblin::elf::dynamic::{DF_TEXTREL, DT_REL};
use goblin::elf::header::ET_DYN;
use goblin::elf::program_header::{
    PF_W, PF_X, PT_GNU_RELRO, PT_GNU_STACK, PT_LOAD, PT_TLS, ProgramHeader, program_header64,
};
use goblin::elf::section_header::SHN_UNDEF;
use goblin::elf::sym::STB_WEAK;

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

const DT_RELRSZ: u64 = 35;
const DT_RELR: u64 = 36;
const DT_ANDROID_REL: u64 = 0x6000_000f;
const DT_ANDROID_RELA: u64 = 0x6000_0011;
const DT_ANDROID_RELASZ: u64 = 0x6000_0012;
const DT_ANDROID_RELR: u64 = 0x6fff_e000;
const DT_ANDROID_RELRSZ: u64 = 0x6fff_e001;

/// Returns a segment's pages as offsets from the library's start: the start of the first, and the end of the last.
pub fn pages(segment: &ProgramHeader) -> Result<(u64, u64)> {
    let end = segment.p_vaddr.checked_add(segment.p_memsz);
    let end = end.and_then(|end| end.checked_next_multiple_of(PAGE)).context("a segment wraps around")?;
    Ok((segment.p_vaddr & !(PAGE - 1), end))
}

/// A symbol of the dynamic table.
pub struct Symbol<'a> {
    /// The name, empty for the first symbol, which stands for none.
    pub name: &'a str,
    /// True if the symbol may remain undefined.
    pub weak: bool,
    /// The address in the library, if the library defines the symbol.
    pub defined: Option<u64>,
}

/// One relocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Relocation {
    /// The address in the library.
    pub at: u64,
    /// The type, one of the machine's `R_*`.
    pub kind: u32,
    /// The index in the dynamic symbol table.
    pub symbol: usize,
    /// The value added to the symbol's address.
    pub addend: i64,
}

/// The description of a shared library in its file, which has been checked.
pub struct Image<'a> {
    /// The content of the file.
    pub file: &'a [u8],
    /// All symbols of the dynamic table, by index.
    pub symbols: Vec<Symbol<'a>>,
    /// All relocations, unpacked.
    pub relocations: Vec<Relocation>,
    elf: Elf<'a>,
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
        let mut image = Self { file, symbols: Vec::new(), relocations: Vec::new(), elf };
        if image.tag(DT_REL).is_some() || image.tag(DT_ANDROID_REL).is_some() {
            bail!("it has relocations without addends, which no 64-bit ABI uses");
        }
        image.symbols = image.read_symbols()?;
        image.relocations = image.read_relocations()?;
        Ok(image)
    }

    /// Returns the LOAD segments.
    pub fn loads(&self) -> impl Iterator<Item = &ProgramHeader> {
        self.elf.program_headers.iter().filter(|segment| segment.p_type == PT_LOAD)
    }

    /// Returns the segment that becomes read-only after the relocations.
    pub fn relro(&self) -> Option<&ProgramHeader> {
        self.elf.program_headers.iter().find(|segment| segment.p_type == PT_GNU_RELRO)
    }

    /// Returns the file names of the libraries that this one needs.
    pub fn needed(&self) -> &[&'a str] {
        &self.elf.libraries
    }

    /// Returns the program headers as bytes of the file.
    pub fn program_headers(&self) -> &'a [u8] {
        let start = self.elf.header.e_phoff as usize;
        &self.file[start..start + self.elf.program_headers.len() * program_header64::SIZEOF_PHDR]
    }

    /// Returns the last value of a tag in the dynamic section.
    pub fn tag(&self, tag: u64) -> Option<u64> {
        let entries = &self.elf.dynamic.as_ref()?.dyns;
        entries.iter().rev().find(|entry| entry.d_tag == tag).map(|entry| entry.d_val)
    }

    /// Returns the file offset of an address in the library.
    ///
    /// # Errors
    /// Fails if the address is not in a segment.
    pub fn offset(&self, address: u64) -> Result<usize> {
        self.loads()
            .find(|segment| address.checked_sub(segment.p_vaddr).is_some_and(|at| at < segment.p_filesz))
            .map(|segment| (address - segment.p_vaddr + segment.p_offset) as usize)
            .with_context(|| format!("address {address:#x} lies in no segment"))
    }

    /// Returns the table whose address and size in bytes are the values of two tags of the dynamic section.
    fn table(&self, address: u64, size: u64) -> Result<Option<&'a [u8]>> {
        let Some(address) = self.tag(address) else { return Ok(None) };
        let size = self.tag(size).context("a table of relocations has no size")?;
        let rest = &self.file[self.offset(address)?..];
        let table = rest.get(..usize::try_from(size)?).context("the file ends within its relocations")?;
        Ok(Some(table))
    }

    fn read_symbols(&self) -> Result<Vec<Symbol<'a>>> {
        let read = |symbol: goblin::elf::Sym| {
            let name = self.elf.dynstrtab.get_at(symbol.st_name);
            Ok(Symbol {
                name: name.context("a name lies outside of the string table")?,
                weak: symbol.st_bind() == STB_WEAK,
                defined: (symbol.st_shndx != SHN_UNDEF as usize).then_some(symbol.st_value),
            })
        };
        self.elf.dynsyms.iter().map(read).collect()
    }

    fn read_relocations(&self) -> Result<Vec<Relocation>> {
        let tables = self.elf.dynrelas.iter().chain(self.elf.pltrelocs.iter());
        let mut relocations: Vec<_> = tables
            .map(|relocation| Relocation {
                at: relocation.r_offset,
                kind: relocation.r_type,
                symbol: relocation.r_sym,
                addend: relocation.r_addend.unwrap_or(0),
            })
            .collect();
        if let Some(packed) = self.table(DT_ANDROID_RELA, DT_ANDROID_RELASZ)? {
            relocations.extend(unpack_relocations(packed)?);
        }
        for (table, size) in [(DT_RELR, DT_RELRSZ), (DT_ANDROID_RELR, DT_ANDROID_RELRSZ)] {
            for at in self.table(table, size)?.map(unpack_relative).unwrap_or_default() {
                let addend = self.file[self.offset(at)?..].first_chunk();
                let addend = i64::from_le_bytes(*addend.context("the file ends within a relocation")?);
                relocations.push(Relocation { at, kind: machine::RELATIVE, symbol: 0, addend });
            }
        }
        Ok(relocations)
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
        ensure!(
            load.p_flags & (PF_W | PF_X) != PF_W | PF_X,
            "LOAD segment {index} is writable and executable"
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
        ensure!(
            segment.p_type != PT_GNU_STACK || segment.p_flags & PF_X == 0,
            "it asks for an executable stack"
        );
        ensure!(
            segment.p_type != PT_GNU_RELRO
                || segment.p_vaddr.checked_add(segment.p_memsz).is_some_and(|end| end % PAGE == 0),
            "its RELRO part does not end at a 16 KiB boundary: what follows would become read-only, too"
        );
    }
    Ok(())
}

/// Unpacks RELR: an even word is an address, an odd word is a bitmap of the next 63 words.
fn unpack_relative(packed: &[u8]) -> Vec<u64> {
    let mut addresses = Vec::new();
    let mut next = 0_u64;
    for word in packed.as_chunks().0 {
        let word = u64::from_le_bytes(*word);
        if word & 1 == 0 {
            addresses.push(word);
            next = word.wrapping_add(8);
        } else {
            let set = (0..63).filter(|bit| word >> (bit + 1) & 1 == 1);
            addresses.extend(set.map(|bit| next.wrapping_add(bit * 8)));
            next = next.wrapping_add(63 * 8);
        }
    }
    addresses
}

/// Unpacks Android's relocations ("APS2"): SLEB128 numbers in groups that share offset delta, info or addend.
fn unpack_relocations(packed: &[u8]) -> Result<Vec<Relocation>> {
    const BY_INFO: i64 = 1;
    const BY_OFFSET_DELTA: i64 = 2;
    const BY_ADDEND: i64 = 4;
    const HAS_ADDEND: i64 = 8;
    let mut rest =
        packed.strip_prefix(b"APS2").context("its packed relocations are not of the known format")?.iter();
    let mut number = || -> Result<i64> {
        let (mut value, mut shift) = (0_i64, 0);
        loop {
            let byte = *rest.next().context("its packed relocations end too early")?;
            ensure!(shift < 64, "its packed relocations hold a number that is too long");
            value |= i64::from(byte & 0x7f) << shift;
            shift += 7;
            if byte & 0x80 == 0 {
                return Ok(if byte & 0x40 != 0 && shift < 64 { value | -1 << shift } else { value });
            }
        }
    };
    let count = usize::try_from(number()?)?;
    let mut at = number()?;
    let mut addend = 0_i64;
    let mut relocations = Vec::new();
    while relocations.len() < count {
        let (size, flags) = (number()?, number()?);
        ensure!(size > 0, "its packed relocations hold an empty group");
        let delta = if flags & BY_OFFSET_DELTA != 0 { Some(number()?) } else { None };
        let info = if flags & BY_INFO != 0 { Some(number()?) } else { None };
        if flags & HAS_ADDEND == 0 {
            addend = 0;
        } else if flags & BY_ADDEND != 0 {
            addend = addend.wrapping_add(number()?);
        }
        for _ in 0..size {
            at = at.wrapping_add(delta.map_or_else(&mut number, Ok)?);
            let info = info.map_or_else(&mut number, Ok)? as u64;
            if flags & HAS_ADDEND != 0 && flags & BY_ADDEND == 0 {
                addend = addend.wrapping_add(number()?);
            }
            let (kind, symbol) = (info as u32, (info >> 32) as usize);
            relocations.push(Relocation { at: at as u64, kind, symbol, addend });
        }
    }
    Ok(relocations)
}

#[cfg(test)]
mod tests {
    use goblin::elf::header::SIZEOF_IDENT;
    use goblin::elf::program_header::PF_R;

    use super::*;

    #[test]
    fn relative_relocations_unpack() {
        let bytes = |words: &[u64]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let packed = bytes(&[0x1000, 0b1011, 0x2000]);
        assert_eq!(unpack_relative(&packed), [0x1000, 0x1008, 0x1018, 0x2000]);
        // A bitmap covers 63 words. The next bitmap continues behind them.
        assert_eq!(unpack_relative(&bytes(&[0x1000, 1, 0b11])), [0x1000, 0x1008 + 63 * 8]);
    }

    #[test]
    fn packed_relocations_unpack() {
        // Three relocations from 0x100 on: a group of two that shares delta 8 and info 8 and has the addends 5 and 5 -
        // 3, then one without an addend, with info 6 and delta 16.
        let mut packed = b"APS2".to_vec();
        packed.extend([3, 0x80, 0x02, 2, 1 | 2 | 8, 8, 8, 5, 0x7d, 1, 0, 16, 6]);
        let relocations = unpack_relocations(&packed).unwrap();
        let relocation = |at, kind, addend| Relocation { at, kind, symbol: 0, addend };
        assert_eq!(relocations, [relocation(0x108, 8, 5), relocation(0x110, 8, 2), relocation(0x120, 6, 0)]);
        assert!(unpack_relocations(&packed[..10]).is_err());
        assert!(unpack_relocations(b"nope").is_err());
    }

    /// Returns the error for a library with one segment and only its headers, after overwriting bytes at an offset.
    fn refused(at: usize, bytes: &[u8]) -> String {
        let mut file = vec![0; 64 + 2 * 56];
        let number = machine::NUMBER.to_le_bytes();
        let page = PAGE.to_le_bytes();
        let own: [(usize, &[u8]); 9] = [
            (0, b"\x7fELF\x02\x01\x01"),
            (SIZEOF_IDENT, &[ET_DYN as u8]),
            (18, &number),
            (32, &[64]),
            (54, &[56]),
            (56, &[2]),
            (64, &[PT_LOAD as u8]),
            (68, &[(PF_R | PF_X) as u8]),
            (64 + 48, &page),
        ];
        for (at, bytes) in own.into_iter().chain([(at, bytes)]) {
            file[at..at + bytes.len()].copy_from_slice(bytes);
        }
        format!("{:#}", Image::parse(&file).err().expect("refused"))
    }

    #[test]
    fn libraries_that_android_refuses_are_refused() {
        let tls = PT_TLS.to_le_bytes();
        let cases: [(usize, &[u8], &str); 8] = [
            (0, &[], "dynamic section"),
            (0, &[0], "ELF"),
            (18, &[3], "another machine"),
            (32, &[120], "no sound ELF file"),
            (64 + 48, &[0, 0x10], "16 KiB"),
            (68, &[7], "writable and executable"),
            (120, &tls, "thread-local"),
            (64 + 32, &[0xff; 8], "larger in the file"),
        ];
        for (at, bytes, reason) in cases {
            let sentence = refused(at, bytes);
            assert!(sentence.contains(reason), "{at}: {sentence}");
        }
    }
}
