//! Experiments: methods, scenes and repetitions as a TOML file says, one run after the other on each device.
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

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::ProgressBar;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::adb::{Device, DeviceError};
use super::capture::{self, CaptureError, Fault, FaultKind, Outcome, RUN_FILE, RunInfo, Writer};
use super::latin::balanced_square;
use super::phone::{self, Battery};
use super::pins::{Pins, Wanted};
use super::run::{self, Found, Plan};
use super::table::toml_mistake;
use yoro_files::interrupt;
use yoro_files::{self as files, FileError};
use yoro_protocol::Method;
use yoro_protocol::{Settings, SettingsError};

/// What the experiment's own file is called in the folder of its runs.
pub const FILE: &str = "experiment.toml";
/// Seconds that a start takes, for the estimate of a plan's length.
const START_S: f64 = 5.0;
/// How often a cooling device is asked for its temperature.
const COOLING: Duration = Duration::from_secs(5);
/// How long a device may be gone between runs, in seconds.
const LOST_PATIENCE_S: f64 = 300.0;
/// Settings that are not the file's to give.
const RESERVED: &[&str] = &["scene", "duration", "auto-exit", "run"];

/// In what order methods take turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// By the rows of a balanced Latin square (Williams 1949): each method comes in each place, and after each other one,
    /// equally often over its rows. Scenes are shuffled.
    #[default]
    Balanced,
    /// Methods and scenes are shuffled.
    Random,
    /// As the file lists them.
    Listed,
}

/// What becomes of a run whose device does not cool down in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Otherwise {
    /// It is made, and says that it began too warm.
    #[default]
    Start,
    /// It is left out, and says why.
    Skip,
    /// The experiment ends here; the same command goes on later.
    Stop,
}

/// Waiting before each run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CoolDown {
    /// Warmest that the battery may be at the start of a run, in degrees Celsius.
    pub celsius: f64,
    /// Longest wait for it in seconds.
    #[serde(default = "CoolDown::default_max")]
    pub max_seconds: f64,
    /// What happens then.
    #[serde(default)]
    pub otherwise: Otherwise,
}

impl CoolDown {
    fn default_max() -> f64 {
        900.0
    }
}

/// A method as the experiment compares it: settings with a name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entrant {
    /// Name in tables; where the settings have no `method`, the stereo method itself.
    pub name: String,
    /// Settings of the viewer.
    #[serde(default, skip_serializing_if = "Table::is_empty")]
    pub settings: Table,
}

/// An experiment. Lengths are in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Experiment {
    /// Its name in captures and reports.
    pub name: String,
    /// Length of a run without warm-up.
    pub seconds: f64,
    /// What is cut off at the begin of a run.
    #[serde(default = "Experiment::default_warm_up")]
    pub warm_up_seconds: f64,
    /// How often each method is measured in each scene.
    #[serde(default = "Experiment::once")]
    pub repetitions: u32,
    /// In what order.
    #[serde(default)]
    pub order: Order,
    /// Seed of the order; each device has its own order from it.
    #[serde(default)]
    pub seed: u64,
    /// Pause before each run, at least.
    #[serde(default)]
    pub rest_seconds: f64,
    /// Scenes, as the viewer's setting `scene` takes them.
    pub scenes: Vec<String>,
    /// Brightness to pin the screen to, 0 to 255.
    pub brightness: Option<u8>,
    /// Refresh rate to pin the display to, in Hz.
    pub refresh_hz: Option<f64>,
    /// Whether this is about power: a device that is plugged in is refused.
    #[serde(default = "Experiment::about_power")]
    pub power: bool,
    /// Lowest level of the battery in percent that a run about power begins with; below, the experiment waits for somebody
    /// to charge the device.
    #[serde(default = "Experiment::default_min_level")]
    pub min_level: f64,
    /// Level in percent up to which it is charged then.
    #[serde(default = "Experiment::default_charge_level")]
    pub charge_level: f64,
    /// Waiting for a temperature before each run.
    pub cool_down: Option<CoolDown>,
    /// Settings of the viewer for all methods.
    #[serde(default, skip_serializing_if = "Table::is_empty")]
    pub settings: Table,
    /// The methods.
    pub method: Vec<Entrant>,
}

