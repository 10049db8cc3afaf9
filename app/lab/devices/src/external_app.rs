//! Measures other applications on Meta headsets. The runtime logs their frame rates; this computer reads the battery,
//! which nothing on the device logs.

use super::adb::{Device, DeviceError, now};
use super::capture::Sample;
use super::log::{self, Kind, VRAPI_TAG};
use super::phone::{self, Battery};
use super::reading::Reading;
use yoro_settings::telemetry::{CurrentNormalizer, Line};

/// Interval in seconds at which the battery is read. Each query costs the device some power.
const BATTERY_PERIOD_S: f64 = 2.0;
/// Interval in seconds at which the application's processes are looked up while other processes write to the log.
const PROCESSES_PERIOD_S: f64 = 2.0;

/// The application that is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// The application's package.
    pub package: String,
    /// The process that logs for the application, usually named like the package.
    pub process: String,
}

/// Finds the log lines of another application, and adds the battery's values.
pub(crate) struct ExternalApp<'a> {
    device: &'a Device,
    subject: Subject,
    processes: Vec<u32>,
    /// Time of the last look-up.
    processes_s: f64,
    battery: Battery,
    battery_s: f64,
    normalizer: CurrentNormalizer,
}

impl<'a> ExternalApp<'a> {
    /// Starts to follow an application.
    pub fn new(device: &'a Device, subject: Subject) -> Result<ExternalApp<'a>, DeviceError> {
        Ok(ExternalApp {
            device,
            subject,
            processes: Vec::new(),
            processes_s: f64::NEG_INFINITY,
            battery: phone::battery_now(device)?,
            battery_s: now(),
            normalizer: CurrentNormalizer::default(),
        })
    }

    /// True if a line is for [`Reading`]: a line of the runtime about this application, or a damaged line.
    pub fn accepts(&mut self, line: &str) -> Result<bool, DeviceError> {
        let entry = match log::parse(line) {
            Kind::Entry(entry) => entry,
            Kind::Mark | Kind::Damaged => return Ok(true),
        };
        let Some(pid) = entry.pid.filter(|_| entry.tag == VRAPI_TAG) else { return Ok(false) };
        let now = now();
        if !self.processes.contains(&pid) && now - self.processes_s >= PROCESSES_PERIOD_S {
            self.processes_s = now;
            // Lines of a device that is already gone may still arrive.
            self.processes = unless_lost(phone::processes(self.device, &self.subject.process))?
                .unwrap_or(std::mem::take(&mut self.processes));
        }
        Ok(self.processes.contains(&pid))
    }

    /// Adds the battery's values to a sample, and records their faults in `reading`.
    pub fn complete(&mut self, sample: &mut Sample, reading: &mut Reading) -> Result<(), DeviceError> {
        let battery = self.battery;
        let plugged = if battery.plugged() { battery.sources.max(1) } else { 0 };
        let current_ma =
            battery.current_raw.and_then(|raw| self.normalizer.add(raw, battery.status, Some(plugged)));
        let line = Line {
            current_raw: battery.current_raw,
            current_ma,
            voltage_mv: battery.voltage_mv.map(|voltage| voltage as i32),
            plugged: Some(plugged),
            status: battery.status,
            ..Line::default()
        };
        reading.count_anomalies(&line, sample.time_s);
        sample.current_raw = battery.current_raw;
        sample.current_ma = current_ma;
        sample.voltage_mv = battery.voltage_mv.filter(|voltage| *voltage >= phone::LEAST_MILLIVOLTS);
        sample.level_percent = battery.level_percent;
        sample.charge_uah = battery.charge_uah;
        sample.plugged = Some(plugged);
        sample.battery_celsius = battery.celsius.or(sample.battery_celsius);
        let now = now();
        if now - self.battery_s >= BATTERY_PERIOD_S {
            self.battery_s = now;
            let asked = phone::battery_now(self.device);
            self.battery = unless_lost(asked)?.unwrap_or(battery);
        }
        Ok(())
    }
}

/// Returns `None` if the device is gone, which its log reports as well.
fn unless_lost<T>(said: Result<T, DeviceError>) -> Result<Option<T>, DeviceError> {
    match said {
        Ok(value) => Ok(Some(value)),
        Err(error) if error.is_lost() => Ok(None),
        Err(error) => Err(error),
    }
}
