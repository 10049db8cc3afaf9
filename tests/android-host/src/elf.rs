//! A loader for the application's library. It is our own and not glibc's `dlopen`, because imports must be bound to what
//! Android's libraries export, and it is stricter than Android's about what it accepts.

use std::collections::BTreeMap;
use std::ffi::CString;

use anyhow::{Context, Result, bail, ensure};

use crate::exports::System;
use crate::summary::LibraryFacts;
use crate::thunk;

/// Pages of newer Android devices.
const PAGE: u64 = 0x4000;

#[cfg(target_arch = "x86_64")]
mod machine {
    pub const NUMBER: u16 = 62;
    pub const ABSOLUTE: u32 = 1;
    pub const GLOB_DAT: u32 = 6;
    pub const JUMP_SLOT: u32 = 7;
    pub const RELATIVE: u32 = 8;
}
#[cfg(target_arch = "aarch64")]
mod machine {
    pub const NUMBER: u16 = 183;
    pub const ABSOLUTE: u32 = 257;
    pub const GLOB_DAT: u32 = 1025;
    pub const JUMP_SLOT: u32 = 1026;
    pub const RELATIVE: u32 = 1027;
}

const PT_LOAD: u32 = 1;
const PT_DYNAMIC: u32 = 2;
const PT_TLS: u32 = 7;
const PT_GNU_STACK: u32 = 0x6474_e551;
const PT_GNU_RELRO: u32 = 0x6474_e552;
const EXECUTE: u32 = 1;
const WRITE: u32 = 2;
const READ: u32 = 4;

const DT_NEEDED: u64 = 1;
const DT_PLTRELSZ: u64 = 2;
const DT_HASH: u64 = 4;
const DT_STRTAB: u64 = 5;
const DT_SYMTAB: u64 = 6;
const DT_RELA: u64 = 7;
const DT_RELASZ: u64 = 8;
const DT_STRSZ: u64 = 10;
const DT_INIT: u64 = 12;
const DT_REL: u64 = 17;
const DT_TEXTREL: u64 = 22;
const DT_JMPREL: u64 = 23;
const DT_INIT_ARRAY: u64 = 25;
const DT_INIT_ARRAYSZ: u64 = 27;
const DT_FLAGS: u64 = 30;
const DT_RELRSZ: u64 = 35;
const DT_RELR: u64 = 36;
const DT_ANDROID_REL: u64 = 0x6000_000f;
const DT_ANDROID_RELA: u64 = 0x6000_0011;
const DT_ANDROID_RELASZ: u64 = 0x6000_0012;
const DT_GNU_HASH: u64 = 0x6fff_fef5;
const DT_ANDROID_RELR: u64 = 0x6fff_e000;
const DT_ANDROID_RELRSZ: u64 = 0x6fff_e001;
const DF_TEXTREL: u64 = 4;

/// A program header.
#[derive(Clone, Copy, Debug)]
struct Segment {
    kind: u32,
    flags: u32,
    offset: u64,
    address: u64,
    file_size: u64,
    memory_size: u64,
    align: u64,
}

impl Segment {
    /// The pages it touches.
    fn pages(&self) -> Result<(u64, u64)> {
        let end = self
            .address
            .checked_add(self.memory_size)
            .and_then(|end| end.checked_next_multiple_of(PAGE))
            .context("a segment wraps around")?;
        Ok((self.address & !(PAGE - 1), end))
    }
}

/// A symbol of the dynamic table.
struct Symbol {
    name: String,
    weak: bool,
    /// Address in the library, for what it defines.
    defined: Option<u64>,
}

/// One relocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Relocation {
    at: u64,
    kind: u32,
    symbol: u32,
    addend: i64,
}

