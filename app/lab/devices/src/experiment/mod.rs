//! Experiments: methods, scenes and repetitions from a TOML file, one run after the other on each device.
//!
//! ```toml
//! name = "five-minutes"
//! seconds = 50
//! warm-up-seconds = 10
//! repetitions = 1
//! scenes = ["prototype", "street"]
//!
//! [cool-down]
//! celsius = 32
//!
//! [[method]]
//! name = "conventional"
//!
//! [[method]]
//! name = "paper"
//! settings = { method = "yoro", pipeline = "paper" }
//! ```

mod conduct;
#[cfg(test)]
mod tests;

use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use crate::DataError;
use crate::latin_square::balanced_square;
use crate::run::Plan;
use crate::table::toml_mistake;
use yoro_files::{self as files, FileError};
use yoro_settings::{Method, MethodChoice, Settings, SettingsError};

pub use conduct::{Progress, conduct};

/// The name under which the experiment is kept in the folder of its runs.
pub const FILE: &str = "experiment.toml";
/// Estimated seconds to start the application, for the length of a plan.
const START_S: f64 = 5.0;
/// Settings that an experiment's file may not contain.
const RESERVED: &[&str] = &["scene", "duration", "run"];
/// Maximum number of runs on a device: two weeks of two minutes each.
const MAX_RUNS: usize = 10_000;

/// The order of the runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// The rows of a balanced Latin square (Williams 1949): over all rows, each method comes equally often in each
    /// place, and equally often after each other method. Scenes are shuffled.
    #[default]
    Balanced,
    /// Methods and scenes are shuffled.
    Random,
    /// The order in the file.
    Listed,
}

/// What happens to a run if the device does not cool down in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WhenTooWarm {
    /// The run is made, with the fault that it began too warm.
    #[default]
    Start,
    /// The run is skipped, and the reason is recorded.
    Skip,
    /// The experiment stops. The same command continues it later.
    Stop,
}

/// Cooling down before each run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CoolDown {
    /// Highest temperature of the battery at the start of a run in degrees Celsius.
    pub celsius: f64,
    /// Maximum time to wait for this in seconds.
    #[serde(default = "CoolDown::default_max")]
    pub max_seconds: f64,
    /// What happens if the device is still too warm after this time.
    #[serde(default)]
    pub otherwise: WhenTooWarm,
}

impl CoolDown {
    fn default_max() -> f64 {
        900.0
    }
}

/// A method of an experiment: a name and settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodEntry {
    /// Name in tables. Also the stereo method, if the settings have no `method`.
    pub name: String,
    /// Viewer settings.
    #[serde(default, skip_serializing_if = "Table::is_empty")]
    pub settings: Table,
}

/// An experiment. Lengths are in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Experiment {
    /// The name in captures and reports.
    pub name: String,
    /// Length of a run, without the warm-up.
    pub seconds: f64,
    /// Warm-up at the beginning of a run. Its samples are discarded.
    #[serde(default = "Experiment::default_warm_up")]
    pub warm_up_seconds: f64,
    /// Number of runs of each method in each scene.
    #[serde(default = "Experiment::once")]
    pub repetitions: u32,
    /// The order of the runs.
    #[serde(default)]
    pub order: Order,
    /// Seed of the order, from which each device gets its own order.
    #[serde(default)]
    pub seed: u64,
    /// Minimum pause before each run.
    #[serde(default)]
    pub rest_seconds: f64,
    /// Scenes, as in the viewer's setting `scene`.
    pub scenes: Vec<String>,
    /// Brightness to hold the screen at, 0 to 255.
    pub brightness: Option<u8>,
    /// Refresh rate to hold the display at, in Hz.
    pub refresh_hz: Option<f64>,
    /// True to measure power. A device that is plugged in is refused.
    #[serde(default = "Experiment::about_power")]
    pub power: bool,
    /// Minimum battery level in percent at the start of a power measurement. Below it, the experiment waits until the
    /// device has been charged.
    #[serde(default = "Experiment::default_min_level")]
    pub min_level: f64,
    /// Battery level in percent up to which the device is then charged.
    #[serde(default = "Experiment::default_charge_level")]
    pub charge_level: f64,
    /// The temperature to wait for before each run.
    pub cool_down: Option<CoolDown>,
    /// Viewer settings for all methods.
    #[serde(default, skip_serializing_if = "Table::is_empty")]
    pub settings: Table,
    /// The methods.
    pub method: Vec<MethodEntry>,
}

