//! Everything that is chosen by a name: the words of settings files, command lines and pages.

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Lengths in millimetres that a side of a screen behind lenses can have.
const PLAUSIBLE_SCREEN: std::ops::RangeInclusive<f32> = 30.0..=400.0;
/// The largest distance between the eyes that settings may ask for, in metres.
pub const MAX_IPD: f32 = 0.08;
/// The distance between the eyes in metres where nobody says otherwise: the paper's.
pub const DEFAULT_IPD: f32 = 0.063;
/// The most point lights that light one view.
pub const MAX_POINT_LIGHTS: usize = 24;

/// Numbers of samples that a pixel of the forward renderer may have.
pub const MSAA: [u32; 3] = [1, 2, 4];

/// How a view is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RendererKind {
    /// G-buffer, ambient occlusion, lighting of each pixel, bloom, tone mapping; edges are smoothed afterwards, by FXAA.
    #[default]
    Deferred,
    /// Surfaces are lit as they are drawn, with several samples in each pixel (MSAA); no ambient occlusion.
    Forward,
}

impl RendererKind {
    /// All of them, the default first.
    pub const ALL: [RendererKind; 2] = [RendererKind::Deferred, RendererKind::Forward];

    /// Its name on the command line and in settings.
    pub fn name(self) -> &'static str {
        match self {
            RendererKind::Deferred => "deferred",
            RendererKind::Forward => "forward",
        }
    }
}

/// A way to make both eyes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
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

    /// Whether the method shows pixels of one eye to the other, which needs eyes that look in the same direction
    /// (`yoro::eyes::EyePair::synthesis`).
    pub fn needs_aligned_eyes(self) -> bool {
        matches!(self, Method::Hybrid | Method::ShadingReprojection | Method::Mono | Method::Yoro)
    }
}

/// Which pipeline synthesizes the other eye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", try_from = "String")]
pub enum Pipeline {
    /// Fragment shaders that march along the source row.
    #[default]
    Gather,
    /// Algorithms 1 to 3 of the paper.
    Paper,
}

impl Pipeline {
    /// All pipelines, the default first.
    pub const ALL: [Pipeline; 2] = [Pipeline::Gather, Pipeline::Paper];

    /// Its name in settings.
    pub fn name(self) -> &'static str {
        match self {
            Pipeline::Gather => "gather",
            Pipeline::Paper => "paper",
        }
    }
}

/// A name that is not the name of a [`Pipeline`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ParsePipelineError {
    /// A pipeline of earlier versions.
    #[error(
        "the pipeline rowgroup was taken out: choose gather, which is closer to the truth on every scene"
    )]
    Rowgroup,
    /// Any other name.
    #[error("{0:?} is not a pipeline: choose gather or paper")]
    Unknown(String),
}

impl FromStr for Pipeline {
    type Err = ParsePipelineError;

    fn from_str(name: &str) -> Result<Pipeline, ParsePipelineError> {
        match Pipeline::ALL.into_iter().find(|pipeline| pipeline.name() == name) {
            Some(pipeline) => Ok(pipeline),
            None if name == "rowgroup" => Err(ParsePipelineError::Rowgroup),
            None => Err(ParsePipelineError::Unknown(name.to_owned())),
        }
    }
}

impl TryFrom<String> for Pipeline {
    type Error = ParsePipelineError;

    fn try_from(name: String) -> Result<Pipeline, ParsePipelineError> {
        name.parse()
    }
}

/// Resolution of the ImBuffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ImBufferSize {
    /// One ImBuffer pixel per this many image pixels, on both axes: 1, 2, 4, 8 or 16 in the paper.
    Divisor(u32),
    /// A fixed size in pixels for the target, whatever the image's size.
    Fixed([u32; 2]),
}

/// A text that is no [`ImBufferSize`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("give a divisor from 1 to 64, such as 2, or a size, such as 512x512")]
pub struct ParseImBufferSizeError;

/// A divisor from 1 to 64 (`2`), or a width and a height from 1 to 8192 (`512x512`).
impl FromStr for ImBufferSize {
    type Err = ParseImBufferSizeError;

    fn from_str(text: &str) -> Result<ImBufferSize, ParseImBufferSizeError> {
        let number = |t: &str| t.parse::<u32>().ok().filter(|n| (1..=8192).contains(n));
        match text.split_once('x') {
            Some((w, h)) => number(w).zip(number(h)).map(|(w, h)| ImBufferSize::Fixed([w, h])),
            None => number(text).filter(|n| *n <= 64).map(ImBufferSize::Divisor),
        }
        .ok_or(ParseImBufferSizeError)
    }
}

/// As [`FromStr`] reads it.
impl Display for ImBufferSize {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            ImBufferSize::Divisor(n) => write!(f, "{n}"),
            ImBufferSize::Fixed([w, h]) => write!(f, "{w}x{h}"),
        }
    }
}

/// When anti-aliasing runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// On what the eyes are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DisplayKind {
    /// A headset where there is an OpenXR runtime, else a Cardboard-compatible viewer.
    #[default]
    Auto,
    /// A headset with an OpenXR runtime.
    OpenXr,
    /// A phone in a Cardboard-compatible viewer.
    Cardboard,
}

/// How fast the processors should run, where applications may say: on headsets by XR_EXT_performance_settings; on phones
/// the two sustained levels are Android's sustained performance mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Performance {
    /// As slowly as can be.
    PowerSaving,
    /// Slowly; the rate may be missed.
    SustainedLow,
    /// As fast as can be held for as long as one likes.
    #[default]
    SustainedHigh,
    /// As fast as can be, for a short time.
    Boost,
}

/// Ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ssao {
    /// None.
    Off,
    /// At half the resolution.
    Half,
    /// At full resolution.
    Full,
}

/// Width and height of a screen in millimetres, in the position in which a viewer holds it: `158x71mm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenSize {
    millimetres: [f32; 2],
}

impl ScreenSize {
    /// Width and height in metres.
    pub fn metres(self) -> [f32; 2] {
        self.millimetres.map(|length| length * 1e-3)
    }
}

impl FromStr for ScreenSize {
    type Err = String;

    fn from_str(text: &str) -> Result<ScreenSize, String> {
        let lengths = text.trim().strip_suffix("mm").and_then(|lengths| lengths.split_once('x'));
        let lengths = lengths.map(|(width, height)| [width, height].map(|text| text.trim().parse().ok()));
        match lengths {
            Some([Some(width), Some(height)])
                if PLAUSIBLE_SCREEN.contains(&width) && PLAUSIBLE_SCREEN.contains(&height) =>
            {
                Ok(ScreenSize { millimetres: [width, height] })
            }
            _ => Err(format!(
                "give width and height from {} to {} mm, such as 158x71mm, or auto for what the device says",
                PLAUSIBLE_SCREEN.start(),
                PLAUSIBLE_SCREEN.end()
            )),
        }
    }
}

impl Display for ScreenSize {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [width, height] = self.millimetres;
        write!(f, "{width}x{height}mm")
    }
}
