//! Programs and libraries for Linux on arm64. qemu's user mode runs them on x86_64 machines: the simulated Android host,
//! so that the tests execute the library that phones execute, and the program.
//!
//! qemu and the host's libraries come from Debian packages, which are only unpacked into a folder. apt gets a private
//! state for this, and nothing is installed.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Context as _;

use crate::apt::{self, Need};
use crate::cargo;
use crate::folders::{make_once, target_folder};
use crate::packages::{PrivateApt, quoted, write_launcher};
use crate::rust::{Panic, Rust, build_std, source};

/// Rust's name for the target.
pub const TRIPLE: &str = "aarch64-unknown-linux-gnu";
/// Mesa's EGL and OpenGL ES with its rasterizer, and what a linker needs. The package of libstdc++, which needs that of
/// libgcc, is missing here, since its name contains a number.
const PACKAGES: [&str; 5] = ["libegl1", "libegl-mesa0", "libgles2", "libgl1-mesa-dri", "libc6-dev"];
const LIBSTDCXX: &str = "libstdc++-";
const QEMU: [&str; 2] = ["usr/bin/qemu-aarch64-static", "usr/bin/qemu-aarch64"];

/// Installs what compiling for arm64 needs, without asking, and fetches what its programs need. Returns the folder.
pub fn fetch() -> anyhow::Result<PathBuf> {
    let needs = || {
        let rust = Rust::for_target(TRIPLE).map(|(rust, _)| rust);
        vec![
            Need::program("clang", &["clang"]),
            Need::program("ld.lld", &["lld"]),
            Need::program("llvm-strip", &["llvm"]),
            Need::program("llvm-ar", &["llvm"]),
            source(rust.as_ref()),
        ]
    };
    apt::install_missing(needs, true)?;
    let folder = folder()?;
    System::make(&folder)?;
    Ok(folder)
}

/// Compiles the simulated Android host, and returns its launcher: `launcher APK SCRIPT ...`.
pub fn build_host() -> anyhow::Result<PathBuf> {
    let folder = folder()?;
    let system = System::make(&folder)?;
    let target = folder.join("build");
    let mut build = command(&system, Panic::Abort)?;
    build.args(["build", "--package=yoro-android-host", "--package=yoro-openxr-stub", "--target", TRIPLE]);
    build.env("CARGO_TARGET_DIR", &target).env("CARGO_PROFILE_DEV_PANIC", "abort");
    cargo::perform(&mut build, "the simulated Android host does not compile for arm64")?;
    let program = target.join(TRIPLE).join("debug/yoro-android-host");
    let launcher = folder.join("yoro-android-host");
    let words = system.arguments().map(|argument| quoted(Path::new(&argument)));
    let text = format!(
        "# The simulated Android host for arm64, in qemu's user mode.\nexec {} {} {} \"$@\"\n",
        quoted(&system.qemu),
        words.join(" "),
        quoted(&program)
    );
    write_launcher(&launcher, &text)?;
    Ok(launcher)
}

fn folder() -> anyhow::Result<PathBuf> {
    Ok(target_folder()?.join("android/arm64"))
}

/// A small Debian for arm64 in a folder, with qemu.
struct System {
    root: PathBuf,
    qemu: PathBuf,
}

impl System {
    /// Fetches and unpacks the system unless the folder is complete.
    fn make(folder: &Path) -> anyhow::Result<Self> {
        let root = folder.join("root");
        make_once(folder, &format!("{} {LIBSTDCXX} {}\n", PACKAGES.join(" "), QEMU.join(" ")), || {
            let apt = PrivateApt::new(folder.join("apt"), &["amd64", "arm64"], None)?;
            let libstdcxx = newest(&apt.names(LIBSTDCXX)?);
            let libstdcxx = libstdcxx.context("this distribution has no libstdc++-dev for the linker")?;
            let mut packages: Vec<String> = PACKAGES.iter().map(|name| format!("{name}:arm64")).collect();
            packages.extend([format!("{libstdcxx}:arm64"), "qemu-user-static:amd64".to_owned()]);
            apt.unpack(&packages, &root, &[])
        })?;
        let qemu = QEMU.map(|name| root.join(name)).into_iter().find(|program| program.is_file());
        Ok(Self { qemu: qemu.context("qemu is not where Debian's packages have it")?, root })
    }

    /// Returns qemu's arguments before a program's path. This machine's libraries cannot be used, nor its GPU: qemu does
    /// not support the system calls of graphics drivers.
    fn arguments(&self) -> [OsString; 6] {
        let fixed = ["-U", "LD_LIBRARY_PATH", "-E", "LIBGL_ALWAYS_SOFTWARE=1", "-L"].map(OsString::from);
        let [unset, path, set, software, from] = fixed;
        [unset, path, set, software, from, self.root.clone().into()]
    }
}

/// Returns the `libstdc++-N-dev` with the largest number among package names, one per line.
fn newest(names: &str) -> Option<String> {
    let number = |name: &str| name.strip_prefix(LIBSTDCXX)?.strip_suffix("-dev")?.parse::<u32>().ok();
    let newest = names.lines().filter_map(number).max()?;
    Some(format!("{LIBSTDCXX}{newest}-dev"))
}

/// Returns the command that runs a program for arm64 in qemu, with Mesa's rasterizer.
pub fn emulated(program: &Path) -> anyhow::Result<Command> {
    let system = System::make(&fetch()?)?;
    let mut command = Command::new(&system.qemu);
    command.args(system.arguments()).arg(program);
    Ok(command)
}

/// Returns a cargo that compiles and links for arm64 with `--target` [`TRIPLE`]. Fetches and installs what it needs.
/// Panics in its programs unwind.
pub fn cargo() -> anyhow::Result<Command> {
    command(&System::make(&fetch()?)?, Panic::Unwind)
}

fn command(system: &System, panic: Panic) -> anyhow::Result<Command> {
    let (rust, with_std) =
        Rust::for_target(TRIPLE).with_context(|| format!("no Rust can compile for {TRIPLE}"))?;
    let mut command = rust.cargo()?;
    if with_std {
        build_std(&mut command, panic);
    }
    let flags = [
        "-Clinker=clang".to_owned(),
        "-Clink-arg=--target=aarch64-linux-gnu".to_owned(),
        "-Clink-arg=-fuse-ld=lld".to_owned(),
        format!("-Clink-arg=--sysroot={}", system.root.display()),
    ];
    command.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    // For build scripts that compile C.
    let underscored = TRIPLE.replace('-', "_");
    let flags = format!("--target=aarch64-linux-gnu --sysroot={}", system.root.display());
    for (variable, value) in
        [("CC", "clang"), ("CXX", "clang++"), ("AR", "llvm-ar"), ("CFLAGS", &flags), ("CXXFLAGS", &flags)]
    {
        command.env(format!("{variable}_{underscored}"), value);
    }
    Ok(command)
}
