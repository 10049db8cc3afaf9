//! The list of precompiled shader modules, in SPIR-V here and in WGSL in yoro-wgpu, for the tests that compile them.

/// The name of a compiled module, its file in `yoro-shaders`, and the macros it is compiled with.
pub type Module = (&'static str, &'static str, &'static [&'static str]);

const MARCH: &str = "synthesis/gather/march.frag";
const LAYER_MARCH: &str = "synthesis/layers/march.frag";
const SPANS: &str = "synthesis/gather/spans.frag";
const SPLIT: &str = "synthesis/layers/split.frag";
const TILES: &str = "synthesis/gather/tiles.frag";
const ANY_VIEW: &str = "synthesis/any_view/march.frag";
pub const MODULES: [Module; 31] = [
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
