//! Static checks of the source.

use anyhow::{Context as _, bail};
use serde_json::Value;

use crate::cargo;
use crate::web;

/// The packages that could be published to a registry: the library's core and its dependencies.
const PUBLISHED: [&str; 4] = ["yoro-shaders", "yoro-gl", "yoro", "yoro-wgpu"];

/// Runs all checks, even after one has failed.
///
/// # Errors
/// Fails if a check has found something.
pub fn lint() -> anyhow::Result<()> {
    let mut checks: Vec<Vec<&str>> = vec![
        vec!["fmt", "--all", "--check"],
        [
            &["clippy", "--quiet", "--workspace", "--all-targets", "--features", "yoro-cli/neural"][..],
            &["--", "--deny", "warnings"],
        ]
        .concat(),
        // Users build without the neural patcher, and so do the tests.
        vec!["test", "--quiet", "--package", "yoro-bench", "--features", "neural", "--lib", "inpaint"],
        vec!["doc", "--quiet", "--workspace", "--no-deps"],
    ];
    let metadata = cargo::output(&["metadata", "--no-deps", "--format-version", "1"])?;
    let libraries = libraries(&metadata).context("cargo's metadata are not as expected")?;
    for library in &libraries {
        checks.push(vec!["check", "--quiet", "--package", library, "--lib", "--no-default-features"]);
    }
    // What `cargo xtask run` builds.
    checks.push(vec!["check", "--quiet", "--package", "yoro-cli", "--bin", "yoro", "--no-default-features"]);
    // Without the lock file, cargo does not ask the registry for packages that are not published.
    let mut package = vec!["package", "--quiet", "--no-verify", "--allow-dirty", "--exclude-lockfile"];
    package.extend(PUBLISHED.iter().flat_map(|name| ["--package", name]));
    checks.push(package);
    // The plugin for Bevy is a workspace of its own; `cargo xtask bevy test` compiles it.
    let bevy = ["--manifest-path", "app/engines/bevy/Cargo.toml"];
    checks.push([&["fmt", "--check"][..], &bevy].concat());
    checks.push(
        [&["package", "--quiet", "--no-verify", "--allow-dirty", "--exclude-lockfile"][..], &bevy].concat(),
    );
    let mut failed: Vec<String> = checks
        .iter()
        .filter(|check| !cargo::succeeds(check, &[("RUSTDOCFLAGS", "--deny warnings")]))
        .map(|check| format!("cargo {}", check.join(" ")))
        .collect();
    if !web::check_types()? {
        failed.push("the type checker (app/vr/web/tsconfig.json)".into());
    }
    if !failed.is_empty() {
        bail!("{} found something: see above", failed.join(", "));
    }
    println!("lint: nothing found");
    Ok(())
}

/// Returns the packages that are libraries for other Rust projects.
fn libraries(metadata: &str) -> Option<Vec<String>> {
    let metadata: Value = serde_json::from_str(metadata).ok()?;
    let is_library = |package: &&Value| {
        let mut kinds = package["targets"].as_array().into_iter().flatten().map(|target| &target["kind"]);
        kinds.any(|kind| kind.as_array().is_some_and(|kinds| kinds.iter().any(|kind| kind == "lib")))
    };
    let packages = metadata["packages"].as_array()?.iter().filter(is_library);
    Some(packages.filter_map(|package| package["name"].as_str().map(str::to_owned)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_are_distinguished_from_programs() {
        let metadata = r#"{"packages": [
            {"name": "yoro", "targets": [{"kind": ["test"]}, {"kind": ["lib"]}]},
            {"name": "yoro-cli", "targets": [{"kind": ["bin"]}]},
            {"name": "yoro-android", "targets": [{"kind": ["cdylib"]}]}
        ]}"#;
        assert_eq!(libraries(metadata).unwrap(), ["yoro"]);
        assert_eq!(libraries("{}"), None);
    }
}
