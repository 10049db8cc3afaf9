//! The gather pipeline: three fragment passes.

use std::rc::Rc;

use super::{Outputs, Source, Synthesis, draw_target, set_source};
use crate::eyes::Warp;
use crate::synthesis::uniforms::{Uniforms, tiles};
use yoro_gl::{
    Capabilities, Context, Destination, Filter, Format, GlError, Program, RenderTarget, ShaderSource,
};

/// How the shaders are written for a kind of driver. All give the same picture, to the rounding of positions.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GatherVariant {
    /// OpenGL ES 3.0: every depth value is a fetch, every pixel marches in one loop.
    Plain,
    /// A CPU rasterizer, which pays for every fetch in the text, taken or not: textureGather for the tiles only.
    Software,
    /// A GPU: textureGather, and a short way on which nearly every pixel ends before the loop.
    ShortWay,
}

impl GatherVariant {
    /// All of them.
    pub const ALL: [GatherVariant; 3] =
        [GatherVariant::Plain, GatherVariant::Software, GatherVariant::ShortWay];

    fn of(capabilities: &Capabilities) -> GatherVariant {
        match capabilities {
            // OpenGL ES 3.1 brings compute shaders and textureGather alike.
            Capabilities { compute: false, .. } => GatherVariant::Plain,
            Capabilities { software: true, .. } => GatherVariant::Software,
            _ => GatherVariant::ShortWay,
        }
    }

    fn defines(self) -> &'static [&'static str] {
        match self {
            GatherVariant::Plain => &[],
            GatherVariant::Software => &["TEXTURE_GATHER"],
            GatherVariant::ShortWay => &["TEXTURE_GATHER", "SHORT_WAY"],
        }
    }
}

/// Tile bounds, tile spans, march. Reads depth about four times and colour once per target pixel, writes the
/// target; the intermediate buffers are 4 bytes per tile of 16 x 8 pixels.
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
        Gather::with_variant(gl, outputs, GatherVariant::of(gl.capabilities()))
    }

    /// As [`Gather::new`], as on another kind of driver: for tests of what this one would not take.
    ///
    /// # Errors
    /// As [`Gather::new`]; also where the driver is older than the variant.
    #[doc(hidden)]
    pub fn with_variant(
        gl: &Rc<Context>,
        outputs: Outputs,
        variant: GatherVariant,
    ) -> Result<Gather, GlError> {
        Gather::with_defines(gl, outputs, variant.defines())
    }

    /// What GPUs run, with counts for colours: in the target's red how often a pixel runs the loop of the short way (low four
    /// bits) and of the fill (the next two), and whether it goes the long way (the highest bit); in green, blue and alpha how
    /// many columns it walks there, in how many rounds, and past how many tiles (of 255, and no more than that).
    ///
    /// # Errors
    /// As [`Gather::with_variant`].
    #[doc(hidden)]
    pub fn counting(gl: &Rc<Context>) -> Result<Gather, GlError> {
        let defines = [GatherVariant::ShortWay.defines(), &["COUNT_TRIPS"]].concat();
        Gather::with_defines(gl, Outputs::default(), &defines)
    }

    fn with_defines(gl: &Rc<Context>, outputs: Outputs, variant: &[&'static str]) -> Result<Gather, GlError> {
        let variant: Vec<_> = variant.iter().map(|&name| (name, String::new())).collect();
        let march: Vec<_> = outputs.defines().into_iter().chain(variant.clone()).collect();
        let program = |file, defines: &[_]| Program::new(gl, ShaderSource::Screen(file), defines);
        let map = || RenderTarget::new(gl, [1, 1], &[(Format::R32Ui, Filter::Nearest)], None);
        Ok(Gather {
            gl: gl.clone(),
            outputs,
            bounds: program("synthesis/gather/tiles.frag", &variant)?,
            spans: program("synthesis/gather/spans.frag", &[])?,
            march: program("synthesis/gather/march.frag", &march)?,
            tile_map: map()?,
            span_map: map()?,
        })
    }
}

impl Synthesis for Gather {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        self.tile_map.resize(tiles(warp.source_size))?;
        self.span_map.resize(tiles([warp.target_size[0], warp.source_size[1]]))
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        self.gl.set_first_unit();
        self.prepare(warp)?;
        self.gl.begin_synthesis(self.outputs.draw_buffers(), self.outputs.srgb);
        let gl = &self.gl;
        let uniforms = Uniforms::new(warp, target.origin);
        gl.pass("gather tiles", || {
            self.tile_map.bind();
            set_source(self.bounds.bind(), source, &uniforms);
            gl.draw_screen();
        });
        gl.pass("gather spans", || {
            self.span_map.bind();
            set_source(self.spans.bind(), source, &uniforms);
            self.spans.texture("tile_map", 2, self.tile_map.color(0).raw());
            gl.draw_screen();
        });
        gl.pass("gather march", || {
            set_source(self.march.bind(), source, &uniforms);
            self.march.texture("tile_map", 2, self.tile_map.color(0).raw());
            self.march.texture("span_map", 3, self.span_map.color(0).raw());
            draw_target(gl, target, self.outputs);
        });
        gl.end_synthesis();
        Ok(())
    }
}
