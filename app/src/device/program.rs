//! The program adb.

use std::env;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::adb::{Adb, Device, DeviceError, Listed, LogEvent, LogStream, State};
use super::log;
use crate::cli::interrupted;

/// How long a command may take.
const PATIENCE: Duration = Duration::from_secs(60);
/// How long an installation may take.
const INSTALL_PATIENCE: Duration = Duration::from_secs(600);
/// How often a wait looks whether the user has asked to stop.
const GLANCE: Duration = Duration::from_millis(50);
/// Lines that wait to be taken; more than that, and adb waits.
const QUEUE: usize = 4096;

/// Devices by the program adb.
#[derive(Clone, Debug)]
pub struct AdbProgram {
    program: PathBuf,
}

impl AdbProgram {
    /// Finds the program (the one given, in `PATH`, or in `ANDROID_HOME`) and starts its server.
    ///
    /// # Errors
    /// [`DeviceError`].
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
        // Without its folder, a program is looked for in PATH.
        let program = program.map(|path| std::path::absolute(&path).unwrap_or(path));
        let looked = given.map_or("PATH and ANDROID_HOME".into(), |path| path.display().to_string());
        let adb = AdbProgram { program: program.ok_or(DeviceError::NoAdb { looked })? };
        // A server that a later command starts would keep that command's pipes open.
        let mut start = Command::new(&adb.program);
        start.arg("start-server").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        start.status().map_err(|error| adb.does_not_start(&error))?;
        Ok(adb)
    }

    fn does_not_start(&self, error: &std::io::Error) -> DeviceError {
        DeviceError::Start { program: self.program.clone(), reason: error.to_string() }
    }
}

impl Adb for AdbProgram {
    fn devices(&self) -> Result<Vec<Listed>, DeviceError> {
        let mut command = Command::new(&self.program);
        let output = command.arg("devices").stdin(Stdio::null()).output();
        let output = output.map_err(|error| self.does_not_start(&error))?;
        Ok(listed(&String::from_utf8_lossy(&output.stdout)))
    }

    fn open(&self, serial: &str) -> Box<dyn Device> {
        Box::new(ProgramDevice { adb: self.clone(), serial: serial.into() })
    }
}

/// The devices in what `adb devices` prints.
fn listed(text: &str) -> Vec<Listed> {
    let device = |line: &str| {
        let (serial, state) = line.split_once('\t')?;
        let state = State::from_adb(state.split_whitespace().next()?);
        Some(Listed { serial: serial.trim().into(), state })
    };
    text.lines().filter_map(device).collect()
}

struct ProgramDevice {
    adb: AdbProgram,
    serial: String,
}

/// What a command of adb has said.
struct Said {
    success: bool,
    stdout: String,
    stderr: String,
}

impl Said {
    /// Its last words, those of the error first.
    fn reason(&self) -> String {
        let last = |text: &str| text.lines().map(str::trim).rfind(|line| !line.is_empty()).map(str::to_owned);
        last(&self.stderr).or_else(|| last(&self.stdout)).unwrap_or_else(|| "it does not say why".into())
    }
}

impl ProgramDevice {
    fn command<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new(&self.adb.program);
        command.arg("-s").arg(&self.serial).args(arguments);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C in the terminal is for this program, which ends adb when it has cleaned up.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command
    }

    /// Runs adb to its end; `what` is for the error.
    fn finish(
        &self,
        mut command: Command,
        input: Option<&str>,
        what: &str,
        patience: Duration,
    ) -> Result<Said, DeviceError> {
        if input.is_some() {
            command.stdin(Stdio::piped());
        }
        let mut child = command.spawn().map_err(|error| self.adb.does_not_start(&error))?;
        if let (Some(input), Some(mut stdin)) = (input, child.stdin.take()) {
            // A command that does not take it says why by itself.
            let _ = stdin.write_all(input.as_bytes());
        }
        let stdout = read_all(child.stdout.take());
        let stderr = read_all(child.stderr.take());
        let begin = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().map_err(|error| self.adb.does_not_start(&error))? {
                break status;
            }
            if begin.elapsed() > patience {
                end(&mut child);
                let seconds = patience.as_secs();
                return Err(DeviceError::Silent {
                    serial: self.serial.clone(),
                    command: what.into(),
                    seconds,
                });
            }
            thread::sleep(Duration::from_millis(2).max(begin.elapsed() / 16).min(GLANCE));
        };
        let text = |channel: Receiver<String>| channel.recv_timeout(GLANCE * 20).unwrap_or_default();
        let said = Said { success: status.success(), stdout: text(stdout), stderr: text(stderr) };
        match self.lost(&said) {
            Some(error) if !said.success => Err(error),
            _ => Ok(said),
        }
    }

    /// What adb itself says of a device that it cannot reach.
    fn lost(&self, said: &Said) -> Option<DeviceError> {
        let serial = self.serial.clone();
        // adb says this at the begin of a line; the same words of a command on the device mean something else.
        let mut lines = said
            .stderr
            .lines()
            .filter_map(|line| line.strip_prefix("error: ").or(line.strip_prefix("adb: ")));
        lines.find_map(|line| match line {
            _ if line.contains("unauthorized") => Some(DeviceError::Unauthorized { serial: serial.clone() }),
            _ if line.contains("offline") => Some(DeviceError::Offline { serial: serial.clone() }),
            _ if line.contains("insufficient permissions") => {
                Some(DeviceError::NoPermission { serial: serial.clone() })
            }
            _ if line.contains("not found") || line.contains("no devices") || line.starts_with("closed") => {
                Some(DeviceError::Lost { serial: serial.clone() })
            }
            _ => None,
        })
    }

    fn refused(&self, command: &str, said: &Said) -> DeviceError {
        DeviceError::Refused { serial: self.serial.clone(), command: command.into(), reason: said.reason() }
    }
}

