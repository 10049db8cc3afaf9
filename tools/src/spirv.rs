//! The synthesis shaders as SPIR-V. It is kept in the repository, so that nobody who builds the library needs a compiler.

use anyhow::bail;
use yoro_tools::cargo;

/// Compiles all modules, and returns what to look at next. The test that notices old modules knows what each is made of,
/// and makes it when it is told to.
///
/// # Errors
/// Without glslang, or when a shader does not compile.
pub fn compile() -> anyhow::Result<String> {
    cargo::succeeds(&["xtask", "setup"], &[]);
    let test = ["test", "--quiet", "--package", "yoro", "--lib", "vulkan::shaders"];
    if !cargo::succeeds(&test, &[("YORO_BLESS_SPIRV", "1")]) {
        bail!("the shaders cannot be compiled: see above");
    }
    Ok("compiled: look at `git diff --stat app/core/src/vulkan/spirv`\n".to_owned())
}
