//! Synthesis on OpenGL: two textures of one eye in, the other eye in a framebuffer out.

mod gather;
mod layers;
mod preserve;

use std::rc::Rc;

use super::edges::Edges;
use super::uniforms::Uniforms;
use crate::eyes::Warp;
use yoro_gl::{Context, Destination, GlError, Program};

pub use gather::Gather;
#[doc(hidden)]
pub use gather::GatherVariant;
pub use layers::Layers;
use preserve::Preserving;

/// The outputs of a pipeline besides colour, and their encoding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Write the synthesized eye's depth, in the source's encoding, to the target's depth attachment: for transparent
    /// objects, near objects and compositors.
    pub depth: bool,
    /// Write the source map to colour attachment 1 ([`yoro_gl::Format::R32Ui`]). Bit 31 marks a hole; the other bits are the
    /// source column of the pixel, or of the edge it was filled from, in 1/65536 pixel. The column is counted from the left
    /// for a synthesized left eye and from the right for a right eye.
    /// [`SourceMapEntry`](super::SourceMapEntry) decodes it.
    pub source_map: bool,
    /// Encode colour for an sRGB target: set it if source and target are both sRGB textures
    /// ([`yoro_gl::Format::Srgb8Alpha8`]), which sampling decodes. Otherwise encoding is off and values are stored as they
    /// are sampled. OpenGL ES without `EXT_sRGB_write_control` always encodes for sRGB targets.
    pub srgb: bool,
}

impl Outputs {
    /// Returns the number of the target's colour attachments.
    pub fn draw_buffers(self) -> u32 {
        1 + u32::from(self.source_map)
    }

    /// Returns the preprocessor defines that select these outputs in the last pass of a pipeline.
    pub fn defines(self) -> Vec<(&'static str, String)> {
        let defines = [("WRITE_DEPTH", self.depth), ("SOURCE_MAP", self.source_map)];
        defines.into_iter().filter(|(_, wanted)| *wanted).map(|(name, _)| (name, String::new())).collect()
    }
}

/// The rendered eye: GL names of 2-D textures of the same size. Their filters, wrapping, compare mode and samplers do not
/// matter.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// Colour, in any filterable format and any encoding; all four channels are synthesized. For kinds other than
    /// [`Edges::Hard`] it is resolved, with values from 0 to 1.
    pub color: glow::Texture,
    /// Depth: a depth texture, a depth-stencil texture whose depth is sampled, or a float texture. A multisample texture
    /// for [`Edges::Multisample`].
    pub depth: glow::Texture,
    /// For [`Edges::Multisample`], the multisample texture that the colour was resolved from, if it still exists.
    pub samples: Option<glow::Texture>,
}

impl Source {
    /// Returns a source without the colours of samples.
    pub fn new(color: glow::Texture, depth: glow::Texture) -> Source {
        Source { color, depth, samples: None }
    }
}

/// The effect of a call on the context's state, which the table of [`Synthesis`] lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlState {
    /// Leaves some state changed. This costs least, for hosts that set all state they draw with.
    #[default]
    Leave,
    /// Queries all state first and restores it at the end. This takes 3 to 4 microseconds a call on llvmpipe
    /// (docs/library.md has the measurement). A driver that works in its own thread may have to wait for it.
    Preserve,
}

/// A pipeline that synthesizes the other eye.
///
/// The context must be current on the calling thread. The picture does not depend on its state: a call sets all state that
/// it relies on. Afterwards the state is as [`SynthesisOptions::gl_state`] says: with [`GlState::Leave`] as in the table,
/// with [`GlState::Preserve`] as before the call. State that is not in the table is neither read nor changed. State that a
/// context lacks, by version or extension, is neither set nor queried.
///
/// | state | set to | afterwards |
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
/// | depth function, depth mask, depth range | `ALWAYS`, on, 0 to 1 | as set |
/// | blending and colour mask, of draw buffer 0 and, with [`Outputs::source_map`] or other than with [`Edges::Hard`], 1 (of all draw buffers before OpenGL ES 3.2) | off; all channels | as set |
/// | dithering, polygon offset for filling, rasterizer discard, primitive restart (fixed index) | off | off |
/// | alpha to coverage, sample coverage; sample mask (ES 3.1) | off | off |
/// | clip distances (`EXT_clip_cull_distance`, desktop), depth bounds test (`EXT_depth_bounds_test`) | off | off |
/// | sRGB encoding of what is written (`EXT_sRGB_write_control`, desktop) | off, or on with [`Outputs::srgb`] | as set |
/// | primitive restart, logic operation, polygon smoothing, alpha to one (desktop) | off | off |
/// | polygon mode (desktop) | fill | fill |
///
/// Not touched: buffers bound to any target (vertex, uniform, storage, pixel pack and unpack), pixel store, scissor box,
/// blend function and equation, stencil function, clear values, other texture targets and units. GL's error flag is read
/// where buffers are allocated.
///
/// The host ensures the rest: transform feedback and conditional rendering are not active, the shading rate is one fragment
/// a pixel, the target's draw buffers are its colour attachments from 0 on, and neither texture of the source is attached
/// to it. An active occlusion query counts the passes' fragments.
pub trait Synthesis {
    /// Allocates intermediate buffers for images of these sizes, for which it binds framebuffers and a 2-D texture to the
    /// active unit. Costs nothing if the sizes are the same as before. [`Synthesis::synthesize`] calls it.
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
}

/// Compiles the pipeline: [`Gather`] for hard edges, [`Layers`] for the others. Changes the same state as
/// [`Synthesis::prepare`], or none with [`GlState::Preserve`].
///
/// # Errors
/// [`GlError::Unsupported`] for [`Edges::Multisample`] without OpenGL ES 3.1; [`GlError::Shader`] if the driver refuses a
/// shader.
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

/// Sets the uniforms and textures that `include/warp.glsl` declares, for a pass of a pipeline. Uses texture units 0 and 1.
/// The program must be current.
pub fn set_source(program: &Program, source: Source, uniforms: &Uniforms) {
    program.texture("depth_map", 0, source.depth).texture("color_map", 1, source.color);
    uniforms.set(program);
}

/// Binds the target and draws the last pass of a pipeline into it.
pub fn draw_target(gl: &Context, target: &Destination, outputs: Outputs) {
    gl.bind_framebuffer(target.framebuffer, target.origin, target.size);
    gl.set_depth_write(outputs.depth);
    gl.draw_screen();
    gl.set_depth_write(false);
}
