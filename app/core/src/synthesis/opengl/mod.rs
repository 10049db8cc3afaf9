//! Synthesis on OpenGL: the two textures of one eye in, the other eye in a framebuffer out.

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

/// What a pipeline writes besides colour, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Depth of the synthesized eye, in the source's encoding, to the target's depth attachment: for
    /// transparent objects, near objects and compositors.
    pub depth: bool,
    /// The source map, to colour attachment 1 ([`yoro_gl::Format::R32Ui`]): bit 31 marks a hole, the other bits are the
    /// source column of the pixel (or of the edge it was filled from) in 1/65536 pixel. [`SourceMapEntry`]
    /// decodes it. The column is counted from the left for a synthesized left eye and from the right for a
    /// right eye.
    pub source_map: bool,
    /// The source's colour and the target's are both sRGB textures ([`yoro_gl::Format::Srgb8Alpha8`]), which sampling
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
