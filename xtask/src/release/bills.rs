//! Bills of materials in CycloneDX, by cargo-cyclonedx: one for each file that contains others' code, with its name.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::folders::{remove, root, target_folder, write};
use crate::package::VERSION;
use crate::package::linux::run;
use crate::{arm64, web};

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
///
/// # Errors
/// Fails if the tool cannot be installed, or fails.
pub fn make(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let tool = install()?;
    // The tool writes beside the manifest of every package: into a copy.
    let copy = target_folder()?.join("bills").join(PLACE);
    remove(&copy)?;
    run(Command::new("git").arg("clone").arg("--quiet").arg(root()).arg(&copy))?;
    let mut made = Vec::new();
    for (target, files) in FILES {
        let mut command = Command::new(&tool);
        command.args([
            "cyclonedx",
            "--quiet",
            "--format",
            "json",
            "--spec-version",
            FORMAT,
            "--no-build-deps",
        ]);
        command.args(["--override-filename", NAME, "--target", target]);
        command.arg("--manifest-path").arg(copy.join("Cargo.toml")).env("SOURCE_DATE_EPOCH", "0");
        run(&mut command)?;
        for (name, package) in files {
            let bill = copy.join(package).join(NAME).with_extension("json");
            let text =
                std::fs::read_to_string(&bill).with_context(|| format!("{} was not made", bill.display()))?;
            let file = folder.join(name.replace("{}", VERSION) + ENDING);
            write(&file, text.replace(&copy.display().to_string(), &format!("/{PLACE}")))?;
            made.push(file);
        }
    }
    remove(&copy)?;
    Ok(made)
}

/// Installs the tool in the project's own folder, and returns its path.
fn install() -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join("tools");
    let program = folder.join("bin/cargo-cyclonedx");
    let version = Command::new(&program).args(["cyclonedx", "--version"]).output();
    if version.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim().ends_with(TOOL)) {
        return Ok(program);
    }
    // A debug build, as it runs for seconds.
    let mut install = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    install.args([
        "install",
        "cargo-cyclonedx",
        "--version",
        TOOL,
        "--locked",
        "--debug",
        "--force",
        "--quiet",
    ]);
    install.args(["--no-track", "--root"]).arg(&folder).env_remove("CARGO_TARGET_DIR");
    eprintln!("$ cargo install cargo-cyclonedx --version {TOOL} --locked --root {}", folder.display());
    if !install.status().context("cargo cannot be started")?.success() {
        bail!("cargo-cyclonedx {TOOL} cannot be installed: see above");
    }
    Ok(program)
}
