//! The log line: `v=2,t=12.0s,method=yoro,FPS=71.9/72,Stale=1,...`.
//!
//! [`LINE_KEYS`] is the one table of its keys. It is used for writing, for reading, and wherever else a line's values
//! are used. Scripts rely on keys and units: another set of keys requires another [`VERSION`]. New keys are appended.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use super::power::BatteryStatus;
use super::text::{Field, LineError, MISSING, Reader, VERSION, word};

/// The name in the table of the second number of `FPS=a/b`, the refresh rate.
const REFRESH: &str = "FPS/";
/// The key of the GPU time per frame, which is followed by the stages' times in parentheses.
const GPU: &str = "App";
/// The most characters of an optional name; longer names are cut.
const MAX_CHARACTERS: usize = 64;

/// The GPU time of one stage.
#[derive(Clone, Debug, PartialEq)]
pub struct StageTime {
    /// Name of the pass; spaces become `-` in a line.
    pub name: String,
    /// Mean milliseconds per frame.
    pub milliseconds: f64,
}

/// One second of telemetry. Values that the device does not report are `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// Seconds since the session began.
    pub time_s: f64,
    /// Stereo method.
    pub method: String,
    /// Synthesis pipeline; missing for methods without synthesis.
    pub pipeline: Option<String>,
    /// Scene.
    pub scene: String,
    /// Frames per second.
    pub fps: Option<f64>,
    /// Refresh rate of the display in Hz.
    pub refresh_hz: Option<f64>,
    /// Number of refreshes that showed an old frame again.
    pub stale: Option<u32>,
    /// Mean time between frames in milliseconds.
    pub frame_ms: Option<f64>,
    /// The 99th percentile of the times between frames, in milliseconds.
    pub p99_ms: Option<f64>,
    /// GPU time per frame in milliseconds.
    pub gpu_ms: Option<f64>,
    /// GPU time per stage.
    pub stages: Vec<StageTime>,
    /// CPU load of the process in percent of one core.
    pub cpu_percent: Option<f64>,
    /// Resident memory in MB (10^6 bytes).
    pub rss_mb: Option<f64>,
    /// Battery current as the device reports it.
    pub current_raw: Option<i64>,
    /// Battery current in milliamperes, negative while discharging.
    pub current_ma: Option<f64>,
    /// Battery voltage in millivolts.
    pub voltage_mv: Option<i32>,
    /// Battery level in percent.
    pub level_percent: Option<i32>,
    /// Remaining charge in microampere-hours.
    pub charge_uah: Option<i64>,
    /// The kind of power supply, 0 for none.
    pub plugged: Option<i32>,
    /// Battery temperature in degrees Celsius.
    pub battery_celsius: Option<f64>,
    /// Skin temperature in degrees Celsius.
    pub skin_celsius: Option<f64>,
    /// Thermal status, 0 to 6.
    pub thermal_status: Option<i32>,
    /// Thermal headroom; 1 is severe throttling.
    pub thermal_headroom: Option<f64>,
    /// Render scale per axis; 1 is one rendered pixel per screen pixel at the lens's centre.
    pub render_scale: f64,
    /// Divisor of the ImBuffer's resolution; missing without an ImBuffer.
    pub imbuffer: Option<u32>,
    /// Number of intervals between frames in this second.
    pub frames: Option<u32>,
    /// The state of the battery.
    pub status: Option<BatteryStatus>,
    /// The name of this run in the settings.
    pub run: Option<String>,
    /// The performance modes in use: [`DeviceState::performance`](super::DeviceState::performance).
    pub performance: Option<String>,
    /// With `method=auto`, the reason for [`Line::method`], such as `6.1/8.9ms`; missing for a named method.
    pub auto: Option<String>,
}

/// One key of the line, and its value.
pub struct LineKey {
    /// The key in the line. The second number of `FPS=a/b`, the refresh rate, has the name `FPS/`.
    pub name: &'static str,
    /// Number of digits after a number's decimal point.
    pub decimals: usize,
    /// The unit after a number.
    pub unit: &'static str,
    get: fn(&Line) -> Value<'_>,
    /// Sets the value from a text without its unit, `None` for a missing value; returns false if it does not fit.
    set: fn(&mut Line, Option<&str>) -> bool,
}

