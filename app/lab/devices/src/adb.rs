//! Devices, reached through the program adb.

use std::env;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::log;
use crate::DataError;
use yoro_files::interrupt;

/// Timeout of a command on the device.
const COMMAND_TIMEOUT: Duration = Duration::from_secs(60);
/// Timeout of an installation.
const INSTALL_TIMEOUT: Duration = Duration::from_secs(600);
/// Timeout of commands to the adb server, which wait for no device.
const SERVER_TIMEOUT: Duration = Duration::from_secs(20);
/// Interval at which a wait checks whether the user has interrupted the program.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Capacity of the queue of log lines. While it is full, adb waits.
const QUEUE: usize = 4096;

/// A device in adb's list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// The device's serial number, as adb lists it.
    pub serial: String,
    /// Its state in adb's words: `device` if it is ready, or `unauthorized`, `offline`, `no permissions`, `recovery`.
    pub state: String,
}

impl Listed {
    /// True if commands can be run on the device.
    pub fn is_ready(&self) -> bool {
        self.state == "device"
    }
}

/// The reason why no measurement can be made on a device: one sentence that names the remedy.
#[derive(Debug, thiserror::Error)]
pub enum DeviceError {
    /// The adb server, which runs every command, does not answer. Holds adb's words.
    #[error(
        "adb's server does not answer ({0}): restart it by adb kill-server and adb start-server, and use one version of adb only"
    )]
    Server(String),
    /// The program adb was not found, or does not start. Holds the sentence.
    #[error("{0}")]
    NoAdb(String),
    /// No device is connected.
    #[error(
        "no device is connected: turn on USB debugging in its developer options, use a data cable, and look with yoro device list"
    )]
    NoDevice,
    /// Several devices are connected and none was chosen. Holds their serial numbers.
    #[error("several devices are connected ({}): name one or some of them, or ask for all", .0.join(", "))]
    Several(Vec<String>),
    /// adb does not reach the device.
    #[error(
        "{serial} is not reached by adb ({words}): unlock it, accept this computer's key on its screen, plug it in again \
         (over Wi-Fi adb connect {serial}), and see docs/measuring.md"
    )]
    Unreached {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// adb's words: its message, or the device's state in its list.
        words: String,
    },
    /// The application is not installed.
    #[error("yoro is not installed on {serial}: yoro device install installs it")]
    NotInstalled {
        /// The device's serial number, as adb lists it.
        serial: String,
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
    /// The application cannot be installed, or the device's state would spoil a measurement. Holds the sentence.
    #[error("{0}")]
    Unfit(String),
    /// A command on the device failed.
    #[error("{serial} refuses \"{command}\" ({reason}): docs/measuring.md has the remedies")]
    Refused {
        /// The device's serial number, as adb lists it.
        serial: String,
        /// The command.
        command: String,
        /// The device's answer.
        reason: String,
    },
    /// The user has asked to stop.
    #[error("interrupted: what was captured is kept, and the same command goes on")]
    Interrupted,
    /// A run cannot be read or written.
    #[error(transparent)]
    Data(#[from] DataError),
}

impl DeviceError {
    /// True if the device may come back without help.
    pub fn is_lost(&self) -> bool {
        matches!(self, DeviceError::Unreached { .. } | DeviceError::Server(_))
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

/// True if adb reaches the device over the network: by address and port, or by a name found with mDNS, such as
/// `adb-SERIAL-x7Fw2a._adb-tls-connect._tcp`.
fn is_wireless(serial: &str) -> bool {
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

/// Returns the seconds since 1970 by this computer's clock. It never jumps.
pub fn now() -> f64 {
    static BEGIN: OnceLock<(Instant, f64)> = OnceLock::new();
    let (begin, unix) = BEGIN.get_or_init(|| {
        let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        (Instant::now(), unix.as_secs_f64())
    });
    unix + begin.elapsed().as_secs_f64()
}

/// Sleeps for `time`, or until the user interrupts the program.
pub(crate) fn sleep(time: Duration) {
    let begin = Instant::now();
    while !interrupt::requested() && begin.elapsed() < time {
        thread::sleep(POLL_INTERVAL.min(time.saturating_sub(begin.elapsed())));
    }
}

/// The program adb.
#[derive(Clone, Debug)]
pub struct Adb {
    program: PathBuf,
}

impl Adb {
    /// Finds adb and starts its server. Uses the given file, or else looks in `PATH` and in `platform-tools` of
    /// `ANDROID_HOME` and `ANDROID_SDK_ROOT`.
    pub fn find(given: Option<&Path>) -> Result<Adb, DeviceError> {
        let name = format!("adb{}", env::consts::EXE_SUFFIX);
        let program = match given {
            Some(given) => Some(given).filter(|path| path.is_file()).map(Path::to_path_buf),
            None => {
                let homes = ["ANDROID_HOME", "ANDROID_SDK_ROOT"].iter().filter_map(env::var_os);
                let homes = homes.map(|home| Path::new(&home).join("platform-tools"));
                let path = env::var_os("PATH").unwrap_or_default();
                let mut folders = env::split_paths(&path).chain(homes);
                folders.find_map(|folder| Some(folder.join(&name)).filter(|path| path.is_file()))
            }
        };
        // A program that is given without a folder would be looked for in PATH.
        let program = program.map(|path| std::path::absolute(&path).unwrap_or(path));
        let looked =
            given.map_or("PATH, ANDROID_HOME and ANDROID_SDK_ROOT".into(), |path| path.display().to_string());
        let missing = || {
            DeviceError::NoAdb(format!(
                "adb was not found in {looked}: install Android's platform tools (Debian and Ubuntu: apt install adb), or name its file"
            ))
        };
        let adb = Adb { program: program.ok_or_else(missing)? };
        adb.start_server()?;
        Ok(adb)
    }

    /// Starts adb's server if necessary. One started by a later command would keep that command's pipes open.
    fn start_server(&self) -> Result<(), DeviceError> {
        let mut start = Command::new(&self.program);
        start.arg("start-server").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        self.run(start, None, SERVER_TIMEOUT)?.map(drop).ok_or_else(|| silent_server("start-server"))
    }

    /// Runs adb and waits for it to end. Returns `None` if it does not end in time.
    fn run(
        &self,
        mut command: Command,
        input: Option<&str>,
        timeout: Duration,
    ) -> Result<Option<AdbOutput>, DeviceError> {
        let mut child = command.spawn().map_err(|error| self.does_not_start(error))?;
        if let (Some(input), Some(mut stdin)) = (input, child.stdin.take()) {
            // A command that does not read its input reports the reason itself.
            let _ = stdin.write_all(input.as_bytes());
        }
        let stdout = read_all(child.stdout.take());
        let stderr = read_all(child.stderr.take());
        let begin = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().map_err(|error| self.does_not_start(error))? {
                break status;
            }
            if begin.elapsed() > timeout {
                end(&mut child);
                return Ok(None);
            }
            thread::sleep(Duration::from_millis(2).max(begin.elapsed() / 16).min(POLL_INTERVAL));
        };
        let text = |channel: Receiver<String>| channel.recv_timeout(POLL_INTERVAL * 20).unwrap_or_default();
        Ok(Some(AdbOutput { success: status.success(), stdout: text(stdout), stderr: text(stderr) }))
    }

    fn does_not_start(&self, source: std::io::Error) -> DeviceError {
        let program = self.program.display();
        DeviceError::NoAdb(format!("{program} does not start ({source}): name another one"))
    }

    /// Returns the connected devices in adb's order.
    pub fn devices(&self) -> Result<Vec<Listed>, DeviceError> {
        let mut command = Command::new(&self.program);
        command.arg("devices").stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let said = self.run(command, None, SERVER_TIMEOUT)?.ok_or_else(|| silent_server("devices"))?;
        if said.success { Ok(listed(&said.stdout)) } else { Err(DeviceError::Server(said.reason())) }
    }

    /// Returns the device with this name in adb's list. If it is not connected, its commands fail.
    pub fn open(&self, serial: &str) -> Device {
        Device { adb: self.clone(), serial: serial.into() }
    }

    /// Returns the chosen devices: those with the given serial numbers, all of them, or the only one that is ready.
    ///
    /// # Errors
    /// [`DeviceError`] if there is no device, several without a choice, an unknown serial number, or one that is not
    /// ready.
    pub fn choose(&self, serials: &[String], all: bool) -> Result<Vec<Device>, DeviceError> {
        let listed = self.devices()?;
        if listed.is_empty() && serials.is_empty() {
            return Err(DeviceError::NoDevice);
        }
        // Devices that cannot be used do not make the choice ambiguous.
        let mut chosen = serials.to_vec();
        chosen.sort();
        chosen.dedup();
        if serials.is_empty() {
            let is_chosen = |device: &&Listed| all || listed.len() == 1 || device.is_ready();
            chosen = listed.iter().filter(is_chosen).map(|device| device.serial.clone()).collect();
            if !all && chosen.len() != 1 {
                return Err(DeviceError::Several(listed.into_iter().map(|device| device.serial).collect()));
            }
        }
        let open = |serial: &String| {
            let found = listed.iter().find(|device| device.serial == *serial);
            match found.map_or("it is not connected", |device| &device.state) {
                "device" => Ok(self.open(serial)),
                words => Err(DeviceError::Unreached { serial: serial.clone(), words: words.into() }),
            }
        };
        chosen.iter().map(open).collect()
    }
}

fn silent_server(command: &str) -> DeviceError {
    DeviceError::Server(format!("adb {command} has not ended for {} s", SERVER_TIMEOUT.as_secs()))
}

/// Parses the output of `adb devices`.
fn listed(text: &str) -> Vec<Listed> {
    let device = |line: &str| {
        let (serial, state) = line.split_once('\t')?;
        let state = state.split(';').next()?.trim();
        Some(Listed { serial: serial.trim().into(), state: state.into() })
    };
    text.lines().filter_map(device).collect()
}

/// Output of a command of adb.
struct AdbOutput {
    success: bool,
    stdout: String,
    stderr: String,
}

impl AdbOutput {
    /// Returns the reason of a failure: the first line of a Java exception, without its stack trace; otherwise the last
    /// line of stderr, or of stdout if stderr is empty.
    fn reason(&self) -> String {
        let exception = |text: &str| {
            let thrown = |line: &&str| {
                line.split_once(": ")
                    .is_some_and(|(name, _)| name.ends_with("Exception") && !name.contains(' '))
            };
            text.lines().map(str::trim).find(thrown).map(str::to_owned)
        };
        let last = |text: &str| text.lines().map(str::trim).rfind(|line| !line.is_empty()).map(str::to_owned);
        let [stderr, stdout] = [&self.stderr, &self.stdout];
        let found =
            exception(stderr).or_else(|| exception(stdout)).or_else(|| last(stderr)).or_else(|| last(stdout));
        found.unwrap_or_else(|| "it does not say why".into())
    }

    /// Returns the line in which adb itself reports an error, and not the command on the device.
    fn words_of_adb(&self) -> Option<&str> {
        let is_own = |line: &&str| {
            ["error: ", "adb: ", "adb.exe: ", "adb server "].iter().any(|w| line.starts_with(w))
        };
        self.stderr.lines().map(str::trim).find(is_own).filter(|_| !self.success)
    }
}

/// One device.
#[derive(Clone, Debug)]
pub struct Device {
    adb: Adb,
    /// The device's serial number, as adb lists it.
    pub serial: String,
}

impl Device {
    /// Returns the device's serial number, which does not depend on how it is connected. Emulators of one image all
    /// have the same number (`EMULATOR34X1X19X0`), so for them this is the name in adb's list.
    pub(crate) fn serial_number(&self) -> Result<String, DeviceError> {
        let own = self.shell(&["getprop", "ro.serialno"])?.trim().to_owned();
        let is_shared = own.is_empty() || own.starts_with("EMULATOR") || self.serial.starts_with("emulator-");
        Ok(if is_shared { self.serial.clone() } else { own })
    }

    fn command<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new(&self.adb.program);
        command.arg("-s").arg(&self.serial).args(arguments);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C in the terminal must reach this program only: it cleans up before it ends adb.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command
    }

    /// Runs adb and waits for it to end. `what` names the command in errors.
    fn finish(
        &self,
        mut command: Command,
        input: Option<&str>,
        what: &str,
        timeout: Duration,
    ) -> Result<AdbOutput, DeviceError> {
        if input.is_some() {
            command.stdin(Stdio::piped());
        }
        let said = self.adb.run(command, input, timeout)?;
        said.ok_or_else(|| self.unreached(format!("no answer to \"{what}\" for {} s", timeout.as_secs())))
    }

    fn unreached(&self, words: String) -> DeviceError {
        DeviceError::Unreached { serial: self.serial.clone(), words }
    }

    fn run_shell(&self, line: &str, input: Option<&str>) -> Result<String, DeviceError> {
        let said = self.finish(self.command(["shell", line]), input, line, COMMAND_TIMEOUT)?;
        match said.words_of_adb() {
            Some(words) => Err(self.unreached(words.to_owned())),
            None if said.success => Ok(said.stdout),
            None => Err(self.refused(line, said.reason())),
        }
    }

    pub(crate) fn refused(&self, command: &str, reason: String) -> DeviceError {
        DeviceError::Refused { serial: self.serial.clone(), command: command.into(), reason }
    }

    /// Runs a command on the device, given as words, and returns its output.
    pub fn shell(&self, words: &[&str]) -> Result<String, DeviceError> {
        self.run_shell(&words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" "), None)
    }

    /// Writes a small file on the device.
    pub(crate) fn put(&self, path: &str, text: &str) -> Result<(), DeviceError> {
        self.run_shell(&format!("cat > {}", quoted(path)), Some(text)).map(drop)
    }

    /// Installs an APK, replacing an installed version.
    pub fn install(&self, apk: &Path) -> Result<(), DeviceError> {
        let arguments = [OsStr::new("install"), OsStr::new("-r"), apk.as_os_str()];
        let said = self.finish(self.command(arguments), None, "install", INSTALL_TIMEOUT)?;
        if said.success && !said.stdout.contains("Failure") {
            return Ok(());
        }
        let all = format!("{}\n{}", said.stdout, said.stderr);
        let failure = all.lines().find_map(|line| line.split_once("Failure [")?.1.split(']').next());
        let reason = failure.map_or_else(|| said.reason(), str::to_owned);
        Err(DeviceError::Unfit(format!(
            "{} cannot be installed on {}: {reason} (docs/measuring.md has the remedies)",
            apk.display(),
            self.serial
        )))
    }

    /// Follows the device's log for the tags of [`super::log`], with times in seconds since 1970. Starts at the first
    /// line at or after `since`, or at the oldest line that the device still has.
    pub(crate) fn logcat(&self, since: Option<&str>) -> Result<LogStream, DeviceError> {
        let mut arguments = vec!["logcat", "-v", "threadtime", "-v", "epoch", "-v", "usec"];
        arguments.extend(since.iter().flat_map(|since| ["-T", since]));
        let filter = log::filter();
        arguments.extend(filter.iter().map(String::as_str));
        let mut command = self.command(arguments);
        let mut child =
            command.stderr(Stdio::null()).spawn().map_err(|error| self.adb.does_not_start(error))?;
        let (sender, lines) = mpsc::sync_channel(QUEUE);
        if let Some(stdout) = child.stdout.take() {
            thread::spawn(move || {
                let mut reader = BufReader::new(stdout);
                let mut line = Vec::new();
                while reader.read_until(b'\n', &mut line).is_ok_and(|length| length > 0) {
                    // A lost connection may cut a line. End it, so that the next line does not continue it.
                    if !line.ends_with(b"\n") {
                        line.push(b'\n');
                    }
                    if sender.send(std::mem::take(&mut line)).is_err() {
                        break;
                    }
                }
            });
        }
        Ok(LogStream { child, lines })
    }

    /// Tries to reconnect a lost device. The next command shows whether this worked.
    pub(crate) fn reconnect(&self) {
        // If this fails, the next command reports an error of the server.
        let _ = self.adb.start_server();
        let mut command = match is_wireless(&self.serial) {
            true => Command::new(&self.adb.program),
            false => self.command(["reconnect", "offline"]),
        };
        if is_wireless(&self.serial) {
            command.args(["connect", &self.serial]);
        }
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let _ = self.finish(command, None, "reconnect", COMMAND_TIMEOUT / 4);
    }
}

/// An event while a log is followed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum LogEvent {
    /// A line as it came, with its line end. Messages of drivers need not be valid UTF-8.
    Line(Vec<u8>),
    /// No line came in the time given.
    Quiet,
    /// The log has ended: the device is gone, or its log service was restarted.
    Ended,
}