/// Little-endian reads that end in an error, not in a panic, when a file is damaged.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn slice(&self, at: u64, length: u64) -> Result<&'a [u8]> {
        let range =
            usize::try_from(at)?..usize::try_from(at.checked_add(length).context("an offset wraps around")?)?;
        self.0.get(range).with_context(|| format!("the file ends before offset {at:#x}"))
    }

    fn u16(&self, at: u64) -> Result<u16> {
        Ok(u16::from_le_bytes(self.slice(at, 2)?.try_into()?))
    }

    fn u32(&self, at: u64) -> Result<u32> {
        Ok(u32::from_le_bytes(self.slice(at, 4)?.try_into()?))
    }

    fn u64(&self, at: u64) -> Result<u64> {
        Ok(u64::from_le_bytes(self.slice(at, 8)?.try_into()?))
    }

    fn text(&self, at: u64) -> Result<String> {
        let rest = self.0.get(usize::try_from(at)?..).context("a name lies outside of the string table")?;
        let end = rest.iter().position(|byte| *byte == 0).context("a name does not end")?;
        Ok(String::from_utf8(rest[..end].to_vec())?)
    }
}

/// A shared library as its file describes it, checked.
struct Image<'a> {
    file: &'a [u8],
    header: Vec<u8>,
    segments: Vec<Segment>,
    needed: Vec<String>,
    symbols: Vec<Symbol>,
    relocations: Vec<Relocation>,
    relro: Option<Segment>,
    init: Option<u64>,
    init_array: (u64, u64),
}

impl<'a> Image<'a> {
    fn parse(file: &'a [u8]) -> Result<Self> {
        let bytes = Bytes(file);
        ensure!(bytes.slice(0, 7)? == b"\x7fELF\x02\x01\x01", "it is no 64-bit little-endian ELF file");
        ensure!(bytes.u16(16)? == 3, "it is no shared library");
        ensure!(bytes.u16(18)? == machine::NUMBER, "it is for another machine ({})", bytes.u16(18)?);
        let (table, size, count) = (bytes.u64(32)?, u64::from(bytes.u16(54)?), u64::from(bytes.u16(56)?));
        ensure!(size == 56, "program headers have {size} bytes");
        let segments = (0..count)
            .map(|index| {
                let at = table.saturating_add(index * size);
                Ok(Segment {
                    kind: bytes.u32(at)?,
                    flags: bytes.u32(at + 4)?,
                    offset: bytes.u64(at + 8)?,
                    address: bytes.u64(at + 16)?,
                    file_size: bytes.u64(at + 32)?,
                    memory_size: bytes.u64(at + 40)?,
                    align: bytes.u64(at + 48)?,
                })
            })
            .collect::<Result<Vec<_>>>()?;
        check_segments(file, &segments)?;
        let mut image = Self {
            file,
            header: bytes.slice(table, count * size)?.to_vec(),
            relro: segments.iter().find(|segment| segment.kind == PT_GNU_RELRO).copied(),
            segments,
            needed: Vec::new(),
            symbols: Vec::new(),
            relocations: Vec::new(),
            init: None,
            init_array: (0, 0),
        };
        image.read_dynamic()?;
        Ok(image)
    }

    /// File offset of a virtual address.
    fn offset(&self, address: u64) -> Result<u64> {
        self.segments
            .iter()
            .find(|segment| {
                segment.kind == PT_LOAD
                    && address >= segment.address
                    && address - segment.address < segment.file_size
            })
            .map(|segment| address - segment.address + segment.offset)
            .with_context(|| format!("address {address:#x} lies in no segment"))
    }

