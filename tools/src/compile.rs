//! The synthesis shaders as SPIR-V and WGSL. They are kept in the repository, so that nobody who builds the libraries
//! needs a compiler.

use anyhow::bail;
use yoro_tools::cargo;

/// Compiles all modules for Vulkan, and returns what to look at next.
///
/// # Errors
/// Without glslang, or when a shader does not compile.
pub fn spirv() -> anyhow::Result<String> {
    compile("yoro", "vulkan::shaders", "YORO_BLESS_SPIRV", "app/core/src/vulkan/spirv")
}

/// Compiles all modules for wgpu, and returns what to look at next.
///
/// # Errors
/// Without glslang, or when a shader does not compile.
pub fn wgsl() -> anyhow::Result<String> {
    compile("yoro-wgpu", "shaders", "YORO_BLESS_WGSL", "app/wgpu/src/wgsl")
}

/// The test that notices old modules knows what each is made of, and makes it when it is told to.
fn compile(package: &str, test: &str, bless: &str, folder: &str) -> anyhow::Result<String> {
    cargo::succeeds(&["xtask", "setup"], &[]);
    let test = ["test", "--quiet", "--package", package, "--lib", test];
    if !cargo::succeeds(&test, &[(bless, "1")]) {
        bail!("the shaders cannot be compiled: see above");
    }
    Ok(format!("compiled: look at `git diff --stat {folder}`\n"))
}
