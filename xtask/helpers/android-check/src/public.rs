//! The symbols that Android's public libraries export to applications.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::Context as _;
use goblin::elf::Elf;
use goblin::elf::section_header::SHN_UNDEF;
use xtask::ndk::symbols::{LISTS, listed};
use xtask::ndk::target::{Architecture, MIN_API};

/// The source of the public symbols.
#[derive(Debug)]
pub enum Public {
    /// This project's lists.
    Lists,
    /// The stub libraries of an NDK, in this `sysroot/usr/lib` folder.
    Stubs(std::path::PathBuf),
}

impl Public {
    /// Returns the NDK's stubs, or this project's lists if there is no NDK.
    pub fn of(ndk: Option<&Path>) -> Self {
        let stubs = ndk.map(|ndk| ndk.join("toolchains/llvm/prebuilt/linux-x86_64/sysroot/usr/lib"));
        match stubs.filter(|folder| folder.is_dir()) {
            Some(folder) => Self::Stubs(folder),
            None => Self::Lists,
        }
    }

    /// Returns a library's exports on the oldest supported Android, or `None` if the library is not public.
    ///
    /// # Errors
    /// Fails if a stub of the NDK cannot be read.
    pub fn symbols(
        &self,
        library: &str,
        architecture: Architecture,
    ) -> anyhow::Result<Option<BTreeSet<String>>> {
        match self {
            Self::Lists => {
                let list = LISTS.iter().find(|(name, _)| library.strip_suffix(".so") == Some(name));
                Ok(list.map(|(_, list)| listed(list, MIN_API).map(|symbol| symbol.name.to_owned()).collect()))
            }
            Self::Stubs(folder) => {
                let path = folder.join(architecture.triple).join(MIN_API.to_string()).join(library);
                if !path.is_file() {
                    return Ok(None);
                }
                let bytes = fs::read(&path).with_context(|| format!("{} cannot be read", path.display()))?;
                let elf = Elf::parse(&bytes).with_context(|| format!("{} is no library", path.display()))?;
                let defined = elf.dynsyms.iter().filter(|symbol| symbol.st_shndx != SHN_UNDEF as usize);
                Ok(Some(defined.filter_map(|s| elf.dynstrtab.get_at(s.st_name).map(str::to_owned)).collect()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use xtask::ndk::target::ARCHITECTURES;

    use super::*;

    #[test]
    fn private_libraries_have_no_list() {
        let symbols = |library| Public::Lists.symbols(library, ARCHITECTURES[0]).unwrap();
        assert!(symbols("libEGL.so").unwrap().contains("eglSwapBuffers"));
        assert!(symbols("libcutils.so").is_none());
        assert!(symbols("libEGL").is_none());
    }
}
