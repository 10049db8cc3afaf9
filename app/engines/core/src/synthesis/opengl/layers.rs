//! The gather pipeline for anti-aliased sources: four fragment passes.

use std::rc::Rc;

use glam::IVec4;
use glow::HasContext as _;

use super::{
    HistoryBinding, Outputs, Source, Synthesis, SynthesisOptions, draw_target, map_sizes, march_source,
};
use crate::eyes::Warp;
use crate::synthesis::edges::Edges;
use crate::synthesis::uniforms::Uniforms;
use yoro_gl::{Context, Destination, Filter, Format, GlError, Program, RenderTarget, ShaderSource};

/// Number of draw buffers that the passes use: the split pass writes two.
pub(super) const DRAW_BUFFERS: u32 = 2;

/// The samples from left to right in the standard patterns of 2 and 4 samples (Vulkan's `standardSampleLocations`).
/// Each sample represents the stripes of the pixel nearest to it.
const STANDARD_2: IVec4 = IVec4::new(1, 1, 0, 0);
const STANDARD_4: IVec4 = IVec4::new(2, 0, 3, 1);

/// Split, tile bounds, tile spans, march over layers.
///
/// The split pass finds the one or two surfaces that each source pixel shows, and writes 8 bytes per source pixel. The
/// march composes the surfaces that cover a target pixel, front to back, so that the synthesized eye is as anti-aliased
/// as the rendered one.
pub struct Layers {
    gl: Rc<Context>,
    outputs: Outputs,
    options: SynthesisOptions,
    split: Split,
    bounds: Program,
    spans: Program,
    march: Program,
    /// The layers, and the colour of the back surfaces.
    layers: RenderTarget,
    tile_map: RenderTarget,
    span_map: RenderTarget,
    history_binding: Option<HistoryBinding>,
}

/// The first pass, for sources without and with sample colours.
struct Split {
    resolved: Program,
    /// For sources with sample colours.
    samples: Option<Program>,
}

impl Layers {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for [`Edges::Hard`], which needs [`super::Gather`], and for [`Edges::Multisample`]
    /// without OpenGL ES 3.1; [`GlError::Shader`] if the driver refuses a shader.
    pub fn new(gl: &Rc<Context>, outputs: Outputs, edges: Edges) -> Result<Layers, GlError> {
        Layers::with_options(gl, outputs, &SynthesisOptions { edges, ..SynthesisOptions::default() })
    }

    /// Compiles the passes with counts instead of colours. Red: columns of the march's first loop. Green and blue:
    /// pairs of columns in which something happens, and all pairs that the second loop visits. Alpha: rows of its fill,
    /// and in the highest bit whether the source pixel at the same place shows two surfaces. All counts are clamped to
    /// 255.
    ///
    /// # Errors
    /// Those of [`Layers::new`].
    #[doc(hidden)]
    pub fn counting(gl: &Rc<Context>, edges: Edges) -> Result<Layers, GlError> {
        let options = SynthesisOptions { edges, ..SynthesisOptions::default() };
        Layers::with_defines(gl, Outputs::default(), &options, &[("COUNT_TRIPS", String::new())])
    }

    /// Compiles the passes for the kind of source that the options select.
    pub(super) fn with_options(
        gl: &Rc<Context>,
        outputs: Outputs,
        options: &SynthesisOptions,
    ) -> Result<Layers, GlError> {
        Layers::with_defines(gl, outputs, options, &[])
    }

