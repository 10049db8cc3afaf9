//! Makes the runs of an experiment on a device, with pauses between them.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::ProgressBar;

use super::{Experiment, WhenTooWarm, file_name, length};
use crate::DataError;
use crate::adb::{Device, DeviceError, now, sleep};
use crate::capture::{self, Fault, FaultKind, Outcome, RUN_FILE, RunInfo, Writer};
use crate::held_settings::{HeldSettings, Wanted};
use crate::phone::{self, Battery};
use crate::run::{self, Found, LOST_TIMEOUT_S, Plan};
use yoro_files::{FileError, interrupt};

/// Interval at which the temperature of a cooling device is read.
const COOLING: Duration = Duration::from_secs(5);

/// The progress of an experiment on a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// Number of runs in the plan.
    pub planned: usize,
    /// Number of runs that were complete before this call.
    pub before: usize,
    /// Number of runs made by this call.
    pub made: usize,
    /// Runs that failed or were skipped: folder and reason.
    pub failed: Vec<(PathBuf, String)>,
}

impl fmt::Display for Progress {
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

/// Makes the missing runs on a device, each in its own folder below `out`. Restores the device's settings afterwards,
/// even after Ctrl-C. Repeats runs that were interrupted or failed, and keeps their earlier captures.
///
/// # Errors
/// [`DeviceError`]. A later call continues where this one stopped.
pub fn conduct(
    device: &Device,
    experiment: &Experiment,
    out: &Path,
    bar: &ProgressBar,
) -> Result<Progress, DeviceError> {
    let found = run::look(device)?;
    // Even if the device is unlocked now, a restart would lock it again with nobody there to unlock it.
    if phone::keyguard(device)?.secure {
        return Err(run::locked(device));
    }
    if experiment.power {
        run::refuse_charger(device)?;
    }
    let wanted = Wanted { brightness: experiment.brightness, refresh_hz: experiment.refresh_hz };
    let mut held = HeldSettings::new(device, &found.info, &wanted)?;
    let folder = out.join(file_name(&found.info.serial));
    let made = Conductor { device, experiment, found: &found, held: &mut held, folder: &folder, bar }.all();
    // Restore after errors and Ctrl-C, too. If both fail, the first error is returned.
    match (made, held.restore(device)) {
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
    device: &'a Device,
    experiment: &'a Experiment,
    found: &'a Found,
    held: &'a mut HeldSettings,
    folder: &'a Path,
    bar: &'a ProgressBar,
}

impl Conductor<'_> {
    fn all(&mut self) -> Result<Progress, DeviceError> {
        let planned = self.experiment.plan(&self.found.info.serial);
        let mut progress = Progress { planned: planned.len(), ..Progress::default() };
        for (i, planned) in planned.iter().enumerate() {
            let folder = self.folder.join(&planned.folder);
            if is_complete(&folder, &planned.plan)? {
                progress.before += 1;
                continue;
            }
            if interrupt::requested() {
                return Err(DeviceError::Interrupted);
            }
            set_aside(&folder)?;
            let [left, _] = self.experiment.length(progress.planned - i);
            let (run, of) = (i + 1, progress.planned);
            self.bar.set_prefix(format!("{}: run {run} of {of}, {} left", self.device.serial, length(left)));
            self.bar.set_length(planned.plan.seconds() as u64);
            self.bar.set_position(0);
            let info = self.one(&planned.plan, &folder)?;
            match info.outcome {
                Outcome::Complete => progress.made += 1,
                Outcome::Failed { reason } => {
                    self.bar.suspend(|| log::warn!("{}: {reason}", folder.display()));
                    progress.failed.push((folder, reason));
                }
                Outcome::Interrupted { .. } if interrupt::requested() => {
                    return Err(DeviceError::Interrupted);
                }
                Outcome::Interrupted { reason } => {
                    return Err(DeviceError::Unreached { serial: self.device.serial.clone(), words: reason });
                }
            }
        }
        Ok(progress)
    }

    fn one(&mut self, plan: &Plan, folder: &Path) -> Result<RunInfo, DeviceError> {
        if let Some(celsius) = self.cool_down(plan)?
            && let Some(cool_down) = self.experiment.cool_down
        {
            let wanted = cool_down.celsius;
            match cool_down.otherwise {
                WhenTooWarm::Start => {}
                WhenTooWarm::Skip => return self.leave_out(plan, folder, celsius, wanted),
                WhenTooWarm::Stop => {
                    return Err(DeviceError::Unfit(format!(
                        "{} has {celsius:.1} C and does not cool down to {wanted:.1} C: let it rest in a cooler place, \
                         then give the same command",
                        self.device.serial
                    )));
                }
            }
        }
        match run::capture(self.device, self.found, plan, self.held, folder, self.bar) {
            // The capture names the reason, and other runs may succeed.
            Err(DeviceError::Refused { .. }) if folder.join(RUN_FILE).exists() => {
                Ok(capture::read_info(folder)?)
            }
            result => result,
        }
    }

    /// Waits for the pause, the charge and the temperature. Returns the temperature if it is still too high.
    fn cool_down(&self, plan: &Plan) -> Result<Option<f64>, DeviceError> {
        let mut begin = now();
        let mut lost_at = None;
        let mut charging = None;
        let wanted = self.experiment.cool_down;
        loop {
            if interrupt::requested() {
                return Err(DeviceError::Interrupted);
            }
            let waited = now() - begin;
            let asked = phone::stop(self.device).and_then(|()| phone::battery(self.device));
            let battery = match asked {
                Ok(battery) => battery,
                Err(error) if error.is_lost() => {
                    let lost_at = *lost_at.get_or_insert(now());
                    if now() - lost_at > LOST_TIMEOUT_S {
                        return Err(error);
                    }
                    self.bar.set_message("lost: connect it again");
                    self.device.reconnect();
                    sleep(COOLING);
                    continue;
                }
                Err(error) => return Err(error),
            };
            lost_at = None;
            if self.experiment.power && self.must_charge(&battery, &mut charging)? {
                // Charging warms the battery, so the time to cool down starts when charging ends.
                begin = now();
                sleep(COOLING);
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
            sleep(COOLING);
        }
    }

    /// True while the experiment waits for somebody to plug in or unplug the charger. `charging` is `None` when it does
    /// not wait, otherwise whether a charger has been plugged in during this wait. Unplugging it before the battery has
    /// reached `charge_level` continues the experiment if the level is at least `min_level`.
    fn must_charge(&self, battery: &Battery, charging: &mut Option<bool>) -> Result<bool, DeviceError> {
        let Experiment { min_level, charge_level, .. } = *self.experiment;
        let Some(level) = battery.level_percent else { return Ok(false) };
        let (is_low, plugged) = (level < min_level, battery.plugged());
        if let Some(was_plugged) = charging {
            *was_plugged |= plugged;
            if !plugged && (level >= charge_level || *was_plugged && !is_low) {
                *charging = None;
                return Ok(false);
            }
        } else if !is_low && !plugged {
            return Ok(false);
        }
        let what = if level < charge_level && (is_low || charging.is_some()) {
            format!("charge it to {charge_level:.0} %, then take the charger off")
        } else {
            "take the charger off".into()
        };
        if charging.is_none() {
            *charging = Some(plugged);
            self.bar.suspend(|| {
                log::warn!(
                    "{}: the battery has {level:.0} %: {what}, and the plan goes on",
                    self.device.serial
                )
            });
        }
        self.bar.set_message(format!("{level:.0} %: {what}"));
        Ok(true)
    }

    /// Writes a capture for a run that was skipped because the device is too warm.
    fn leave_out(
        &self,
        plan: &Plan,
        folder: &Path,
        celsius: f64,
        wanted: f64,
    ) -> Result<RunInfo, DeviceError> {
        let reason = format!("the battery had {celsius:.1} C and did not cool down to {wanted:.1} C in time");
        let fault = Fault { kind: FaultKind::TooWarm, at_s: Some(0.0), detail: reason.clone() };
        let mut info = plan.info(self.found, now(), Some(celsius));
        info.faults.push(fault);
        Ok(Writer::create(folder, info)?.finish(Outcome::Failed { reason })?)
    }
}

/// True if the folder holds this run and the run is complete.
fn is_complete(folder: &Path, plan: &Plan) -> Result<bool, DeviceError> {
    if !folder.join(RUN_FILE).exists() {
        return Ok(false);
    }
    let info = match capture::read_info(folder) {
        Ok(info) => info,
        // The file was damaged while it was written. Treat the run as interrupted.
        Err(DataError::Damaged(_)) => return Ok(false),
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
    let failed = |source| DataError::File(FileError::Write { path: folder.into(), source });
    Ok(fs::rename(folder, &free).map_err(failed)?)
}
