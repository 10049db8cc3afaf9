//! A simulated device: its clock, its battery, its log, and the application on it.

mod shell;

use std::collections::BTreeMap;

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::script::{Current, Fault, FaultKind, Load, Phone, Voltage};
use yoro_devices::adb::{DeviceError, State};
use yoro_devices::log;
use yoro_settings::Method;
use yoro_settings::Settings;
use yoro_settings::telemetry::{BatteryStatus, CurrentNormalizer, Line};

/// The start of every replay in seconds since 1970. It is fixed so that results do not depend on the date.
const BEGIN: f64 = 1_750_000_000.0;
/// Duration of a command in seconds.
const COMMAND_S: f64 = 0.02;
/// Seconds from the application's start to its first frame.
const LOADING_S: f64 = 1.5;
/// Power in milliwatts while no application runs.
const IDLE_MILLIWATTS: f64 = 300.0;
/// Steady rise of the temperature in degrees Celsius per watt.
const CELSIUS_PER_WATT: f64 = 5.0;
/// Time constant of the temperature in seconds: a difference has then fallen to 37 %.
const WARMING_S: f64 = 400.0;
/// Maximum random difference between runs of the same kind, as a fraction.
const VARIATION: f64 = 0.02;
/// Time in seconds that Android takes to start once the device is connected again.
const BOOT_S: f64 = 10.0;

/// Battery level in percent at which the charger is unplugged.
const CHARGED_PERCENT: f64 = 95.0;
/// A process of Meta's runtime that is not an application.
const RUNTIME_PID: u32 = 2072;
/// Property that records whether a simulated headset was told that it is worn.
pub const WORN: &str = "simulated.worn";

/// A line of the log.
struct Logged {
    clock: f64,
    text: String,
}

/// The running application.
struct Application {
    pid: u32,
    /// The package, if this is not the project's application: then only Meta's runtime logs it.
    other: Option<String>,
    settings: Settings,
    method: String,
    first_frame: f64,
    lines: u32,
    /// Random factor on the cost in this start of the application.
    variation: f64,
    normalizer: CurrentNormalizer,
    faults: Vec<Fault>,
}

impl Application {
    /// Returns the time of the next line.
    fn next_line(&self) -> f64 {
        self.first_frame + f64::from(self.lines + 1)
    }

    /// Returns the time of the next fault.
    fn next_fault(&self) -> f64 {
        self.faults.first().map_or(f64::INFINITY, |fault| self.first_frame + fault.at)
    }
}

/// The state that a device keeps while it is turned off.
struct Stored {
    settings: BTreeMap<String, String>,
    properties: BTreeMap<String, String>,
    files: BTreeMap<String, String>,
}

/// A simulated device.
pub struct SimulatedDevice {
    script: Phone,
    /// This computer's clock.
    now: f64,
    /// The device's clock minus this computer's, in seconds.
    clock_offset: f64,
    /// Time until which the device is gone, and the state in which adb lists it meanwhile.
    gone_until: f64,
    gone_as: State,
    boots: u32,
    booted_at: f64,
    starts: u32,
    installed: bool,
    application: Option<Application>,
    log: Vec<Logged>,
    /// Number of lines that the log no longer has.
    forgotten: usize,
    /// Incremented whenever readers of the log are cut off.
    generation: u32,
    stored: Stored,
    charge_mah: f64,
    celsius: f64,
    plugged_until: f64,
    throttled_until: f64,
    silent_until: f64,
    truncate: bool,
    random: Pcg64Mcg,
}

impl SimulatedDevice {
    /// Creates the device of a script.
    pub fn new(script: Phone, seed: u64) -> SimulatedDevice {
        // Give each device of a script its own random numbers.
        let own = script
            .serial
            .bytes()
            .fold(seed, |seed, byte| seed.wrapping_mul(31).wrapping_add(u64::from(byte)));
        SimulatedDevice {
            now: BEGIN,
            clock_offset: 0.25,
            gone_until: f64::NEG_INFINITY,
            gone_as: State::Offline,
            boots: 1,
            booted_at: BEGIN - 5000.0,
            starts: 0,
            installed: script.installed,
            application: None,
            log: Vec::new(),
            forgotten: 0,
            generation: 0,
            stored: Stored {
                settings: script.settings.clone(),
                properties: script.properties.clone(),
                files: BTreeMap::new(),
            },
            charge_mah: script.capacity_mah * script.level_percent / 100.0,
            celsius: script.celsius,
            plugged_until: if script.plugged { f64::INFINITY } else { f64::NEG_INFINITY },
            throttled_until: f64::NEG_INFINITY,
            silent_until: f64::NEG_INFINITY,
            truncate: false,
            random: Pcg64Mcg::seed_from_u64(own),
            script,
        }
    }

