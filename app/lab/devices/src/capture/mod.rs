//! Captures: the record of one run on a device, a folder with `run.json`, `log.txt` and `samples.csv`.
//!
//! - `run.json` is a [`RunInfo`].
//! - `log.txt` holds the lines of logcat as they came.
//! - `samples.csv` has one [`Sample`] per row. Its columns have the names that the OVR Metrics Tool uses, if that tool
//!   has the quantity in a documented unit. A cell is empty if the device does not give the value.
//!
//! During a run, `log.txt` and `samples.csv` grow line by line. `run.json` is replaced after each change; until the run
//! ends it describes the run as interrupted.

mod sample;
#[cfg(test)]
pub(crate) mod tests;
mod writer;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::DataError;
use crate::table::csv_mistake;
use yoro_files as files;

pub use sample::Sample;
pub use writer::Writer;

/// Version of the folder's format.
pub const VERSION: u32 = 1;
/// The file that describes the run and its outcome.
pub const RUN_FILE: &str = "run.json";
/// The file with the lines of logcat.
pub const LOG_FILE: &str = "log.txt";
/// The file with the samples.
pub const SAMPLES_FILE: &str = "samples.csv";

/// The device of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceInfo {
    /// Serial number, or adb's name of the device if it has none.
    pub serial: String,
    /// Manufacturer.
    pub manufacturer: String,
    /// Model.
    pub model: String,
    /// Android's version, such as `14`.
    pub android: String,
    /// Nominal capacity of the battery in milliampere-hours, if the device reports it.
    pub capacity_mah: Option<f64>,
    /// True if the log says that it comes from a simulated device. All of its results are marked as simulated.
    pub simulated: bool,
}

/// The outcome of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "state")]
pub enum Outcome {
    /// The run lasted for its planned time.
    Complete,
    /// The run has not ended, or was cut short by Ctrl-C or by a device that did not come back.
    Interrupted {
        /// The reason in one sentence.
        reason: String,
    },
    /// The run could not be made, or its results are useless.
    Failed {
        /// The reason in one sentence.
        reason: String,
    },
}

/// The kinds of faults that do not end a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// The device was lost and found again.
    Disconnected,
    /// A charger was plugged in, so the battery's current is not the device's.
    PluggedIn,
    /// The device does not give the battery's current.
    NoCurrent,
    /// The device gives the current in milliamperes instead of microamperes. The figures are corrected.
    CurrentInMilliamperes,
    /// The device gives a positive current while discharging. The figures are corrected.
    CurrentSign,
    /// The device's clock jumped.
    ClockJump,
    /// Lines of the log were cut or damaged.
    DamagedLines,
    /// Lines, one of which is expected each second, are missing.
    MissingLines,
    /// The device was restarted.
    Rebooted,
    /// The application ended, or crashed, and was started again.
    Restarted,
    /// The device throttled, or was too warm when the run began.
    TooWarm,
    /// The device gives the voltage in whole volts.
    VoltageInVolts,
    /// The device refused to hold a value fixed.
    NotPinned,
    /// The display did not keep the requested refresh rate.
    RefreshRate,
    /// The device's pictures differ from the stored ones, or its driver cannot make them.
    Pictures,
}

impl FaultKind {
    /// Returns the name in tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            FaultKind::Disconnected => "disconnected",
            FaultKind::PluggedIn => "plugged in",
            FaultKind::NoCurrent => "no current",
            FaultKind::CurrentInMilliamperes => "current in mA",
            FaultKind::CurrentSign => "sign of the current",
            FaultKind::ClockJump => "clock jump",
            FaultKind::DamagedLines => "damaged lines",
            FaultKind::MissingLines => "missing lines",
            FaultKind::Rebooted => "rebooted",
            FaultKind::Restarted => "application restarted",
            FaultKind::TooWarm => "too warm",
            FaultKind::VoltageInVolts => "voltage in V",
            FaultKind::NotPinned => "not pinned",
            FaultKind::RefreshRate => "refresh rate",
            FaultKind::Pictures => "pictures",
        }
    }
}

/// Something that went wrong in a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// What went wrong.
    pub kind: FaultKind,
    /// Time in seconds since the run began; `None` for a fault of the whole run.
    pub at_s: Option<f64>,
    /// One sentence with the figures.
    pub detail: String,
}

