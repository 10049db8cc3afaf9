//! An archive for Linux: header, libraries, files for pkg-config and CMake, examples.

use std::env::consts::ARCH;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::arm64;
use crate::cargo::cargo;
use crate::folders::{copy, remove, root, target_folder, write};
use crate::notices;

use super::portable::{self, OLDEST_GLIBC};
use super::texts::{cmake, cmake_version, manual, pkg_config, readme, soname, with_links};
use super::{Built, VERSION, build};

/// Makes the package for this machine.
pub fn native(folder: &Path) -> anyhow::Result<PathBuf> {
    let target = target_folder()?;
    let built = portable(cargo(), None, portable::native_compiler(), &target)?;
    archive(&built, ARCH, "strip", folder)
}

/// Makes the package for arm64, with this machine's clang and Debian's arm64 libraries.
pub fn aarch64(folder: &Path) -> anyhow::Result<PathBuf> {
    let mut compiler = Command::new("clang");
    compiler.arg("--target=aarch64-linux-gnu");
    let target = target_folder()?.join("android/arm64/capi");
    let built = portable(arm64::cargo()?, Some(arm64::TRIPLE), compiler, &target)?;
    archive(&built, "aarch64", "llvm-strip", folder)
}

/// Builds the library so that it runs on old systems and does not contain the builder's folders.
fn portable(
    mut cargo: Command,
    target: Option<&str>,
    mut compiler: Command,
    folder: &Path,
) -> anyhow::Result<Built> {
    portable::set_flags(&mut cargo);
    let old_functions = portable::old_functions(&mut compiler, folder)?;
    let built = build(cargo, target, &soname(), &[&old_functions], folder)?;
    portable::check(&built.shared)?;
    Ok(built)
}

/// Packs `libyoro-VERSION-linux-ARCHITECTURE.tar.xz`, and returns its path.
fn archive(built: &Built, architecture: &str, strip: &str, folder: &Path) -> anyhow::Result<PathBuf> {
    let name = format!("libyoro-{VERSION}-linux-{architecture}");
    let content = folder.join(&name);
    remove(&content)?;
    let package = root().join("app/engines/c");
    copy(&package.join("include/yoro.h"), &content.join("include/yoro.h"))?;
    let library = content.join("lib");
    let file = format!("libyoro.so.{VERSION}");
    copy(&built.shared, &library.join(&file))?;
    for link in [soname().as_str(), "libyoro.so"] {
        symlink(&file, library.join(link)).with_context(|| format!("{link} cannot be made"))?;
    }
    copy(&built.archive, &library.join("libyoro.a"))?;
    run(Command::new(strip).arg("--strip-debug").arg(library.join("libyoro.a")))?;
    portable::check(&library.join("libyoro.a"))?;
    write(&library.join("pkgconfig/yoro.pc"), pkg_config(&built.needs))?;
    write(&library.join("cmake/yoro/yoro-config.cmake"), cmake(&built.needs))?;
    write(&library.join("cmake/yoro/yoro-config-version.cmake"), cmake_version())?;
    let examples = package.join("examples");
    for entry in fs::read_dir(&examples).context("app/engines/c/examples cannot be read")? {
        let name = entry.context("app/engines/c/examples cannot be read")?.file_name();
        copy(&examples.join(&name), &content.join("share/yoro/examples").join(&name))?;
    }
    let documents = content.join("share/doc/yoro");
    for document in ["LICENSE-APACHE", "LICENSE-MIT", "docs/pictures/integration-mistakes.png"] {
        let name = Path::new(document).file_name().unwrap_or_default();
        copy(&root().join(document), &documents.join(name))?;
    }
    let notices = notices::text("yoro-c", &format!("{architecture}-unknown-linux-gnu"), &[])?;
    write(&documents.join(notices::FILE), notices)?;
    let guide = root().join("docs/engines.md");
    let text = fs::read_to_string(&guide).with_context(|| format!("{} cannot be read", guide.display()))?;
    write(&documents.join("guide.md"), with_links(&manual(&text), packaged))?;
    write(&content.join("README.md"), readme(architecture, OLDEST_GLIBC))?;
    tar(folder, &name)
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
        _ => example.or_else(|| target.starts_with('#').then(|| target.to_owned())),
    }
}

/// Runs a program whose output nobody reads.
pub fn run(command: &mut Command) -> anyhow::Result<()> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("{program} cannot be started: install it"))?;
    if !output.status.success() {
        bail!("{program} failed: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_page_has_a_line_for_each_sample() {
        let page = readme("x86_64", (2, 28));
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
        let here = |file: &str| root().join(file).is_file();
        for target in kept.iter().filter(|target| !target.starts_with('#')) {
            let from = target
                .replace("../../../include/", "app/engines/c/include/")
                .replace("../../yoro/examples/", "app/engines/c/examples/");
            assert!(here(&from) || here(&format!("docs/pictures/{target}")), "{target}");
        }
        assert!(kept.iter().any(|target| target.ends_with("vulkan.c")));
        assert!(kept.iter().any(|target| target == "integration-mistakes.png"));
    }
}
