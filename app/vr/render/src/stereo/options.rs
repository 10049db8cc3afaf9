//! Settings of the methods.

use std::rc::Rc;

use super::near_field_policy::NearFieldPolicy;
use super::paper::{Paper, PaperOptions};
use crate::render::RenderSettings;
use yoro::eyes::GuardBand;
use yoro::synthesis::{self, Edges, Outputs, Synthesis, SynthesisOptions};
use yoro_gl::{Capabilities, Context, GlError};
use yoro_settings::Settings;
pub use yoro_settings::{AntiAliasing, History, Method, MethodChoice, Pipeline};

/// Returns what the forward renderer lacks for a method, if anything.
fn lacking_forward(method: Method) -> Option<&'static str> {
    match method {
        Method::ShadingReprojection => Some("the g-buffer of both eyes"),
        // Layers with several samples need EXT_multisampled_render_to_texture and
        // GL_OVR_multiview_multisampled_render_to_texture.
        Method::Multiview => Some("layers with one sample in each pixel"),
        _ => None,
    }
}

impl RenderSettings {
    /// Checks that a driver can run a method with this renderer. The pipelines of [`Method::Yoro`] check their own
    /// requirements.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with what is missing and what to do.
    pub fn supports(&self, method: Method, capabilities: &Capabilities) -> Result<(), GlError> {
        self.supported(capabilities)?;
        if self.is_forward()
            && let Some(lacking) = lacking_forward(method)
        {
            return Err(GlError::Unsupported(format!(
                "{} needs {lacking}: choose the deferred renderer, or another method",
                method.name()
            )));
        }
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

impl PipelineOptions {
    /// Compiles the pipeline for a source with these edges, with or without a history. Only [`Pipeline::Gather`] can
    /// use a history.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for [`Pipeline::Paper`] or [`Edges::Multisample`] without OpenGL ES 3.1, and for
    /// [`Pipeline::Paper`] with other than hard edges; [`GlError::Shader`] if the driver refuses a shader.
    pub fn create(
        &self,
        gl: &Rc<Context>,
        edges: Edges,
        history: bool,
        outputs: Outputs,
    ) -> Result<Box<dyn Synthesis>, GlError> {
        match self.pipeline {
            Pipeline::Gather => {
                let options = SynthesisOptions { edges, history, ..SynthesisOptions::default() };
                synthesis::create(gl, &options, outputs)
            }
            Pipeline::Paper if edges == Edges::Hard => Ok(Box::new(Paper::new(gl, outputs, self.paper)?)),
            Pipeline::Paper => Err(GlError::Unsupported(format!(
                "the pipeline paper takes one sample per pixel, not {} depth; choose the pipeline gather, or hard edges",
                edges.name()
            ))),
        }
    }
}

/// Settings of all methods.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct StereoOptions {
    /// The synthesis pipeline and its options.
    pub synthesis: PipelineOptions,
    /// How synthesis interprets the rendered eye's edges; `None` for the interpretation that suits the renderer
    /// ([`StereoOptions::edges`]).
    pub edges: Option<Edges>,
    /// The resolution of the rendered history of the other eye, for disocclusions. Not with [`Pipeline::Paper`].
    pub history: History,
    /// How much wider the dominant eye is rendered.
    pub guard_band: GuardBand,
    /// When anti-aliasing runs.
    pub anti_aliasing: AntiAliasing,
    /// Objects nearer than this, in metres, are rendered for both eyes.
    pub near_field: Option<f32>,
    /// When to render both eyes of frames that are mostly too near; `None` for never.
    pub policy: Option<NearFieldPolicy>,
    /// Renders per second. Frames between two renders show the last one at the newest poses
    /// ([`super::StereoMethod::show_again`]). `None` renders every frame. Such renders are taken as having hard edges,
    /// without near field, history and policy. Not with [`Pipeline::Paper`].
    pub render_rate: Option<f32>,
    /// [`Method::Hybrid`]: the far field starts where the disparity between the eyes is this many pixels, at
    /// `f_px * IPD / split_disparity` metres.
    pub split_disparity: f32,
}

impl Default for StereoOptions {
    fn default() -> StereoOptions {
        StereoOptions {
            synthesis: PipelineOptions::default(),
            edges: None,
            history: History::default(),
            guard_band: GuardBand::Distance(1.0),
            anti_aliasing: AntiAliasing::default(),
            near_field: None,
            policy: Some(NearFieldPolicy::default()),
            render_rate: None,
            split_disparity: 1.0,
        }
    }
}

impl StereoOptions {
    /// Returns how synthesis interprets edges. The default depends on the samples of a pixel. If shaders can read them,
    /// their nearest depth is taken as that of a hard edge, at an eighth of the cost of layers (docs/method.md).
    /// Otherwise only the first sample's depth is available, which as a hard edge would leave outlines of objects in
    /// place. Pipelines other than gather take one surface per pixel.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for [`Edges::Multisample`] with one sample per pixel.
    pub fn edges(&self, settings: &RenderSettings, capabilities: &Capabilities) -> Result<Edges, GlError> {
        let single = settings.samples() == 1 || self.synthesis.pipeline != Pipeline::Gather;
        match self.edges {
            Some(Edges::Multisample) if settings.samples() == 1 => Err(GlError::Unsupported(
                "multisample edges need several samples in each pixel: choose the forward renderer".into(),
            )),
            Some(edges) => Ok(edges),
            None if single => Ok(Edges::Hard),
            None if capabilities.multisample_textures => Ok(Edges::Hard),
            None => Ok(Edges::Sample),
        }
    }