impl Device for ProgramDevice {
    fn serial(&self) -> &str {
        &self.serial
    }

    fn is_simulated(&self) -> bool {
        false
    }

    fn shell(&self, words: &[&str]) -> Result<String, DeviceError> {
        let line = words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ");
        let said = self.finish(self.command(["shell", &line]), None, &line, PATIENCE)?;
        if said.success { Ok(said.stdout) } else { Err(self.refused(&line, &said)) }
    }

    fn put(&self, path: &str, text: &str) -> Result<(), DeviceError> {
        let line = format!("cat > {}", quoted(path));
        let said = self.finish(self.command(["shell", &line]), Some(text), &line, PATIENCE)?;
        if said.success { Ok(()) } else { Err(self.refused(&line, &said)) }
    }

    fn install(&self, apk: &Path) -> Result<(), DeviceError> {
        let arguments = [OsStr::new("install"), OsStr::new("-r"), apk.as_os_str()];
        let said = self.finish(self.command(arguments), None, "install", INSTALL_PATIENCE)?;
        if said.success && !said.stdout.contains("Failure") {
            return Ok(());
        }
        let serial = self.serial.clone();
        let all = format!("{}\n{}", said.stdout, said.stderr);
        Err(if all.contains("INSUFFICIENT_STORAGE") || all.contains("No space left") {
            DeviceError::StorageFull { serial }
        } else if all.contains("UPDATE_INCOMPATIBLE") {
            DeviceError::OtherKey { serial }
        } else {
            let word = all.split(['[', ']', ':', ' ']).find(|word| word.starts_with("INSTALL_"));
            let reason = word.map_or_else(|| said.reason(), str::to_owned);
            DeviceError::Install { serial, apk: apk.into(), reason }
        })
    }

    fn logcat(&self, since: Option<&str>) -> Result<Box<dyn LogStream>, DeviceError> {
        let mut arguments = vec!["logcat", "-v", "threadtime", "-v", "epoch", "-v", "usec"];
        arguments.extend(since.iter().flat_map(|since| ["-T", since]));
        arguments.extend(log::FILTER);
        let mut command = self.command(arguments);
        let mut child =
            command.stderr(Stdio::null()).spawn().map_err(|error| self.adb.does_not_start(&error))?;
        let (sender, lines) = mpsc::sync_channel(QUEUE);
        if let Some(stdout) = child.stdout.take() {
            thread::spawn(move || {
                let mut reader = BufReader::new(stdout);
                let mut line = Vec::new();
                // What a driver logs need not be text.
                while reader.read_until(b'\n', &mut line).is_ok_and(|length| length > 0) {
                    let text = String::from_utf8_lossy(&line).trim_end_matches(['\r', '\n']).to_owned();
                    if sender.send(text).is_err() {
                        break;
                    }
                    line.clear();
                }
            });
        }
        Ok(Box::new(ProgramLog { child, lines }))
    }

    fn reconnect(&self) {
        let mut command = if self.serial.contains(':') {
            let mut command = Command::new(&self.adb.program);
            command.args(["connect", &self.serial]);
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            command
        } else {
            self.command(["reconnect", "offline"])
        };
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let _ = self.finish(command, None, "reconnect", PATIENCE / 4);
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
        while !interrupted() && begin.elapsed() < time {
            thread::sleep(GLANCE.min(time.saturating_sub(begin.elapsed())));
        }
    }
}

/// `adb logcat`, ended with this.
struct ProgramLog {
    child: Child,
    lines: Receiver<String>,
}

impl LogStream for ProgramLog {
    fn next(&mut self, wait: Duration) -> LogEvent {
        let begin = Instant::now();
        loop {
            match self.lines.recv_timeout(GLANCE.min(wait)) {
                Ok(line) => return LogEvent::Line(line),
                Err(RecvTimeoutError::Disconnected) => return LogEvent::Ended,
                Err(RecvTimeoutError::Timeout) if interrupted() || begin.elapsed() >= wait => {
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

/// Ends a process that need not have ended.
fn end(child: &mut Child) {
    // It may have ended by itself meanwhile, which is as good.
    let _ = child.kill();
    let _ = child.wait();
}

/// Reads a pipe to its end, beside everything else: a full one would stop the command.
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

/// A word as the device's shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-._/:=,%+@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
