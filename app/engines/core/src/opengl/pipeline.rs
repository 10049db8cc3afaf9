//! Tile bounds, tile spans, march.

use std::marker::PhantomData;
use std::rc::Rc;

use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Image, Program, RenderTarget, ShaderSource, Touched,
};

use super::{Bloom, GlState, Options, Outputs, Source, draw_open, draw_target, mark_image, target_images};
use crate::eyes::{MotionWarp, PoseWarp, Warp};
use crate::synthesis::backend::{PerKind, UniformBlock as _, WarpKind, map_sizes};
use crate::synthesis::{HoleMark, Holes};

/// Synthesis between parallel eyes. The march follows the source's row.
pub type Gather = Pipeline<Warp>;

/// Synthesis of a view in any pose near the source's. The march follows a segment of any direction. For parallel eyes on
/// a level line it draws the same picture as [`Gather`], within the rounding of positions, but more slowly. It has no
/// source map, which can only hold columns.
pub type AnyView = Pipeline<PoseWarp>;

/// Synthesis of motion vectors between parallel eyes, for runtimes that make frames between those that are rendered.
///
/// The source's colour is the texture of the vectors, in RGBA16F, with three components in NDC ([`VectorSpace`]). It has
/// the size that a runtime recommends for vectors, which is not that of the eye, and its depth has the same size. Two
/// components are not enough, since a hand that comes near moves sideways in the other eye, by 8 pixels of 1024. The
/// target receives vectors, and with [`Outputs::depth`] also depth. Silhouettes are not blended, and a hole takes the
/// vector of its background.
///
/// [`VectorSpace`]: crate::eyes::VectorSpace
pub type Motion = Pipeline<MotionWarp>;

/// The passes for a kind of warp: [`Gather`], [`AnyView`] or [`Motion`]. They are three fragment passes, which find the
/// bounds of tiles, find the spans of tiles, and march. The two buffers between them have 16 bytes for each tile of 16 x 8
/// pixels ([`buffer_bytes`](super::buffer_bytes)).
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
/// | 2-D texture of units 0 to 3 | depth, colour, intermediate | changed |
/// | 2-D texture of unit 4, for sources with bloom | bloom | changed, even with `Preserve` |
/// | array texture of units 0 and 1, for sources that are layers | depth, colour | changed |
/// | sampler object of units 0 to 3 | yoro's own | none |
/// | active unit | 0 to 3 | changed |
/// | scissor test (as the viewport), stencil and depth test, face culling | off; depth test on for the target if depth is written | off |
/// | depth function, depth mask, depth range (as the viewport) | `ALWAYS`, on, 0 to 1 | as set |
/// | with open holes: scissor box (as the viewport) | the target's rectangle | as set |
/// | with holes marked by stencil: stencil function, operations and write mask, of both faces | `ALWAYS` 1, `REPLACE`, all bits | as set |
/// | blending and colour mask, of draw buffer 0 and, with a source map, 1 (of all draw buffers before OpenGL ES 3.2) | off; all channels | as set |
/// | dithering, polygon offset for filling, rasterizer discard, primitive restart (fixed index) | off | off |
/// | alpha to coverage, sample coverage; sample mask (ES 3.1) | off | off |
/// | clip distances (`EXT_clip_cull_distance`, desktop), depth bounds test (`EXT_depth_bounds_test`) | off | off |
/// | sRGB encoding of what is written (`EXT_sRGB_write_control`, desktop) | off, or on if asked for | as set |
/// | primitive restart, logic operation, polygon smoothing, alpha to one (desktop) | off | off |
/// | polygon mode (desktop) | fill | fill |
/// | alpha test, polygon stipple (compatibility profile) | off | off |
///
/// Not touched: buffers bound to any target (vertex, uniform, storage, pixel pack and unpack), pixel store, blend
/// function and equation, clear values, other texture targets and units. A pending error stays, except in browsers, where allocating buffers reads GL's error flag. A program that the host deleted while it
/// was current is destroyed, as GL specifies, when another one becomes current; `Preserve` then leaves no program
/// current.
///
/// The host ensures the rest: transform feedback and conditional rendering are inactive, the shading rate is one
/// fragment per pixel, the target's draw buffers are its colour attachments from 0 on, and neither texture of the
/// source is attached to it. An active occlusion query counts the passes' fragments. While [`Context::set_profiling`]
/// times passes, no TIME_ELAPSED query of the host is active.
pub struct Pipeline<W> {
    gl: Rc<Context>,
    outputs: Outputs,
    options: Options,
    tiles: Program,
    spans: Program,
    march: Program,
    tile_map: RenderTarget,
    span_map: RenderTarget,
    warp: PhantomData<W>,
}

