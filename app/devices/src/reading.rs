//! From the lines of a log to samples, and to what is wrong with them.

use std::collections::BTreeMap;

use super::capture::{Fault, FaultKind, Sample};
use super::log::{self, Entry, Kind, VRAPI_TAG};
use super::phone::LEAST_MILLIVOLTS;
use yoro_protocol::telemetry::{BatteryStatus, LOG_TAG, Line, fields};

/// Of two lines in one session, the device's clock may differ by this from the session's before that is a jump, in
/// seconds: a line is logged some frames after its second has ended.
const JUMP_S: f64 = 2.0;
/// Lines of a session further apart than this, in seconds, have had others between them.
const GAP_S: f64 = 1.8;
/// From here on Android's thermal status means that the device throttles (`THERMAL_STATUS_MODERATE`).
const THROTTLED: i32 = 2;
/// Between the last line of a session and the first of the next there is not more than this, in seconds.
const LONGEST_PAUSE_S: f64 = 3600.0;
/// Values of the battery's current that stand for none: of Meta's tools, and the ends of an integer's range.
const PLACEHOLDERS: [i64; 5] = [9_999, 9_999_000, i32::MIN as i64, i32::MAX as i64, i64::MIN];

/// What a line has brought.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// A second.
    Sample(Box<Sample>),
    /// The summary at the end of a session.
    Summary,
    /// A line that cannot be read; why.
    Damaged(String),
    /// Nothing that is measured: other words, other tags, another run.
    Other,
}

/// Something that is counted, and when it was first seen.
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

/// One start of the application.
#[derive(Clone, Copy, Debug)]
struct Session {
    pid: Option<u32>,
    /// Added to the session's time for that of the run.
    offset_s: f64,
    /// The session's own time at its last line.
    last_s: f64,
    /// The device's clock at its last line.
    clock_s: Option<f64>,
}

