//! Reading back what was rendered, for files, streams and measurements. In all arrays rows run from the bottom, as in
//! GL.

use std::rc::Rc;

use super::depth::{DepthImage, DepthProgram};
use super::renderer::{Renderer, ViewTargets};
use super::scene::GpuScene;
use yoro::eyes::View;
use yoro_gl::{Context, Filter, Format, GlError, RasterState, RenderTarget};

/// Copies depth into a colour target, from which every driver can read it.
pub struct DepthReader {
    gl: Rc<Context>,
    copy: DepthProgram,
    target: RenderTarget,
}

impl DepthReader {
    /// Makes the target.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses the target.
    pub fn new(gl: &Rc<Context>) -> Result<DepthReader, GlError> {
        Ok(DepthReader {
            gl: gl.clone(),
            copy: DepthProgram::new(gl, "render/depth_copy.frag"),
            target: RenderTarget::new(gl, [1, 1], &[(Format::R32F, Filter::Nearest)], None)?,
        })
    }

    /// Copies the depth of a view of this size in pixels.
    ///
    /// # Errors
    /// [`GlError`] when the driver has no memory for the target, or refuses the program.
    pub fn copy(&mut self, depth: &DepthImage, size: [u32; 2]) -> Result<(), GlError> {
        self.target.resize(size)?;
        self.target.bind();
        self.gl.set_raster_state(&RasterState::SCREEN);
        self.copy.bind(depth)?;
        self.gl.draw_screen();
        Ok(())
    }

    /// Returns the depth that was copied last, 0 to 1.
    pub fn read(&self) -> Vec<f32> {
        let texels = self.target.read_rgba32f(0, [0, 0], self.target.size());
        texels.into_iter().map(|texel| texel[0]).collect()
    }
}

/// Renders views with everything in them, and reads them back.
pub struct ViewReader {
    targets: ViewTargets,
    depth: DepthReader,
}

impl ViewReader {
    /// Compiles the programs.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a target.
    pub fn new(gl: &Rc<Context>) -> Result<ViewReader, GlError> {
        Ok(ViewReader { targets: ViewTargets::default(), depth: DepthReader::new(gl)? })
    }

    /// Returns a view's RGBA, 8 bits each, including transparent objects.
    ///
    /// # Errors
    /// [`GlError`] beyond the driver's limits.
    pub fn color(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        view: &View,
    ) -> Result<Vec<u8>, GlError> {
        let rendered = renderer.render_all(&mut self.targets, scene, view)?;
        self.depth.copy(&rendered.depth, view.size)?;
        Ok(rendered.color.read_rgba8(0, [0, 0], view.size))
    }

    /// Returns the depth buffer of the view whose colour was returned last, 0 to 1; transparent objects are not in it.
    pub fn depth(&self) -> Vec<f32> {
        self.depth.read()
    }
}
