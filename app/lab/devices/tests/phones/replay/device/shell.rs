//! A simulated device's answers to commands.

use super::super::script::Fault;
use super::{Application, BOOT_S, LOADING_S, SimulatedDevice, VARIATION, WORN};
use rand::Rng;
use yoro_devices::adb::DeviceError;
use yoro_devices::phone;
use yoro_settings::PROPERTY_PREFIX;
use yoro_settings::Settings;
use yoro_settings::telemetry::{CurrentNormalizer, LOG_TAG};

/// The kernel's file with the battery's values.
const KERNEL_BATTERY: &str = "/sys/class/power_supply/battery/uevent";

impl SimulatedDevice {
    /// Installs the application.
    pub fn install(&mut self) -> Result<(), DeviceError> {
        self.reach()?;
        if self.script.storage_full {
            return Err(DeviceError::StorageFull(self.script.serial.clone()));
        }
        self.installed = true;
        Ok(())
    }

    /// Writes a file.
    pub fn put(&mut self, path: &str, text: &str) -> Result<(), DeviceError> {
        self.reach()?;
        if self.script.storage_full {
            return Err(self.refused(&["cat", ">", path], "No space left on device"));
        }
        self.stored.files.insert(path.into(), text.into());
        Ok(())
    }

    fn refused(&self, words: &[&str], reason: &str) -> DeviceError {
        let serial = self.script.serial.clone();
        DeviceError::Refused { serial, command: words.join(" "), reason: reason.into() }
    }

    /// Answers a command as Android's shell does. Only knows the commands that this program uses.
    pub fn shell(&mut self, words: &[&str]) -> Result<String, DeviceError> {
        self.reach()?;
        match words {
            ["getprop"] => {
                Ok(self.stored.properties.iter().map(|(k, v)| format!("[{k}]: [{v}]\n")).collect())
            }
            ["getprop", name] => Ok(self.property(name) + "\n"),
            ["setprop", name, value] => {
                self.stored.properties.insert((*name).into(), (*value).into());
                Ok(String::new())
            }
            ["settings", verb, table, key, value @ ..] => {
                let name = if *table == "system" { (*key).to_owned() } else { format!("{table}/{key}") };
                self.setting(words, verb, name, value.first().copied())
            }
            ["cat", "/proc/sys/kernel/random/boot_id"] => Ok(format!("{:08}-simulated\n", self.boots)),
            ["cat", path] if *path == KERNEL_BATTERY => self.kernel_battery(words),
            ["cat", path] => self
                .stored
                .files
                .get(*path)
                .cloned()
                .ok_or_else(|| self.refused(words, "No such file or directory")),
            ["rm", "-f", path] => {
                self.stored.files.remove(*path);
                Ok(String::new())
            }
            ["date", "+%s.%N"] => Ok(format!("{:.9}\n", self.now + self.clock_offset)),
            ["dumpsys", "battery"] => Ok(self.battery()),
            ["dumpsys", "batterystats"] => {
                Ok(format!("  Estimated battery capacity: {:.0} mAh\n", self.script.capacity_mah))
            }
            ["dumpsys", "window", "policy"] => Ok(format!(
                "    KeyguardServiceDelegate\n      showing=false\n      secure={}\n",
                self.script.secure_lock
            )),
            ["am", "broadcast", "-a", "com.oculus.vrpowermanager.prox_close"] => {
                self.stored.properties.insert(WORN.into(), "yes".into());
                Ok(String::new())
            }
            ["am", "broadcast", "-a", "com.oculus.vrpowermanager.automation_disable"] => {
                self.stored.properties.remove(WORN);
                Ok(String::new())
            }
            ["dumpsys", "package", name] if self.script.others.iter().any(|other| other == name) => {
                Ok("Packages:\n    versionName=7.1\n".into())
            }
            ["dumpsys", "package", name] if self.installed && *name == phone::PACKAGE => {
                Ok(format!("Packages:\n    versionName={}\n", env!("CARGO_PKG_VERSION")))
            }
            ["dumpsys", "package", name] => Ok(format!("Unable to find package: {name}\n")),
            ["ip", "route"] => Ok("192.0.2.0/24 dev wlan0 proto kernel scope link src 192.0.2.7\n".into()),
            ["pidof", name] => match &self.application {
                Some(application) if application.other.as_deref().unwrap_or(phone::PACKAGE) == *name => {
                    Ok(format!("{}\n", application.pid))
                }
                _ => Err(self.refused(words, "it does not say why")),
            },
            ["am", "force-stop", _] => {
                self.application = None;
                Ok(String::new())
            }
            ["am", "start", "-S", "-W", "-n", activity, extras @ ..] => self.start(activity, extras),
            ["input", ..] | ["wm", ..] | ["logcat", "-G", _] => Ok(String::new()),
            _ => Err(self.refused(words, "a simulated device does not know it")),
        }
    }