    fn read_dynamic(&mut self) -> Result<()> {
        let bytes = Bytes(self.file);
        let dynamic = *self
            .segments
            .iter()
            .find(|segment| segment.kind == PT_DYNAMIC)
            .context("it has no dynamic section")?;
        let mut needed = Vec::new();
        let mut tags = BTreeMap::new();
        for at in (dynamic.offset..).step_by(16) {
            match (bytes.u64(at)?, bytes.u64(at + 8)?) {
                (0, _) => break,
                (DT_NEEDED, name) => needed.push(name),
                (tag, value) => _ = tags.insert(tag, value),
            }
        }
        let tag = |tag: u64| tags.get(&tag).copied();
        if tag(DT_TEXTREL).is_some() || tag(DT_FLAGS).unwrap_or(0) & DF_TEXTREL != 0 {
            bail!("it has text relocations, which Android refuses");
        }
        if tag(DT_REL).is_some() || tag(DT_ANDROID_REL).is_some() {
            bail!("it has relocations without addends, which no 64-bit ABI uses");
        }
        let strings_at = self.offset(tag(DT_STRTAB).context("it has no string table")?)?;
        let strings = Bytes(bytes.slice(strings_at, tag(DT_STRSZ).context("its string table has no size")?)?);
        self.needed = needed.into_iter().map(|at| strings.text(at)).collect::<Result<_>>()?;

        let count = match (tag(DT_HASH), tag(DT_GNU_HASH)) {
            (Some(hash), _) => bytes.u32(self.offset(hash)? + 4)?,
            (None, Some(hash)) => gnu_hash_symbols(&bytes, self.offset(hash)?)?,
            (None, None) => bail!("it has no symbol hash table"),
        };
        let table = self.offset(tag(DT_SYMTAB).context("it has no symbol table")?)?;
        for index in 0..u64::from(count) {
            let at = table + index * 24;
            let info = bytes.slice(at + 4, 1)?[0];
            let section = bytes.u16(at + 6)?;
            self.symbols.push(Symbol {
                name: strings.text(u64::from(bytes.u32(at)?))?,
                weak: info >> 4 == 2,
                defined: if section == 0 { None } else { Some(bytes.u64(at + 8)?) },
            });
        }

        for (table, size) in [(DT_RELA, DT_RELASZ), (DT_JMPREL, DT_PLTRELSZ)] {
            if let Some(table) = tag(table) {
                let length = tag(size).context("a relocation table has no size")?;
                let table = if length == 0 { 0 } else { self.offset(table)? };
                for at in (table..table + length).step_by(24) {
                    let info = bytes.u64(at + 8)?;
                    self.relocations.push(Relocation {
                        at: bytes.u64(at)?,
                        kind: info as u32,
                        symbol: (info >> 32) as u32,
                        addend: bytes.u64(at + 16)? as i64,
                    });
                }
            }
        }
        if let Some(table) = tag(DT_ANDROID_RELA) {
            let length = tag(DT_ANDROID_RELASZ).context("its packed relocations have no size")?;
            self.relocations.extend(unpack_relocations(bytes.slice(self.offset(table)?, length)?)?);
        }
        for (table, size) in [(DT_RELR, DT_RELRSZ), (DT_ANDROID_RELR, DT_ANDROID_RELRSZ)] {
            if let Some(table) = tag(table) {
                let packed = bytes.slice(
                    self.offset(table)?,
                    tag(size).context("a relative relocation table has no size")?,
                )?;
                for at in unpack_relative(packed)? {
                    let addend = bytes.u64(self.offset(at)?)? as i64;
                    self.relocations.push(Relocation { at, kind: machine::RELATIVE, symbol: 0, addend });
                }
            }
        }
        self.init = tag(DT_INIT);
        self.init_array = (tag(DT_INIT_ARRAY).unwrap_or(0), tag(DT_INIT_ARRAYSZ).unwrap_or(0));
        Ok(())
    }
}

