//! Packages for others' builds: the C library for Linux and Android, the OpenXR layer, the Godot add-on, the package for
//! three.js.

mod android;
mod godot;
pub mod layer;
pub mod linux;
pub mod portable;
pub mod texts;
mod three;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};
use clap::ValueEnum;

use crate::android::check;
use crate::apt::{self, Need};
use crate::folders::{copy, make, remove, root, target_folder};

use linux::Machine;

pub use layer::aar_for_tests as layer_for_tests;

/// The version of all packages.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The target of a package.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// Linux on this machine's processor, an archive
    Linux,
    /// Linux on arm64, an archive
    LinuxAarch64,
    /// Android on arm64 and x86_64, an AAR with prefab
    Android,
    /// The OpenXR API layer for Android on arm64 and x86_64, an AAR
    AndroidLayer,
    /// The OpenXR API layer for Linux on this machine's processor, an archive
    LayerLinux,
    /// The OpenXR API layer for Linux on arm64, an archive
    LayerLinuxAarch64,
    /// The add-on for Godot, a zip
    Godot,
    /// The package for three.js, a tarball of npm's
    Three,
}

/// Makes these packages, or all if none is given, and returns their paths.
pub fn package(targets: &[Target]) -> anyhow::Result<Vec<PathBuf>> {
    let targets = if targets.is_empty() { Target::value_variants() } else { targets };
    let folder = target_folder()?.join("package");
    make(&folder)?;
    let pack = |target: &Target| match target {
        Target::Linux => linux::library(Machine::Native, &folder),
        Target::LinuxAarch64 => linux::library(Machine::Arm64, &folder),
        Target::Android => android::aar(&folder),
        Target::AndroidLayer => layer::aar(&folder),
        Target::LayerLinux => layer::archive(Machine::Native, &folder),
        Target::LayerLinuxAarch64 => layer::archive(Machine::Arm64, &folder),
        Target::Godot => godot::zip(&folder),
        Target::Three => three::tarball(&folder),
    };
    targets.iter().map(pack).collect()
}

/// Installs the tools by which people take the package for Linux into their programs.
pub fn fetch_users_tools() -> anyhow::Result<PathBuf> {
    let needs = || {
        let tools: [(_, &[_]); 5] = [
            ("cc", &["gcc"]),
            ("xz", &["xz-utils"]),
            ("pkg-config", &["pkg-config"]),
            ("cmake", &["cmake"]),
            ("make", &["make"]),
        ];
        tools.map(|(name, packages)| Need::program(name, packages)).to_vec()
    };
    apt::install_missing(needs, true)?;
    Ok(PathBuf::new())
}

/// Packs the files of a folder as a zip, removes the folder, and returns the zip's path.
pub fn zip(content: &Path, packed: PathBuf) -> anyhow::Result<PathBuf> {
    check::pack(&packed, content)?;
    remove(content)?;
    println!("{}", packed.display());
    Ok(packed)
}

/// Copies yoro's own licences into a folder.
pub fn copy_licences(folder: &Path) -> anyhow::Result<()> {
    ["LICENSE-APACHE", "LICENSE-MIT"].iter().try_for_each(|name| copy(&root().join(name), &folder.join(name)))
}

/// A library built by cargo.
struct Built {
    shared: PathBuf,
    archive: PathBuf,
    /// The linker arguments that the static library needs, such as `-lm`.
    needs: Vec<String>,
}

/// Builds a package's library with `cargo`, and returns its files and linker arguments. Links `objects` into it.
/// `folder` is cargo's output folder for this target.
fn compile(
    mut cargo: Command,
    package: &str,
    crate_types: &str,
    target: Option<&str>,
    soname: &str,
    objects: &[&Path],
    folder: &Path,
) -> anyhow::Result<(PathBuf, String)> {
    cargo.args(["rustc", "--package", package, "--lib", "--profile", "capi"]);
    cargo.args(["--crate-type", crate_types]).args(target.iter().flat_map(|target| ["--target", target]));
    cargo.args(["--", "--print", "native-static-libs", &format!("-Clink-arg=-Wl,-soname,{soname}")]);
    cargo.args(objects.iter().map(|object| format!("-Clink-arg={}", object.display())));
    cargo.current_dir(root()).env("CARGO_TARGET_DIR", folder);
    eprintln!(
        "$ cargo {}",
        cargo.get_args().map(|argument| argument.to_string_lossy()).collect::<Vec<_>>().join(" ")
    );
    let output =
        cargo.stdin(Stdio::null()).stdout(Stdio::inherit()).output().context("cargo cannot be started")?;
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    eprint!("{told}");
    if !output.status.success() {
        bail!("{package} does not compile: see above");
    }
    Ok((target.map_or(folder.to_owned(), |target| folder.join(target)).join("capi"), told))
}

/// Builds the C library with `cargo`.
fn build(
    cargo: Command,
    target: Option<&str>,
    soname: &str,
    objects: &[&Path],
    folder: &Path,
) -> anyhow::Result<Built> {
    let (built, told) = compile(cargo, "yoro-c", "cdylib,staticlib", target, soname, objects, folder)?;
    let needs = needs(&told).context("rustc does not say what the archive needs")?;
    let shared = built.join("libyoro_c.so");
    let size = fs::metadata(&shared).with_context(|| format!("{} is missing", shared.display()))?.len();
    println!("{}: {size} bytes", shared.display());
    Ok(Built { shared, archive: built.join("libyoro_c.a"), needs })
}

/// Parses rustc's note about the libraries that a static library needs, without duplicates.
fn needs(output: &str) -> Option<Vec<String>> {
    let line = output.lines().find_map(|line| line.trim().strip_prefix("note: native-static-libs:"))?;
    let mut needs: Vec<String> = Vec::new();
    for library in line.split_whitespace() {
        if !needs.iter().any(|known| known == library) {
            needs.push(library.to_owned());
        }
    }
    Some(needs)
}
