//! The stereo methods: ways to render the two eyes of a frame.

mod auto;
mod border;
mod conventional;
mod finish;
mod frame;
mod guard_band;
mod hybrid;
mod kinds;
mod method;
mod mono;
mod near_field_policy;
mod near_fraction;
mod offline;
mod options;
mod overlay;
mod paper;
mod pipeline;
mod readback;
mod reprojected;
mod shading_reprojection;
mod single_pass;
mod still;
mod substitute;
mod synthesized;
#[cfg(test)]
mod tests;

use std::rc::Rc;

use crate::render::{DeferredRenderer, ForwardRenderer, Layout, RenderSettings, RendererKind};
use yoro_gl::{Context, GlError};

pub use auto::{Auto, SelectedMethod};
use conventional::Conventional;
use frame::Setup;
use hybrid::Hybrid;
use kinds::StereoRenderer;
pub use method::{DepthTarget, EyeTarget, GuardBandUse, StereoError, StereoFrame, StereoMethod};
use mono::Mono;
pub use near_field_policy::{FrameMode, NearFieldPolicy};
pub use offline::{Offline, SynthesizedImage};
pub use options::{AntiAliasing, Method, MethodChoice, Pipeline, PipelineOptions, StereoOptions};
pub use paper::{ImBufferSize, Paper, PaperOptions, ParseImBufferSizeError};
pub use pipeline::Synthesis;
use reprojected::Reprojected;
use shading_reprojection::ShadingReprojection;
use single_pass::{DeferredPair, SinglePass};
pub use still::stills;
pub use substitute::Substitute;
use synthesized::Synthesized;

/// Makes a method and compiles what does not depend on the scene. [`StereoMethod::prepare`] compiles the rest.
///
/// # Errors
/// [`GlError`] if the driver cannot run the method.
pub fn create(
    gl: &Rc<Context>,
    method: Method,
    settings: &RenderSettings,
    options: &StereoOptions,
) -> Result<Box<dyn StereoMethod>, GlError> {
    settings.supports(method, gl.capabilities())?;
    let setup = &Setup { gl, settings, options };
    match settings.renderer {
        RendererKind::Deferred => create_for::<DeferredRenderer>(method, setup),
        RendererKind::Forward => create_for::<ForwardRenderer>(method, setup),
    }
}

fn create_for<R: StereoRenderer>(method: Method, setup: &Setup) -> Result<Box<dyn StereoMethod>, GlError> {
    Ok(match method {
        Method::Conventional => Box::new(Conventional::<R>::new(setup)?),
        Method::Instanced => Box::new(SinglePass::<R::Pair>::instanced(setup)?),
        // Only the deferred renderer has these two; see `RenderSettings::supports`.
        Method::Multiview => Box::new(SinglePass::<DeferredPair>::new(setup, Layout::Layered)?),
        Method::ShadingReprojection => Box::new(ShadingReprojection::new(setup)?),
        Method::Hybrid => Box::new(Hybrid::<R::Fields>::new(setup)?),
        Method::Mono => Box::new(Mono::<R>::new(setup)?),
        Method::Synthesized => match setup.options.render_rate {
            Some(rate) => Box::new(Reprojected::<R>::new(setup, rate)?),
            None => Box::new(Synthesized::<R>::new(setup)?),
        },
    })
}
