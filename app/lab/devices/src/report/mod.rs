//! Reports on captures: power, frame rate, temperature and others by method and scene, compared with a baseline.
//!
//! The seconds of a run are not independent, so intervals are computed from repetitions, and each run counts as one
//! value. Two methods are compared by pairs of runs of the same device, scene and repetition. A change in percent is
//! the geometric mean of the pairs' ratios; its interval is Student's t on their logarithms. For the mean over scenes,
//! the scenes are fixed blocks, and the scatter of the repetitions around them is pooled. If every scene was measured
//! only once, the interval is computed from the scatter of the scenes and is marked. A single pair has no interval.

mod compare;
mod page;
mod run;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::capture::{Capture, DeviceInfo};
use compare::{Difference, Mean};
use run::{Quantity, Run};
use yoro_report::ReportFiles;
use yoro_report::stats::unique;
use yoro_scenes::BUILTINS;

/// A device that was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Device {
    /// Name in tables. Ends in `(simulated)` for a simulated device.
    name: String,
    #[serde(flatten)]
    info: DeviceInfo,
    /// Number of battery cells, if the device reports the current of one cell; otherwise 1.
    cells: u32,
    applications: BTreeSet<String>,
    scenes: Vec<String>,
    /// Methods in the order of tables: the baseline, then this project's.
    methods: Vec<String>,
}

/// Something that readers of the figures must know.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Note {
    pub(crate) name: &'static str,
    /// The run or other subject that it is about.
    of: String,
    detail: String,
}

/// The figures of several captures.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceReport {
    /// True if any of the runs was simulated rather than measured.
    simulated: bool,
    /// The method that the others are compared with.
    baseline: String,
    confidence: f64,
    /// Program, version and command that made the report.
    made_by: String,
    devices: Vec<Device>,
    differences: Vec<Difference>,
    means: Vec<Mean>,
    /// Excluded runs, with the reasons.
    pub(crate) left_out: Vec<Note>,
    /// Faults that did not exclude a run.
    faults: Vec<Note>,
    runs: Vec<Run>,
}

impl DeviceReport {
    /// Combines the runs of several folders, each with its path. A run that is given twice counts once; the same
    /// repetition in another folder counts as a further one. `cells` gives the number of battery cells, by serial
    /// number, of devices that report the current of a single cell.
    pub fn new(
        sets: &[Vec<(PathBuf, Capture)>],
        baseline: &str,
        cells: &BTreeMap<String, u32>,
        made_by: String,
    ) -> DeviceReport {
        let all = unique(sets.iter().flatten().map(|(_, capture)| &capture.info.device));
        let mut runs: Vec<Run> = Vec::new();
        for (set, captures) in sets.iter().enumerate() {
            for (folder, capture) in captures {
                if runs.iter().all(|known| known.info != capture.info) {
                    let device = &capture.info.device;
                    let cells = cells.get(&device.serial).copied().unwrap_or(1);
                    let folder = folder.display().to_string();
                    runs.push(Run::of(capture, folder, set, device_name(device, &all), cells));
                }
            }
        }
        leave_out_repeated(&mut runs);
        let devices = devices(&runs, baseline);
        DeviceReport {
            simulated: devices.iter().any(|device| device.info.simulated),
            baseline: baseline.into(),
            confidence: 0.95,
            made_by,
            left_out: joined(left_out(&runs, &devices, baseline)),
            faults: joined(faults(&runs, &devices)),
            differences: devices.iter().flat_map(|d| compare::differences(&runs, d, baseline)).collect(),
            means: devices.iter().flat_map(|device| compare::means(&runs, device)).collect(),
            devices,
            runs,
        }
    }

    /// Writes `report.html`, `report.md` and `report.json` into `folder`.
    ///
    /// # Errors
    /// One sentence. All three are made before the first one is written.
    pub fn write(&self, folder: &Path) -> anyhow::Result<ReportFiles> {
        self.report().write(folder, "report", Some(&serde_json::to_string_pretty(self)?))
    }
}

impl Device {
    fn runs<'a>(&'a self, runs: &'a [Run]) -> impl Iterator<Item = &'a Run> {
        runs.iter().filter(|run| run.device_name == self.name)
    }
}

/// Returns a device's name in tables: manufacturer and model, with the serial number if another one shares them.
fn device_name(device: &DeviceInfo, all: &[&DeviceInfo]) -> String {
    let plain = |device: &DeviceInfo| {
        let (maker, model) = (device.manufacturer.trim(), device.model.trim());
        let has_maker = model.to_lowercase().starts_with(&maker.to_lowercase());
        let name = if has_maker { model.to_owned() } else { format!("{maker} {model}").trim().to_owned() };
        if name.is_empty() { device.serial.clone() } else { name }
    };
    let is_other =
        |other: &DeviceInfo| (&other.serial, other.simulated) != (&device.serial, device.simulated);
    let shares = all.iter().any(|other| is_other(other) && plain(other) == plain(device));
    let serial = if shares { format!(" {}", device.serial) } else { String::new() };
    format!("{}{serial}{}", plain(device), if device.simulated { " (simulated)" } else { "" })
}

