//! Archives for Linux: what all have in common, and that of the C library with header, libraries, files for pkg-config and
//! CMake, examples.

use std::env::consts::ARCH;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Context as _;

use crate::console::run;
use crate::folders::{copy, copy_folder, read_text, remove, root, target_folder, write};
use crate::{arm64, cargo, notices};

use super::portable::{self, OLDEST_GLIBC};
use super::texts::{cmake, cmake_version, manual, pkg_config, readme, soname, with_links};
use super::{VERSION, build, copy_licences};

/// The first page of the C library's archive.
const README: &str = include_str!("templates/README.library.txt");

/// A kind of machine that archives are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Machine {
    /// This machine's processor.
    Native,
    /// arm64, by this machine's clang and Debian's arm64 libraries.
    Arm64,
}

impl Machine {
    /// Returns the architecture's name.
    pub fn architecture(self) -> &'static str {
        if self == Self::Native { ARCH } else { "aarch64" }
    }

    /// Returns the target to be named to cargo.
    pub fn target(self) -> Option<&'static str> {
        (self == Self::Arm64).then_some(arm64::TRIPLE)
    }

    /// Returns cargo, whose output does not contain the builder's folders.
    pub fn cargo(self) -> anyhow::Result<Command> {
        let mut cargo = if self == Self::Native { cargo::cargo() } else { arm64::cargo()? };
        portable::set_flags(&mut cargo);
        Ok(cargo)
    }

    /// Returns cargo's output folder.
    pub fn folder(self) -> anyhow::Result<PathBuf> {
        let target = target_folder()?;
        Ok(if self == Self::Native { target } else { target.join("android/arm64/capi") })
    }

    /// Removes symbols from a file.
    pub fn strip(self, arguments: &[&str], file: &Path) -> anyhow::Result<()> {
        let strip = if self == Self::Native { "strip" } else { "llvm-strip" };
        run(Command::new(strip).args(arguments).arg(file)).map(drop)
    }

    /// Packs `NAME-VERSION-linux-ARCHITECTURE.tar.xz` in `folder`, and returns its path. `fill` writes the files, and returns
    /// the README. The licences, and the notices of what `package` contains, are written to `documents` in the archive.
    pub fn pack(
        self,
        folder: &Path,
        name: &str,
        package: &str,
        documents: &str,
        fill: impl FnOnce(&Path) -> anyhow::Result<String>,
    ) -> anyhow::Result<PathBuf> {
        let architecture = self.architecture();
        let name = format!("{name}-{VERSION}-linux-{architecture}");
        let content = folder.join(&name);
        remove(&content)?;
        let readme = fill(&content)?;
        write(&content.join("README.md"), readme)?;
        let documents = content.join(documents);
        copy_licences(&documents)?;
        let notices = notices::text(package, &format!("{architecture}-unknown-linux-gnu"), &[])?;
        write(&documents.join(notices::FILE), notices)?;
        let packed = tar(folder, &name)?;
        remove(&content)?;
        Ok(packed)
    }
}

/// Packs the C library, and returns the archive's path.
pub fn library(machine: Machine, folder: &Path) -> anyhow::Result<PathBuf> {
    let output = machine.folder()?;
    let mut compiler = Command::new(if machine == Machine::Native { "cc" } else { "clang" });
    if machine == Machine::Arm64 {
        compiler.arg("--target=aarch64-linux-gnu");
    }
    let old_functions = portable::old_functions(&mut compiler, &output)?;
    let built = build(machine.cargo()?, machine.target(), &soname(), &[&old_functions], &output)?;
    portable::check(&built.shared)?;
    machine.pack(folder, "libyoro", "yoro-c", "share/doc/yoro", |content| {
        let package = root().join("app/engines/c");
        copy(&package.join("include/yoro.h"), &content.join("include/yoro.h"))?;
        for folder in ["examples", "csharp"] {
            copy_folder(&package.join(folder), &content.join("share/yoro").join(folder))?;
        }
        let library = content.join("lib");
        let file = format!("libyoro.so.{VERSION}");
        copy(&built.shared, &library.join(&file))?;
        for link in [soname().as_str(), "libyoro.so"] {
            symlink(&file, library.join(link)).with_context(|| format!("{link} cannot be made"))?;
        }
        let archive = library.join("libyoro.a");
        copy(&built.archive, &archive)?;
        machine.strip(&["--strip-debug"], &archive)?;
        portable::check(&archive)?;
        write(&library.join("pkgconfig/yoro.pc"), pkg_config(&built.needs))?;
        write(&library.join("cmake/yoro/yoro-config.cmake"), cmake(&built.needs))?;
        write(&library.join("cmake/yoro/yoro-config-version.cmake"), cmake_version())?;
        let documents = content.join("share/doc/yoro");
        let picture = "integration-mistakes.png";
        copy(&root().join("docs/pictures").join(picture), &documents.join(picture))?;
        let guide = read_text(&root().join("docs/engines.md"))?;
        write(&documents.join("guide.md"), with_links(&manual(&guide), packaged))?;
        Ok(readme(README, machine.architecture(), OLDEST_GLIBC))
    })
}

