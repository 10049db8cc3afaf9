//! Synthesis on OpenGL: reads the colour and depth textures of one eye, and draws the other eye into a framebuffer.
//!
//! [`Gather`] draws a parallel eye from a [`Warp`](crate::eyes::Warp), and [`AnyView`] draws a view in any pose near the
//! source's from a [`PoseWarp`](crate::eyes::PoseWarp). [`Motion`] makes the other eye's motion vectors. Each is a
//! [`Pipeline`], and runs on OpenGL ES 3.0, on WebGL 2, and on desktop OpenGL 4.5, or 4.3 with
//! GL_ARB_ES3_1_compatibility. `examples/engine.rs` uses one in an engine of its own.
//!
//! [`GuessedDepth`] runs before [`Gather`] on drivers that resolve only one depth sample of an anti-aliased image. A
//! [`Composer`] combines the layers of a foveated view into the eye that is shown.
//!
//! [`Context::set_profiling`] times the passes, which are named `gather tiles`, `gather spans` and `gather march`, or
//! `any view tiles` and so on, and `compose`. Call [`Context::end_timed_frame`] once a frame: it returns the times of an
//! earlier frame without waiting. [`Context::take_pass_times`] waits for those of this one.

mod composer;
mod guessed_depth;
mod pipeline;

use glam::{Vec2, Vec4};

use crate::synthesis::backend::{HoleMarks, Places, WarpKind, map_sizes};
use crate::synthesis::{HoleMark, Holes, Uniforms};
use yoro_gl::{Format, Image, Program};

pub use composer::{Composer, InsetImage, LevelImage, LevelImages};
pub use glow;
pub use guessed_depth::GuessedDepth;
pub use pipeline::{AnyView, Gather, Motion, Pipeline};
/// The types of `yoro-gl` that a host needs: its context in a wrapper, and where to draw.
pub use yoro_gl::{Capabilities, Context, Destination, GlApi, GlError, PassTime, Profiling};

/// The outputs of a pipeline besides colour, and their encoding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Writes the synthesized eye's depth, in the source's encoding, to the target's depth attachment, for transparent
    /// objects and compositors. Where a tile has a law it is the law's, to a sixteenth of a pixel of displacement.
    pub depth: bool,
    /// Writes the source map to colour attachment 1 ([`yoro_gl::Format::R32Ui`]). Bit 31 marks a hole; the other bits
    /// are the source column of the pixel, or of the edge that it was filled from, in 1/65536 pixel. Columns are
    /// counted from the left for a synthesized left eye and from the right for a right eye.
    /// [`SourceMapEntry`](crate::synthesis::SourceMapEntry) decodes an entry.
    pub source_map: bool,
    /// Encodes colour for an sRGB target. Set it if source and target are both sRGB textures
    /// ([`yoro_gl::Format::Srgb8Alpha8`]), which are decoded when they are sampled. Otherwise values are stored as they
    /// are sampled, without encoding. OpenGL ES without `EXT_sRGB_write_control` always encodes for sRGB targets.
    pub srgb: bool,
    /// What becomes of holes; [`AnyView`] and [`Motion`] fill them.
    pub holes: Holes,
}

impl Outputs {
    /// Returns the number of the target's colour attachments.
    pub fn draw_buffers(self) -> u32 {
        1 + u32::from(self.source_map)
    }

    /// Returns the preprocessor defines that select these outputs in the last pass of a pipeline.
    pub fn defines(self) -> Vec<(&'static str, String)> {
        let open = self.holes.is_open();
        defines([("WRITE_DEPTH", self.depth), ("SOURCE_MAP", self.source_map), ("OPEN_HOLES", open)])
    }
}