    /// Returns this computer's clock in seconds since 1970.
    pub fn now(&self) -> f64 {
        self.now
    }

    /// Returns the state in which adb lists the device, or `None` if adb does not list it.
    pub fn state(&self) -> Option<State> {
        let state = State::from_adb(&self.script.state);
        if state != State::Ready {
            return Some(state);
        }
        if self.now >= self.gone_until {
            return Some(State::Ready);
        }
        (self.gone_as == State::Unauthorized).then_some(State::Unauthorized)
    }

    /// Lets the time of a command pass. Returns an error if the device does not answer.
    pub fn reach(&mut self) -> Result<(), DeviceError> {
        let serial = self.script.serial.clone();
        self.advance(self.now + COMMAND_S);
        match self.state() {
            Some(State::Ready) => Ok(()),
            Some(State::Unauthorized) => Err(DeviceError::Unauthorized(serial)),
            Some(_) => Err(DeviceError::Offline(serial)),
            None => Err(DeviceError::Lost(serial)),
        }
    }

    /// Lets time pass until `to`.
    pub fn advance(&mut self, to: f64) {
        while self.now < to {
            self.step(to);
        }
    }

    /// Lets time pass until something happens, at most until `limit`.
    fn step(&mut self, limit: f64) {
        let next = |a: &Application| a.next_line().min(a.next_fault());
        let to = self.application.as_ref().map_or(f64::INFINITY, next).min(limit).max(self.now);
        let passed = to - self.now;
        self.now = to;
        self.discharge(passed);
        let is_due = |time: fn(&Application) -> f64| self.application.as_ref().is_some_and(|a| time(a) <= to);
        if is_due(Application::next_fault) {
            self.apply_fault();
        } else if is_due(Application::next_line) {
            self.log_second();
        }
    }

    /// Returns the application's current cost.
    fn load(&self, application: &Application) -> Load {
        let load = self.script.load.get(&application.method).copied().unwrap_or_default();
        // The cost of a scene is derived from its name, and is the same factor for all methods.
        let name: u32 = application.settings.scene.bytes().map(u32::from).sum();
        let weight = (0.85 + 0.3 * f64::from(name % 100) / 100.0) * application.variation;
        Load { frame_ms: load.frame_ms * weight, milliwatts: load.milliwatts * weight }
    }

    fn level_percent(&self) -> f64 {
        if self.script.capacity_mah == 0.0 {
            return self.script.level_percent;
        }
        100.0 * self.charge_mah / self.script.capacity_mah
    }

    /// Returns the voltage as the device reports it.
    fn voltage(&self) -> f64 {
        match self.script.voltage {
            Voltage::Millivolts => self.volts() * 1e3,
            Voltage::Volts => self.volts().floor(),
        }
    }

    /// Returns the current in milliamperes, negative while discharging.
    fn milliamperes(&self) -> f64 {
        if self.now < self.plugged_until {
            return 1500.0;
        }
        -self.application.as_ref().map_or(IDLE_MILLIWATTS, |a| self.load(a).milliwatts) / self.volts()
    }

    fn volts(&self) -> f64 {
        3.5 + 0.7 * self.level_percent() / 100.0
    }

    fn discharge(&mut self, seconds: f64) {
        let milliwatts = self.application.as_ref().map_or(IDLE_MILLIWATTS, |a| self.load(a).milliwatts);
        let watts = milliwatts / 1e3;
        let hours = seconds / 3600.0;
        if self.now < self.plugged_until {
            self.charge_mah = (self.charge_mah + 1500.0 * hours).min(self.script.capacity_mah);
        } else {
            self.charge_mah = (self.charge_mah - watts / self.volts() * 1e3 * hours).max(0.0);
        }
        if let Some(percent) = self.script.charged_below {
            if self.level_percent() >= CHARGED_PERCENT {
                self.plugged_until = f64::NEG_INFINITY;
            } else if self.application.is_none() && self.level_percent() < percent {
                self.plugged_until = f64::INFINITY;
            }
        }
        let end = self.script.ambient_celsius + CELSIUS_PER_WATT * watts;
        self.celsius = end + (self.celsius - end) * (-seconds / WARMING_S).exp();
    }

