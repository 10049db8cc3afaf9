//! How a frame gets its two eyes, one file a method.

mod conventional;
mod hybrid;
mod mono;
mod near_field;
mod shading_reprojection;
mod single_pass;
#[cfg(all(test, feature = "desktop"))]
mod tests;
mod yoro;

use std::rc::Rc;

use crate::eyes::{Eye, EyePair, EyesError, GuardBand, View};
use crate::gl::{Capabilities, Context, Destination, Filter, Format, GlError, RenderTarget};
use crate::render::{DepthCopy, DepthImage, Fxaa, GpuScene, RenderSettings, Renderer};
use crate::synthesis::{NearFieldPolicy, Pipeline, SynthesisOptions};

pub use conventional::Conventional;
pub use hybrid::Hybrid;
pub use mono::Mono;
pub use shading_reprojection::ShadingReprojection;
pub use single_pass::SinglePass;
pub use yoro::Yoro;

/// Why a stereo frame could not be rendered.
#[derive(Debug, thiserror::Error)]
pub enum StereoError {
    /// The pair of eyes does not fit the method.
    #[error(transparent)]
    Eyes(#[from] EyesError),
    /// GL refused.
    #[error(transparent)]
    Gl(#[from] GlError),
}

/// A way to make both eyes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "desktop", derive(clap::ValueEnum))]
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
    /// ([`EyePair::synthesis`]).
    pub fn needs_aligned_eyes(self) -> bool {
        matches!(self, Method::Hybrid | Method::ShadingReprojection | Method::Mono | Method::Yoro)
    }

    /// Whether a driver can run the method; what a pipeline of [`Method::Yoro`] needs is its own to say.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] with what is missing and the remedy.
    pub fn supported(self, capabilities: &Capabilities) -> Result<(), GlError> {
        if self == Method::Multiview && !capabilities.multiview {
            return Err(GlError::Unsupported(format!(
                "{} ({}) has no GL_OVR_multiview2; use --method instanced, or a driver that has it, such as Mesa 25",
                capabilities.renderer, capabilities.version_string
            )));
        }
        Ok(())
    }
}

/// When anti-aliasing runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "desktop", derive(clap::ValueEnum))]
pub enum AntiAliasing {
    /// After synthesis, on each eye.
    #[default]
    After,
    /// Before synthesis, on the rendered eye only, as in the paper.
    Before,
    /// Not at all.
    Off,
}

/// Settings of all methods.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct StereoOptions {
    /// Synthesis pipeline and its knobs.
    pub synthesis: SynthesisOptions,
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
            guard_band: GuardBand::Distance(1.0),
            anti_aliasing: AntiAliasing::default(),
            near_field: None,
            policy: Some(NearFieldPolicy::default()),
            split_disparity: 1.0,
        }
    }
}

impl StereoOptions {
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

/// The finished images of a frame: [`Format::Rgba8`], display-referred sRGB with luma in alpha.
pub struct StereoFrame {
    eyes: [RenderTarget; 2],
}

impl StereoFrame {
    /// A frame of two images of `size` pixels.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn new(gl: &Rc<Context>, size: [u32; 2]) -> Result<StereoFrame, GlError> {
        let eye = || RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None);
        Ok(StereoFrame { eyes: [eye()?, eye()?] })
    }

    /// Gives the images another size; nothing happens at the same size.
    ///
    /// # Errors
    /// As [`RenderTarget::resize`].
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.eyes.iter_mut().try_for_each(|eye| eye.resize(size))
    }

    /// One eye's image.
    pub fn eye(&self, eye: Eye) -> &RenderTarget {
        &self.eyes[eye.index()]
    }

    /// Both images as targets, without depth.
    pub fn targets(&self) -> [EyeTarget<'static>; 2] {
        Eye::BOTH.map(|eye| EyeTarget { color: Destination::whole(self.eye(eye)), depth: None })
    }
}

/// Where one eye of a frame goes. The rectangles have the pair's size.
#[derive(Clone, Copy)]
pub struct EyeTarget<'a> {
    /// Takes display-referred sRGB with luma in alpha, and stores it as it is written.
    pub color: Destination,
    /// Takes the eye's window depth, if somebody wants it.
    pub depth: Option<DepthTarget<'a>>,
}

/// Where the window depth of an eye goes.
#[derive(Clone, Copy)]
pub struct DepthTarget<'a> {
    /// Framebuffer with a depth attachment and nothing else.
    pub to: Destination,
    /// The pass that writes it.
    pub copy: &'a DepthCopy,
}

/// A method with its own programs and targets.
pub trait StereoMethod {
    /// Compiles what the method needs for the materials of a scene, so that its first frame of that scene does not
    /// have to.
    ///
    /// # Errors
    /// [`StereoError`] when GL refuses.
    fn prepare(&self, _renderer: &mut Renderer, _scene: &GpuScene) -> Result<(), StereoError> {
        Ok(())
    }

    /// Renders both eyes of a frame to wherever they are wanted, by [`Eye::index`].
    ///
    /// # Errors
    /// [`StereoError`] for a pair of eyes that the method cannot do, or when GL refuses.
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError>;

    /// Renders both eyes into a frame, which is resized to the pair's size.
    ///
    /// # Errors
    /// As [`StereoMethod::render_to`].
    fn render(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<(), StereoError> {
        frame.resize(pair.size)?;
        self.render_to(renderer, scene, pair, &frame.targets())
    }
}

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
    method.supported(gl.capabilities())?;
    Ok(match method {
        Method::Conventional => Box::new(Conventional::new(gl, settings, options)?),
        Method::Instanced => Box::new(SinglePass::instanced(gl, settings, options)?),
        Method::Multiview => Box::new(SinglePass::multiview(gl, settings, options)?),
        Method::Hybrid => Box::new(Hybrid::new(gl, settings, options)?),
        Method::ShadingReprojection => Box::new(ShadingReprojection::new(gl, settings, options)?),
        Method::Mono => Box::new(Mono::new(gl, settings, options)?),
        Method::Yoro => Box::new(Yoro::new(gl, settings, options)?),
    })
}

/// The last steps of an eye: transparent objects, then anti-aliasing or a plain copy of a part of an image into the
/// frame.
struct Finish {
    gl: Rc<Context>,
    fxaa: Option<Fxaa>,
}

impl Finish {
    fn new(gl: &Rc<Context>, anti_alias: bool) -> Result<Finish, GlError> {
        Ok(Finish { gl: gl.clone(), fxaa: anti_alias.then(|| Fxaa::new(gl)).transpose()? })
    }

    /// Draws the transparent part of the scene over a rendered eye and fills `to` from it.
    fn eye(
        &self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        view: &View,
        color: &RenderTarget,
        depth: DepthImage,
        to: &EyeTarget,
    ) -> Result<(), GlError> {
        if scene.has_transparent() {
            renderer.draw_transparent(&Destination::whole(color), depth, scene, view)?;
        }
        self.color(color, [0, 0], &to.color);
        Finish::depth(depth, to);
        Ok(())
    }

    /// Fills `to` from the part of `from` whose lower left corner is `crop`.
    fn color(&self, from: &RenderTarget, crop: [u32; 2], to: &Destination) {
        match &self.fxaa {
            Some(fxaa) => fxaa.run(from.color(0), crop, to),
            None => self.gl.pass("copy", || from.copy_color(crop, to)),
        }
    }

    /// Hands an eye's depth to whoever wants it.
    fn depth(from: DepthImage, to: &EyeTarget) {
        if let Some(depth) = &to.depth {
            depth.copy.run(from, &depth.to);
        }
    }
}
