//! What one run on a device leaves behind: a folder with `run.json`, `log.txt` and `samples.csv`.
//!
//! `run.json` is a [`RunInfo`]; `log.txt` holds the raw lines of logcat as they came; `samples.csv` one [`Sample`] a
//! row, under the column names of the OVR Metrics Tool where that has the quantity in a documented unit. An empty cell
//! is a value that the device does not give. While a run lasts, both grow line by line; `run.json` is replaced as a
//! whole whenever there is news, and says until the end that the run was cut off.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use yoro_files::{self as files, FileError};
use yoro_protocol::telemetry::{LINE_KEYS, Line};

/// Version of the folder's format.
pub const VERSION: u32 = 1;
/// What the run was and how it went.
pub const RUN_FILE: &str = "run.json";
/// The raw lines of logcat.
pub const LOG_FILE: &str = "log.txt";
/// The samples.
pub const SAMPLES_FILE: &str = "samples.csv";

/// Why a capture cannot be read or written: one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CaptureError {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The folder holds no run.
    #[error("{} is no capture (it has no {RUN_FILE}): name a folder that yoro device has written", folder.display())]
    Foreign {
        /// The folder.
        folder: PathBuf,
    },
    /// There is no run in any of the folders.
    #[error("there is no capture in {folders}: name folders that yoro device has written")]
    None {
        /// The folders, with commas.
        folders: String,
    },
    /// A run is there already.
    #[error("{} holds a run already: name another folder", folder.display())]
    Exists {
        /// The folder.
        folder: PathBuf,
    },
    /// Written by another version.
    #[error(
        "{} has version {version} of the capture format and this yoro reads version {VERSION}: use the yoro that wrote it",
        path.display()
    )]
    Version {
        /// Its `run.json`.
        path: PathBuf,
        /// What it says.
        version: u64,
    },
    /// `run.json` is damaged.
    #[error("{} is damaged ({what}): leave the run out, or measure it again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// A row of `samples.csv` is damaged.
    #[error(
        "{}, line {line}: {what}; remove the line, or make the samples anew from the log beside it by yoro device logcat",
        path.display()
    )]
    Row {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: u64,
        /// What is wrong.
        what: String,
    },
}

/// The device that a run was made on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceInfo {
    /// Serial number; what adb calls the device where it does not tell one.
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
    /// The device gives the voltage in whole volts.
    VoltageInVolts,
    /// The power is such that no device has it: one of its factors is wrong.
    ImplausiblePower,
    /// The device did not let a value be held fixed.
    NotPinned,
    /// The display did not have the refresh rate that it was to be held at.
    RefreshRate,
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

/// A number of a [`Sample`]: what `samples.csv` calls it and what it is to be multiplied by for the unit there, and the
/// key of the log line that it comes from. The OVR Metrics Tool has voltage and wattage, too, but does not say in what
/// units.
struct Column {
    name: &'static str,
    /// Of [`LINE_KEYS`].
    key: &'static str,
    scale: f64,
    get: fn(&Sample) -> Option<f64>,
    set: fn(&mut Sample, f64),
}

macro_rules! column {
    ($name:literal, $key:literal, $field:ident) => {
        column!($name, $key, $field, 1.0)
    };
    ($name:literal, $key:literal, $field:ident, $scale:literal) => {
        Column {
            name: $name,
            key: $key,
            scale: $scale,
            get: |s| s.$field,
            set: |s, value| s.$field = Some(value),
        }
    };
    ($name:literal, $key:literal, $field:ident as $integer:ty) => {
        Column {
            name: $name,
            key: $key,
            scale: 1.0,
            get: |s| s.$field.map(|value| value as f64),
            set: |s, value| s.$field = Some(value as $integer),
        }
    };
}

const TIME: &str = "Time Stamp";
const COLUMNS: &[Column] = &[
    Column { name: TIME, key: "t", scale: 1e3, get: |s| Some(s.time_s), set: |s, value| s.time_s = value },
    column!("average_frame_rate", "FPS", fps),
    column!("display_refresh_rate", "FPS/", refresh_hz),
    column!("stale_frame_count", "Stale", stale),
    column!("frame_time_milliseconds", "frame", frame_ms),
    column!("frame_time_p99_milliseconds", "p99", p99_ms),
    column!("app_gpu_time_microseconds", "App", gpu_ms, 1e3),
    column!("app_cpu_percentage_of_one_core", "CPU", cpu_percent),
    column!("app_rss_MB", "RSS", rss_mb),
    column!("battery_current_raw", "mA_raw", current_raw as i64),
    column!("battery_current_now_milliamps", "mA", current_ma),
    column!("battery_voltage_millivolts", "mV", voltage_mv),
    column!("battery_level_percentage", "level", level_percent),
    column!("battery_charge_microampere_hours", "uAh", charge_uah),
    column!("battery_plugged", "plug", plugged as i32),
    column!("battery_temperature_celcius", "Tbat", battery_celsius),
    column!("skin_temperature_celcius", "Tskin", skin_celsius),
    column!("thermal_status", "thermal", thermal_status as i32),
];