    /// Returns the options for the viewer's settings. `pipeline` may differ from that of the settings if the driver
    /// does not support the latter.
    pub fn of_settings(settings: &Settings, pipeline: Pipeline) -> StereoOptions {
        let options = StereoOptions::of_pipeline(pipeline);
        let paper = PaperOptions {
            imbuffer: settings.imbuffer,
            linear_interpolation: settings.linear_interpolation,
            kernel_height: settings.kernel_height,
            strict: settings.strict,
        };
        StereoOptions {
            synthesis: PipelineOptions { paper, ..options.synthesis },
            edges: settings.edges,
            history: settings.history,
            guard_band: settings.guard_band.unwrap_or(options.guard_band),
            anti_aliasing: settings.anti_aliasing.unwrap_or(options.anti_aliasing),
            near_field: settings.near_field,
            policy: settings.switch.then(NearFieldPolicy::default),
            render_rate: settings.render_rate,
            split_disparity: settings.split_disparity,
        }
    }

    /// Returns the defaults for a pipeline. The paper's has no guard band and anti-aliasing before synthesis, as in the
    /// paper.
    pub fn of_pipeline(pipeline: Pipeline) -> StereoOptions {
        let synthesis = PipelineOptions { pipeline, ..PipelineOptions::default() };
        let options = StereoOptions { synthesis, ..StereoOptions::default() };
        match pipeline {
            Pipeline::Paper => {
                StereoOptions { guard_band: GuardBand::None, anti_aliasing: AntiAliasing::Before, ..options }
            }
            _ => options,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every option of the methods must have a setting.
    #[test]
    fn every_stereo_option_has_a_setting() {
        let changed = Settings::resolve(
            None,
            [
                "imbuffer=4",
                "linear-interpolation=false",
                "kernel-height=5",
                "strict=true",
                "guard-band=40px",
                "anti-aliasing=off",
                "edges=nearest",
                "history=full",
                "near-field=1",
                "switch=false",
                "render-rate=36",
                "split-disparity=2.5",
            ],
        );
        let [changed, default] = [changed.unwrap(), Settings::default()]
            .map(|s| serde_json::json!(StereoOptions::of_settings(&s, Pipeline::Paper)));
        assert_eq!(
            serde_json::json!(StereoOptions::of_settings(&Settings::default(), Pipeline::Gather)),
            serde_json::json!(StereoOptions::default())
        );
        fn unchanged(path: &str, a: &serde_json::Value, b: &serde_json::Value) -> Vec<String> {
            match (a.as_object(), b.as_object()) {
                (Some(a), Some(b)) => {
                    a.iter().flat_map(|(key, a)| unchanged(&format!("{path}.{key}"), a, &b[key])).collect()
                }
                _ => (a == b).then(|| path.to_owned()).into_iter().collect(),
            }
        }
        assert_eq!(unchanged("", &changed, &default), [".synthesis.pipeline"]);
    }
}
