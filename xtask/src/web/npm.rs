//! npm packages: an emulated headset for tests, a type checker, and what the package for three.js is tested with.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, ensure};

use crate::apt;
use crate::console::run;
use crate::folders::{copy, make, make_once, read_text, root, target_folder};

/// Returns the script of the Immersive Web Emulation Runtime, which emulates a headset in the page's tests.
pub fn emulator() -> anyhow::Result<PathBuf> {
    fetch("iwer", "iwer@2.5.0", "build/iwer.min.js")
}

/// Returns the folder of the npm packages that the package for three.js is tested with: three.js in its oldest and its
/// newest version, frameworks, a bundler. `tests/three/package.json` lists them.
pub fn three() -> anyhow::Result<PathBuf> {
    let (source, folder) = (root().join("tests/three"), target_folder()?.join("three"));
    let lock = "package-lock.json";
    let recipe = read_text(&source.join(lock))?;
    make_once(&folder, &recipe, || {
        for name in ["package.json", lock] {
            copy(&source.join(name), &folder.join(name))?;
        }
        let arguments = ["ci", "--loglevel=error", "--ignore-scripts", "--no-audit", "--no-fund"];
        run(npm().args(arguments).current_dir(&folder)).map(drop)
    })?;
    Ok(folder.join("node_modules"))
}

/// Returns the command `npm`. Installs it if it is missing and apt has it.
pub fn npm() -> Command {
    if apt::find_program("npm").is_none()
        && apt::find_program("apt-get").is_some()
        && let Err(error) = apt::install(&[&["npm"]])
    {
        eprintln!("warning: {error:#}");
    }
    Command::new("npm")
}

/// Checks the types of the page's scripts by their JSDoc comments. Returns true if no fault was found. If the type
/// checker is not available, prints a message and returns true.
pub fn check_types() -> anyhow::Result<bool> {
    let compiler = match fetch("typescript", "typescript@5.9.3", "lib/tsc.js") {
        Ok(compiler) => compiler,
        Err(error) => {
            println!("the types of the page's scripts were not checked: {error:#}");
            return Ok(true);
        }
    };
    let project = root().join("app/vr/web/tsconfig.json");
    let status = Command::new("node").arg(compiler).arg("--project").arg(project).status();
    Ok(status.context("node cannot be started: apt-get install nodejs")?.success())
}

/// Fetches a package without its dependencies unless it exists, and returns the path of one of its scripts.
fn fetch(name: &str, package: &str, script: &str) -> anyhow::Result<PathBuf> {
    let folder = target_folder()?.join(name);
    let script = folder.join("package").join(script);
    make_once(&folder, package, || {
        make(&folder)?;
        let archive = run(npm().args(["pack", "--loglevel=error", package]).current_dir(&folder))?;
        run(Command::new("tar").args(["-xzf", archive.trim()]).current_dir(&folder))?;
        ensure!(script.is_file(), "{package} has not the script that was expected");
        Ok(())
    })?;
    Ok(script)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// npm 9, Debian 12's, takes no lock that names a repository where `overrides` names a version.
    #[test]
    fn the_lock_names_versions_alone() {
        let lock = read_text(&root().join("tests/three/package-lock.json")).unwrap();
        let repositories: Vec<_> = lock.lines().filter(|line| line.contains('#')).collect();
        assert!(repositories.is_empty(), "write the version there: {repositories:?}");
    }
}
