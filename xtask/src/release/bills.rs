//! Bills of materials in CycloneDX, by cargo-cyclonedx: one for each file that contains others' code, with its name.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cargo;
use crate::console::run;
use crate::folders::{read_text, remove, root, target_folder, write};
use crate::package::VERSION;

const TOOL: &str = "0.5.9";
pub const FORMAT: &str = "1.5";
/// The name that the tool gives to what it writes beside each manifest.
const NAME: &str = "bill";
/// The folder of the workspace in the bills, in place of the builder's.
const PLACE: &str = "yoro";

/// What is added to a file's name for that of its bill.
pub const ENDING: &str = ".cdx.json";

/// For each target the published files, `VERSION` for the version, and the folders of their packages.
const FILES: &str = include_str!("bills.txt");

/// Makes the bills, and returns their paths.
pub fn make(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let tool = cargo::install("cargo-cyclonedx", TOOL)?;
    // The tool writes beside the manifest of every package: into a copy.
    let copy = target_folder()?.join("bills").join(PLACE);
    remove(&copy)?;
    run(Command::new("git").arg("clone").arg("--quiet").arg(root()).arg(&copy))?;
    let mut made = Vec::new();
    for group in FILES.split("\n\n") {
        let mut lines = group.lines();
        let target = lines.next().unwrap_or_default();
        let mut command = Command::new(&tool);
        command.args(["cyclonedx", "--quiet", "--format", "json", "--spec-version", FORMAT]);
        command.args(["--no-build-deps", "--override-filename", NAME, "--target", target]);
        command.arg("--manifest-path").arg(copy.join("Cargo.toml")).env("SOURCE_DATE_EPOCH", "0");
        run(&mut command)?;
        for (name, package) in lines.filter_map(|line| line.split_once(' ')) {
            let bill = copy.join(package).join(NAME).with_extension("json");
            let text = read_text(&bill)?;
            let file = folder.join(name.replace("VERSION", VERSION) + ENDING);
            write(&file, text.replace(&copy.display().to_string(), &format!("/{PLACE}")))?;
            made.push(file);
        }
    }
    remove(&copy)?;
    Ok(made)
}
