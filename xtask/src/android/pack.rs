//! The APK packed anew: cargo-apk's, with the completed manifest.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, bail};

use super::keystore::Keystore;
use super::manifest;
use yoro_tools::ndk::sdk::build_tool;

/// Packs, aligns and signs an APK of what cargo-apk has left in `folder`: its manifest, which is completed, and the
/// libraries that are in its own APK `name`. The new APK, beside the others.
///
/// # Errors
/// When a tool fails, or cargo-apk has left something else.
pub fn pack(
    folder: &Path,
    name: &str,
    android_jar: &Path,
    resources: &Path,
    keystore: &Keystore,
) -> anyhow::Result<PathBuf> {
    let at = |file: &str| folder.join(file);
    let written = at("AndroidManifest.xml");
    let text =
        fs::read_to_string(&written).with_context(|| format!("{} cannot be read", written.display()))?;
    let text = manifest::complete(&text)?;
    // aapt takes the manifest by this name alone.
    let whole = at("complete/AndroidManifest.xml");
    fs::create_dir_all(at("complete"))
        .and_then(|()| fs::write(&whole, text))
        .with_context(|| format!("{} cannot be written", whole.display()))?;
    let [unaligned, finished] =
        ["complete-unaligned", "complete"].map(|kind| at(&format!("{name}-{kind}.apk")));

    let tool = |tool: &str| -> anyhow::Result<Command> {
        let mut command = Command::new(build_tool(tool)?);
        // Libraries are added by their paths in the APK, which are those in this folder.
        command.current_dir(folder);
        Ok(command)
    };
    let mut package = tool("aapt")?;
    package.args(["package", "-f", "-F"]).arg(&unaligned).arg("-M").arg(&whole);
    package.arg("-I").arg(android_jar).arg("-S").arg(resources);
    run(&mut package)?;
    run(tool("aapt")?.arg("add").arg(&unaligned).args(libraries(&at(&format!("{name}.apk")))?))?;
    run(tool("zipalign")?.args(["-f", "4"]).arg(&unaligned).arg(&finished))?;
    sign(&finished, keystore, &[])?;
    Ok(finished)
}

/// Signs an APK; with other arguments, something else.
pub fn sign(file: &Path, keystore: &Keystore, arguments: &[&str]) -> anyhow::Result<()> {
    let mut sign = Command::new(build_tool("apksigner")?);
    sign.arg("sign").arg("--ks").arg(&keystore.path).args(arguments);
    // Passed through the environment: every user of this machine can read arguments.
    sign.args(["--ks-pass", "env:YORO_KEYSTORE_PASSWORD"]).env("YORO_KEYSTORE_PASSWORD", &keystore.password);
    run(sign.arg(file)).map(drop)
}

/// The libraries in an APK, by their paths in it.
fn libraries(apk: &Path) -> anyhow::Result<Vec<String>> {
    let listing = run(Command::new(build_tool("aapt")?).arg("list").arg(apk))?;
    Ok(listing.lines().filter(|name| name.starts_with("lib/")).map(str::to_owned).collect())
}

/// Runs a tool, and returns what it prints.
fn run(command: &mut Command) -> anyhow::Result<String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("{program} cannot be started"))?;
    if !output.status.success() {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
        bail!("{program} failed: {} {}", text(&output.stderr), text(&output.stdout));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
