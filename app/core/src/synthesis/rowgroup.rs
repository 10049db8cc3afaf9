//! The rowgroup pipeline: one compute workgroup per row, then a resolve pass.

use std::rc::Rc;

use glow::HasContext;

use super::{Outputs, Source, Synthesis, Uniforms, draw_target, output_defines, set_source};
use crate::eyes::Warp;
use crate::gl::{Context, Destination, Filter, Format, GlError, Program, ShaderSource, Texture};

/// Invocations per row.
const THREADS: u32 = 64;

/// Scatter by atomicMin in shared memory, then one fetch per pixel. Reads depth twice and colour once, writes
/// and reads a 4-byte source map per pixel.
pub struct Rowgroup {
    gl: Rc<Context>,
    outputs: Outputs,
    scatter: Program,
    /// Row width in pixels that the scatter program was compiled for.
    capacity: u32,
    resolve: Program,
    source_map: Option<Texture>,
}

impl Rowgroup {
    /// Compiles the passes for images of up to 2048 pixels width, or fewer where the driver has less than 8 KiB
    /// of shared memory; wider ones recompile once in [`Synthesis::prepare`].
    ///
    /// # Errors
    /// [`GlError::Unsupported`] without OpenGL ES 3.1.
    pub fn new(gl: &Rc<Context>, outputs: Outputs) -> Result<Rowgroup, GlError> {
        let capacity = 2048.min(gl.capabilities().max_compute_shared_memory / 4);
        let resolve = ShaderSource::Screen("synthesis/rowgroup/resolve.frag");
        Ok(Rowgroup {
            gl: gl.clone(),
            outputs,
            scatter: scatter_program(gl, capacity)?,
            capacity,
            resolve: Program::new(gl, resolve, &output_defines(outputs))?,
            source_map: None,
        })
    }
}

fn scatter_program(gl: &Rc<Context>, capacity: u32) -> Result<Program, GlError> {
    let defines = [("THREADS", THREADS.to_string()), ("KEYS", capacity.to_string())];
    Program::new(gl, ShaderSource::Compute("synthesis/rowgroup/scatter.comp"), &defines)
}

impl Synthesis for Rowgroup {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        let width = warp.target_size[0];
        let limit = self.gl.capabilities().max_compute_shared_memory / 4;
        if width > limit {
            return Err(GlError::Unsupported(format!(
                "an eye of {width} pixels width does not fit the {} KiB of shared memory that the rowgroup pipeline has on {}; choose the pipeline gather",
                limit / 256,
                self.gl.capabilities().renderer
            )));
        }
        if width > self.capacity {
            self.scatter = scatter_program(&self.gl, limit)?;
            self.capacity = limit;
        }
        if self.source_map.as_ref().is_none_or(|map| map.size() != warp.target_size) {
            self.source_map = None;
            self.source_map = Some(Texture::new(&self.gl, warp.target_size, Format::R32Ui, Filter::Nearest)?);
        }
        Ok(())
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        self.gl.set_first_unit();
        self.prepare(warp)?;
        self.gl.begin_synthesis(self.outputs.draw_buffers(), self.outputs.srgb);
        let Some(map) = self.source_map.as_ref().map(Texture::raw) else { return Ok(()) };
        let gl = &self.gl;
        let uniforms = Uniforms::new(warp, target.origin);
        gl.pass("rowgroup scatter", || {
            set_source(self.scatter.bind(), source, &uniforms);
            let raw = gl.raw();
            // SAFETY: the image is an immutable R32UI texture of the target's size; one workgroup per row.
            unsafe {
                raw.bind_image_texture(0, Some(map), 0, false, 0, glow::WRITE_ONLY, glow::R32UI);
                raw.dispatch_compute(warp.target_size[1], 1, 1);
                raw.memory_barrier(glow::TEXTURE_FETCH_BARRIER_BIT);
            }
        });
        gl.pass("rowgroup resolve", || {
            set_source(self.resolve.bind(), source, &uniforms);
            self.resolve.texture("source_map", 2, map);
            draw_target(gl, target, self.outputs);
        });
        gl.end_synthesis();
        Ok(())
    }
}
