//! What each pass reads, and what of its tile it loads and stores. A test compares it with what drivers are told.
//!
//! Passes that follow one another in the same framebuffer share a tile: the first of them alone may load, and what any of
//! them stores is stored once, at the end.

/// A part of a tile that is read from memory, or written to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Colour of one sample a pixel, or the average of several.
    Color,
    /// Depth of one sample a pixel.
    Depth,
    /// Several samples a pixel. They are stored only where shaders read them ([`super::DepthResolve::Samples`]).
    Samples,
}

/// A pass, by the name that timers and debuggers show.
#[derive(Clone, Copy, Debug)]
pub struct Pass {
    /// The name.
    pub name: &'static str,
    /// The uniforms of the textures that it reads; `copied` for the image that it copies or averages.
    pub reads: &'static [&'static str],
    /// What it may load if it is the first in its tile.
    pub loads: &'static [Part],
    /// What it may leave in memory.
    pub stores: &'static [Part],
}

const COLOR: &[Part] = &[Part::Color];
const DEPTH: &[Part] = &[Part::Depth];
const BOTH: &[Part] = &[Part::Color, Part::Depth];
const ALL: &[Part] = &[Part::Color, Part::Depth, Part::Samples];

const fn pass(
    name: &'static str,
    reads: &'static [&'static str],
    loads: &'static [Part],
    stores: &'static [Part],
) -> Pass {
    Pass { name, reads, loads, stores }
}

/// The passes of the renderer and of the stereo methods.
pub const PASSES: &[Pass] = &[
    pass("shadow", &["diffuse_map"], &[], DEPTH),
    pass(
        "surfaces",
        &[
            "diffuse_map",
            "specular_map",
            "emissive_map",
            "normal_map",
            "shadow_map",
            "color_map",
            "depth_map",
            "dominant_color",
        ],
        &[],
        ALL,
    ),
    pass(
        "transparent",
        &["diffuse_map", "specular_map", "emissive_map", "normal_map", "shadow_map"],
        &[],
        ALL,
    ),
    pass(
        "near objects",
        &["diffuse_map", "specular_map", "emissive_map", "normal_map", "shadow_map"],
        &[],
        BOTH,
    ),
    pass("carry", &[], &[], &[]),
    pass("resolve", &["color_map", "depth_map"], &[], BOTH),
    pass("outlines", &["color_map", "depth_map"], &[], COLOR),
    pass("bloom", &["source"], COLOR, COLOR),
    pass("guessed depth", &["color_map", "depth_map"], &[], DEPTH),
    pass("moving surfaces", &["diffuse_map"], &[], COLOR),
    pass("vectors", &["depth_map", "moving_map"], &[], BOTH),
    pass("motion tiles", &["depth_map"], &[], COLOR),
    pass("motion spans", &["tile_map"], &[], COLOR),
    pass("motion march", &["color_map", "depth_map", "tile_map", "span_map"], &[], BOTH),
    pass("gather tiles", &["depth_map"], &[], COLOR),
    pass("gather spans", &["tile_map"], &[], COLOR),
    pass("gather march", &["color_map", "depth_map", "tile_map", "span_map", "bloom"], &[], BOTH),
    pass("develop", &["color_map", "depth_map", "bloom"], &[], BOTH),
    pass("copy", &["copied"], &[], COLOR),
    pass("depth copy", &["depth_map"], &[], DEPTH),
    pass("near fraction", &["depth_map"], &[], COLOR),
];
