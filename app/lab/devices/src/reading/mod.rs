//! Turns the lines of a log into samples and faults.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use crate::capture::{Fault, FaultKind, Sample};
use crate::log::{self, Entry, Kind, VRAPI_TAG};
use yoro_settings::telemetry::{BatteryStatus, LOG_TAG, Line, fields};

/// A line is a clock jump if the device's clock and the session's time have advanced by amounts that differ by more
/// than this many seconds. Lines are logged some frames after their second ends.
const JUMP_S: f64 = 2.0;
/// Lines are missing between two lines of a session that are further apart than this many seconds.
const GAP_S: f64 = 1.8;
/// Lowest thermal status of Android at which the device throttles (`THERMAL_STATUS_MODERATE`).
const THROTTLED: i32 = 2;
/// Minimum voltage that is taken for millivolts. Some phones give whole volts, which are too coarse for power.
pub(crate) const LEAST_MILLIVOLTS: f64 = 100.0;
/// Maximum plausible time in seconds between the last line of a session and the first line of the next.
const LONGEST_PAUSE_S: f64 = 3600.0;
/// Values of the current that stand for a missing one: those of Meta's tools, and the limits of integer types.
const PLACEHOLDERS: [i64; 5] = [9_999, 9_999_000, i32::MIN as i64, i32::MAX as i64, i64::MIN];

/// The content of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum LineContent {
    /// The sample of a second.
    Sample(Box<Sample>),
    /// The summary at the end of a session.
    Summary,
    /// A line that cannot be parsed, and the reason.
    Damaged(String),
    /// A line without measurements, or one of another tag or run.
    Other,
}

/// A counter, and the time of the first occurrence.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    times: u64,
    first_s: Option<f64>,
}

impl Count {
    fn add(&mut self, times: u64, at_s: f64) {
        if times > 0 {
            self.times = self.times.saturating_add(times);
            self.first_s.get_or_insert(at_s);
        }
    }
}

/// One start of the application and its lines.
#[derive(Clone, Copy, Debug)]
struct Session {
    pid: Option<u32>,
    /// Offset in seconds from the session's time to the run's time.
    offset_s: f64,
    /// The session's own time at its last line.
    last_s: f64,
    /// The device's clock at the session's last line.
    clock_s: Option<f64>,
}

/// Reads a log line by line. Time 0 is the first frame of the first session.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The run whose lines are read, or `None` for all lines.
    run: Option<String>,
    session: Option<Session>,
    /// Values of Meta's runtime since the last sample, by key.
    runtime: BTreeMap<String, String>,
    /// Time of the last sample.
    time_s: f64,
    methods: Vec<(String, String)>,
    /// True if the log consists of bare messages. `None` until a line has been recognised.
    is_raw: Option<bool>,
    /// Lines before that: damaged ones, or other messages of a raw log.
    unknown: u64,

    seconds: u64,
    damaged: Count,
    /// Damaged lines since the last good line. They are not counted as missing again.
    damaged_now: u64,
    missing: Count,
    plugged: Count,
    /// Seconds with battery values, seconds with a current, and seconds with a current of 0.
    judged: u64,
    with_current: u64,
    zero: u64,
    placeholder: Option<i64>,
    volts: Count,
    milliamperes: Count,
    positive: Count,
    throttled: Count,
    jumps: Vec<(f64, f64)>,
    restarts: Vec<(f64, f64)>,
}

impl Reading {
    /// Creates a reader of the lines of this run, or of all lines.
    pub fn new(run: Option<String>) -> Reading {
        Reading { run, ..Reading::default() }
    }

    /// Returns the time of the last sample in seconds since the run began.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Returns the number of samples.
    pub fn samples(&self) -> u64 {
        self.seconds
    }

    /// True if a line of the log has been recognised.
    pub fn has_read(&self) -> bool {
        self.is_raw.is_some()
    }

    /// Returns the number of damaged lines.
    pub fn damaged(&self) -> u64 {
        self.damaged.times
    }

    /// Returns the methods and scenes in the log, in order of their first lines.
    pub fn methods(&self) -> &[(String, String)] {
        &self.methods
    }

    /// Reads a line of logcat. `passed_s` is the time since the line before it by this computer's clock, if known. It
    /// is used where the device's clock is implausible.
    pub fn line(&mut self, line: &str, passed_s: Option<f64>) -> LineContent {
        let kind = log::parse(line);
        if let (None, Kind::Entry(entry)) = (self.is_raw, &kind) {
            let is_raw = entry.time_s.is_none() && entry.pid.is_none();
            self.is_raw = Some(is_raw);
            self.damaged.add(if is_raw { 0 } else { self.unknown }, 0.0);
        }
        match kind {
            Kind::Entry(entry) if entry.tag == LOG_TAG => self.own(&entry, passed_s),
            Kind::Entry(entry) if entry.tag == VRAPI_TAG => {
                self.runtime(entry.message);
                LineContent::Other
            }
            Kind::Entry(_) | Kind::Mark => LineContent::Other,
            Kind::Damaged => match self.is_raw {
                Some(false) => self.damage("it is no line of logcat".into()),
                Some(true) => LineContent::Other,
                None => {
                    self.unknown += 1;
                    LineContent::Other
                }
            },
        }
    }

