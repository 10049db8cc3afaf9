//! Loads the libraries of a package. glibc's `dlopen` cannot be used, because imports must be bound to the exports of
//! Android's libraries. This loader is stricter than Android's.

use std::collections::BTreeMap;
use std::ffi::{CString, c_void};
use std::ops::Range;

use anyhow::{Context, Result, bail, ensure};
use goblin::elf::Sym;
use goblin::elf::dynamic::{DT_INIT, DT_INIT_ARRAY, DT_INIT_ARRAYSZ};
use goblin::elf::program_header::{PF_R, PF_W, PF_X, PT_GNU_RELRO, ProgramHeader, program_header64};
use goblin::elf::section_header::SHN_UNDEF;
use goblin::elf::sym::STB_WEAK;

use crate::elf::{Image, PAGE, machine, pages};
use crate::exports::System;
use crate::thunk;

/// A loaded library.
pub struct Library {
    /// The path that `dladdr` reports.
    pub path: CString,
    /// The start of the mapping.
    pub base: usize,
    span: usize,
    /// The program headers, as in the file.
    pub program_headers: Vec<u8>,
    symbols: BTreeMap<String, usize>,
    code: Vec<Range<usize>>,
    init: Vec<usize>,
}

/// The result of loading.
pub struct Loaded {
    /// The library.
    pub library: Library,
    /// The imported symbols without a definition. Calling one ends the run with its name.
    pub trapped: Vec<String>,
}

impl Library {
    /// Maps and links a library. Imports are searched in the libraries that this one needs. `find` returns the address
    /// of a symbol that a system library exports.
    ///
    /// # Errors
    /// Fails with one sentence on what Android or the host would reject.
    pub fn load(name: &str, file: &[u8], find: impl Fn(System, &str) -> Option<usize>) -> Result<Loaded> {
        let image = Image::parse(file).with_context(|| format!("{name} cannot be loaded"))?;
        let needed = image.elf.libraries.iter().map(|library| {
            System::named(library).with_context(|| {
                format!("{name} needs {library}, which is no public library known to the host")
            })
        });
        let needed = needed.collect::<Result<Vec<_>>>()?;
        let span = image.loads().map(|segment| pages(segment).map_or(0, |pages| pages.1)).max().unwrap_or(0);
        let base = map(&image, span)?;
        let (values, trapped) =
            bind(&image, base, &needed, find).with_context(|| format!("{name} cannot be linked"))?;
        relocate(&image, base, &values).with_context(|| format!("{name} cannot be linked"))?;
        let init = constructors(&image, base)?;
        protect(&image, base)?;
        let exports = image.symbols.iter();
        let exports =
            exports.filter_map(|(name, symbol)| Some(((*name).to_owned(), base + defined(symbol)?)));
        let headers = image.elf.header.e_phoff as usize;
        let headers = headers..headers + image.elf.program_headers.len() * program_header64::SIZEOF_PHDR;
        let code = image.loads().filter(|segment| segment.p_flags & PF_X != 0).map(|segment| {
            let start = base + segment.p_vaddr as usize;
            start..start + segment.p_memsz as usize
        });
        let library = Self {
            path: CString::new(format!("/data/app/base.apk!/{name}"))?,
            base,
            span: span as usize,
            program_headers: image.file[headers].to_vec(),
            symbols: exports.collect(),
            code: code.collect(),
            init,
        };
        Ok(Loaded { library, trapped })
    }

    /// Runs the constructors.
    ///
    /// # Safety
    /// Must be called once, when everything that they may call is in place.
    pub unsafe fn initialize(&self) {
        for function in &self.init {
            // SAFETY: DT_INIT and DT_INIT_ARRAY contain functions of this type. The caller allows them to run.
            let function: extern "C" fn(i32, *const *const u8, *const *const u8) =
                unsafe { std::mem::transmute(*function) };
            function(0, std::ptr::null(), std::ptr::null());
        }
    }

    /// Returns the address of an exported symbol.
    pub fn symbol(&self, name: &str) -> Option<usize> {
        self.symbols.get(name).copied()
    }

    /// True if the address lies in the library.
    pub fn contains(&self, address: usize) -> bool {
        (self.base..self.base + self.span).contains(&address)
    }

    /// True if the address lies in the library's code.
    pub fn is_code(&self, address: usize) -> bool {
        self.code.iter().any(|range| range.contains(&address))
    }
}

/// Returns the address of a symbol in its library, if the library defines it.
fn defined(symbol: &Sym) -> Option<usize> {
    (symbol.st_shndx != SHN_UNDEF as usize).then_some(symbol.st_value as usize)
}

/// Maps the segments as a kernel with 16 KiB pages would, for now writable, and returns the start of the library.
fn map(image: &Image, span: u64) -> Result<usize> {
    // SAFETY: creates a new anonymous mapping at an address chosen by the kernel.
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
    for segment in image.loads() {
        let (first, last) = pages(segment)?;
        protect_range(base, first, last, libc::PROT_READ | libc::PROT_WRITE)?;
        let start = segment.p_offset - (segment.p_vaddr - first);
        let source = &image.file[start as usize..(segment.p_offset + segment.p_filesz) as usize];
        // SAFETY: the pages were just made writable, and hold at least the segment. As by a kernel, bytes of the file
        // that precede the segment on its first page are mapped as well.
        unsafe {
            std::ptr::copy_nonoverlapping(source.as_ptr(), (base as u64 + first) as *mut u8, source.len())
        };
    }
    Ok(base)
}

