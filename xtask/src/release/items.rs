//! The files of a release: what makes them, whom they are for, how they were tested.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::ValueEnum;

use crate::android::{self, Options};
use crate::folders::{copy, copy_folder, make, remove, target_folder};
use crate::package::linux::Machine;
use crate::package::{Target, VERSION, package, zip};
use crate::{cargo, kit, lint};

use super::program;

/// A part of a release, in the order in which they are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Item {
    /// The program for Linux on this machine's processor and on arm64
    Program,
    /// The APKs and the bundle
    Apk,
    /// The OpenXR layer for Linux and Android
    Layer,
    /// The C library for Linux and Android
    Library,
    /// The shader kit
    Kit,
    /// The add-on for Godot
    Godot,
    /// The crates
    Crates,
    /// The package for three.js
    Three,
    /// The site
    Site,
}

/// What RELEASE.md says about files, as cells of a table: for whom, tested by, not tested on, same bytes again.
const FILES: &str = include_str!("files.txt");

impl Item {
    /// Returns the name on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Makes the item's files, and returns their paths. The site is a folder, and made of the others.
    pub fn make(self) -> anyhow::Result<Vec<PathBuf>> {
        let folder = target_folder()?.join("package");
        make(&folder)?;
        match self {
            Item::Program => Ok(vec![
                program::archive(Machine::Native, &folder)?,
                program::archive(Machine::Arm64, &folder)?,
            ]),
            Item::Apk => apks(&folder),
            Item::Layer => package(&[Target::LayerLinux, Target::LayerLinuxAarch64, Target::AndroidLayer]),
            Item::Library => package(&[Target::Linux, Target::LinuxAarch64, Target::Android]),
            Item::Kit => {
                let packed = folder.join(format!("yoro-kit-{VERSION}.zip"));
                let content = folder.join("kit.files");
                remove(&content)?;
                copy_folder(&kit::kit()?, &content.join(format!("yoro-kit-{VERSION}")))?;
                Ok(vec![zip(&content, packed)?])
            }
            Item::Godot => package(&[Target::Godot]),
            Item::Crates => crates(),
            Item::Three => package(&[Target::Three]),
            Item::Site => Ok(Vec::new()),
        }
    }
}

/// Builds the APKs and the bundle, under names with the version.
fn apks(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let options = Options { release: true, yes: true, bundle: true, quest: true, ..Options::default() };
    let apk = android::apk(&options)?;
    let mut made = Vec::new();
    for (suffix, extension) in [("", "apk"), ("-quest", "apk"), ("", "aab")] {
        let built = apk.with_file_name(format!("yoro{suffix}")).with_extension(extension);
        let named = folder.join(format!("yoro-{VERSION}{suffix}.{extension}"));
        copy(&built, &named)?;
        made.push(named);
    }
    Ok(made)
}

/// Packs the published crates, and returns their files.
fn crates() -> anyhow::Result<Vec<PathBuf>> {
    let target = target_folder()?;
    let mut made = Vec::new();
    let kinds: [(&[&str], PathBuf); 2] =
        [(&lint::PUBLISHED, target.clone()), (&["bevy_yoro"], target.join("bevy"))];
    for (arguments, (names, target)) in lint::packing().into_iter().zip(kinds) {
        let mut command = cargo::cargo();
        command.args(arguments).arg("--target-dir").arg(&target);
        cargo::perform(&mut command, "the crates cannot be packed")?;
        made.extend(names.iter().map(|name| target.join("package").join(format!("{name}-{VERSION}.crate"))));
    }
    Ok(made)
}

/// Returns what RELEASE.md says about a file.
pub fn description(file: &Path) -> anyhow::Result<&'static str> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let mut rows =
        FILES.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once(" | "));
    let is_for = |(parts, _): &(&str, &str)| {
        let (beginning, part) = parts.split_once(' ').unwrap_or_default();
        name.starts_with(beginning) && name.contains(part)
    };
    let row = rows.find(is_for).with_context(|| format!("{} is no file of a release", file.display()))?;
    Ok(row.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_described() {
        for (name, title) in [
            ("yoro-0.1.0-linux-x86_64.tar.xz", "the program: render"),
            ("libyoro-0.1.0-linux-x86_64.tar.xz", "C, C++"),
            ("yoro-openxr-layer-0.1.0-linux-aarch64.tar.xz", "OpenXR applications"),
            ("yoro-openxr-layer-0.1.0.aar", "the same for Android"),
            ("yoro-0.1.0-quest.apk", "Meta"),
            ("yoro-0.1.0.apk", "phones"),
            ("yoro-0.1.0.aar", "the C library"),
            ("yoro-gl-0.1.0.crate", "Rust"),
            ("bevy_yoro-0.1.0.crate", "Rust"),
            ("yoro-0.1.0-linux-aarch64.tar.xz", "the program: render"),
        ] {
            let description = description(Path::new(name)).unwrap();
            assert!(description.starts_with(title), "{name}: {description}");
        }
        assert!(description(Path::new("notes.txt")).is_err());
    }
}
