//! The gather pipeline: three fragment passes.

use std::rc::Rc;

use super::{Outputs, Source, Synthesis, draw_target, output_defines, set_warp};
use crate::eyes::Warp;
use crate::gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource,
};

/// Columns and rows of a tile; `include/tiles.glsl`.
const TILE: [u32; 2] = [8, 8];

/// Tile bounds, tile spans, march. Reads depth about four times and colour once per target pixel, writes the
/// target; the intermediate buffers are 4 bytes per tile of 8 x 8 pixels.
pub struct Gather {
    gl: Rc<Context>,
    outputs: Outputs,
    bounds: Program,
    spans: Program,
    march: Program,
    tile_map: RenderTarget,
    span_map: RenderTarget,
}

impl Gather {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`GlError::Shader`] when the driver refuses a shader.
    pub fn new(gl: &Rc<Context>, outputs: Outputs) -> Result<Gather, GlError> {
        let program = |file, defines: &[_]| Program::new(gl, ShaderSource::Screen(file), defines);
        let map = || RenderTarget::new(gl, [1, 1], &[(Format::R32Ui, Filter::Nearest)], None);
        Ok(Gather {
            gl: gl.clone(),
            outputs,
            bounds: program("synthesis/gather/tiles.frag", &[])?,
            spans: program("synthesis/gather/spans.frag", &[])?,
            march: program("synthesis/gather/march.frag", &output_defines(outputs))?,
            tile_map: map()?,
            span_map: map()?,
        })
    }
}

impl Synthesis for Gather {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        let tiles = |columns: u32| [columns.div_ceil(TILE[0]), warp.source_size[1].div_ceil(TILE[1])];
        self.tile_map.resize(tiles(warp.source_size[0]))?;
        self.span_map.resize(tiles(warp.target_size[0]))
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        self.prepare(warp)?;
        let gl = &self.gl;
        gl.set_raster_state(&RasterState::SCREEN);
        gl.pass("gather tiles", || {
            self.tile_map.bind();
            set_warp(self.bounds.bind(), source, warp, [0, 0]);
            gl.draw_screen();
        });
        gl.pass("gather spans", || {
            self.span_map.bind();
            set_warp(self.spans.bind(), source, warp, [0, 0]);
            self.spans.texture("tile_map", 2, self.tile_map.color(0).raw());
            gl.draw_screen();
        });
        gl.pass("gather march", || {
            set_warp(self.march.bind(), source, warp, target.origin);
            self.march.texture("span_map", 2, self.span_map.color(0).raw());
            draw_target(gl, target, self.outputs);
        });
        Ok(())
    }
}
