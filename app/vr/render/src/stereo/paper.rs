//! The paper's pipeline: Algorithms 1 to 3 with its options, as corrected.

use std::rc::Rc;

use glam::{IVec2, Vec2};
use glow::HasContext;

use super::pipeline::Synthesis;
use yoro::eyes::Warp;
use yoro::opengl::{Outputs, Source, draw_target, set_source};
use yoro::synthesis::Uniforms;
use yoro_gl::{Context, Destination, Filter, Format, GlError, Program, RenderTarget, ShaderSource};
pub use yoro_settings::{ImBufferSize, ParseImBufferSizeError};

/// Rows per workgroup of Algorithm 2, with one invocation for each row.
const ROWS: u32 = 64;

/// Height of the patcher's kernel in rows, `h` of Algorithm 3.
const KERNEL_HEIGHT: i32 = 3;

/// Options of the paper's pipeline.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PaperOptions {
    /// Resolution of the ImBuffer, section "(c) Resolution-Independent Intermediate Buffers".
    pub imbuffer: ImBufferSize,
    /// Interpolates the shift between ImBuffer entries, section "(d) Linear Interpolation".
    pub linear_interpolation: bool,
    /// Stores whole source columns and samples one depth per ImBuffer pixel, as in Algorithm 2. Otherwise the
    /// fractional column is stored, and the nearest depth of the block is taken.
    pub strict: bool,
}

impl Default for PaperOptions {
    fn default() -> PaperOptions {
        PaperOptions { imbuffer: ImBufferSize::Divisor(1), linear_interpolation: true, strict: false }
    }
}

/// A fragment shader, a compute shader for each row, and a fragment shader. Algorithm 1 reads depth and writes 4 bytes
/// per ImBuffer pixel. Algorithm 2 reads those, and reads and writes 4 bytes per ImBuffer pixel, serially along each
/// row. Algorithm 3 reads the ImBuffer and colour.
pub struct Paper {
    gl: Rc<Context>,
    outputs: Outputs,
    options: PaperOptions,
    reproject: Program,
    scatter: Program,
    patch: Program,
    written_to: RenderTarget,
    imbuffer: RenderTarget,
    scale: Vec2,
}

impl Paper {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] without OpenGL ES 3.1 or float render targets.
    pub fn new(gl: &Rc<Context>, outputs: Outputs, options: PaperOptions) -> Result<Paper, GlError> {
        let strict = if options.strict { vec![("STRICT", String::new())] } else { Vec::new() };
        let mut scatter = strict.clone();
        scatter.push(("ROWS", ROWS.to_string()));
        let mut patch = outputs.defines();
        if options.linear_interpolation && options.imbuffer != ImBufferSize::Divisor(1) {
            patch.push(("LINEAR", String::new()));
        }
        let map = |format| RenderTarget::new(gl, [1, 1], &[(format, Filter::Nearest)], None);
        Ok(Paper {
            gl: gl.clone(),
            outputs,
            options,
            scatter: Program::new(gl, ShaderSource::Compute("stereo/paper/scatter.comp"), &scatter)?,
            reproject: Program::new(gl, ShaderSource::Screen("stereo/paper/reproject.frag"), &strict)?,
            patch: Program::new(gl, ShaderSource::Screen("stereo/paper/patch.frag"), &patch)?,
            written_to: map(Format::R32F)?,
            imbuffer: map(Format::R32Ui)?,
            scale: Vec2::ONE,
        })
    }

    fn set_imbuffer(&self, program: &Program) {
        let size = |target: &RenderTarget| IVec2::new(target.size()[0] as i32, target.size()[1] as i32);
        program
            .set("imbuffer_source_size", size(&self.written_to))
            .set("imbuffer_target_size", size(&self.imbuffer))
            .set("imbuffer_scale", self.scale);
    }
}

impl Synthesis for Paper {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        let [width, height] = warp.target_size.map(|n| n as f32);
        self.scale = match self.options.imbuffer {
            ImBufferSize::Divisor(n) => Vec2::splat(n.max(1) as f32),
            ImBufferSize::Fixed([w, h]) => Vec2::new(width / w.max(1) as f32, height / h.max(1) as f32),
        };
        let pixels = |n: u32, scale: f32| ((n as f32 / scale - 1e-3).ceil() as u32).max(1);
        // Both buffers have the source's rows.
        let rows = pixels(warp.source_size[1], self.scale.y);
        self.written_to.resize([pixels(warp.source_size[0], self.scale.x), rows])?;
        self.imbuffer.resize([pixels(warp.target_size[0], self.scale.x), rows])
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        self.gl.set_first_unit();
        self.prepare(warp)?;
        self.gl.begin_synthesis(self.outputs.draw_buffers(), self.outputs.srgb);
        if source.stored {
            self.gl.read_stored();
        }
        let gl = &self.gl;
        let raw = gl.raw();
        let uniforms = Uniforms::new(warp, target.origin);
        gl.pass("paper reproject").write(self.written_to.images()).run(|| {
            self.written_to.bind();
            set_source(self.reproject.bind(), source, &uniforms);
            self.set_imbuffer(&self.reproject);
            gl.draw_screen();
        });
        let pass = gl.pass("paper scatter").read("written_to_map", self.written_to.color(0));
        pass.write(self.imbuffer.images()).run(|| {
            self.imbuffer.bind();
            let imbuffer = self.imbuffer.color(0).raw();
            set_source(self.scatter.bind(), source, &uniforms);
            self.set_imbuffer(&self.scatter);
            self.scatter.texture("written_to_map", 2, self.written_to.color(0).raw());
            // SAFETY: the image is an immutable R32UI texture; the shader checks its row.
            unsafe {
                raw.clear_buffer_u32_slice(glow::COLOR, 0, &[u32::MAX; 4]);
                raw.bind_image_texture(0, Some(imbuffer), 0, false, 0, glow::READ_WRITE, glow::R32UI);
                raw.dispatch_compute(1, self.imbuffer.size()[1].div_ceil(ROWS), 1);
                raw.memory_barrier(glow::TEXTURE_FETCH_BARRIER_BIT);
            }
        });
        let pass = gl.pass("paper patch").read("imbuffer", self.imbuffer.color(0));
        pass.write([target.image(Format::Rgba8)]).run(|| {
            set_source(self.patch.bind(), source, &uniforms);
            self.set_imbuffer(&self.patch);
            self.patch.set("kernel_height", KERNEL_HEIGHT);
            self.patch.texture("imbuffer", 2, self.imbuffer.color(0).raw());
            draw_target(gl, target, self.outputs);
        });
        gl.end_synthesis();
        Ok(())
    }
}
