//! The methods and their settings.

use crate::render::RenderSettings;
use yoro::eyes::GuardBand;
use yoro::gl::{Capabilities, GlError};
use yoro::synthesis::{Edges, NearFieldPolicy, Pipeline, SynthesisOptions};

/// A way to make both eyes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Both eyes rendered, one after the other: the ground truth.
    Conventional,
    /// Both eyes in one set of draw calls, by instancing.
    Instanced,
    /// Both eyes in one set of draw calls, by GL_OVR_multiview2.
    Multiview,
    /// The far field rendered once for both eyes, the near field for each (Fink et al. 2019).
    Hybrid,
    /// The dominant eye's shading reprojected to the other eye's geometry; only disocclusions are shaded.
    ShadingReprojection,
    /// The dominant eye's image shown to both: the lower bound.
    Mono,
    /// The dominant eye rendered, the other synthesized.
    Yoro,
}

impl Method {
    /// All methods: those that render both eyes first.
    pub const ALL: [Method; 7] = [
        Method::Conventional,
        Method::Instanced,
        Method::Multiview,
        Method::Hybrid,
        Method::ShadingReprojection,
        Method::Mono,
        Method::Yoro,
    ];

    /// The name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Method::Conventional => "conventional",
            Method::Instanced => "instanced",
            Method::Multiview => "multiview",
            Method::Hybrid => "hybrid",
            Method::ShadingReprojection => "shading-reprojection",
            Method::Mono => "mono",
            Method::Yoro => "yoro",
        }
    }

    /// What the forward renderer does not have for the method, if anything.
    fn lacking_forward(self) -> Option<&'static str> {
        match self {
            Method::ShadingReprojection => Some("the g-buffer of both eyes"),
            // Layers with several samples are EXT_multisampled_render_to_texture's, by
            // GL_OVR_multiview_multisampled_render_to_texture.
            Method::Multiview => Some("layers with one sample in each pixel"),
            _ => None,
        }
    }

    /// Whether the method shows pixels of one eye to the other, which needs eyes that look in the same direction
    /// ([`yoro::eyes::EyePair::synthesis`]).
    pub fn needs_aligned_eyes(self) -> bool {
        matches!(self, Method::Hybrid | Method::ShadingReprojection | Method::Mono | Method::Yoro)
    }

    /// Whether a driver can run the method with a renderer of these settings; what a pipeline of [`Method::Yoro`] needs
    /// is its own to say.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with what is missing and the remedy.
    pub fn supported(self, capabilities: &Capabilities, settings: &RenderSettings) -> Result<(), GlError> {
        settings.supported(capabilities)?;
        if settings.is_forward()
            && let Some(lacking) = self.lacking_forward()
        {
            return Err(GlError::Unsupported(format!(
                "{} needs {lacking}: choose the deferred renderer, or another method",
                self.name()
            )));
        }
        if self == Method::Multiview && !capabilities.multiview {
            return Err(GlError::Unsupported(format!(
                "{} ({}) has no GL_OVR_multiview2; use instanced, or a driver that has it, such as Mesa 25",
                capabilities.renderer, capabilities.version_string
            )));
        }
        Ok(())
    }
}

/// When anti-aliasing runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AntiAliasing {
    /// After synthesis, on each eye.
    #[default]
    After,
    /// Before synthesis, on the rendered eye only, as in the paper.
    Before,
    /// Not at all.
    Off,
}

impl AntiAliasing {
    /// All of them, the default first.
    pub const ALL: [AntiAliasing; 3] = [AntiAliasing::After, AntiAliasing::Before, AntiAliasing::Off];

    /// Its name in settings.
    pub fn name(self) -> &'static str {
        match self {
            AntiAliasing::After => "after",
            AntiAliasing::Before => "before",
            AntiAliasing::Off => "off",
        }
    }
}

/// Settings of all methods.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct StereoOptions {
    /// Synthesis pipeline and its knobs.
    pub synthesis: SynthesisOptions,
    /// What the synthesis takes the rendered eye's edges for; `None` for what fits the renderer: [`StereoOptions::edges`].
    pub edges: Option<Edges>,
    /// How much wider the dominant eye is rendered.
    pub guard_band: GuardBand,
    /// When anti-aliasing runs.
    pub anti_aliasing: AntiAliasing,
    /// Hybrid near field: objects nearer than this (metres) are rendered for both eyes.
    pub near_field: Option<f32>,
    /// Render both eyes of frames that are mostly too near; `None` never does.
    pub policy: Option<NearFieldPolicy>,
    /// [`Method::Hybrid`]: the far field starts where the disparity between the eyes is this many pixels, at
    /// `f_px * IPD / split_disparity` metres.
    pub split_disparity: f32,
}

impl Default for StereoOptions {
    fn default() -> StereoOptions {
        StereoOptions {
            synthesis: SynthesisOptions::default(),
            edges: None,
            guard_band: GuardBand::Distance(1.0),
            anti_aliasing: AntiAliasing::default(),
            near_field: None,
            policy: Some(NearFieldPolicy::default()),
            split_disparity: 1.0,
        }
    }
}

impl StereoOptions {
    /// What the synthesis takes the edges of images with so many samples in a pixel for. By itself, of several samples,
    /// all of them where shaders can read them, else the first one's depth; one surface a pixel for pipelines that know
    /// no other.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for [`Edges::Multisample`] of one sample.
    pub fn edges(&self, settings: &RenderSettings, capabilities: &Capabilities) -> Result<Edges, GlError> {
        let single = settings.samples() == 1 || self.synthesis.pipeline != Pipeline::Gather;
        match self.edges {
            Some(Edges::Multisample) if settings.samples() == 1 => Err(GlError::Unsupported(
                "multisample edges need several samples in each pixel: choose the forward renderer".into(),
            )),
            Some(edges) => Ok(edges),
            None if single => Ok(Edges::Hard),
            None if capabilities.multisample_textures => Ok(Edges::Multisample),
            None => Ok(Edges::Sample),
        }
    }

    /// The default with another pipeline. The paper's pipeline comes as in the paper: no guard band,
    /// anti-aliasing before synthesis.
    pub fn of_pipeline(pipeline: Pipeline) -> StereoOptions {
        let synthesis = SynthesisOptions { pipeline, ..SynthesisOptions::default() };
        let options = StereoOptions { synthesis, ..StereoOptions::default() };
        match pipeline {
            Pipeline::Paper => {
                StereoOptions { guard_band: GuardBand::None, anti_aliasing: AntiAliasing::Before, ..options }
            }
            _ => options,
        }
    }
}
