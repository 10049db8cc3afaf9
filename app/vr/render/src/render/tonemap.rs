//! Tone mapping: scene-referred to display-referred colour.

use std::rc::Rc;

use glam::IVec2;

use super::bloom;
use yoro_gl::{Context, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture};

/// Adds bloom, applies exposure and the tone curve, encodes as sRGB.
///
/// Reads scene-referred colour and bloom, writes 8-bit colour with luma in alpha.
pub struct TonemapPass {
    gl: Rc<Context>,
    program: Program,
}

impl TonemapPass {
    /// Compiles the program; `defines` are those of `include/hdr.glsl`, and `BLOOM`.
    pub fn new(gl: &Rc<Context>, defines: &[(&'static str, String)]) -> Result<TonemapPass, GlError> {
        let program = Program::new(gl, ShaderSource::Screen("render/tonemap.frag"), defines)?;
        Ok(TonemapPass { gl: gl.clone(), program })
    }

    /// Writes all of `target`. Only columns `[first, end]` of the source are valid; the edge columns are repeated.
    pub fn run(
        &self,
        target: &RenderTarget,
        (source, [first, end]): (&Texture, [u32; 2]),
        bloom: Option<&Texture>,
        exposure: f32,
    ) {
        self.gl.pass("tonemap", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            target.bind();
            self.program
                .bind()
                .texture("source", 0, source.raw())
                .set("columns", IVec2::new(first as i32, end as i32 - 1))
                .set("exposure", exposure);
            if let Some(bloom) = bloom {
                self.program.texture("bloom", 1, bloom.raw()).set("bloom_strength", bloom::STRENGTH);
            }
            self.gl.draw_screen();
        });
    }
}