/// The names of the passes, their shaders, and what they can do.
struct Shaders {
    tiles: [&'static str; 2],
    spans: [&'static str; 2],
    march: &'static str,
    march_vertex: &'static str,
    march_fragment: &'static str,
    /// A macro of the march.
    macro_name: Option<&'static str>,
    writes_source_map: bool,
    adds_bloom: bool,
    opens_holes: bool,
}

const GATHER: Shaders = Shaders {
    tiles: ["gather tiles", "synthesis/gather/tiles.frag"],
    spans: ["gather spans", "synthesis/gather/spans.frag"],
    march: "gather march",
    march_vertex: "synthesis/march.vert",
    march_fragment: "synthesis/gather/march.frag",
    macro_name: None,
    writes_source_map: true,
    adds_bloom: true,
    opens_holes: true,
};

const ANY_VIEW: Shaders = Shaders {
    tiles: ["any view tiles", "synthesis/any_view/tiles.frag"],
    spans: ["any view spans", "synthesis/any_view/spans.frag"],
    march: "any view march",
    march_vertex: "screen.vert",
    march_fragment: "synthesis/any_view/march.frag",
    macro_name: None,
    writes_source_map: false,
    adds_bloom: false,
    opens_holes: false,
};

const MOTION: Shaders = Shaders {
    tiles: ["motion tiles", GATHER.tiles[1]],
    spans: ["motion spans", GATHER.spans[1]],
    march: "motion march",
    macro_name: Some("MOTION"),
    adds_bloom: false,
    opens_holes: false,
    ..GATHER
};

static SHADERS: PerKind<Shaders> = PerKind { gather: GATHER, motion: MOTION, any_view: ANY_VIEW };

impl Shaders {
    fn check(&self, options: &Options, outputs: Outputs) -> Result<(), GlError> {
        let refuse = |reason: &str| Err(GlError::Unsupported(reason.into()));
        if outputs.source_map && !self.writes_source_map {
            return refuse("any view has no source map, which can only hold columns");
        }
        if options.bloom && !self.adds_bloom {
            return refuse("only gather adds bloom");
        }
        if outputs.holes.is_open() && !self.opens_holes {
            return refuse("only gather leaves holes open");
        }
        if outputs.holes == Holes::Open(HoleMark::Depth) && outputs.depth {
            return refuse("depth cannot both be written and mark what is written; mark it by stencil");
        }
        Ok(())
    }
}

impl<W: WarpKind> Pipeline<W> {
    /// Compiles the passes. Changes the same state as [`Pipeline::prepare`], or none with [`GlState::Preserve`].
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for an [`AnyView`] with a source map, for anything but a [`Gather`] with bloom or open
    /// holes, or if depth is both written and a mark; [`GlError::Shader`] if the driver refuses a shader.
    pub fn new(gl: &Rc<Context>, options: &Options, outputs: Outputs) -> Result<Pipeline<W>, GlError> {
        let shaders = W::of(&SHADERS);
        shaders.check(options, outputs)?;
        preserving(gl, options, outputs, || {
            let defines = options.defines();
            let screen = |file| Program::new(gl, ShaderSource::Screen(file), &defines);
            let map = || RenderTarget::new(gl, [1, 1], &[(Format::Rgba32Ui, Filter::Nearest)], None);
            let Shaders { tiles, spans, march_vertex, march_fragment, macro_name, .. } = *shaders;
            let march = ShaderSource::Raster { vertex: march_vertex, fragment: march_fragment };
            let own = macro_name.map(|name| (name, String::new()));
            let march_defines = [outputs.defines(), own.into_iter().collect(), defines.clone()].concat();
            Ok(Pipeline {
                gl: gl.clone(),
                outputs,
                options: *options,
                tiles: screen(tiles[1])?,
                spans: screen(spans[1])?,
                march: Program::new(gl, march, &march_defines)?,
                tile_map: map()?,
                span_map: map()?,
                warp: PhantomData,
            })
        })
    }

    /// Allocates intermediate buffers for images of these sizes; this binds framebuffers, and a 2-D texture to unit 0.
    /// Costs nothing if the sizes have not changed. [`Pipeline::synthesize`] calls it.
    ///
    /// # Errors
    /// [`GlError`] if the sizes are beyond the driver's limits.
    pub fn prepare(&mut self, warp: &W) -> Result<(), GlError> {
        self.preserving(|pipeline| pipeline.resize(warp))
    }

    /// Synthesizes the other eye into a rectangle of the warp's target size and overwrites all of it. The framebuffer's
    /// attachments must fit the pipeline's [`Outputs`].
    ///
    /// # Errors
    /// Those of [`Pipeline::prepare`].
    pub fn synthesize(&mut self, source: Source, warp: &W, target: &Destination) -> Result<(), GlError> {
        self.preserving(|pipeline| {
            pipeline.resize(warp)?;
            pipeline.draw(source, warp, target);
            Ok(())
        })
    }

    fn preserving<R>(&mut self, body: impl FnOnce(&mut Self) -> R) -> R {
        let (gl, options, outputs) = (self.gl.clone(), self.options, self.outputs);
        preserving(&gl, &options, outputs, || body(self))
    }

    fn resize(&mut self, warp: &W) -> Result<(), GlError> {
        self.gl.set_first_unit();
        let maps = [&mut self.tile_map, &mut self.span_map];
        for (map, size) in maps.into_iter().zip(map_sizes::<W>(warp.sizes())) {
            map.resize(self.options.buffer_size(map.size(), size))?;
        }
        Ok(())
    }

    fn draw(&self, source: Source, warp: &W, target: &Destination) {
        let gl = &*self.gl;
        let [tile_size, span_size] = map_sizes::<W>(warp.sizes());
        gl.begin_synthesis(self.outputs.draw_buffers(), self.outputs.srgb);
        if source.stored {
            gl.read_stored();
        }
        let shaders = W::of(&SHADERS);
        let places = source.places(warp.sizes()[0], target, self.options.parts);
        let uniforms = warp.uniforms(&places);
        let begin = |program: &Program| {
            self.options.bind_source(program.bind(), source);
            uniforms.set(program);
        };
        let [depth, color] = self.options.source_images(warp.sizes()[0]);
        let [tile_map, span_map] = [(&self.tile_map, tile_size), (&self.span_map, span_size)]
            .map(|(map, size)| Image { size, ..map.color(0).image() });
        gl.pass(shaders.tiles[0]).read("depth_map", depth).write([tile_map]).run(|| {
            self.tile_map.bind_part(tile_size);
            begin(&self.tiles);
            gl.draw_screen();
        });
        gl.pass(shaders.spans[0]).read("tile_map", tile_map).write([span_map]).run(|| {
            self.span_map.bind_part(span_size);
            begin(&self.spans);
            self.spans.texture("tile_map", 2, self.tile_map.color(0).raw());
            gl.draw_screen();
        });
        let march = gl.pass(shaders.march).read("depth_map", depth).read("color_map", color);
        let mut march = march.read("tile_map", tile_map).read("span_map", span_map);
        let bloom = source.bloom.filter(|_| self.options.bloom);
        if let Some(Bloom { size, .. }) = bloom {
            // The texture's size is not known here; a blurred image needs no more than half the pixels along each axis.
            march = march.read("bloom", Image { size: size.map(|n| n.div_ceil(2)), ..color });
        }
        march = march.write(target_images(target, self.outputs));
        march.in_tile(mark_image(target, self.outputs)).run(|| {
            begin(&self.march);
            self.march.texture("tile_map", 2, self.tile_map.color(0).raw());
            self.march.texture("span_map", 3, self.span_map.color(0).raw());
            if let Some(bloom) = bloom {
                self.march
                    .texture("bloom", 4, bloom.texture)
                    .set("bloom_strength", bloom.strength)
                    .set("bloom_place", bloom.place(&places));
            }
            match warp.marks(self.outputs.holes) {
                Some(marks) => draw_open(gl, target, self.outputs, marks),
                None => draw_target(gl, target, self.outputs),
            }
        });
        gl.end_synthesis();
    }
}

/// Runs `body`, and restores the host's state afterwards, even if it fails, if the options say so.
pub(super) fn preserving<R>(
    gl: &Context,
    options: &Options,
    outputs: Outputs,
    body: impl FnOnce() -> R,
) -> R {
    if options.gl_state == GlState::Leave {
        return body();
    }
    let touched = Touched {
        draw_buffers: outputs.draw_buffers(),
        arrays: options.array_textures,
        marks: outputs.holes.is_open(),
    };
    let state = gl.save_state(touched);
    gl.set_first_unit();
    let result = body();
    gl.restore_state(&state);
    result
}