/// Returns the values of all symbols, and the names of those without a definition, which become traps.
fn bind(
    image: &Image,
    base: usize,
    needed: &[System],
    find: impl Fn(System, &str) -> Option<usize>,
) -> Result<(Vec<usize>, Vec<String>)> {
    let mut values = vec![0; image.symbols.len()];
    let mut missing = Vec::new();
    for (index, (name, symbol)) in image.symbols.iter().enumerate().skip(1) {
        let finds = |library: &System| find(*library, name);
        if let Some(address) = defined(symbol) {
            values[index] = base + address;
        } else if let Some(address) = needed.iter().find_map(finds) {
            values[index] = address;
        } else if let Some(library) = System::ALL.into_iter().find(|library| finds(library).is_some()) {
            bail!("{name} comes from {}, which the library does not name as needed", library.0);
        } else if symbol.st_bind() != STB_WEAK {
            missing.push(index);
        }
    }
    let names: Vec<_> = missing.iter().map(|index| image.symbols[*index].0.to_owned()).collect();
    for (index, address) in missing.into_iter().zip(thunk::traps(&names)?) {
        values[index] = address;
    }
    Ok((values, names))
}

/// Applies the relocations. `values` are the values of the symbols.
fn relocate(image: &Image, base: usize, values: &[usize]) -> Result<()> {
    for relocation in image.elf.dynrelas.iter().chain(&image.elf.pltrelocs) {
        let at = relocation.r_offset;
        let value = match relocation.r_type {
            machine::RELATIVE => base,
            machine::ABSOLUTE | machine::GLOB_DAT | machine::JUMP_SLOT => {
                *values.get(relocation.r_sym).context("a relocation names a symbol that is not there")?
            }
            other => bail!("a relocation has the type {other}, which the host does not know"),
        };
        let end = at.checked_add(8).context("a relocation wraps around")?;
        let is_writable = image.loads().any(|segment| {
            let range = segment.p_vaddr..=segment.p_vaddr + segment.p_memsz;
            segment.p_flags & PF_W != 0 && range.contains(&at) && range.contains(&end)
        });
        ensure!(is_writable, "a relocation lies outside of the writable segments");
        let value = (value as u64).wrapping_add_signed(relocation.r_addend.unwrap_or(0));
        // SAFETY: the address was checked to be in a segment that `map` has made writable.
        unsafe { ((base as u64 + at) as *mut u64).write_unaligned(value) };
    }
    Ok(())
}

/// Returns the addresses of the constructors. The relocations must have been applied.
fn constructors(image: &Image, base: usize) -> Result<Vec<usize>> {
    let mut init: Vec<_> = image.tag(DT_INIT).map(|init| base + init as usize).into_iter().collect();
    let [start, length] = [DT_INIT_ARRAY, DT_INIT_ARRAYSZ].map(|tag| image.tag(tag).unwrap_or(0));
    for at in (start..start.saturating_add(length)).step_by(8) {
        let is_in =
            |segment: &ProgramHeader| (segment.p_vaddr..segment.p_vaddr + segment.p_filesz).contains(&at);
        ensure!(image.loads().any(is_in), "address {at:#x} lies in no segment");
        // SAFETY: the address is in a mapped segment, and the relocations have filled in the table.
        init.push(unsafe { ((base as u64 + at) as *const usize).read_unaligned() });
    }
    Ok(init)
}

fn protect(image: &Image, base: usize) -> Result<()> {
    for segment in image.loads() {
        let (first, last) = pages(segment)?;
        let bits = [(PF_R, libc::PROT_READ), (PF_W, libc::PROT_WRITE), (PF_X, libc::PROT_EXEC)];
        let bits = bits.into_iter().filter(|(flag, _)| segment.p_flags & flag != 0);
        protect_range(base, first, last, bits.fold(0, |all, (_, bit)| all | bit))?;
    }
    // The segment that becomes read-only after the relocations.
    if let Some(relro) = image.elf.program_headers.iter().find(|segment| segment.p_type == PT_GNU_RELRO) {
        protect_range(base, relro.p_vaddr & !(PAGE - 1), relro.p_vaddr + relro.p_memsz, libc::PROT_READ)?;
    }
    Ok(())
}

fn protect_range(base: usize, first: u64, last: u64, protection: i32) -> Result<()> {
    // SAFETY: the range is in the mapping made by `map`, which nothing else uses yet.
    let result =
        unsafe { libc::mprotect((base as u64 + first) as *mut c_void, (last - first) as usize, protection) };
    ensure!(result == 0, "memory protection cannot be set: {}", std::io::Error::last_os_error());
    Ok(())
}
