//! `yoro device list`.

use super::which::SourceArgs;
use crate::cli::Subcommand;
use yoro_devices::adb::{Device, DeviceError};
use yoro_devices::phone;

/// List the devices, their batteries and the yoro on them
#[derive(clap::Args, Clone, Debug)]
pub struct ListArgs {
    #[command(flatten)]
    source: SourceArgs,
}

impl Subcommand for ListArgs {
    /// Prints a table.
    fn run(&self) -> anyhow::Result<()> {
        let adb = self.source.open()?;
        let devices = adb.devices()?;
        if devices.is_empty() {
            return Err(DeviceError::NoDevice.into());
        }
        println!(
            "{:<22} {:<14} {:<36} {:<8} {:>7} {:>7}  {:<8} YORO",
            "SERIAL", "STATE", "DEVICE", "ANDROID", "BATTERY", "TEMP", "PLUGGED"
        );
        for listed in devices {
            let state = if listed.is_ready() { "ready" } else { &listed.state };
            let mut row = format!("{:<22} {state:<14}", listed.serial);
            if listed.is_ready() {
                match details(&adb.open(&listed.serial)) {
                    Ok(details) => row += &details,
                    Err(error) => row += &format!(" {error}"),
                }
            }
            println!("{}", row.trim_end());
        }
        Ok(())
    }
}

fn details(device: &Device) -> Result<String, DeviceError> {
    let info = phone::info(device)?;
    let battery = phone::battery(device)?;
    let version = phone::version(device)?;
    let name = format!("{} {}", info.manufacturer, info.model);
    let number = |value: Option<f64>, decimals: usize, unit: &str| {
        value.map_or("na".into(), |value| format!("{value:.decimals$} {unit}"))
    };
    Ok(format!(
        " {name:<36} {:<8} {:>7} {:>7}  {:<8} {}",
        info.android,
        number(battery.level_percent, 0, "%"),
        number(battery.celsius, 1, "C"),
        if battery.plugged() { "yes" } else { "no" },
        version.as_deref().unwrap_or("not installed"),
    ))
}
