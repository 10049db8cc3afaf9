//! How a frame gets its two eyes, one file a method.

mod border;
mod conventional;
mod finish;
mod forward_hybrid;
mod forward_single_pass;
mod guard_band;
mod hybrid;
mod method;
mod mono;
mod near_field;
mod near_field_policy;
mod offline;
mod options;
mod paper;
mod readback;
mod shading_reprojection;
mod single_pass;
mod synthesized;
#[cfg(test)]
mod tests;

use std::rc::Rc;

use crate::render::RenderSettings;
use yoro_gl::{Context, GlError};

use conventional::Conventional;
use forward_hybrid::ForwardHybrid;
use forward_single_pass::ForwardSinglePass;
use hybrid::Hybrid;
pub use method::{DepthTarget, EyeTarget, GuardBandUse, StereoError, StereoFrame, StereoMethod};
use mono::Mono;
pub use near_field_policy::{FrameMode, NearFieldPolicy};
pub use offline::{Offline, SynthesizedImage};
pub use options::{AntiAliasing, Method, Pipeline, PipelineOptions, StereoOptions};
pub use paper::{ImBufferSize, Paper, PaperOptions, ParseImBufferSizeError};
use shading_reprojection::ShadingReprojection;
use single_pass::SinglePass;
use synthesized::Yoro;

/// Makes a method; all that does not depend on the scene is compiled here ([`StereoMethod::prepare`] does the rest).
///
/// # Errors
/// [`GlError`] when the driver cannot run it.
pub fn create(
    gl: &Rc<Context>,
    method: Method,
    settings: &RenderSettings,
    options: &StereoOptions,
) -> Result<Box<dyn StereoMethod>, GlError> {
    settings.supports(method, gl.capabilities())?;
    Ok(match method {
        Method::Conventional => Box::new(Conventional::new(gl, settings, options)?),
        Method::Instanced if settings.is_forward() => {
            Box::new(ForwardSinglePass::new(gl, settings, options)?)
        }
        Method::Instanced => Box::new(SinglePass::instanced(gl, settings, options)?),
        Method::Multiview => Box::new(SinglePass::multiview(gl, settings, options)?),
        Method::Hybrid if settings.is_forward() => Box::new(ForwardHybrid::new(gl, settings, options)?),
        Method::Hybrid => Box::new(Hybrid::new(gl, settings, options)?),
        Method::ShadingReprojection => Box::new(ShadingReprojection::new(gl, settings, options)?),
        Method::Mono => Box::new(Mono::new(gl, settings, options)?),
        Method::Yoro => Box::new(Yoro::new(gl, settings, options)?),
    })
}
