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

use super::capture::Capture;
use compare::{Difference, Mean};
use run::{Integrated, Quantity, Run};
use yoro_report::{CONFIDENCE, ReportError, ReportFiles};
use yoro_scenes::BUILTINS;

/// A device that was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Device {
    /// Name in tables. Ends in `(simulated)` for a simulated device.
    name: String,
    android: String,
    capacity_mah: Option<f64>,
    /// Number of battery cells, if the device reports the current of one cell; otherwise 1.
    cells: u32,
    simulated: bool,
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
        let cells_of = |capture: &Capture| cells.get(&capture.info.device.serial).copied().unwrap_or(1);
        let names = device_names(sets.iter().flatten().map(|(_, capture)| capture));
        let name = |capture: &Capture| names[&device_key(capture)].clone();
        let mut seen = BTreeSet::new();
        let mut runs: Vec<Run> = Vec::new();
        let mut settings: BTreeMap<(String, String), BTreeSet<String>> = BTreeMap::new();
        for (set, captures) in sets.iter().enumerate() {
            for (folder, capture) in captures {
                let info = &capture.info;
                let what = (info.method.clone(), info.scene.clone(), info.repetition);
                let identity = (device_key(capture), info.started_unix_s.to_bits(), what);
                if !seen.insert(identity) {
                    continue;
                }
                let device = name(capture);
                let other = info.settings.iter().filter(|(key, _)| *key != "scene");
                let text = other.map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(" ");
                settings.entry((device.clone(), info.method.clone())).or_default().insert(text);
                runs.push(Run::of(capture, folder.display().to_string(), set, device, cells_of(capture)));
            }
        }
        leave_out_repeated(&mut runs);
        let captures = sets.iter().flatten().map(|(_, capture)| capture);
        let devices = devices(captures, name, cells_of, baseline);

        let means = devices.iter().flat_map(|device| compare::means(&runs, device)).collect();
        let differences =
            devices.iter().flat_map(|device| compare::differences(&runs, device, baseline)).collect();
        let mut report = DeviceReport {
            simulated: devices.iter().any(|device| device.simulated),
            baseline: baseline.into(),
            confidence: CONFIDENCE,
            made_by,
            left_out: joined(left_out(&runs, &devices, baseline)),
            faults: joined(faults(&runs)),
            devices,
            differences,
            means,
            runs,
        };
        for ((device, method), texts) in settings.iter().filter(|(_, texts)| texts.len() > 1) {
            let texts: Vec<&str> = texts.iter().map(|t| if t.is_empty() { "defaults" } else { t }).collect();
            report.faults.push(Note {
                name: "settings differ",
                of: format!("{device}, {method}"),
                detail: format!("runs under one name had different settings: {}", texts.join("; ")),
            });
        }
        report
    }

    /// Writes `report.html`, `report.md` and `report.json` into `folder`.
    ///
    /// # Errors
    /// [`ReportError`]. All three are made before the first one is written.
    pub fn write(&self, folder: &Path) -> Result<ReportFiles, ReportError> {
        self.report().write(folder, "report", Some(&serde_json::to_string_pretty(self)?))
    }
}

/// Returns the key that distinguishes devices: the serial number, and whether the device is simulated.
fn device_key(capture: &Capture) -> (String, bool) {
    (capture.info.device.serial.clone(), capture.info.device.simulated)
}

/// Returns the devices' names in tables: manufacturer and model, with the serial number if two devices share them.
fn device_names<'a>(captures: impl Iterator<Item = &'a Capture>) -> BTreeMap<(String, bool), String> {
    let mut names: BTreeMap<(String, bool), String> = BTreeMap::new();
    for capture in captures {
        let device = &capture.info.device;
        let (maker, model) = (device.manufacturer.trim(), device.model.trim());
        let has_maker = model.to_lowercase().starts_with(&maker.to_lowercase());
        let name = if has_maker { model.to_owned() } else { format!("{maker} {model}").trim().to_owned() };
        let name = if name.is_empty() { device.serial.clone() } else { name };
        names.entry(device_key(capture)).or_insert(name);
    }
    let all: Vec<String> = names.values().cloned().collect();
    for ((serial, simulated), name) in &mut names {
        if all.iter().filter(|other| *other == name).count() > 1 {
            *name = format!("{name} {serial}");
        }
        if *simulated {
            name.push_str(" (simulated)");
        }
    }
    names
}