impl Sample {
    /// The numbers of a line; what else it says is not in [`Sample::other`] yet.
    pub fn of(line: &Line) -> Sample {
        let mut sample = Sample::default();
        for column in COLUMNS {
            let key = LINE_KEYS.iter().find(|key| key.name == column.key);
            if let Some(value) = key.and_then(|key| key.number(line)) {
                (column.set)(&mut sample, value);
            }
        }
        sample
    }

    /// Whether a key of the line has a field of its own in a sample.
    pub fn has_field(key: &str) -> bool {
        COLUMNS.iter().any(|column| column.key == key)
    }
}

/// A number without needless zeros; microseconds, microvolts and the like are kept.
fn number(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Reads the run in `folder`. A last row that was cut off in writing is left out.
///
/// # Errors
/// [`CaptureError`].
pub fn read(folder: &Path) -> Result<Capture, CaptureError> {
    let info = read_info(folder)?;
    let path = folder.join(SAMPLES_FILE);
    let bytes = files::read(&path)?;
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let mut samples = Vec::new();
    if whole > 0 {
        let mut table = csv::Reader::from_reader(&bytes[..whole]);
        let row_error = |error: csv::Error| {
            let line = error.position().map_or(1, csv::Position::line);
            let what = match error.kind() {
                csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                    format!("{len} cells where the header has {expected_len}")
                }
                csv::ErrorKind::Utf8 { .. } => "this is no text".into(),
                _ => "this is no row of a table".into(),
            };
            CaptureError::Row { path: path.clone(), line, what }
        };
        let header = table.headers().map_err(row_error)?.clone();
        for row in table.records() {
            let row = row.map_err(row_error)?;
            let line = row.position().map_or(0, csv::Position::line);
            let sample = read_row(&header, &row).map_err(|what| CaptureError::Row {
                path: path.clone(),
                line,
                what,
            })?;
            samples.push(sample);
        }
    }
    Ok(Capture { info, samples })
}

/// What the run in `folder` was.
///
/// # Errors
/// [`CaptureError`].
pub fn read_info(folder: &Path) -> Result<RunInfo, CaptureError> {
    let path = folder.join(RUN_FILE);
    if folder.is_dir() && !path.exists() {
        return Err(CaptureError::Foreign { folder: folder.into() });
    }
    let bytes = files::read(&path)?;
    let damaged =
        |error: serde_json::Error| CaptureError::Damaged { path: path.clone(), what: error.to_string() };
    let value: serde_json::Value = serde_json::from_slice(&bytes).map_err(damaged)?;
    match value.get("version").and_then(serde_json::Value::as_u64) {
        Some(version) if version != u64::from(VERSION) => {
            Err(CaptureError::Version { path: path.clone(), version })
        }
        _ => serde_json::from_value(value).map_err(damaged),
    }
}

fn read_row(header: &csv::StringRecord, row: &csv::StringRecord) -> Result<Sample, String> {
    let mut sample = Sample::default();
    let mut has_time = false;
    for (name, cell) in header.iter().zip(row).filter(|(_, cell)| !cell.is_empty()) {
        let Some(column) = COLUMNS.iter().find(|column| column.name == name) else {
            sample.other.insert(name.into(), cell.into());
            continue;
        };
        let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
        let value = value.ok_or_else(|| format!("\"{cell}\" in the column \"{name}\" is no number"))?;
        (column.set)(&mut sample, value / column.scale);
        has_time |= name == TIME;
    }
    if has_time { Ok(sample) } else { Err(format!("there is nothing in the column \"{TIME}\"")) }
}

/// The folders of all runs in `folders` and below, sorted, each once. Links to folders are not followed.
///
/// # Errors
/// [`CaptureError`]: also where a folder does not exist, or there is no run at all.
pub fn find(folders: &[PathBuf]) -> Result<Vec<PathBuf>, CaptureError> {
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
        return Err(CaptureError::None { folders: names.join(", ") });
    }
    Ok(found)
}