    fn damage(&mut self, why: String) -> LineContent {
        self.damaged.add(1, self.time_s);
        self.damaged_now += 1;
        LineContent::Damaged(why)
    }

    fn own(&mut self, entry: &Entry, passed_s: Option<f64>) -> LineContent {
        let message = entry.message;
        if !message.starts_with("v=") {
            return LineContent::Other;
        }
        if message.contains(",summary=1,") {
            return LineContent::Summary;
        }
        let line: Line = match message.parse() {
            Ok(line) => line,
            Err(error) => return self.damage(format!("{error}")),
        };
        if !line.time_s.is_finite() {
            return self.damage("its time is no number".into());
        }
        if let Some(run) = &self.run {
            match line.run.as_deref() {
                Some(name) if name == run => {}
                Some(name) if !run.starts_with(name) => return LineContent::Other,
                // The run's name is the last key of a line.
                _ => return self.damage("the line has lost its end: it is cut".into()),
            }
        }
        let time_s = self.place(&line, entry, passed_s);
        let named = (line.method.clone(), line.scene.clone());
        if !self.methods.contains(&named) {
            self.methods.push(named);
        }
        self.count_anomalies(&line, time_s);
        self.time_s = time_s;
        self.seconds += 1;
        LineContent::Sample(Box::new(self.sample(line, message, time_s)))
    }

    /// Returns a line's time in the run. Records restarts, gaps and clock jumps.
    fn place(&mut self, line: &Line, entry: &Entry, passed_s: Option<f64>) -> f64 {
        let clock_s = entry.time_s;
        let damaged = std::mem::take(&mut self.damaged_now);
        let Some(session) = &mut self.session else {
            // A log may begin anywhere, so nothing is missing before the first line.
            self.session = Some(Session { pid: entry.pid, offset_s: 0.0, last_s: line.time_s, clock_s });
            return line.time_s;
        };
        let is_new = line.time_s < session.last_s || session.pid != entry.pid;
        let before_s = session.last_s + session.offset_s;
        if is_new {
            let by_clock = clock_s.zip(session.clock_s).map(|(now, then)| now - then);
            let longest = passed_s.map_or(LONGEST_PAUSE_S, |passed| passed + JUMP_S);
            let sensible = by_clock.filter(|pause| *pause >= 0.0 && *pause <= longest);
            let pause = sensible.or(passed_s).unwrap_or(1.0).max(0.0);
            self.restarts.push((before_s, pause));
            *session = Session {
                pid: entry.pid,
                offset_s: before_s + pause - line.time_s,
                last_s: line.time_s,
                clock_s,
            };
        } else {
            let by_clock = clock_s.zip(session.clock_s).map(|(now, then)| now - then);
            let jump = by_clock.map(|passed| passed - (line.time_s - session.last_s));
            if let Some(jump) = jump.filter(|jump| jump.abs() > JUMP_S) {
                self.jumps.push((before_s, jump));
            }
            session.last_s = line.time_s;
            session.clock_s = clock_s;
        }
        let time_s = line.time_s + session.offset_s;
        let gap = time_s - before_s;
        if gap > GAP_S {
            let seconds = (gap - 0.5).floor() as u64;
            self.missing.add(seconds.saturating_sub(damaged), before_s);
        }
        time_s
    }

    /// Counts the anomalies of a second, from the battery values and thermal status of its line.
    fn count_anomalies(&mut self, line: &Line, at_s: f64) {
        self.judged += 1;
        let is_idle = matches!(line.status, Some(BatteryStatus::NotCharging));
        let is_plugged = line.plugged.is_some_and(|plugged| plugged != 0) || is_idle;
        self.plugged.add(u64::from(is_plugged), at_s);
        self.throttled.add(u64::from(line.thermal_status.is_some_and(|status| status >= THROTTLED)), at_s);
        let in_volts = line.voltage_mv.is_some_and(|voltage| f64::from(voltage) < LEAST_MILLIVOLTS);
        self.volts.add(u64::from(in_volts), at_s);
        let Some(raw) = line.current_raw else { return };
        if is_placeholder(raw) {
            self.placeholder = Some(raw);
            return;
        }
        self.zero += u64::from(raw == 0);
        self.with_current += 1;
        let Some(current) = line.current_ma.filter(|current| *current != 0.0) else { return };
        let scale = (raw as f64 / current).abs();
        self.milliamperes.add(u64::from((0.5..2.0).contains(&scale)), at_s);
        self.positive.add(u64::from(current < 0.0 && raw > 0), at_s);
    }