/// The exclusive right of one process to make runs in a folder.
#[derive(Debug)]
#[expect(dead_code, reason = "the file is locked while it is open")]
pub struct Claim(File);

/// A planned run.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// The run's plan.
    pub plan: Plan,
    /// The name of the run's folder.
    pub folder: String,
}

/// Formats a duration for people, such as `1 h 5 min`.
pub fn length(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round() as u64;
    match (minutes / 60, minutes % 60) {
        (0, 0) => format!("{seconds:.0} s"),
        (0, minutes) => format!("{minutes} min"),
        (hours, minutes) => format!("{hours} h {minutes} min"),
    }
}

impl Experiment {
    fn default_warm_up() -> f64 {
        30.0
    }

    fn default_min_level() -> f64 {
        20.0
    }

    fn default_charge_level() -> f64 {
        90.0
    }

    fn once() -> u32 {
        1
    }

    fn about_power() -> bool {
        true
    }

    /// Reads and checks an experiment's file.
    pub fn read(path: &Path) -> Result<Experiment, DataError> {
        let text = String::from_utf8_lossy(&files::read(path)?).into_owned();
        let format = |what: String| DataError::Unusable(format!("{}: {what}", path.display()));
        let experiment: Experiment =
            toml::from_str(&text).map_err(|error| format(toml_mistake(&text, &error)))?;
        experiment.check().map_err(format)?;
        Ok(experiment)
    }

    fn check(&self) -> Result<(), String> {
        let ensure = |fine: bool, what: &str| if fine { Ok(()) } else { Err(what.to_owned()) };
        let in_order = |value: f64| value >= 0.0 && value.is_finite();
        ensure(self.seconds > 0.0 && self.seconds.is_finite(), "seconds must be above 0")?;
        ensure(in_order(self.warm_up_seconds), "warm-up-seconds cannot be negative")?;
        ensure(in_order(self.rest_seconds), "rest-seconds cannot be negative")?;
        ensure(self.repetitions > 0, "repetitions must be 1 at least")?;
        ensure(!self.scenes.is_empty(), "scenes names none: name one at least")?;
        ensure(!self.method.is_empty(), "there is no [[method]]: give one at least")?;
        let runs =
            self.scenes.len().saturating_mul(self.method.len()).saturating_mul(self.repetitions as usize);
        let many = format!(
            "{runs} runs are too many ({} scenes, {} methods, {} repetitions): up to {MAX_RUNS} are made, so give fewer repetitions",
            self.scenes.len(),
            self.method.len(),
            self.repetitions
        );
        ensure(runs <= MAX_RUNS, &many)?;
        ensure(self.refresh_hz.is_none_or(|hz| hz > 0.0 && hz.is_finite()), "refresh-hz must be above 0")?;
        let levels =
            0.0 <= self.min_level && self.min_level < self.charge_level && self.charge_level <= 100.0;
        ensure(levels, "min-level must be below charge-level, and both between 0 and 100 percent")?;
        let cool = |c: &CoolDown| c.celsius.is_finite() && in_order(c.max_seconds);
        ensure(
            self.cool_down.as_ref().is_none_or(cool),
            "cool-down: celsius and max-seconds must be numbers",
        )?;
        for (i, entry) in self.method.iter().enumerate() {
            ensure(!entry.name.trim().is_empty(), "a [[method]] has no name: give it one")?;
            let twin = self.method[..i].iter().any(|other| other.name == entry.name);
            ensure(!twin, &format!("two methods are called \"{}\": give each its own name", entry.name))?;
            for scene in &self.scenes {
                self.viewer_settings(entry, scene).map_err(|error| error.to_string())?;
            }
        }
        for (i, scene) in self.scenes.iter().enumerate() {
            ensure(
                !self.scenes[..i].contains(scene),
                &format!("the scene \"{scene}\" is listed twice: once is enough"),
            )?;
        }
        let all = std::iter::once(&self.settings).chain(self.method.iter().map(|entry| &entry.settings));
        for key in all.flat_map(Table::keys) {
            let what = format!("the setting \"{key}\" is the experiment's own: leave it out");
            ensure(!RESERVED.contains(&key.as_str()), &what)?;
        }
        Ok(())
    }

    /// Returns the viewer settings of a method in a scene.
    fn viewer_settings(&self, entry: &MethodEntry, scene: &str) -> Result<Settings, SettingsError> {
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let pairs = |table: &Table| table.iter().map(|(k, v)| format!("{k}={}", text(v))).collect::<Vec<_>>();
        let method = format!("method={}", entry.name);
        let has_method = self.settings.contains_key("method") || entry.settings.contains_key("method");
        let first = (!has_method).then_some(method).into_iter().chain([format!("scene={scene}")]);
        Settings::resolve(None, first.chain(pairs(&self.settings)).chain(pairs(&entry.settings)))
    }

