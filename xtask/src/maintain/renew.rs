//! Everything that is generated and committed, so that building requires no more than Rust.

use anyhow::bail;

use super::shader_cost;
use crate::folders::{copy, root};
use crate::{cargo, kit, setup};

/// Something that a test knows the sources of. The test detects that it is outdated, and renews it if a variable is set.
struct Generated {
    what: &'static str,
    test: &'static [&'static str],
    variable: &'static str,
}

const GENERATED: [Generated; 4] = [
    Generated {
        what: "the synthesis shaders for Vulkan",
        test: &["--package", "yoro", "--lib", "vulkan::shaders"],
        variable: "YORO_BLESS_SPIRV",
    },
    Generated {
        what: "the synthesis shaders for wgpu",
        test: &["--package", "yoro-wgpu", "--lib", "shaders"],
        variable: "YORO_BLESS_WGSL",
    },
    Generated {
        what: "the header of the C library",
        test: &["--package", "yoro-c", "--test", "header"],
        variable: "YORO_BLESS",
    },
    Generated {
        what: "the table in docs/settings.md",
        test: &["--package", "yoro-settings", "the_document_has_the_table"],
        variable: "YORO_BLESS",
    },
];
/// The shaders in the package for three.js.
const THREE: &str = "app/engines/three/src/shaders.js";

/// Renews all of it. Returns a text on what to check next, and false if a shader has a fault.
///
/// # Errors
/// Fails if glslang is missing, a shader does not compile, or a file cannot be written.
pub fn renew() -> anyhow::Result<(String, bool)> {
    setup::vulkan();
    for Generated { what, test, variable } in GENERATED {
        if !cargo::succeeds(&[&["test", "--quiet"], test].concat(), &[(variable, "1")]) {
            bail!("{what} cannot be renewed: see above");
        }
    }
    copy(&kit::kit()?.join("three/shaders.js"), &root().join(THREE))?;
    let (costs, passed) = match shader_cost::Compilers::make() {
        Ok(compilers) => {
            let options = shader_cost::Options { filter: None, gpus: Vec::new(), bless: true };
            shader_cost::report(&options, &compilers, shader_cost::programs()?)?
        }
        Err(error) => (format!("the costs of shaders were not renewed: {error:#}\n"), true),
    };
    Ok((format!("{costs}renewed: look at `git diff --stat`\n"), passed))
}