fn devices(runs: &[Run], baseline: &str) -> Vec<Device> {
    let mut devices: Vec<Device> = Vec::new();
    for Run { device_name, info, cells, .. } in runs {
        let at = devices.iter().position(|device| device.name == *device_name).unwrap_or_else(|| {
            let (name, info, applications) = (device_name.clone(), info.device.clone(), BTreeSet::new());
            devices.push(Device { name, info, cells: *cells, applications, scenes: vec![], methods: vec![] });
            devices.len() - 1
        });
        let device = &mut devices[at];
        device.applications.extend(info.application.clone());
        device.scenes.push(info.scene.clone());
        device.methods.push(info.method.clone());
    }
    for device in &mut devices {
        let place =
            |scene: &str| BUILTINS.iter().position(|builtin| builtin.name == scene).unwrap_or(BUILTINS.len());
        device.scenes.sort_by_key(|scene| (place(scene), scene.clone()));
        device.scenes.dedup();
        let rank = |method: &str| (method != baseline, !method.starts_with("yoro"));
        device.methods.sort_by_key(|method| (rank(method), method.clone()));
        device.methods.dedup();
    }
    devices.sort_by(|a, b| (a.info.simulated, &a.name).cmp(&(b.info.simulated, &b.name)));
    devices
}

/// Excludes all but the last run of a repetition that was made more than once.
fn leave_out_repeated(runs: &mut [Run]) {
    let counting = || runs.iter().filter(|run| run.counts(Quantity::Fps));
    let is_repeated = |run: &Run| {
        let same = |other: &&Run| {
            let of = |run: &Run| (run.device_name.clone(), run.info.method.clone());
            compare::key(other) == compare::key(run) && of(other) == of(run)
        };
        counting().filter(same).any(|other| other.info.started_unix_s > run.info.started_unix_s)
    };
    let repeated: Vec<bool> = runs.iter().map(|run| run.counts(Quantity::Fps) && is_repeated(run)).collect();
    for (run, _) in runs.iter_mut().zip(repeated).filter(|(_, repeated)| *repeated) {
        run.leave_out("measured again", "a later run of the same repetition counts".into());
    }
}

fn left_out(runs: &[Run], devices: &[Device], baseline: &str) -> Vec<Note> {
    let mut notes = Vec::new();
    for run in runs {
        for exclusion in &run.exclusions {
            let what = if exclusion.power_only { "its power" } else { "the run" };
            let detail = format!("{what} does not count: {}", exclusion.reason);
            notes.push(Note { name: exclusion.name, of: run.name(), detail });
        }
    }
    let detail = format!("no run of {baseline} that counts is there to compare it with; its own means count");
    for run in devices.iter().flat_map(|device| compare::without_partner(runs, device, baseline)) {
        notes.push(Note { name: "no partner", of: run.name(), detail: detail.clone() });
    }
    notes
}

/// Returns the notes with one for all those that say the same.
fn joined(notes: Vec<Note>) -> Vec<Note> {
    let one = |(name, detail): (&'static str, &String)| {
        let same = notes.iter().filter(|note| note.name == name && note.detail == *detail);
        let of: Vec<&str> = same.map(|note| note.of.as_str()).collect();
        let shown = of[..of.len().min(3)].join("; ");
        let more = of.len() - of.len().min(3);
        let of = if more > 0 { format!("{shown} and {} more", page::count(more, "run")) } else { shown };
        Note { name, of, detail: detail.clone() }
    };
    unique(notes.iter().map(|note| (note.name, &note.detail))).into_iter().map(one).collect()
}

fn faults(runs: &[Run], devices: &[Device]) -> Vec<Note> {
    let mut notes = Vec::new();
    for run in runs {
        let mut note = |name, detail| notes.push(Note { name, of: run.name(), detail });
        for fault in &run.info.faults {
            let at = fault.at_s.map(|at| format!(" (at {at:.0} s)")).unwrap_or_default();
            note(fault.kind.name(), format!("{}{at}", fault.detail));
        }
        if run.gaps > 0 {
            let gaps = page::count(run.gaps, "gap");
            note("gaps", format!("{gaps} in the samples, not bridged: {:.0} s count", run.covered_s));
        }
        // Charging, up to 0, is excluded elsewhere.
        let milliwatts = run.integrated.map_or(0.0, |integrated| integrated.milliwatts);
        if milliwatts > 0.0 && !(100.0..=30_000.0).contains(&milliwatts) {
            let detail = format!(
                "a mean power of {milliwatts:.1} mW is implausible (below 100 mW or above 30 W): the unit of the battery's \
                 current or voltage is another one"
            );
            note("implausible power", detail);
        }
        if !run.counts(Quantity::Power) {
            continue;
        }
        if run.counted.is_some_and(|counted| counted.scale >= run::MILLI) {
            note("counter in mAh", "the charge counter is in mAh in place of uAh; corrected".into());
        }
        if let Some(by) = run.twice_by() {
            let detail = format!(
                "{by} says about twice what current x voltage says: if the battery has two cells and the device gives \
                 the current of one, give the report their number"
            );
            note("two cells?", detail);
        } else if let Some(counted) = run.counted.filter(|c| c.disagreement().abs() > run::COUNTER_TOLERANCE)
        {
            let detail = format!(
                "over {:.0} s the charge counter says {:.0} mW, current x voltage {:.0} mW ({:+.0} %): one of the \
                 device's gauges is wrong",
                counted.seconds,
                counted.milliwatts,
                counted.integrated_milliwatts,
                100.0 * counted.disagreement()
            );
            note("counter disagrees", detail);
        }
    }
    for (device, method) in devices.iter().flat_map(|d| d.methods.iter().map(move |method| (d, method))) {
        let of = device.runs(runs).filter(|run| run.info.method == *method);
        let settings: BTreeSet<String> = of.map(settings).collect();
        if settings.len() > 1 {
            let settings = settings.into_iter().collect::<Vec<_>>().join("; ");
            let detail = format!("runs under one name had different settings: {settings}");
            notes.push(Note { name: "settings differ", of: format!("{}, {method}", device.name), detail });
        }
    }
    notes
}

fn settings(run: &Run) -> String {
    let other = run.info.settings.iter().filter(|(key, _)| *key != "scene");
    let text = other.map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(" ");
    if text.is_empty() { "defaults".into() } else { text }
}
