//! The notices of others' licences, which go along with each file that contains their code.

use crate::cargo;

/// The name of the notices in archives, in the APK and beside the page.
pub const FILE: &str = "NOTICES.txt";

/// Returns the notices of everything that a package contains for a target, built with these arguments of cargo's.
pub fn text(package: &str, target: &str, features: &[&str]) -> anyhow::Result<String> {
    let arguments = [&["notices", package, target], features].concat();
    let (text, _) = cargo::helper("yoro-publish", &arguments)?;
    Ok(text)
}