    fn sample(&mut self, line: Line, message: &str, time_s: f64) -> Sample {
        let numbers = Sample::of(&line);
        let mut other = std::mem::take(&mut self.runtime);
        // Values that the run's description has need no column.
        let is_known = |key: &str| Sample::has_field(key) || ["v", "run", "method", "scene"].contains(&key);
        for field in fields(message).filter(|field| !is_known(field.key)) {
            if let Some(value) = field.value.filter(|value| *value != "na" && !value.is_empty()) {
                other.insert(field.key.into(), value.into());
            }
        }
        for stage in &line.stages {
            other.insert(format!("App.{}", stage.name), stage.milliseconds.to_string());
        }
        if self.methods.len() > 1 {
            other.insert("method".into(), line.method);
            other.insert("scene".into(), line.scene);
        }
        Sample {
            time_s,
            other,
            current_ma: numbers.current_ma.filter(|_| !line.current_raw.is_some_and(is_placeholder)),
            voltage_mv: numbers.voltage_mv.filter(|voltage| *voltage >= LEAST_MILLIVOLTS),
            ..numbers
        }
    }

    /// Keeps the values of Meta's runtime for the application's next line. Only lines that begin with the frame rate are
    /// used; with App SpaceWarp there is a second line, which begins with `ASW=`.
    fn runtime(&mut self, message: &str) {
        if !message.starts_with("FPS=") {
            return;
        }
        self.runtime.clear();
        let mut unnamed = 0;
        for field in fields(message) {
            let (key, value) = field.value.map_or_else(
                || {
                    unnamed += 1;
                    (format!("VrApi.{unnamed}"), field.key)
                },
                |value| (format!("VrApi.{}", field.key), value),
            );
            self.runtime.insert(key, value.to_owned());
        }
    }

    /// Returns the faults found so far, in the order of [`FaultKind`].
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut add = |kind, at_s, detail| faults.push(Fault { kind, at_s, detail });
        let of = |count: Count| format!("{} of {} seconds", count.times, self.seconds);
        if self.plugged.times > 0 {
            add(FaultKind::PluggedIn, self.plugged.first_s, format!("plugged in for {}", of(self.plugged)));
        }
        let without = self.judged - self.with_current;
        if without > 0 {
            let at_s = (self.with_current > 0).then_some(0.0);
            let instead = self.placeholder.map_or(String::new(), |raw| format!("; {raw} stands for none"));
            let detail = format!("no battery current in {without} of {} seconds{instead}", self.judged);
            add(FaultKind::NoCurrent, at_s, detail);
        }
        if self.with_current > 0 && self.zero == self.with_current {
            let detail =
                format!("the battery current is 0 in all of {} seconds: it is not measured", self.zero);
            add(FaultKind::NoCurrent, None, detail);
        }
        if self.milliamperes.times > 0 {
            let detail = format!("mA in place of uA in {}; corrected", of(self.milliamperes));
            add(FaultKind::CurrentInMilliamperes, None, detail);
        }
        if self.positive.times > 0 {
            let detail = format!("positive while discharging in {}; corrected", of(self.positive));
            add(FaultKind::CurrentSign, None, detail);
        }
        for (at_s, by_s) in &self.jumps {
            let detail = format!("the device's clock jumped by {by_s:+.1} s; times are those of the session");
            add(FaultKind::ClockJump, Some(*at_s), detail);
        }
        if self.damaged.times > 0 {
            let lines = if self.damaged.times == 1 { "line" } else { "lines" };
            let detail =
                format!("{} {lines} of the log cut or damaged, left out of the samples", self.damaged.times);
            add(FaultKind::DamagedLines, self.damaged.first_s, detail);
        }
        if self.missing.times > 0 {
            let seconds = if self.missing.times == 1 { "second has" } else { "seconds have" };
            let detail = format!("{} {seconds} no line in the log", self.missing.times);
            add(FaultKind::MissingLines, self.missing.first_s, detail);
        }
        for (at_s, pause_s) in &self.restarts {
            let detail = format!("the application began anew, {pause_s:.0} s after its last line");
            add(FaultKind::Restarted, Some(*at_s), detail);
        }
        if self.throttled.times > 0 {
            let detail = format!("thermal status {THROTTLED} or more in {}", of(self.throttled));
            add(FaultKind::TooWarm, self.throttled.first_s, detail);
        }
        if self.volts.times > 0 {
            let detail = format!("whole volts in place of mV in {}: too coarse for power", of(self.volts));
            add(FaultKind::VoltageInVolts, None, detail);
        }
        faults
    }
}

/// True if a current is a placeholder for a missing value.
fn is_placeholder(raw: i64) -> bool {
    PLACEHOLDERS.contains(&raw) || PLACEHOLDERS.contains(&raw.saturating_neg())
}
