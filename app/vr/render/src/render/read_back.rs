//! Reading back what was rendered, for files, streams and measurements. In all arrays rows run from the bottom, as in
//! GL.

use std::rc::Rc;

use super::fxaa::Fxaa;
use super::renderer::{Renderer, ViewTargets};
use super::scene::GpuScene;
use yoro::eyes::View;
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};

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

    /// Returns the depth that was copied last, 0 to 1.
    pub fn read(&self) -> Vec<f32> {
        let texels = self.target.read_rgba32f(0, [0, 0], self.target.size());
        texels.into_iter().map(|texel| texel[0]).collect()
    }
}

/// Renders views with everything in them, and reads them back.
pub struct ViewReader {
    targets: ViewTargets,
    fxaa: Option<Fxaa>,
    smooth: RenderTarget,
    depth: DepthReader,
}

impl ViewReader {
    /// Compiles the programs. `anti_aliasing` applies FXAA to what is rendered.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target.
    pub fn new(gl: &Rc<Context>, anti_aliasing: bool) -> Result<ViewReader, GlError> {
        Ok(ViewReader {
            targets: ViewTargets::default(),
            fxaa: anti_aliasing.then(|| Fxaa::new(gl)).transpose()?,
            smooth: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], None)?,
            depth: DepthReader::new(gl)?,
        })
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
        self.depth.copy(rendered.depth, view.size)?;
        let mut color = rendered.color;
        if let Some(fxaa) = &self.fxaa {
            self.smooth.resize(view.size)?;
            fxaa.run(color.color(0), [0, 0], &Destination::whole(&self.smooth));
            color = &self.smooth;
        }
        Ok(color.read_rgba8(0, [0, 0], view.size))
    }

    /// Returns the depth buffer of the view whose colour was returned last, 0 to 1; transparent objects are not in it.
    pub fn depth(&self) -> Vec<f32> {
        self.depth.read()
    }
}
