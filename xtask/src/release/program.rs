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
use crate::{arm64, notices, web};

/// The features of the program for arm64: without the server, which nobody runs on a headset.
const LEAN: [&str; 1] = ["--no-default-features"];

/// Makes the archive for this machine's processor, with the page that `yoro serve` shows.
///
/// # Errors
/// Fails if the program or the page does not compile.
pub fn native(folder: &Path) -> anyhow::Result<PathBuf> {
    let program = build(cargo(), &[], &target_folder()?.join("program"), "release")?;
    let pack = Pack { architecture: ARCH, features: &[], strip: "strip", page: Some(web::build_once()?) };
    pack.make(&program, &layer_linux::native_library()?, folder)
}

/// Makes the archive for arm64.
///
/// # Errors
/// Fails if the program does not compile, or what it takes cannot be had.
pub fn aarch64(folder: &Path) -> anyhow::Result<PathBuf> {
    let mut cargo = arm64::cargo()?;
    arm64::use_compilers(&mut cargo)?;
    let arguments = [&["--target", arm64::TRIPLE][..], &LEAN].concat();
    let target = target_folder()?.join("android/arm64/program");
    let program = build(cargo, &arguments, &target, &format!("{}/release", arm64::TRIPLE))?;
    let pack = Pack { architecture: "aarch64", features: &LEAN, strip: "llvm-strip", page: None };
    pack.make(&program, &layer_linux::aarch64_library()?, folder)
}

/// Builds the program into a target folder of its own, since its flags differ from those of all other builds.
fn build(mut cargo: Command, more: &[&str], target: &Path, profile: &str) -> anyhow::Result<PathBuf> {
    set_flags(&mut cargo);
    let arguments =
        [&["build", "--locked", "--release", "--package", "yoro-cli", "--bin", "yoro"], more].concat();
    announce(&arguments);
    let status = cargo.args(&arguments).env("CARGO_TARGET_DIR", target).status();
    if !status.context("cargo cannot be started")?.success() {
        bail!("the program does not compile: see above");
    }
    Ok(target.join(profile).join("yoro"))
}

/// What differs between the archives.
struct Pack<'a> {
    architecture: &'a str,
    features: &'a [&'a str],
    strip: &'a str,
    page: Option<PathBuf>,
}

impl Pack<'_> {
    /// Packs `yoro-VERSION-linux-ARCHITECTURE.tar.xz`, and returns its path.
    fn make(&self, program: &Path, layer: &Path, folder: &Path) -> anyhow::Result<PathBuf> {
        let name = format!("yoro-{VERSION}-linux-{}", self.architecture);
        let content = folder.join(&name);
        remove(&content)?;
        let yoro = content.join("bin/yoro");
        let library = content.join("lib").join(layer_linux::LIBRARY);
        copy(program, &yoro)?;
        copy(layer, &library)?;
        for file in [&yoro, &library] {
            run(Command::new(self.strip).arg(file))?;
        }
        let glibc = needed_glibc(&yoro)?.max(needed_glibc(&library)?);
        if let Some(page) = &self.page {
            copy_folder(page, &content.join("web"))?;
            // The source is published beside the archive.
            remove_file(&content.join("web/yoro-source.tar.gz"))?;
        }
        for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
            copy(&root().join(licence), &content.join(licence))?;
        }
        let target = format!("{}-unknown-linux-gnu", self.architecture);
        write(&content.join(notices::FILE), notices::text("yoro-cli", &target, self.features)?)?;
        write(&content.join("README.md"), readme(self.architecture, self.page.is_some(), glibc))?;
        let packed = tar(folder, &name)?;
        remove(&content)?;
        Ok(packed)
    }
}

fn readme(architecture: &str, serves: bool, (major, minor): (u32, u32)) -> String {
    let serve = match serves {
        true => {
            "bin/yoro serve street                                # any browser shows it; the address is printed\n"
        }
        false => "",
    };
    format!(
        "# yoro {VERSION} for Linux on {architecture}\n\
         \n\
         Needs glibc {major}.{minor} or newer, and EGL with OpenGL ES 3 from the distribution, with a GPU's driver or without:\n\
         \n\
         ```sh\n\
         apt-get install libegl1 libgles2 libgl1-mesa-dri       # Debian, Ubuntu\n\
         dnf install libglvnd-egl libglvnd-gles mesa-dri-drivers # Fedora\n\
         ```\n\
         \n\
         ```sh\n\
         bin/yoro render prototype --measure --out picture    # picture.left.png, and how close the made-up eye is\n\
         bin/yoro run                                         # all scenes, and a report\n\
         bin/yoro xr                                          # in a headset, by OpenXR\n\
         {serve}\
         bin/yoro --help\n\
         ```\n\
         \n\
         `lib` has the OpenXR API layer: `bin/yoro layer --help`.\n\
         \n\
         MIT or Apache 2.0, at your option; {} has the notices of others' code.\n",
        notices::FILE
    )
}

fn remove_file(path: &Path) -> anyhow::Result<()> {
    if path.exists() {
        std::fs::remove_file(path).with_context(|| format!("{} cannot be removed", path.display()))?;
    }
    Ok(())
}
