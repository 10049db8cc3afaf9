//! The gather pipeline: three fragment passes.

use std::rc::Rc;

use super::{Outputs, Source, Synthesis, draw_target, set_source};
use crate::eyes::Warp;
use crate::synthesis::uniforms::{Uniforms, tiles};
use yoro_gl::{
    Capabilities, Context, Destination, Filter, Format, GlError, Program, RenderTarget, ShaderSource,
};

/// Variants of the shaders for kinds of drivers. All give the same picture, within the rounding of positions.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GatherVariant {
    /// For OpenGL ES 3.0: every depth value is a fetch, every pixel marches in one loop.
    Plain,
    /// For CPU rasterizers, which execute every fetch in the text, taken or not: textureGather for the tiles only.
    Software,
    /// For GPUs: textureGather, and a short path on which nearly every pixel ends before the loop.
    ShortWay,
}

impl GatherVariant {
    /// All variants.
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

/// Tile bounds, tile spans, march. Reads depth about four times and colour once per target pixel. The two intermediate
/// buffers have 4 bytes per tile of 16 x 8 pixels.
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
    /// [`GlError::Shader`] if the driver refuses a shader.
    pub fn new(gl: &Rc<Context>, outputs: Outputs) -> Result<Gather, GlError> {
        Gather::with_variant(gl, outputs, GatherVariant::of(gl.capabilities()))
    }

    /// Compiles a variant that this driver would not choose, for tests.
    ///
    /// # Errors
    /// Those of [`Gather::new`], also if the driver is too old for the variant.
    #[doc(hidden)]
    pub fn with_variant(
        gl: &Rc<Context>,
        outputs: Outputs,
        variant: GatherVariant,
    ) -> Result<Gather, GlError> {
        Gather::with_defines(gl, outputs, variant.defines())
    }

    /// Compiles the variant for GPUs with counts in place of colours. Red: trips of the short path's loop (low four bits) and
    /// of the fill's (the next two), and whether the pixel takes the long path (the highest bit). Green, blue and alpha:
    /// columns walked on the long path, its rounds, and the tiles passed, at most 255 each.
    ///
    /// # Errors
    /// Those of [`Gather::with_variant`].
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