/// Reads a log, line by line. Time starts with the first frame of the first session.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The run whose lines count; all if none.
    run: Option<String>,
    session: Option<Session>,
    /// What the runtime has said since the last sample: its own sample, should nobody else say anything.
    runtime: Option<Sample>,
    /// The clock at the first line of a log that has only the runtime's lines.
    runtime_begin: Option<f64>,
    /// Time of the last sample.
    time_s: f64,
    methods: Vec<(String, String)>,
    /// Whether the lines have nothing before the message; none until one was recognised.
    is_raw: Option<bool>,
    /// Lines before that, which are damaged, or words in a raw log.
    unknown: u64,

    seconds: u64,
    damaged: Count,
    /// Damaged lines since the last good one: their seconds are not missing on top.
    damaged_now: u64,
    missing: Count,
    plugged: Count,
    /// Seconds that say something of the battery, those with a current, and those whose current is a number but means none.
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
    /// Reads the lines that carry the name of this run, or all.
    pub fn new(run: Option<String>) -> Reading {
        Reading { run, ..Reading::default() }
    }

    /// Time of the last sample in seconds since the run began.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// How many samples there were.
    pub fn samples(&self) -> u64 {
        self.seconds
    }

    /// Whether any line was one of logcat's.
    pub fn has_read(&self) -> bool {
        self.is_raw.is_some()
    }

    /// How many damaged lines there were.
    pub fn damaged(&self) -> u64 {
        self.damaged.times
    }

    /// Whether the voltage came in whole volts, and is left out of the samples.
    pub fn has_whole_volts(&self) -> bool {
        self.volts.times > 0
    }

    /// The methods and scenes that the lines name, in the order of their first lines.
    pub fn methods(&self) -> &[(String, String)] {
        &self.methods
    }

    /// Reads a line of logcat. `passed_s` is how long by this computer's clock there was no line before it, where that is
    /// known: it stands in for the device's clock where that makes no sense.
    pub fn line(&mut self, line: &str, passed_s: Option<f64>) -> News {
        let kind = log::parse(line);
        if let (None, Kind::Entry(entry)) = (self.is_raw, &kind) {
            let is_raw = entry.time_s.is_none() && entry.pid.is_none();
            self.is_raw = Some(is_raw);
            self.damaged.add(if is_raw { 0 } else { self.unknown }, 0.0);
        }
        match kind {
            Kind::Entry(entry) if entry.tag == LOG_TAG => self.own(&entry, passed_s),
            Kind::Entry(entry) if entry.tag == VRAPI_TAG => self.runtime(&entry),
            Kind::Entry(_) | Kind::Mark => News::Other,
            Kind::Damaged => match self.is_raw {
                Some(false) => self.damage("it is no line of logcat".into()),
                Some(true) => News::Other,
                None => {
                    self.unknown += 1;
                    News::Other
                }
            },
        }
    }

    fn damage(&mut self, why: String) -> News {
        self.damaged.add(1, self.time_s);
        self.damaged_now += 1;
        News::Damaged(why)
    }

    fn own(&mut self, entry: &Entry, passed_s: Option<f64>) -> News {
        let message = entry.message;
        if !message.starts_with("v=") {
            return News::Other;
        }
        if message.contains(",summary=1,") {
            return News::Summary;
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
                Some(name) if !run.starts_with(name) => return News::Other,
                // The name is the last of the keys.
                _ => return self.damage("the line has lost its end: it is cut".into()),
            }
        }
        let time_s = self.place(&line, entry, passed_s);
        let named = (line.method.clone(), line.scene.clone());
        if !self.methods.contains(&named) {
            self.methods.push(named);
        }
        self.judge(&line, time_s);
        self.time_s = time_s;
        self.seconds += 1;
        News::Sample(Box::new(self.sample(line, message, time_s)))
    }

    /// The time of a line in the run. Notes restarts, gaps, and jumps of the clock.
    fn place(&mut self, line: &Line, entry: &Entry, passed_s: Option<f64>) -> f64 {
        let clock_s = entry.time_s;
        let damaged = std::mem::take(&mut self.damaged_now);
        let Some(session) = &mut self.session else {
            // What came before the first line is not missing: a log may begin anywhere.
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

    /// Counts what is odd about a second; of a line, its battery matters.
    pub(super) fn judge(&mut self, line: &Line, at_s: f64) {
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
        let mut other = self.runtime.take().map(|runtime| runtime.other).unwrap_or_default();
        // What the run says already needs no column.
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

    /// A line of Meta's runtime. Only those that begin with a frame rate are statistics; a second one with App SpaceWarp
    /// begins with `ASW=`. It goes with the application's next line; alone it is a sample only in a log without such
    /// lines, that of another application.
    fn runtime(&mut self, entry: &Entry) -> News {
        if !entry.message.starts_with("FPS=") {
            return News::Other;
        }
        let mut found = BTreeMap::new();
        let mut unnamed = 0;
        for field in fields(entry.message) {
            match field.value {
                Some(value) => found.insert(format!("VrApi.{}", field.key), value.to_owned()),
                None => {
                    unnamed += 1;
                    found.insert(format!("VrApi.{unnamed}"), field.key.to_owned())
                }
            };
        }
        let value = |key: &str| found.get(&format!("VrApi.{key}")).map(String::as_str);
        // Until 2020 without the display's rate; then at least the line must not end there.
        let rates = value("FPS").unwrap_or_default();
        let (fps, refresh) = match rates.split_once('/') {
            Some((fps, refresh)) => (fps.parse::<f64>(), Some(refresh.parse::<f64>())),
            None => (rates.parse::<f64>(), None),
        };
        let (Ok(fps), Ok(refresh)) = (fps, refresh.transpose()) else {
            return self.damage("the frame rate of VrApi is no number: the line is cut or damaged".into());
        };
        if refresh.is_none() && found.len() == 1 {
            return self.damage("the line of VrApi ends with its first value: it is cut".into());
        }
        let number = |text: Option<&str>, unit: &str| text?.strip_suffix(unit)?.parse::<f64>().ok();
        let begin = entry.time_s.map(|clock| *self.runtime_begin.get_or_insert(clock));
        // A log without times has at least a line a second.
        let count = self.runtime.as_ref().map_or(0.0, |before| before.time_s + 1.0);
        let time_s = entry.time_s.zip(begin).map_or(count, |(clock, begin)| clock - begin);
        let celsius = value("Temp").and_then(|text| text.split('/').next());
        let sample = Sample {
            time_s,
            fps: Some(fps),
            refresh_hz: refresh,
            stale: number(value("Stale"), ""),
            gpu_ms: number(value("App"), "ms"),
            battery_celsius: number(celsius, "C"),
            other: found,
            ..Sample::default()
        };
        let before = self.runtime.replace(sample);
        // Beside the application's own lines, two between two of them are one too many.
        if self.session.is_some() || self.run.is_some() {
            return News::Other;
        }
        before.map_or(News::Other, |before| News::Sample(Box::new(self.alone(before))))
    }

    fn alone(&mut self, sample: Sample) -> Sample {
        self.time_s = sample.time_s;
        self.seconds += 1;
        sample
    }

    /// The last sample of a log that has only the runtime's lines: each waits for a line of the application.
    pub fn end(&mut self) -> Option<Sample> {
        let last = self.runtime.take()?;
        (self.session.is_none() && self.run.is_none()).then(|| self.alone(last))
    }

    /// What was wrong up to now, in the order of [`FaultKind`].
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut add = |kind, at_s, detail| faults.push(Fault { kind, at_s, detail });
        let of = |count: Count| format!("{} of {} seconds", count.times, self.seconds);
        if self.plugged.times > 0 {
            add(FaultKind::PluggedIn, self.plugged.first_s, format!("plugged in for {}", of(self.plugged)));
        }
        // A log of the runtime alone says nothing of the battery.
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

/// Whether a current stands for none.
fn is_placeholder(raw: i64) -> bool {
    PLACEHOLDERS.contains(&raw) || PLACEHOLDERS.contains(&raw.saturating_neg())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use yoro_protocol::telemetry::BatteryStatus;

    fn line(time_s: f64) -> Line {
        Line {
            time_s,
            method: "yoro".into(),
            scene: "talk".into(),
            fps: Some(60.0),
            current_raw: Some(-512_000),
            current_ma: Some(-512.0),
            voltage_mv: Some(3900),
            plugged: Some(0),
            render_scale: 1.0,
            status: Some(BatteryStatus::Discharging),
            run: Some("r1".into()),
            ..Line::default()
        }
    }

    fn logged(clock: f64, pid: u32, text: &dyn std::fmt::Display) -> String {
        format!("{clock:.6}  {pid}  {pid} I YORO    : {text}")
    }

    fn sample(news: News) -> Sample {
        match news {
            News::Sample(sample) => *sample,
            other => panic!("{other:?}"),
        }
    }

    fn kinds(reading: &Reading) -> Vec<FaultKind> {
        reading.faults().iter().map(|fault| fault.kind).collect()
    }

    #[test]
    fn nothing_is_wrong_with_a_good_log() {
        let mut reading = Reading::new(Some("r1".into()));
        for i in 1..=60 {
            let text = logged(1e9 + i as f64, 7, &line(i as f64 * 1.02));
            assert_eq!(
                sample(reading.line(&text, None)).time_s,
                line(i as f64 * 1.02).to_string().parse::<Line>().unwrap().time_s
            );
        }
        assert_eq!((reading.samples(), reading.faults()), (60, Vec::new()));
        let other = Line { run: Some("before".into()), ..line(9.0) };
        assert_eq!(reading.line(&logged(1e9, 6, &other), None), News::Other);
        assert_eq!(reading.line("--------- beginning of main", None), News::Other);
        assert_eq!(reading.line(&logged(1e9, 7, &"yoro 0.1.0 starts"), None), News::Other);
        assert_eq!(reading.line(&logged(1e9, 7, &"v=1,summary=1,t=60.0s"), None), News::Summary);
    }

    #[test]
    fn unknown_keys_stages_and_the_runtime_are_kept() {
        let mut reading = Reading::default();
        assert_eq!(reading.line("1000000000.2 1 2 I VrApi   : FPS=70/72", None), News::Other);
        let runtime = "1000000000.5 1 2 I VrApi   : FPS=72/72,Stale=3,1171/441MHz,LCnt=2(DR72,LM2),GPU%=0.43";
        let mut text = line(1.0).to_string().replace("App=na", "App=2.00ms(march=1.500,lens=0.500)");
        let first = sample(reading.line(&logged(1e9, 7, &text), None));
        assert_eq!((first.other["VrApi.FPS"].as_str(), reading.samples()), ("70/72", 1));
        assert_eq!(reading.line(runtime, None), News::Other);
        text = text.replace("t=1.0s", "t=2.0s") + ",gaze=0.5";
        let kept = sample(reading.line(&logged(1e9 + 1.0, 7, &text), None));
        let get = |key: &str| kept.other.get(key).map(String::as_str);
        assert_eq!((get("gaze"), get("App.march"), get("scale")), (Some("0.5"), Some("1.5"), Some("1.00")));
        assert_eq!(
            (get("VrApi.Stale"), get("VrApi.1"), get("VrApi.LCnt")),
            (Some("3"), Some("1171/441MHz"), Some("2(DR72,LM2)"))
        );
        assert_eq!((kept.stale, kept.gpu_ms, get("run")), (None, Some(2.0), None));
    }

    #[test]
    fn another_application_on_a_headset() {
        let mut reading = Reading::default();
        let mut read = Vec::new();
        for i in 0..3 {
            let text = format!("100000000{i}.5 1 2 I VrApi   : FPS=71/72,Stale=3,Temp=32.2C/0.0C,App=4.49ms");
            if let News::Sample(sample) = reading.line(&text, None) {
                read.push(*sample);
            }
        }
        assert!(matches!(reading.line("1000000009.5 1 2 I VrApi   : FPS=7", None), News::Damaged(_)));
        read.extend(reading.end());
        assert_eq!(read.iter().map(|sample| sample.time_s).collect::<Vec<_>>(), [0.0, 1.0, 2.0]);
        for sample in read {
            assert_eq!((sample.fps, sample.refresh_hz, sample.stale), (Some(71.0), Some(72.0), Some(3.0)));
            assert_eq!((sample.gpu_ms, sample.battery_celsius), (Some(4.49), Some(32.2)));
        }
        assert_eq!((kinds(&reading), reading.end()), (vec![FaultKind::DamagedLines], None));
    }

    #[test]
    fn figures_of_the_battery_that_mean_none() {
        let read = |change: fn(&mut Line)| {
            let mut reading = Reading::default();
            let mut last = Sample::default();
            for i in 1..=3 {
                let mut line = line(i as f64);
                change(&mut line);
                last = sample(reading.line(&logged(1e9 + i as f64, 7, &line), None));
            }
            let faults = reading.faults();
            (last, faults.iter().map(|fault| (fault.kind, fault.detail.clone())).collect::<Vec<_>>())
        };
        use FaultKind::{NoCurrent, PluggedIn, VoltageInVolts};
        // Phones that give EXTRA_VOLTAGE in whole volts (PlusPlusBattery issue 5, home-assistant/android 4286).
        let (volts, faults) = read(|line| line.voltage_mv = Some(4));
        assert_eq!((volts.voltage_mv, faults.len(), faults[0].0), (None, 1, VoltageInVolts));
        let (_, faults) = read(|line| (line.current_raw, line.current_ma) = (Some(0), None));
        assert!(faults.len() == 1 && faults[0].0 == NoCurrent && faults[0].1.contains("is 0"), "{faults:?}");
        // OVR Metrics Tool's placeholder, and Integer.MIN_VALUE (home-assistant/android 4977).
        for raw in [9999, -9999, -2_147_483_648] {
            let mut reading = Reading::default();
            let line = Line { current_raw: Some(raw), current_ma: Some(raw as f64), ..line(1.0) };
            assert_eq!(sample(reading.line(&logged(1e9, 7, &line), None)).current_ma, None);
            let faults = reading.faults();
            assert!(faults.len() == 1 && faults[0].detail.contains(&raw.to_string()), "{faults:?}");
        }
        let (_, faults) = read(|line| line.status = Some(BatteryStatus::NotCharging));
        assert_eq!((faults.len(), faults[0].0), (1, PluggedIn));
    }

    /// Statistics as headsets logged them: Quest 2 in 2020 (soundstagevr issue 34), App SpaceWarp (Meta's guide to it),
    /// and other lines of the same tags (GearVRf issue 383, Meta's guide to logcat), all but the first shortened.
    #[test]
    fn lines_of_metas_runtime() {
        let mut reading = Reading::default();
        let mut seconds = Vec::new();
        for text in [
            "11-12 18:46:09.356  3579  3669 I VrApi   : FPS=52,Prd=49ms,Tear=0,Early=0,Stale=65,VSnc=1,Lat=1,Fov=0D,CPU4/GPU=4/3,1478/490MHz,OC=FF,TA=0/0/0,SP=N/N/N,Mem=1555MHz,Free=3179MB,PSM=0,PLS=0,Temp=34.7C/0.0C,TW=1.17ms,App=21.69ms,GD=0.00ms,CPU&GPU=31.47ms,LCnt=1,GPU%=0.99,CPU%=0.29(W0.30),DSF=1.00",
            "11-12 18:46:10.350  3579  3669 I VrApi   : FPS=36/72,Prd=39ms,Stale=0,Temp=44.5C/0.0C,App=11.42ms,LCnt=1",
            "11-12 18:46:10.351  3579  3669 I VrApi   : ASW=72, Type=App E=-0.000/0.250,D=0.000/0.000",
            "11-12 18:46:10.400  2072  2090 I XrPerformanceManager: SetClockLevels: Apply pending clock request change: 4,3 -> 3,3",
            "11-12 18:46:10.500: I/VrApi(24826): SetVrSystemPerformance( 2, 2 )",
        ] {
            if let News::Sample(sample) = reading.line(text, None) {
                seconds.push(*sample);
            }
        }
        seconds.extend(reading.end());
        let rates: Vec<_> =
            seconds.iter().map(|sample| (sample.fps, sample.refresh_hz, sample.gpu_ms)).collect();
        assert_eq!(rates, [(Some(52.0), None, Some(21.69)), (Some(36.0), Some(72.0), Some(11.42))]);
        assert_eq!((reading.damaged(), reading.faults()), (0, Vec::new()));
    }

    #[test]
    fn each_fault_has_its_name() {
        let mut reading = Reading::new(Some("r1".into()));
        let mut put = |clock: f64, pid: u32, line: &Line| reading.line(&logged(1e9 + clock, pid, line), None);
        put(1.0, 7, &line(1.0));
        // The clock goes back an hour, the session does not.
        put(2.0 - 3600.0, 7, &line(2.0));
        let cut = logged(1e9 + 3.0 - 3600.0, 7, &line(3.0));
        put(4.0 - 3600.0, 7, &Line { plugged: Some(2), ..line(4.0) });
        put(7.0 - 3600.0, 7, &Line { current_raw: Some(512), ..line(7.0) });
        put(
            8.0 - 3600.0,
            7,
            &Line { current_raw: None, current_ma: None, thermal_status: Some(3), ..line(8.0) },
        );
        // A new session after twenty seconds.
        let again = put(28.0 - 3600.0, 8, &line(1.0));
        assert_eq!(sample(again).time_s, 28.0);
        let run = cut.find("run=").unwrap();
        assert!(matches!(reading.line(&cut[..run + 4], None), News::Damaged(_)));
        assert!(matches!(reading.line(&cut[..60], None), News::Damaged(_)));
        use FaultKind::*;
        assert_eq!(
            kinds(&reading),
            [
                PluggedIn,
                NoCurrent,
                CurrentInMilliamperes,
                CurrentSign,
                ClockJump,
                DamagedLines,
                MissingLines,
                Restarted,
                TooWarm
            ]
        );
        let faults = reading.faults();
        assert!(faults[4].detail.contains("-3600.0 s"), "{faults:?}");
        assert_eq!((faults[4].at_s, faults[6].at_s), (Some(1.0), Some(2.0)));
        // 3, 5 and 6, and 9 to 27.
        assert!(faults[6].detail.starts_with("22 seconds"), "{faults:?}");
    }

    #[test]
    fn what_is_damaged_depends_on_the_format() {
        let text = line(1.0).to_string();
        let of = |lines: &[&str]| {
            let mut reading = Reading::default();
            lines.iter().for_each(|line| drop(reading.line(line, None)));
            (reading.samples(), reading.damaged())
        };
        // Only messages: other words are messages, too.
        assert_eq!(of(&["yoro 0.1.0 starts", &text, "rating,v=1", &text[..50]]), (1, 1));
        let full = logged(1e9, 7, &text);
        assert_eq!(of(&["00I YORO    : v=1", &full, "10000000"]), (1, 2));
        assert_eq!(of(&["nothing", "of ours"]), (0, 0));
    }

    #[test]
    fn a_damaged_second_is_not_missing_as_well() {
        let mut reading = Reading::default();
        for i in 1..=5 {
            let text = logged(1e9 + i as f64, 7, &line(i as f64));
            reading.line(if i == 3 { &text[..80] } else { &text }, None);
        }
        assert_eq!(kinds(&reading), [FaultKind::DamagedLines]);
    }

    #[test]
    fn a_clock_without_sense_gives_way_to_this_computers() {
        let mut reading = Reading::default();
        reading.line(&logged(1e9, 7, &line(50.0)), None);
        let after = sample(reading.line(&logged(5.0, 3, &line(1.0)), Some(40.0)));
        assert_eq!(after.time_s, 90.0);
    }

    proptest! {
        #[test]
        fn damaged_logs_never_panic(lines in proptest::collection::vec((0usize..400, ".{0,4}", any::<bool>()), 1..12)) {
            let mut reading = Reading::new(Some("r1".into()));
            let mut seen = 0;
            for (i, (at, with, cut)) in lines.iter().enumerate() {
                let mut text = logged(1e9 + i as f64, 7, &line(i as f64));
                let at = (*at).min(text.len());
                if *cut { text.truncate(at) } else { text.insert_str(at, with) }
                // Each line is a sample, or damaged, or says nothing.
                seen += match reading.line(&text, None) { News::Sample(_) => 1, _ => 0 };
            }
            prop_assert_eq!(reading.samples(), seen);
            let _ = reading.faults();
        }
    }
}
