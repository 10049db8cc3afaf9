//! The interface to devices. [`AdbProgram`](super::adb_program::AdbProgram) implements it with the program adb; tests
//! have phones of their own.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::capture::CaptureError;
use yoro_files::FileError;

/// The state in which adb lists a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// Ready.
    Ready,
    /// The device waits for its user to accept this computer.
    Unauthorized,
    /// Connected, but it does not answer.
    Offline,
    /// The operating system does not allow adb to open the device.
    NoPermission,
    /// Any other state, in adb's words, such as `bootloader` or `recovery`.
    Other(String),
}

impl State {
    /// Parses the second word of a line of `adb devices`.
    pub fn from_adb(word: &str) -> State {
        match word {
            "device" => State::Ready,
            "unauthorized" | "authorizing" => State::Unauthorized,
            "offline" | "connecting" => State::Offline,
            "no" => State::NoPermission,
            other => State::Other(other.into()),
        }
    }

    /// Returns the state's name in tables.
    pub fn name(&self) -> &str {
        match self {
            State::Ready => "ready",
            State::Unauthorized => "unauthorized",
            State::Offline => "offline",
            State::NoPermission => "no permission",
            State::Other(word) => word,
        }
    }
}

/// A device in adb's list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// The device's serial number, as adb lists it.
    pub serial: String,
    /// Its state.
    pub state: State,
}

/// The reason why no measurement can be made on a device: one sentence that names the remedy.
///
/// A variant with a single text holds the device's serial number.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DeviceError {
    /// The adb server, which runs every command, does not answer.
    #[error(
        "adb's server does not answer ({reason}): restart it by adb kill-server and adb start-server, and use one version of adb only"
    )]
    Server {
        /// The reason in adb's words.
        reason: String,
    },
    /// The program adb was not found.
    #[error(
        "adb was not found in {looked}: install Android's platform tools (Debian and Ubuntu: apt install adb), or name its file"
    )]
    NoAdb {
        /// The places that were searched.
        looked: String,
    },
    /// The program adb exists, but does not start.
    #[error("{} does not start ({reason}): name another one", program.display())]
    Start {
        /// The program.
        program: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// No device is connected.
    #[error(
        "no device is connected: turn on USB debugging in its developer options, use a data cable, and look with yoro device list"
    )]
    NoDevice,
    /// Several devices are connected and none was chosen.
    #[error("several devices are connected ({}): name one or some of them, or ask for all", serials.join(", "))]
    Several {
        /// Their names in adb's list.
        serials: Vec<String>,
    },
    /// No connected device has this serial number.
    #[error("{0} is not connected: yoro device list shows which devices are")]
    Unknown(String),
    /// See [`State::Unauthorized`].
    #[error("{0} does not trust this computer yet: unlock it and accept the key that it shows")]
    Unauthorized(String),
    /// See [`State::Offline`].
    #[error(
        "{} is offline: plug it in again, or connect anew (adb reconnect offline, over Wi-Fi adb connect {})",
        .0, quoted(.0)
    )]
    Offline(String),
    /// See [`State::NoPermission`].
    #[error(
        "this user may not open {0}: install the udev rules for Android (Debian and Ubuntu: apt install android-sdk-platform-tools-common), then plug it in again"
    )]
    NoPermission(String),
    /// See [`State::Other`].
    #[error("{serial} is in the state \"{state}\": start Android on it")]
    NotReady {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// adb's words.
        state: String,
    },
    /// adb does not reach the device.
    #[error("adb does not reach {serial} ({reason}): connect it again, unlock it, and give the same command")]
    Unreached {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The reason in adb's words.
        reason: String,
    },
    /// The device was connected, but no longer is.
    #[error("{0} was lost: connect it again and give the same command")]
    Lost(String),
    /// The application is not installed.
    #[error("yoro is not installed on {0}: yoro device install does it")]
    NotInstalled(String),
    /// Another application is not installed.
    #[error(
        "{package} is not installed on {serial}: adb -s {} shell pm list packages prints what is",
        quoted(serial)
    )]
    NoPackage {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The application's package.
        package: String,
    },
    /// The installation failed.
    #[error("{} cannot be installed on {serial}: {reason} (docs/measuring.md has the remedies)", apk.display())]
    Install {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The APK file.
        apk: PathBuf,
        /// The reason in adb's words.
        reason: String,
    },
    /// Power cannot be measured because the device is plugged in.
    #[error(
        "{serial} is plugged in, and a charging battery says nothing of the device's power: measure over Wi-Fi ({}), or allow a plugged-in device for everything but power",
        wifi(serial, address)
    )]
    PluggedIn {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The device's address in the wireless network, if it has one.
        address: Option<String>,
    },
    /// The battery's values were set by hand.
    #[error(
        "what {} says of its battery was set by hand (dumpsys battery set or unplug): adb -s {} shell dumpsys battery reset",
        .0, quoted(.0)
    )]
    BatteryHeld(String),
    /// The battery saver is on.
    #[error(
        "the battery saver of {} is on, which slows it down: turn it off (adb -s {} shell settings put global low_power 0)",
        .0, quoted(.0)
    )]
    BatterySaver(String),
    /// The screen is locked by a PIN, a pattern or a password, which an unattended run cannot enter.
    #[error(
        "{0} is locked by PIN, pattern or password, which ends a measurement as soon as its screen goes off: set its screen lock to none or swipe for the time of the measurement"
    )]
    Locked(String),
    /// The device does not cool down.
    #[error(
        "{serial} has {celsius:.1} C and does not cool down to {wanted:.1} C: let it rest in a cooler place, then give the same command"
    )]
    TooWarm {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The device's temperature in degrees Celsius.
        celsius: f64,
        /// The temperature that it should cool down to, in degrees Celsius.
        wanted: f64,
    },
    /// A command on the device failed.
    #[error("{serial} refuses \"{command}\" ({reason}): {}", after_refusal(serial, reason))]
    Refused {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The command.
        command: String,
        /// The device's answer.
        reason: String,
    },
    /// A command on the device did not end in time.
    #[error("{serial} has not answered \"{command}\" for {seconds} s: plug it in again, or restart it")]
    Silent {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The command.
        command: String,
        /// The time waited, in seconds.
        seconds: u64,
    },
    /// The user has asked to stop.
    #[error("interrupted: what was captured is kept, and the same command goes on")]
    Interrupted,
    /// A capture cannot be written.
    #[error(transparent)]
    Capture(#[from] CaptureError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl DeviceError {
    /// True if the device may come back without help.
    pub fn is_lost(&self) -> bool {
        use DeviceError::{Lost, Offline, Server, Silent, Unauthorized, Unknown, Unreached};
        matches!(
            self,
            Lost(_)
                | Offline(_)
                | Unauthorized(_)
                | Unknown(_)
                | Silent { .. }
                | Server { .. }
                | Unreached { .. }
        )
    }
}

