//! The program for Linux: an archive that runs where no Rust is.

use std::env::consts::ARCH;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::cargo::{announce, cargo};
use crate::folders::{copy, copy_folder, remove, root, target_folder, write};
use crate::package::VERSION;
use crate::package::layer_linux;
use crate::package::linux::{run, tar};
use crate::package::portable::{needed_glibc, set_flags};
use crate::{arm64, notices, setup, web};

/// Makes `yoro-VERSION-linux-ARCHITECTURE.tar.xz` for this machine's processor, with the page that `yoro serve` shows, and
/// returns its path.
///
/// # Errors
/// Fails if the program, the layer or the page does not compile, or the program renders nothing.
pub fn native(folder: &Path) -> anyhow::Result<PathBuf> {
    setup::ensure()?;
    let program = build(cargo(), None)?;
    try_out(Command::new(&program))?;
    pack(folder, ARCH, "strip", &program, &layer_linux::native_library()?)
}

/// Makes the archive for arm64.
///
/// # Errors
/// Fails as [`native`] does; the program renders in qemu.
pub fn aarch64(folder: &Path) -> anyhow::Result<PathBuf> {
    let program = build(arm64::cargo()?, Some(arm64::TRIPLE))?;
    try_out(arm64::emulated(&program)?)?;
    pack(folder, "aarch64", "llvm-strip", &program, &layer_linux::aarch64_library()?)
}

/// Builds the program into a target folder of its own, since its flags differ from those of all other builds.
fn build(mut cargo: Command, target: Option<&str>) -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("program");
    set_flags(&mut cargo);
    let mut arguments = vec!["build", "--locked", "--release", "--package", "yoro-cli", "--bin", "yoro"];
    arguments.extend(target.iter().flat_map(|target| ["--target", target]));
    announce(&arguments);
    let status = cargo.args(arguments).env("CARGO_TARGET_DIR", &folder).status();
    if !status.context("cargo cannot be started")?.success() {
        bail!("the program does not compile: see above");
    }
    Ok(target.map_or(folder.clone(), |target| folder.join(target)).join("release/yoro"))
}

/// Renders a scene with the program. With one sample a pixel: Mesa 22's rasterizer for arm64 crashes in qemu with four.
fn try_out(mut yoro: Command) -> anyhow::Result<()> {
    let out = target_folder()?.join("program/picture");
    run(yoro.args(["render", "prototype", "--size", "64x64", "--msaa", "1", "--out"]).arg(&out))
}

fn pack(
    folder: &Path,
    architecture: &str,
    strip: &str,
    program: &Path,
    layer: &Path,
) -> anyhow::Result<PathBuf> {
    let name = format!("yoro-{VERSION}-linux-{architecture}");
    let content = folder.join(&name);
    remove(&content)?;
    let yoro = content.join("bin/yoro");
    let library = content.join("lib").join(layer_linux::LIBRARY);
    copy(program, &yoro)?;
    copy(layer, &library)?;
    for file in [&yoro, &library] {
        run(Command::new(strip).arg(file))?;
    }
    let glibc = needed_glibc(&yoro)?.max(needed_glibc(&library)?);
    copy_folder(&web::build_once()?, &content.join("web"))?;
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        copy(&root().join(licence), &content.join(licence))?;
    }
    let target = format!("{architecture}-unknown-linux-gnu");
    write(&content.join(notices::FILE), notices::text("yoro-cli", &target, &[])?)?;
    write(&content.join("README.md"), readme(architecture, glibc))?;
    let packed = tar(folder, &name)?;
    remove(&content)?;
    Ok(packed)
}

fn readme(architecture: &str, (major, minor): (u32, u32)) -> String {
    format!(
        "# yoro {VERSION} for Linux on {architecture}\n\
         \n\
         Needs glibc {major}.{minor} or newer, and EGL with OpenGL ES 3 from the distribution, with a GPU's driver or without:\n\
         \n\
         ```sh\n\
         apt-get install libegl1 libgl1-mesa-dri       # Debian, Ubuntu\n\
         dnf install libglvnd-egl mesa-dri-drivers     # Fedora, not tried\n\
         ```\n\
         \n\
         ```sh\n\
         bin/yoro render prototype --measure --out picture    # picture.left.png, and how close the made-up eye is\n\
         bin/yoro run                                         # all scenes, and a report\n\
         bin/yoro xr                                          # in a headset, by OpenXR\n\
         bin/yoro serve street                                # any browser shows it; the address is printed\n\
         bin/yoro --help\n\
         ```\n\
         \n\
         `lib` has the OpenXR API layer: `bin/yoro layer --help`.\n\
         \n\
         MIT or Apache 2.0, at your option; {} has the notices of others' code.\n",
        notices::FILE
    )
}
