//! Static checks of the source.

use anyhow::bail;

use crate::{cargo, web};

/// The packages that could be published to a registry: the library's core and its dependencies.
pub const PUBLISHED: [&str; 4] = ["yoro-shaders", "yoro-gl", "yoro", "yoro-wgpu"];

/// The plugin for Bevy is a workspace of its own; `cargo xtask bevy test` compiles it.
const BEVY: [&str; 2] = ["--manifest-path", "app/engines/bevy/Cargo.toml"];

/// Returns cargo's arguments that pack the published crates: [`PUBLISHED`], and the plugin for Bevy.
pub fn packing() -> [Vec<&'static str>; 2] {
    let crates: Vec<&str> = PUBLISHED.iter().flat_map(|name| ["--package", name]).collect();
    // Without the lock file, cargo does not ask the registry for packages that are not published.
    let package = ["package", "--quiet", "--no-verify", "--allow-dirty", "--exclude-lockfile"];
    [[&package[..], &crates].concat(), [&package[..], &BEVY].concat()]
}

/// Runs all checks, even after one has failed.
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
    // Each alone: in the workspace, others turn on features that it may lack.
    for library in PUBLISHED {
        checks.push(vec!["check", "--quiet", "--package", library, "--lib", "--no-default-features"]);
    }
    // What `cargo xtask run` builds.
    checks.push(vec!["check", "--quiet", "--package", "yoro-cli", "--bin", "yoro", "--no-default-features"]);
    checks.push([&["fmt", "--check"][..], &BEVY].concat());
    checks.extend(packing());
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
