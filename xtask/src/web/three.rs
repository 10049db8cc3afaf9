//! The example of the package for three.js beside the page, bundled with three.js.

use std::path::Path;
use std::process::Command;

use super::npm;
use crate::console::run;
use crate::folders::{copy, read_text, root};

/// Writes the example into a folder, and returns the notice of three.js, which is in it.
pub fn example(folder: &Path) -> anyhow::Result<String> {
    let package = root().join("app/engines/three");
    let modules = npm::three()?;
    let mut esbuild = Command::new("node");
    esbuild.arg(modules.join("esbuild/bin/esbuild")).arg(package.join("examples/main.js"));
    esbuild.args(["--bundle", "--minify", "--format=esm", "--log-level=error"]);
    esbuild.arg(format!("--alias:yoro-three={}", package.join("src/index.js").display()));
    esbuild.arg(format!("--outfile={}", folder.join("main.js").display())).env("NODE_PATH", &modules);
    run(&mut esbuild)?;
    for name in ["index.html", "style.css"] {
        copy(&package.join("examples").join(name), &folder.join(name))?;
    }
    let licence = modules.join("three/LICENSE");
    let text = read_text(&licence)?;
    Ok(format!("\n{}\nthree.js, in the folder three (MIT)\n\n{text}", "=".repeat(78)))
}
