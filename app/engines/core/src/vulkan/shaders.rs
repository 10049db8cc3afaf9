//! The shaders of the passes as SPIR-V, compiled from the files of `yoro-shaders` by `cargo xtask maintain renew`.

use super::{Options, VulkanError};
use crate::synthesis::backend::{PerKind, WarpKind};
use crate::synthesis::{HoleMark, Holes};

pub(super) const SCREEN: &[u8] = include_bytes!("spirv/screen.spv");
pub(super) const COMPOSE: &[u8] = include_bytes!("spirv/compose.spv");

/// The shaders of the passes for a kind of warp.
pub(super) struct Shaders {
    /// Finds the bounds of each tile.
    pub(super) tiles: &'static [u8],
    /// Finds the part of the source to search for each tile of the target.
    pub(super) spans: &'static [u8],
    /// The vertex shader of the last pass.
    pub(super) march_vertex: &'static [u8],
    /// The last pass.
    march: &'static [u8],
    /// The last pass, writing depth, too.
    march_depth: &'static [u8],
    /// The last pass with open holes, without depth and writing depth.
    march_open: Option<[&'static [u8]; 2]>,
}

const GATHER: Shaders = Shaders {
    tiles: include_bytes!("spirv/tiles.spv"),
    spans: include_bytes!("spirv/spans.spv"),
    march_vertex: include_bytes!("spirv/march-vertex.spv"),
    march: include_bytes!("spirv/march.spv"),
    march_depth: include_bytes!("spirv/march-depth.spv"),
    march_open: Some([include_bytes!("spirv/march-open.spv"), include_bytes!("spirv/march-open-depth.spv")]),
};

const MOTION: Shaders = Shaders {
    march: include_bytes!("spirv/march-motion.spv"),
    march_depth: include_bytes!("spirv/march-motion-depth.spv"),
    march_open: None,
    ..GATHER
};

const ANY_VIEW: Shaders = Shaders {
    tiles: include_bytes!("spirv/any-view-tiles.spv"),
    spans: include_bytes!("spirv/any-view-spans.spv"),
    march_vertex: SCREEN,
    march: include_bytes!("spirv/any-view-march.spv"),
    march_depth: include_bytes!("spirv/any-view-march-depth.spv"),
    march_open: None,
};

static SHADERS: PerKind<Shaders> = PerKind { gather: GATHER, motion: MOTION, any_view: ANY_VIEW };

impl Shaders {
    pub(super) fn of<W: WarpKind>() -> &'static Shaders {
        W::of(&SHADERS)
    }

    /// Returns the last pass.
    pub(super) fn march(&self, options: &Options) -> Result<&'static [u8], VulkanError> {
        match options.holes {
            Holes::Filled if options.depth_format.is_some() => Ok(self.march_depth),
            Holes::Filled => Ok(self.march),
            Holes::Open(mark) => {
                let open = self.march_open.ok_or(VulkanError::Holes("only Gather can; fill them"))?;
                Ok(open[usize::from(mark == HoleMark::Stencil)])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use yoro_test_support::compiled::{self, Compiled, Source};
    use yoro_test_support::modules::{MODULES, Module};

    /// SPIR-V for Vulkan 1.0, optimized for size, without names and line numbers.
    const ARGUMENTS: [&str; 3] = ["-V", "-Os", "-g0"];

    fn source((name, file, macros): &Module) -> Source {
        let mut defines = vec![("UNIFORM_BLOCK", "layout(push_constant, std140)".to_owned())];
        defines.extend(macros.iter().map(|name| (*name, String::new())));
        let text = yoro_shaders::assemble(file, "310 es", &defines).unwrap().text;
        Source { name, vertex: file.ends_with(".vert"), text }
    }

    #[test]
    fn modules_are_compiled_from_the_present_shaders() {
        let compiled = Compiled {
            folder: Path::new(env!("CARGO_MANIFEST_DIR")).join("src/vulkan/spirv"),
            ending: "spv",
            compiler: compiled::glslang(&ARGUMENTS),
            command: "cargo xtask maintain renew",
            compile: |source: &Source| compiled::spirv(source, &ARGUMENTS),
        };
        let sources = MODULES.each_ref().map(source);
        if std::env::var_os("YORO_BLESS_SHADERS").is_some() {
            compiled.renew(&sources).unwrap();
        }
        compiled.check(&sources).unwrap();
    }
}
