//! Simulated phones and headsets. They run a script in virtual time, so that ten minutes pass in a moment: a device
//! generates a log from a seed and made-up values, and the script lists the faults.

mod device;
mod script;

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use device::SimulatedDevice;
use script::{Phone, Script};
use yoro_devices::adb::{Adb, Device, DeviceError, Listed, LogEvent, LogStream};

pub use device::WORN;

type Shared = Arc<Mutex<SimulatedDevice>>;

fn lock(device: &Shared) -> MutexGuard<'_, SimulatedDevice> {
    device.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The devices of a script.
pub struct Replay {
    devices: Vec<(String, Shared)>,
}

impl Replay {
    /// Makes the devices of a script in TOML.
    #[track_caller]
    pub fn new(script: &str) -> Replay {
        let script: Script = toml::from_str(script).unwrap_or_else(|error| panic!("{error}: {script}"));
        let device = |phone: Phone| {
            (phone.serial.clone(), Arc::new(Mutex::new(SimulatedDevice::new(phone, script.seed))))
        };
        Replay { devices: script.device.into_iter().map(device).collect() }
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
        let (_, device) = known.unwrap_or_else(|| panic!("the script has no device {serial}"));
        let device = device.clone();
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
        Ok(Box::new(ReplayLog { device: self.device.clone(), at, generation }))
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
}

impl LogStream for ReplayLog {
    fn next(&mut self, wait: Duration) -> LogEvent {
        match lock(&self.device).read_log(&mut self.at, self.generation, wait.as_secs_f64()) {
            Ok(Some(line)) => LogEvent::Line((line + "\n").into()),
            Ok(None) => LogEvent::Quiet,
            Err(()) => LogEvent::Ended,
        }
    }
}
