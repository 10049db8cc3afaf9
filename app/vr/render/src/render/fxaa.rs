//! Anti-aliasing of a finished image.

use std::rc::Rc;

use glam::IVec2;

use yoro_gl::{Context, Destination, GlError, Program, RasterState, ShaderSource, Texture};

/// Smooths edges (FXAA). Runs on one eye's image after synthesis, so that synthesis never moves blended edge colours.
///
/// Reads display-referred colour with luma in alpha and a linear filter; writes the same.
pub struct Fxaa {
    gl: Rc<Context>,
    program: Program,
}

impl Fxaa {
    /// Compiles the program.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn new(gl: &Rc<Context>) -> Result<Fxaa, GlError> {
        let program = Program::new(gl, ShaderSource::Screen("render/fxaa.frag"), &[])?;
        Ok(Fxaa { gl: gl.clone(), program })
    }

    /// Writes `to` from the rectangle of its size in `source` whose lower left corner is pixel `crop`. Reads up to two
    /// pixels beyond the rectangle's border where the source has them.
    pub fn run(&self, source: &Texture, crop: [u32; 2], to: &Destination) {
        self.gl.pass("fxaa", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.gl.overwrite(to, 1, false);
            let offset = IVec2::from(crop.map(|n| n as i32)) - IVec2::from(to.origin.map(|n| n as i32));
            self.program.bind().texture("source", 0, source.raw()).set("offset", offset);
            self.gl.draw_screen();
        });
    }
}
