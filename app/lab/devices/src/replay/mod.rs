//! Simulated devices, for tests and for people without a phone. They run a script in virtual time, so that ten minutes
//! pass in a moment. All of their results are marked as simulated.
//!
//! A device plays recorded logs, or generates a log from a seed and made-up values. The script lists the faults.

mod device;
mod script;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use device::SimulatedDevice;
pub use script::{Current, Fault, FaultKind, Load, Phone, Script, Voltage};

use super::adb::{Adb, Device, DeviceError, Listed, LogEvent, LogStream};
use super::log::SIMULATED_MARK;

type Shared = Arc<Mutex<SimulatedDevice>>;

fn lock(device: &Shared) -> MutexGuard<'_, SimulatedDevice> {
    device.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The devices of a script.
pub struct Replay {
    path: PathBuf,
    devices: Vec<(String, Shared)>,
}

impl Replay {
    /// Reads a script, or a folder of captures whose logs are replayed.
    pub fn read(path: &Path) -> Result<Replay, DeviceError> {
        Ok(Replay::new(path, Script::read(path)?))
    }

    /// Makes the devices of a script that was read from `path`.
    pub fn new(path: &Path, script: Script) -> Replay {
        let (seed, speed) = (script.seed, script.speed);
        let device = |phone: Phone| {
            let kept = script.state.as_ref().map(|folder| folder.join(format!("{}.json", phone.serial)));
            (phone.serial.clone(), Arc::new(Mutex::new(SimulatedDevice::new(phone, seed, speed, kept))))
        };
        Replay { path: path.into(), devices: script.device.into_iter().map(device).collect() }
    }
}

impl Adb for Replay {
    fn devices(&self) -> Result<Vec<Listed>, DeviceError> {
        let listed = |(serial, device): &(String, Shared)| {
            Some(Listed { serial: serial.clone(), state: lock(device).state()? })
        };
        Ok(self.devices.iter().filter_map(listed).collect())
    }

    fn open(&self, serial: &str) -> Box<dyn Device> {
        let known = self.devices.iter().find(|(known, _)| known == serial);
        let device = known.map_or_else(
            || {
                ::log::debug!("{} has no device {serial}", self.path.display());
                let phone = Phone { serial: serial.into(), state: "offline".into(), ..Phone::default() };
                Arc::new(Mutex::new(SimulatedDevice::new(phone, 0, None, None)))
            },
            |(_, device)| device.clone(),
        );
        Box::new(ReplayDevice { serial: serial.into(), device })
    }
}

struct ReplayDevice {
    serial: String,
    device: Shared,
}

impl Device for ReplayDevice {
    fn serial(&self) -> &str {
        &self.serial
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn shell(&self, words: &[&str]) -> Result<String, DeviceError> {
        lock(&self.device).shell(words)
    }

    fn put(&self, path: &str, text: &str) -> Result<(), DeviceError> {
        lock(&self.device).put(path, text)
    }

    fn install(&self, _apk: &Path) -> Result<(), DeviceError> {
        lock(&self.device).install()
    }

    fn logcat(&self, since: Option<&str>) -> Result<Box<dyn LogStream>, DeviceError> {
        let mut device = lock(&self.device);
        device.reach()?;
        let (at, generation) = device.reader(since);
        Ok(Box::new(ReplayLog { device: self.device.clone(), at, generation, is_new: true }))
    }

    fn is_attended(&self) -> bool {
        lock(&self.device).is_attended()
    }

    fn reconnect(&self) {}

    fn now(&self) -> f64 {
        lock(&self.device).now()
    }

    fn sleep(&self, time: Duration) {
        let mut device = lock(&self.device);
        let to = device.now() + time.as_secs_f64();
        device.advance(to);
    }
}

struct ReplayLog {
    device: Shared,
    at: usize,
    generation: u32,
    is_new: bool,
}

impl LogStream for ReplayLog {
    fn next(&mut self, wait: Duration) -> LogEvent {
        if std::mem::take(&mut self.is_new) {
            return LogEvent::Line(format!("{SIMULATED_MARK} by a replay of yoro\n").into());
        }
        match lock(&self.device).read_log(&mut self.at, self.generation, wait.as_secs_f64()) {
            Ok(Some(line)) => LogEvent::Line((line + "\n").into()),
            Ok(None) => LogEvent::Quiet,
            Err(()) => LogEvent::Ended,
        }
    }
}
