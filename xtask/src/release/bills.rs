//! Bills of materials in CycloneDX, by cargo-cyclonedx: one for each file that contains others' code, with its name.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::console::run;
use crate::folders::{read_text, remove, root, target_folder, write};
use crate::package::VERSION;
use crate::{arm64, cargo, web};

const TOOL: &str = "0.5.9";
pub const FORMAT: &str = "1.5";
/// The name that the tool gives to what it writes beside each manifest.
const NAME: &str = "bill";
/// The folder of the workspace in the bills, in place of the builder's.
const PLACE: &str = "yoro";

/// What is added to a file's name for that of its bill.
pub const ENDING: &str = ".cdx.json";

const PROGRAM: &str = "app/program";
const LAYER: &str = "app/engines/openxr-layer";
const LIBRARY: &str = "app/engines/c";
const APK: &str = "android";

/// For each target the published files, `{}` for the version, and the folders of their packages.
const FILES: [(&str, &[(&str, &str)]); 4] = [
    (
        "x86_64-unknown-linux-gnu",
        &[
            ("yoro-{}-linux-x86_64.tar.xz", PROGRAM),
            ("yoro-openxr-layer-{}-linux-x86_64.tar.xz", LAYER),
            ("libyoro-{}-linux-x86_64.tar.xz", LIBRARY),
            ("yoro-wgpu-{}.crate", "app/engines/wgpu"),
        ],
    ),
    (
        arm64::TRIPLE,
        &[
            ("yoro-{}-linux-aarch64.tar.xz", PROGRAM),
            ("yoro-openxr-layer-{}-linux-aarch64.tar.xz", LAYER),
            ("libyoro-{}-linux-aarch64.tar.xz", LIBRARY),
        ],
    ),
    (
        "aarch64-linux-android",
        &[
            ("yoro-{}.apk", APK),
            ("yoro-{}-quest.apk", APK),
            ("yoro-{}.aab", APK),
            ("yoro-openxr-layer-{}.aar", LAYER),
            ("yoro-{}.aar", LIBRARY),
        ],
    ),
    (web::TRIPLE, &[("yoro-page-{}", "app/vr/web")]),
];

/// Makes the bills, and returns their paths.
pub fn make(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let tool = cargo::install("cargo-cyclonedx", TOOL)?;
    // The tool writes beside the manifest of every package: into a copy.
    let copy = target_folder()?.join("bills").join(PLACE);
    remove(&copy)?;
    run(Command::new("git").arg("clone").arg("--quiet").arg(root()).arg(&copy))?;
    let mut made = Vec::new();
    for (target, files) in FILES {
        let mut command = Command::new(&tool);
        command.args(["cyclonedx", "--quiet", "--format", "json", "--spec-version", FORMAT]);
        command.args(["--no-build-deps", "--override-filename", NAME, "--target", target]);
        command.arg("--manifest-path").arg(copy.join("Cargo.toml")).env("SOURCE_DATE_EPOCH", "0");
        run(&mut command)?;
        for (name, package) in files {
            let bill = copy.join(package).join(NAME).with_extension("json");
            let text = read_text(&bill)?;
            let file = folder.join(name.replace("{}", VERSION) + ENDING);
            write(&file, text.replace(&copy.display().to_string(), &format!("/{PLACE}")))?;
            made.push(file);
        }
    }
    remove(&copy)?;
    Ok(made)
}