fn check_segments(file: &[u8], segments: &[Segment]) -> Result<()> {
    let mut loads = segments.iter().filter(|segment| segment.kind == PT_LOAD).peekable();
    ensure!(loads.peek().is_some(), "it has no LOAD segment");
    let mut end = 0;
    for (index, load) in loads.enumerate() {
        ensure!(
            load.align >= PAGE && load.align.is_power_of_two(),
            "LOAD segment {index} is aligned to {:#x}: devices with 16 KiB pages cannot load it",
            load.align
        );
        ensure!(
            load.address % PAGE == load.offset % PAGE,
            "LOAD segment {index} cannot be mapped: its address and its offset differ within a page"
        );
        ensure!(
            load.flags & (WRITE | EXECUTE) != WRITE | EXECUTE,
            "LOAD segment {index} is writable and executable"
        );
        ensure!(
            load.file_size <= load.memory_size,
            "LOAD segment {index} is larger in the file than in memory"
        );
        ensure!(
            load.offset.checked_add(load.file_size).is_some_and(|end| end <= file.len() as u64),
            "the file ends within LOAD segment {index}"
        );
        let (first, last) = load.pages()?;
        ensure!(first >= end, "LOAD segment {index} shares a page with the one before it");
        ensure!(last < 1 << 32, "LOAD segment {index} is unreasonably large");
        end = last;
    }
    for segment in segments {
        ensure!(
            segment.kind != PT_TLS,
            "it has ELF thread-local storage: Android before API level 29 cannot load it, and the host has none"
        );
        ensure!(
            segment.kind != PT_GNU_STACK || segment.flags & EXECUTE == 0,
            "it asks for an executable stack"
        );
        if segment.kind == PT_GNU_RELRO {
            ensure!(
                segment.address.checked_add(segment.memory_size).is_some_and(|end| end % PAGE == 0),
                "its RELRO part does not end at a 16 KiB boundary: what follows would become read-only, too"
            );
        }
    }
    Ok(())
}

/// Number of symbols from a GNU hash table: one more than the largest index that a chain holds.
fn gnu_hash_symbols(bytes: &Bytes, at: u64) -> Result<u32> {
    let (buckets, first, bloom) = (bytes.u32(at)?, bytes.u32(at + 4)?, bytes.u32(at + 8)?);
    let bucket_at = at + 16 + u64::from(bloom) * 8;
    let mut last = 0;
    for index in 0..u64::from(buckets) {
        last = last.max(bytes.u32(bucket_at + index * 4)?);
    }
    if last < first {
        return Ok(first);
    }
    let chains = bucket_at + u64::from(buckets) * 4;
    while bytes.u32(chains + u64::from(last - first) * 4)? & 1 == 0 {
        last += 1;
    }
    Ok(last + 1)
}

/// RELR: an even word is an address, an odd word is a bitmap of the 63 words that follow.
fn unpack_relative(packed: &[u8]) -> Result<Vec<u64>> {
    let bytes = Bytes(packed);
    let mut addresses = Vec::new();
    let mut next = 0_u64;
    for at in (0..packed.len() as u64).step_by(8) {
        let word = bytes.u64(at)?;
        if word & 1 == 0 {
            addresses.push(word);
            next = word.wrapping_add(8);
        } else {
            addresses.extend(
                (0..63).filter(|bit| word >> (bit + 1) & 1 == 1).map(|bit| next.wrapping_add(bit * 8)),
            );
            next = next.wrapping_add(63 * 8);
        }
    }
    Ok(addresses)
}

/// Android's packed relocations ("APS2"): SLEB128 numbers in groups that share offset delta, info or addend.
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
            relocations.push(Relocation {
                at: at as u64,
                kind: info as u32,
                symbol: (info >> 32) as u32,
                addend,
            });
        }
    }
    Ok(relocations)
}

/// A library in memory.
pub struct Library {
    /// Path as `dladdr` tells it.
    pub path: CString,
    base: usize,
    span: usize,
    header: Vec<u8>,
    symbols: BTreeMap<String, usize>,
    code: Vec<(usize, usize)>,
    init: Vec<usize>,
}

/// What loading found.
pub struct Loaded {
    /// The library.
    pub library: Library,
    /// For the summary.
    pub facts: LibraryFacts,
    /// Imports that got a trap.
    pub trapped: Vec<String>,
}

