//! The shaders of the passes as WGSL, compiled in advance from the files of `yoro-shaders` by `cargo xtask maintain wgsl`.

use yoro::synthesis::{Edges, PassSet};

pub(crate) const SCREEN: &str = include_str!("wgsl/screen.wgsl");

/// Returns the first pass for resolved colour, or `None` for hard edges.
pub(crate) fn split(edges: Edges, samples: u32) -> Option<&'static str> {
    match (edges, samples) {
        (Edges::Hard, _) => None,
        (Edges::Nearest, _) => Some(include_str!("wgsl/split-nearest.wgsl")),
        (Edges::Sample, _) => Some(include_str!("wgsl/split-sample.wgsl")),
        (Edges::Multisample, 2) => Some(include_str!("wgsl/split-multisample-two.wgsl")),
        (Edges::Multisample, _) => Some(include_str!("wgsl/split-multisample.wgsl")),
    }
}

/// Returns the first pass for depth and colour of all samples.
pub(crate) fn split_samples(samples: u32) -> &'static str {
    match samples {
        2 => include_str!("wgsl/split-samples-two.wgsl"),
        _ => include_str!("wgsl/split-samples.wgsl"),
    }
}

/// Returns the pass that finds the bounds of tiles.
pub(crate) fn tiles(edges: Edges, passes: PassSet) -> &'static str {
    match (edges, passes) {
        (_, PassSet::AnyView) => include_str!("wgsl/any-view-tiles.wgsl"),
        (Edges::Hard, PassSet::GatherOnCpu) => include_str!("wgsl/tiles.wgsl"),
        (Edges::Hard, PassSet::GatherOnGpu) => include_str!("wgsl/tiles-short.wgsl"),
        _ => include_str!("wgsl/layer-tiles.wgsl"),
    }
}

/// Returns the pass that finds the part of the source that each tile of the target must search.
pub(crate) fn spans(edges: Edges, passes: PassSet) -> &'static str {
    match (edges, passes) {
        (_, PassSet::AnyView) => include_str!("wgsl/any-view-spans.wgsl"),
        (Edges::Hard, PassSet::GatherOnGpu) => include_str!("wgsl/spans-short.wgsl"),
        _ => include_str!("wgsl/spans.wgsl"),
    }
}

/// Returns the vertex shader of the last pass.
pub(crate) fn march_vertex(passes: PassSet) -> &'static str {
    match passes {
        PassSet::GatherOnCpu | PassSet::GatherOnGpu => include_str!("wgsl/march-vertex.wgsl"),
        PassSet::AnyView => SCREEN,
    }
}

/// Returns the last pass, which optionally writes depth and looks up disocclusions in a history.
pub(crate) fn march(edges: Edges, passes: PassSet, depth: bool, history: bool) -> &'static str {
    /// Selects one of the four modules for a kind of source.
    macro_rules! of {
        ($name:literal) => {
            match (depth, history) {
                (false, false) => include_str!(concat!("wgsl/", $name, ".wgsl")),
                (true, false) => include_str!(concat!("wgsl/", $name, "-depth.wgsl")),
                (false, true) => include_str!(concat!("wgsl/", $name, "-history.wgsl")),
                (true, true) => include_str!(concat!("wgsl/", $name, "-depth-history.wgsl")),
            }
        };
    }
    match (edges, passes) {
        (_, PassSet::AnyView) if depth => include_str!("wgsl/any-view-march-depth.wgsl"),
        (_, PassSet::AnyView) => include_str!("wgsl/any-view-march.wgsl"),
        (Edges::Hard, PassSet::GatherOnCpu) => of!("march"),
        (Edges::Hard, PassSet::GatherOnGpu) => of!("march-short"),
        (Edges::Multisample, _) => of!("layer-march-multisample"),
        _ => of!("layer-march"),
    }
}

#[cfg(test)]
mod tests;
