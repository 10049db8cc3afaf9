//! Options that several subcommands share.

use std::path::PathBuf;
use std::rc::Rc;

use anyhow::ensure;

use crate::cli::choices;
use yoro_context::{Backend, ContextError, Headless};
use yoro_gl::Context;
use yoro_lab::inpaint::{self, InpaintError, Patcher, PatcherKind, PatcherOptions};

/// The source of the GL context.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct GlArgs {
    /// Source of the GL context
    #[arg(long = "gl", value_parser = choices::backend(), default_value = Backend::default().name(), value_name = "BACKEND")]
    pub backend: Backend,
}

impl GlArgs {
    /// Opens the context and logs its driver.
    pub fn open(&self) -> Result<Headless, ContextError> {
        let headless = Headless::open(self.backend)?;
        log::info!("{}", headless.gl().capabilities().summary());
        Ok(headless)
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

/// Returns names as an option takes several of them.
pub fn list(names: impl IntoIterator<Item = &'static str>) -> String {
    names.into_iter().collect::<Vec<_>>().join(",")
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
