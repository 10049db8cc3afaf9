//! Google's SDK and NDK, if the user has them.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::bail;

use crate::apt::find_program;

/// Returns the folder that an environment variable such as `ANDROID_HOME` names.
pub fn folder(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// Returns the newest build tools of an SDK, by the same rule as cargo-apk.
pub fn build_tools(sdk: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(sdk.join("build-tools")).ok()?;
    let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
    let newest = names.filter(|name| name.starts_with(|c: char| c.is_ascii_digit())).max()?;
    Some(sdk.join("build-tools").join(newest))
}

/// Returns the path of one of the SDK's tools, from the user's SDK or else from the system.
pub fn build_tool(name: &str) -> anyhow::Result<PathBuf> {
    let sdk = folder("ANDROID_HOME");
    let own = sdk.and_then(|sdk| build_tools(&sdk)).map(|tools| tools.join(name));
    match own.filter(|tool| tool.is_file()).or_else(|| find_program(name)) {
        Some(tool) => Ok(tool),
        None => bail!("{name} is missing: `cargo xtask doctor` says how to get it"),
    }
}
