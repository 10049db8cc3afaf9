//! A pipeline that preserves the host's GL state.

use std::rc::Rc;

use super::{Source, Synthesis};
use crate::eyes::Warp;
use yoro_gl::{Context, Destination, GlError};

/// Saves the state before each call of a pipeline and restores it afterwards, also if the call fails.
pub(super) struct Preserving {
    gl: Rc<Context>,
    pipeline: Box<dyn Synthesis>,
    /// Number of the target's colour attachments.
    draw_buffers: u32,
}

impl Preserving {
    /// Compiles the pipeline and preserves the state.
    pub fn new(
        gl: &Rc<Context>,
        draw_buffers: u32,
        pipeline: impl FnOnce() -> Result<Box<dyn Synthesis>, GlError>,
    ) -> Result<Preserving, GlError> {
        Ok(Preserving { gl: gl.clone(), pipeline: preserve(gl, draw_buffers, pipeline)?, draw_buffers })
    }
}

impl Synthesis for Preserving {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        preserve(&self.gl, self.draw_buffers, || self.pipeline.prepare(warp))
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        preserve(&self.gl, self.draw_buffers, || self.pipeline.synthesize(source, warp, target))
    }
}

fn preserve<R>(gl: &Context, draw_buffers: u32, body: impl FnOnce() -> R) -> R {
    let state = gl.save_state(draw_buffers);
    gl.set_first_unit();
    let result = body();
    gl.restore_state(&state);
    result
}