/// The rendered eye, as GL names of 2-D textures, or arrays of them, of the same size. The textures' filters, wrapping,
/// compare mode and samplers do not matter.
///
/// Every pixel counts as one surface. Of a multisampled image, give colour resolved from the samples, and the depth of
/// each pixel's nearest sample. Never average depth over samples: the average belongs to no surface and causes halos at
/// all edges.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// Colour, in any filterable format and any encoding; all four channels are synthesized.
    pub color: glow::Texture,
    /// Depth: a depth texture, a depth-stencil texture whose depth is sampled, or a float texture.
    pub depth: glow::Texture,
    /// The place of the source in its textures, for a pipeline with [`Options::parts`].
    pub part: Option<Part>,
    /// The layer of both textures, for a pipeline with [`Options::array_textures`]; 0 otherwise.
    pub layer: u32,
    /// What is added to the colours, for a [`Gather`] with [`Options::bloom`].
    pub bloom: Option<Bloom>,
    /// True if colour is an sRGB texture that is read as it is stored; requires [`Context::reads_stored`].
    pub stored: bool,
}

/// Bloom that is not yet part of a source's colours.
#[derive(Clone, Copy, Debug)]
pub struct Bloom {
    /// Scene-referred light in linear RGB, of any size. It is sampled with the filter of the texture, whose edges are
    /// clamped.
    pub texture: glow::Texture,
    /// The factor on the texture's values, the exposure included.
    pub strength: f32,
    /// Lower left corner, in pixels of the source, of the rectangle that the texture covers. Beyond it, the source has the
    /// light of the rectangle's border.
    pub origin: [u32; 2],
    /// Width and height of the rectangle in pixels.
    pub size: [u32; 2],
}

impl Bloom {
    /// Returns the scale and the offset from the texture coordinates of a source at these places to those of its bloom.
    fn place(&self, places: &Places) -> Vec4 {
        let vector = |v: [u32; 2]| Vec2::from(v.map(|n| n as f32));
        let size = vector(self.size);
        let origin = vector(places.source_origin) + vector(self.origin);
        (vector(places.image_size) / size, -origin / size).into()
    }
}

impl Source {
    /// Returns a source that is the whole of two textures.
    pub fn new(color: glow::Texture, depth: glow::Texture) -> Source {
        Source { color, depth, part: None, layer: 0, bloom: None, stored: false }
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

/// What a call does to the context's state, as listed in the table of [`Pipeline`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlState {
    /// Leaves some state changed. This is cheapest, for hosts that set all the state they draw with.
    #[default]
    Leave,
    /// Queries all state first and restores it at the end. This takes 3 to 4 microseconds per call on llvmpipe. A
    /// driver that works in its own thread may have to be waited for.
    Preserve,
}

/// Options of a pipeline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The effect of calls on the host's GL state.
    pub gl_state: GlState,
    /// True if sources may be parts of their textures ([`Source::part`]) and change their size from frame to frame, as
    /// with dynamic resolution. Buffers then only grow, so that no frame allocates after one of the largest size.
    pub parts: bool,
    /// True if colour and depth are layers of array textures, as with multiview ([`Source::layer`]).
    pub array_textures: bool,
    /// True if the depth texture has two channels, each with the reversed depth of one of the pixel's samples, of which
    /// the nearer counts. It is how depth is carried through the average of samples in a tile-based GPU; see the guide
    /// for engines.
    pub depth_pairs: bool,
    /// True if [`Source::bloom`] is added to the synthesized colours. This saves a pass over the rendered eye. The
    /// source's colours must be those of `tonemap` in `include/color.glsl` of `yoro-shaders`: it is undone, the light is
    /// added, and it is applied again. Alpha becomes luma. Only for a [`Gather`], which reads the bloom by texture unit
    /// 4; [`GlState::Preserve`] does not restore that unit.
    pub bloom: bool,
}

impl Options {
    /// Returns the preprocessor macros that select this kind of source.
    fn defines(&self) -> Vec<(&'static str, String)> {
        defines([
            ("SOURCE_PARTS", self.parts),
            ("SOURCE_LAYERS", self.array_textures),
            ("DEPTH_PAIRS", self.depth_pairs),
            ("BLOOM", self.bloom),
        ])
    }

