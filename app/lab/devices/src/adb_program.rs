//! Devices reached through the program adb.

use std::env;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::adb::{Adb, Device, DeviceError, Listed, LogEvent, LogStream, State, is_wireless, quoted};
use super::log;
use yoro_files::interrupt;

/// Timeout of a command on the device.
const COMMAND_TIMEOUT: Duration = Duration::from_secs(60);
/// Timeout of an installation.
const INSTALL_TIMEOUT: Duration = Duration::from_secs(600);
/// Interval at which a wait checks whether the user has interrupted the program.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Capacity of the queue of log lines. While it is full, adb waits.
const QUEUE: usize = 4096;

/// Timeout of commands to the adb server, which wait for no device.
const SERVER_TIMEOUT: Duration = Duration::from_secs(20);

/// Devices that are reached through the program adb.
#[derive(Clone, Debug)]
pub struct AdbProgram {
    program: PathBuf,
    server_timeout: Duration,
}

impl AdbProgram {
    /// Finds adb and starts its server. Uses the given file, or else looks in `PATH` and in `platform-tools` of
    /// `ANDROID_HOME` and `ANDROID_SDK_ROOT`.
    pub fn find(given: Option<&Path>) -> Result<AdbProgram, DeviceError> {
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
        let program = program.ok_or(DeviceError::NoAdb { looked })?;
        let adb = AdbProgram { program, server_timeout: SERVER_TIMEOUT };
        adb.start_server()?;
        Ok(adb)
    }

    /// Starts adb's server if necessary. One started by a later command would keep that command's pipes open.
    fn start_server(&self) -> Result<(), DeviceError> {
        let mut start = Command::new(&self.program);
        start.arg("start-server").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        self.run(start, None, self.server_timeout)?.map(drop).ok_or_else(|| self.silent("start-server"))
    }

    /// Runs adb and waits for it to end. Returns `None` if it does not end in time.
    fn run(
        &self,
        mut command: Command,
        input: Option<&str>,
        timeout: Duration,
    ) -> Result<Option<AdbOutput>, DeviceError> {
        let mut child = command.spawn().map_err(|error| self.does_not_start(&error))?;
        if let (Some(input), Some(mut stdin)) = (input, child.stdin.take()) {
            // A command that does not read its input reports the reason itself.
            let _ = stdin.write_all(input.as_bytes());
        }
        let stdout = read_all(child.stdout.take());
        let stderr = read_all(child.stderr.take());
        let begin = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().map_err(|error| self.does_not_start(&error))? {
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

    fn silent(&self, command: &str) -> DeviceError {
        let seconds = self.server_timeout.as_secs();
        DeviceError::Server { reason: format!("adb {command} has not ended for {seconds} s") }
    }

    /// Returns the text of a line that adb itself wrote, without the prefixes `adb: `, `adb.exe: ` and `error: `.
    /// Returns `None` if the line comes from a command on the device.
    fn own_words<'a>(&self, line: &'a str) -> Option<&'a str> {
        let name = self.program.file_name().unwrap_or_default().to_string_lossy();
        let is_name = |word: &str| [&*name, "adb", "adb.exe", "error"].contains(&word);
        let mut words = line.trim();
        let mut is_own = ["adb server ", "* "].iter().any(|start| words.starts_with(start));
        while let Some((first, rest)) = words.split_once(": ")
            && is_name(first)
        {
            (words, is_own) = (rest.trim_start(), true);
        }
        is_own.then_some(words)
    }

    /// Returns an error if adb reports that it cannot reach the device. adb nests causes in its messages, such as
    /// `failed to get feature set: device offline`. File names in them are not taken for causes.
    fn unreached(&self, stderr: &str, serial: &str) -> Option<DeviceError> {
        let own = stderr.lines().filter_map(|line| self.own_words(line));
        let words = own.map(str::trim).find(|words| words.split(": ").map(str::trim).any(is_unreached))?;
        let (reason, lower) = (words.to_owned(), words.to_lowercase());
        let is_server = lower.contains("daemon") || lower.contains("server version");
        Some(match is_server {
            true => DeviceError::Server { reason },
            false => DeviceError::Unreached { serial: serial.into(), reason },
        })
    }

    fn does_not_start(&self, error: &std::io::Error) -> DeviceError {
        DeviceError::Start { program: self.program.clone(), reason: error.to_string() }
    }
}

impl Adb for AdbProgram {
    fn devices(&self) -> Result<Vec<Listed>, DeviceError> {
        let mut command = Command::new(&self.program);
        command.arg("devices").stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let said = self.run(command, None, self.server_timeout)?;
        let said = said.ok_or_else(|| self.silent("devices"))?;
        if !said.success {
            return Err(DeviceError::Server { reason: said.reason() });
        }
        Ok(listed(&said.stdout))
    }

    fn open(&self, serial: &str) -> Box<dyn Device> {
        Box::new(ProgramDevice { adb: self.clone(), serial: serial.into() })
    }
}

