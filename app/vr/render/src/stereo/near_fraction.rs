//! The fraction of a view that is too near.

use std::rc::Rc;

use glam::IVec2;

use super::readback::Readback;
use crate::view::{DepthImage, DepthProgram};
use yoro::eyes::{DepthConvention, DepthRange};
use yoro_gl::{Context, GlError, Image, RasterState};

/// Texels per side of the image that [`NearFraction`] reads back, as in `stereo/near_fraction.frag`.
const GRID: u32 = 16;

/// Measures the fraction of a view that is nearer than a distance. The result is two frames late, so that nothing waits
/// for it.
pub(super) struct NearFraction {
    gl: Rc<Context>,
    program: DepthProgram,
    readback: Readback,
}

impl NearFraction {
    /// Compiles the pass.
    pub(super) fn new(gl: &Rc<Context>) -> Result<NearFraction, GlError> {
        let program = DepthProgram::new(gl, "stereo/near_fraction.frag");
        Ok(NearFraction { gl: gl.clone(), program, readback: Readback::new(gl, [GRID; 2])? })
    }

    /// Compiles the pass for whole depth textures or for pairs of depths, unless it is compiled already.
    pub(super) fn prepare(&mut self, is_pair: bool) -> Result<(), GlError> {
        self.program.prepare(is_pair)
    }

    /// Starts to measure the part of a depth image that has its lower left corner at the image's origin and `size`
    /// pixels.
    pub(super) fn measure(
        &mut self,
        depth: &DepthImage,
        size: [u32; 2],
        range: &DepthRange,
        distance: f32,
    ) -> Result<(), GlError> {
        let to_ivec = |v: [u32; 2]| IVec2::new(v[0] as i32, v[1] as i32);
        let (gl, program, readback) = (&self.gl, &mut self.program, &mut self.readback);
        let image = Image { size, ..depth.texture.image() };
        let pass = gl.pass("near fraction").read("depth_map", image);
        pass.write(readback.image().images()).run(|| {
            gl.set_raster_state(&RasterState::SCREEN);
            readback.image().bind();
            program
                .bind(depth)?
                .set("origin", to_ivec(depth.origin))
                .set("size", to_ivec(size))
                .set("near_depth", range.depth(distance))
                .set("reversed", range.convention == DepthConvention::Reversed);
            gl.draw_screen();
            readback.start();
            Ok(())
        })
    }

    /// Returns the result of the last but one [`NearFraction::measure`], from 0 to 1. Returns each result once.
    pub(super) fn take(&mut self) -> Option<f32> {
        let mut cells = [0u8; (GRID * GRID * 4) as usize];
        if !self.readback.take(&mut cells) {
            return None;
        }
        let sum: u32 = cells.iter().step_by(4).map(|&c| c as u32).sum();
        Some(sum as f32 / (255 * GRID * GRID) as f32)
    }
}