/// Why an experiment cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The file cannot be read, or the folder not written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file is not as it should be.
    #[error("{}: {what}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong and what is right.
        what: String,
    },
    /// The folder belongs to another experiment.
    #[error("{} holds runs of another experiment than {}: name another folder for the results", folder.display(), path.display())]
    Other {
        /// The folder.
        folder: PathBuf,
        /// The file.
        path: PathBuf,
    },
}

/// A run in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// What it shall be.
    pub plan: Plan,
    /// Name of its folder.
    pub folder: String,
}

/// `1 h 5 min`, for people.
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

    /// Reads and checks a file.
    ///
    /// # Errors
    /// [`ExperimentError`].
    pub fn read(path: &Path) -> Result<Experiment, ExperimentError> {
        let text = String::from_utf8_lossy(&files::read(path)?).into_owned();
        let format = |what: String| ExperimentError::Format { path: path.into(), what };
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
        ensure(self.refresh_hz.is_none_or(|hz| hz > 0.0 && hz.is_finite()), "refresh-hz must be above 0")?;
        let levels =
            0.0 <= self.min_level && self.min_level < self.charge_level && self.charge_level <= 100.0;
        ensure(levels, "min-level must be below charge-level, and both between 0 and 100 percent")?;
        let cool = |c: &CoolDown| c.celsius.is_finite() && in_order(c.max_seconds);
        ensure(
            self.cool_down.as_ref().is_none_or(cool),
            "cool-down: celsius and max-seconds must be numbers",
        )?;
        for (i, entrant) in self.method.iter().enumerate() {
            ensure(!entrant.name.trim().is_empty(), "a [[method]] has no name: give it one")?;
            let twin = self.method[..i].iter().any(|other| other.name == entrant.name);
            ensure(!twin, &format!("two methods are called \"{}\": give each its own name", entrant.name))?;
            for scene in &self.scenes {
                self.viewer_settings(entrant, scene).map_err(|error| error.to_string())?;
            }
        }
        for (i, scene) in self.scenes.iter().enumerate() {
            ensure(
                !self.scenes[..i].contains(scene),
                &format!("the scene \"{scene}\" is listed twice: once is enough"),
            )?;
        }
        let all = std::iter::once(&self.settings).chain(self.method.iter().map(|entrant| &entrant.settings));
        for key in all.flat_map(Table::keys) {
            let what = format!("the setting \"{key}\" is the experiment's own: leave it out");
            ensure(!RESERVED.contains(&key.as_str()), &what)?;
        }
        Ok(())
    }

    /// The settings of a method in a scene.
    fn viewer_settings(&self, entrant: &Entrant, scene: &str) -> Result<Settings, SettingsError> {
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let pairs = |table: &Table| table.iter().map(|(k, v)| format!("{k}={}", text(v))).collect::<Vec<_>>();
        let method = format!("method={}", entrant.name);
        let has_method = self.settings.contains_key("method") || entrant.settings.contains_key("method");
        let first = (!has_method).then_some(method).into_iter().chain([format!("scene={scene}")]);
        Settings::resolve(None, first.chain(pairs(&self.settings)).chain(pairs(&entrant.settings)))
    }

    /// All runs on a device, in their order.
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
        let (scene, entrant) = (&self.scenes[scene], &self.method[method]);
        // Checked when the file was read.
        let settings = self.viewer_settings(entrant, scene).unwrap_or_default();
        let plan = Plan {
            other: None,
            experiment: Some(self.name.clone()),
            method: entrant.name.clone(),
            settings,
            repetition,
            order,
            duration_s: self.seconds,
            warm_up_s: self.warm_up_seconds,
            warmest_celsius: self.cool_down.map(|cool_down| cool_down.celsius),
            refresh_hz: self.refresh_hz,
            power: self.power,
        };
        let folder = format!("{order:03}-{}-{}-{repetition}", file_name(scene), file_name(&entrant.name));
        Planned { plan, folder }
    }

    /// Shortest and longest time for so many runs, in seconds.
    pub fn length(&self, runs: usize) -> [f64; 2] {
        let run = self.warm_up_seconds + self.seconds + START_S;
        let cooling = self.cool_down.map_or(0.0, |cool_down| cool_down.max_seconds).max(self.rest_seconds);
        [run + self.rest_seconds, run + cooling].map(|seconds| seconds * runs as f64)
    }

    /// Makes a folder this experiment's, or sees that it is.
    ///
    /// # Errors
    /// [`ExperimentError`].
    pub fn claim(&self, folder: &Path, path: &Path) -> Result<(), ExperimentError> {
        let file = folder.join(FILE);
        if file.exists() {
            let same = Experiment::read(&file).is_ok_and(|before| before == *self);
            let other = || ExperimentError::Other { folder: folder.into(), path: path.into() };
            return if same { Ok(()) } else { Err(other()) };
        }
        let text = toml::to_string(self)
            .map_err(|error| ExperimentError::Format { path: path.into(), what: error.to_string() })?;
        Ok(files::write(&file, text.as_bytes())?)
    }
}

