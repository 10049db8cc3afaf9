//! A pipeline that preserves the host's GL state.

use std::rc::Rc;

use super::{Source, Synthesis};
use crate::eyes::Warp;
use yoro_gl::{Context, Destination, GlError, Touched};

/// Saves the state before each call of a pipeline and restores it afterwards, even if the call fails.
pub(super) struct Preserving {
    gl: Rc<Context>,
    pipeline: Box<dyn Synthesis>,
    touched: Touched,
}

impl Preserving {
    /// Compiles the pipeline and preserves the state.
    pub fn new(
        gl: &Rc<Context>,
        touched: Touched,
        pipeline: impl FnOnce() -> Result<Box<dyn Synthesis>, GlError>,
    ) -> Result<Preserving, GlError> {
        Ok(Preserving { gl: gl.clone(), pipeline: preserve(gl, touched, pipeline)?, touched })
    }
}

impl Synthesis for Preserving {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        preserve(&self.gl, self.touched, || self.pipeline.prepare(warp))
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        preserve(&self.gl, self.touched, || self.pipeline.synthesize(source, warp, target))
    }
}

pub(super) fn preserve<R>(gl: &Context, touched: Touched, body: impl FnOnce() -> R) -> R {
    let state = gl.save_state(touched);
    gl.set_first_unit();
    let result = body();
    gl.restore_state(&state);
    result
}
