//! Settings of the methods.

use super::near_field_policy::NearFieldPolicy;
use super::paper::PaperOptions;
use crate::view::RenderSettings;
use yoro::eyes::GuardBand;
use yoro_gl::{Capabilities, GlError};
use yoro_settings::FrameRate;
pub use yoro_settings::{HoleMethod, Method, MethodChoice, Pipeline};

impl RenderSettings {
    /// Checks that a driver can run a method with this renderer. The pipelines of [`Method::Synthesized`] check their own
    /// requirements.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with what is missing and what to do.
    pub fn supports(&self, method: Method, capabilities: &Capabilities) -> Result<(), GlError> {
        self.supported(capabilities)?;
        if method == Method::Multiview && !capabilities.multiview {
            return Err(GlError::Unsupported(format!(
                "{} ({}) has no GL_OVR_multiview2; use instanced, or a driver that has it, such as Mesa 25",
                capabilities.renderer, capabilities.version_string
            )));
        }
        Ok(())
    }
}

/// The pipeline, and the options of the paper's.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct PipelineOptions {
    /// The pipeline that synthesizes.
    pub pipeline: Pipeline,
    /// Options of [`Pipeline::Paper`].
    pub paper: PaperOptions,
}

/// Settings of all methods.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct StereoOptions {
    /// The synthesis pipeline and its options.
    pub synthesis: PipelineOptions,
    /// How much wider the dominant eye is rendered.
    pub guard_band: GuardBand,
    /// [`Method::Synthesized`]: what becomes of pixels that the rendered eye does not show. Of eyes with an inset, the wide
    /// layer's are filled.
    pub holes: HoleMethod,
    /// When to render both eyes of frames that are mostly too near; `None` for never.
    pub policy: Option<NearFieldPolicy>,
    /// True if the display's runtime makes frames from the motion vectors of rendered ones ([`super::MotionTarget`]), which
    /// [`Method::Synthesized`] and [`Method::Conventional`] then write.
    pub motion_vectors: bool,
    /// [`Method::Hybrid`]: the far field starts where the disparity between the eyes is this many pixels, at
    /// `f_px * IPD / split_disparity` metres.
    pub split_disparity: f32,
    /// The rate of renders, where the display's runtime makes the other frames.
    pub frame_rate: FrameRate,
}

impl Default for StereoOptions {
    fn default() -> StereoOptions {
        StereoOptions {
            synthesis: PipelineOptions::default(),
            guard_band: GuardBand::Distance(1.0),
            holes: HoleMethod::default(),
            policy: Some(NearFieldPolicy::default()),
            motion_vectors: false,
            split_disparity: 1.0,
            frame_rate: FrameRate::Full,
        }
    }
}

impl StereoOptions {
    /// Returns the defaults for a pipeline. The paper's has no guard band.
    pub fn of_pipeline(pipeline: Pipeline) -> StereoOptions {
        let synthesis = PipelineOptions { pipeline, ..PipelineOptions::default() };
        let options = StereoOptions { synthesis, ..StereoOptions::default() };
        match pipeline {
            Pipeline::Paper => StereoOptions { guard_band: GuardBand::None, ..options },
            _ => options,
        }
    }

    /// Checks that a method can do what the options ask for.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with the remedy.
    pub(super) fn check(&self, method: Method) -> Result<(), GlError> {
        let is_rendered = method == Method::Synthesized && self.holes == HoleMethod::Rendered;
        if is_rendered && self.synthesis.pipeline == Pipeline::Paper {
            let why = "the paper's pipeline fills its holes; choose the pipeline gather, or holes=filled";
            return Err(GlError::Unsupported(why.into()));
        }
        Ok(())
    }
}
