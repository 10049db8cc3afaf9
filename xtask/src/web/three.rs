//! The example of the package for three.js beside the page, bundled with three.js.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, bail};

use super::npm;
use crate::folders::{copy, root};

/// Writes the example into a folder.
///
/// # Errors
/// Fails if the npm packages cannot be had, or the example cannot be bundled.
pub fn example(folder: &Path) -> anyhow::Result<()> {
    let package = root().join("app/engines/three");
    let modules = npm::three()?;
    let mut esbuild = Command::new("node");
    esbuild.arg(modules.join("esbuild/bin/esbuild")).arg(package.join("examples/main.js"));
    esbuild.args(["--bundle", "--minify", "--format=esm", "--log-level=error"]);
    esbuild.arg(format!("--alias:yoro-three={}", package.join("src/index.js").display()));
    esbuild.arg(format!("--outfile={}", folder.join("main.js").display())).env("NODE_PATH", &modules);
    if !esbuild.status().context("node cannot be started: apt-get install nodejs")?.success() {
        bail!("it cannot be bundled: see above");
    }
    for name in ["index.html", "style.css"] {
        copy(&package.join("examples").join(name), &folder.join(name))?;
    }
    Ok(())
}
