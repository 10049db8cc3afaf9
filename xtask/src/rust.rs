//! Rust for other targets than this machine, with rustup's std for them or with std compiled from source.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::Context as _;

use crate::apt::{Need, find_program};
use crate::folders::root;

/// A cargo and its rustc.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rust {
    /// The folder of both programs.
    programs: PathBuf,
    sysroot: PathBuf,
    /// Major and minor version.
    version: (u32, u32),
}

/// What a panic does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Panic {
    /// Ends the process.
    Abort,
    /// Unwinds, so that it can be caught.
    Unwind,
}

impl Rust {
    /// Returns the user's own Rust.
    pub fn own() -> Option<Self> {
        // Cargo sets this variable for the programs that it runs; behind rustup's proxy, it names the real cargo.
        let cargo = env::var_os("CARGO").map(PathBuf::from).or_else(|| find_program("cargo"))?;
        Self::at(cargo.parent()?.to_owned())
    }

    fn at(programs: PathBuf) -> Option<Self> {
        if !programs.join("cargo").is_file() {
            return None;
        }
        let ask = |arguments: &[&str]| {
            let output = Command::new(programs.join("rustc")).args(arguments).output().ok()?;
            output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        let version = version(&ask(&["--version"])?)?;
        let sysroot = PathBuf::from(ask(&["--print", "sysroot"])?);
        Some(Self { programs, sysroot, version })
    }

    /// Returns a Rust that can compile std: the user's own if it has std's source, or else Debian's.
    pub fn with_source() -> Option<Self> {
        let fits = |rust: &Self| rust.is_new_enough() && rust.has_source();
        Self::own().filter(fits).or_else(|| Self::at("/usr/bin".into()).filter(fits))
    }

    /// Returns a Rust that can compile for `triple`, and whether it has to compile std as well.
    pub fn for_target(triple: &str) -> Option<(Self, bool)> {
        let prebuilt = Self::own().filter(|rust| rust.has_target(triple)).map(|rust| (rust, false));
        prebuilt.or_else(|| Some((Self::with_source()?, true)))
    }

    /// True if it has std for `triple`.
    pub fn has_target(&self, triple: &str) -> bool {
        self.sysroot.join("lib/rustlib").join(triple).join("lib").is_dir()
    }

    fn has_source(&self) -> bool {
        self.sysroot.join("lib/rustlib/src/rust/library/std/Cargo.toml").is_file()
    }

    fn is_new_enough(&self) -> bool {
        version(env!("CARGO_PKG_RUST_VERSION")).is_some_and(|minimum| self.version >= minimum)
    }

    /// Returns LLVM's linker for WebAssembly: of this Rust or the user's, or else the system's. Debian's Rust has none.
    pub fn wasm_linker(&self) -> Option<PathBuf> {
        let own = self.rust_lld().or_else(|| Self::own()?.rust_lld());
        own.or_else(|| find_program("wasm-ld"))
    }

    fn rust_lld(&self) -> Option<PathBuf> {
        let hosts = fs::read_dir(self.sysroot.join("lib/rustlib")).ok()?;
        hosts.flatten().map(|host| host.path().join("bin/rust-lld")).find(|file| file.is_file())
    }

    /// Returns its cargo, in the workspace's root and without RUSTFLAGS, which are for this machine's processor.
    pub fn cargo(&self) -> anyhow::Result<Command> {
        let mut command = Command::new(self.programs.join("cargo"));
        command.current_dir(root()).env_remove("RUSTFLAGS");
        self.use_in(&mut command)?;
        Ok(command)
    }

    /// Makes a command use this Rust, by PATH: cargo's subcommands run the first cargo there. Removes the variables
    /// that the cargo of this program has set.
    pub fn use_in(&self, command: &mut Command) -> anyhow::Result<()> {
        let mut path = OsString::from(&self.programs);
        if let Some(rest) = env::var_os("PATH") {
            path = env::join_paths([self.programs.clone()].into_iter().chain(env::split_paths(&rest)))
                .context("PATH holds a folder with a colon in its name")?;
        }
        command.env("PATH", path).env("RUSTC", self.programs.join("rustc"));
        for variable in ["CARGO", "RUSTDOC", "RUSTUP_TOOLCHAIN", "LD_LIBRARY_PATH"] {
            command.env_remove(variable);
        }
        Ok(())
    }
}

/// Makes cargo compile std from its source, without backtraces, which would have no symbols to show.
pub fn build_std(command: &mut Command, panic: Panic) {
    let (crates, features) = match panic {
        Panic::Abort => ("std,panic_abort", ""),
        Panic::Unwind => ("std", "panic-unwind"),
    };
    command
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_UNSTABLE_BUILD_STD", crates)
        .env("CARGO_UNSTABLE_BUILD_STD_FEATURES", features);
}

/// Returns the rustc flag that removes the builder's private folders from the source file names in panic messages.
pub fn anonymous_paths() -> Option<String> {
    let cargo_home = env::var_os("CARGO_HOME")
        .map(PathBuf::from)
        .or_else(|| env::home_dir().map(|home| home.join(".cargo")));
    cargo_home.map(|home| format!("--remap-path-prefix={}=cargo", home.display()))
}

/// Returns the requirement of std's source, which `rust` must have.
pub fn source(rust: Option<&Rust>) -> Need {
    let minimum = env!("CARGO_PKG_RUST_VERSION");
    let found = rust.map(|rust| {
        let (major, minor) = rust.version;
        format!("{} ({major}.{minor})", rust.programs.join("rustc").display())
    });
    Need {
        what: "std's source",
        found: found.ok_or_else(|| format!("no Rust since {minimum} has it")),
        remedy: "apt-get install rustc-web cargo-web rust-web-src (Debian 12 with its security updates), \
                 or rustup component add rust-src"
            .to_owned(),
        packages: &["rustc-web", "cargo-web", "rust-web-src"],
    }
}

/// Parses the version `1.96` in `rustc 1.96.0 (ac68faa20 2026-05-25)`.
fn version(text: &str) -> Option<(u32, u32)> {
    let number = text.split_whitespace().find(|word| word.starts_with(|c: char| c.is_ascii_digit()))?;
    let mut parts = number.split('.');
    Some((parts.next()?.parse().ok()?, parts.next()?.parse().ok()?))
}
