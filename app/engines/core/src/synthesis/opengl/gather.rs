//! The gather pipeline: three fragment passes.

use std::rc::Rc;

use super::{
    HistoryBinding, Outputs, Source, Synthesis, SynthesisOptions, draw_target, map_sizes, march_source,
};
use crate::eyes::Warp;
use crate::synthesis::uniforms::Uniforms;
use yoro_gl::{
    Capabilities, Context, Destination, Filter, Format, GlError, Program, RenderTarget, ShaderSource,
};

/// Variants of the shaders for kinds of drivers. All give the same picture, within the rounding of positions; in tiles
/// that have a law, within an eighth of a pixel.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GatherVariant {
    /// For OpenGL ES 3.0: each depth value is fetched separately, and all pixels march in one loop.
    Plain,
    /// For CPU rasterizers, which execute every fetch in the shader, taken or not: textureGather for the tiles only.
    Software,
    /// For GPUs: textureGather, laws of tiles, and a short path that settles nearly all other pixels before the loop.
    ShortWay,
}

impl GatherVariant {
    /// All variants.
    pub const ALL: [GatherVariant; 3] =
        [GatherVariant::Plain, GatherVariant::Software, GatherVariant::ShortWay];

    fn of(capabilities: &Capabilities) -> GatherVariant {
        match capabilities {
            // OpenGL ES 3.1 has both compute shaders and textureGather.
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

/// The gather pipeline: tile bounds, tile spans, march. Its two intermediate buffers have 16 bytes per tile of 16 x 8
/// pixels.
pub struct Gather {
    gl: Rc<Context>,
    outputs: Outputs,
    options: SynthesisOptions,
    bounds: Program,
    spans: Program,
    march: Program,
    tile_map: RenderTarget,
    span_map: RenderTarget,
    history_binding: Option<HistoryBinding>,
}

impl Gather {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`GlError::Shader`] if the driver refuses a shader.
    pub fn new(gl: &Rc<Context>, outputs: Outputs) -> Result<Gather, GlError> {
        Gather::with_options(gl, outputs, &SynthesisOptions::default())
    }

    /// Compiles the passes for the kind of source that the options select.
    pub(super) fn with_options(
        gl: &Rc<Context>,
        outputs: Outputs,
        options: &SynthesisOptions,
    ) -> Result<Gather, GlError> {
        Gather::with_variant_of(gl, outputs, GatherVariant::of(gl.capabilities()), options)
    }

    /// Compiles a variant that need not be this driver's, for any kind of source; for tests.
    ///
    /// # Errors
    /// Those of [`Gather::with_variant`].
    #[doc(hidden)]
    pub fn with_variant_of(
        gl: &Rc<Context>,
        outputs: Outputs,
        variant: GatherVariant,
        options: &SynthesisOptions,
    ) -> Result<Gather, GlError> {
        Gather::with_defines(gl, outputs, variant.defines(), options)
    }

    /// Compiles a variant that need not be this driver's; for tests.
    ///
    /// # Errors
    /// Those of [`Gather::new`], also if the driver is too old for the variant.
    #[doc(hidden)]
    pub fn with_variant(
        gl: &Rc<Context>,
        outputs: Outputs,
        variant: GatherVariant,
    ) -> Result<Gather, GlError> {
        Gather::with_variant_of(gl, outputs, variant, &SynthesisOptions::default())
    }

    /// Compiles the variant for GPUs, with counts instead of colours. Red: steps on the short path (low three bits),
    /// then one bit each for a hole, the long path, and a law. Green: segments. Blue: events. Alpha: steps to a
    /// segment's crossing.
    ///
    /// # Errors
    /// Those of [`Gather::with_variant`].
    #[doc(hidden)]
    pub fn counting(gl: &Rc<Context>) -> Result<Gather, GlError> {
        let defines = [GatherVariant::ShortWay.defines(), &["COUNT_TRIPS"]].concat();
        Gather::with_defines(gl, Outputs::default(), &defines, &SynthesisOptions::default())
    }

    fn with_defines(
        gl: &Rc<Context>,
        outputs: Outputs,
        variant: &[&'static str],
        options: &SynthesisOptions,
    ) -> Result<Gather, GlError> {
        let variant = variant.iter().map(|&name| (name, String::new())).chain(options.defines());
        let variant: Vec<_> = variant.collect();
        let march = [outputs.defines(), variant.clone(), options.last_pass_defines()].concat();
        let program = |file, defines: &[_]| Program::new(gl, ShaderSource::Screen(file), defines);
        let map = || RenderTarget::new(gl, [1, 1], &[(Format::Rgba32Ui, Filter::Nearest)], None);
        Ok(Gather {
            gl: gl.clone(),
            outputs,
            options: *options,
            bounds: program("synthesis/gather/tiles.frag", &variant)?,
            spans: program("synthesis/gather/spans.frag", &variant)?,
            march: Program::new(gl, march_source("synthesis/gather/march.frag"), &march)?,
            tile_map: map()?,
            span_map: map()?,
            history_binding: options.history_binding(gl)?,
        })
    }
}

impl Synthesis for Gather {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        let [tile_size, span_size] = map_sizes(warp);
        self.tile_map.resize(self.options.buffer_size(self.tile_map.size(), tile_size))?;
        self.span_map.resize(self.options.buffer_size(self.span_map.size(), span_size))
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        self.gl.set_first_unit();
        self.prepare(warp)?;
        self.gl.begin_synthesis(self.outputs.draw_buffers(), self.outputs.srgb);
        let gl = &self.gl;
        let [tile_size, span_size] = map_sizes(warp);
        let uniforms = Uniforms::of_part(warp, &source.places(warp.source_size, target, self.options.parts));
        let set_source = |program: &Program| {
            self.options.bind_source(program, source);
            uniforms.set(program);
        };
        gl.pass("gather tiles", || {
            self.tile_map.bind_part(tile_size);
            set_source(self.bounds.bind());
            gl.draw_screen();
        });
        gl.pass("gather spans", || {
            self.span_map.bind_part(span_size);
            set_source(self.spans.bind());
            self.spans.texture("tile_map", 2, self.tile_map.color(0).raw());
            gl.draw_screen();
        });
        gl.pass("gather march", || {
            set_source(self.march.bind());
            self.march.texture("tile_map", 2, self.tile_map.color(0).raw());
            self.march.texture("span_map", 3, self.span_map.color(0).raw());
            if let Some(binding) = &self.history_binding {
                binding.set(&self.march, source.history, 4);
            }
            draw_target(gl, target, self.outputs);
        });
        gl.end_synthesis();
        Ok(())
    }
}