    /// Returns all runs on the device with this serial number, in order.
    pub fn plan(&self, serial: &str) -> Vec<Planned> {
        let own = serial
            .bytes()
            .fold(self.seed, |hash, byte| hash.wrapping_mul(0x100_0000_01b3).wrapping_add(u64::from(byte)));
        let mut random = Pcg64Mcg::seed_from_u64(own);
        let mut names: Vec<usize> = (0..self.method.len()).collect();
        let rows = balanced_square(names.len());
        let mut shift = 0;
        if self.order == Order::Balanced {
            names.shuffle(&mut random);
            shift = rand::Rng::random_range(&mut random, 0..rows.len());
        }
        let mut planned = Vec::new();
        for repetition in 1..=self.repetitions {
            let mut scenes: Vec<usize> = (0..self.scenes.len()).collect();
            if self.order != Order::Listed {
                scenes.shuffle(&mut random);
            }
            for scene in scenes {
                let mut methods: Vec<usize> = (0..names.len()).collect();
                match self.order {
                    Order::Balanced => {
                        let row = &rows[(shift + scene + repetition as usize) % rows.len()];
                        methods = row.iter().map(|place| names[*place]).collect();
                    }
                    Order::Random => methods.shuffle(&mut random),
                    Order::Listed => {}
                }
                for method in methods {
                    planned.push(self.planned(planned.len() as u32 + 1, repetition, scene, method));
                }
            }
        }
        planned
    }

    fn planned(&self, order: u32, repetition: u32, scene: usize, method: usize) -> Planned {
        let (scene, entry) = (&self.scenes[scene], &self.method[method]);
        // Does not fail: `read` has checked the settings.
        let settings = self.viewer_settings(entry, scene).unwrap_or_default();
        let plan = Plan {
            experiment: Some(self.name.clone()),
            method: entry.name.clone(),
            settings,
            repetition,
            order,
            duration_s: self.seconds,
            warm_up_s: self.warm_up_seconds,
            warmest_celsius: self.cool_down.map(|cool_down| cool_down.celsius),
            refresh_hz: self.refresh_hz,
            power: self.power,
        };
        let folder = format!("{order:03}-{}-{}-{repetition}", file_name(scene), file_name(&entry.name));
        Planned { plan, folder }
    }

    /// Returns the shortest and the longest duration of this number of runs in seconds.
    pub fn length(&self, runs: usize) -> [f64; 2] {
        let run = self.warm_up_seconds + self.seconds + START_S;
        let cooling = self.cool_down.map_or(0.0, |cool_down| cool_down.max_seconds).max(self.rest_seconds);
        [run + self.rest_seconds, run + cooling].map(|seconds| seconds * runs as f64)
    }

    /// Writes the experiment into its folder, or checks that the folder belongs to it. Other processes cannot claim the
    /// folder until the result is dropped.
    pub fn claim(&self, folder: &Path, path: &Path) -> Result<Claim, DataError> {
        let file = folder.join(FILE);
        let mut claimed = files::append(&file)?;
        if claimed.metadata().is_ok_and(|meta| meta.len() > 0) {
            if Experiment::read(&file).is_ok_and(|before| before == *self) {
                return Ok(Claim(claimed));
            }
            let (folder, path) = (folder.display(), path.display());
            return Err(DataError::File(FileError::OtherRun(format!(
                "{folder} holds runs of another experiment than {path}: name another folder for the results"
            ))));
        }
        let text = toml::to_string(self)
            .map_err(|error| DataError::Unusable(format!("{}: {error}", path.display())))?;
        claimed.write_all(text.as_bytes()).map_err(|source| {
            let _ = fs::remove_file(&file);
            FileError::Write { path: file.clone(), source }
        })?;
        Ok(Claim(claimed))
    }
}

/// Turns a name into part of a file name.
pub fn file_name(text: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-._".contains(c) { c } else { '-' };
    let name: String = text.chars().map(plain).collect();
    let name = name.trim_matches(['.', '-']);
    if name.is_empty() { "unnamed".into() } else { name.into() }
}

/// Returns the stereo method in the settings, for a table of the plan.
pub fn method_name(plan: &Plan) -> String {
    match plan.settings.method {
        MethodChoice::Named(Method::Synthesized) => format!("yoro, {}", plan.settings.pipeline.name()),
        method => method.name().into(),
    }
}
