//! What is asked of Android on a device, and told to it.

use super::adb::{Device, DeviceError};
use super::capture::DeviceInfo;
use crate::viewer::Settings;

/// The application.
pub const PACKAGE: &str = "io.github.yoro";
/// Its activity.
const ACTIVITY: &str = "io.github.yoro/android.app.NativeActivity";
/// System properties that begin so are settings of the application.
pub const PROPERTY_PREFIX: &str = "debug.yoro.";
/// Size that the log's buffer is set to, so that it outlasts a lost connection. Android takes it back when it restarts.
const LOG_BUFFER: &str = "8M";

/// The battery as Android sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Battery {
    /// Level in percent.
    pub level_percent: Option<f64>,
    /// Temperature in degrees Celsius.
    pub celsius: Option<f64>,
    /// Whether there is a charger.
    pub plugged: bool,
}

/// What the device is.
///
/// # Errors
/// [`DeviceError`].
pub fn info(device: &dyn Device) -> Result<DeviceInfo, DeviceError> {
    let property = |name| Ok::<_, DeviceError>(device.shell(&["getprop", name])?.trim().to_owned());
    // The same device has another address with each wireless network.
    let own = property("ro.serialno")?;
    let serial = if own.is_empty() { device.serial().to_owned() } else { own };
    Ok(DeviceInfo {
        serial,
        manufacturer: property("ro.product.manufacturer")?,
        model: property("ro.product.model")?,
        android: property("ro.build.version.release")?,
        // Some devices refuse: the capacity is for a figure beside the others only.
        capacity_mah: device.shell(&["dumpsys", "batterystats"]).ok().and_then(|text| capacity(&text)),
        simulated: device.is_simulated(),
    })
}

/// The capacity in what `dumpsys batterystats` prints, in mAh.
fn capacity(text: &str) -> Option<f64> {
    let of = |line: &str| {
        let line = line.trim();
        let rest =
            line.strip_prefix("Estimated battery capacity:").or_else(|| line.strip_prefix("Capacity:"))?;
        let end = rest
            .trim_start()
            .find(|c: char| !c.is_ascii_digit() && c != '.')
            .unwrap_or(rest.trim_start().len());
        rest.trim_start()[..end].parse().ok().filter(|capacity| *capacity > 0.0)
    };
    text.lines().find_map(of)
}

/// The state of the battery.
///
/// # Errors
/// [`DeviceError`].
pub fn battery(device: &dyn Device) -> Result<Battery, DeviceError> {
    Ok(read_battery(&device.shell(&["dumpsys", "battery"])?))
}

fn read_battery(text: &str) -> Battery {
    let mut battery = Battery::default();
    for line in text.lines() {
        let Some((key, value)) = line.trim().split_once(": ") else { continue };
        match key {
            "level" => battery.level_percent = value.trim().parse().ok(),
            "temperature" => battery.celsius = value.trim().parse::<f64>().ok().map(|tenths| tenths / 10.0),
            _ if key.ends_with(" powered") => battery.plugged |= value.trim() == "true",
            _ => {}
        }
    }
    battery
}

/// What changes with each start of the device.
///
/// # Errors
/// [`DeviceError`].
pub fn boot_id(device: &dyn Device) -> Result<String, DeviceError> {
    Ok(device.shell(&["cat", "/proc/sys/kernel/random/boot_id"])?.trim().to_owned())
}

/// The device's clock as logcat takes it: seconds since 1970 with decimals.
///
/// # Errors
/// [`DeviceError`].
pub fn clock(device: &dyn Device) -> Result<String, DeviceError> {
    let text = device.shell(&["date", "+%s.%N"])?;
    let seconds = text.trim().parse::<f64>().ok().filter(|seconds| seconds.is_finite());
    let refused = || DeviceError::Refused {
        serial: device.serial().into(),
        command: "date".into(),
        reason: format!("it says \"{}\"", text.trim()),
    };
    seconds.map(|seconds| format!("{seconds:.6}")).ok_or_else(refused)
}

/// Version of the application on the device; none if it is not there.
///
/// # Errors
/// [`DeviceError`].
pub fn version(device: &dyn Device) -> Result<Option<String>, DeviceError> {
    let text = device.shell(&["dumpsys", "package", PACKAGE])?;
    let version = text.lines().find_map(|line| line.trim().strip_prefix("versionName="));
    Ok(version.map(|version| version.trim().to_owned()))
}

/// The device's address in the wireless network.
pub fn wifi_address(device: &dyn Device) -> Option<String> {
    let routes = device.shell(&["ip", "route"]).ok()?;
    routes.lines().filter(|line| line.contains("wlan")).find_map(|line| {
        let mut words = line.split_whitespace().skip_while(|word| *word != "src");
        words.nth(1).map(str::to_owned)
    })
}

