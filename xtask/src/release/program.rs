//! The program for Linux: an archive that runs where no Rust is.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::console::run;
use crate::folders::{copy, copy_folder, target_folder};
use crate::package::layer;
use crate::package::linux::Machine;
use crate::package::portable::needed_glibc;
use crate::package::texts::readme;
use crate::{arm64, cargo, setup, web};

/// Makes `yoro-VERSION-linux-ARCHITECTURE.tar.xz` with the page that `yoro serve` shows, and returns its path.
pub fn archive(machine: Machine, folder: &Path) -> anyhow::Result<PathBuf> {
    setup::ensure()?;
    // A target folder of its own, since its flags differ from those of all other builds.
    let output = target_folder()?.join("program");
    let mut arguments = vec!["build", "--locked", "--release", "--package", "yoro-cli", "--bin", "yoro"];
    arguments.extend(machine.target().iter().flat_map(|target| ["--target", target]));
    let mut build = machine.cargo()?;
    cargo::perform(build.args(arguments).env("CARGO_TARGET_DIR", &output), "the program does not compile")?;
    let built = machine.target().map_or(output.clone(), |target| output.join(target)).join("release/yoro");
    let mut yoro = match machine {
        Machine::Native => Command::new(&built),
        Machine::Arm64 => arm64::emulated(&built)?,
    };
    // With one sample a pixel: Mesa 22's rasterizer for arm64 crashes in qemu with four.
    run(yoro
        .args(["render", "prototype", "--size", "64x64", "--msaa", "1", "--out"])
        .arg(output.join("picture")))?;
    let layer = layer::library(machine)?;
    machine.pack(folder, "yoro", "yoro-cli", "", |content| {
        let yoro = content.join("bin/yoro");
        let library = content.join("lib").join(layer::LIBRARY);
        copy(&built, &yoro)?;
        copy(&layer, &library)?;
        for file in [&yoro, &library] {
            machine.strip(&[], file)?;
        }
        copy_folder(&web::build_once()?, &content.join("web"))?;
        let template = include_str!("../package/templates/README.program.txt");
        Ok(readme(template, machine.architecture(), needed_glibc(&yoro)?.max(needed_glibc(&library)?)))
    })
}