/// Parses the output of `adb devices`.
fn listed(text: &str) -> Vec<Listed> {
    let device = |line: &str| {
        let (serial, state) = line.split_once('\t')?;
        let state = State::from_adb(state.split_whitespace().next()?);
        Some(Listed { serial: serial.trim().into(), state })
    };
    text.lines().filter_map(device).collect()
}

/// How adb's messages about devices and servers begin that it does not reach.
const UNREACHED: [&str; 16] = [
    "device unauthorized",
    "device still authorizing",
    "device offline",
    "device still connecting",
    "device not found",
    "no devices",
    "no emulators",
    "closed",
    "protocol fault",
    "connection reset",
    "couldn't read from device",
    "cannot connect to daemon",
    "failed to check server version",
    "failed to start daemon",
    "daemon still not running",
    "adb server ",
];

/// True if a part of adb's message says that it reaches no device.
fn is_unreached(sentence: &str) -> bool {
    let lower = sentence.trim_start_matches("* ").to_lowercase();
    let is_gone = lower.starts_with("device '") && lower.trim_end_matches('.').ends_with("' not found");
    is_gone || UNREACHED.iter().any(|begin| lower.starts_with(begin))
}

struct ProgramDevice {
    adb: AdbProgram,
    serial: String,
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
}

impl ProgramDevice {
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
        let said = self.adb.run(command, input, timeout)?.ok_or_else(|| DeviceError::Silent {
            serial: self.serial.clone(),
            command: what.into(),
            seconds: timeout.as_secs(),
        })?;
        match self.adb.unreached(&said.stderr, &self.serial) {
            Some(error) if !said.success => Err(error),
            _ => Ok(said),
        }
    }

    fn refused(&self, command: &str, said: &AdbOutput) -> DeviceError {
        DeviceError::Refused { serial: self.serial.clone(), command: command.into(), reason: said.reason() }
    }
}

impl Device for ProgramDevice {
    fn serial(&self) -> &str {
        &self.serial
    }

    fn shell(&self, words: &[&str]) -> Result<String, DeviceError> {
        let line = words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ");
        let said = self.finish(self.command(["shell", &line]), None, &line, COMMAND_TIMEOUT)?;
        if said.success { Ok(said.stdout) } else { Err(self.refused(&line, &said)) }
    }

    fn put(&self, path: &str, text: &str) -> Result<(), DeviceError> {
        let line = format!("cat > {}", quoted(path));
        let said = self.finish(self.command(["shell", &line]), Some(text), &line, COMMAND_TIMEOUT)?;
        if said.success { Ok(()) } else { Err(self.refused(&line, &said)) }
    }

    fn install(&self, apk: &Path) -> Result<(), DeviceError> {
        let arguments = [OsStr::new("install"), OsStr::new("-r"), apk.as_os_str()];
        let said = self.finish(self.command(arguments), None, "install", INSTALL_TIMEOUT)?;
        if said.success && !said.stdout.contains("Failure") {
            return Ok(());
        }
        let all = format!("{}\n{}", said.stdout, said.stderr);
        let failure = all.lines().find_map(|line| line.split_once("Failure [")?.1.split(']').next());
        let reason = failure.map_or_else(|| said.reason(), str::to_owned);
        Err(DeviceError::Install { serial: self.serial.clone(), apk: apk.into(), reason })
    }

    fn logcat(&self, since: Option<&str>) -> Result<Box<dyn LogStream>, DeviceError> {
        let mut arguments = vec!["logcat", "-v", "threadtime", "-v", "epoch", "-v", "usec"];
        arguments.extend(since.iter().flat_map(|since| ["-T", since]));
        let filter = log::filter();
        arguments.extend(filter.iter().map(String::as_str));
        let mut command = self.command(arguments);
        let mut child =
            command.stderr(Stdio::null()).spawn().map_err(|error| self.adb.does_not_start(&error))?;
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
        Ok(Box::new(ProgramLog { child, lines }))
    }

    fn reconnect(&self) {
        // If this fails, the next command reports an error of the server.
        let _ = self.adb.start_server();
        let mut command = if is_wireless(&self.serial) {
            let mut command = Command::new(&self.adb.program);
            command.args(["connect", &self.serial]);
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            command
        } else {
            self.command(["reconnect", "offline"])
        };
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let _ = self.finish(command, None, "reconnect", COMMAND_TIMEOUT / 4);
    }

    fn now(&self) -> f64 {
        static BEGIN: OnceLock<(Instant, f64)> = OnceLock::new();
        let (begin, unix) = BEGIN.get_or_init(|| {
            let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
            (Instant::now(), unix.as_secs_f64())
        });
        unix + begin.elapsed().as_secs_f64()
    }

    fn sleep(&self, time: Duration) {
        let begin = Instant::now();
        while !interrupt::requested() && begin.elapsed() < time {
            thread::sleep(POLL_INTERVAL.min(time.saturating_sub(begin.elapsed())));
        }
    }
}

/// A running `adb logcat`, which is killed when this is dropped.
struct ProgramLog {
    child: Child,
    lines: Receiver<Vec<u8>>,
}

