//! The list of precompiled shader modules, in SPIR-V here and in WGSL in yoro-wgpu, for the tests that compile them.

/// The name of a compiled module, its file in `yoro-shaders`, and the macros it is compiled with.
pub type Module = (&'static str, &'static str, &'static [&'static str]);

const MARCH: &str = "synthesis/gather/march.frag";
const ANY_VIEW: &str = "synthesis/any_view/march.frag";
pub const MODULES: [Module; 15] = [
    ("any-view-march", ANY_VIEW, &[]),
    ("any-view-march-depth", ANY_VIEW, &["WRITE_DEPTH"]),
    ("any-view-spans", "synthesis/any_view/spans.frag", &[]),
    ("any-view-tiles", "synthesis/any_view/tiles.frag", &[]),
    ("compose", "synthesis/compose.frag", &[]),
    ("march", MARCH, &[]),
    ("march-depth", MARCH, &["WRITE_DEPTH"]),
    ("march-motion", MARCH, &["MOTION"]),
    ("march-motion-depth", MARCH, &["MOTION", "WRITE_DEPTH"]),
    ("march-open", MARCH, &["OPEN_HOLES"]),
    ("march-open-depth", MARCH, &["OPEN_HOLES", "WRITE_DEPTH"]),
    ("march-vertex", "synthesis/march.vert", &[]),
    ("screen", "screen.vert", &[]),
    ("spans", "synthesis/gather/spans.frag", &[]),
    ("tiles", "synthesis/gather/tiles.frag", &[]),
];
