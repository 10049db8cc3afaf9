//! The device's heat: the NDK's thermal service, and the skin temperature sensor if it is readable.

use std::ffi::c_int;
use std::fs;
use std::path::{Path, PathBuf};
use std::ptr::NonNull;
use std::time::{Duration, Instant};

use crate::platform::system::Library;

/// Time between queries of the headroom. The forecast changes slowly, and Android answers frequent queries with NaN.
const HEADROOM_PERIOD: Duration = Duration::from_secs(10);
/// Time until the next query after an answer of NaN.
const HEADROOM_RETRY: Duration = Duration::from_secs(2);
/// The headroom's forecast horizon, in seconds.
const FORECAST_SECONDS: c_int = 10;
/// The plausible skin temperatures in degrees Celsius. Values beyond are in another unit or come from a broken sensor.
const PLAUSIBLE: std::ops::Range<f32> = -40.0..150.0;

/// Opaque `AThermalManager`.
#[repr(C)]
struct Manager {
    _private: [u8; 0],
}

type Acquire = unsafe extern "C" fn() -> *mut Manager;
type Release = unsafe extern "C" fn(*mut Manager);
type Status = unsafe extern "C" fn(*mut Manager) -> c_int;
type Headroom = unsafe extern "C" fn(*mut Manager, c_int) -> f32;

/// The thermal service, from API 30 on.
struct Service {
    manager: NonNull<Manager>,
    release: Release,
    status: Status,
    /// Present from API 31 on.
    headroom: Option<Headroom>,
}

/// The sources of the device's heat.
pub struct Thermal {
    service: Option<Service>,
    skin: Option<PathBuf>,
    headroom: Option<(Instant, Option<f32>)>,
}

impl Thermal {
    /// Looks for the sources that this device has.
    pub fn new() -> Thermal {
        Thermal { service: Service::acquire(), skin: skin_sensor(), headroom: None }
    }

    /// Returns the `AThermalStatus`, 0 to 6.
    pub fn status(&self) -> Option<i32> {
        let service = self.service.as_ref()?;
        // SAFETY: the manager is live.
        Some(unsafe { (service.status)(service.manager.as_ptr()) }).filter(|status| *status >= 0)
    }

    /// Returns the forecast headroom; 1 is severe throttling. It may be ten seconds old.
    pub fn headroom(&mut self) -> Option<f32> {
        let service = self.service.as_ref()?;
        let ask = service.headroom?;
        match self.headroom {
            Some((then, value)) if then.elapsed() < value.map_or(HEADROOM_RETRY, |_| HEADROOM_PERIOD) => {
                value
            }
            _ => {
                // SAFETY: the manager is live.
                let value = unsafe { ask(service.manager.as_ptr(), FORECAST_SECONDS) };
                let value = Some(value).filter(|value| value.is_finite());
                self.headroom = Some((Instant::now(), value));
                value
            }
        }
    }

    /// Returns the skin temperature in degrees Celsius.
    pub fn skin_celsius(&self) -> Option<f32> {
        celsius(self.skin.as_ref()?)
    }
}

impl Service {
    fn acquire() -> Option<Service> {
        let android = Library::android();
        // SAFETY: the types are those of <android/thermal.h>.
        unsafe {
            let acquire: Acquire = android.function(c"AThermal_acquireManager")?;
            let release = android.function(c"AThermal_releaseManager")?;
            let status = android.function(c"AThermal_getCurrentThermalStatus")?;
            let headroom = android.function(c"AThermal_getThermalHeadroom");
            Some(Service { manager: NonNull::new(acquire())?, release, status, headroom })
        }
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // SAFETY: the manager was acquired once and is released only once.
        unsafe { (self.release)(self.manager.as_ptr()) }
    }
}

/// Returns the file of the skin's thermal zone, if applications may read it, which most devices do not allow.
fn skin_sensor() -> Option<PathBuf> {
    let zones = fs::read_dir("/sys/class/thermal").ok()?.flatten().map(|entry| entry.path());
    let is_skin = |zone: &PathBuf| {
        fs::read_to_string(zone.join("type")).is_ok_and(|kind| kind.to_lowercase().contains("skin"))
    };
    zones.filter(is_skin).map(|zone| zone.join("temp")).find(|file| celsius(file).is_some())
}

/// Returns a thermal zone's temperature in degrees Celsius. Most zones report thousandths of a degree, some degrees.
fn celsius(file: &Path) -> Option<f32> {
    let number: f32 = fs::read_to_string(file).ok()?.trim().parse().ok()?;
    let degrees = if number.abs() >= 1000.0 { number * 1e-3 } else { number };
    Some(degrees).filter(|degrees| PLAUSIBLE.contains(degrees))
}
