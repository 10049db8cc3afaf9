//! The shaders of the passes as SPIR-V, compiled from the files of `yoro-shaders` by `cargo xtask maintain spirv`.

use crate::synthesis::{Edges, PassSet};

pub(super) const SCREEN: &[u8] = include_bytes!("spirv/screen.spv");
/// The first pass, for depth and colour of all samples.
pub(super) const SPLIT_SAMPLES: &[u8] = include_bytes!("spirv/split-samples.spv");

/// Returns the first pass, for resolved colour; `None` for hard edges.
pub(super) fn split(edges: Edges) -> Option<&'static [u8]> {
    match edges {
        Edges::Hard => None,
        Edges::Nearest => Some(include_bytes!("spirv/split-nearest.spv")),
        Edges::Sample => Some(include_bytes!("spirv/split-sample.spv")),
        Edges::Multisample => Some(include_bytes!("spirv/split-multisample.spv")),
    }
}

/// Returns the pass that finds the bounds of each tile.
pub(super) fn tiles(edges: Edges, passes: PassSet) -> &'static [u8] {
    match (edges, passes) {
        (_, PassSet::AnyView) => include_bytes!("spirv/any-view-tiles.spv"),
        (Edges::Hard, PassSet::GatherOnCpu) => include_bytes!("spirv/tiles.spv"),
        (Edges::Hard, PassSet::GatherOnGpu) => include_bytes!("spirv/tiles-short.spv"),
        _ => include_bytes!("spirv/layer-tiles.spv"),
    }
}

/// Returns the pass that finds the source columns to search for each tile of the target.
pub(super) fn spans(edges: Edges, passes: PassSet) -> &'static [u8] {
    match (edges, passes) {
        (_, PassSet::AnyView) => include_bytes!("spirv/any-view-spans.spv"),
        (Edges::Hard, PassSet::GatherOnGpu) => include_bytes!("spirv/spans-short.spv"),
        _ => include_bytes!("spirv/spans.spv"),
    }
}

/// Returns the vertex shader of the last pass.
pub(super) fn march_vertex(passes: PassSet) -> &'static [u8] {
    match passes {
        PassSet::GatherOnCpu | PassSet::GatherOnGpu => include_bytes!("spirv/march-vertex.spv"),
        PassSet::AnyView => SCREEN,
    }
}

/// Returns the last pass, with or without writing depth and using a history.
pub(super) fn march(edges: Edges, passes: PassSet, depth: bool, history: bool) -> &'static [u8] {
    /// Selects among the four modules for one kind of source.
    macro_rules! of {
        ($name:literal) => {
            match (depth, history) {
                (false, false) => include_bytes!(concat!("spirv/", $name, ".spv")),
                (true, false) => include_bytes!(concat!("spirv/", $name, "-depth.spv")),
                (false, true) => include_bytes!(concat!("spirv/", $name, "-history.spv")),
                (true, true) => include_bytes!(concat!("spirv/", $name, "-depth-history.spv")),
            }
        };
    }
    match (edges, passes) {
        (_, PassSet::AnyView) if depth => include_bytes!("spirv/any-view-march-depth.spv"),
        (_, PassSet::AnyView) => include_bytes!("spirv/any-view-march.spv"),
        (Edges::Hard, PassSet::GatherOnCpu) => of!("march"),
        (Edges::Hard, PassSet::GatherOnGpu) => of!("march-short"),
        (Edges::Multisample, _) => of!("layer-march-multisample"),
        _ => of!("layer-march"),
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
            command: "cargo xtask maintain spirv",
            compile: |source: &Source| compiled::spirv(source, &ARGUMENTS),
        };
        let sources = MODULES.each_ref().map(source);
        if std::env::var_os("YORO_BLESS_SPIRV").is_some() {
            compiled.renew(&sources).unwrap();
        }
        compiled.check(&sources).unwrap();
    }
}
