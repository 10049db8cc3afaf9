//! The synthesis shaders as SPIR-V, WGSL and three.js's text. They are committed, so that building the libraries requires
//! no compiler.

use anyhow::bail;

use crate::cargo;

/// The packages whose tests know what is made of the shaders.
const PACKAGES: [&str; 3] = ["yoro", "yoro-wgpu", "yoro-three-tests"];
/// What they renew.
const MADE: &str =
    "app/engines/core/src/vulkan/spirv app/engines/wgpu/src/wgsl app/engines/three/src/shaders.js";

/// Renews all that is made of the shaders, by the tests that detect outdated files. Returns a text on what to check next.
///
/// # Errors
/// Fails if glslang is missing, or if a shader does not compile.
pub fn shaders() -> anyhow::Result<String> {
    cargo::succeeds(&["xtask", "setup"], &[]);
    let packages = PACKAGES.iter().flat_map(|package| ["--package", package]);
    let test: Vec<&str> =
        ["test", "--quiet", "--lib"].into_iter().chain(packages).chain(["shaders"]).collect();
    if !cargo::succeeds(&test, &[("YORO_BLESS_SHADERS", "1")]) {
        bail!("the shaders cannot be compiled: see above");
    }
    Ok(format!("compiled: look at `git diff --stat {MADE}`\n"))
}