impl Library {
    /// Maps and links a library. An import is looked for in the libraries that it names as needed; `find` knows what
    /// they export, `exists` whether any other library does.
    ///
    /// # Errors
    /// One sentence on what Android or the host would refuse.
    pub fn load(name: &str, file: &[u8], find: impl Fn(System, &str) -> Option<usize>) -> Result<Loaded> {
        let image = Image::parse(file).with_context(|| format!("{name} cannot be loaded"))?;
        let mut needed = Vec::new();
        for library in &image.needed {
            needed.push(System::named(library).with_context(|| {
                format!("{name} needs {library}, which is no public library known to the host")
            })?);
        }
        let base = map(&image)?;
        let (values, trapped) =
            bind(&image, base, &needed, find).with_context(|| format!("{name} cannot be linked"))?;
        for relocation in &image.relocations {
            let symbol = || {
                values
                    .get(relocation.symbol as usize)
                    .copied()
                    .context("a relocation names a symbol that is not there")
            };
            let value = match relocation.kind {
                machine::RELATIVE => base as u64,
                machine::ABSOLUTE | machine::GLOB_DAT | machine::JUMP_SLOT => symbol()? as u64,
                other => bail!("{name} has a relocation of type {other}, which the host does not know"),
            };
            ensure!(
                image.segments.iter().any(|segment| {
                    segment.kind == PT_LOAD
                        && segment.flags & WRITE != 0
                        && relocation.at >= segment.address
                        && relocation.at + 8 <= segment.address + segment.memory_size
                }),
                "{name} has a relocation outside of its writable segments"
            );
            // SAFETY: the address was checked to lie in a segment that `map` made writable.
            unsafe {
                ((base as u64 + relocation.at) as *mut u64)
                    .write_unaligned(value.wrapping_add_signed(relocation.addend))
            };
        }
        let mut library = Self {
            path: CString::new(format!("/data/app/base.apk!/{name}"))?,
            base,
            span: image
                .segments
                .iter()
                .filter(|segment| segment.kind == PT_LOAD)
                .map(|segment| segment.pages().map_or(0, |pages| pages.1))
                .max()
                .unwrap_or(0) as usize,
            header: image.header.clone(),
            symbols: image
                .symbols
                .iter()
                .filter_map(|symbol| Some((symbol.name.clone(), base + symbol.defined? as usize)))
                .collect(),
            code: Vec::new(),
            init: image.init.map(|init| base + init as usize).into_iter().collect(),
        };
        let (array, length) = image.init_array;
        for at in (array..array.saturating_add(length)).step_by(8) {
            image.offset(at)?;
            // SAFETY: the address lies in a mapped segment; the relocations above have filled the table in.
            library.init.push(unsafe { ((base as u64 + at) as *const usize).read_unaligned() });
        }
        protect(&image, base)?;
        library.code = image
            .segments
            .iter()
            .filter(|segment| segment.kind == PT_LOAD && segment.flags & EXECUTE != 0)
            .map(|segment| {
                (base + segment.address as usize, base + (segment.address + segment.memory_size) as usize)
            })
            .collect();
        let facts = LibraryFacts {
            name: name.to_owned(),
            size: file.len() as u64,
            needed: image.needed.clone(),
            symbols: image
                .symbols
                .iter()
                .filter(|symbol| symbol.defined.is_none() && !symbol.name.is_empty())
                .count()
                - trapped.len(),
            relocations: image.relocations.len(),
            alignment: image
                .segments
                .iter()
                .filter(|segment| segment.kind == PT_LOAD)
                .map(|segment| segment.align)
                .min()
                .unwrap_or(0),
        };
        Ok(Loaded { library, facts, trapped })
    }

    /// Runs the constructors.
    ///
    /// # Safety
    /// Once, after everything that they may call is in place.
    pub unsafe fn initialize(&self) {
        for function in &self.init {
            // SAFETY: DT_INIT and DT_INIT_ARRAY hold functions of this type; the caller vouches for the moment.
            let function: extern "C" fn(i32, *const *const u8, *const *const u8) =
                unsafe { std::mem::transmute(*function) };
            function(0, std::ptr::null(), std::ptr::null());
        }
    }

