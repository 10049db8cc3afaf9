//! The pipeline for any view near the source's: three fragment passes.

use std::rc::Rc;

use super::preserve::preserve;
use super::{Edges, GlState, Outputs, Source, SynthesisOptions, draw_target, tiles};
use crate::eyes::PoseWarp;
use crate::synthesis::PoseUniforms;
use yoro_gl::{Context, Destination, Filter, Format, GlError, Program, RenderTarget, ShaderSource, Touched};

/// View synthesis for a target in any pose near the source's: tile bounds, tile spans, march. For parallel eyes on a
/// level line, it gives the same picture as [`Gather`](super::Gather), within the rounding of positions, but is slower.
/// The buffers have 16 bytes per tile of 16 x 8 source pixels, and per tile of 16 x 8 target pixels. The table of
/// [`Synthesis`](super::Synthesis) lists what a call does to the context's state.
pub struct AnyView {
    gl: Rc<Context>,
    outputs: Outputs,
    options: SynthesisOptions,
    bounds: Program,
    spans: Program,
    march: Program,
    tile_map: RenderTarget,
    span_map: RenderTarget,
}

impl AnyView {
    /// Compiles the passes. Changes the same state as [`AnyView::prepare`], or none with [`GlState::Preserve`].
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for other edges than [`Edges::Hard`], for a history, and for a source map, which can
    /// only hold columns; [`GlError::Shader`] if the driver refuses a shader.
    pub fn new(gl: &Rc<Context>, options: &SynthesisOptions, outputs: Outputs) -> Result<AnyView, GlError> {
        if options.edges != Edges::Hard || options.history || outputs.source_map {
            let message = "any view is synthesized from hard edges, without history and source map";
            return Err(GlError::Unsupported(message.into()));
        }
        preserving(gl, options, || {
            let defines = options.defines();
            let march = [defines.clone(), outputs.defines()].concat();
            let program = |file, defines: &[_]| Program::new(gl, ShaderSource::Screen(file), defines);
            let map = || RenderTarget::new(gl, [1, 1], &[(Format::Rgba32Ui, Filter::Nearest)], None);
            Ok(AnyView {
                gl: gl.clone(),
                outputs,
                options: *options,
                bounds: program("synthesis/any_view/tiles.frag", &defines)?,
                spans: program("synthesis/any_view/spans.frag", &defines)?,
                march: program("synthesis/any_view/march.frag", &march)?,
                tile_map: map()?,
                span_map: map()?,
            })
        })
    }

    /// Allocates the buffers for images of these sizes. Costs nothing if the sizes have not changed.
    /// [`AnyView::synthesize`] calls it.
    ///
    /// # Errors
    /// [`GlError`] if the sizes are beyond the driver's limits.
    pub fn prepare(&mut self, warp: &PoseWarp) -> Result<(), GlError> {
        let tile_size = self.options.buffer_size(self.tile_map.size(), tiles(warp.source_size));
        let span_size = self.options.buffer_size(self.span_map.size(), tiles(warp.target_size));
        preserving(&self.gl, &self.options, || {
            self.tile_map.resize(tile_size)?;
            self.span_map.resize(span_size)
        })
    }

    /// Synthesizes the target into a rectangle of [`PoseWarp::target_size`] and overwrites all of it.
    ///
    /// # Errors
    /// Those of [`AnyView::prepare`].
    pub fn synthesize(
        &mut self,
        source: Source,
        warp: &PoseWarp,
        target: &Destination,
    ) -> Result<(), GlError> {
        self.prepare(warp)?;
        preserving(&self.gl, &self.options, || {
            let gl = &self.gl;
            gl.set_first_unit();
            gl.begin_synthesis(self.outputs.draw_buffers(), self.outputs.srgb);
            gl.pass("any view tiles", || {
                self.tile_map.bind_part(tiles(warp.source_size));
                self.set(&self.bounds, source, warp, target);
                gl.draw_screen();
            });
            gl.pass("any view spans", || {
                self.span_map.bind_part(tiles(warp.target_size));
                self.set(&self.spans, source, warp, target);
                self.spans.texture("tile_map", 2, self.tile_map.color(0).raw());
                gl.draw_screen();
            });
            gl.pass("any view march", || {
                self.set(&self.march, source, warp, target);
                self.march.texture("tile_map", 2, self.tile_map.color(0).raw());
                self.march.texture("span_map", 3, self.span_map.color(0).raw());
                draw_target(gl, target, self.outputs);
            });
            gl.end_synthesis();
        });
        Ok(())
    }

    /// Makes a pass's program current, and sets its uniforms and textures.
    fn set(&self, program: &Program, source: Source, warp: &PoseWarp, target: &Destination) {
        program.bind();
        self.options.bind_source(program, source);
        let places = source.places(warp.source_size, target, self.options.parts);
        PoseUniforms::new(warp, &places).set(program);
    }
}

/// Runs `body`, and restores the host's state afterwards if the options say so.
fn preserving<R>(gl: &Context, options: &SynthesisOptions, body: impl FnOnce() -> R) -> R {
    match options.gl_state {
        GlState::Leave => body(),
        GlState::Preserve => preserve(gl, Touched { draw_buffers: 1, arrays: options.array_textures }, body),
    }
}
