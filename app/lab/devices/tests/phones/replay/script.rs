//! Scripts of replays, in TOML. Unknown keys are errors.
//!
//! ```toml
//! seed = 1
//!
//! [[device]]
//! serial = "SIM1"
//!
//! [device.load.yoro]
//! frame-ms = 9.0
//! milliwatts = 3100.0
//!
//! [[device.fault]]
//! kind = "disconnect"
//! at = 30.0
//! seconds = 20.0
//! ```

use std::collections::BTreeMap;

use serde::Deserialize;

/// The devices of a replay and their faults.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Script {
    /// Seed of everything that is generated.
    #[serde(default)]
    pub seed: u64,
    /// The devices.
    #[serde(default)]
    pub device: Vec<Phone>,
}

/// A simulated device.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Phone {
    /// Serial number.
    pub serial: String,
    /// Manufacturer.
    pub manufacturer: String,
    /// Model.
    pub model: String,
    /// Android's version.
    pub android: String,
    /// State in adb's words: `device`, `unauthorized`, `offline`.
    pub state: String,
    /// True if the application is installed at the start.
    pub installed: bool,
    /// True if there is no storage left to install anything.
    pub storage_full: bool,
    /// Capacity of the battery in mAh. 0 if the device does not report it; then the level never changes.
    pub capacity_mah: f64,
    /// Level of the battery in percent.
    pub level_percent: f64,
    /// Temperature of the battery in degrees Celsius.
    pub celsius: f64,
    /// Temperature of the surroundings in degrees Celsius.
    pub ambient_celsius: f64,
    /// True if a charger is plugged in at the start.
    pub plugged: bool,
    /// How the device reports the battery's current.
    pub current: Current,
    /// True if the device reports a positive current while discharging.
    pub positive: bool,
    /// How the device reports the battery's voltage.
    pub voltage: Voltage,
    /// True if the shell may read the kernel's current and voltage.
    pub kernel_battery: bool,
    /// True if the values of `dumpsys battery` were set by hand.
    pub battery_held: bool,
    /// Somebody plugs in a charger while no application runs and the level is below this percentage, and unplugs it at
    /// 95 %. Nobody does if this is `None`.
    pub charged_below: Option<f64>,
    /// True if the screen lock asks for a PIN.
    pub secure_lock: bool,
    /// Refresh rate of the display in Hz.
    pub refresh_hz: f64,
    /// True if the device also logs a line of Meta's runtime each second.
    pub vr_api: bool,
    /// Packages of other applications on the device. While one of them runs, Meta's runtime logs one line per second
    /// for it, and one for another process.
    pub others: Vec<String>,
    /// Android's settings by name. Names outside the table `system` have the form `global/low_power`.
    pub settings: BTreeMap<String, String>,
    /// Names of the settings that cannot be changed.
    pub fixed_settings: Vec<String>,
    /// System properties.
    pub properties: BTreeMap<String, String>,
    /// Made-up costs for a generated log, by method.
    pub load: BTreeMap<String, Load>,
    /// Faults that occur.
    pub fault: Vec<Fault>,
}

impl Default for Phone {
    fn default() -> Phone {
        Phone {
            serial: "SIMULATED".into(),
            manufacturer: "Simulated".into(),
            model: "phone".into(),
            android: "14".into(),
            state: "device".into(),
            installed: true,
            storage_full: false,
            capacity_mah: 4500.0,
            level_percent: 90.0,
            celsius: 27.0,
            ambient_celsius: 23.0,
            plugged: false,
            current: Current::Microamperes,
            positive: false,
            voltage: Voltage::Millivolts,
            kernel_battery: false,
            battery_held: false,
            charged_below: None,
            secure_lock: false,
            refresh_hz: 60.0,
            vr_api: false,
            others: Vec::new(),
            settings: BTreeMap::from([
                ("screen_brightness".into(), "102".into()),
                ("screen_brightness_mode".into(), "1".into()),
            ]),
            fixed_settings: Vec::new(),
            properties: BTreeMap::new(),
            load: BTreeMap::new(),
            fault: Vec::new(),
        }
    }
}

/// How a device reports the battery's current.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Current {
    /// In microamperes, as Android specifies.
    Microamperes,
    /// In milliamperes, as some devices do.
    Milliamperes,
    /// Always 0.
    Zero,
    /// Not at all.
    Missing,
}

/// How a device reports the battery's voltage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Voltage {
    /// In millivolts, as Android specifies.
    Millivolts,
    /// In volts, as some devices do.
    Volts,
}

/// The cost of a method.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Load {
    /// GPU time per frame in milliseconds.
    pub frame_ms: f64,
    /// Power of the whole device in milliwatts.
    pub milliwatts: f64,
}

impl Default for Load {
    fn default() -> Load {
        Load { frame_ms: 10.0, milliwatts: 3000.0 }
    }
}

/// The kinds of faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// The connection is lost.
    Disconnect,
    /// The connection is lost. Afterwards the device must be told again to trust this computer.
    Unauthorized,
    /// The device restarts.
    Reboot,
    /// The application crashes.
    Crash,
    /// The log ends for adb, with the connection intact.
    LogEnds,
    /// The charger is plugged in.
    Plug,
    /// The clock jumps by [`Fault::by`] seconds.
    ClockJump,
    /// The next line of the log is cut.
    Truncate,
    /// Lines of the log are not written.
    Silence,
    /// The log loses all of its lines.
    Rotate,
    /// The device throttles.
    Throttle,
    /// Somebody taps, which shows the next method.
    Tap,
}

/// A fault with its time.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Fault {
    /// What goes wrong.
    pub kind: FaultKind,
    /// Number of the application's start, from 1, in which the fault occurs.
    #[serde(default = "first")]
    pub start: u32,
    /// Time after the first frame of that start, in seconds.
    pub at: f64,
    /// Duration in seconds. `None` means for ever.
    pub seconds: Option<f64>,
    /// Seconds by which the clock jumps.
    #[serde(default)]
    pub by: f64,
}

fn first() -> u32 {
    1
}