/// The value of a key.
enum Value<'a> {
    Real(f64),
    Integer(i64),
    Text(&'a str),
    Missing,
}

/// Parses an optional number; `None` if the text is not a number.
fn number<T: FromStr>(text: Option<&str>) -> Option<Option<T>> {
    text.map(str::parse).transpose().ok()
}

/// Returns the first [`MAX_CHARACTERS`] of a name.
fn short(name: &str) -> &str {
    name.char_indices().nth(MAX_CHARACTERS).map_or(name, |(end, _)| &name[..end])
}

/// A key with its value: a number that may be missing or is in every line, or a name of either kind.
macro_rules! key {
    ($name:expr, $decimals:literal, $unit:literal, $get:expr, $set:expr) => {
        LineKey { name: $name, decimals: $decimals, unit: $unit, get: $get, set: $set }
    };
    (number $name:expr, $kind:ident, $field:ident, $decimals:literal, $unit:literal) => {
        key!(
            $name,
            $decimals,
            $unit,
            |line| line.$field.map_or(Value::Missing, |value| Value::$kind(value as _)),
            |line, text| number(text).map(|value| line.$field = value).is_some()
        )
    };
    (always $name:literal, $field:ident, $decimals:literal, $unit:literal) => {
        key!($name, $decimals, $unit, |line| Value::Real(line.$field), |line, text| {
            number(text).flatten().map(|value| line.$field = value).is_some()
        })
    };
    (name $name:literal, $field:ident) => {
        key!($name, 0, "", |line| Value::Text(&line.$field), |line, text| {
            line.$field = text.unwrap_or(MISSING).into();
            true
        })
    };
    (optional $name:literal, $field:ident) => {
        key!(
            $name,
            0,
            "",
            |line| line.$field.as_deref().map_or(Value::Missing, |name| Value::Text(short(name))),
            |line, text| {
                line.$field = text.map(str::to_owned);
                true
            }
        )
    };
}

/// The line's keys in order, except for the version, which comes first.
pub const LINE_KEYS: &[LineKey] = &[
    key!(always "t", time_s, 1, "s"),
    key!(name "method", method),
    key!(optional "pipeline", pipeline),
    key!(name "scene", scene),
    key!(number "FPS", Real, fps, 1, ""),
    key!(number REFRESH, Real, refresh_hz, 0, ""),
    key!(number "Stale", Integer, stale, 0, ""),
    key!(number "frame", Real, frame_ms, 2, "ms"),
    key!(number "p99", Real, p99_ms, 2, "ms"),
    key!(number GPU, Real, gpu_ms, 2, "ms"),
    key!(number "CPU", Real, cpu_percent, 1, "%"),
    key!(number "RSS", Real, rss_mb, 1, "MB"),
    key!(number "mA_raw", Integer, current_raw, 0, ""),
    key!(number "mA", Real, current_ma, 1, ""),
    key!(number "mV", Integer, voltage_mv, 0, ""),
    key!(number "level", Integer, level_percent, 0, "%"),
    key!(number "uAh", Integer, charge_uah, 0, ""),
    key!(number "plug", Integer, plugged, 0, ""),
    key!(number "Tbat", Real, battery_celsius, 1, "C"),
    key!(number "Tskin", Real, skin_celsius, 1, "C"),
    key!(number "thermal", Integer, thermal_status, 0, ""),
    key!(number "headroom", Real, thermal_headroom, 2, ""),
    key!(always "scale", render_scale, 2, ""),
    key!(number "imbuffer", Integer, imbuffer, 0, ""),
    key!(number "frames", Integer, frames, 0, ""),
    key!(
        "status",
        0,
        "",
        |line| line.status.map_or(Value::Missing, |status| Value::Text(status.name())),
        |line, text| {
            line.status = text.and_then(BatteryStatus::from_name);
            line.status.is_some() == text.is_some()
        }
    ),
    key!(optional "run", run),
    key!(optional "perf", performance),
    key!(optional "auto", auto),
];

