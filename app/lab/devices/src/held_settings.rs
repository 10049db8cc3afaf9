//! Device settings that are held fixed during a measurement and restored afterwards.
//!
//! The earlier values are first written to a file on the device. After a crash or a lost connection, the next
//! measurement on the device restores them.

use super::adb::{Device, DeviceError};
use super::capture::DeviceInfo;
use super::phone;

/// The file on the device with the values to restore.
const FILE: &str = "/data/local/tmp/yoro-restore.txt";
/// Android's answer for a setting without a value.
const UNSET: &str = "null";
/// Property with the refresh rate of Meta's headsets.
const QUEST_RATE: &str = "debug.oculus.refreshRate";
/// Property that lets applications on Meta's headsets continue outside the boundary.
const QUEST_BOUNDARY: &str = "debug.oculus.guardian_pause";
/// Time without a touch until the screen turns off, in milliseconds: one day. While a phone cools down, no application
/// keeps the screen on, and some phones turn off adb over Wi-Fi together with the screen.
const SCREEN_TIMEOUT_MS: &str = "86400000";
/// Do not disturb except for alarms (`Global.ZEN_MODE_ALARMS`).
const ALARMS_ONLY: &str = "3";
/// Above this many Hz, phones by Samsung need their high refresh rate mode.
const SAMSUNG_STANDARD_HZ: f64 = 60.0;

/// The values to hold fixed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted {
    /// Brightness of the screen, 0 to 255.
    pub brightness: Option<u8>,
    /// Refresh rate of the display in Hz.
    pub refresh_hz: Option<f64>,
}

/// The tables of Android's settings.
const TABLES: [&str; 3] = ["system", "secure", "global"];

/// Where a value is stored.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    /// `settings get TABLE KEY`.
    Setting(&'static str, String),
    /// `getprop KEY`.
    Property(String),
    /// The proximity sensor of a Meta headset, which can be overridden but not read.
    Worn,
}

/// A stored value, or `None` if it is not set.
#[derive(Clone, Debug, PartialEq, Eq)]
struct HeldSetting {
    place: Place,
    value: Option<String>,
}

impl HeldSetting {
    fn new(place: Place, value: &str) -> HeldSetting {
        let value = value.trim();
        HeldSetting {
            place,
            value: Some(value.to_owned()).filter(|value| !value.is_empty() && value != UNSET),
        }
    }

    /// Reads the current value.
    fn now(device: &Device, place: &Place) -> Result<HeldSetting, DeviceError> {
        let value = match place {
            Place::Setting(table, key) => device.shell(&["settings", "get", table, key])?,
            Place::Property(name) => device.shell(&["getprop", name])?,
            Place::Worn => String::new(),
        };
        Ok(HeldSetting::new(place.clone(), &value))
    }

    fn set(&self, device: &Device) -> Result<(), DeviceError> {
        match (&self.place, &self.value) {
            (Place::Setting(table, key), Some(value)) => {
                device.shell(&["settings", "put", table, key, value]).map(drop)
            }
            (Place::Setting(table, key), None) => device.shell(&["settings", "delete", table, key]).map(drop),
            // Setting a property to an empty text removes it.
            (Place::Property(name), value) => {
                device.shell(&["setprop", name, value.as_deref().unwrap_or("")]).map(drop)
            }
            (Place::Worn, value) => {
                let word = if value.is_some() { "prox_close" } else { "automation_disable" };
                let action = format!("com.oculus.vrpowermanager.{word}");
                device.shell(&["am", "broadcast", "-a", &action]).map(drop)
            }
        }
    }

    fn line(&self) -> String {
        let value = self.value.as_deref().unwrap_or(UNSET);
        match &self.place {
            Place::Setting(table, key) => format!("{table} {key} {value}\n"),
            Place::Property(name) => format!("property {name} {value}\n"),
            Place::Worn => format!("headset worn {value}\n"),
        }
    }

    fn read(line: &str) -> Option<HeldSetting> {
        let mut words = line.splitn(3, ' ');
        let (kind, key, value) = (words.next()?, words.next()?.to_owned(), words.next()?);
        let place = match kind {
            "property" => Place::Property(key),
            "headset" => Place::Worn,
            kind => Place::Setting(TABLES.into_iter().find(|table| *table == kind)?, key),
        };
        Some(HeldSetting::new(place, value))
    }
}