    fn apply_fault(&mut self) {
        let Some(application) = &mut self.application else { return };
        let fault = application.faults.remove(0);
        let until = fault.seconds.map_or(f64::INFINITY, |seconds| self.now + seconds);
        match fault.kind {
            FaultKind::Disconnect | FaultKind::Unauthorized => {
                self.gone_until = until;
                self.gone_as =
                    if fault.kind == FaultKind::Unauthorized { State::Unauthorized } else { State::Offline };
                self.generation += 1;
            }
            FaultKind::Reboot => {
                self.gone_until = until;
                self.gone_as = State::Offline;
                self.generation += 1;
                self.boots += 1;
                self.booted_at = until;
                self.forgotten += self.log.len();
                self.log.clear();
                self.stored.properties.retain(|name, _| !name.starts_with("debug.") && name != WORN);
                self.application = None;
            }
            FaultKind::Crash => {
                let pid = application.pid;
                self.write_log(pid, "E", "AndroidRuntime", "FATAL EXCEPTION: main");
                self.application = None;
            }
            FaultKind::LogEnds => self.generation += 1,
            FaultKind::Plug => self.plugged_until = until,
            FaultKind::ClockJump => self.clock_offset += fault.by,
            FaultKind::Truncate => self.truncate = true,
            FaultKind::Silence => self.silent_until = until,
            FaultKind::Rotate => {
                self.forgotten += self.log.len();
                self.log.clear();
            }
            FaultKind::Throttle => self.throttled_until = until,
            FaultKind::Tap => {
                let methods = &application.settings.methods;
                let at = methods.iter().position(|method| method.name() == application.method);
                application.method = methods[at.map_or(0, |at| at + 1) % methods.len()].first().name().into();
            }
        }
    }

    fn write_log(&mut self, pid: u32, priority: &str, tag: &str, message: &str) {
        let clock = self.now + self.clock_offset;
        let text = format!("{clock:17.6} {pid:5} {:5} {priority} {tag:<8}: {message}", pid + 16);
        self.log.push(Logged { clock, text: text.trim_start().into() });
    }

    /// Logs the application's line of this second, and ends the application when its duration is over.
    fn log_second(&mut self) {
        let Some(mut application) = self.application.take() else { return };
        application.lines += 1;
        let time_s = f64::from(application.lines);
        let mut line = self.generate(&mut application);
        line.time_s = time_s;
        line.run.clone_from(&application.settings.run);
        let pid = application.pid;
        let other = application.other.clone();
        let over = application.settings.duration.is_some_and(|seconds| time_s >= f64::from(seconds));
        let is_logged = self.now >= self.silent_until;
        let refresh = self.script.refresh_hz;
        if !(over && application.settings.auto_exit) {
            self.application = Some(application);
        }
        if is_logged {
            if other.is_some() {
                let text = format!("FPS=1/{refresh:.0},Stale=71,Temp=20.0C/0.0C,App=0.10ms,LCnt=1");
                self.write_log(RUNTIME_PID, "I", log::VRAPI_TAG, &text);
            }
            if self.script.vr_api || other.is_some() {
                let fps = line.fps.unwrap_or(0.0);
                let text = format!(
                    "FPS={fps:.0}/{refresh:.0},Prd=38ms,Tear=0,Early=0,Stale={},CPU4/GPU=2/2,1171/441MHz,Temp={:.1}C/0.0C,App={:.2}ms,LCnt=2(DR72,LM2)",
                    line.stale.unwrap_or(0),
                    self.celsius,
                    line.gpu_ms.unwrap_or(0.0),
                );
                self.write_log(pid, "I", log::VRAPI_TAG, &text);
            }
        }
        if is_logged && other.is_none() {
            let mut text = line.to_string();
            if std::mem::take(&mut self.truncate) {
                text.truncate(text.len() * 2 / 3);
            }
            self.write_log(pid, "I", yoro_settings::telemetry::LOG_TAG, &text);
        }
        if over {
            let text = format!("v=2,summary=1,t={time_s:.1}s,frames={:.0}", time_s * line.fps.unwrap_or(0.0));
            self.write_log(pid, "I", yoro_settings::telemetry::LOG_TAG, &text);
        }
    }

