//! Options that several subcommands share.

use std::path::PathBuf;
use std::rc::Rc;

use anyhow::ensure;
use clap::builder::RangedU64ValueParser;

use crate::cli::choices;
use yoro_context::{Backend, ContextError, Headless};
use yoro_gl::Context;
use yoro_lab::inpaint::{self, InpaintError, Patcher, PatcherKind, PatcherOptions};
use yoro_protocol::{DEFAULT_IPD, MAX_IPD, Settings};
use yoro_render::stereo::{ImBufferSize, PaperOptions, Pipeline, PipelineOptions};
use yoro_render::{MSAA, RenderSettings, RendererKind};

/// Where the GL context comes from.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct GlArgs {
    /// Where to take the GL context from
    #[arg(long = "gl", value_parser = choices::backend(), default_value = Backend::default().name(), value_name = "BACKEND")]
    pub backend: Backend,
}

impl GlArgs {
    /// Opens the context and says once what it is.
    pub fn open(&self) -> Result<Headless, ContextError> {
        let headless = Headless::open(self.backend)?;
        log::info!("{}", headless.gl().capabilities().summary());
        Ok(headless)
    }
}

/// The renderer.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct RendererArgs {
    /// How a view is rendered
    #[arg(long, value_parser = choices::renderer(), default_value = RendererKind::default().name(), value_name = "RENDERER")]
    renderer: RendererKind,
    /// forward: samples in each pixel, 1, 2 or 4, as far as the driver has them [default: 4]
    #[arg(long, value_parser = parse_msaa, value_name = "N")]
    msaa: Option<u32>,
}

impl RendererArgs {
    /// As the library takes them; everything else is as by default.
    pub fn settings(&self) -> anyhow::Result<RenderSettings> {
        ensure!(
            self.msaa.is_none() || self.renderer == RendererKind::Forward,
            "--msaa goes with --renderer forward only: give that, or leave it out"
        );
        let default = RenderSettings::default();
        Ok(RenderSettings { renderer: self.renderer, msaa: self.msaa.unwrap_or(default.msaa), ..default })
    }
}

/// The renderer, where it is a setting of the viewer.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct RendererSettingArgs {
    /// How a view is rendered [default: deferred]
    #[arg(long, value_parser = choices::renderer(), value_name = "RENDERER")]
    renderer: Option<RendererKind>,
    /// forward: samples in each pixel, 1, 2 or 4, as far as the driver has them [default: 4]
    #[arg(long, value_parser = parse_msaa, value_name = "N")]
    msaa: Option<u32>,
}

impl RendererSettingArgs {
    /// As `key=value`.
    pub fn settings(&self) -> impl Iterator<Item = String> {
        let renderer = self.renderer.map(|renderer| format!("renderer={}", renderer.name()));
        renderer.into_iter().chain(self.msaa.map(|samples| format!("msaa={samples}")))
    }
}

/// The synthesis pipeline and its knobs.
#[derive(clap::Args, Clone, Debug)]
pub struct SynthesisArgs {
    /// How the other eye is synthesized
    #[arg(long, value_parser = choices::pipeline(), default_value = Pipeline::default().name(), value_name = "PIPELINE")]
    pub pipeline: Pipeline,
    /// paper: ImBuffer resolution, as a divisor (1, 2, 4, 8, 16) or a fixed size (512x512)
    #[arg(long, default_value = "1", value_name = "N|WxH")]
    pub imbuffer: ImBufferSize,
    /// paper: do not interpolate between ImBuffer entries
    #[arg(long)]
    pub no_linear_interpolation: bool,
    /// paper: rows of the patcher's kernel
    #[arg(long, default_value_t = 3, value_parser = RangedU64ValueParser::<u32>::new().range(1..=15), value_name = "ROWS")]
    pub kernel_height: u32,
    /// paper: whole source columns and one depth sample per ImBuffer pixel, as the text says
    #[arg(long)]
    pub strict: bool,
}

impl SynthesisArgs {
    /// As the library takes them.
    pub fn options(&self) -> PipelineOptions {
        PipelineOptions {
            pipeline: self.pipeline,
            paper: PaperOptions {
                imbuffer: self.imbuffer,
                linear_interpolation: !self.no_linear_interpolation,
                kernel_height: self.kernel_height,
                strict: self.strict,
            },
        }
    }
}

/// The patcher, where it is not the pipeline itself that fills the holes.
#[derive(clap::Args, Clone, Debug)]
pub struct PatcherArgs {
    /// Fill the holes by this patcher instead of the pipeline's own fill
    #[arg(long, value_parser = choices::patcher(), value_name = "KIND")]
    pub patcher: Option<PatcherKind>,
    /// neural: another ONNX file than the built-in model
    #[arg(long, value_name = "FILE", requires = "patcher")]
    pub model: Option<PathBuf>,
}

impl PatcherArgs {
    /// Refuses a model without the patcher that runs it.
    pub fn check(&self) -> anyhow::Result<()> {
        ensure!(
            self.model.is_none() || self.patcher == Some(PatcherKind::Neural),
            "--model goes with --patcher neural only: give that, or leave it out"
        );
        Ok(())
    }

    /// Makes the patcher, if one was asked for.
    pub fn create(&self, gl: &Rc<Context>) -> Result<Option<Box<dyn Patcher>>, InpaintError> {
        let options = PatcherOptions { model: self.model.clone() };
        self.patcher.map(|kind| inpaint::create(gl, kind, &options)).transpose()
    }
}

/// Settings of the viewer on the command line
#[derive(clap::Args, Clone, Debug)]
pub struct SettingsArgs {
    /// Leave out the HUD
    #[arg(long)]
    no_hud: bool,
    /// Settings of the viewer in a TOML file
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// One setting of the viewer; as often as needed
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
}

impl SettingsArgs {
    /// The settings; what has an option of its own, as `key=value`, is stronger than `--set`.
    pub fn resolve(&self, named: impl IntoIterator<Item = String>) -> anyhow::Result<Settings> {
        let hud = self.no_hud.then(|| "hud=false".to_owned());
        let overrides = self.overrides.iter().cloned().chain(named).chain(hud);
        Ok(Settings::resolve(self.settings.as_deref(), overrides)?)
    }
}

/// Parses an IPD in metres.
pub fn parse_ipd(text: &str) -> Result<f32, String> {
    let ipd: f32 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=MAX_IPD).contains(&ipd) {
        Ok(ipd)
    } else {
        Err(format!("give metres from 0 to {MAX_IPD}: {DEFAULT_IPD} is {:.0} mm", DEFAULT_IPD * 1e3))
    }
}

/// Parses a number of samples in a pixel.
fn parse_msaa(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|samples| MSAA.contains(samples)).ok_or_else(|| "give 1, 2 or 4".into())
}

/// Parses a finite number.
pub fn parse_finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("give a finite number".into()),
    }
}

/// Parses a finite number above zero.
pub fn parse_positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("give a number above 0".into()),
    }
}

/// Parses an angle in degrees that a flat image can have, and returns radians.
pub fn parse_fov(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if (1.0..=170.0).contains(&value) => Ok(value.to_radians()),
        _ => Err("give degrees from 1 to 170".into()),
    }
}