/// Reads all runs in `folders` and below, in order of their paths.
///
/// # Errors
/// The first that [`find`] or [`read`] gives.
pub fn read_all(folders: &[PathBuf]) -> Result<Vec<Capture>, CaptureError> {
    find(folders)?.iter().map(|folder| read(folder)).collect()
}

/// Writes a run while it lasts.
#[derive(Debug)]
pub struct Writer {
    folder: PathBuf,
    info: RunInfo,
    log: File,
    samples: File,
    /// Keys of [`Sample::other`] that have a column.
    others: Vec<String>,
}

impl Writer {
    /// Begins a run in a folder, which is made. Until [`Writer::finish`], the run counts as cut off.
    ///
    /// # Errors
    /// [`CaptureError`]: also where the folder holds a run already.
    pub fn create(folder: &Path, mut info: RunInfo) -> Result<Writer, CaptureError> {
        files::create_folder(folder)?;
        if folder.join(RUN_FILE).exists() {
            return Err(CaptureError::Exists { folder: folder.into() });
        }
        info.outcome = Outcome::Interrupted { reason: "the program that captured it was ended".into() };
        let new = |name: &str| {
            let path = folder.join(name);
            File::create(&path).map_err(|source| FileError::Write { path, source })
        };
        let writer = Writer {
            folder: folder.into(),
            info,
            log: new(LOG_FILE)?,
            samples: new(SAMPLES_FILE)?,
            others: Vec::new(),
        };
        writer.append(
            &writer.samples,
            SAMPLES_FILE,
            &writer.row(|column| column.name.into(), String::clone),
        )?;
        writer.renew()?;
        Ok(writer)
    }

    /// What the run is, up to now.
    pub fn info(&self) -> &RunInfo {
        &self.info
    }

    /// Where it lies.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Adds a line of the log.
    ///
    /// # Errors
    /// [`CaptureError::File`].
    pub fn log(&mut self, line: &str) -> Result<(), CaptureError> {
        self.append(&self.log, LOG_FILE, &format!("{line}\n"))
    }

    /// Adds a sample. A key that no sample had before becomes a column of the whole table.
    ///
    /// # Errors
    /// [`CaptureError`].
    pub fn sample(&mut self, sample: &Sample) -> Result<(), CaptureError> {
        let before = self.others.len();
        for key in sample.other.keys() {
            if !self.others.contains(key) {
                self.others.push(key.clone());
            }
        }
        if self.others.len() > before {
            self.widen(before)?;
        }
        let cell = |column: &Column| {
            let value = (column.get)(sample).filter(|value| value.is_finite());
            value.map_or(String::new(), |value| number(value * column.scale))
        };
        let row = self.row(cell, |key| sample.other.get(key).cloned().unwrap_or_default());
        self.append(&self.samples, SAMPLES_FILE, &row)
    }

    /// Notes that something went wrong.
    ///
    /// # Errors
    /// [`CaptureError::File`].
    pub fn fault(&mut self, fault: Fault) -> Result<(), CaptureError> {
        self.info.faults.push(fault);
        self.renew()
    }

    /// Ends the run.
    ///
    /// # Errors
    /// [`CaptureError::File`].
    pub fn finish(mut self, outcome: Outcome) -> Result<RunInfo, CaptureError> {
        self.info.outcome = outcome;
        self.renew()?;
        Ok(self.info)
    }

    /// Changes what the run says of itself.
    ///
    /// # Errors
    /// [`CaptureError::File`].
    pub fn change(&mut self, change: impl FnOnce(&mut RunInfo)) -> Result<(), CaptureError> {
        change(&mut self.info);
        self.renew()
    }

    fn renew(&self) -> Result<(), CaptureError> {
        Ok(files::write_with(&self.folder.join(RUN_FILE), |out| {
            serde_json::to_writer_pretty(&mut *out, &self.info)?;
            out.write_all(b"\n")
        })?)
    }

    /// A row in one piece: a reader never sees half a line.
    fn append(&self, mut file: &File, name: &str, text: &str) -> Result<(), CaptureError> {
        let failed = |source| FileError::Write { path: self.folder.join(name), source };
        Ok(file.write_all(text.as_bytes()).map_err(failed)?)
    }

