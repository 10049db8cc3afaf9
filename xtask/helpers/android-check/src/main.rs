//! Works with Android's archives and libraries. `check APK STORE [any-key] [any-size]` checks whether Android will install
//! and start an APK or a bundle (.aab), and whether a store (`quest`, `play`; `-` for none) takes it, apart from the key that
//! signed it or its size; `bundle APK AAB` converts an APK to a bundle, `loader LIBRARY` prints the architecture of an OpenXR
//! loader, and `pack ARCHIVE FOLDER` packs the files of a folder.
//!
//! This is a separate program so that only people who build for Android have to compile its dependencies.

mod bundle;
mod check;
mod library;
mod manifest;

use std::path::Path;
use std::process::ExitCode;

use anyhow::bail;
use check::Store;
use xtask::console;

fn main() -> ExitCode {
    console::main(perform)
}

/// Returns the text to print, and false if a check has failed.
fn perform(arguments: &[&str]) -> anyhow::Result<(String, bool)> {
    match arguments {
        ["check", apk, name, apart_from @ ..] => {
            let store = match *name {
                "quest" => Store::Quest,
                "play" => Store::Play,
                _ => Store::None,
            };
            let report = check::check(Path::new(apk), store, apart_from)?;
            return Ok((report.text, !report.failed));
        }
        ["bundle", apk, bundle] => bundle::make(Path::new(apk), Path::new(bundle))?,
        ["loader", library] => return Ok((library::loader_abi(Path::new(library))?.to_owned(), true)),
        ["pack", packed, folder] => bundle::pack(Path::new(folder), Path::new(packed))?,
        _ => bail!("usage: see xtask/helpers/android-check/src/main.rs"),
    }
    Ok((String::new(), true))
}