/// Packs a folder in `folder` as `NAME.tar.xz` beside it, and returns its path.
pub fn tar(folder: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let packed = folder.join(format!("{name}.tar.xz"));
    let unfinished = folder.join(format!("{name}.tar.xz.tmp"));
    let mut tar = Command::new("tar");
    // These options make the archive depend only on the files, and not on the builder's umask.
    tar.args(["--create", "--xz", "--sort=name", "--owner=0", "--group=0", "--numeric-owner"]);
    tar.args(["--mode=u+rwX,go=rX", "--mtime=@0", "--file"]).arg(&unfinished);
    tar.arg("--directory").arg(folder).arg(name);
    run(&mut tar)?;
    fs::rename(&unfinished, &packed).with_context(|| format!("{} cannot be written", packed.display()))?;
    println!("{}", packed.display());
    Ok(packed)
}

/// Returns the path in the package for the target of a link in docs/engines.md, or `None` if it is not packed.
fn packaged(target: &str) -> Option<String> {
    let example =
        target.strip_prefix("../app/engines/c/examples/").map(|file| format!("../../yoro/examples/{file}"));
    match target {
        "../app/engines/c/include/yoro.h" => Some("../../../include/yoro.h".into()),
        "pictures/integration-mistakes.png" => Some("integration-mistakes.png".into()),
        "../app/engines/c/csharp" => Some("../../yoro/csharp".into()),
        _ => example.or_else(|| target.starts_with('#').then(|| target.to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_page_has_a_line_for_each_sample() {
        let page = readme(README, "x86_64", (2, 28));
        let files = fs::read_dir(root().join("app/engines/c/examples")).unwrap();
        let names = files.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
        let samples: Vec<String> = names.filter(|name| name.ends_with(".c")).collect();
        assert!(samples.len() >= 2);
        for sample in samples {
            assert!(page.contains(&format!("\ncc share/yoro/examples/{sample} ")), "{sample}");
        }
        assert!(page.contains("glibc 2.28"));
    }

    #[test]
    fn the_same_files_give_the_same_archive() {
        let pack = |names: [&str; 2]| {
            let folder = tempfile::tempdir().unwrap();
            for name in names {
                write(&folder.path().join("packed").join(name), name).unwrap();
            }
            fs::read(tar(folder.path(), "packed").unwrap()).unwrap()
        };
        assert!(pack(["lib/a", "b"]) == pack(["b", "lib/a"]));
    }

    #[test]
    fn every_link_of_the_packages_document_leads_into_the_package() {
        let text = fs::read_to_string(root().join("docs/engines.md")).unwrap();
        let mut kept = Vec::new();
        let text = manual(&text);
        let packed = with_links(&text, |target| packaged(target).inspect(|to| kept.push(to.clone())));
        let links = packed.matches("](").count();
        let headings: Vec<&str> = text.lines().filter(|line| line.starts_with("## ")).collect();
        let anchor =
            |heading: &str| heading[3..].to_lowercase().replace(' ', "-").replace(['(', ')', ','], "");
        for inside in kept.iter().filter_map(|target| target.strip_prefix('#')) {
            assert!(headings.iter().any(|heading| anchor(heading) == inside), "no chapter #{inside}");
        }
        assert_eq!(links, kept.len());
        let here = |file: &str| root().join(file).exists();
        for target in kept.iter().filter(|target| !target.starts_with('#')) {
            let from = target
                .replace("../../../include/", "app/engines/c/include/")
                .replace("../../yoro/", "app/engines/c/");
            assert!(here(&from) || here(&format!("docs/pictures/{target}")), "{target}");
        }
        assert!(kept.iter().any(|target| target.ends_with("vulkan.c")));
        assert!(kept.iter().any(|target| target == "integration-mistakes.png"));
    }
}
