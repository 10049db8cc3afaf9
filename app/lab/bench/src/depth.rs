//! Reading back the depth of a rendered view.

use std::rc::Rc;

use yoro_gl::{Context, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture};

/// Copies depth into a colour target, from which every driver can read it.
pub struct DepthReader {
    gl: Rc<Context>,
    copy: Program,
    target: RenderTarget,
}

impl DepthReader {
    /// Compiles the copy.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses the program or the target.
    pub fn new(gl: &Rc<Context>) -> Result<DepthReader, GlError> {
        Ok(DepthReader {
            gl: gl.clone(),
            copy: Program::new(gl, ShaderSource::Screen("render/depth_copy.frag"), &[])?,
            target: RenderTarget::new(gl, [1, 1], &[(Format::R32F, Filter::Nearest)], None)?,
        })
    }

    /// Copies the depth of a view of this size in pixels.
    ///
    /// # Errors
    /// [`GlError`] when the driver has no memory for the target.
    pub fn copy(&mut self, depth: &Texture, size: [u32; 2]) -> Result<(), GlError> {
        self.target.resize(size)?;
        self.target.bind();
        self.gl.set_raster_state(&RasterState::SCREEN);
        self.copy.bind().texture("source", 0, depth.raw());
        self.gl.draw_screen();
        Ok(())
    }

    /// Returns the depth that was copied last, 0 to 1, rows from the bottom.
    pub fn read(&self) -> Vec<f32> {
        let texels = self.target.read_rgba32f(0, [0, 0], self.target.size());
        texels.into_iter().map(|texel| texel[0]).collect()
    }
}