/// A running `adb logcat`, which is killed when this is dropped.
pub(crate) struct LogStream {
    child: Child,
    lines: Receiver<Vec<u8>>,
}

impl LogStream {
    /// Returns the next line, or [`LogEvent::Quiet`] after `wait`.
    pub fn next(&mut self, wait: Duration) -> LogEvent {
        let begin = Instant::now();
        loop {
            match self.lines.recv_timeout(POLL_INTERVAL.min(wait)) {
                Ok(line) => return LogEvent::Line(line),
                Err(RecvTimeoutError::Disconnected) => return LogEvent::Ended,
                Err(RecvTimeoutError::Timeout) if interrupt::requested() || begin.elapsed() >= wait => {
                    return LogEvent::Quiet;
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }
}

impl Drop for LogStream {
    fn drop(&mut self) {
        end(&mut self.child);
    }
}

/// Kills a process and waits for it.
fn end(child: &mut Child) {
    // An error means that it has ended already.
    let _ = child.kill();
    let _ = child.wait();
}

/// Reads a pipe to its end on a thread, since a full pipe would stop the command.
fn read_all(pipe: Option<impl Read + Send + 'static>) -> Receiver<String> {
    let (sender, text) = mpsc::channel();
    if let Some(mut pipe) = pipe {
        thread::spawn(move || {
            let mut bytes = Vec::new();
            let _ = pipe.read_to_end(&mut bytes);
            let _ = sender.send(String::from_utf8_lossy(&bytes).into_owned());
        });
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failed(stderr: &str) -> AdbOutput {
        AdbOutput { success: false, stdout: String::new(), stderr: stderr.into() }
    }

    /// adb's messages from issues of scrcpy (1714, 3042), flutter (125971) and APK-Installer (25), and other programs'.
    #[test]
    fn adbs_own_words_mean_a_lost_device() {
        for said in [
            "error: device offline",
            "adb.exe: device 'X' not found\r",
            "adb: error: failed to get feature set: device unauthorized.\nThis adb server's $ADB_VENDOR_KEYS is not set",
            "* daemon still not running\nerror: cannot connect to daemon",
        ] {
            assert!(failed(said).words_of_adb().is_some(), "{said}");
        }
        for said in
            ["/system/bin/sh: nothing: not found", "cat: /sys/x: device offline", "Error: no device", ""]
        {
            assert!(failed(said).words_of_adb().is_none(), "{said}");
        }
    }

    /// The states as adb prints them (dadb issue 55, flutter 27456, android-udev-rules 308).
    #[test]
    fn states_in_adbs_list_are_parsed() {
        let text = "* daemon started successfully\nList of devices attached\nRF8M33XXXXX\tdevice\n1WMH\tno permissions; see [http://developer.android.com/tools/device.html]\nadb-13e75597-Upleco (2)._adb-tls-connect._tcp\tdevice\n\n";
        let found = listed(text);
        let states: Vec<&str> = found.iter().map(|device| &*device.state).collect();
        assert_eq!(states, ["device", "no permissions", "device"]);
        assert_eq!(found[2].serial, "adb-13e75597-Upleco (2)._adb-tls-connect._tcp");
    }

    /// The output of `settings put` on a phone by Xiaomi (auto_set_proxy issue 1, shortened).
    #[test]
    fn the_exception_line_is_the_reason_of_a_refusal() {
        let stderr = "\nException occurred while executing 'put':\njava.lang.SecurityException: Permission denial: writing to settings requires:android.permission.WRITE_SECURE_SETTINGS\n\tat com.android.providers.settings.SettingsProvider.call(SettingsProvider.java:398)\n";
        let reason = failed(stderr).reason();
        assert!(reason.starts_with("java.lang.SecurityException: Permission denial"), "{reason}");
        let plain =
            AdbOutput { success: false, stdout: "a\n".into(), stderr: "first\nlast: word\n\n".into() };
        assert_eq!(plain.reason(), "last: word");
    }
}
