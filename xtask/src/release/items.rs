//! The files of a release: what makes them, whom they are for, how they were tested.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::ValueEnum;

use crate::android::{self, Options, check};
use crate::folders::{copy, copy_folder, make, remove, target_folder};
use crate::package::linux::Machine;
use crate::package::{Target, VERSION, package};
use crate::{cargo, kit, lint};

use super::{bills, program};

/// A part of a release.
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
    /// The bills of materials (SBOM)
    Bills,
    /// The site
    Site,
}

/// True if the same commit gives the same bytes again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Same {
    /// On any machine.
    Anywhere,
    /// With the same compilers.
    Compilers,
    /// With the same compilers and the same key.
    Key,
}

/// What RELEASE.md says about files whose names contain a part.
pub struct Description {
    /// Parts of the names.
    pub parts: [&'static str; 2],
    pub title: &'static str,
    pub tested: &'static str,
    pub untested: &'static str,
    pub same: Same,
    /// Some of those whose notices are in the file, if it contains others' code.
    pub notices: &'static [&'static str],
}

/// Of what the layer and the C library contain.
const LIBRARIES: &[&str] = &["ash", "glam", "glow"];
const APPLICATION: &[&str] = &["glow", "android-properties", "The font B612 Mono"];

const NO_DEVICE: &str = "a device";

/// The descriptions, the first that fits counts: parts of names, title, tested, untested, same, notices.
pub const DESCRIPTIONS: [Description; 12] = [
    describe(["yoro-openxr-layer", "linux"], "OpenXR applications that render one view", "x86_64, of another build: hello_xr on Monado", "arm64, headsets, Steam Frame", Same::Compilers, LIBRARIES),
    describe(["yoro-openxr-layer", ".aar"], "the same for Android applications", "another build of it, in the simulated Android host", NO_DEVICE, Same::Compilers, LIBRARIES),
    describe(["libyoro", "linux"], "C, C++ and others: pkg-config, CMake", "x86_64: its README's commands, pictures against Rust's; arm64: it is linked", "arm64 devices", Same::Compilers, LIBRARIES),
    describe(["yoro-", "linux"], "the program: render, measure, stream, OpenXR", "it renders a scene, arm64 in qemu; x86_64: all tests, of another build", "headsets, arm64 devices, Steam Frame", Same::Compilers, &["openh264-sys2", "clap", "rustls"]),
    describe(["yoro-", "-quest.apk"], "Meta's store", "check-apk --store quest; its library in the simulated Android host", "a Quest, the store", Same::Key, APPLICATION),
    describe(["yoro-", ".apk"], "phones, all headsets, sideloading", "check-apk, the simulated Android host", NO_DEVICE, Same::Key, APPLICATION),
    describe(["yoro-", ".aab"], "Google Play, phones and Android XR", "check-apk --store play", "a device, bundletool, the store", Same::Key, APPLICATION),
    describe(["yoro-", ".aar"], "the C library for Android, by prefab", "it is linked with public names alone", NO_DEVICE, Same::Compilers, LIBRARIES),
    describe(["yoro-kit", ".zip"], "engines that want no library: shaders and a header", "pictures against the library's", "", Same::Anywhere, &[]),
    describe(["yoro-godot", ".zip"], "Godot", "Godot opens it, pictures against its second camera", "GPUs", Same::Anywhere, &[]),
    describe(["yoro-three", ".tgz"], "three.js", "installed and bundled, pictures against three's own eyes", "headsets", Same::Compilers, &[]),
    describe(["", ".crate"], "Rust, as the registry takes them", "all tests, before they are packed", "", Same::Compilers, &[]),
];

const fn describe(
    parts: [&'static str; 2],
    title: &'static str,
    tested: &'static str,
    untested: &'static str,
    same: Same,
    notices: &'static [&'static str],
) -> Description {
    Description { parts, title, tested, untested, same, notices }
}

impl Item {
    /// All items, in the order in which they are made.
    pub const ALL: [Item; 10] = [
        Item::Program,
        Item::Apk,
        Item::Layer,
        Item::Library,
        Item::Kit,
        Item::Godot,
        Item::Crates,
        Item::Three,
        Item::Bills,
        Item::Site,
    ];

    /// Returns the name on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Makes the item's files, and returns their paths. The site is a folder, and made of the others.
    ///
    /// # Errors
    /// Fails if something is missing or does not compile.
    pub fn make(self) -> anyhow::Result<Vec<PathBuf>> {
        let folder = target_folder()?.join("package");
        make(&folder)?;
        match self {
            Item::Program => Ok(vec![program::archive(Machine::Native, &folder)?, program::archive(Machine::Arm64, &folder)?]),
            Item::Apk => apks(&folder),
            Item::Layer => package(&[Target::LayerLinux, Target::LayerLinuxAarch64, Target::AndroidLayer]),
            Item::Library => package(&[Target::Linux, Target::LinuxAarch64, Target::Android]),
            Item::Kit => Ok(vec![zip(&kit::kit()?, &format!("yoro-kit-{VERSION}"), &folder)?]),
            Item::Godot => package(&[Target::Godot]),
            Item::Crates => crates(),
            Item::Three => package(&[Target::Three]),
            Item::Bills => bills::make(&folder),
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

/// Packs a folder as a zip whose files are in a folder of the same name.
fn zip(from: &Path, name: &str, folder: &Path) -> anyhow::Result<PathBuf> {
    let content = folder.join(format!("{name}.files"));
    remove(&content)?;
    copy_folder(from, &content.join(name))?;
    let packed = folder.join(format!("{name}.zip"));
    check::pack(&packed, &content)?;
    remove(&content)?;
    println!("{}", packed.display());
    Ok(packed)
}

/// Packs the published crates, and returns their files.
fn crates() -> anyhow::Result<Vec<PathBuf>> {
    let target = target_folder()?;
    let mut made = Vec::new();
    let kinds: [(&[&str], PathBuf); 2] =
        [(&lint::PUBLISHED, target.clone()), (&["bevy_yoro"], target.join("bevy"))];
    for (arguments, (names, target)) in lint::packing().into_iter().zip(kinds) {
        let place = target.display().to_string();
        if !cargo::succeeds(&[&arguments[..], &["--target-dir", &place]].concat(), &[]) {
            bail!("the crates cannot be packed: see above");
        }
        made.extend(names.iter().map(|name| target.join("package").join(format!("{name}-{VERSION}.crate"))));
    }
    Ok(made)
}

impl Description {
    /// Returns the description of a file.
    ///
    /// # Errors
    /// Fails if it is no file of a release.
    pub fn of(file: &Path) -> anyhow::Result<&'static Description> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let description = DESCRIPTIONS.iter().find(|description| {
            let [beginning, other] = description.parts;
            name.starts_with(beginning) && name.contains(other)
        });
        description.with_context(|| format!("{} is no file of a release: take it away", file.display()))
    }
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
            let description = Description::of(Path::new(name)).unwrap();
            assert!(description.title.starts_with(title), "{name}: {}", description.title);
        }
        assert!(Description::of(Path::new("notes.txt")).is_err());
    }
}
