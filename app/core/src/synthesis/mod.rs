//! Colour and depth of one eye in, the other eye out.
//!
//! Nothing here knows of scenes, renderers or windows: a pipeline takes two GL textures, a
//! [`Warp`] and a framebuffer. `examples/engine.rs` shows it in a foreign engine.
//!
//! | pipeline | passes | needs |
//! |---|---|---|
//! | [`Gather`] | tile bounds, tile spans, march: fragment shaders | ES 3.0 |
//! | [`Layers`] | [`Gather`] of anti-aliased sources: split, tile bounds, tile spans, march: fragment shaders | ES 3.0, multisample depth ES 3.1 |

mod gather;
mod layers;
mod preserve;
mod uniforms;

use std::rc::Rc;

use crate::eyes::{DepthConvention, Eye, Warp};
use crate::gl::{Context, Destination, GlError, Program};

pub use gather::Gather;
#[doc(hidden)]
pub use gather::GatherVariant;
pub use layers::Layers;

#[cfg(feature = "vulkan")]
pub(crate) use uniforms::Places;
pub use uniforms::Uniforms;
pub(crate) use uniforms::tiles;

use preserve::Preserving;

/// Bit of a source map entry that marks a hole.
pub const SOURCE_MAP_HOLE: u32 = 1 << 31;
/// Source map entries count columns in this fraction of a pixel.
pub const SOURCE_MAP_FIXED: f32 = 65536.0;

/// What the source knows of its edges, where a pixel shows more than one surface, and with it what its depth is.
///
/// | | source | synthesized eye |
/// |---|---|---|
/// | [`Edges::Hard`] | one sample per pixel | one surface per pixel; silhouettes blended by where they cross it |
/// | [`Edges::Nearest`], [`Edges::Sample`] | resolved colour, one depth per pixel | anti-aliased; the share of each surface is estimated from colour and depth around |
/// | [`Edges::Multisample`] | resolved colour, depth of all samples | anti-aliased; with the samples' colours, too, nothing is estimated |
///
/// Depth that was averaged over samples belongs to no surface, and gives halos by each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Edges {
    /// One sample per pixel: every pixel shows one surface.
    #[default]
    Hard,
    /// Resolved (anti-aliased) colour; depth of each pixel's nearest sample.
    Nearest,
    /// Resolved colour; depth of each pixel's first sample, as drivers resolve it, or of its middle.
    Sample,
    /// Depth of every sample, in a multisample texture of 2 or 4 samples in the standard pattern; colour resolved, and
    /// optionally of every sample, too ([`Source::samples`]). Needs OpenGL ES 3.1.
    Multisample,
}

impl Edges {
    /// All of them, the default first.
    pub const ALL: [Edges; 4] = [Edges::Hard, Edges::Nearest, Edges::Sample, Edges::Multisample];

    /// Its name in settings.
    pub fn name(self) -> &'static str {
        match self {
            Edges::Hard => "hard",
            Edges::Nearest => "nearest",
            Edges::Sample => "sample",
            Edges::Multisample => "multisample",
        }
    }
}

/// What a pipeline writes besides colour, and how.
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
    /// The source's colour and the target's are both sRGB textures ([`crate::gl::Format::Srgb8Alpha8`]), which sampling
    /// decodes: encode what is written. Without it sRGB encoding is off where the context can switch it, and values
    /// are stored as they are sampled; OpenGL ES without `EXT_sRGB_write_control` always encodes for sRGB targets.
    pub srgb: bool,
}

impl Outputs {
    /// Returns the number of colour attachments that the target has.
    pub fn draw_buffers(self) -> u32 {
        1 + u32::from(self.source_map)
    }

    /// Returns the defines that select a shader's outputs, for the last pass of a pipeline.
    pub fn defines(self) -> Vec<(&'static str, String)> {
        let defines = [("WRITE_DEPTH", self.depth), ("SOURCE_MAP", self.source_map)];
        defines.into_iter().filter(|(_, wanted)| *wanted).map(|(name, _)| (name, String::new())).collect()
    }
}

/// The rendered eye: GL names of 2-D textures of the same size. Filters, wrapping, compare mode and sampler objects are
/// the pipelines' own, whatever the textures have.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// Colour, in any filterable format and any encoding; all four channels are carried over. Other than with
    /// [`Edges::Hard`] it is resolved, and lies between 0 and 1.
    pub color: glow::Texture,
    /// Depth: a depth texture, a depth-stencil texture whose depth is sampled, or a float texture; with
    /// [`Edges::Multisample`] a multisample texture.
    pub depth: glow::Texture,
    /// With [`Edges::Multisample`], the multisample texture that the colour was resolved from, if it is still there.
    pub samples: Option<glow::Texture>,
}

impl Source {
    /// A source without colours of samples.
    pub fn new(color: glow::Texture, depth: glow::Texture) -> Source {
        Source { color, depth, samples: None }
    }
}

/// What a call does to the context's state; the table is with [`Synthesis`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlState {
    /// Some state is left changed: for hosts that set what they draw with, which costs least.
    #[default]
    Leave,
    /// All that is changed is queried first and set back at the end: 3 to 4 microseconds a call on llvmpipe
    /// (docs/library.md has the measurement). A driver with a thread of its own may have to wait for it.
    Preserve,
}

