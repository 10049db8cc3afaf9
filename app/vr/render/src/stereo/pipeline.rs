//! The pipelines that make the other eye: yoro's, and the paper's.

use std::rc::Rc;

use super::options::{Pipeline, PipelineOptions};
use super::paper::Paper;
use yoro::eyes::Warp;
use yoro::opengl::{Gather, Options, Outputs, Source};
use yoro_gl::{Context, Destination, GlError};

/// Makes the other eye of colour and depth of one.
pub trait Synthesis {
    /// Allocates intermediate buffers for images of these sizes. Costs nothing if the sizes have not changed.
    /// [`Synthesis::synthesize`] calls it.
    ///
    /// # Errors
    /// [`GlError`] if the sizes are beyond the driver's limits.
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError>;

    /// Synthesizes the other eye into a rectangle of [`Warp::target_size`] and overwrites all of it. The framebuffer's
    /// attachments must fit the pipeline's [`Outputs`].
    ///
    /// # Errors
    /// Those of [`Synthesis::prepare`].
    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError>;
}

impl Synthesis for Gather {
    fn prepare(&mut self, warp: &Warp) -> Result<(), GlError> {
        Gather::prepare(self, warp)
    }

    fn synthesize(&mut self, source: Source, warp: &Warp, target: &Destination) -> Result<(), GlError> {
        Gather::synthesize(self, source, warp, target)
    }
}

impl PipelineOptions {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for [`Pipeline::Paper`] without OpenGL ES 3.1; [`GlError::Shader`] if the driver refuses
    /// a shader.
    pub fn create(&self, gl: &Rc<Context>, outputs: Outputs) -> Result<Box<dyn Synthesis>, GlError> {
        Ok(match self.pipeline {
            Pipeline::Gather => Box::new(Gather::new(gl, &Options::default(), outputs)?),
            Pipeline::Paper => Box::new(Paper::new(gl, outputs, self.paper)?),
        })
    }
}
