//! Makes libraries portable: they only call functions of old C libraries, and hold nothing of the builder's machine.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::ensure;

use crate::console::run;
use crate::folders::{read, root, write};
use crate::rust::anonymous_paths;

/// The oldest supported glibc, which Debian 10, Ubuntu 18.10 and RHEL 8 have.
pub const OLDEST_GLIBC: (u32, u32) = (2, 28);

/// What Rust's std calls of newer versions, in terms of older functions.
const OLD_FUNCTIONS: &str = include_str!("templates/old_functions.c");

/// Compiles these functions with a C compiler and its arguments, and returns the object file.
pub fn old_functions(compiler: &mut Command, folder: &Path) -> anyhow::Result<PathBuf> {
    let (source, object) = (folder.join("old_functions.c"), folder.join("old_functions.o"));
    write(&source, OLD_FUNCTIONS)?;
    run(compiler.args(["-c", "-O2", "-fPIC", "-o"]).arg(&object).arg(&source))?;
    Ok(object)
}

/// Adds rustc's flag that removes the builder's folders from source file names.
pub fn set_flags(cargo: &mut Command) {
    let given = cargo.get_envs().find(|(name, _)| *name == OsStr::new("CARGO_ENCODED_RUSTFLAGS"));
    let given = given.and_then(|(_, value)| value).map(|value| value.to_string_lossy().into_owned());
    let flags: Vec<String> = given.into_iter().chain(anonymous_paths()).collect();
    cargo.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
}

/// Checks that a library runs with the oldest supported glibc, and contains none of the builder's folders.
pub fn check(file: &Path) -> anyhow::Result<()> {
    let (major, minor) = needed_glibc(file)?;
    ensure!(
        (major, minor) <= OLDEST_GLIBC,
        "{} needs glibc {major}.{minor}, which is too new: `objdump -T` names the functions; give older ones in \
         xtask/src/package/templates/old_functions.c",
        file.display()
    );
    Ok(())
}

/// Checks that a program or a library contains none of the builder's folders, and returns the oldest glibc that it runs
/// with: any if it names none.
pub fn needed_glibc(file: &Path) -> anyhow::Result<(u32, u32)> {
    let content = read(file)?;
    check_folders(file, &content)?;
    Ok(newest_glibc(&content).unwrap_or_default())
}

fn check_folders(file: &Path, content: &[u8]) -> anyhow::Result<()> {
    for folder in [root()].into_iter().chain(std::env::home_dir()) {
        // A home such as / or /root does not identify anybody, only folders in it do.
        let name = format!("{}/", folder.display());
        let is_in = content.windows(name.len()).any(|window| window == name.as_bytes());
        ensure!(!is_in, "{} holds the builder's folder {name}: remap it", file.display());
    }
    Ok(())
}

/// Returns the newest glibc version among a library's dynamic symbols.
fn newest_glibc(content: &[u8]) -> Option<(u32, u32)> {
    const NAME: &[u8] = b"GLIBC_";
    let names = content.windows(NAME.len()).enumerate().filter(|(_, window)| *window == NAME);
    let versions = names.filter_map(|(at, _)| {
        let rest = &content[at + NAME.len()..];
        let end = rest.iter().position(|byte| !matches!(byte, b'0'..=b'9' | b'.'))?;
        let mut numbers = std::str::from_utf8(&rest[..end]).ok()?.split('.').map(str::parse);
        Some((numbers.next()?.ok()?, numbers.next()?.ok()?))
    });
    versions.max()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check fails for libraries that a package must not contain.
    #[test]
    fn newer_functions_and_the_builders_folders_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let outcome = |content: &str| {
            let file = folder.path().join("library");
            write(&file, content).unwrap();
            check(&file).map_err(|error| error.to_string())
        };
        assert_eq!(outcome("\0GLIBC_2.17\0/rustc/library/std/src"), Ok(()));
        assert!(outcome("\0GLIBC_2.33\0").unwrap_err().contains("glibc 2.33"));
        let own = format!("\0{}/app/core/src/lib.rs\0", root().display());
        assert!(outcome(&own).unwrap_err().contains("builder's folder"));
    }
}