    fn row(&self, cell: impl Fn(&Column) -> String, other: impl Fn(&String) -> String) -> String {
        let cells = COLUMNS.iter().map(cell).chain(self.others.iter().map(other));
        let mut row = String::new();
        for (i, cell) in cells.enumerate() {
            let comma = if i == 0 { "" } else { "," };
            // What comes from one line of a log has no line breaks; a row must be one line.
            let cell = cell.replace(['\n', '\r'], " ");
            let written = if cell.contains([',', '"']) {
                write!(row, "{comma}\"{}\"", cell.replace('"', "\"\""))
            } else {
                write!(row, "{comma}{cell}")
            };
            written.expect("a string takes everything");
        }
        row + "\n"
    }

    /// Writes the table anew with empty cells in the columns that are new since there were `before` of the others.
    fn widen(&mut self, before: usize) -> Result<(), CaptureError> {
        let path = self.folder.join(SAMPLES_FILE);
        let text = String::from_utf8_lossy(&files::read(&path)?).into_owned();
        let header = self.row(|column| column.name.into(), String::clone);
        let commas = ",".repeat(self.others.len() - before);
        files::write_with(&path, |out| {
            out.write_all(header.as_bytes())?;
            text.lines().skip(1).try_for_each(|row| writeln!(out, "{row}{commas}"))
        })?;
        let open = OpenOptions::new().append(true).open(&path);
        self.samples = open.map_err(|source| FileError::Write { path, source })?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use proptest::prelude::*;

    use super::*;

    fn info() -> RunInfo {
        RunInfo {
            version: VERSION,
            device: DeviceInfo { serial: "S1".into(), simulated: true, ..DeviceInfo::default() },
            experiment: Some("test".into()),
            method: "yoro".into(),
            scene: "prototype".into(),
            repetition: 1,
            order: 1,
            settings: BTreeMap::from([("hud".into(), "false".into())]),
            started_unix_s: 1.7e9,
            duration_s: 60.0,
            warm_up_s: 5.0,
            start_celsius: None,
            application: Some("0.1.0".into()),
            outcome: Outcome::Complete,
            faults: Vec::new(),
        }
    }

    fn others(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
        pairs.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect()
    }

    #[test]
    fn a_run_is_readable_at_any_time() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("a/b");
        let mut writer = Writer::create(&folder, info()).unwrap();
        let none = read(&folder).unwrap();
        assert!(matches!(none.info.outcome, Outcome::Interrupted { .. }) && none.samples.is_empty());
        writer.log("one").unwrap();
        let first = Sample { time_s: 1.0, gpu_ms: Some(4.49), ..Sample::default() };
        writer.sample(&first).unwrap();
        let second = Sample {
            time_s: 2.1,
            current_raw: Some(-512_000),
            plugged: Some(0),
            other: others(&[("App.march", "1.5"), ("VrApi.LCnt", "2(DR72,LM2)"), ("odd", "a \"b\"")]),
            ..Sample::default()
        };
        writer.sample(&second).unwrap();
        let third = Sample { time_s: 3.0, other: others(&[("later", "1")]), ..Sample::default() };
        writer.sample(&third).unwrap();
        let fault = Fault { kind: FaultKind::ClockJump, at_s: Some(2.0), detail: "by an hour".into() };
        writer.fault(fault.clone()).unwrap();
        let cut = read(&folder).unwrap();
        assert_eq!(cut.samples, [first.clone(), second.clone(), third.clone()]);
        assert_eq!(cut.info.faults, [fault]);
        let done = writer.finish(Outcome::Complete).unwrap();
        assert_eq!(read(&folder).unwrap().info, done);
        assert_eq!(fs::read_to_string(folder.join(LOG_FILE)).unwrap(), "one\n");
        assert!(matches!(Writer::create(&folder, info()), Err(CaptureError::Exists { .. })));
        // What was cut off in writing does not count.
        let path = folder.join(SAMPLES_FILE);
        let mut text = fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("Time Stamp,average_frame_rate,display_refresh_rate,stale_frame_count,"));
        text.push_str("4000,72,7");
        fs::write(&path, &text).unwrap();
        assert_eq!(read(&folder).unwrap().samples, [first, second, third]);
        assert_eq!(find(&[dir.path().into(), folder.clone()]).unwrap(), [folder]);
        // What is no number is none for the reader.
        let odd = dir.path().join("odd");
        let mut writer = Writer::create(&odd, info()).unwrap();
        writer
            .sample(&Sample { fps: Some(f64::NAN), stale: Some(f64::INFINITY), ..Sample::default() })
            .unwrap();
        assert_eq!(read(&odd).unwrap().samples, [Sample::default()]);
    }

    /// Column names and cells are read by other programs.
    #[test]
    fn a_row_with_every_column() {
        let line = "v=1,t=12.5s,method=yoro,pipeline=gather,scene=prototype,FPS=59.9/60,Stale=3,frame=16.68ms,p99=17.02ms,App=6.10ms(march=1.250),CPU=41.0%,RSS=212.4MB,mA_raw=-512000,mA=-512.0,mV=3921,level=87%,uAh=2712000,plug=2,Tbat=31.2C,Tskin=33.5C,thermal=1,headroom=0.42,scale=1.00,imbuffer=na,frames=60,status=discharging,run=a";
        let line: Line = line.parse().unwrap();
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("run");
        let mut writer = Writer::create(&folder, info()).unwrap();
        writer.sample(&Sample::of(&line)).unwrap();
        assert_eq!(
            fs::read_to_string(folder.join(SAMPLES_FILE)).unwrap(),
            "Time Stamp,average_frame_rate,display_refresh_rate,stale_frame_count,frame_time_milliseconds,frame_time_p99_milliseconds,app_gpu_time_microseconds,app_cpu_percentage_of_one_core,app_rss_MB,battery_current_raw,battery_current_now_milliamps,battery_voltage_millivolts,battery_level_percentage,battery_charge_microampere_hours,battery_plugged,battery_temperature_celcius,skin_temperature_celcius,thermal_status\n\
             12500,59.9,60,3,16.68,17.02,6100,41,212.4,-512000,-512,3921,87,2712000,2,31.2,33.5,1\n"
        );
        // Each column finds its key.
        assert!(COLUMNS.iter().all(|column| LINE_KEYS.iter().any(|key| key.name == column.key)));
    }

    #[test]
    fn damaged_folders_are_named() {
        let dir = tempfile::tempdir().unwrap();
        let sentence = |folder: &Path| read(folder).unwrap_err().to_string();
        assert!(sentence(dir.path()).contains("is no capture"));
        assert!(sentence(&dir.path().join("none")).contains("does not exist"));
        let error = read_all(&[dir.path().into()]).unwrap_err();
        assert!(matches!(error, CaptureError::None { .. }), "{error}");
        let folder = dir.path().join("run");
        let mut writer = Writer::create(&folder, info()).unwrap();
        writer.sample(&Sample::default()).unwrap();
        let (run, samples) = (folder.join(RUN_FILE), folder.join(SAMPLES_FILE));
        let good = fs::read_to_string(&run).unwrap();
        for (damage, word) in [("{", "damaged"), ("{}", "missing field"), ("{\"version\":9}", "version 9")] {
            fs::write(&run, damage).unwrap();
            assert!(sentence(&folder).contains(word), "{}", sentence(&folder));
        }
        fs::write(&run, good.replace("\"scene\"", "\"scenery\"")).unwrap();
        assert!(sentence(&folder).contains("scenery"));
        fs::write(&run, good).unwrap();
        let table = fs::read_to_string(&samples).unwrap();
        for (row, word) in [
            ("x,1\n", "2 cells"),
            ("abc,,,,,,,,,,,,,,,,,\n", "no number"),
            (",,,,,,,,,,,,,,,,,\n", "Time Stamp"),
        ] {
            fs::write(&samples, format!("{table}{row}")).unwrap();
            assert!(
                sentence(&folder).contains("line 3") && sentence(&folder).contains(word),
                "{}",
                sentence(&folder)
            );
        }
        fs::remove_file(&samples).unwrap();
        assert!(sentence(&folder).contains(SAMPLES_FILE));
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_again(
            numbers in proptest::collection::vec(proptest::option::of(-1_000_000_000i64..1_000_000_000), 10),
            key in "[A-Za-z][A-Za-z./,\" ]{0,8}", value in "[ -~]{1,12}",
        ) {
            let real = |i: usize| numbers[i].map(|n| n as f64 / 1e3);
            let sample = Sample {
                time_s: real(0).unwrap_or(0.0), fps: real(1), stale: real(2), frame_ms: real(3), current_raw: numbers[4],
                current_ma: real(5), charge_uah: numbers[6].map(|n| n as f64), thermal_status: numbers[7].map(|n| n as i32),
                plugged: numbers[8].map(|n| n as i32), skin_celsius: real(9),
                other: others(&[(&key, &value)]), ..Sample::default()
            };
            let dir = tempfile::tempdir().unwrap();
            let folder = dir.path().join("run");
            let mut writer = Writer::create(&folder, info()).unwrap();
            writer.sample(&sample).unwrap();
            prop_assert_eq!(read(&folder).unwrap().samples, [sample]);
        }
    }
}