    /// Generates the line of a second from made-up values.
    fn generate(&mut self, application: &mut Application) -> Line {
        let load = self.load(application);
        let volts = self.volts();
        let mut noise = |share: f64| 1.0 + share * self.random.random_range(-1.0..1.0);
        let refresh_hz = self.script.refresh_hz;
        let gpu_ms = load.frame_ms * noise(0.03);
        let fps = (1e3 / gpu_ms).min(refresh_hz);
        let milliwatts = load.milliwatts * noise(0.04);
        let (cpu_percent, rss_mb) = (45.0 * noise(0.1), 300.0 * noise(0.01));
        let plugged = self.now < self.plugged_until;
        let (current_ma, status) = if plugged {
            (1500.0, BatteryStatus::Charging)
        } else {
            (-milliwatts / volts, BatteryStatus::Discharging)
        };
        let sign = if self.script.positive { -1.0 } else { 1.0 };
        let current_raw = match self.script.current {
            Current::Microamperes => Some((sign * current_ma * 1e3) as i64),
            Current::Milliamperes => Some((sign * current_ma) as i64),
            Current::Zero => Some(0),
            Current::Missing => None,
        };
        let plugged = Some(i32::from(plugged) * 2);
        let current_ma = current_raw.and_then(|raw| application.normalizer.add(raw, Some(status), plugged));
        let settings = &application.settings;
        let is_yoro = application.method == Method::Synthesized.name();
        Line {
            time_s: 0.0,
            method: application.method.clone(),
            pipeline: is_yoro.then(|| settings.pipeline.name().to_owned()),
            scene: settings.scene.clone(),
            fps: Some(fps),
            refresh_hz: Some(refresh_hz),
            stale: Some((refresh_hz - fps).round() as u32),
            frame_ms: Some(1e3 / fps),
            p99_ms: Some(1e3 / fps * 1.1),
            gpu_ms: Some(gpu_ms),
            stages: Vec::new(),
            cpu_percent: Some(cpu_percent),
            rss_mb: Some(rss_mb),
            current_raw,
            current_ma,
            voltage_mv: Some(self.voltage() as i32),
            level_percent: Some(self.level_percent().round() as i32),
            charge_uah: Some((self.charge_mah * 1e3) as i64),
            plugged,
            battery_celsius: Some(self.celsius),
            skin_celsius: None,
            thermal_status: Some(if self.now < self.throttled_until { 3 } else { 0 }),
            thermal_headroom: None,
            render_scale: f64::from(settings.render_scale),
            imbuffer: None,
            frames: Some(fps as u32),
            status: Some(status),
            run: None,
            performance: None,
            auto: None,
        }
    }

    /// Returns where a new reader of the log begins: at the oldest line if `since` is `None`, that many lines before
    /// the end if it is an integer, otherwise at the first line at or after that time.
    pub fn reader(&self, since: Option<&str>) -> (usize, u32) {
        let end = self.forgotten + self.log.len();
        let begin = match since {
            None => self.forgotten,
            Some(since) => match since.parse::<usize>() {
                Ok(lines) => end.saturating_sub(lines).max(self.forgotten),
                Err(_) => {
                    let since: f64 = since.parse().unwrap_or(f64::INFINITY);
                    let at = self.log.iter().position(|logged| logged.clock >= since);
                    at.map_or(end, |at| self.forgotten + at)
                }
            },
        };
        (begin, self.generation)
    }

    /// Returns the next line for a reader. Lets time pass until there is one, for at most `wait` seconds. Returns an
    /// error if the reader is cut off.
    pub fn read_log(&mut self, at: &mut usize, generation: u32, wait: f64) -> Result<Option<String>, ()> {
        let limit = self.now + wait;
        loop {
            if generation != self.generation || self.state() != Some(State::Ready) {
                return Err(());
            }
            *at = (*at).max(self.forgotten);
            if let Some(logged) = self.log.get(*at - self.forgotten) {
                *at += 1;
                return Ok(Some(logged.text.clone()));
            }
            if self.now >= limit {
                return Ok(None);
            }
            self.step(limit);
        }
    }
}
