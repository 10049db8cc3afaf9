//! `yoro device run`.

use std::path::{Path, PathBuf};

use anyhow::bail;

use super::which::{WhichArgs, each, folder_of};
use crate::cli::Subcommand;
use crate::cli::args::{self, parse_positive};
use yoro_devices::adb::{Device, DeviceError};
use yoro_devices::capture::Outcome;
use yoro_devices::held_settings::Wanted;
use yoro_devices::run::{self, Plan};
use yoro_files::interrupt;
use yoro_settings::Settings;

/// Make one run: a method in a scene for a time, captured into a folder
#[derive(clap::Args, Clone, Debug)]
pub struct RunArgs {
    /// A built-in scene, or one that was pushed onto the device [default: prototype]
    scene: Option<String>,
    /// The stereo method [default: yoro]
    #[arg(long)]
    method: Option<String>,
    /// Number of the repetition: runs of the same number, scene and device are compared
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = args::whole::<u32>(1..=u32::MAX))]
    repetition: u32,
    /// Settings of the viewer in a TOML file
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// One setting of the viewer; more than once for several
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Name of the method in tables [default: the method]
    #[arg(long)]
    name: Option<String>,
    /// Length without warm-up
    #[arg(long, default_value_t = 60.0, value_parser = parse_positive, value_name = "S")]
    seconds: f32,
    /// Warm-up time to discard
    #[arg(long, default_value_t = 5, value_name = "S", value_parser = args::whole::<u32>(0..=3600))]
    warm_up_seconds: u32,
    /// Brightness to pin the screen to, 0 to 255
    #[arg(long, value_name = "N", value_parser = args::whole::<u8>(0..=u8::MAX))]
    brightness: Option<u8>,
    /// Refresh rate to pin the display to, in Hz
    #[arg(long, value_parser = parse_positive, value_name = "HZ")]
    refresh_hz: Option<f32>,
    /// Measure a device that is plugged in: everything except power
    #[arg(long)]
    plugged: bool,
    /// New folder for the capture; with several devices, one folder below it for each
    #[arg(long, default_value = "out/run", value_name = "FOLDER")]
    out: PathBuf,
    #[command(flatten)]
    which: WhichArgs,
}

impl Subcommand for RunArgs {
    /// Makes the run on each device.
    fn run(&self) -> anyhow::Result<()> {
        let named = [("scene", &self.scene), ("method", &self.method)];
        let named = named.into_iter().filter_map(|(key, value)| Some(format!("{key}={}", value.as_ref()?)));
        let overrides = self.overrides.iter().cloned().chain(named);
        let settings = Settings::measured().changed(self.settings.as_deref(), overrides)?;
        let plan = Plan {
            experiment: None,
            method: self.name.clone().unwrap_or_else(|| settings.method.name().into()),
            settings,
            repetition: self.repetition,
            order: 1,
            duration_s: f64::from(self.seconds),
            warm_up_s: f64::from(self.warm_up_seconds),
            warmest_celsius: None,
            refresh_hz: self.refresh_hz.map(f64::from),
            power: !self.plugged,
        };
        let wanted = Wanted { brightness: self.brightness, refresh_hz: self.refresh_hz.map(f64::from) };
        let devices = self.which.choose()?;
        let is_only = devices.len() == 1;
        each(devices, |device, bar| {
            let folder = folder_of(&self.out, &device.serial, is_only);
            bar.set_length(plan.seconds() as u64);
            one(device, &plan, &wanted, &folder, bar)
        })
    }
}

fn one(
    device: &Device,
    plan: &Plan,
    wanted: &Wanted,
    folder: &Path,
    bar: &indicatif::ProgressBar,
) -> anyhow::Result<String> {
    let info = run::make(device, plan, wanted, folder, bar)?;
    let faults: String = info.faults.iter().map(|fault| format!("\n  {}", fault.detail)).collect();
    match info.outcome {
        Outcome::Complete => Ok(format!("complete, captured into {}{faults}", folder.display())),
        Outcome::Interrupted { .. } if interrupt::requested() => Err(DeviceError::Interrupted.into()),
        Outcome::Interrupted { reason } | Outcome::Failed { reason } => {
            bail!("{reason}; what there was is in {}", folder.display())
        }
    }
}
