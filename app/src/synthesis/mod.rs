//! Colour and depth of one eye in, the other eye out.
//!
//! Nothing here knows of scenes, renderers or windows: a pipeline takes two GL textures, a
//! [`Warp`] and a framebuffer. `app/examples/engine.rs` shows it in a foreign engine.
//!
//! | pipeline | passes | needs |
//! |---|---|---|
//! | [`Gather`] | tile bounds, tile spans, march: fragment shaders | ES 3.0 |
//! | [`Rowgroup`] | scatter by one workgroup a row (compute), resolve | ES 3.1 |
//! | [`Paper`] | Algorithms 1 to 3: fragment, compute per row, fragment | ES 3.1 |

mod gather;
mod near_field;
mod offline;
mod paper;
#[cfg(test)]
mod reference;
mod rowgroup;
#[cfg(all(test, feature = "desktop"))]
mod tests;

use std::rc::Rc;

use glam::{IVec2, Vec2};

use crate::eyes::{DepthConvention, Eye, Warp};
use crate::gl::{Context, Destination, GlError, Program, RasterState};

pub use gather::Gather;
pub use near_field::{FrameMode, NearFieldPolicy};
pub use offline::{Offline, SynthesizedImage};
pub use paper::{ImBufferSize, Paper, PaperOptions, ParseImBufferSizeError};
pub use rowgroup::Rowgroup;

/// Bit of a source map entry that marks a hole.
pub const SOURCE_MAP_HOLE: u32 = 1 << 31;
/// Source map entries count columns in this fraction of a pixel.
pub const SOURCE_MAP_FIXED: f32 = 65536.0;

/// Which pipeline synthesizes the other eye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "desktop", derive(clap::ValueEnum))]
pub enum Pipeline {
    /// Fragment shaders that march along the source row.
    #[default]
    Gather,
    /// One compute workgroup per row.
    Rowgroup,
    /// Algorithms 1 to 3 of the paper.
    Paper,
}

impl Pipeline {
    /// All pipelines, the default first.
    pub const ALL: [Pipeline; 3] = [Pipeline::Gather, Pipeline::Rowgroup, Pipeline::Paper];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Pipeline::Gather => "gather",
            Pipeline::Rowgroup => "rowgroup",
            Pipeline::Paper => "paper",
        }
    }
}

/// What a pipeline writes besides colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Depth of the synthesized eye, in the source's encoding, to the target's depth attachment: for
    /// transparent objects, near objects and compositors.
    pub depth: bool,
    /// The source map, to colour attachment 1 ([`crate::gl::Format::R32Ui`]): bit 31 marks a hole, the other bits are the
    /// source column of the pixel (or of the edge it was filled from) in 1/65536 pixel. [`SourceMapEntry`]
    /// decodes it. The column is counted from the left for a synthesized left eye and from the right for a
    /// right eye.
    pub source_map: bool,
}

/// The rendered eye: GL names of two textures of the same size.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// Colour, in any filterable format and any encoding; all four channels are carried over. Sampled with the
    /// texture's own filter, which should be linear and clamped to the edge.
    pub color: glow::Texture,
    /// Depth: a depth texture (compare mode off) or a float texture, nearest filter.
    pub depth: glow::Texture,
}

/// A way to synthesize the other eye.
pub trait Synthesis {
    /// Gets ready for images of these sizes: allocates intermediate buffers. Costs nothing when the sizes are
    /// the same as before; [`Synthesis::synthesize`] calls it.
    ///
    /// # Errors
    /// [`GlError`] when the sizes are beyond the driver's limits.
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError>;

    /// Synthesizes the other eye into a rectangle of [`Warp::target_size`], all of which is overwritten; the
    /// framebuffer's attachments fit the pipeline's [`Outputs`]. Leaves the target bound and blending, depth
    /// test, scissor test and face culling off.
    ///
    /// # Errors
    /// As [`Synthesis::prepare`].
    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError>;
}

/// Settings of all pipelines.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct SynthesisOptions {
    /// Which pipeline.
    pub pipeline: Pipeline,
    /// Knobs of the paper's pipeline.
    pub paper: PaperOptions,
}