impl LogStream for ProgramLog {
    fn next(&mut self, wait: Duration) -> LogEvent {
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

impl Drop for ProgramLog {
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

    fn adb() -> AdbProgram {
        AdbProgram { program: "/usr/bin/adb-31".into(), server_timeout: SERVER_TIMEOUT }
    }

    fn unreached(stderr: &str) -> Option<DeviceError> {
        adb().unreached(stderr, "X")
    }

    /// adb's messages on Linux and Windows, from issues of scrcpy (1714, 3042), flutter (27456, 125971) and
    /// APK-Installer (25).
    #[test]
    fn adbs_words_about_lost_devices_are_recognised() {
        for said in [
            "error: device offline",
            "adb.exe: device offline",
            "adb-31: device offline",
            "error: device still authorizing\nTry 'adb kill-server' if that seems wrong.",
            "error: device still connecting",
            "adb: error: failed to get feature set: device unauthorized.\nThis adb server's $ADB_VENDOR_KEYS is not set",
            "adb.exe: error: failed to get feature set: no devices/emulators found",
            "adb: device 'X' not found",
            "adb.exe: device 'X' not found\r",
            "error: closed",
            "error: protocol fault (couldn't read status): Connection reset by peer",
            "error: cannot connect to daemon at tcp:5037: Connection refused",
            "adb server version (41) doesn't match this client (39); killing...\n* failed to start daemon",
            "adb: failed to run abb_exec. Error: cannot connect to daemon at tcp:5037: cannot connect to 127.0.0.1:5037",
            "* daemon still not running\nerror: cannot connect to daemon",
        ] {
            assert!(unreached(said).is_some_and(|error| error.is_lost()), "{said}");
        }
        let server = unreached("adb.exe: error: cannot connect to daemon").unwrap().to_string();
        assert!(server.contains("adb kill-server"), "{server}");
    }

    #[test]
    fn words_of_other_programs_mean_no_lost_device() {
        for said in [
            "adb: failed to install /home/u/offline/yoro.apk: Failure [INSTALL_FAILED_USER_RESTRICTED: no]",
            "adb: failed to install /srv/device offline/closed.apk: Failure [INSTALL_FAILED_INVALID_APK]",
            "/system/bin/sh: nothing: not found",
            "cat: /sys/x: device offline",
            "Error: device not found",
            "* daemon not running; starting now at tcp:5037\n* daemon started successfully",
            "",
        ] {
            assert!(unreached(said).is_none(), "{said}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_hanging_adb_server_times_out() {
        use std::os::unix::fs::PermissionsExt as _;

        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("adb");
        std::fs::write(&program, "#!/bin/sh\nexec sleep 60\n").unwrap();
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
        let adb = AdbProgram { program, server_timeout: Duration::from_millis(300) };
        let begin = Instant::now();
        for (result, command) in [(adb.devices().map(drop), "devices"), (adb.start_server(), "start-server")]
        {
            let error = result.unwrap_err();
            assert!(error.is_lost() && error.to_string().contains(command), "{error}");
        }
        assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
    }

    /// The states as adb prints them (dadb issue 55, flutter 27456, android-udev-rules 308).
    #[test]
    fn states_in_adbs_list_are_parsed() {
        let text = "* daemon started successfully\nList of devices attached\nRF8M33XXXXX\tdevice\n3949\tauthorizing\n1WMH\tno permissions; see [http://developer.android.com/tools/device.html]\nadb-13e75597-Upleco (2)._adb-tls-connect._tcp\tdevice\n192.168.1.7:5555\tconnecting\nUYT5\trecovery\n\n";
        let found = listed(text);
        let states: Vec<&str> = found.iter().map(|device| device.state.name()).collect();
        assert_eq!(states, ["ready", "unauthorized", "no permission", "ready", "offline", "recovery"]);
        assert_eq!(found[3].serial, "adb-13e75597-Upleco (2)._adb-tls-connect._tcp");
    }

    /// The output of `settings put` on a phone by Xiaomi (auto_set_proxy issue 1, shortened).
    #[test]
    fn the_exception_line_is_the_reason_of_a_refusal() {
        let stderr = "\nException occurred while executing 'put':\njava.lang.SecurityException: Permission denial: writing to settings requires:android.permission.WRITE_SECURE_SETTINGS\n\tat com.android.providers.settings.SettingsProvider.call(SettingsProvider.java:398)\n\tat android.os.Binder.execTransact(Binder.java:1129)\n";
        let said = AdbOutput { success: false, stdout: String::new(), stderr: stderr.into() };
        assert!(
            said.reason().starts_with("java.lang.SecurityException: Permission denial"),
            "{}",
            said.reason()
        );
        let refused = DeviceError::Refused {
            serial: "X".into(),
            command: "settings put".into(),
            reason: said.reason(),
        };
        assert!(refused.to_string().contains("USB debugging (Security settings)"), "{refused}");
        let plain =
            AdbOutput { success: false, stdout: "a\n".into(), stderr: "first\nlast: word\n\n".into() };
        assert_eq!(plain.reason(), "last: word");
    }
}