/// Values that are held fixed until [`HeldSettings::restore`]. Without it, the next [`HeldSettings::new`] restores
/// them.
#[must_use]
#[derive(Debug)]
pub struct HeldSettings {
    wanted: Vec<HeldSetting>,
    before: Vec<HeldSetting>,
    /// A sentence for each value that the device refused to change.
    pub(crate) refused: Vec<String>,
    /// The boot id of the device when they were set.
    boot: String,
}

impl HeldSettings {
    /// Restores values that an earlier run has left behind, then sets the wanted ones, keeps the screen on, silences
    /// notifications, and clears the application's own properties, which would override a run's settings. Tells a Meta
    /// headset that it is worn. Values that the device refuses to change are kept, and told by a sentence each.
    ///
    /// # Errors
    /// [`DeviceError`]. The next call restores everything that was changed.
    pub fn new(device: &Device, info: &DeviceInfo, wanted: &Wanted) -> Result<HeldSettings, DeviceError> {
        restore_leftovers(device)?;
        let mut settings = settings_to_hold(info, wanted);
        for (name, value) in phone::properties(device)? {
            ::log::warn!(
                "{}: {name} is {value}; it is taken away for the time of the measurement",
                device.serial
            );
            settings.push(HeldSetting { place: Place::Property(name), value: None });
        }
        let before = settings
            .iter()
            .map(|setting| HeldSetting::now(device, &setting.place))
            .collect::<Result<Vec<_>, _>>()?;
        device.put(FILE, &before.iter().map(HeldSetting::line).collect::<String>())?;
        let boot = phone::boot_id(device)?;
        let mut held = HeldSettings { wanted: settings, before, refused: Vec::new(), boot };
        held.hold(device)?;
        for refused in &held.refused {
            ::log::warn!("{refused}");
        }
        Ok(held)
    }

    /// Sets all values again if the device was restarted, which resets system properties and the wear state.
    pub fn renew(&mut self, device: &Device) -> Result<(), DeviceError> {
        let boot = phone::boot_id(device)?;
        if boot == self.boot {
            return Ok(());
        }
        self.boot = boot;
        self.hold(device)
    }

    fn hold(&mut self, device: &Device) -> Result<(), DeviceError> {
        self.refused.clear();
        for held in &self.wanted {
            match hold(device, held) {
                Err(error) if error.is_lost() => return Err(error),
                Err(error) => self.refused.push(format!("{error}; it stays as it is")),
                Ok(()) => {}
            }
        }
        Ok(())
    }

    /// Restores all values. If the device is gone, the next measurement on it does so.
    pub fn restore(self, device: &Device) -> Result<(), DeviceError> {
        restore(device, &self.before)
    }
}

fn settings_to_hold(info: &DeviceInfo, wanted: &Wanted) -> Vec<HeldSetting> {
    let setting = |table: &'static str, key: &str, value: &str| {
        HeldSetting::new(Place::Setting(table, key.into()), value)
    };
    let property = |name: &str, value: &str| HeldSetting::new(Place::Property(name.into()), value);
    let is_by = |maker: &str| info.manufacturer.eq_ignore_ascii_case(maker);
    let mut settings = vec![
        setting("system", "screen_off_timeout", SCREEN_TIMEOUT_MS),
        setting("global", "zen_mode", ALARMS_ONLY),
    ];
    if let Some(brightness) = wanted.brightness {
        settings.push(setting("system", "screen_brightness_mode", "0"));
        settings.push(setting("system", "screen_brightness", &brightness.to_string()));
    }
    if let Some(hz) = wanted.refresh_hz {
        if is_by("samsung") {
            // Peak and minimum rate have no effect there without the mode: 0 is the standard rate, 2 the high one.
            let mode = if hz > SAMSUNG_STANDARD_HZ { "2" } else { "0" };
            settings.push(setting("secure", "refresh_rate_mode", mode));
        }
        settings.push(setting("system", "peak_refresh_rate", &hz.to_string()));
        settings.push(setting("system", "min_refresh_rate", &hz.to_string()));
        // This property is for headsets, but phones accept any property.
        settings.push(property(QUEST_RATE, &hz.to_string()));
    }
    if is_by("oculus") || is_by("meta") {
        settings.push(property(QUEST_BOUNDARY, "1"));
        settings.push(HeldSetting::new(Place::Worn, "yes"));
    }
    settings
}

