//! Synthesis on OpenGL: from two textures of one eye to a framebuffer with the other eye.

mod any_view;
mod gather;
mod layers;
mod preserve;

use std::rc::Rc;

use super::edges::Edges;
use super::history::Strips;
use super::uniforms::{Places, Uniforms, tiles};
use crate::eyes::Warp;
use yoro_gl::{Context, Destination, Filter, Format, GlError, Program, RenderTarget, ShaderSource, Touched};

pub use any_view::AnyView;
pub use gather::Gather;
#[doc(hidden)]
pub use gather::GatherVariant;
pub use layers::Layers;
use preserve::Preserving;

/// The texture unit of a history's colour, which is filtered.
const HISTORY_COLOR_UNIT: u32 = 5;

/// The outputs of a pipeline besides colour, and their encoding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Writes the synthesized eye's depth, in the source's encoding, to the target's depth attachment, for transparent
    /// objects, near objects and compositors.
    pub depth: bool,
    /// Writes the source map to colour attachment 1 ([`yoro_gl::Format::R32Ui`]). Bit 31 marks a hole; the other bits
    /// are the source column of the pixel, or of the edge that it was filled from, in 1/65536 pixel. Columns are
    /// counted from the left for a synthesized left eye and from the right for a right eye.
    /// [`SourceMapEntry`](super::SourceMapEntry) decodes an entry.
    pub source_map: bool,
    /// Encodes colour for an sRGB target. Set it if source and target are both sRGB textures
    /// ([`yoro_gl::Format::Srgb8Alpha8`]), which are decoded when they are sampled. Otherwise values are stored as they
    /// are sampled, without encoding. OpenGL ES without `EXT_sRGB_write_control` always encodes for sRGB targets.
    pub srgb: bool,
}

impl Outputs {
    /// Returns the number of the target's colour attachments.
    pub fn draw_buffers(self) -> u32 {
        1 + u32::from(self.source_map)
    }

    /// Returns the preprocessor defines that select these outputs in the last pass of a pipeline.
    pub fn defines(self) -> Vec<(&'static str, String)> {
        defines([("WRITE_DEPTH", self.depth), ("SOURCE_MAP", self.source_map)])
    }
}

/// The rendered eye, as GL names of 2-D textures, or arrays of them, of the same size. The textures' filters, wrapping,
/// compare mode and samplers do not matter.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// Colour, in any filterable format and any encoding; all four channels are synthesized. For kinds other than
    /// [`Edges::Hard`] it is resolved, with values from 0 to 1.
    pub color: glow::Texture,
    /// Depth: a depth texture, a depth-stencil texture whose depth is sampled, or a float texture. A multisample
    /// texture for [`Edges::Multisample`].
    pub depth: glow::Texture,
    /// For [`Edges::Multisample`], the multisample texture that the colour was resolved from, if it still exists.
    pub samples: Option<glow::Texture>,
    /// The place of the source in its textures, for a pipeline with [`SynthesisOptions::parts`].
    pub part: Option<Part>,
    /// The layer of both textures, for a pipeline with [`SynthesisOptions::array_textures`]; 0 otherwise.
    pub layer: u32,
    /// Earlier renders of the other eye, for a pipeline with [`SynthesisOptions::history`].
    pub history: Option<History>,
}

/// A rendered image of the synthesized eye, from this frame or earlier ones. It shows what is in disocclusions.
#[derive(Clone, Copy, Debug)]
pub struct History {
    /// Colour in the encoding of the source's: the input of synthesis, without what is drawn over both eyes afterwards.
    pub color: glow::Texture,
    /// Depth, of the same size, one value per pixel, with the planes and encoding of the source's.
    pub depth: glow::Texture,
    /// The views of its strips.
    pub strips: Strips,
}

impl Source {
    /// Returns a source that is the whole of two textures, without sample colours.
    pub fn new(color: glow::Texture, depth: glow::Texture) -> Source {
        Source { color, depth, samples: None, part: None, layer: 0, history: None }
    }