    fn property(&self, name: &str) -> String {
        let own = match name {
            "ro.serialno" => Some(self.script.serial.clone()),
            "ro.product.manufacturer" => Some(self.script.manufacturer.clone()),
            "ro.product.model" => Some(self.script.model.clone()),
            "ro.build.version.release" => Some(self.script.android.clone()),
            "sys.boot_completed" if self.now >= self.booted_at + BOOT_S => Some("1".into()),
            _ => None,
        };
        own.or_else(|| self.stored.properties.get(name).cloned()).unwrap_or_default()
    }

    fn setting(
        &mut self,
        words: &[&str],
        verb: &str,
        name: String,
        value: Option<&str>,
    ) -> Result<String, DeviceError> {
        if verb == "get" {
            return Ok(self.stored.settings.get(&name).cloned().unwrap_or_else(|| "null".into()) + "\n");
        }
        if self.script.fixed_settings.contains(&name) {
            return Err(self.refused(words, "java.lang.SecurityException: you cannot change it"));
        }
        match value {
            Some(value) => self.stored.settings.insert(name, value.into()),
            None => self.stored.settings.remove(&name),
        };
        Ok(String::new())
    }

    fn battery(&self) -> String {
        let plugged = self.now < self.plugged_until;
        let held =
            if self.script.battery_held { "  (UPDATES STOPPED -- use 'reset' to restart)\n" } else { "" };
        format!(
            "Current Battery Service state:\n{held}  AC powered: false\n  USB powered: {plugged}\n  Wireless powered: false\n  status: {}\n  level: {:.0}\n  scale: 100\n  voltage: {:.0}\n  temperature: {:.0}\n",
            if plugged { 2 } else { 3 },
            self.level_percent(),
            self.voltage(),
            self.celsius * 10.0,
        )
    }

    fn kernel_battery(&self, words: &[&str]) -> Result<String, DeviceError> {
        if !self.script.kernel_battery {
            return Err(self.refused(words, "Permission denied"));
        }
        Ok(format!(
            "POWER_SUPPLY_NAME=battery\nPOWER_SUPPLY_VOLTAGE_NOW={:.0}\nPOWER_SUPPLY_CURRENT_NOW={:.0}\n",
            self.volts() * 1e6,
            self.milliamperes() * 1e3,
        ))
    }

    /// Starts the application with the settings in `extras`, overridden by system properties.
    fn start(&mut self, activity: &str, extras: &[&str]) -> Result<String, DeviceError> {
        let package = activity.split('/').next().unwrap_or_default();
        let other = self.script.others.iter().find(|other| *other == package).cloned();
        if !self.installed && other.is_none() {
            return Ok(format!("Error type 3\nError: Activity class {{{activity}}} does not exist.\n"));
        }
        let pairs = extras.chunks_exact(3).map(|words| (words[1].to_owned(), words[2].to_owned()));
        let properties = self.stored.properties.iter().filter_map(|(name, value)| {
            Some((name.strip_prefix(PROPERTY_PREFIX)?.to_owned(), value.clone()))
        });
        let mut settings = Settings::default();
        for (key, value) in pairs.chain(properties.collect::<Vec<_>>()) {
            if let Err(error) = settings.apply(&format!("{key}={value}")) {
                return Ok(format!("Error: {error}\n"));
            }
        }
        self.starts += 1;
        let pid = 4000 + self.starts;
        let mut faults: Vec<Fault> =
            self.script.fault.iter().filter(|fault| fault.start == self.starts).copied().collect();
        faults.sort_by(|a, b| a.at.total_cmp(&b.at));
        self.write_log(pid, "I", LOG_TAG, &format!("yoro {} starts", env!("CARGO_PKG_VERSION")));
        self.application = Some(Application {
            pid,
            other,
            method: settings.method.first().name().into(),
            settings,
            first_frame: self.now + LOADING_S,
            lines: 0,
            variation: 1.0 + VARIATION * self.random.random_range(-1.0..1.0),
            normalizer: CurrentNormalizer::default(),
            faults,
        });
        Ok("Starting: Intent { cmp=io.github.yoro/android.app.NativeActivity (has extras) }\nStatus: ok\n"
            .into())
    }
}