/// Sets a value and checks that the device has kept it.
fn hold(device: &Device, held: &HeldSetting) -> Result<(), DeviceError> {
    held.set(device)?;
    if held.place == Place::Worn {
        return Ok(());
    }
    let now = HeldSetting::now(device, &held.place)?;
    let number = |held: &HeldSetting| held.value.as_ref().and_then(|value| value.parse::<f64>().ok());
    if now.value == held.value || number(&now).is_some() && number(&now) == number(held) {
        return Ok(());
    }
    let value = now.value.as_deref().unwrap_or(UNSET);
    Err(device.refused(held.line().trim(), format!("it is still {value}")))
}

fn restore(device: &Device, before: &[HeldSetting]) -> Result<(), DeviceError> {
    for held in before {
        match held.set(device) {
            Err(error) if error.is_lost() => return Err(error),
            Err(error) => ::log::warn!("{error}; it stays as it is"),
            Ok(()) => {}
        }
    }
    if before.is_empty() { Ok(()) } else { device.shell(&["rm", "-f", FILE]).map(drop) }
}

/// Restores the values that a killed measurement has left on the device.
fn restore_leftovers(device: &Device) -> Result<(), DeviceError> {
    let text = match device.shell(&["cat", FILE]) {
        Ok(text) => text,
        Err(DeviceError::Refused { .. }) => return Ok(()),
        Err(error) => return Err(error),
    };
    let settings: Vec<HeldSetting> = text.lines().filter_map(HeldSetting::read).collect();
    if !settings.is_empty() {
        ::log::warn!("{}: what an earlier measurement had left changed is given back", device.serial);
    }
    restore(device, &settings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pins_survive_writing_and_reading() {
        let settings = [
            HeldSetting::new(Place::Setting("system", "screen_brightness".into()), "120\n"),
            HeldSetting::new(Place::Setting("secure", "refresh_rate_mode".into()), "null"),
            HeldSetting::new(Place::Property("debug.yoro.methods".into()), "yoro, mono"),
            HeldSetting::new(Place::Worn, "null"),
        ];
        let text: String = settings.iter().map(HeldSetting::line).collect();
        assert_eq!(
            text,
            "system screen_brightness 120\nsecure refresh_rate_mode null\nproperty debug.yoro.methods yoro, mono\nheadset worn null\n"
        );
        assert_eq!(text.lines().filter_map(HeldSetting::read).collect::<Vec<_>>(), settings);
        assert_eq!(HeldSetting::read("nonsense"), None);
    }

    #[test]
    fn each_maker_has_its_own_pins() {
        let lines = |manufacturer: &str, hz: f64| -> Vec<String> {
            let info = DeviceInfo { manufacturer: manufacturer.into(), ..DeviceInfo::default() };
            let wanted = Wanted { brightness: None, refresh_hz: Some(hz) };
            settings_to_hold(&info, &wanted).iter().map(|setting| setting.line().trim().to_owned()).collect()
        };
        let has = |lines: &[String], line: &str| lines.iter().any(|found| found == line);
        assert!(has(&lines("Google", 60.0), "system screen_off_timeout 86400000"));
        assert!(!lines("Google", 60.0).iter().any(|line| line.contains("refresh_rate_mode")));
        assert!(has(&lines("samsung", 120.0), "secure refresh_rate_mode 2"));
        assert!(has(&lines("samsung", 60.0), "secure refresh_rate_mode 0"));
        for line in ["property debug.oculus.guardian_pause 1", "headset worn yes"] {
            assert!(has(&lines("Oculus", 72.0), line) && has(&lines("Meta", 72.0), line), "{line}");
            assert!(!has(&lines("Google", 72.0), line));
        }
    }
}
