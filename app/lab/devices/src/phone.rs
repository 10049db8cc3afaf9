//! Commands to Android on a device, and parsers of their output.

use super::adb::{Device, DeviceError};
use super::capture::DeviceInfo;
use yoro_settings::telemetry::BatteryStatus;
use yoro_settings::{PROPERTY_PREFIX, Settings};

/// The application's package.
pub const PACKAGE: &str = "io.github.yoro";
/// The application's activity.
const ACTIVITY: &str = "io.github.yoro/android.app.NativeActivity";
/// Size of the log buffer, which must hold the lines of a lost connection. Android resets it on a restart.
const LOG_BUFFER: &str = "8M";

/// The battery's state as Android reports it (`dumpsys battery`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Battery {
    /// Level in percent.
    pub level_percent: Option<f64>,
    /// Temperature in degrees Celsius.
    pub celsius: Option<f64>,
    /// Sum of the power sources as in Android's `EXTRA_PLUGGED`: 1 for AC, 2 for USB, 4 for wireless, 8 for a dock.
    pub sources: i32,
    /// Charging status.
    pub status: Option<BatteryStatus>,
    /// True if these values were set by hand and no longer follow the battery (`UPDATES STOPPED`).
    pub held: bool,
}

impl Battery {
    /// True if the battery's current is not the device's: a charger is connected, or the battery charges or does not
    /// discharge. Phones whose charging is switched off report no source, but the status "not charging".
    pub fn plugged(&self) -> bool {
        self.sources != 0 || matches!(self.status, Some(BatteryStatus::Charging | BatteryStatus::NotCharging))
    }
}

/// Returns the device's manufacturer, model, Android version and battery capacity.
pub fn info(device: &Device) -> Result<DeviceInfo, DeviceError> {
    let property = |name| Ok::<_, DeviceError>(device.shell(&["getprop", name])?.trim().to_owned());
    Ok(DeviceInfo {
        // The name in adb's list is not stable: a device has another address in each wireless network.
        serial: device.serial_number()?,
        manufacturer: property("ro.product.manufacturer")?,
        model: property("ro.product.model")?,
        android: property("ro.build.version.release")?,
        // Some devices refuse this. The capacity is only needed for an additional figure.
        capacity_mah: device.shell(&["dumpsys", "batterystats"]).ok().and_then(|text| capacity(&text)),
        simulated: false,
    })
}

/// Parses the capacity in mAh in the output of `dumpsys batterystats`.
fn capacity(text: &str) -> Option<f64> {
    let of = |line: &str| {
        let line = line.trim();
        let rest =
            line.strip_prefix("Estimated battery capacity:").or_else(|| line.strip_prefix("Capacity:"))?;
        let number = rest.trim_start().split(|c: char| !c.is_ascii_digit() && c != '.').next()?;
        number.parse().ok().filter(|capacity| *capacity > 0.0)
    };
    text.lines().find_map(of)
}

/// Returns the state of the battery.
pub fn battery(device: &Device) -> Result<Battery, DeviceError> {
    Ok(read_battery(&device.shell(&["dumpsys", "battery"])?))
}

fn read_battery(text: &str) -> Battery {
    let mut battery = Battery { held: text.contains("UPDATES STOPPED"), ..Battery::default() };
    for line in text.lines() {
        let Some((key, value)) = line.trim().split_once(": ") else { continue };
        let value = value.trim();
        let mut source = |bit: i32| battery.sources |= if value == "true" { bit } else { 0 };
        match key {
            "AC powered" => source(1),
            "USB powered" => source(2),
            "Wireless powered" => source(4),
            "Dock powered" => source(8),
            "status" => battery.status = value.parse().ok().and_then(BatteryStatus::from_android),
            "level" => battery.level_percent = value.parse().ok(),
            "temperature" => battery.celsius = value.parse::<f64>().ok().map(|tenths| tenths / 10.0),
            _ => {}
        }
    }
    battery
}

/// Returns an empty output if the device refused the command.
fn unless_refused(said: Result<String, DeviceError>) -> Result<String, DeviceError> {
    match said {
        Err(DeviceError::Refused { .. }) => Ok(String::new()),
        said => said,
    }
}

/// True if the battery saver is on.
pub(crate) fn saves_battery(device: &Device) -> Result<bool, DeviceError> {
    Ok(unless_refused(device.shell(&["settings", "get", "global", "low_power"]))?.trim() == "1")
}

/// The screen lock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Keyguard {
    /// True if it asks for a PIN, a pattern or a password.
    pub secure: bool,
    /// True if it is shown now.
    pub showing: bool,
}

/// Returns the state of the screen lock. Both values are false if Android does not report it.
pub(crate) fn keyguard(device: &Device) -> Result<Keyguard, DeviceError> {
    Ok(read_keyguard(&unless_refused(device.shell(&["dumpsys", "window", "policy"]))?))
}

fn read_keyguard(text: &str) -> Keyguard {
    // Other parts of the output have keys with the same names.
    let own = text.split_once("KeyguardServiceDelegate").map_or("", |(_, own)| own);
    let value = |key: &str| own.split_whitespace().find_map(|word| word.strip_prefix(key)) == Some("true");
    Keyguard { secure: value("secure="), showing: value("showing=") }
}

/// Returns the boot id, which changes whenever the device restarts.
pub(crate) fn boot_id(device: &Device) -> Result<String, DeviceError> {
    Ok(device.shell(&["cat", "/proc/sys/kernel/random/boot_id"])?.trim().to_owned())
}