    /// Returns the place of the source, of this size, in its textures, and that of the target.
    fn places(&self, size: [u32; 2], target: &Destination, part: bool) -> Places {
        let whole = Part { origin: [0, 0], image_size: size };
        let Part { origin, image_size } = self.part.filter(|_| part).unwrap_or(whole);
        Places { source_origin: origin, image_size, target_origin: target.origin, part }
    }
}

/// A rectangle of the source's size in larger textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Lower left corner in pixels.
    pub origin: [u32; 2],
    /// Width and height of the textures in pixels.
    pub image_size: [u32; 2],
}

/// What a call does to the context's state, as listed in the table of [`Synthesis`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlState {
    /// Leaves some state changed. This is cheapest, for hosts that set all the state they draw with.
    #[default]
    Leave,
    /// Queries all state first and restores it at the end. This takes 3 to 4 microseconds per call on llvmpipe
    /// (docs/library.md has the measurement). A driver that works in its own thread may have to be waited for.
    Preserve,
}

/// A pipeline that synthesizes the other eye.
///
/// The context must be current on the calling thread. The picture does not depend on the context's state: a call sets
/// all the state that it relies on. Afterwards, the state is as in the table with [`GlState::Leave`], and as before the
/// call with [`GlState::Preserve`]. State that is not in the table is neither read nor changed, and state that a
/// context lacks, by version or extension, is neither set nor queried.
///
/// | state | set to | afterwards |
/// |---|---|---|
/// | program | the passes' | changed; none once the pipeline is dropped |
/// | vertex array | one without attributes | changed |
/// | draw and read framebuffer | the target's | changed |
/// | viewport (the first; with `OES_viewport_array` all) | the target's rectangle | changed |
/// | 2-D texture of units 0 to 3, of 0 to 4 other than with hard edges, of 0 to 5 with a history | depth, colour, intermediate | changed |
/// | multisample texture of units 0 and 3, with multisampled sources | depth, colour | changed |
/// | array texture of units 0 and 1, for sources that are layers | depth, colour | changed |
/// | sampler object of units 0 to 5 | yoro's own | none |
/// | active unit | 0 to 5 | changed |
/// | scissor test (as the viewport), stencil and depth test, face culling | off; depth test on for the target if depth is written | off |
/// | depth function, depth mask, depth range (as the viewport) | `ALWAYS`, on, 0 to 1 | as set |
/// | blending and colour mask, of draw buffer 0 and, with a source map or other than with hard edges, 1 (of all draw buffers before OpenGL ES 3.2) | off; all channels | as set |
/// | dithering, polygon offset for filling, rasterizer discard, primitive restart (fixed index) | off | off |
/// | alpha to coverage, sample coverage; sample mask (ES 3.1) | off | off |
/// | clip distances (`EXT_clip_cull_distance`, desktop), depth bounds test (`EXT_depth_bounds_test`) | off | off |
/// | sRGB encoding of what is written (`EXT_sRGB_write_control`, desktop) | off, or on if asked for | as set |
/// | primitive restart, logic operation, polygon smoothing, alpha to one (desktop) | off | off |
/// | polygon mode (desktop) | fill | fill |
/// | alpha test, polygon stipple (compatibility profile) | off | off |
///
/// Not touched: buffers bound to any target (vertex, uniform, storage, pixel pack and unpack), pixel store, scissor
/// box, blend function and equation, stencil function, clear values, other texture targets and units. A pending error
/// stays, except in browsers, where allocating buffers reads GL's error flag. A program that the host deleted while it
/// was current is destroyed, as GL specifies, when another one becomes current; `Preserve` then leaves no program
/// current.
///
/// The host ensures the rest: transform feedback and conditional rendering are inactive, the shading rate is one
/// fragment per pixel, the target's draw buffers are its colour attachments from 0 on, and neither texture of the
/// source is attached to it. An active occlusion query counts the passes' fragments.
pub trait Synthesis {
    /// Allocates intermediate buffers for images of these sizes; this binds framebuffers, and a 2-D texture to the
    /// active unit. Costs nothing if the sizes have not changed. [`Synthesis::synthesize`] calls it.
    ///
    /// # Errors
    /// [`GlError`] if the sizes are beyond the driver's limits.
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError>;

