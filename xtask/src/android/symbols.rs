//! Which functions Android's public libraries offer.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::Context as _;
use goblin::elf::Elf;
use goblin::elf::section_header::SHN_UNDEF;

use super::target::{Architecture, MIN_API};

/// The lists that the stand-in NDK is made of. They hold all of EGL, GLES and libandroid, and of libc and libm what
/// Rust's std and this project ask for.
pub const LISTS: [(&str, &str); 8] = [
    ("libEGL", include_str!("../../android/symbols/libEGL.txt")),
    ("libGLESv2", include_str!("../../android/symbols/libGLESv2.txt")),
    ("libGLESv3", include_str!("../../android/symbols/libGLESv3.txt")),
    ("libandroid", include_str!("../../android/symbols/libandroid.txt")),
    ("libc", include_str!("../../android/symbols/libc.txt")),
    ("libdl", include_str!("../../android/symbols/libdl.txt")),
    ("liblog", include_str!("../../android/symbols/liblog.txt")),
    ("libm", include_str!("../../android/symbols/libm.txt")),
];

/// A public name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Symbol<'a> {
    /// As the linker knows it.
    pub name: &'a str,
    /// Data, not a function.
    pub object: bool,
}

/// The names of a list that an API level has.
pub fn listed(list: &str, api: u32) -> impl Iterator<Item = Symbol<'_>> {
    let mut since = 0;
    list.lines().filter(|line| !line.starts_with('#') && !line.is_empty()).filter_map(move |line| {
        if let Some(level) = line.strip_prefix('@') {
            since = level.parse().unwrap_or(u32::MAX);
            return None;
        }
        let (name, object) = line.strip_suffix(":object").map_or((line, false), |name| (name, true));
        (since <= api).then_some(Symbol { name, object })
    })
}

/// Where the check learns what is public.
#[derive(Debug)]
pub enum Public {
    /// The lists of this project.
    Lists,
    /// The stub libraries of an NDK: the `sysroot/usr/lib` folder.
    Stubs(std::path::PathBuf),
}

impl Public {
    /// The NDK's own stubs; without an NDK the lists.
    pub fn of(ndk: Option<&Path>) -> Self {
        let stubs = ndk.map(|ndk| ndk.join("toolchains/llvm/prebuilt/linux-x86_64/sysroot/usr/lib"));
        match stubs.filter(|folder| folder.is_dir()) {
            Some(folder) => Self::Stubs(folder),
            None => Self::Lists,
        }
    }

    /// What a library offers to the oldest Android; `None` when it is not public.
    ///
    /// # Errors
    /// When a stub of the NDK cannot be read.
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
    use super::*;

    #[test]
    fn a_list_knows_levels_and_data() {
        let list = "# A library.\none\ntwo:object\n@30\nthree\n";
        let at = |api| listed(list, api).map(|symbol| (symbol.name, symbol.object)).collect::<Vec<_>>();
        assert_eq!(at(29), [("one", false), ("two", true)]);
        assert_eq!(at(30), [("one", false), ("two", true), ("three", false)]);
    }

    #[test]
    fn every_list_is_sorted_and_free_of_doubles() {
        for (library, list) in LISTS {
            let names: Vec<_> = listed(list, MIN_API).map(|symbol| symbol.name).collect();
            assert!(names.len() > 3, "{library}");
            assert!(names.is_sorted_by(|a, b| a < b), "{library}");
        }
    }

    #[test]
    fn an_unwinder_is_public_since_api_30() {
        let libc = LISTS.iter().find(|(name, _)| *name == "libc").unwrap().1;
        assert!(listed(libc, 30).any(|symbol| symbol.name == "_Unwind_Resume"));
        assert!(!listed(libc, 29).any(|symbol| symbol.name == "_Unwind_Resume"));
    }

    #[test]
    fn private_libraries_have_no_list() {
        let symbols =
            |library| Public::Lists.symbols(library, super::super::target::ARCHITECTURES[0]).unwrap();
        assert!(symbols("libEGL.so").unwrap().contains("eglSwapBuffers"));
        assert!(symbols("libcutils.so").is_none());
        assert!(symbols("libEGL").is_none());
    }
}
