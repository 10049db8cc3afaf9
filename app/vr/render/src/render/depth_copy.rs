//! Depth for compositors that reproject images with it.

use std::rc::Rc;

use glam::IVec2;

use super::role::RoleKind;
use super::transparent::DepthImage;
use yoro_gl::{Context, Destination, GlError, Program, RasterState, ShaderSource};

/// Copies window depth into a framebuffer's depth attachment, which may have any depth format.
pub struct DepthCopy {
    gl: Rc<Context>,
    program: Program,
    /// Copies depth from layers of array textures. `None` without multiview.
    layered: Option<Program>,
}

impl DepthCopy {
    /// Compiles the programs.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn new(gl: &Rc<Context>) -> Result<DepthCopy, GlError> {
        let compile = |role: RoleKind| {
            let defines: Vec<_> = role.define().into_iter().collect();
            Program::new(gl, ShaderSource::Screen("render/depth_write.frag"), &defines)
        };
        let layered = gl.capabilities().multiview.then(|| compile(RoleKind::Layer)).transpose()?;
        Ok(DepthCopy { gl: gl.clone(), program: compile(RoleKind::Whole)?, layered })
    }

    /// Writes the destination's depth.
    pub fn run(&self, from: DepthImage, to: &Destination) {
        let program = match (from.layer, &self.layered) {
            (Some(_), Some(layered)) => layered,
            _ => &self.program,
        };
        self.gl.pass("depth copy", || {
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            let offset =
                IVec2::from(from.origin.map(|n| n as i32)) - IVec2::from(to.origin.map(|n| n as i32));
            program
                .bind()
                .texture_of("depth_map", 0, from.texture)
                .set("offset", offset)
                .set("view_layer", from.layer.unwrap_or(0) as i32);
            self.gl.draw_screen();
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }
}
