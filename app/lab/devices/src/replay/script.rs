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
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::adb::DeviceError;
use crate::capture;
use crate::table::toml_mistake;
use yoro_files as files;

/// The devices of a replay and their faults.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Script {
    /// Seed of everything that is generated.
    #[serde(default)]
    pub seed: u64,
    /// Simulated seconds per real second. `None` means as fast as possible.
    pub speed: Option<f64>,
    /// A folder, relative to the script, in which the devices keep settings, properties and files from one replay to
    /// the next. With `None`, every replay starts from the initial state.
    pub state: Option<PathBuf>,
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
    /// The settings of the application if it runs at the start.
    pub running: Option<BTreeMap<String, String>>,
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
    /// The other application that runs at the start.
    pub foreground: Option<String>,
    /// Android's settings by name. Names outside the table `system` have the form `global/low_power`.
    pub settings: BTreeMap<String, String>,
    /// Names of the settings that cannot be changed.
    pub fixed_settings: Vec<String>,
    /// System properties.
    pub properties: BTreeMap<String, String>,
    /// Files on the device by path.
    pub files: BTreeMap<String, String>,
    /// Recorded logs, relative to the script. If there are any, no lines are generated, and the application does not
    /// start with a method and scene that is in none of them.
    pub logs: Vec<PathBuf>,
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
            running: None,
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
            foreground: None,
            settings: BTreeMap::from([
                ("screen_brightness".into(), "102".into()),
                ("screen_brightness_mode".into(), "1".into()),
            ]),
            fixed_settings: Vec::new(),
            properties: BTreeMap::new(),
            files: BTreeMap::new(),
            logs: Vec::new(),
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

impl Phone {
    /// Returns a sentence on a number that is out of range. Within the ranges, time and power stay finite.
    fn mistake(&self) -> Option<String> {
        let numbers = [
            ("capacity-mah", self.capacity_mah, 0.0..=1e6),
            ("level-percent", self.level_percent, 0.0..=100.0),
            ("celsius", self.celsius, -100.0..=200.0),
            ("ambient-celsius", self.ambient_celsius, -100.0..=200.0),
            ("charged-below", self.charged_below.unwrap_or(0.0), 0.0..=100.0),
            ("refresh-hz", self.refresh_hz, 1.0..=1000.0),
        ];
        let loads = self.load.values().flat_map(|load| {
            [("frame-ms", load.frame_ms, 1e-3..=1e6), ("milliwatts", load.milliwatts, 0.0..=1e6)]
        });
        let faults = self.fault.iter().flat_map(|fault| {
            let seconds = fault.seconds.unwrap_or(0.0);
            [("at", fault.at, 0.0..=1e9), ("seconds", seconds, 0.0..=1e9), ("by", fault.by, -1e9..=1e9)]
        });
        let mut all = numbers.into_iter().chain(loads).chain(faults);
        let (name, value, range) = all.find(|(_, value, range)| !range.contains(value))?;
        Some(format!("{name} is {value}: give a number from {} to {}", range.start(), range.end()))
    }
}

impl Script {
    /// Reads a script, or makes one from the captures in a folder, whose logs are replayed.
    pub fn read(path: &Path) -> Result<Script, DeviceError> {
        let script = if path.is_dir() { Script::of_captures(path)? } else { Script::of_file(path)? };
        let refuse = |reason: &str| Err(DeviceError::Replay { path: path.into(), reason: reason.into() });
        if script.speed.is_some_and(|speed| !(speed > 0.0 && speed.is_finite())) {
            return refuse("speed must be above 0");
        }
        if let Some((phone, what)) = script.device.iter().find_map(|phone| Some((phone, phone.mistake()?))) {
            return refuse(&format!("the device {}: {what}", phone.serial));
        }
        let mut serials: Vec<&str> = script.device.iter().map(|phone| phone.serial.as_str()).collect();
        serials.sort_unstable();
        serials.dedup();
        if serials.len() < script.device.len() {
            return refuse("two devices have the same serial: give each its own");
        }
        Ok(script)
    }

    fn of_file(path: &Path) -> Result<Script, DeviceError> {
        let bytes = files::read(path)?;
        let refused = |reason: String| DeviceError::Replay { path: path.into(), reason };
        let text =
            String::from_utf8(bytes).map_err(|_| refused("this is no text: give a TOML file".into()))?;
        let mut script: Script =
            toml::from_str(&text).map_err(|error| refused(toml_mistake(&text, &error)))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        script.state = script.state.map(|state| folder.join(state));
        for log in script.device.iter_mut().flat_map(|phone| &mut phone.logs) {
            *log = folder.join(&*log);
        }
        Ok(script)
    }

    fn of_captures(folder: &Path) -> Result<Script, DeviceError> {
        let mut script = Script::default();
        for run in capture::find(&[folder.into()])? {
            let info = capture::read_info(&run)?.device;
            let log = run.join(capture::LOG_FILE);
            if let Some(phone) = script.device.iter_mut().find(|phone| phone.serial == info.serial) {
                phone.logs.push(log);
                continue;
            }
            script.device.push(Phone {
                serial: info.serial,
                manufacturer: info.manufacturer,
                model: info.model,
                android: info.android,
                capacity_mah: info.capacity_mah.unwrap_or(0.0),
                logs: vec![log],
                ..Phone::default()
            });
        }
        Ok(script)
    }
}