    /// Address of an exported symbol.
    pub fn symbol(&self, name: &str) -> Option<usize> {
        self.symbols.get(name).copied()
    }

    /// Start of the mapping.
    pub fn base(&self) -> usize {
        self.base
    }

    /// Whether the address lies in the library.
    pub fn contains(&self, address: usize) -> bool {
        (self.base..self.base + self.span).contains(&address)
    }

    /// Whether the address lies in the library's code.
    pub fn is_code(&self, address: usize) -> bool {
        self.code.iter().any(|(start, end)| (*start..*end).contains(&address))
    }

    /// Program headers, as in the file.
    pub fn program_headers(&self) -> &[u8] {
        &self.header
    }
}

/// Maps the segments as a kernel with 16 KiB pages would, writable for the moment.
fn map(image: &Image) -> Result<usize> {
    let span = image
        .segments
        .iter()
        .filter(|segment| segment.kind == PT_LOAD)
        .map(|segment| segment.pages().map(|pages| pages.1))
        .try_fold(0, |end, pages| pages.map(|pages| end.max(pages)))?;
    // SAFETY: a new anonymous mapping at an address of the kernel's choice.
    let memory = unsafe {
        libc::mmap(
            std::ptr::null_mut(),
            (span + PAGE) as usize,
            libc::PROT_NONE,
            libc::MAP_PRIVATE | libc::MAP_ANONYMOUS,
            -1,
            0,
        )
    };
    ensure!(memory != libc::MAP_FAILED, "no memory for the library: {}", std::io::Error::last_os_error());
    let base = (memory as usize).next_multiple_of(PAGE as usize);
    for segment in image.segments.iter().filter(|segment| segment.kind == PT_LOAD) {
        let (first, last) = segment.pages()?;
        protect_range(base, first, last, libc::PROT_READ | libc::PROT_WRITE)?;
        let start = segment.offset - (segment.address - first);
        let source = &image.file[start as usize..(segment.offset + segment.file_size) as usize];
        // SAFETY: the pages were just made writable and hold at least the segment; what the file has before the segment
        // on its first page is mapped along, as a kernel does.
        unsafe {
            std::ptr::copy_nonoverlapping(source.as_ptr(), (base as u64 + first) as *mut u8, source.len())
        };
    }
    Ok(base)
}

fn protect(image: &Image, base: usize) -> Result<()> {
    for segment in image.segments.iter().filter(|segment| segment.kind == PT_LOAD) {
        let (first, last) = segment.pages()?;
        let mut protection = 0;
        for (flag, bit) in [(READ, libc::PROT_READ), (WRITE, libc::PROT_WRITE), (EXECUTE, libc::PROT_EXEC)] {
            if segment.flags & flag != 0 {
                protection |= bit;
            }
        }
        protect_range(base, first, last, protection)?;
    }
    if let Some(relro) = &image.relro {
        protect_range(base, relro.address & !(PAGE - 1), relro.address + relro.memory_size, libc::PROT_READ)?;
    }
    Ok(())
}

fn protect_range(base: usize, first: u64, last: u64, protection: i32) -> Result<()> {
    // SAFETY: the range lies in the mapping made by `map`, which nothing else uses yet.
    let result = unsafe {
        libc::mprotect((base as u64 + first) as *mut libc::c_void, (last - first) as usize, protection)
    };
    ensure!(result == 0, "memory protection cannot be set: {}", std::io::Error::last_os_error());
    Ok(())
}

