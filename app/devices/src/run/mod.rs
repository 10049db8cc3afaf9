//! One run on a device: started, captured to its end over whatever happens, and stopped.

mod session;

use std::collections::BTreeMap;

use crate::adb::{Device, DeviceError};
use crate::capture::{DeviceInfo, Outcome, RunInfo, VERSION};
use crate::foreign::Subject;
use crate::phone::{self, PACKAGE};
use yoro_protocol::Settings;

pub(crate) use session::LOST_TIMEOUT_S;
pub use session::capture;

/// Another application than this project's.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Its package and process.
    pub subject: Subject,
    /// Its activity.
    pub activity: String,
}

/// The plan of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The application that runs in place of this project's; of the settings only the scene's name counts then.
    pub other: Option<Other>,
    /// The experiment that it is part of.
    pub experiment: Option<String>,
    /// Name of the method in tables.
    pub method: String,
    /// Settings of the viewer, method and scene included.
    pub settings: Settings,
    /// Number of the repetition, from 1.
    pub repetition: u32,
    /// Place in the experiment, from 1.
    pub order: u32,
    /// Seconds without warm-up.
    pub duration_s: f64,
    /// Seconds at the begin that count for nothing.
    pub warm_up_s: f64,
    /// Warmest that the battery should be at the start, in degrees Celsius.
    pub warmest_celsius: Option<f64>,
    /// Refresh rate that the display is held at, in Hz.
    pub refresh_hz: Option<f64>,
    /// True to refuse a device that is plugged in.
    pub power: bool,
}

impl Plan {
    /// The package of the application.
    pub fn package(&self) -> &str {
        self.other.as_ref().map_or(PACKAGE, |other| &other.subject.package)
    }

    /// Returns the seconds from the first frame to the end.
    pub fn seconds(&self) -> f64 {
        self.warm_up_s + self.duration_s
    }

    /// The settings other than the defaults, without those that each run has.
    pub fn own_settings(&self) -> BTreeMap<String, String> {
        if let Some(other) = &self.other {
            return BTreeMap::from([("package".into(), other.subject.package.clone())]);
        }
        let defaults = Settings::default().pairs();
        let of_each = ["scene", "method", "duration", "auto-exit", "run"];
        let pairs = self.settings.pairs().into_iter();
        pairs.filter(|pair| !defaults.contains(pair) && !of_each.contains(&pair.0.as_str())).collect()
    }

    /// Returns the description of the run for a capture that begins.
    pub fn info(&self, found: &Found, started_unix_s: f64, start_celsius: Option<f64>) -> RunInfo {
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

/// The device that runs are made on, as it was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// Description of the device.
    pub info: DeviceInfo,
    /// Version of the application on it.
    pub application: String,
}

/// Looks whether runs of an application can be made on a device.
///
/// # Errors
/// [`DeviceError`]: also where the application is not there, the battery saver is on, or the screen is locked so that
/// only its owner can unlock it.
pub fn look(device: &dyn Device, package: &str) -> Result<Found, DeviceError> {
    let serial = || device.serial().to_owned();
    let application = phone::version(device, package)?.ok_or_else(|| match package {
        PACKAGE => DeviceError::NotInstalled(serial()),
        package => DeviceError::NoPackage { serial: serial(), package: package.into() },
    })?;
    if phone::saves_battery(device)? {
        return Err(DeviceError::BatterySaver(serial()));
    }
    let keyguard = phone::keyguard(device)?;
    if keyguard.secure && keyguard.showing {
        return Err(DeviceError::Locked(serial()));
    }
    Ok(Found { info: phone::info(device)?, application })
}

/// Refuses a device whose battery does not show the device's power: it is plugged in, or its values were set by hand.
///
/// # Errors
/// [`DeviceError::PluggedIn`] and [`DeviceError::BatteryHeld`] with the way out.
pub fn refuse_charger(device: &dyn Device) -> Result<(), DeviceError> {
    let battery = phone::battery(device)?;
    let serial = device.serial().to_owned();
    if battery.held {
        return Err(DeviceError::BatteryHeld(serial));
    }
    if battery.plugged() {
        return Err(DeviceError::PluggedIn { serial, address: phone::wifi_address(device) });
    }
    Ok(())
}