/// A name as part of the name of a file.
pub fn file_name(text: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-._".contains(c) { c } else { '-' };
    let name: String = text.chars().map(plain).collect();
    let name = name.trim_matches(['.', '-']);
    if name.is_empty() { "unnamed".into() } else { name.into() }
}

/// What an experiment has come to on a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Runs in the plan.
    pub planned: usize,
    /// Complete before.
    pub before: usize,
    /// Complete now.
    pub made: usize,
    /// Failed or left out: folder and reason.
    pub failed: Vec<(PathBuf, String)>,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} of {} runs complete", self.before + self.made, self.planned)?;
        if self.before > 0 {
            write!(f, " ({} from before)", self.before)?;
        }
        if !self.failed.is_empty() {
            write!(f, ", {} failed", self.failed.len())?;
        }
        Ok(())
    }
}

/// Makes the runs that a device still lacks, each into a folder of its own below `out`; what it finds changed on the
/// device, it leaves as it was, also after Ctrl-C. Runs that were cut off or failed are made again, and the earlier
/// captures kept beside them.
///
/// # Errors
/// [`DeviceError`]; the same call goes on later.
pub fn conduct(
    device: &dyn Device,
    experiment: &Experiment,
    out: &Path,
    bar: &ProgressBar,
) -> Result<Tally, DeviceError> {
    let found = run::look(device, phone::PACKAGE)?;
    // It is unlocked now, but nobody is there when it is locked again, by a restart at the latest.
    if phone::keyguard(device)?.secure {
        return Err(DeviceError::Locked(device.serial().into()));
    }
    if experiment.power {
        run::refuse_charger(device)?;
    }
    let wanted = Wanted { brightness: experiment.brightness, refresh_hz: experiment.refresh_hz };
    let mut pins = Pins::new(device, &found.info, &wanted)?;
    let folder = out.join(file_name(&found.info.serial));
    let made = Conductor { device, experiment, found: &found, pins: &mut pins, folder: &folder, bar }.all();
    // Also after Ctrl-C and after errors. One on top of another says nothing new.
    match (made, pins.give_back(device)) {
        (Ok(_), Err(error)) => Err(error),
        (Err(first), Err(error)) => {
            bar.suspend(|| {
                log::warn!("{error}; the next measurement gives brightness and refresh rate back")
            });
            Err(first)
        }
        (made, Ok(())) => made,
    }
}

struct Conductor<'a> {
    device: &'a dyn Device,
    experiment: &'a Experiment,
    found: &'a Found,
    pins: &'a mut Pins,
    folder: &'a Path,
    bar: &'a ProgressBar,
}

