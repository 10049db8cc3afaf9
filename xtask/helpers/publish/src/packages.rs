//! Packages as cargo knows them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::Context as _;
use serde_json::Value;
use xtask::cargo;

/// A package that is not the workspace's own.
#[derive(Clone, Debug)]
pub struct Package {
    pub name: String,
    pub version: String,
    /// The licence's expression in its manifest; empty if there is none.
    pub licence: String,
    pub authors: Vec<String>,
    /// The folder of its sources.
    pub folder: PathBuf,
}

/// Returns all packages that a workspace may depend on, on any platform, by name and version.
pub fn all(manifest: &str) -> anyhow::Result<BTreeMap<(String, String), Package>> {
    let arguments = ["metadata", "--format-version", "1", "--locked", "--manifest-path", manifest];
    let metadata = serde_json::from_str::<Value>(&cargo::output(&arguments)?);
    let metadata = metadata.context("cargo metadata prints something else than JSON")?;
    let packages = metadata["packages"].as_array().context("cargo metadata prints no packages")?;
    let others = packages.iter().filter(|package| !package["source"].is_null());
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    Ok(others
        .map(|package| {
            let (name, version) = (text(&package["name"]), text(&package["version"]));
            let authors = package["authors"].as_array().into_iter().flatten().map(text).collect();
            let mut folder = PathBuf::from(text(&package["manifest_path"]));
            folder.pop();
            let licence = text(&package["license"]);
            ((name.clone(), version.clone()), Package { name, version, licence, authors, folder })
        })
        .collect())
}

/// Returns names and versions of what a package for a target contains, itself included.
pub fn contained(package: &str, target: &str, features: &[&str]) -> anyhow::Result<Vec<(String, String)>> {
    // Macros and build scripts run on the builder's machine, and nothing of them is in the result.
    let mut arguments = vec!["tree", "--locked", "--package", package, "--target", target];
    arguments.extend(["--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"]);
    arguments.extend(features);
    let mut found: Vec<_> = cargo::output(&arguments)?.lines().filter_map(name_and_version).collect();
    found.sort();
    found.dedup();
    Ok(found)
}

/// Splits `name v1.2.3 (folder)`.
fn name_and_version(line: &str) -> Option<(String, String)> {
    let mut words = line.split(' ');
    Some((words.next()?.to_owned(), words.next()?.strip_prefix('v')?.to_owned()))
}
