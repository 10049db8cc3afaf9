//! An archive for Linux: header, libraries, files for pkg-config and CMake, examples.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use super::texts::{cmake, cmake_version, pkg_config, soname};
use super::{Built, VERSION, build, copy, write};
use crate::android::{ARM64_TRIPLE, arm64_cargo};
use crate::cargo::cargo;
use crate::folders::{root, target_folder};

/// For this machine.
pub fn native(folder: &Path) -> anyhow::Result<PathBuf> {
    let built = build(cargo(), None, &soname(), &target_folder()?)?;
    archive(&built, std::env::consts::ARCH, "strip", folder)
}

/// For arm64, by this machine's clang and Debian's libraries for arm64.
pub fn aarch64(folder: &Path) -> anyhow::Result<PathBuf> {
    let cargo = arm64_cargo()?;
    let built = build(cargo, Some(ARM64_TRIPLE), &soname(), &target_folder()?.join("android/arm64/capi"))?;
    archive(&built, "aarch64", "llvm-strip", folder)
}

/// Packs `yoro-VERSION-linux-ARCHITECTURE.tar.xz`; the file.
fn archive(built: &Built, architecture: &str, strip: &str, folder: &Path) -> anyhow::Result<PathBuf> {
    let name = format!("yoro-{VERSION}-linux-{architecture}");
    let content = folder.join(&name);
    if content.exists() {
        fs::remove_dir_all(&content).with_context(|| format!("{} cannot be removed", content.display()))?;
    }
    let package = root().join("app/capi");
    copy(&package.join("include/yoro.h"), &content.join("include/yoro.h"))?;
    let library = content.join("lib");
    let file = format!("libyoro.so.{VERSION}");
    copy(&built.shared, &library.join(&file))?;
    for link in [soname().as_str(), "libyoro.so"] {
        symlink(&file, library.join(link)).with_context(|| format!("{link} cannot be made"))?;
    }
    copy(&built.archive, &library.join("libyoro.a"))?;
    run(Command::new(strip).arg("--strip-debug").arg(library.join("libyoro.a")))?;
    write(&library.join("pkgconfig/yoro.pc"), &pkg_config(&built.needs))?;
    write(&library.join("cmake/yoro/yoro-config.cmake"), &cmake(&built.needs))?;
    write(&library.join("cmake/yoro/yoro-config-version.cmake"), &cmake_version())?;
    let examples = package.join("examples");
    for entry in fs::read_dir(&examples).context("app/capi/examples cannot be read")? {
        let name = entry.context("app/capi/examples cannot be read")?.file_name();
        copy(&examples.join(&name), &content.join("share/yoro/examples").join(&name))?;
    }
    for document in ["LICENSE-APACHE", "LICENSE-MIT", "docs/library.md"] {
        let name = Path::new(document).file_name().unwrap_or_default();
        copy(&root().join(document), &content.join("share/doc/yoro").join(name))?;
    }
    let packed = folder.join(format!("{name}.tar.xz"));
    let unfinished = folder.join(format!("{name}.tar.xz.tmp"));
    let mut tar = Command::new("tar");
    // The same files make the same archive.
    tar.args(["--create", "--xz", "--sort=name", "--owner=0", "--group=0", "--numeric-owner"]);
    tar.args(["--mtime=@0", "--file"]).arg(&unfinished).arg("--directory").arg(folder).arg(&name);
    run(&mut tar)?;
    fs::rename(&unfinished, &packed).with_context(|| format!("{} cannot be written", packed.display()))?;
    println!("{}", packed.display());
    Ok(packed)
}

fn run(command: &mut Command) -> anyhow::Result<()> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("{program} cannot be started: install it"))?;
    if !output.status.success() {
        bail!("{program} failed: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(())
}
