//! The synthesis shaders as SPIR-V, which is kept in the repository: nobody who builds the library needs a compiler for
//! it.

use anyhow::bail;

use crate::{cargo, setup};

/// Compiles all modules. The test that tells when they are old knows what each is made of, and makes it when it is told
/// to.
///
/// # Errors
/// Without glslang, or when a shader does not compile.
pub fn compile() -> anyhow::Result<()> {
    setup::vulkan();
    if setup::glslang().is_none() {
        bail!("glslangValidator is missing: install it (Debian: glslang-tools)");
    }
    let test = ["test", "--quiet", "--package", "yoro", "--lib", "vulkan::shaders"];
    if !cargo::succeeds(&test, &[("YORO_BLESS_SPIRV", "1")]) {
        bail!("the shaders cannot be compiled: see above");
    }
    println!("compiled: look at `git diff --stat app/core/src/vulkan/spirv`");
    Ok(())
}
