//! A stand-in for Google's SDK and NDK, made of Debian's clang and Android tools: what cargo-apk uses of both.
//!
//! Its libraries contain only public names, so that linking fails with any other name. The device's own libraries take
//! their place when the application starts.

use std::fmt::Write as _;
use std::fs;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Context as _;

use super::symbols::{LISTS, listed};
use super::target::{ARCHITECTURES, Architecture, MIN_API, TARGET_API};
use crate::apt::find_program;
use crate::console::run;
use crate::folders::{make, make_once, make_parent, write};

const CRTBEGIN: &str = include_str!("../../ndk/crtbegin_so.c");
const UNWIND: &str = include_str!("../../ndk/unwind.c");
/// Debian's build of Android's framework, which defines what manifests and resources may contain.
pub const FRAMEWORK: &str = "/usr/share/android-framework-res/framework-res.apk";

/// Version 0.0.1 is old enough that cargo-apk omits its own libgcc, which newer NDKs need.
const PROPERTIES: &str = "Pkg.Desc = Android NDK stand-in\nPkg.Revision = 0.0.1\n";
/// Without a newline at the end: cargo-apk rejects a file with an empty line.
const PLATFORMS: &str = "NDK_MIN_PLATFORM_LEVEL := 21\nNDK_MAX_PLATFORM_LEVEL := 36";

/// The folders of the stand-in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StandIn {
    /// The value of ANDROID_HOME.
    pub sdk: PathBuf,
    /// The value of ANDROID_NDK_ROOT.
    pub ndk: PathBuf,
}

impl StandIn {
    /// Makes the SDK and the NDK in `folder`, unless they exist and are up to date.
    pub fn make(folder: &Path) -> anyhow::Result<Self> {
        let made = Self { sdk: folder.join("sdk"), ndk: folder.join("ndk") };
        make_once(folder, &recipe(), || {
            made.make_sdk()?;
            made.make_ndk()
        })?;
        Ok(made)
    }

    fn make_sdk(&self) -> anyhow::Result<()> {
        for tool in ["aapt", "zipalign", "apksigner"] {
            link(&program(tool)?, &self.sdk.join("build-tools/29.0.3").join(tool))?;
        }
        link(Path::new(FRAMEWORK), &self.sdk.join(format!("platforms/android-{TARGET_API}/android.jar")))
    }

    fn make_ndk(&self) -> anyhow::Result<()> {
        write(&self.ndk.join("source.properties"), PROPERTIES)?;
        write(&self.ndk.join("build/core/platforms.mk"), PLATFORMS)?;
        let toolchain = self.ndk.join("toolchains/llvm/prebuilt/linux-x86_64");
        for tool in ["clang", "clang++", "llvm-ar", "llvm-objcopy", "llvm-readelf"] {
            link(&program(tool)?, &toolchain.join("bin").join(tool))?;
        }
        for architecture in ARCHITECTURES {
            let folder = toolchain.join("sysroot/usr/lib");
            make_libraries(&folder, architecture, MIN_API)?;
            make_unwinder(&folder, architecture, UNWIND)?;
        }
        Ok(())
    }

    /// Returns the compiler and linker.
    pub fn clang(&self) -> PathBuf {
        self.ndk.join("toolchains/llvm/prebuilt/linux-x86_64/bin/clang")
    }

    /// Returns the arguments that make Debian's clang link like the NDK's.
    pub fn link_arguments(&self) -> [String; 2] {
        let sysroot = self.ndk.join("toolchains/llvm/prebuilt/linux-x86_64/sysroot");
        ["-fuse-ld=lld".to_owned(), format!("--sysroot={}", sysroot.display())]
    }
}

/// Returns a hash of everything that the stand-in depends on. Cargo does not notice when a stub changes.
fn recipe() -> String {
    let mut hasher = DefaultHasher::new();
    (LISTS, CRTBEGIN, UNWIND, PROPERTIES, PLATFORMS, MIN_API, TARGET_API).hash(&mut hasher);
    for tool in ["clang", "llvm-ar", "aapt"] {
        find_program(tool).and_then(|path| path.canonicalize().ok()).hash(&mut hasher);
    }
    format!("{:016x}\n", hasher.finish())
}

/// Makes the stub libraries of an API level, and the object files that a linker puts first and last.
pub fn make_libraries(folder: &Path, architecture: Architecture, api: u32) -> anyhow::Result<()> {
    let target = format!("--target={}{api}", architecture.triple);
    let level = folder.join(architecture.triple).join(api.to_string());
    make(&level)?;
    let source = level.join("source");

    for (library, list) in LISTS {
        write(&source, stub(list, api))?;
        let soname = format!("-Wl,-soname,{library}.so");
        let options = ["-fuse-ld=lld", "-nostdlib", "-shared", &soname];
        clang(&target, &options, "assembler", &source, &level.join(format!("{library}.so")))?;
    }
    let compile = ["-O2", "-fPIC", "-ffreestanding", "-c"];
    write(&source, CRTBEGIN)?;
    clang(&target, &compile, "c", &source, &level.join("crtbegin_so.o"))?;
    write(&source, "")?;
    clang(&target, &compile, "c", &source, &level.join("crtend_so.o"))?;
    fs::remove_file(&source).with_context(|| format!("{} cannot be removed", source.display()))
}

/// Makes the library that std uses for unwinding from this source, which is empty if libc has all of its functions.
pub fn make_unwinder(folder: &Path, architecture: Architecture, content: &str) -> anyhow::Result<()> {
    let target = format!("--target={}{MIN_API}", architecture.triple);
    let common = folder.join(architecture.triple);
    let (source, unwind) = (common.join("source"), common.join("unwind.o"));
    write(&source, content)?;
    clang(&target, &["-O2", "-fPIC", "-ffreestanding", "-c"], "c", &source, &unwind)?;
    run(Command::new("llvm-ar").arg("rcs").arg(common.join("libunwind.a")).arg(&unwind))?;
    for temporary in [unwind, source] {
        fs::remove_file(&temporary).with_context(|| format!("{} cannot be removed", temporary.display()))?;
    }
    Ok(())
}

/// Returns the assembly of a library that defines the names but contains no code.
fn stub(list: &str, api: u32) -> String {
    let mut text = String::new();
    for symbol in listed(list, api) {
        let name = symbol.name;
        let (section, kind, content) =
            if symbol.object { (".data", "object", ".quad 0") } else { (".text", "function", "") };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{section}\n.globl {name}\n.type {name}, %{kind}\n{name}: {content}");
    }
    text
}

fn clang(target: &str, options: &[&str], language: &str, source: &Path, made: &Path) -> anyhow::Result<()> {
    let mut command = Command::new("clang");
    command.arg(target).args(options).args(["-x", language]).arg(source).arg("-o").arg(made);
    run(&mut command).map(drop)
}

fn program(name: &str) -> anyhow::Result<PathBuf> {
    find_program(name).with_context(|| format!("{name} is missing: `cargo xtask doctor` says how to get it"))
}

fn link(original: &Path, link: &Path) -> anyhow::Result<()> {
    make_parent(link)?;
    symlink(original, link).with_context(|| format!("{} cannot be made", link.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stub_has_the_names_of_its_level() {
        assert_eq!(
            stub("# A library.\nopen\nenviron:object\n@30\nlater\n", 29),
            ".text\n.globl open\n.type open, %function\nopen: \n\
             .data\n.globl environ\n.type environ, %object\nenviron: .quad 0\n"
        );
    }
}