    /// Synthesizes the other eye into a rectangle of [`Warp::target_size`] and overwrites all of it. The framebuffer's
    /// attachments must fit the pipeline's [`Outputs`].
    ///
    /// # Errors
    /// Those of [`Synthesis::prepare`].
    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError>;
}

/// Options of a pipeline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SynthesisOptions {
    /// The kind of source.
    pub edges: Edges,
    /// The effect of calls on the host's GL state.
    pub gl_state: GlState,
    /// True if sources may be parts of their textures ([`Source::part`]) and change their size from frame to frame, as
    /// with dynamic resolution. Buffers then only grow, so that no frame allocates after one of the largest size.
    pub parts: bool,
    /// True if colour and depth are layers of array textures, as with multiview ([`Source::layer`]). Not supported with
    /// [`Edges::Multisample`].
    pub array_textures: bool,
    /// True if sources may have a history ([`Source::history`]).
    pub history: bool,
}

impl SynthesisOptions {
    /// Returns the preprocessor macro for a last pass that uses a history.
    fn last_pass_defines(&self) -> Vec<(&'static str, String)> {
        defines([("HISTORY", self.history)])
    }

    fn history_binding(&self, gl: &Rc<Context>) -> Result<Option<HistoryBinding>, GlError> {
        self.history.then(|| HistoryBinding::new(gl)).transpose()
    }

    /// Returns the preprocessor macros that select this kind of source.
    fn defines(&self) -> Vec<(&'static str, String)> {
        defines([("SOURCE_PARTS", self.parts), ("SOURCE_LAYERS", self.array_textures)])
    }

    /// Binds a texture of the source: an array texture with [`SynthesisOptions::array_textures`]. The program must be
    /// current.
    fn bind<'a>(&self, program: &'a Program, name: &str, unit: u32, texture: glow::Texture) -> &'a Program {
        if self.array_textures {
            program.texture_array(name, unit, texture)
        } else {
            program.texture(name, unit, texture)
        }
    }

    /// Binds depth and colour of the source to units 0 and 1. The program must be current.
    fn bind_source(&self, program: &Program, source: Source) {
        self.bind(program, "depth_map", 0, source.depth);
        self.bind(program, "color_map", 1, source.color);
        program.set("source_layer", source.layer as i32);
    }

    /// Returns a buffer's new size: the needed one, or with parts at least the current one, too.
    fn buffer_size(&self, now: [u32; 2], needed: [u32; 2]) -> [u32; 2] {
        if self.parts { [0, 1].map(|i| now[i].max(needed[i])) } else { needed }
    }
}

/// Returns the size in bytes of the buffers that [`Synthesis::prepare`] allocates for these sizes, for planning before
/// a pipeline exists. Drivers add padding.
pub fn buffer_bytes(edges: Edges, warp: &Warp) -> u64 {
    let area = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
    let maps: u64 = map_sizes(warp).map(area).iter().sum();
    match edges {
        Edges::Hard => 16 * maps,
        // The surfaces of each source pixel (4 bytes), and the colour of the back one.
        _ => 4 * maps + 8 * area(warp.source_size),
    }
}