/// The value of every symbol, and the names of those that got a trap.
fn bind(
    image: &Image,
    base: usize,
    needed: &[System],
    find: impl Fn(System, &str) -> Option<usize>,
) -> Result<(Vec<usize>, Vec<String>)> {
    let mut values = vec![0; image.symbols.len()];
    let mut missing = Vec::new();
    for (index, symbol) in image.symbols.iter().enumerate().skip(1) {
        if let Some(address) = symbol.defined {
            values[index] = base + address as usize;
        } else if let Some(address) = needed.iter().find_map(|library| find(*library, &symbol.name)) {
            values[index] = address;
        } else if let Some(library) = System::ALL
            .into_iter()
            .find(|library| !needed.contains(library) && find(*library, &symbol.name).is_some())
        {
            bail!("{} comes from {}, which the library does not name as needed", symbol.name, library.name());
        } else if !symbol.weak {
            missing.push(index);
        }
    }
    let names: Vec<_> = missing.iter().map(|index| image.symbols[*index].name.clone()).collect();
    for (index, address) in missing.into_iter().zip(thunk::traps(&names)?) {
        values[index] = address;
    }
    Ok((values, names))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_relocations_unpack() {
        let words = [0x1000_u64, 0b1011, 0x2000];
        let packed: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        assert_eq!(unpack_relative(&packed).unwrap(), [0x1000, 0x1008, 0x1018, 0x2000]);
        // A bitmap covers 63 words, and the next one goes on behind them.
        let words = [0x1000_u64, 1, 0b11];
        let packed: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        assert_eq!(unpack_relative(&packed).unwrap(), [0x1000, 0x1008 + 63 * 8]);
    }

    #[test]
    fn packed_relocations_unpack() {
        // Three relocations from 0x100 on: a group of two that shares delta 8 and info 8 and has addends 5 and 5 - 3,
        // then one without addend, of info 6 and delta 16.
        let mut packed = b"APS2".to_vec();
        packed.extend([3, 0x80, 0x02, 2, 1 | 2 | 8, 8, 8, 5, 0x7d, 1, 0, 16, 6]);
        let relocations = unpack_relocations(&packed).unwrap();
        let relocation = |at, kind, addend| Relocation { at, kind, symbol: 0, addend };
        assert_eq!(relocations, [relocation(0x108, 8, 5), relocation(0x110, 8, 2), relocation(0x120, 6, 0)]);
        assert!(unpack_relocations(&packed[..10]).is_err());
        assert!(unpack_relocations(b"nope").is_err());
    }

    /// A library of one segment and nothing in it but its own headers.
    fn elf(change: impl FnOnce(&mut Vec<u8>)) -> String {
        let mut file = vec![0; 64 + 2 * 56];
        file[..7].copy_from_slice(b"\x7fELF\x02\x01\x01");
        file[16..18].copy_from_slice(&3_u16.to_le_bytes());
        file[18..20].copy_from_slice(&machine::NUMBER.to_le_bytes());
        file[32..40].copy_from_slice(&64_u64.to_le_bytes());
        file[54..56].copy_from_slice(&56_u16.to_le_bytes());
        file[56..58].copy_from_slice(&2_u16.to_le_bytes());
        file[64..68].copy_from_slice(&PT_LOAD.to_le_bytes());
        file[68..72].copy_from_slice(&(READ | EXECUTE).to_le_bytes());
        file[64 + 48..64 + 56].copy_from_slice(&PAGE.to_le_bytes());
        change(&mut file);
        format!("{:#}", Image::parse(&file).err().expect("refused"))
    }

    #[test]
    fn what_android_refuses_is_refused() {
        assert!(elf(|_| {}).contains("dynamic section"));
        assert!(elf(|file| file.truncate(80)).contains("ends before"));
        assert!(elf(|file| file[0] = 0).contains("ELF"));
        assert!(elf(|file| file[18] = 3).contains("another machine"));
        assert!(
            elf(|file| file[64 + 48..64 + 56].copy_from_slice(&0x1000_u64.to_le_bytes())).contains("16 KiB")
        );
        assert!(elf(|file| file[68] = 7).contains("writable and executable"));
        assert!(elf(|file| file[120..124].copy_from_slice(&PT_TLS.to_le_bytes())).contains("thread-local"));
        assert!(
            elf(|file| file[64 + 32..64 + 40].copy_from_slice(&u64::MAX.to_le_bytes()))
                .contains("larger in the file")
        );
    }
}
