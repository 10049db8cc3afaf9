//! A cargo for libraries that others include in their Android applications.

use std::process::Command;

use anyhow::Context as _;

use crate::folders::target_folder;
use crate::ndk::stand_in::{StandIn, make_libraries, make_unwinder};
use crate::ndk::target::Architecture;
use crate::rust::{Panic, Rust, build_std};

use super::build::link_flags;
use super::toolchain::{self, Toolchain};

/// The API level of the oldest Android that the libraries support (Android 11). It is the first whose C library can
/// unwind; the stand-in NDK has no unwinder.
pub const API: u32 = 30;

/// Returns a cargo that compiles and links for Android with the architecture's triple. The result can unwind.
pub fn cargo(architecture: Architecture) -> anyhow::Result<Command> {
    let (toolchain, _) = Toolchain::choose();
    toolchain::ensure(&toolchain, true)?;
    let mut flags = link_flags();
    flags.push(format!("-Clink-arg=--target={}{API}", architecture.triple));
    let rust = match &toolchain {
        Toolchain::Google { ndk, .. } => {
            let clang = ndk.join("toolchains/llvm/prebuilt/linux-x86_64/bin/clang");
            flags.push(format!("-Clinker={}", clang.display()));
            Rust::own()
        }
        Toolchain::StandIn => {
            let stand_in = StandIn::make(&target_folder()?.join("android/stand-in"))?;
            // Separate from the application's sysroot, which is for an older Android.
            let folder = target_folder()?.join("android/capi/sysroot");
            let libraries = folder.join("usr/lib");
            make_libraries(&libraries, architecture, API)?;
            make_unwinder(&libraries, architecture, "")?;
            flags.push(format!("-Clinker={}", stand_in.clang().display()));
            flags.push("-Clink-arg=-fuse-ld=lld".to_owned());
            flags.push(format!("-Clink-arg=--sysroot={}", folder.display()));
            Rust::with_source()
        }
    };
    let rust = rust.context("no Rust can be found: put cargo and rustc into PATH")?;
    let mut command = rust.cargo()?;
    if toolchain == Toolchain::StandIn {
        build_std(&mut command, Panic::Unwind);
    }
    command.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    Ok(command)
}