/// A way to synthesize the other eye.
///
/// The context is current on the calling thread. Whatever state it is in, the picture is the same: a call sets all that
/// it relies on. What it leaves is the choice in [`SynthesisOptions::gl_state`]: [`GlState::Leave`] does as the table says,
/// [`GlState::Preserve`] leaves everything as it was. What is not in the table is neither read nor changed, and what a
/// context does not have (by version or extension) is neither set nor queried.
///
/// | state | set to | left |
/// |---|---|---|
/// | program | the passes' | changed |
/// | vertex array | one without attributes | changed |
/// | draw and read framebuffer | the target's | changed |
/// | viewport (all of a viewport array, which `Preserve` gives back as the first) | the target's rectangle | changed |
/// | 2-D texture of units 0 to 3, of 0 to 4 other than with [`Edges::Hard`] | depth, colour, intermediate | changed |
/// | multisample texture of units 0 and 3, with [`Edges::Multisample`] | depth, colour | changed |
/// | sampler object of units 0 to 4 | yoro's own | none |
/// | active unit | 0 to 4 | changed |
/// | scissor, stencil and depth test, face culling | off; depth test on for the target with [`Outputs::depth`] | off |
/// | depth function, depth mask, depth range | `ALWAYS`, on, 0 to 1 | so |
/// | blending and colour mask, of draw buffer 0 and, with [`Outputs::source_map`] or other than with [`Edges::Hard`], 1 (of all draw buffers before OpenGL ES 3.2) | off; all channels | so |
/// | dithering, polygon offset for filling, rasterizer discard, primitive restart (fixed index) | off | off |
/// | alpha to coverage, sample coverage; sample mask (ES 3.1) | off | off |
/// | clip distances (`EXT_clip_cull_distance`, desktop), depth bounds test (`EXT_depth_bounds_test`) | off | off |
/// | sRGB encoding of what is written (`EXT_sRGB_write_control`, desktop) | off, or on with [`Outputs::srgb`] | so |
/// | primitive restart, logic operation, polygon smoothing, alpha to one (desktop) | off | off |
/// | polygon mode (desktop) | fill | fill |
///
/// Not touched: buffers bound to any target (vertex, uniform, storage, pixel pack and unpack), pixel store, scissor box,
/// blend function and equation, stencil function, clear values, other texture targets and units. GL's error flag is read
/// where buffers are allocated.
///
/// The host sees to the rest: transform feedback and conditional rendering are not active (an occlusion query counts
/// the passes' fragments), the shading rate is one fragment a pixel, the target's draw buffers are its colour
/// attachments from 0 on, and neither texture of the source is attached to it.
pub trait Synthesis {
    /// Gets ready for images of these sizes: allocates intermediate buffers, for which it binds framebuffers and a 2-D
    /// texture to the active unit. Costs nothing when the sizes are the same as before; [`Synthesis::synthesize`]
    /// calls it.
    ///
    /// # Errors
    /// [`GlError`] when the sizes are beyond the driver's limits.
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError>;

    /// Synthesizes the other eye into a rectangle of [`Warp::target_size`], all of which is overwritten; the
    /// framebuffer's attachments fit the pipeline's [`Outputs`].
    ///
    /// # Errors
    /// As [`Synthesis::prepare`].
    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError>;
}

/// How to synthesize: the host's business, and in no file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SynthesisOptions {
    /// What the source knows of its edges.
    pub edges: Edges,
    /// What becomes of the host's GL state.
    pub gl_state: GlState,
}

/// Compiles the pipeline: [`Gather`] for hard edges, [`Layers`] for the others. Leaves the context's state as
/// [`Synthesis::prepare`] does, or as it was with [`GlState::Preserve`].
///
/// # Errors
/// [`GlError::Unsupported`] for [`Edges::Multisample`] without OpenGL ES 3.1; [`GlError::Shader`] when the driver refuses
/// a shader.
pub fn create(
    gl: &Rc<Context>,
    options: &SynthesisOptions,
    outputs: Outputs,
) -> Result<Box<dyn Synthesis>, GlError> {
    let pipeline = || -> Result<Box<dyn Synthesis>, GlError> {
        Ok(match options.edges {
            Edges::Hard => Box::new(Gather::new(gl, outputs)?),
            edges => Box::new(Layers::new(gl, outputs, edges)?),
        })
    };
    let draw_buffers = match options.edges {
        Edges::Hard => outputs.draw_buffers(),
        _ => layers::DRAW_BUFFERS,
    };
    match options.gl_state {
        GlState::Leave => pipeline(),
        GlState::Preserve => Ok(Box::new(Preserving::new(gl, draw_buffers, pipeline)?)),
    }
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

/// Sets the uniforms and textures that `include/warp.glsl` declares, for a pass of a pipeline. Texture units 0 and 1.
pub fn set_source(program: &Program, source: Source, uniforms: &Uniforms) {
    program.texture("depth_map", 0, source.depth).texture("color_map", 1, source.color);
    uniforms.set(program);
}

/// Binds the target and draws the pass that writes it: the last of a pipeline.
pub fn draw_target(gl: &Context, target: &Destination, outputs: Outputs) {
    gl.bind_framebuffer(target.framebuffer, target.origin, target.size);
    gl.set_depth_write(outputs.depth);
    gl.draw_screen();
    gl.set_depth_write(false);
}