/// Returns the device's clock in the format that logcat takes: seconds since 1970 with decimals.
pub(crate) fn clock(device: &Device) -> Result<String, DeviceError> {
    let text = device.shell(&["date", "+%s.%N"])?;
    let seconds = text.trim().parse::<f64>().ok().filter(|seconds| seconds.is_finite());
    let refused = || device.refused("date", format!("it says \"{}\"", text.trim()));
    seconds.map(|seconds| format!("{seconds:.6}")).ok_or_else(refused)
}

/// Returns the version of the application, or `None` if it is not installed.
pub fn version(device: &Device) -> Result<Option<String>, DeviceError> {
    let text = device.shell(&["dumpsys", "package", PACKAGE])?;
    let version = text.lines().find_map(|line| line.trim().strip_prefix("versionName="));
    Ok(version.map(|version| version.trim().to_owned()))
}

/// Returns the device's address in the wireless network.
pub(crate) fn wifi_address(device: &Device) -> Option<String> {
    let routes = device.shell(&["ip", "route"]).ok()?;
    routes.lines().filter(|line| line.contains("wlan")).find_map(|line| {
        let mut words = line.split_whitespace().skip_while(|word| *word != "src");
        words.nth(1).map(str::to_owned)
    })
}

/// Returns the settings in the application's system properties, which override those given at its start.
pub(crate) fn properties(device: &Device) -> Result<Vec<(String, String)>, DeviceError> {
    let property = |line: &str| {
        let (name, value) = line.trim().strip_prefix('[')?.strip_suffix(']')?.split_once("]: [")?;
        (name.starts_with(PROPERTY_PREFIX) && !value.is_empty()).then(|| (name.to_owned(), value.to_owned()))
    };
    Ok(device.shell(&["getprop"])?.lines().filter_map(property).collect())
}

/// Wakes the device up, dismisses the screen lock and enlarges the log buffer. Ignores failures.
pub(crate) fn wake(device: &Device) {
    let commands: [&[&str]; 3] = [
        &["input", "keyevent", "KEYCODE_WAKEUP"],
        &["wm", "dismiss-keyguard"],
        &["logcat", "-G", LOG_BUFFER],
    ];
    for words in commands {
        if let Err(error) = device.shell(words) {
            ::log::debug!("{error}");
        }
    }
}

/// Restarts the application with exactly these settings. It ignores a settings file on the device.
pub(crate) fn start(device: &Device, settings: &Settings) -> Result<(), DeviceError> {
    let pairs = settings.pairs();
    let mut words = vec!["am", "start", "-S", "-W", "-n", ACTIVITY];
    for (key, value) in &pairs {
        words.extend(["--es", key, value]);
    }
    let said = device.shell(&words)?;
    match said.lines().rfind(|line| line.starts_with("Error")) {
        Some(reason) => Err(device.refused(&format!("am start -n {ACTIVITY}"), reason.trim().into())),
        None => Ok(()),
    }
}

/// Ends the application.
pub(crate) fn stop(device: &Device) -> Result<(), DeviceError> {
    device.shell(&["am", "force-stop", PACKAGE]).map(drop)
}

/// Returns whether the application runs.
pub(crate) fn runs(device: &Device) -> Result<bool, DeviceError> {
    // `pidof` exits with 1 if it finds no process.
    Ok(!unless_refused(device.shell(&["pidof", PACKAGE]))?.trim().is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn battery_and_capacity_are_parsed() {
        let text = "Current Battery Service state:\n  AC powered: false\n  USB powered: true\n  Wireless powered: false\n  Max charging current: 500000\n  status: 2\n  level: 87\n  scale: 100\n  voltage: 4312\n  temperature: 285\n";
        let battery = read_battery(text);
        assert_eq!((battery.level_percent, battery.celsius), (Some(87.0), Some(28.5)));
        assert!(battery.plugged() && battery.sources == 2);
        assert!(!read_battery(&text.replace("true", "false").replace("status: 2", "status: 3")).plugged());
        assert_eq!(read_battery(""), Battery::default());
        assert_eq!(capacity("x\n  Estimated battery capacity: 4410 mAh\n"), Some(4410.0));
        assert_eq!(capacity("  Capacity: 5000, Computed drain: 12.3, actual drain: 50\n"), Some(5000.0));
        assert_eq!(capacity("  Capacity: unknown\n"), None);
    }

    /// The output of a phone with a charger whose charging is switched off (VR-25/acc issue 112), and the same after
    /// `dumpsys battery unplug`.
    #[test]
    fn a_battery_that_does_not_discharge_counts_as_plugged_in() {
        let text = "Current Battery Service state:\n  AC powered: false\n  USB powered: false\n  Wireless powered: false\n  Charge counter: 3124799\n  status: 4\n  level: 89\n  voltage: 4218\n  temperature: 324\n";
        assert!(read_battery(text).plugged() && !read_battery(text).held);
        assert!(!read_battery(&text.replace("status: 4", "status: 3")).plugged());
        // The battery is full, and the charger was just unplugged.
        assert!(!read_battery(&text.replace("status: 4", "status: 5")).plugged());
        let held = text.replace("state:\n", "state:\n  (UPDATES STOPPED -- use 'reset' to restart)\n");
        assert!(read_battery(&held).held);
    }

    #[test]
    fn the_screen_lock_is_parsed() {
        let text = "WINDOW MANAGER POLICY STATE\n  showing=true\n  KeyguardServiceDelegate\n    showing=false\n    inputRestricted=false\n    secure=true\n    dreaming=false\n";
        assert_eq!(read_keyguard(text), Keyguard { secure: true, showing: false });
        assert_eq!(read_keyguard("Can't find service: window"), Keyguard::default());
    }
}
