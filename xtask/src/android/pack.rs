//! Repacks cargo-apk's APK with the completed manifest.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::keystore::Keystore;
use super::manifest;
use crate::console::run;
use crate::folders::{read_text, write};
use crate::ndk::sdk::build_tool;
use crate::ndk::target::ARCHITECTURES;
use crate::notices;

/// Where an APK is to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Phones and all headsets.
    All,
    /// Meta's store.
    Quest,
}

/// Packs, aligns and signs an APK from cargo-apk's output in `folder`: its manifest, which is completed for the variant,
/// and the libraries in its APK `name`. `notices` goes into its assets. Returns the path of the new APK, in the same
/// folder.
pub fn pack(
    variant: Variant,
    folder: &Path,
    name: &str,
    android_jar: &Path,
    resources: &Path,
    notices: &str,
    keystore: &Keystore,
) -> anyhow::Result<PathBuf> {
    let at = |file: &str| folder.join(file);
    let text = read_text(&at("AndroidManifest.xml"))?;
    let text = match variant {
        Variant::All => manifest::complete(&text)?,
        Variant::Quest => manifest::for_quest(&text)?,
    };
    // aapt requires this file name.
    let whole = at("complete/AndroidManifest.xml");
    write(&whole, text)?;
    let assets = at("assets");
    write(&assets.join(notices::FILE), notices)?;
    let [unaligned, finished] =
        ["complete-unaligned", "complete"].map(|kind| at(&format!("{name}-{kind}.apk")));

    let libraries = libraries(&at(&format!("{name}.apk")))?;
    let libraries = libraries.iter().filter(|path| match variant {
        Variant::All => true,
        Variant::Quest => path.contains(ARCHITECTURES[0].abi),
    });

    let tool = |tool: &str| -> anyhow::Result<Command> {
        let mut command = Command::new(build_tool(tool)?);
        // aapt adds libraries under the paths that they have in this folder.
        command.current_dir(folder);
        Ok(command)
    };
    let mut package = tool("aapt")?;
    package.args(["package", "-f", "-F"]).arg(&unaligned).arg("-M").arg(&whole);
    package.arg("-I").arg(android_jar).arg("-S").arg(resources).arg("-A").arg(&assets);
    run(&mut package)?;
    run(tool("aapt")?.arg("add").arg(&unaligned).args(libraries))?;
    run(tool("zipalign")?.args(["-f", "4"]).arg(&unaligned).arg(&finished))?;
    sign(&finished, keystore, &[])?;
    Ok(finished)
}

/// Signs an APK, or another file if `arguments` say so.
pub fn sign(file: &Path, keystore: &Keystore, arguments: &[&str]) -> anyhow::Result<()> {
    let mut sign = Command::new(build_tool("apksigner")?);
    sign.arg("sign").arg("--ks").arg(&keystore.path).args(arguments);
    // In the environment, because every user of this machine can read a program's arguments.
    sign.args(["--ks-pass", "env:YORO_KEYSTORE_PASSWORD"]).env("YORO_KEYSTORE_PASSWORD", &keystore.password);
    run(sign.arg(file)).map(drop)
}

/// Returns the paths of the libraries in an APK.
fn libraries(apk: &Path) -> anyhow::Result<Vec<String>> {
    let listing = run(Command::new(build_tool("aapt")?).arg("list").arg(apk))?;
    Ok(listing.lines().filter(|name| name.starts_with("lib/")).map(str::to_owned).collect())
}
