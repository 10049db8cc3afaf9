//! One run on a device: it is started, captured to its end despite lost connections and restarts, and stopped.

mod session;

use std::collections::BTreeMap;
use std::path::Path;

use indicatif::ProgressBar;

use crate::adb::{Device, DeviceError, quoted};
use crate::capture::{DeviceInfo, Outcome, RunInfo, VERSION};
use crate::held_settings::{HeldSettings, Wanted};
use crate::phone;
use yoro_settings::Settings;

pub(crate) use session::LOST_TIMEOUT_S;
pub(crate) use session::capture;

/// The plan of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The experiment that the run belongs to.
    pub experiment: Option<String>,
    /// Name of the method in tables.
    pub method: String,
    /// Settings of the viewer, method and scene included.
    pub settings: Settings,
    /// Number of the repetition, from 1.
    pub repetition: u32,
    /// Place in the experiment, from 1.
    pub order: u32,
    /// Length in seconds, without the warm-up.
    pub duration_s: f64,
    /// Length of the warm-up in seconds.
    pub warm_up_s: f64,
    /// Maximum temperature of the battery at the start, in degrees Celsius.
    pub warmest_celsius: Option<f64>,
    /// Refresh rate that the display is held at, in Hz.
    pub refresh_hz: Option<f64>,
    /// True to refuse a device that is plugged in.
    pub power: bool,
}

impl Plan {
    /// Returns the seconds from the first frame to the end of the run.
    pub fn seconds(&self) -> f64 {
        self.warm_up_s + self.duration_s
    }

    /// Returns the settings that differ from the defaults, without those that every run has.
    pub(crate) fn own_settings(&self) -> BTreeMap<String, String> {
        let defaults = Settings::default().pairs();
        let of_each = ["scene", "method", "duration", "run"];
        let pairs = self.settings.pairs().into_iter();
        pairs.filter(|pair| !defaults.contains(pair) && !of_each.contains(&pair.0.as_str())).collect()
    }

    /// Returns the description of the run for a new capture.
    pub(crate) fn info(&self, found: &Found, started_unix_s: f64, start_celsius: Option<f64>) -> RunInfo {
        RunInfo {
            version: VERSION,
            device: found.info.clone(),
            experiment: self.experiment.clone(),
            method: self.method.clone(),
            scene: self.settings.scene.clone(),
            repetition: self.repetition,
            order: self.order,
            settings: self.own_settings(),
            started_unix_s,
            duration_s: self.duration_s,
            warm_up_s: self.warm_up_s,
            start_celsius,
            application: Some(found.application.clone()),
            outcome: Outcome::Complete,
            faults: Vec::new(),
        }
    }
}

/// The device on which runs are made.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// Description of the device.
    pub info: DeviceInfo,
    /// Version of the application on the device.
    pub application: String,
}

/// Checks whether runs can be made on a device.
///
/// # Errors
/// [`DeviceError`], also if the application is not installed, the battery saver is on, or the screen has a lock that
/// only its owner can open.
pub(crate) fn look(device: &Device) -> Result<Found, DeviceError> {
    let application =
        phone::version(device)?.ok_or_else(|| DeviceError::NotInstalled { serial: device.serial.clone() })?;
    if phone::saves_battery(device)? {
        return Err(DeviceError::Unfit(format!(
            "the battery saver of {} is on, which slows it down: turn it off (adb -s {} shell settings put global \
             low_power 0)",
            device.serial,
            quoted(&device.serial)
        )));
    }
    let keyguard = phone::keyguard(device)?;
    if keyguard.secure && keyguard.showing {
        return Err(locked(device));
    }
    Ok(Found { info: phone::info(device)?, application })
}

/// Returns the error of a screen lock that an unattended run cannot open.
pub(crate) fn locked(device: &Device) -> DeviceError {
    DeviceError::Unfit(format!(
        "{} is locked by PIN, pattern or password, which ends a measurement as soon as its screen goes off: set its \
         screen lock to none or swipe for the time of the measurement",
        device.serial
    ))
}

/// Refuses a device whose battery values are not the device's power, because it is plugged in or they were set by hand.
///
/// # Errors
/// [`DeviceError`], which names the remedy.
pub(crate) fn refuse_charger(device: &Device) -> Result<(), DeviceError> {
    let battery = phone::battery(device)?;
    let serial = device.serial.clone();
    if battery.held {
        return Err(DeviceError::Unfit(format!(
            "what {serial} says of its battery was set by hand (dumpsys battery set or unplug): adb -s {} shell \
             dumpsys battery reset",
            quoted(&serial)
        )));
    }
    if battery.plugged() {
        return Err(DeviceError::PluggedIn { serial, address: phone::wifi_address(device) });
    }
    Ok(())
}

/// Makes one run: looks at the device, holds its settings, captures the run into a new folder, and restores the
/// settings.
///
/// # Errors
/// [`DeviceError`], if the run could not begin.
pub fn make(
    device: &Device,
    plan: &Plan,
    wanted: &Wanted,
    folder: &Path,
    bar: &ProgressBar,
) -> Result<RunInfo, DeviceError> {
    let found = look(device)?;
    if plan.power {
        refuse_charger(device)?;
    }
    let mut held = HeldSettings::new(device, &found.info, wanted)?;
    let made = capture(device, &found, plan, &mut held, folder, bar);
    let restored = held.restore(device);
    let info = made?;
    if let Err(error) = restored {
        log::warn!("{error}; the next measurement gives brightness and refresh rate back");
    }
    Ok(info)
}