/// Settings that the application's system properties hold, stronger than those that it is started with.
///
/// # Errors
/// [`DeviceError`].
pub fn properties(device: &dyn Device) -> Result<Vec<(String, String)>, DeviceError> {
    let property = |line: &str| {
        let (name, value) = line.trim().strip_prefix('[')?.strip_suffix(']')?.split_once("]: [")?;
        (name.starts_with(PROPERTY_PREFIX) && !value.is_empty()).then(|| (name.to_owned(), value.to_owned()))
    };
    Ok(device.shell(&["getprop"])?.lines().filter_map(property).collect())
}

/// Sets a system property; empty is as good as none.
///
/// # Errors
/// [`DeviceError`].
pub fn set_property(device: &dyn Device, name: &str, value: &str) -> Result<(), DeviceError> {
    device.shell(&["setprop", name, value]).map(drop)
}

/// Wakes the device up and lets its log keep more. Both help, and neither is needed.
pub fn wake(device: &dyn Device) {
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

/// Starts the application anew with exactly these settings, whatever file lies on the device.
///
/// # Errors
/// [`DeviceError`].
pub fn start(device: &dyn Device, settings: &Settings) -> Result<(), DeviceError> {
    let pairs = pairs(settings);
    let mut words = vec!["am", "start", "-S", "-W", "-n", ACTIVITY];
    for (key, value) in &pairs {
        words.extend(["--es", key, value]);
    }
    let said = device.shell(&words)?;
    if said.contains("does not exist") {
        return Err(DeviceError::NotInstalled { serial: device.serial().into() });
    }
    match said.lines().find(|line| line.starts_with("Error")) {
        Some(reason) => Err(DeviceError::Refused {
            serial: device.serial().into(),
            command: format!("am start -n {ACTIVITY}"),
            reason: reason.trim().into(),
        }),
        None => Ok(()),
    }
}

/// Each setting as key and value, as the application reads them.
pub fn pairs(settings: &Settings) -> Vec<(String, String)> {
    use toml::Value;
    let Ok(table) = toml::Table::try_from(settings) else { return Vec::new() };
    let text = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => (*number as f32).to_string(),
        Value::Array(list) => list.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    };
    let value = |key: &str| table.get(key).map_or_else(|| "auto".into(), text);
    crate::viewer::KEYS.iter().map(|key| ((*key).to_owned(), value(key))).collect()
}

/// Ends the application.
///
/// # Errors
/// [`DeviceError`].
pub fn stop(device: &dyn Device) -> Result<(), DeviceError> {
    device.shell(&["am", "force-stop", PACKAGE]).map(drop)
}

/// Whether the application runs.
///
/// # Errors
/// [`DeviceError`].
pub fn is_running(device: &dyn Device) -> Result<bool, DeviceError> {
    match device.shell(&["pidof", PACKAGE]) {
        Ok(pids) => Ok(!pids.trim().is_empty()),
        // It ends with 1 where there is no process.
        Err(DeviceError::Refused { .. }) => Ok(false),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_android_prints() {
        let text = "Current Battery Service state:\n  AC powered: false\n  USB powered: true\n  Wireless powered: false\n  Max charging current: 500000\n  status: 2\n  level: 87\n  scale: 100\n  voltage: 4312\n  temperature: 285\n";
        let battery = read_battery(text);
        assert_eq!(battery, Battery { level_percent: Some(87.0), celsius: Some(28.5), plugged: true });
        assert!(!read_battery(&text.replace("true", "false")).plugged);
        assert_eq!(read_battery(""), Battery::default());
        assert_eq!(capacity("x\n  Estimated battery capacity: 4410 mAh\n"), Some(4410.0));
        assert_eq!(capacity("  Capacity: 5000, Computed drain: 12.3, actual drain: 50\n"), Some(5000.0));
        assert_eq!(capacity("  Capacity: unknown\n"), None);
    }

    #[test]
    fn settings_arrive_as_they_left() {
        let mut settings = Settings::default();
        for pair in [
            "scene=talk",
            "method=conventional",
            "render-scale=0.8",
            "guard-band=40px",
            "run=7",
            "duration=61.5",
        ] {
            settings.apply(pair).unwrap();
        }
        let mut read = Settings { seed: 99, methods: Vec::new(), hud: false, ..Settings::default() };
        for (key, value) in pairs(&settings) {
            read.apply(&format!("{key}={value}")).unwrap();
        }
        assert_eq!(read, settings);
    }
}