/// Returns the commands that move a device from the cable to the wireless network.
fn wifi(serial: &str, address: &Option<String>) -> String {
    if is_wireless(serial) {
        return "it already is: take the charger off".into();
    }
    let address = address.as_deref().unwrap_or("ADDRESS");
    format!(
        "adb -s {} tcpip 5555; unplug it; adb connect {address}:5555; the device is {address}:5555 then",
        quoted(serial)
    )
}

/// Returns the device's serial number, which does not depend on how it is connected. Emulators of one image all have
/// the same number (`EMULATOR34X1X19X0`), so for them this is the name in adb's list.
pub fn serial_number(device: &dyn Device) -> Result<String, DeviceError> {
    let own = device.shell(&["getprop", "ro.serialno"])?.trim().to_owned();
    let is_shared = own.is_empty() || own.starts_with("EMULATOR") || device.serial().starts_with("emulator-");
    Ok(if is_shared { device.serial().to_owned() } else { own })
}

/// True if adb reaches the device over the network: by address and port, or by a name found with mDNS, such as
/// `adb-SERIAL-x7Fw2a._adb-tls-connect._tcp`.
pub fn is_wireless(serial: &str) -> bool {
    serial.contains(':') || serial.contains("._adb")
}

/// Quotes a word for the shell of this computer or of the device.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-._/:=,%+@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Returns the remedy for a refusal.
fn after_refusal(serial: &str, reason: &str) -> String {
    if reason.contains("SecurityException") {
        return "on phones by Xiaomi turn on \"USB debugging (Security settings)\" in the developer options and restart \
                the phone"
            .into();
    }
    format!("try it by adb -s {} shell", quoted(serial))
}

/// An event while a log is followed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LogEvent {
    /// A line as it came, with its line end. Messages of drivers need not be valid UTF-8.
    Line(Vec<u8>),
    /// No line came in the time given.
    Quiet,
    /// The log has ended: the device is gone, or its log service was restarted.
    Ended,
}

