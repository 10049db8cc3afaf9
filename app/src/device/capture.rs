//! What one run on a device leaves behind: a folder with `run.json`, `log.txt` and `samples.csv`.
//!
//! `run.json` is a [`RunInfo`]; `log.txt` holds the raw lines of logcat as they came; `samples.csv` one [`Sample`] a
//! row, under the column names of the OVR Metrics Tool where that has the quantity.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Version of the folder's format.
pub const VERSION: u32 = 1;

/// The device that a run was made on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceInfo {
    /// Serial number, or address and port, as adb knows the device.
    pub serial: String,
    /// Manufacturer.
    pub manufacturer: String,
    /// Model.
    pub model: String,
    /// Android's version, such as `14`.
    pub android: String,
    /// Nominal capacity of the battery in milliampere-hours, if the device tells.
    pub capacity_mah: Option<f64>,
    /// Not a device but the replay of logs: said wherever results of it appear.
    pub simulated: bool,
}

/// How a run has ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "state")]
pub enum Outcome {
    /// It lasted as long as it should.
    Complete,
    /// It is not over, or was cut off: by Ctrl-C, or by a device that did not come back.
    Interrupted {
        /// One sentence.
        reason: String,
    },
    /// It could not be made, or is worth nothing.
    Failed {
        /// One sentence.
        reason: String,
    },
}

/// What can go wrong in a run without ending it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// The device was lost and found again.
    Disconnected,
    /// A charger was plugged in: the battery's current is not the device's.
    PluggedIn,
    /// The device does not give the battery's current.
    NoCurrent,
    /// The device gives milliamperes in place of microamperes; the figures are corrected.
    CurrentInMilliamperes,
    /// The device's current is positive while it discharges; the figures are corrected.
    CurrentSign,
    /// The device's clock jumped.
    ClockJump,
    /// Lines of the log were cut or damaged.
    DamagedLines,
    /// Lines that should be there, one a second, are missing.
    MissingLines,
    /// The device was started anew.
    Rebooted,
    /// The application ended, or crashed, and was started again.
    Restarted,
    /// The device throttled, or was too warm at the start.
    TooWarm,
}

/// Something that went wrong in a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// Kind.
    pub kind: FaultKind,
    /// When, in seconds since the run began; none for what concerns all of it.
    pub at_s: Option<f64>,
    /// One sentence with the figures.
    pub detail: String,
}

/// What a run was and how it went.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunInfo {
    /// [`VERSION`].
    pub version: u32,
    /// Where it ran.
    pub device: DeviceInfo,
    /// Name of the experiment that it is part of.
    pub experiment: Option<String>,
    /// Name of the method in tables: a stereo method, or what the experiment calls its settings.
    pub method: String,
    /// Scene.
    pub scene: String,
    /// Which repetition, from 1: runs of the same number, scene and device are paired.
    pub repetition: u32,
    /// Place in the order of the experiment, from 1.
    pub order: u32,
    /// Settings of the viewer other than the defaults.
    pub settings: BTreeMap<String, String>,
    /// When it began, in seconds since 1970 by this computer's clock.
    pub started_unix_s: f64,
    /// How long it should last without warm-up, in seconds.
    pub duration_s: f64,
    /// Seconds at its begin that count for nothing.
    pub warm_up_s: f64,
    /// Temperature of the battery at the start in degrees Celsius.
    pub start_celsius: Option<f64>,
    /// Version of the application.
    pub application: Option<String>,
    /// How it ended.
    pub outcome: Outcome,
    /// What went wrong on the way.
    pub faults: Vec<Fault>,
}

/// One second of a run. `None` is a value that the device does not give.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// Seconds since the run began, without jumps: by the device's monotonic clock where the log has it.
    pub time_s: f64,
    /// Frames per second.
    pub fps: Option<f64>,
    /// Refresh rate of the display in Hz.
    pub refresh_hz: Option<f64>,
    /// Refreshes in this second that showed an old frame again.
    pub stale: Option<f64>,
    /// Mean time between frames in milliseconds.
    pub frame_ms: Option<f64>,
    /// 99 % of the times between frames are below, in milliseconds.
    pub p99_ms: Option<f64>,
    /// GPU time per frame in milliseconds.
    pub gpu_ms: Option<f64>,
    /// CPU load of the process in percent of one core.
    pub cpu_percent: Option<f64>,
    /// Resident memory in MB (10^6 bytes).
    pub rss_mb: Option<f64>,
    /// Battery current as the device gave it.
    pub current_raw: Option<i64>,
    /// Battery current in milliamperes, negative while discharging.
    pub current_ma: Option<f64>,
    /// Battery voltage in millivolts.
    pub voltage_mv: Option<f64>,
    /// Battery level in percent.
    pub level_percent: Option<f64>,
    /// Remaining charge in microampere-hours.
    pub charge_uah: Option<f64>,
    /// What the device is plugged into, 0 for nothing.
    pub plugged: Option<i32>,
    /// Battery temperature in degrees Celsius.
    pub battery_celsius: Option<f64>,
    /// Skin temperature in degrees Celsius.
    pub skin_celsius: Option<f64>,
    /// Thermal status, 0 to 6.
    pub thermal_status: Option<i32>,
    /// Everything else that the log says, by key; keys of `VrApi` begin with `VrApi.`.
    pub other: BTreeMap<String, String>,
}

/// One run as it lies on disk.
#[derive(Clone, Debug, PartialEq)]
pub struct Capture {
    /// What it was.
    pub info: RunInfo,
    /// Second by second, warm-up included, in order of time.
    pub samples: Vec<Sample>,
}
