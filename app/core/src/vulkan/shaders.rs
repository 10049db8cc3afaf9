//! The shaders of the passes as SPIR-V, compiled beforehand from the files of `yoro-shaders`: `cargo tools spirv`.

use crate::synthesis::{Edges, PassSet};

pub(super) const SCREEN: &[u8] = include_bytes!("spirv/screen.spv");
/// The first pass for depth and colour of all samples.
pub(super) const SPLIT_SAMPLES: &[u8] = include_bytes!("spirv/split-samples.spv");

/// Returns the first pass for resolved colour; None for hard edges.
pub(super) fn split(edges: Edges) -> Option<&'static [u8]> {
    match edges {
        Edges::Hard => None,
        Edges::Nearest => Some(include_bytes!("spirv/split-nearest.spv")),
        Edges::Sample => Some(include_bytes!("spirv/split-sample.spv")),
        Edges::Multisample => Some(include_bytes!("spirv/split-multisample.spv")),
    }
}

/// Returns the pass that finds the bounds of tiles.
pub(super) fn tiles(edges: Edges, passes: PassSet) -> &'static [u8] {
    match (edges, passes) {
        (_, PassSet::AnyView) => include_bytes!("spirv/any-view-tiles.spv"),
        (Edges::Hard, PassSet::GatherOnCpu) => include_bytes!("spirv/tiles.spv"),
        (Edges::Hard, PassSet::GatherOnGpu) => include_bytes!("spirv/tiles-short.spv"),
        _ => include_bytes!("spirv/layer-tiles.spv"),
    }
}

/// Returns the pass that finds what each tile of the target has to search.
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

/// Returns the last pass, which writes depth or does not, and looks disocclusions up in a history or does not.
pub(super) fn march(edges: Edges, passes: PassSet, depth: bool, history: bool) -> &'static [u8] {
    /// The four modules of a source's kind.
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

    use yoro_tools::compiled::{self, Compiled, Source};

    /// A file in `spirv/` without its ending, the file of `yoro-shaders` that it is made of, and the macros for that.
    type Module = (&'static str, &'static str, &'static [&'static str]);

    const MARCH: &str = "synthesis/gather/march.frag";
    const LAYER_MARCH: &str = "synthesis/layers/march.frag";
    const SPANS: &str = "synthesis/gather/spans.frag";
    const SPLIT: &str = "synthesis/layers/split.frag";
    const TILES: &str = "synthesis/gather/tiles.frag";
    const ANY_VIEW: &str = "synthesis/any_view/march.frag";
    const MODULES: [Module; 31] = [
        ("any-view-march", ANY_VIEW, &[]),
        ("any-view-march-depth", ANY_VIEW, &["WRITE_DEPTH"]),
        ("any-view-spans", "synthesis/any_view/spans.frag", &[]),
        ("any-view-tiles", "synthesis/any_view/tiles.frag", &[]),
        ("layer-march", LAYER_MARCH, &[]),
        ("layer-march-history", LAYER_MARCH, &["HISTORY"]),
        ("layer-march-depth", LAYER_MARCH, &["WRITE_DEPTH"]),
        ("layer-march-depth-history", LAYER_MARCH, &["WRITE_DEPTH", "HISTORY"]),
        ("layer-march-multisample", LAYER_MARCH, &["MULTISAMPLE"]),
        ("layer-march-multisample-history", LAYER_MARCH, &["MULTISAMPLE", "HISTORY"]),
        ("layer-march-multisample-depth", LAYER_MARCH, &["MULTISAMPLE", "WRITE_DEPTH"]),
        ("layer-march-multisample-depth-history", LAYER_MARCH, &["MULTISAMPLE", "WRITE_DEPTH", "HISTORY"]),
        ("layer-tiles", "synthesis/layers/tiles.frag", &[]),
        ("march", MARCH, &["TEXTURE_GATHER"]),
        ("march-history", MARCH, &["TEXTURE_GATHER", "HISTORY"]),
        ("march-depth", MARCH, &["TEXTURE_GATHER", "WRITE_DEPTH"]),
        ("march-depth-history", MARCH, &["TEXTURE_GATHER", "WRITE_DEPTH", "HISTORY"]),
        ("march-short", MARCH, &["TEXTURE_GATHER", "SHORT_WAY"]),
        ("march-short-history", MARCH, &["TEXTURE_GATHER", "SHORT_WAY", "HISTORY"]),
        ("march-short-depth", MARCH, &["TEXTURE_GATHER", "SHORT_WAY", "WRITE_DEPTH"]),
        ("march-short-depth-history", MARCH, &["TEXTURE_GATHER", "SHORT_WAY", "WRITE_DEPTH", "HISTORY"]),
        ("march-vertex", "synthesis/march.vert", &[]),
        ("screen", "screen.vert", &[]),
        ("spans", SPANS, &[]),
        ("spans-short", SPANS, &["SHORT_WAY"]),
        ("split-multisample", SPLIT, &["MULTISAMPLE"]),
        ("split-nearest", SPLIT, &[]),
        ("split-sample", SPLIT, &["FIRST_SAMPLE"]),
        ("split-samples", SPLIT, &["MULTISAMPLE", "SAMPLE_COLORS"]),
        ("tiles", TILES, &["TEXTURE_GATHER"]),
        ("tiles-short", TILES, &["TEXTURE_GATHER", "SHORT_WAY"]),
    ];
    /// Vulkan 1.0's SPIR-V, optimized for size, without names and lines.
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
            command: "cargo tools spirv",
            compile: |source: &Source| compiled::spirv(source, &ARGUMENTS),
        };
        let sources = MODULES.each_ref().map(source);
        if std::env::var_os("YORO_BLESS_SPIRV").is_some() {
            compiled.renew(&sources).unwrap();
        }
        compiled.check(&sources).unwrap();
    }
}