impl Conductor<'_> {
    fn all(&mut self) -> Result<Tally, DeviceError> {
        let planned = self.experiment.plan(&self.found.info.serial);
        let mut tally = Tally { planned: planned.len(), ..Tally::default() };
        for (i, planned) in planned.iter().enumerate() {
            let folder = self.folder.join(&planned.folder);
            if is_complete(&folder, &planned.plan)? {
                tally.before += 1;
                continue;
            }
            if interrupt::requested() {
                return Err(DeviceError::Interrupted);
            }
            set_aside(&folder)?;
            let [left, _] = self.experiment.length(tally.planned - i);
            let (run, of) = (i + 1, tally.planned);
            self.bar.set_prefix(format!(
                "{}: run {run} of {of}, {} left",
                self.device.serial(),
                length(left)
            ));
            self.bar.set_length(planned.plan.seconds() as u64);
            self.bar.set_position(0);
            let info = self.one(&planned.plan, &folder)?;
            match info.outcome {
                Outcome::Complete => tally.made += 1,
                Outcome::Failed { reason } => {
                    self.bar.suspend(|| log::warn!("{}: {reason}", folder.display()));
                    tally.failed.push((folder, reason));
                }
                Outcome::Interrupted { .. } if interrupt::requested() => {
                    return Err(DeviceError::Interrupted);
                }
                Outcome::Interrupted { .. } => {
                    return Err(DeviceError::Lost(self.device.serial().into()));
                }
            }
        }
        Ok(tally)
    }

    fn one(&mut self, plan: &Plan, folder: &Path) -> Result<RunInfo, DeviceError> {
        if let Some(celsius) = self.cool_down(plan)?
            && let Some(cool_down) = self.experiment.cool_down
        {
            let wanted = cool_down.celsius;
            match cool_down.otherwise {
                Otherwise::Start => {}
                Otherwise::Skip => return self.leave_out(plan, folder, celsius, wanted),
                Otherwise::Stop => {
                    let serial = self.device.serial().into();
                    return Err(DeviceError::TooWarm { serial, celsius, wanted });
                }
            }
        }
        let mut made = run::capture(self.device, self.found, plan, self.pins, folder, self.bar);
        if made.as_ref().is_err_and(DeviceError::is_lost) && !interrupt::requested() {
            // Gone before there was anything to follow: waited for as between runs, once.
            set_aside(folder)?;
            self.cool_down(plan)?;
            made = run::capture(self.device, self.found, plan, self.pins, folder, self.bar);
        }
        match made {
            // The capture says so; the other runs may be possible.
            Err(DeviceError::Refused { .. }) if folder.join(RUN_FILE).exists() => {
                Ok(capture::read_info(folder)?)
            }
            result => result,
        }
    }

    /// Waits for rest, charge and temperature. The temperature where it was too high to the end.
    fn cool_down(&self, plan: &Plan) -> Result<Option<f64>, DeviceError> {
        let mut begin = self.device.now();
        let mut lost_at = None;
        let mut charging = None;
        let wanted = self.experiment.cool_down;
        loop {
            if interrupt::requested() {
                return Err(DeviceError::Interrupted);
            }
            let waited = self.device.now() - begin;
            let asked = phone::stop(self.device, plan.package()).and_then(|()| phone::battery(self.device));
            let battery = match asked {
                Ok(battery) => battery,
                Err(error) if error.is_lost() => {
                    let lost_at = *lost_at.get_or_insert(self.device.now());
                    if self.device.now() - lost_at > LOST_PATIENCE_S {
                        return Err(error);
                    }
                    self.bar.set_message("lost: connect it again");
                    self.device.reconnect();
                    self.device.sleep(COOLING);
                    continue;
                }
                Err(error) => return Err(error),
            };
            lost_at = None;
            if self.experiment.power && self.must_charge(&battery, &mut charging) {
                // Charging warms the battery: the time to cool down begins when it is over.
                begin = self.device.now();
                self.device.sleep(COOLING);
                continue;
            }
            let celsius = battery.celsius.filter(|celsius| wanted.is_some_and(|w| *celsius > w.celsius));
            let rested = waited >= self.experiment.rest_seconds;
            match (celsius, wanted) {
                (None, _) if rested => return Ok(None),
                (Some(celsius), Some(wanted)) if rested && waited >= wanted.max_seconds => {
                    return Ok(Some(celsius));
                }
                (Some(celsius), Some(wanted)) => self.bar.set_message(format!(
                    "before {}, {}: {celsius:.1} C, cooling down to {:.1} C",
                    plan.method, plan.settings.scene, wanted.celsius
                )),
                _ => self.bar.set_message("resting"),
            }
            self.device.sleep(COOLING);
        }
    }

    /// Whether to wait for somebody who charges the battery or takes the charger off. `charging` is none outside of such a
    /// pause, and inside of it whether there has been a charger: who takes it off early wants to go on.
    fn must_charge(&self, battery: &Battery, charging: &mut Option<bool>) -> bool {
        let Experiment { min_level, charge_level, .. } = *self.experiment;
        let Some(level) = battery.level_percent else { return false };
        let (is_low, plugged) = (level < min_level, battery.plugged());
        let what = match level < charge_level && (is_low || charging.is_some()) {
            true => format!("charge it to {charge_level:.0} %, then take the charger off"),
            false => "take the charger off".into(),
        };
        if charging.is_none() && (is_low || plugged) {
            *charging = Some(plugged);
            self.bar.suspend(|| {
                log::warn!(
                    "{}: the battery has {level:.0} %: {what}, and the plan goes on",
                    self.device.serial()
                )
            });
        }
        let Some(was_plugged) = charging else { return false };
        *was_plugged |= plugged;
        if !plugged && (level >= charge_level || *was_plugged && !is_low) {
            *charging = None;
            return false;
        }
        self.bar.set_message(format!("{level:.0} %: {what}"));
        true
    }

    /// A capture of a run that was not made.
    fn leave_out(
        &self,
        plan: &Plan,
        folder: &Path,
        celsius: f64,
        wanted: f64,
    ) -> Result<RunInfo, DeviceError> {
        let reason = format!("the battery had {celsius:.1} C and did not cool down to {wanted:.1} C in time");
        let fault = Fault { kind: FaultKind::TooWarm, at_s: Some(0.0), detail: reason.clone() };
        let mut info = plan.info(self.found, self.device.now(), Some(celsius));
        info.faults.push(fault);
        Ok(Writer::create(folder, info)?.finish(Outcome::Failed { reason })?)
    }
}

