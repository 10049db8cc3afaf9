//! The synthesis shaders as SPIR-V and WGSL. They are committed, so that building the libraries requires no compiler.

use anyhow::bail;

use crate::cargo;

/// Compiles all modules for Vulkan, and returns a text on what to check next.
///
/// # Errors
/// Fails if glslang is missing, or if a shader does not compile.
pub fn spirv() -> anyhow::Result<String> {
    compile("yoro", "vulkan::shaders", "YORO_BLESS_SPIRV", "app/engines/core/src/vulkan/spirv")
}

/// Compiles all modules for wgpu, and returns a text on what to check next.
///
/// # Errors
/// Fails if glslang is missing, or if a shader does not compile.
pub fn wgsl() -> anyhow::Result<String> {
    compile("yoro-wgpu", "shaders", "YORO_BLESS_WGSL", "app/engines/wgpu/src/wgsl")
}

/// Preprocesses all passes for three.js, and returns a text on what to check next.
///
/// # Errors
/// Fails if glslang is missing.
pub fn three() -> anyhow::Result<String> {
    compile("yoro-three-tests", "shaders", "YORO_BLESS_THREE", "app/engines/three/src/shaders.js")
}

/// Runs the test that detects outdated modules. It knows their sources, and renews them if `bless` is set.
fn compile(package: &str, test: &str, bless: &str, folder: &str) -> anyhow::Result<String> {
    cargo::succeeds(&["xtask", "setup"], &[]);
    let test = ["test", "--quiet", "--package", package, "--lib", test];
    if !cargo::succeeds(&test, &[(bless, "1")]) {
        bail!("the shaders cannot be compiled: see above");
    }
    Ok(format!("compiled: look at `git diff --stat {folder}`\n"))
}
