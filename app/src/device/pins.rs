//! What is held fixed on a device while it is measured, and given back afterwards.
//!
//! What there was before is written into a file on the device first: after a crash, or when the cable was pulled,
//! whoever measures on the device next gives it back.

use super::adb::{Device, DeviceError};
use super::phone::{self, set_property};

/// Where the device keeps what is to be given back.
const FILE: &str = "/data/local/tmp/yoro-restore.txt";
/// What Android prints for a setting that was never made.
const UNSET: &str = "null";
/// Refresh rate of Meta's headsets.
const QUEST_RATE: &str = "debug.oculus.refreshRate";

/// What is to be held fixed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted {
    /// Brightness of the screen, 0 to 255.
    pub brightness: Option<u8>,
    /// Refresh rate of the display in Hz.
    pub refresh_hz: Option<f64>,
}

/// Where Android keeps a value.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    /// `settings get system KEY`.
    System(String),
    /// `getprop KEY`.
    Property(String),
}

/// A value at its place; none where there was none.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Pin {
    place: Place,
    value: Option<String>,
}

impl Pin {
    fn new(place: Place, value: &str) -> Pin {
        let value = value.trim();
        Pin { place, value: Some(value.to_owned()).filter(|value| !value.is_empty() && value != UNSET) }
    }

    /// The value at the place now.
    fn now(device: &dyn Device, place: &Place) -> Result<Pin, DeviceError> {
        let value = match place {
            Place::System(key) => device.shell(&["settings", "get", "system", key])?,
            Place::Property(name) => device.shell(&["getprop", name])?,
        };
        Ok(Pin::new(place.clone(), &value))
    }

    fn set(&self, device: &dyn Device) -> Result<(), DeviceError> {
        match (&self.place, &self.value) {
            (Place::System(key), Some(value)) => {
                device.shell(&["settings", "put", "system", key, value]).map(drop)
            }
            (Place::System(key), None) => device.shell(&["settings", "delete", "system", key]).map(drop),
            (Place::Property(name), value) => set_property(device, name, value.as_deref().unwrap_or("")),
        }
    }

    fn line(&self) -> String {
        let value = self.value.as_deref().unwrap_or(UNSET);
        match &self.place {
            Place::System(key) => format!("system {key} {value}\n"),
            Place::Property(name) => format!("property {name} {value}\n"),
        }
    }

    fn read(line: &str) -> Option<Pin> {
        let mut words = line.splitn(3, ' ');
        let (kind, key, value) = (words.next()?, words.next()?.to_owned(), words.next()?);
        match kind {
            "system" => Some(Pin::new(Place::System(key), value)),
            "property" => Some(Pin::new(Place::Property(key), value)),
            _ => None,
        }
    }
}

/// Holds values fixed. [`Pins::give_back`] must be called; if that cannot be, the next [`Pins::new`] does it.
#[must_use]
#[derive(Debug)]
pub struct Pins {
    before: Vec<Pin>,
}

impl Pins {
    /// Gives back what an earlier run has left, then fixes what is wanted, and takes the application's own properties away:
    /// they would be stronger than the settings of a run. What the device does not let anybody change is told, and stays.
    ///
    /// # Errors
    /// [`DeviceError`]; nothing is changed then that the next call does not give back.
    pub fn new(device: &dyn Device, wanted: &Wanted) -> Result<Pins, DeviceError> {
        give_back_leftovers(device)?;
        let mut pins = Vec::new();
        let mut system = |key: &str, value: &str| pins.push(Pin::new(Place::System(key.into()), value));
        if let Some(brightness) = wanted.brightness {
            system("screen_brightness_mode", "0");
            system("screen_brightness", &brightness.to_string());
        }
        if let Some(hz) = wanted.refresh_hz {
            system("peak_refresh_rate", &hz.to_string());
            system("min_refresh_rate", &hz.to_string());
            pins.push(Pin::new(Place::Property(QUEST_RATE.into()), &hz.to_string()));
        }
        for (name, value) in phone::properties(device)? {
            ::log::warn!(
                "{}: {name} is {value}; it is taken away for the time of the measurement",
                device.serial()
            );
            pins.push(Pin { place: Place::Property(name), value: None });
        }
        let before = pins.iter().map(|pin| Pin::now(device, &pin.place)).collect::<Result<Vec<_>, _>>()?;
        if !before.is_empty() {
            device.put(FILE, &before.iter().map(Pin::line).collect::<String>())?;
        }
        let held = Pins { before };
        for pin in &pins {
            if let Err(error) = hold(device, pin) {
                if error.is_lost() {
                    return Err(error);
                }
                ::log::warn!("{error}; it stays as it is");
            }
        }
        Ok(held)
    }

    /// Gives everything back. A device that is gone gets it from the next measurement.
    ///
    /// # Errors
    /// [`DeviceError`].
    pub fn give_back(self, device: &dyn Device) -> Result<(), DeviceError> {
        give_back(device, &self.before)
    }
}

/// Sets a value and looks whether it has stayed.
fn hold(device: &dyn Device, pin: &Pin) -> Result<(), DeviceError> {
    pin.set(device)?;
    let now = Pin::now(device, &pin.place)?;
    let same = now.value == pin.value
        || now.value.as_ref().and_then(|v| v.parse::<f64>().ok())
            == pin.value.as_ref().and_then(|v| v.parse().ok());
    // A phone need not know the property of headsets, but takes any.
    if same {
        return Ok(());
    }
    let value = now.value.as_deref().unwrap_or(UNSET);
    let reason = format!("it is still {value}");
    Err(DeviceError::Refused { serial: device.serial().into(), command: pin.line().trim().into(), reason })
}

fn give_back(device: &dyn Device, before: &[Pin]) -> Result<(), DeviceError> {
    for pin in before {
        match pin.set(device) {
            Err(error) if error.is_lost() => return Err(error),
            Err(error) => ::log::warn!("{error}; it stays as it is"),
            Ok(()) => {}
        }
    }
    if before.is_empty() { Ok(()) } else { device.shell(&["rm", "-f", FILE]).map(drop) }
}

/// Gives back what a measurement that was killed has left on the device.
///
/// # Errors
/// [`DeviceError`].
pub fn give_back_leftovers(device: &dyn Device) -> Result<(), DeviceError> {
    let text = match device.shell(&["cat", FILE]) {
        Ok(text) => text,
        Err(DeviceError::Refused { .. }) => return Ok(()),
        Err(error) => return Err(error),
    };
    let pins: Vec<Pin> = text.lines().filter_map(Pin::read).collect();
    if !pins.is_empty() {
        ::log::warn!("{}: what an earlier measurement had left changed is given back", device.serial());
    }
    give_back(device, &pins)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_to_be_given_back_is_read_again() {
        let pins = [
            Pin::new(Place::System("screen_brightness".into()), "120\n"),
            Pin::new(Place::System("peak_refresh_rate".into()), "null"),
            Pin::new(Place::Property("debug.yoro.methods".into()), "yoro, mono"),
        ];
        let text: String = pins.iter().map(Pin::line).collect();
        assert_eq!(
            text,
            "system screen_brightness 120\nsystem peak_refresh_rate null\nproperty debug.yoro.methods yoro, mono\n"
        );
        assert_eq!(text.lines().filter_map(Pin::read).collect::<Vec<_>>(), pins);
        assert_eq!(Pin::read("nonsense"), None);
    }
}