impl LineKey {
    /// Returns the value as a number; `None` for names and missing values.
    pub fn number(&self, line: &Line) -> Option<f64> {
        match (self.get)(line) {
            Value::Real(value) => Some(value),
            Value::Integer(value) => Some(value as f64),
            Value::Text(_) | Value::Missing => None,
        }
    }

    fn write(&self, line: &Line, f: &mut Formatter) -> fmt::Result {
        match (self.get)(line) {
            Value::Real(value) => write!(f, "{value:.*}{}", self.decimals, self.unit),
            Value::Integer(value) => write!(f, "{value}{}", self.unit),
            Value::Text(name) => f.write_str(&word(name)),
            Value::Missing => f.write_str(MISSING),
        }
    }

    /// Returns the value's text in a line, with its unit.
    fn find<'a>(&self, reader: &Reader<'a>) -> Result<&'a str, LineError> {
        match self.name {
            "FPS" => Ok(rates(reader)?.0),
            REFRESH => Ok(rates(reader)?.1),
            GPU => Ok(gpu_times(reader)?.0),
            name => reader.text(name),
        }
    }

    fn read(&self, reader: &Reader, line: &mut Line) -> Result<(), LineError> {
        let text = self.find(reader)?;
        let fits = match text {
            MISSING => (self.set)(line, None),
            _ => text.strip_suffix(self.unit).is_some_and(|text| (self.set)(line, Some(text))),
        };
        let key = self.name.trim_end_matches('/');
        if fits { Ok(()) } else { Err(LineError::Value { key, value: text.into() }) }
    }
}

/// Returns the two numbers of `FPS=a/b`.
fn rates<'a>(reader: &Reader<'a>) -> Result<(&'a str, &'a str), LineError> {
    let text = reader.text("FPS")?;
    text.split_once('/').ok_or_else(|| LineError::Value { key: "FPS", value: text.into() })
}

/// Returns the frame's GPU time, and the list of the stages' times if there is one.
fn gpu_times<'a>(reader: &Reader<'a>) -> Result<(&'a str, Option<&'a str>), LineError> {
    let text = reader.text(GPU)?;
    match text.split_once('(') {
        None => Ok((text, None)),
        Some((total, list)) => match list.strip_suffix(')') {
            Some(list) => Ok((total, Some(list))),
            None => Err(LineError::Value { key: GPU, value: text.into() }),
        },
    }
}

fn read_stages(reader: &Reader) -> Result<Vec<StageTime>, LineError> {
    let Some(list) = gpu_times(reader)?.1 else { return Ok(Vec::new()) };
    let stage = |item: &str| {
        let (name, time) = item.split_once('=')?;
        Some(StageTime { name: name.into(), milliseconds: time.parse().ok()? })
    };
    let stages: Option<_> = list.split(',').map(stage).collect();
    match stages {
        Some(stages) => Ok(stages),
        None => Err(LineError::Value { key: GPU, value: reader.text(GPU)?.into() }),
    }
}

fn write_stages(stages: &[StageTime], f: &mut Formatter) -> fmt::Result {
    for (i, stage) in stages.iter().enumerate() {
        let before = if i == 0 { '(' } else { ',' };
        write!(f, "{before}{}={:.3}", word(&stage.name), stage.milliseconds)?;
    }
    if stages.is_empty() { Ok(()) } else { f.write_str(")") }
}

impl Display for Line {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "v={VERSION}")?;
        for key in LINE_KEYS {
            match key.name {
                REFRESH => f.write_str("/")?,
                name => write!(f, ",{name}=")?,
            }
            key.write(self, f)?;
            if key.name == GPU {
                write_stages(&self.stages, f)?;
            }
        }
        Ok(())
    }
}

impl FromStr for Line {
    type Err = LineError;