/// Compiles a pipeline.
///
/// # Errors
/// [`GlError::Unsupported`] for a compute pipeline without OpenGL ES 3.1.
pub fn create(
    gl: &Rc<Context>,
    options: &SynthesisOptions,
    outputs: Outputs,
) -> Result<Box<dyn Synthesis>, GlError> {
    Ok(match options.pipeline {
        Pipeline::Gather => Box::new(Gather::new(gl, outputs)?),
        Pipeline::Rowgroup => Box::new(Rowgroup::new(gl, outputs)?),
        Pipeline::Paper => Box::new(Paper::new(gl, outputs, options.paper)?),
    })
}

/// One decoded entry of a source map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SourceMapEntry {
    /// No source pixel is seen here: the colour was filled in.
    pub hole: bool,
    /// Column in the source image, counted from the left, with pixel centres at whole numbers: 0 is the centre
    /// of the first pixel.
    pub column: f32,
    /// Displacement in pixels, `target column - source column`, both from the left.
    pub displacement: f32,
}

impl SourceMapEntry {
    /// Decodes the entry at target column `x`, counted from the left.
    pub fn decode(entry: u32, x: u32, warp: &Warp) -> SourceMapEntry {
        let forward = (entry & !SOURCE_MAP_HOLE) as f32 / SOURCE_MAP_FIXED;
        let column = match warp.target_eye {
            Eye::Left => forward,
            Eye::Right => (warp.source_size[0] - 1) as f32 - forward,
        };
        SourceMapEntry { hole: entry & SOURCE_MAP_HOLE != 0, column, displacement: x as f32 - column }
    }
}

/// The disparity law in forward columns (`include/warp.glsl`): mirrored for the right eye, so that a larger
/// displacement always means nearer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ForwardLaw {
    offset: f64,
    scale: f64,
    mirrored: bool,
    far: f64,
    near: f64,
}

impl ForwardLaw {
    fn new(warp: &Warp) -> ForwardLaw {
        let mirrored = warp.target_eye == Eye::Right;
        let (offset, scale) = if mirrored {
            (warp.target_size[0] as f64 - warp.source_size[0] as f64 - warp.law.offset, -warp.law.scale)
        } else {
            (warp.law.offset, warp.law.scale)
        };
        let (near, far) = match warp.convention {
            DepthConvention::Standard => (0.0, 1.0),
            DepthConvention::Reversed => (1.0, 0.0),
        };
        ForwardLaw { offset, scale, mirrored, far: offset + scale * far, near: offset + scale * near }
    }
}

/// Sets the uniforms and textures that `include/warp.glsl` declares. Texture units 0 and 1.
fn set_warp(program: &Program, source: Source, warp: &Warp, origin: [u32; 2]) {
    let law = ForwardLaw::new(warp);
    let size = |s: [u32; 2]| IVec2::new(s[0] as i32, s[1] as i32);
    program
        .texture("depth_map", 0, source.depth)
        .texture("color_map", 1, source.color)
        .set("source_size", size(warp.source_size))
        .set("target_size", size(warp.target_size))
        .set("law", Vec2::new(law.offset as f32, law.scale as f32))
        .set("mirrored", law.mirrored)
        .set("row_offset", warp.row_offset)
        .set("target_origin", IVec2::from(origin.map(|n| n as i32)))
        .set("far_displacement", law.far as f32)
        .set("near_displacement", law.near as f32);
}

/// Binds the target and draws the pass that writes it.
fn draw_target(gl: &Context, target: &Destination, outputs: Outputs) {
    gl.set_raster_state(if outputs.depth { &RasterState::SCREEN_DEPTH } else { &RasterState::SCREEN });
    gl.bind_framebuffer(target.framebuffer, target.origin, target.size);
    gl.draw_screen();
    gl.set_raster_state(&RasterState::SCREEN);
}

/// The defines that select a shader's outputs.
fn output_defines(outputs: Outputs) -> Vec<(&'static str, String)> {
    let mut defines = Vec::new();
    if outputs.depth {
        defines.push(("WRITE_DEPTH", String::new()));
    }
    if outputs.source_map {
        defines.push(("SOURCE_MAP", String::new()));
    }
    defines
}