/// A log that is being followed.
pub trait LogStream {
    /// Returns the next line, or [`LogEvent::Quiet`] after `wait`.
    fn next(&mut self, wait: Duration) -> LogEvent;
}

/// One device.
pub trait Device: Send {
    /// The device's serial number, as adb lists it.
    fn serial(&self) -> &str;

    /// Runs a command on the device, given as words, and returns its output.
    fn shell(&self, words: &[&str]) -> Result<String, DeviceError>;

    /// Writes a small file on the device.
    fn put(&self, path: &str, text: &str) -> Result<(), DeviceError>;

    /// Installs an APK, replacing an installed version.
    fn install(&self, apk: &Path) -> Result<(), DeviceError>;

    /// Follows the device's log for the tags of [`super::log`], with times in seconds since 1970. Starts at the first
    /// line at or after `since`, or at the oldest line that the device still has.
    fn logcat(&self, since: Option<&str>) -> Result<Box<dyn LogStream>, DeviceError>;

    /// Tries to reconnect a lost device. The next command shows whether this worked.
    fn reconnect(&self);

    /// Returns the seconds since 1970 by this computer's clock. It never jumps.
    fn now(&self) -> f64;

    /// Sleeps for `time`, or until the user interrupts the program.
    fn sleep(&self, time: Duration);
}

/// The source of devices.
pub trait Adb {
    /// Returns the connected devices in adb's order.
    fn devices(&self) -> Result<Vec<Listed>, DeviceError>;

    /// Returns the device with this name in adb's list. If it is not connected, its commands fail.
    fn open(&self, serial: &str) -> Box<dyn Device>;
}

/// Returns the chosen devices: those with the given serial numbers, all of them, or the only one. If a device is
/// connected both by cable and by Wi-Fi, the connection that adb lists first is used.
///
/// # Errors [`DeviceError`] if there is no device, several without a choice, an unknown serial number, or one that is
/// not ready.
pub fn choose(adb: &dyn Adb, serials: &[String], all: bool) -> Result<Vec<Box<dyn Device>>, DeviceError> {
    let listed = adb.devices()?;
    let find = |serial: &String| {
        let found = listed.iter().find(|device| device.serial == *serial);
        found.ok_or_else(|| DeviceError::Unknown(serial.clone()))
    };
    let open = |chosen: &[&Listed]| {
        let opened = chosen.iter().map(|device| ready(device).map(|()| adb.open(&device.serial)));
        once_each(opened.collect::<Result<_, _>>()?)
    };
    match (serials, &listed[..]) {
        ([], []) => Err(DeviceError::NoDevice),
        ([], [one]) => open(&[one]),
        ([], several) if all => open(&several.iter().collect::<Vec<_>>()),
        ([], several) => {
            // Devices that cannot be used do not make the choice ambiguous.
            let ready: Vec<&Listed> = several.iter().filter(|device| device.state == State::Ready).collect();
            match open(&ready)? {
                one if one.len() == 1 => Ok(one),
                _ => {
                    let serials = several.iter().map(|device| device.serial.clone()).collect();
                    Err(DeviceError::Several { serials })
                }
            }
        }
        (serials, _) => open(&serials.iter().map(find).collect::<Result<Vec<_>, _>>()?),
    }
}

/// Removes further connections of the same device.
fn once_each(devices: Vec<Box<dyn Device>>) -> Result<Vec<Box<dyn Device>>, DeviceError> {
    if devices.len() < 2 {
        return Ok(devices);
    }
    let mut chosen: Vec<(String, Box<dyn Device>)> = Vec::new();
    for device in devices {
        let own = serial_number(&*device)?;
        match chosen.iter().find(|(known, _)| *known == own) {
            Some((_, known)) if known.serial() == device.serial() => {}
            Some((_, known)) => ::log::warn!(
                "{} and {} are the same device: {} is used",
                known.serial(),
                device.serial(),
                known.serial()
            ),
            None => chosen.push((own, device)),
        }
    }
    Ok(chosen.into_iter().map(|(_, device)| device).collect())
}

fn ready(device: &Listed) -> Result<(), DeviceError> {
    let serial = device.serial.clone();
    match &device.state {
        State::Ready => Ok(()),
        State::Unauthorized => Err(DeviceError::Unauthorized(serial)),
        State::Offline => Err(DeviceError::Offline(serial)),
        State::NoPermission => Err(DeviceError::NoPermission(serial)),
        State::Other(state) => Err(DeviceError::NotReady { serial, state: state.clone() }),
    }
}