    fn from_str(text: &str) -> Result<Line, LineError> {
        let reader = Reader::new(text);
        if !reader.first().is_some_and(Field::is_version) {
            return Err(LineError::Version);
        }
        let mut line = Line::default();
        LINE_KEYS.iter().try_for_each(|key| key.read(&reader, &mut line))?;
        line.stages = read_stages(&reader)?;
        Ok(line)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn example() -> Line {
        Line {
            time_s: 12.0,
            method: "yoro".into(),
            pipeline: Some("gather".into()),
            scene: "prototype".into(),
            fps: Some(71.9),
            refresh_hz: Some(72.0),
            stale: Some(1),
            frame_ms: Some(13.91),
            p99_ms: Some(15.2),
            gpu_ms: Some(4.49),
            stages: vec![
                StageTime { name: "geometry".into(), milliseconds: 1.25 },
                StageTime { name: "gather-march".into(), milliseconds: 0.5 },
            ],
            current_raw: Some(-512),
            voltage_mv: Some(3921),
            plugged: Some(0),
            render_scale: 0.8,
            frames: Some(72),
            status: Some(BatteryStatus::Discharging),
            run: Some("first".into()),
            performance: Some("sustained".into()),
            auto: Some("6.1/8.9ms".into()),
            ..Line::default()
        }
    }

    #[test]
    fn a_line_is_written_and_read_in_its_documented_form() {
        assert_eq!(
            example().to_string(),
            "v=2,t=12.0s,method=yoro,pipeline=gather,scene=prototype,FPS=71.9/72,Stale=1,frame=13.91ms,p99=15.20ms,App=4.49ms(geometry=1.250,gather-march=0.500),CPU=na,RSS=na,mA_raw=-512,mA=na,mV=3921,level=na,uAh=na,plug=0,Tbat=na,Tskin=na,thermal=na,headroom=na,scale=0.80,imbuffer=na,frames=72,status=discharging,run=first,perf=sustained,auto=6.1/8.9ms"
        );
        assert_eq!(example().to_string().parse(), Ok(example()));
    }

    /// Each value once, with its own digits and unit. None of this may change without another version.
    #[test]
    fn a_line_with_every_value() {
        let line = Line {
            time_s: 3600.04,
            fps: Some(59.96),
            refresh_hz: Some(59.94),
            stale: Some(4_000_000_000),
            frame_ms: Some(16.6778),
            p99_ms: Some(17.0),
            gpu_ms: Some(6.104),
            cpu_percent: Some(141.06),
            rss_mb: Some(212.45),
            current_raw: Some(i64::MIN),
            current_ma: Some(-512.04),
            voltage_mv: Some(-1),
            level_percent: Some(87),
            charge_uah: Some(2_712_000),
            plugged: Some(2),
            battery_celsius: Some(31.25),
            skin_celsius: Some(-3.0),
            thermal_status: Some(6),
            thermal_headroom: Some(0.424),
            imbuffer: Some(4),
            status: Some(BatteryStatus::NotCharging),
            run: Some("r".repeat(70)),
            ..example()
        };
        let text = line.to_string();
        let expected = "v=2,t=3600.0s,method=yoro,pipeline=gather,scene=prototype,FPS=60.0/60,Stale=4000000000,frame=16.68ms,p99=17.00ms,App=6.10ms(geometry=1.250,gather-march=0.500),CPU=141.1%,RSS=212.4MB,mA_raw=-9223372036854775808,mA=-512.0,mV=-1,level=87%,uAh=2712000,plug=2,Tbat=31.2C,Tskin=-3.0C,thermal=6,headroom=0.42,scale=0.80,imbuffer=4,frames=72,status=not-charging,run=";
        assert_eq!(text, format!("{expected}{},perf=sustained,auto=6.1/8.9ms", "r".repeat(64)));
        let read: Line = text.parse().unwrap();
        assert_eq!(read.to_string(), text);
        assert_eq!((read.current_raw, read.stale, read.status), (line.current_raw, line.stale, line.status));
        for out_of_range in
            ["Stale=-1", "Stale=1.5", "mV=3.9", "thermal=9999999999", "scale=na", "t=nas", "t=1"]
        {
            let (key, _) = out_of_range.split_once('=').unwrap();
            let field =
                text.split(',').find(|field| field.split_once('=').is_some_and(|f| f.0 == key)).unwrap();
            assert!(text.replace(field, out_of_range).parse::<Line>().is_err(), "{out_of_range}");
        }
    }

    #[test]
    fn numbers_by_key() {
        let numbers: Vec<_> =
            LINE_KEYS.iter().filter_map(|key| Some((key.name, key.number(&example())?))).collect();
        let expected = [
            ("t", 12.0),
            ("FPS", 71.9),
            ("FPS/", 72.0),
            ("Stale", 1.0),
            ("frame", 13.91),
            ("p99", 15.2),
            ("App", 4.49),
            ("mA_raw", -512.0),
            ("mV", 3921.0),
            ("plug", 0.0),
            ("scale", 0.8),
            ("frames", 72.0),
        ];
        assert_eq!(numbers, expected);
    }

    #[test]
    fn unknown_values_are_na_and_not_zero() {
        let empty = Line { method: "yoro".into(), scene: "x".into(), ..Line::default() };
        let text = empty.to_string();
        assert_eq!(text.matches("na").count(), 25, "{text}");
        assert_eq!(text.parse(), Ok(empty));
    }

    #[test]
    fn names_cannot_break_the_line() {
        let line = Line { method: "a,b=c(d".into(), scene: "na".into(), ..example() };
        let read: Line = line.to_string().parse().unwrap();
        assert_eq!((read.method.as_str(), read.scene.as_str()), ("a-b-c-d", "-"));
    }

    #[test]
    fn damaged_lines_say_where() {
        let text = example().to_string();
        assert_eq!("FPS=72/72".parse::<Line>(), Err(LineError::Version));
        assert_eq!("".parse::<Line>(), Err(LineError::Version));
        assert_eq!(text[..40].parse::<Line>(), Err(LineError::Missing("scene")));
        assert_eq!(text[..80].parse::<Line>(), Err(LineError::Missing("frame")));
        assert!(text.replace("discharging", "disch").parse::<Line>().is_err());
        let twisted = text.replace("3921", "39x1").parse::<Line>();
        assert_eq!(twisted, Err(LineError::Value { key: "mV", value: "39x1".into() }));
        assert!(text.replace(")", "").parse::<Line>().is_err());
    }

    fn rounded(decimals: i32) -> impl Strategy<Value = Option<f64>> {
        let scale = 10f64.powi(decimals);
        proptest::option::of(-1_000_000i32..1_000_000).prop_map(move |n| n.map(|n| n as f64 / scale))
    }

    proptest! {
        /// No stage is named `na`, which stands for a missing value.
        #[test]
        fn parameters_survive_a_round_trip(
            fps in rounded(1), frame in rounded(2), mah in rounded(1), headroom in rounded(2),
            raw in proptest::option::of(any::<i64>()), stale in proptest::option::of(any::<u32>()),
            level in proptest::option::of(any::<i32>()), names in proptest::collection::vec("[a-m][a-z-]{0,8}", 0..6),
        ) {
            let stages: Vec<_> = names.into_iter().map(|name| StageTime { name, milliseconds: 0.125 }).collect();
            let line = Line {
                fps, frame_ms: frame, current_ma: mah, thermal_headroom: headroom, current_raw: raw, stale,
                level_percent: level, stages, ..example()
            };
            prop_assert_eq!(line.to_string().parse(), Ok(line));
        }

        #[test]
        fn damaged_lines_never_panic(at in 0usize..300, with in ".{0,3}", cut in 0usize..300) {
            let mut text = example().to_string();
            let at = at.min(text.len());
            text.insert_str(at, &with);
            let cut = (0..=cut.min(text.len())).rev().find(|&n| text.is_char_boundary(n)).unwrap_or(0);
            let _ = text.parse::<Line>();
            let _ = text[..cut].parse::<Line>();
        }
    }
}
