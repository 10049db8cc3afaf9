//! The samples of a run, and the columns of `samples.csv`.

use std::collections::BTreeMap;

use crate::table::csv_text;
use yoro_settings::telemetry::{LINE_KEYS, Line};

/// One second of a run. A value is `None` if the device does not give it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// Seconds since the run began, without jumps. Taken from the device's monotonic clock if the log has it.
    pub time_s: f64,
    /// Frames per second.
    pub fps: Option<f64>,
    /// Refresh rate of the display in Hz.
    pub refresh_hz: Option<f64>,
    /// Refreshes in this second that repeated an old frame.
    pub stale: Option<f64>,
    /// Mean time between frames in milliseconds.
    pub frame_ms: Option<f64>,
    /// 99th percentile of the times between frames in milliseconds.
    pub p99_ms: Option<f64>,
    /// GPU time per frame in milliseconds.
    pub gpu_ms: Option<f64>,
    /// CPU load of the process in percent of one core.
    pub cpu_percent: Option<f64>,
    /// Resident memory in MB (10^6 bytes).
    pub rss_mb: Option<f64>,
    /// Battery current as the device reported it.
    pub current_raw: Option<i64>,
    /// Battery current in milliamperes, negative while discharging.
    pub current_ma: Option<f64>,
    /// Battery voltage in millivolts.
    pub voltage_mv: Option<f64>,
    /// Battery level in percent.
    pub level_percent: Option<f64>,
    /// Remaining charge in microampere-hours.
    pub charge_uah: Option<f64>,
    /// Sum of the connected power sources as in Android's `EXTRA_PLUGGED`, 0 if there are none.
    pub plugged: Option<i32>,
    /// Battery temperature in degrees Celsius.
    pub battery_celsius: Option<f64>,
    /// Skin temperature in degrees Celsius.
    pub skin_celsius: Option<f64>,
    /// Thermal status, 0 to 6.
    pub thermal_status: Option<i32>,
    /// All other values of the log, by key. Keys from the `VrApi` line begin with `VrApi.`.
    pub other: BTreeMap<String, String>,
}

/// A number of a [`Sample`]: its column in `samples.csv`, the factor to that column's unit, and its key in the log
/// line. The OVR Metrics Tool also has columns for voltage and power, but does not document their units.
pub(super) struct Column {
    name: &'static str,
    /// A key of [`LINE_KEYS`].
    pub(super) key: &'static str,
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
pub(super) const COLUMNS: &[Column] = &[
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
    /// Returns the sample of a log line, without [`Sample::other`].
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

    /// True if samples have a field for this key of the log line.
    pub fn has_field(key: &str) -> bool {
        COLUMNS.iter().any(|column| column.key == key)
    }

    /// Returns the header of `samples.csv`, with one more column for each of `others`.
    pub(super) fn header(others: &[String]) -> String {
        row_of(COLUMNS.iter().map(|column| column.name.to_owned()).chain(others.iter().cloned()))
    }

    /// Returns the sample as a row of `samples.csv`. Cells of values that are not finite are empty.
    pub(super) fn row(&self, others: &[String]) -> String {
        let numbers = COLUMNS.iter().map(|column| {
            let value = (column.get)(self).filter(|value| value.is_finite());
            value.map_or(String::new(), |value| number(value * column.scale))
        });
        row_of(numbers.chain(others.iter().map(|key| self.other.get(key).cloned().unwrap_or_default())))
    }

    /// Parses a row of `samples.csv`. The error describes the mistake.
    pub(super) fn read(header: &csv::StringRecord, row: &csv::StringRecord) -> Result<Sample, String> {
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
}

/// Formats a number with up to six decimals and without trailing zeros.
fn number(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Joins cells to one line of CSV. Line breaks inside cells become spaces.
fn row_of(cells: impl Iterator<Item = String>) -> String {
    csv_text([cells.map(|cell| cell.replace(['\n', '\r'], " "))])
}
