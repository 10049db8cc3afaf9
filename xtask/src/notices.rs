//! The licences of others: what dependencies may have, and the notices that go along with each file that contains them.

use crate::{cargo, console};

/// The name of the notices in archives, in the APK and beside the page.
pub const FILE: &str = "NOTICES.txt";

/// Returns the notices of everything that a package contains for a target, built with these arguments of cargo's.
pub fn text(package: &str, target: &str, features: &[&str]) -> anyhow::Result<String> {
    let arguments = [&["notices", package, target], features].concat();
    let (text, _) = cargo::helper("yoro-publish", &arguments)?;
    Ok(text)
}

/// Checks the licences of all dependencies, and prints those that are not accepted. Returns true if all are.
pub fn are_accepted() -> anyhow::Result<bool> {
    let (report, passed) = cargo::helper("yoro-publish", &["licences"])?;
    console::print(&report);
    Ok(passed)
}