fn devices<'a>(
    captures: impl Iterator<Item = &'a Capture>,
    name: impl Fn(&Capture) -> String,
    cells: impl Fn(&Capture) -> u32,
    baseline: &str,
) -> Vec<Device> {
    let mut devices: Vec<Device> = Vec::new();
    for capture in captures {
        let (info, name) = (&capture.info, name(capture));
        let at = devices.iter().position(|device| device.name == name).unwrap_or_else(|| {
            devices.push(Device {
                name,
                android: info.device.android.clone(),
                capacity_mah: info.device.capacity_mah,
                cells: cells(capture),
                simulated: info.device.simulated,
                applications: BTreeSet::new(),
                scenes: Vec::new(),
                methods: Vec::new(),
            });
            devices.len() - 1
        });
        let device = &mut devices[at];
        device.applications.extend(info.application.clone());
        if !device.scenes.contains(&info.scene) {
            device.scenes.push(info.scene.clone());
        }
        if !device.methods.contains(&info.method) {
            device.methods.push(info.method.clone());
        }
    }
    for device in &mut devices {
        let place =
            |scene: &str| BUILTINS.iter().position(|builtin| builtin.name == scene).unwrap_or(BUILTINS.len());
        device.scenes.sort_by_key(|scene| (place(scene), scene.clone()));
        let rank = |method: &str| (method != baseline, !method.starts_with("yoro"));
        device.methods.sort_by_key(|method| (rank(method), method.clone()));
    }
    devices.sort_by(|a, b| (a.simulated, &a.name).cmp(&(b.simulated, &b.name)));
    devices
}

/// Excludes all but the last run of a repetition that was made more than once.
fn leave_out_repeated(runs: &mut [Run]) {
    let key = |run: &Run| {
        let place = (run.set, run.experiment.clone(), run.scene.clone(), run.method.clone(), run.repetition);
        (run.device.clone(), place)
    };
    let mut last: BTreeMap<_, f64> = BTreeMap::new();
    for run in runs.iter().filter(|run| run.counts(Quantity::Fps)) {
        let started = last.entry(key(run)).or_insert(run.started_unix_s);
        *started = started.max(run.started_unix_s);
    }
    for run in runs.iter_mut().filter(|run| run.counts(Quantity::Fps)) {
        if last.get(&key(run)).is_some_and(|started| run.started_unix_s < *started) {
            run.leave_out("measured again", "a later run of the same repetition counts".into());
        }
    }
}

fn left_out(runs: &[Run], devices: &[Device], baseline: &str) -> Vec<Note> {
    let mut notes = Vec::new();
    for run in runs {
        for exclusion in &run.exclusions {
            let what =
                if exclusion.power_only { "its power does not count" } else { "the run does not count" };
            let detail = format!("{what}: {}", exclusion.reason);
            notes.push(Note { name: exclusion.name, of: run.name(), detail });
        }
    }
    for device in devices {
        for run in compare::without_partner(runs, device, baseline) {
            let detail =
                format!("no run of {baseline} that counts is there to compare it with; its own means count");
            notes.push(Note { name: "no partner", of: run.name(), detail });
        }
    }
    notes
}

/// Returns the notes with one for all those that say the same.
fn joined(notes: Vec<Note>) -> Vec<Note> {
    let mut all: Vec<(Note, usize)> = Vec::new();
    for note in notes {
        match all.iter_mut().find(|(known, _)| known.name == note.name && known.detail == note.detail) {
            Some((known, count)) => {
                *count += 1;
                if *count <= 3 {
                    known.of = format!("{}; {}", known.of, note.of);
                }
            }
            None => all.push((note, 1)),
        }
    }
    let finish = |(mut note, count): (Note, usize)| {
        if count > 3 {
            note.of = format!("{} and {} more", note.of, page::count(count - 3, "run"));
        }
        note
    };
    all.into_iter().map(finish).collect()
}

fn faults(runs: &[Run]) -> Vec<Note> {
    let mut notes = Vec::new();
    for run in runs {
        for fault in &run.faults {
            let at = fault.at_s.map(|at| format!(" (at {at:.0} s)")).unwrap_or_default();
            let detail = format!("{}{at}", fault.detail);
            notes.push(Note { name: fault.kind.name(), of: run.name(), detail });
        }
        if run.gaps > 0 {
            let gaps = page::count(run.gaps, "gap");
            let detail = format!("{gaps} in the samples, not bridged: {:.0} s count", run.covered_s);
            notes.push(Note { name: "gaps", of: run.name(), detail });
        }
        let mut note = |name, detail| notes.push(Note { name, of: run.name(), detail });
        if let Some(found) = run.integrated.filter(Integrated::is_implausible) {
            let detail = format!(
                "a mean power of {:.1} mW is implausible (below 100 mW or above 30 W): the unit of the battery's current \
                 or voltage is another one",
                found.milliwatts
            );
            note("implausible power", detail);
        }
        let counted = run.counted.filter(|_| run.counts(Quantity::Power));
        if counted.is_some_and(|counted| counted.scale >= run::MILLI) {
            note("counter in mAh", "the charge counter is in mAh in place of uAh; corrected".into());
        }
        if let Some(by) = run.twice_by().filter(|_| run.counts(Quantity::Power)) {
            let detail = format!(
                "{by} says about twice what current x voltage says: if the battery has two cells and the device gives \
                 the current of one, give the report their number"
            );
            note("two cells?", detail);
        } else if let Some(counted) = counted.filter(|c| c.disagreement().abs() > run::COUNTER_TOLERANCE) {
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
    notes
}