    /// Returns the images of a source of this size, for declarations: `depth_map` and `color_map`.
    fn source_images(&self, size: [u32; 2]) -> [Image; 2] {
        let depth = if self.depth_pairs { Format::Rg16F } else { Format::Depth32F };
        [depth, Format::Rgba8].map(|format| Image { format, size, samples: 1 })
    }

    /// Binds depth and colour of the source to units 0 and 1. The program must be current.
    fn bind_source(&self, program: &Program, source: Source) {
        for (name, unit, texture) in [("depth_map", 0, source.depth), ("color_map", 1, source.color)] {
            if self.array_textures {
                program.texture_array(name, unit, texture);
            } else {
                program.texture(name, unit, texture);
            }
        }
        program.set("source_layer", source.layer as i32);
    }

    /// Returns a buffer's new size: the needed one, or with parts at least the current one, too.
    fn buffer_size(&self, now: [u32; 2], needed: [u32; 2]) -> [u32; 2] {
        if self.parts { [0, 1].map(|i| now[i].max(needed[i])) } else { needed }
    }
}

/// Returns the size in bytes of the buffers that [`Pipeline::prepare`] allocates for these sizes, for planning before a
/// pipeline exists. Drivers add padding.
pub fn buffer_bytes<W: WarpKind>(warp: &W) -> u64 {
    map_sizes::<W>(warp.sizes()).map(|[width, height]| 16 * u64::from(width) * u64::from(height)).iter().sum()
}

/// Returns those preprocessor macros that are wanted, without values.
fn defines<const N: usize>(wanted: [(&'static str, bool); N]) -> Vec<(&'static str, String)> {
    wanted.into_iter().filter(|(_, wanted)| *wanted).map(|(name, _)| (name, String::new())).collect()
}

/// Sets the uniforms and textures that `include/warp.glsl` declares, for a pass of another pipeline. Uses texture units
/// 0 and 1. The program must be current.
pub fn set_source(program: &Program, source: Source, uniforms: &Uniforms) {
    program.texture("depth_map", 0, source.depth).texture("color_map", 1, source.color);
    uniforms.set(program);
}

/// Binds the target and draws the last pass of a pipeline into it.
pub fn draw_target(gl: &Context, target: &Destination, outputs: Outputs) {
    gl.overwrite(target, outputs.draw_buffers() as usize, outputs.depth);
    gl.set_depth_write(outputs.depth);
    gl.draw_screen();
    gl.set_depth_write(false);
}

/// Like [`draw_target`], for a march that leaves pixels open: marks those that it writes.
fn draw_open(gl: &Context, target: &Destination, outputs: Outputs, HoleMarks { mark, planes }: HoleMarks) {
    gl.overwrite(target, outputs.draw_buffers() as usize, false);
    let [nearest, farthest] = planes;
    gl.clear_marks(target, farthest, mark == HoleMark::Stencil);
    gl.set_depth_write(outputs.depth || mark == HoleMark::Depth);
    match mark {
        HoleMark::Stencil => gl.marking_stencil(|| gl.draw_screen()),
        HoleMark::Depth => gl.marking_depth(nearest, || gl.draw_screen()),
    }
    gl.set_depth_write(false);
}

/// Declares what [`draw_target`] and [`draw_open`] write.
fn target_images(target: &Destination, outputs: Outputs) -> impl Iterator<Item = Image> {
    let depth = outputs.depth.then(|| target.image(depth_format(outputs.holes)));
    let map = outputs.source_map.then(|| target.image(Format::R32Ui));
    [Some(target.image(Format::Rgba8)), map, depth].into_iter().flatten()
}

/// Declares the marks of [`draw_open`] where depth is no output: whoever draws in open pixels reads them in the same tiles.
fn mark_image(target: &Destination, Outputs { depth, holes, .. }: Outputs) -> Option<Image> {
    (holes.is_open() && !depth).then(|| target.image(depth_format(holes)))
}

fn depth_format(holes: Holes) -> Format {
    match holes {
        Holes::Open(HoleMark::Stencil) => Format::Depth32FStencil8,
        Holes::Open(HoleMark::Depth) | Holes::Filled => Format::Depth32F,
    }
}