/// Compiles the pipeline: [`Gather`] for hard edges, [`Layers`] for the others. Changes the same state as
/// [`Synthesis::prepare`], or none with [`GlState::Preserve`].
///
/// # Errors
/// [`GlError::Unsupported`] for [`Edges::Multisample`] without OpenGL ES 3.1 or with
/// [`SynthesisOptions::array_textures`]; [`GlError::Shader`] if the driver refuses a shader.
pub fn create(
    gl: &Rc<Context>,
    options: &SynthesisOptions,
    outputs: Outputs,
) -> Result<Box<dyn Synthesis>, GlError> {
    let pipeline = || -> Result<Box<dyn Synthesis>, GlError> {
        Ok(match options.edges {
            Edges::Hard => Box::new(Gather::with_options(gl, outputs, options)?),
            _ => Box::new(Layers::with_options(gl, outputs, options)?),
        })
    };
    let draw_buffers = match options.edges {
        Edges::Hard => outputs.draw_buffers(),
        _ => layers::DRAW_BUFFERS,
    };
    match options.gl_state {
        GlState::Leave => pipeline(),
        GlState::Preserve => {
            let touched = Touched { draw_buffers, arrays: options.array_textures };
            Ok(Box::new(Preserving::new(gl, touched, pipeline)?))
        }
    }
}

/// Returns those preprocessor macros that are wanted, without values.
fn defines<const N: usize>(wanted: [(&'static str, bool); N]) -> Vec<(&'static str, String)> {
    wanted.into_iter().filter(|(_, wanted)| *wanted).map(|(name, _)| (name, String::new())).collect()
}

/// Returns the sizes of the maps of tiles and of spans.
fn map_sizes(warp: &Warp) -> [[u32; 2]; 2] {
    [warp.source_size, [warp.target_size[0], warp.source_size[1]]].map(tiles)
}

/// Sets the uniforms and textures that `include/warp.glsl` declares, for a pass of a pipeline. Uses texture units 0 and
/// 1. The program must be current.
pub fn set_source(program: &Program, source: Source, uniforms: &Uniforms) {
    program.texture("depth_map", 0, source.depth).texture("color_map", 1, source.color);
    uniforms.set(program);
}

/// The texture that a pipeline with [`SynthesisOptions::history`] binds for sources without a history.
struct HistoryBinding {
    nothing: RenderTarget,
}

impl HistoryBinding {
    fn new(gl: &Rc<Context>) -> Result<HistoryBinding, GlError> {
        Ok(HistoryBinding {
            nothing: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Nearest)], None)?,
        })
    }

    /// Sets what `include/history.glsl` declares. Depth is bound to `depth_unit`, which must not filter. The program
    /// must be current.
    fn set(&self, program: &Program, history: Option<History>, depth_unit: u32) {
        let nothing = self.nothing.color(0).raw();
        let none = History { color: nothing, depth: nothing, strips: Strips::NONE };
        let History { color, depth, strips } = history.unwrap_or(none);
        program.texture("history_depth", depth_unit, depth);
        program.texture("history_color", HISTORY_COLOR_UNIT, color);
        strips.set(program);
    }
}

/// Returns the shaders of a pipeline's last pass.
fn march_source(fragment: &str) -> ShaderSource<'_> {
    ShaderSource::Raster { vertex: "synthesis/march.vert", fragment }
}

/// Binds the target and draws the last pass of a pipeline into it.
pub fn draw_target(gl: &Context, target: &Destination, outputs: Outputs) {
    gl.overwrite(target, outputs.draw_buffers() as usize, outputs.depth);
    gl.set_depth_write(outputs.depth);
    gl.draw_screen();
    gl.set_depth_write(false);
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_guide_lists_the_state() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../docs/library.md");
        // The published package does not contain this file.
        let Ok(guide) = std::fs::read_to_string(path) else { return };
        let rows = include_str!("mod.rs").lines().filter_map(|line| line.strip_prefix("/// | "));
        let rows: Vec<_> = rows.filter(|row| !row.starts_with("state |")).collect();
        assert!(rows.len() > 15, "the table of `Synthesis`");
        for row in rows {
            assert!(guide.contains(&format!("\n| {row}\n")), "docs/library.md has no row {row}");
        }
    }
}