    fn with_defines(
        gl: &Rc<Context>,
        outputs: Outputs,
        options: &SynthesisOptions,
        counts: &[(&'static str, String)],
    ) -> Result<Layers, GlError> {
        let edges = options.edges;
        let define = match edges {
            Edges::Hard => {
                return Err(GlError::Unsupported(
                    "hard edges have no layers; use the gather pipeline".into(),
                ));
            }
            Edges::Nearest => None,
            Edges::Sample => Some("FIRST_SAMPLE"),
            Edges::Multisample => Some("MULTISAMPLE"),
        };
        if edges == Edges::Multisample && !gl.capabilities().multisample_textures {
            return Err(GlError::Unsupported(format!(
                "{} has no multisample textures (OpenGL ES 3.1); hand over resolved colour and the nearest depth",
                gl.capabilities().renderer
            )));
        }
        if edges == Edges::Multisample && options.array_textures {
            return Err(GlError::Unsupported(
                "layers of multisample arrays cannot be synthesized; hand over resolved colour and the nearest depth".into(),
            ));
        }
        let program = |file, defines: &[_]| Program::new(gl, ShaderSource::Screen(file), defines);
        let sources = options.defines();
        let edge_defines = define.into_iter().map(|name| (name, String::new())).chain(sources.clone());
        let edge_defines: Vec<_> = edge_defines.collect();
        let of_samples = [edge_defines.clone(), vec![("SAMPLE_COLORS", String::new())]].concat();
        let march = [&edge_defines[..], &outputs.defines(), &options.last_pass_defines(), counts].concat();
        let split = "synthesis/layers/split.frag";
        let map = || RenderTarget::new(gl, [1, 1], &[(Format::R32Ui, Filter::Nearest)], None);
        // Back surfaces are stored like the source's colour: unmixing must happen in the colour space of the resolve.
        let back = if outputs.srgb { Format::Srgb8Alpha8 } else { Format::Rgba8 };
        let layers = [(Format::R32Ui, Filter::Nearest), (back, Filter::Nearest)];
        Ok(Layers {
            gl: gl.clone(),
            outputs,
            options: *options,
            split: Split {
                resolved: program(split, &edge_defines)?,
                samples: (edges == Edges::Multisample).then(|| program(split, &of_samples)).transpose()?,
            },
            bounds: program("synthesis/layers/tiles.frag", &sources)?,
            spans: program("synthesis/gather/spans.frag", &sources)?,
            march: Program::new(gl, march_source("synthesis/layers/march.frag"), &march)?,
            layers: RenderTarget::new(gl, [1, 1], &layers, None)?,
            tile_map: map()?,
            span_map: map()?,
            history_binding: options.history_binding(gl)?,
        })
    }

    /// Binds the program and the textures of the first pass.
    fn bind_split(&self, source: Source, uniforms: &Uniforms) {
        let program = match (&self.split.samples, source.samples) {
            (Some(program), Some(samples)) => program.bind().texture_multisample("sample_colors", 3, samples),
            _ => self.split.resolved.bind(),
        };
        if self.options.edges == Edges::Multisample {
            program.texture_multisample("sample_depths", 0, source.depth);
            program.set("from_left", self.left_to_right());
        } else {
            self.options.bind(program, "depth_map", 0, source.depth);
        }
        self.options.bind(program, "color_map", 1, source.color);
        program.set("source_layer", source.layer as i32);
        uniforms.set(program);
    }

    /// Returns the order from left to right of the samples of the multisample texture that is bound to the active unit.
    fn left_to_right(&self) -> IVec4 {
        // SAFETY: queries the texture that is bound to the active unit.
        let samples = unsafe {
            self.gl.raw().get_tex_level_parameter_i32(glow::TEXTURE_2D_MULTISAMPLE, 0, glow::TEXTURE_SAMPLES)
        };
        if samples == 2 { STANDARD_2 } else { STANDARD_4 }
    }
}

impl Synthesis for Layers {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        let [tile_size, span_size] = map_sizes(warp);
        self.layers.resize(self.options.buffer_size(self.layers.size(), warp.source_size))?;
        self.tile_map.resize(self.options.buffer_size(self.tile_map.size(), tile_size))?;
        self.span_map.resize(self.options.buffer_size(self.span_map.size(), span_size))
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        self.gl.set_first_unit();
        self.prepare(warp)?;
        self.gl.begin_synthesis(DRAW_BUFFERS, self.outputs.srgb);
        let gl = &self.gl;
        let [tile_size, span_size] = map_sizes(warp);
        let uniforms = Uniforms::of_part(warp, &source.places(warp.source_size, target, self.options.parts));
        gl.pass("layers split", || {
            self.layers.bind_part(warp.source_size);
            self.bind_split(source, &uniforms);
            gl.draw_screen();
        });
        let [layers, backs] = [0, 1].map(|i| self.layers.color(i).raw());
        gl.pass("layers tiles", || {
            self.tile_map.bind_part(tile_size);
            uniforms.set(self.bounds.bind().texture("layer_map", 2, layers));
            gl.draw_screen();
        });
        gl.pass("layers spans", || {
            self.span_map.bind_part(span_size);
            uniforms.set(self.spans.bind().texture("tile_map", 2, self.tile_map.color(0).raw()));
            gl.draw_screen();
        });
        gl.pass("layers march", || {
            let program = self.options.bind(self.march.bind(), "color_map", 1, source.color);
            program.set("source_layer", source.layer as i32);
            program.texture("span_map", 2, self.span_map.color(0).raw());
            program.texture("layer_map", 3, layers).texture("back_map", 4, backs);
            uniforms.set(program);
            if let Some(binding) = &self.history_binding {
                // The march does not read the source's depth.
                binding.set(program, source.history, 0);
            }
            draw_target(gl, target, self.outputs);
        });
        gl.end_synthesis();
        Ok(())
    }
}