/// A description of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunInfo {
    /// [`VERSION`] of the format.
    pub version: u32,
    /// The device.
    pub device: DeviceInfo,
    /// The experiment that the run belongs to.
    pub experiment: Option<String>,
    /// The method's name in tables: a stereo method, or the experiment's name for its settings.
    pub method: String,
    /// Scene.
    pub scene: String,
    /// Number of the repetition, from 1. Runs with the same number, scene and device are paired.
    pub repetition: u32,
    /// Place in the order of the experiment, from 1.
    pub order: u32,
    /// Viewer settings that differ from the defaults.
    pub settings: BTreeMap<String, String>,
    /// Start in seconds since 1970 by this computer's clock.
    pub started_unix_s: f64,
    /// Planned length in seconds, without the warm-up.
    pub duration_s: f64,
    /// Length of the warm-up in seconds. Its samples are discarded.
    pub warm_up_s: f64,
    /// Temperature of the battery at the start in degrees Celsius.
    pub start_celsius: Option<f64>,
    /// Version of the application.
    pub application: Option<String>,
    /// The outcome.
    pub outcome: Outcome,
    /// The faults that occurred.
    pub faults: Vec<Fault>,
}

/// A capture that was read from its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Capture {
    /// Description of the run.
    pub info: RunInfo,
    /// The samples of all seconds in order of time, warm-up included.
    pub samples: Vec<Sample>,
}

/// Reads the run in `folder`. Ignores a last row that is incomplete.
pub fn read(folder: &Path) -> Result<Capture, DataError> {
    let info = read_info(folder)?;
    let path = folder.join(SAMPLES_FILE);
    let bytes = files::read(&path)?;
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let mut samples = Vec::new();
    if whole > 0 {
        let mut table = csv::Reader::from_reader(&bytes[..whole]);
        let damaged = |(line, what): (u64, String)| damaged(&path, &format!("line {line}: {what}"));
        let header = table.headers().map_err(|error| damaged(csv_mistake(&error)))?.clone();
        for row in table.records() {
            let row = row.map_err(|error| damaged(csv_mistake(&error)))?;
            let line = row.position().map_or(0, csv::Position::line);
            samples.push(Sample::read(&header, &row).map_err(|what| damaged((line, what)))?);
        }
    }
    Ok(Capture { info, samples })
}

/// Reads the description of the run in `folder`.
pub fn read_info(folder: &Path) -> Result<RunInfo, DataError> {
    let path = folder.join(RUN_FILE);
    if folder.is_dir() && !path.exists() {
        return Err(DataError::Unusable(format!(
            "{} is no capture (it has no {RUN_FILE}): name a folder that yoro device has written",
            folder.display()
        )));
    }
    let bytes = files::read(&path)?;
    let damaged = |error: serde_json::Error| damaged(&path, &error.to_string());
    let value: serde_json::Value = serde_json::from_slice(&bytes).map_err(damaged)?;
    match value.get("version").and_then(serde_json::Value::as_u64) {
        Some(version) if version != u64::from(VERSION) => Err(DataError::Unusable(format!(
            "{} has version {version} of the capture format and this yoro reads version {VERSION}: use the yoro that wrote it",
            path.display()
        ))),
        _ => serde_json::from_value(value).map_err(damaged),
    }
}

fn damaged(path: &Path, what: &str) -> DataError {
    DataError::Damaged(format!(
        "{} is damaged ({what}): leave the run out, or measure it again",
        path.display()
    ))
}

/// Returns the folders of all runs in and below `folders`, sorted and without duplicates. Does not follow links.
///
/// # Errors
/// [`DataError`], also if a folder does not exist or no run was found.
pub fn find(folders: &[PathBuf]) -> Result<Vec<PathBuf>, DataError> {
    let mut found = Vec::new();
    for folder in folders {
        for file in files::find(folder, &["json"])? {
            if file.file_name().is_some_and(|name| name == RUN_FILE) {
                found.push(folder.join(file.parent().unwrap_or(Path::new(""))));
            }
        }
    }
    found.sort();
    found.dedup();
    if found.is_empty() {
        let names: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
        let what =
            format!("there is no capture in {}: name folders that yoro device has written", names.join(", "));
        return Err(DataError::Unusable(what));
    }
    Ok(found)
}
