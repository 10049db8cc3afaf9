//! The stereo methods: ways to render the two eyes of a frame.

mod auto;
mod conventional;
mod fallback;
mod frame;
#[cfg(test)]
mod hole_tests;
mod hybrid;
mod images;
mod method;
mod mono;
mod motion;
#[cfg(test)]
mod motion_tests;
mod near_field_policy;
mod near_fraction;
mod offline;
mod options;
mod overlay;
mod paper;
mod pipeline;
mod rate;
mod readback;
mod session;
mod shading_reprojection;
mod single_pass;
mod still;
mod synthesized;
#[cfg(test)]
mod tests;

use std::rc::Rc;

use crate::view::Layout;
use yoro_gl::{Context, GlError};

pub use auto::Auto;
use conventional::Conventional;
pub use fallback::{FallbackReason, alignment_error};
use hybrid::Hybrid;
pub use images::{LayerTargets, StereoImages};
use method::StereoMethod;
pub use method::{DepthTarget, EyeTarget, MotionTarget, StereoError, StereoFrame};
use mono::Mono;
pub use near_field_policy::{FrameMode, NearFieldPolicy};
pub use offline::{Offline, SynthesizedImage};
pub use options::{HoleMethod, Method, MethodChoice, Pipeline, PipelineOptions, StereoOptions};
pub use paper::{ImBufferSize, Paper, PaperOptions, ParseImBufferSizeError};
pub use pipeline::Synthesis;
pub use session::{FrameLoad, FrameReport, FrameTargets, StereoSession};
use shading_reprojection::ShadingReprojection;
use single_pass::SinglePass;
pub use still::stills;
use synthesized::Synthesized;

/// Makes a method and compiles what does not depend on the scene. [`StereoMethod::prepare`] compiles the rest.
fn create(
    gl: &Rc<Context>,
    method: Method,
    options: &StereoOptions,
) -> Result<Box<dyn StereoMethod>, GlError> {
    Ok(match method {
        Method::Conventional => Box::new(Conventional::new(options)),
        Method::Instanced => Box::new(SinglePass::instanced(gl)),
        Method::Multiview => Box::new(SinglePass::new(Layout::Layered)),
        Method::ShadingReprojection => Box::new(ShadingReprojection::default()),
        Method::Hybrid => Box::new(Hybrid::new(options.split_disparity)),
        Method::Mono => Box::new(Mono::default()),
        Method::Synthesized => Box::new(Synthesized::new(gl, options)),
    })
}