/// Whether the folder holds this run, complete.
fn is_complete(folder: &Path, plan: &Plan) -> Result<bool, DeviceError> {
    if !folder.join(RUN_FILE).exists() {
        return Ok(false);
    }
    let info = match capture::read_info(folder) {
        Ok(info) => info,
        // It was damaged while it was written: as good as cut off.
        Err(CaptureError::Damaged { .. }) => return Ok(false),
        Err(error) => return Err(error.into()),
    };
    Ok(info.outcome == Outcome::Complete && info.method == plan.method && info.scene == plan.settings.scene)
}

/// Renames the folder of a run that is to be made again.
fn set_aside(folder: &Path) -> Result<(), DeviceError> {
    if !folder.exists() {
        return Ok(());
    }
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let aside = |n: u32| folder.with_file_name(format!("{name}-cut-{n}"));
    let free = (1..).map(aside).find(|path| !path.exists()).unwrap_or_else(|| aside(0));
    fs::rename(folder, &free).map_err(|source| FileError::Write { path: folder.into(), source })?;
    Ok(())
}

/// The stereo methods that settings name, for a table of the plan.
pub fn method_name(plan: &Plan) -> String {
    match plan.settings.method {
        Method::Yoro => format!("yoro, {}", plan.settings.pipeline.name()),
        method => method.name().into(),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn read(text: &str) -> Result<Experiment, String> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("e.toml");
        fs::write(&path, text).unwrap();
        Experiment::read(&path).map_err(|error| error.to_string())
    }

    const SMALL: &str = "name = \"small\"\nseconds = 10\nscenes = [\"talk\", \"stage\"]\n";

    fn with_methods(n: usize) -> Experiment {
        let methods: String = (0..n)
            .map(|i| format!("[[method]]\nname = \"m{i}\"\nsettings = {{ method = \"mono\" }}\n"))
            .collect();
        read(&format!("{SMALL}repetitions = 4\n{methods}")).unwrap()
    }

    #[test]
    fn plans_are_complete_and_the_same_again() {
        let mut experiment = with_methods(3);
        for order in [Order::Balanced, Order::Random, Order::Listed] {
            experiment.order = order;
            let plan = experiment.plan("S1");
            assert_eq!(plan, experiment.plan("S1"));
            assert_eq!(plan.len(), 24);
            assert!(plan.iter().enumerate().all(|(i, p)| p.plan.order as usize == i + 1));
            let of = |p: &Planned| (p.plan.repetition, p.plan.settings.scene.clone(), p.plan.method.clone());
            assert_eq!(plan.iter().map(of).collect::<BTreeSet<_>>().len(), 24);
            let repetitions: Vec<u32> = plan.iter().map(|p| p.plan.repetition).collect();
            assert!(repetitions.is_sorted(), "a repetition is over before the next one");
            let same = experiment.plan("S2") == plan;
            assert_eq!(same, order == Order::Listed, "devices have orders of their own");
        }
        assert_eq!(experiment.plan("S1")[0].folder, "001-talk-m0-1");
        assert_eq!(experiment.length(24), [1080.0, 1080.0]);
        assert_eq!(
            (length(40.0 * 60.0), length(3900.0), length(12.0)),
            ("40 min".into(), "1 h 5 min".into(), "12 s".into())
        );
    }

    #[test]
    fn methods_are_settings_with_a_name() {
        let text = format!(
            "{SMALL}[settings]\nhud = false\n[[method]]\nname = \"hybrid\"\n[[method]]\nname = \"paper\"\nsettings = {{ method = \"yoro\", pipeline = \"paper\", imbuffer = 2 }}\n"
        );
        let experiment = Experiment { order: Order::Listed, ..read(&text).unwrap() };
        let plan = experiment.plan("S1");
        assert_eq!(plan[0].plan.settings.method, Method::Hybrid);
        assert_eq!(method_name(&plan[1].plan), "yoro, paper");
        let own = plan[1].plan.own_settings();
        let own: Vec<_> = own.iter().map(|(k, v)| format!("{k}={v}")).collect();
        assert_eq!(own, ["hud=false", "imbuffer=2", "pipeline=paper"]);
        let written: Experiment = toml::from_str(&toml::to_string(&experiment).unwrap()).unwrap();
        assert_eq!(written, experiment);
    }

    #[test]
    fn mistakes_are_one_sentence() {
        let method = "[[method]]\nname = \"yoro\"\n";
        for (text, word) in [
            (format!("{SMALL}{method}colour = 1\n"), "colour"),
            (SMALL.to_owned(), "method"),
            (format!("{SMALL}{method}{method}"), "two methods"),
            (format!("{SMALL}[[method]]\nname = \"magic\"\n"), "magic"),
            (format!("{SMALL}{method}settings = {{ speed = 1 }}\n"), "speed"),
            (format!("{SMALL}{method}settings = {{ duration = 1 }}\n"), "duration"),
            (format!("{SMALL}repetitions = 0\n{method}"), "repetitions"),
            (format!("{SMALL}[cool-down]\nmax-seconds = 3\n{method}"), "celsius"),
            (SMALL.replace("stage", "talk") + method, "twice"),
            (SMALL.replace("10", "-1") + method, "seconds"),
        ] {
            let error = read(&text).unwrap_err();
            assert!(
                error.contains(word) && error.contains("e.toml") && !error.contains('\n'),
                "{word}: {error}"
            );
        }
    }

    #[test]
    fn the_experiments_of_this_repository() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../experiments");
        for (name, hours) in [("paper.toml", 24.0), ("five-minutes.toml", 1.0)] {
            let experiment = Experiment::read(&folder.join(name)).unwrap();
            let runs = experiment.plan("S1").len();
            assert!(experiment.length(runs)[0] < hours * 3600.0, "{name}");
        }
        let paper = Experiment::read(&folder.join("paper.toml")).unwrap();
        assert_eq!((paper.seconds, paper.scenes.len()), (600.0, 8));
    }
}
