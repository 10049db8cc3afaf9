//! `yoro device run`.

use std::path::{Path, PathBuf};

use anyhow::bail;

use super::{WhichArgs, each, folder_of};
use crate::cli::{interrupted, parse_positive};
use crate::device::adb::{Device, DeviceError};
use crate::device::capture::Outcome;
use crate::device::pins::{Pins, Wanted};
use crate::device::run::{self, Plan};
use crate::viewer::Settings;

/// Make one run: a method in a scene for a time, captured into a folder
#[derive(clap::Args, Clone, Debug)]
pub struct RunArgs {
    /// A built-in scene, or one that was pushed onto the device [default: prototype]
    scene: Option<String>,
    /// The stereo method [default: yoro]
    #[arg(long)]
    method: Option<String>,
    /// Settings of the viewer in a TOML file
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// One setting of the viewer; as often as needed
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Name of the method in tables [default: the method]
    #[arg(long)]
    name: Option<String>,
    /// Length without warm-up
    #[arg(long, default_value_t = 60.0, value_parser = parse_positive, value_name = "S")]
    seconds: f32,
    /// What is cut off at the begin
    #[arg(long, default_value_t = 5, value_name = "S")]
    warm_up_seconds: u32,
    /// Brightness to pin the screen to, 0 to 255
    #[arg(long, value_name = "N")]
    brightness: Option<u8>,
    /// Refresh rate to pin the display to, in Hz
    #[arg(long, value_parser = parse_positive, value_name = "HZ")]
    refresh_hz: Option<f32>,
    /// Go on although the device is plugged in: everything but power
    #[arg(long)]
    plugged: bool,
    /// Where the capture goes: a new folder; with several devices, one below it for each
    #[arg(long, default_value = "out/run", value_name = "FOLDER")]
    out: PathBuf,
    #[command(flatten)]
    which: WhichArgs,
}

/// Makes the run on each device.
pub fn run(args: &RunArgs) -> anyhow::Result<()> {
    let named = [("scene", &args.scene), ("method", &args.method)];
    let named = named.into_iter().filter_map(|(key, value)| Some(format!("{key}={}", value.as_ref()?)));
    let settings = Settings::resolve(args.settings.as_deref(), args.overrides.iter().cloned().chain(named))?;
    let plan = Plan {
        experiment: None,
        method: args.name.clone().unwrap_or_else(|| settings.method.name().into()),
        settings,
        repetition: 1,
        order: 1,
        duration_s: f64::from(args.seconds),
        warm_up_s: f64::from(args.warm_up_seconds),
        warmest_celsius: None,
        power: !args.plugged,
    };
    let wanted = Wanted { brightness: args.brightness, refresh_hz: args.refresh_hz.map(f64::from) };
    let devices = args.which.choose()?;
    let is_only = devices.len() == 1;
    each(devices, |device, bar| {
        let folder = folder_of(&args.out, device.serial(), is_only);
        bar.set_length(plan.seconds() as u64);
        one(device, &plan, &wanted, &folder, bar)
    })
}

fn one(
    device: &dyn Device,
    plan: &Plan,
    wanted: &Wanted,
    folder: &Path,
    bar: &indicatif::ProgressBar,
) -> anyhow::Result<String> {
    let found = run::look(device)?;
    if plan.power {
        run::refuse_charger(device)?;
    }
    let pins = Pins::new(device, wanted)?;
    let made = run::capture(device, &found, plan, folder, bar);
    let given_back = pins.give_back(device);
    let info = made?;
    if let Err(error) = given_back {
        log::warn!("{error}; the next measurement gives brightness and refresh rate back");
    }
    let faults: String = info.faults.iter().map(|fault| format!("\n  {}", fault.detail)).collect();
    match info.outcome {
        Outcome::Complete => Ok(format!("complete, captured into {}{faults}", folder.display())),
        Outcome::Interrupted { .. } if interrupted() => Err(DeviceError::Interrupted.into()),
        Outcome::Interrupted { reason } | Outcome::Failed { reason } => {
            bail!("{reason}; what there was is in {}", folder.display())
        }
    }
}
