//! Reads battery and heat once a second. This has a thread of its own, since some devices take milliseconds to answer,
//! which would cost a frame.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use yoro_settings::telemetry::{BatteryStatus, DeviceState};

use super::thermal::Thermal;
use crate::platform::java::{BatteryProperty, Java};

const PERIOD: Duration = Duration::from_secs(1);

/// The device's state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Battery and heat.
    pub state: DeviceState,
    /// The display's refresh rate in Hz; Android may change it at any time.
    pub refresh_hz: Option<f32>,
}

/// The thread that reads the state, running until this is dropped.
pub struct Device {
    report: Arc<Mutex<Report>>,
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Device {
    /// Starts the thread.
    pub fn watch(java: &Java) -> Device {
        let report = Arc::new(Mutex::new(Report::default()));
        let (stop, stopped) = mpsc::channel();
        let (java, of_thread) = (java.clone(), report.clone());
        let work = move || {
            let mut thermal = Thermal::new();
            loop {
                let answer = ask(&java, &mut thermal);
                *of_thread.lock().unwrap_or_else(PoisonError::into_inner) = answer;
                if stopped.recv_timeout(PERIOD) != Err(RecvTimeoutError::Timeout) {
                    break;
                }
            }
        };
        let thread = thread::Builder::new()
            .name("yoro-device".into())
            .spawn(work)
            .inspect_err(|error| log::error!("no thread for battery and heat ({error}): they are na"))
            .ok();
        Device { report, stop: Some(stop), thread }
    }

    /// Returns the newest report.
    pub fn report(&self) -> Report {
        *self.report.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        self.stop = None;
        if let Some(thread) = self.thread.take() {
            // At worst the thread has panicked, which is in the log.
            let _ = thread.join();
        }
    }
}

fn ask(java: &Java, thermal: &mut Thermal) -> Report {
    let intent = java.battery_intent();
    let level = intent.level.zip(intent.scale).filter(|(_, scale)| *scale > 0);
    let status = java.battery(BatteryProperty::Status).or(intent.status);
    let state = DeviceState {
        current_raw: java.battery(BatteryProperty::CurrentNow).map(i64::from),
        status: status.and_then(BatteryStatus::from_android),
        voltage_mv: intent.voltage.filter(|millivolts| *millivolts > 0),
        level_percent: java
            .battery(BatteryProperty::Capacity)
            .or(level.map(|(level, scale)| (level as i64 * 100 / scale as i64) as i32))
            .filter(|percent| (0..=100).contains(percent)),
        charge_counter_uah: java.battery(BatteryProperty::ChargeCounter).filter(|n| *n > 0).map(i64::from),
        plugged: intent.plugged,
        battery_celsius: intent.temperature.map(|tenths| tenths as f32 * 0.1),
        skin_celsius: thermal.skin_celsius(),
        thermal_status: thermal.status(),
        thermal_headroom: thermal.headroom(),
        performance: None,
    };
    let refresh_hz = java.display_metrics().map(|display| display.refresh_hz).filter(|hz| *hz > 0.0);
    Report { state, refresh_hz }
}
