//! The log line: `v=1,t=12.0s,method=yoro,FPS=71.9/72,Stale=1,...`.
//!
//! Keys and units are a promise to scripts: changing one needs another [`VERSION`]; new keys go to the end.

use std::fmt::{self, Display};
use std::str::FromStr;

use super::power::BatteryStatus;

/// The first field of every line.
pub const VERSION: u32 = 1;
/// What stands for a missing value.
pub(super) const MISSING: &str = "na";

/// GPU time of one stage.
#[derive(Clone, Debug, PartialEq)]
pub struct StageTime {
    /// Name of the pass; spaces become `-` in a line.
    pub name: String,
    /// Milliseconds per frame, on average.
    pub milliseconds: f64,
}

/// One second of telemetry. `None` is a value that the device does not give.
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
    /// Refreshes that showed an old frame again.
    pub stale: Option<u32>,
    /// Mean time between frames in milliseconds.
    pub frame_ms: Option<f64>,
    /// 99 % of the times between frames are below, in milliseconds.
    pub p99_ms: Option<f64>,
    /// GPU time per frame in milliseconds.
    pub gpu_ms: Option<f64>,
    /// GPU time per stage.
    pub stages: Vec<StageTime>,
    /// CPU load of the process in percent of one core.
    pub cpu_percent: Option<f64>,
    /// Resident memory in MB (10^6 bytes).
    pub rss_mb: Option<f64>,
    /// Battery current as the device gave it.
    pub current_raw: Option<i64>,
    /// Battery current in milliamperes, negative while discharging.
    pub current_ma: Option<f64>,
    /// Battery voltage in millivolts.
    pub voltage_mv: Option<i32>,
    /// Battery level in percent.
    pub level_percent: Option<i32>,
    /// Remaining charge in microampere-hours.
    pub charge_uah: Option<i64>,
    /// What the device is plugged into, 0 for nothing.
    pub plugged: Option<i32>,
    /// Battery temperature in degrees Celsius.
    pub battery_celsius: Option<f64>,
    /// Skin temperature in degrees Celsius.
    pub skin_celsius: Option<f64>,
    /// Thermal status, 0 to 6.
    pub thermal_status: Option<i32>,
    /// Thermal headroom, 1 being severe.
    pub thermal_headroom: Option<f64>,
    /// Render scale per axis; 1 is one rendered pixel per screen pixel at the lens's centre.
    pub render_scale: f64,
    /// Divisor of the ImBuffer's resolution; missing without ImBuffer.
    pub imbuffer: Option<u32>,
    /// Times between frames in this second.
    pub frames: Option<u32>,
    /// Whether the battery charges.
    pub status: Option<BatteryStatus>,
    /// What the settings call this run.
    pub run: Option<String>,
}

/// Why a text is not a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LineError {
    /// It does not start with `v=1`.
    #[error(
        "the line does not start with v={VERSION}: it is no telemetry line, or one of another version of this program"
    )]
    Version,
    /// A key is missing.
    #[error("the line has no key \"{0}\": it is cut or damaged")]
    Missing(&'static str),
    /// A value does not fit its key.
    #[error("the value \"{value}\" of the key \"{key}\" cannot be read: the line is damaged")]
    Value {
        /// Key.
        key: &'static str,
        /// Text found.
        value: String,
    },
}

/// A value with so many decimals and its unit.
pub(super) struct Na<T>(pub Option<T>, pub usize, pub &'static str);

impl<T: Display> Display for Na<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.0 {
            Some(value) => write!(f, "{value:.*}{}", self.1, self.2),
            None => f.write_str(MISSING),
        }
    }
}

/// Text that cannot end its field.
pub(super) fn word(text: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "-._/".contains(c) { c } else { '-' };
    let word: String = text.chars().map(plain).collect();
    if word.is_empty() || word == MISSING { "-".into() } else { word }
}

impl Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let pipeline = self.pipeline.as_deref().map(word);
        write!(
            f,
            "v={VERSION},t={:.1}s,method={},pipeline={},scene={},FPS={}/{},Stale={},frame={},p99={},App={}",
            self.time_s,
            word(&self.method),
            Na(pipeline, 64, ""),
            word(&self.scene),
            Na(self.fps, 1, ""),
            Na(self.refresh_hz, 0, ""),
            Na(self.stale, 0, ""),
            Na(self.frame_ms, 2, "ms"),
            Na(self.p99_ms, 2, "ms"),
            Na(self.gpu_ms, 2, "ms"),
        )?;
        for (i, stage) in self.stages.iter().enumerate() {
            let before = if i == 0 { '(' } else { ',' };
            write!(f, "{before}{}={:.3}", word(&stage.name), stage.milliseconds)?;
        }
        if !self.stages.is_empty() {
            f.write_str(")")?;
        }
        write!(
            f,
            ",CPU={},RSS={},mA_raw={},mA={},mV={},level={},uAh={},plug={},Tbat={},Tskin={},thermal={},headroom={},scale={:.2},imbuffer={},frames={},status={},run={}",
            Na(self.cpu_percent, 1, "%"),
            Na(self.rss_mb, 1, "MB"),
            Na(self.current_raw, 0, ""),
            Na(self.current_ma, 1, ""),
            Na(self.voltage_mv, 0, ""),
            Na(self.level_percent, 0, "%"),
            Na(self.charge_uah, 0, ""),
            Na(self.plugged, 0, ""),
            Na(self.battery_celsius, 1, "C"),
            Na(self.skin_celsius, 1, "C"),
            Na(self.thermal_status, 0, ""),
            Na(self.thermal_headroom, 2, ""),
            self.render_scale,
            Na(self.imbuffer, 0, ""),
            Na(self.frames, 0, ""),
            Na(self.status.map(BatteryStatus::name), 64, ""),
            Na(self.run.as_deref().map(word), 64, ""),
        )
    }
}

/// One field of a line; `value` is `None` without a `=`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field<'a> {
    /// What comes before the first `=`.
    pub key: &'a str,
    /// What comes after it.
    pub value: Option<&'a str>,
}

/// Splits a line at the commas outside parentheses. Reads the lines of Meta's runtime (tag `VrApi`), too.
pub fn fields(line: &str) -> impl Iterator<Item = Field<'_>> {
    let mut depth = 0u32;
    line.trim()
        .split(move |c| {
            match c {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            c == ',' && depth == 0
        })
        .map(|field| match field.split_once('=') {
            Some((key, value)) => Field { key, value: Some(value) },
            None => Field { key: field, value: None },
        })
}

/// The fields of a line by key.
pub(super) struct Reader<'a>(Vec<Field<'a>>);

impl<'a> Reader<'a> {
    pub fn new(line: &'a str) -> Reader<'a> {
        Reader(fields(line).collect())
    }

    pub fn text(&self, key: &'static str) -> Result<&'a str, LineError> {
        let field = self.0.iter().find(|field| field.key == key);
        field.and_then(|field| field.value).ok_or(LineError::Missing(key))
    }

    pub fn optional<T: FromStr>(&self, key: &'static str, unit: &str) -> Result<Option<T>, LineError> {
        number(key, self.text(key)?, unit)
    }

    /// A key that lines of earlier programs do not have.
    fn later(&self, key: &'static str) -> &'a str {
        self.text(key).unwrap_or(MISSING)
    }

    pub fn required<T: FromStr>(&self, key: &'static str, unit: &str) -> Result<T, LineError> {
        self.optional(key, unit)?.ok_or_else(|| LineError::Value { key, value: MISSING.into() })
    }
}

fn number<T: FromStr>(key: &'static str, text: &str, unit: &str) -> Result<Option<T>, LineError> {
    if text == MISSING {
        return Ok(None);
    }
    let parsed = text.strip_suffix(unit).and_then(|number| number.parse().ok());
    parsed.map(Some).ok_or_else(|| LineError::Value { key, value: text.into() })
}

impl FromStr for Line {
    type Err = LineError;

    fn from_str(text: &str) -> Result<Line, LineError> {
        let reader = Reader::new(text);
        let version = format!("{VERSION}");
        if reader.0.first().is_none_or(|f| f.key != "v" || f.value != Some(version.as_str())) {
            return Err(LineError::Version);
        }
        let fps = reader.text("FPS")?;
        let rate = || LineError::Value { key: "FPS", value: fps.into() };
        let (fps, refresh) = fps.split_once('/').ok_or_else(rate)?;
        let app = reader.text("App")?;
        let (total, stages) = match app.split_once('(') {
            None => (app, Vec::new()),
            Some((total, list)) => {
                let damaged = || LineError::Value { key: "App", value: app.into() };
                let list = list.strip_suffix(')').ok_or_else(damaged)?;
                let stage = |item: &str| {
                    let (name, time) = item.split_once('=')?;
                    Some(StageTime { name: name.into(), milliseconds: time.parse().ok()? })
                };
                (total, list.split(',').map(stage).collect::<Option<_>>().ok_or_else(damaged)?)
            }
        };
        let status = match reader.later("status") {
            MISSING => None,
            name => {
                let damaged = || LineError::Value { key: "status", value: name.into() };
                Some(BatteryStatus::from_name(name).ok_or_else(damaged)?)
            }
        };
        Ok(Line {
            time_s: reader.required("t", "s")?,
            method: reader.text("method")?.into(),
            pipeline: Some(reader.text("pipeline")?).filter(|p| *p != MISSING).map(str::to_owned),
            scene: reader.text("scene")?.into(),
            fps: number("FPS", fps, "")?,
            refresh_hz: number("FPS", refresh, "")?,
            stale: reader.optional("Stale", "")?,
            frame_ms: reader.optional("frame", "ms")?,
            p99_ms: reader.optional("p99", "ms")?,
            gpu_ms: number("App", total, "ms")?,
            stages,
            cpu_percent: reader.optional("CPU", "%")?,
            rss_mb: reader.optional("RSS", "MB")?,
            current_raw: reader.optional("mA_raw", "")?,
            current_ma: reader.optional("mA", "")?,
            voltage_mv: reader.optional("mV", "")?,
            level_percent: reader.optional("level", "%")?,
            charge_uah: reader.optional("uAh", "")?,
            plugged: reader.optional("plug", "")?,
            battery_celsius: reader.optional("Tbat", "C")?,
            skin_celsius: reader.optional("Tskin", "C")?,
            thermal_status: reader.optional("thermal", "")?,
            thermal_headroom: reader.optional("headroom", "")?,
            render_scale: reader.required("scale", "")?,
            imbuffer: reader.optional("imbuffer", "")?,
            frames: number("frames", reader.later("frames"), "")?,
            status,
            run: Some(reader.later("run")).filter(|run| *run != MISSING).map(str::to_owned),
        })
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
            ..Line::default()
        }
    }

    #[test]
    fn a_line_as_people_read_it() {
        assert_eq!(
            example().to_string(),
            "v=1,t=12.0s,method=yoro,pipeline=gather,scene=prototype,FPS=71.9/72,Stale=1,frame=13.91ms,p99=15.20ms,App=4.49ms(geometry=1.250,gather-march=0.500),CPU=na,RSS=na,mA_raw=-512,mA=na,mV=3921,level=na,uAh=na,plug=0,Tbat=na,Tskin=na,thermal=na,headroom=na,scale=0.80,imbuffer=na,frames=72,status=discharging,run=first"
        );
        assert_eq!(example().to_string().parse(), Ok(example()));
    }

    #[test]
    fn nothing_known_is_na_and_not_zero() {
        let empty = Line { method: "yoro".into(), scene: "x".into(), ..Line::default() };
        let text = empty.to_string();
        assert_eq!(text.matches("na").count(), 23, "{text}");
        assert_eq!(text.parse(), Ok(empty));
    }

    #[test]
    fn names_cannot_break_the_line() {
        let line = Line { method: "a,b=c(d".into(), scene: "na".into(), ..example() };
        let read: Line = line.to_string().parse().unwrap();
        assert_eq!((read.method.as_str(), read.scene.as_str()), ("a-b-c-d", "-"));
    }

    #[test]
    fn a_line_of_metas_runtime_splits() {
        let line = "FPS=72/72,Prd=38ms,Stale2/5/10/max=0/0/0/0,1171/441MHz,Temp=32.2C/0.0C,CPU&GPU=12.96ms,LCnt=2(DR72,LM2),GPU%=0.43";
        let found: Vec<Field> = fields(line).collect();
        assert_eq!(found.len(), 8);
        assert_eq!(found[3], Field { key: "1171/441MHz", value: None });
        assert_eq!(found[6], Field { key: "LCnt", value: Some("2(DR72,LM2)") });
    }

    #[test]
    fn keys_that_came_later_may_be_missing() {
        let text = example().to_string();
        let (early, _) = text.split_once(",frames=").unwrap();
        let read: Line = early.parse().unwrap();
        assert_eq!(read, Line { frames: None, status: None, run: None, ..example() });
        assert!(text.replace("discharging", "disch").parse::<Line>().is_err());
    }

    #[test]
    fn damaged_lines_say_where() {
        let text = example().to_string();
        assert_eq!("FPS=72/72".parse::<Line>(), Err(LineError::Version));
        assert_eq!("".parse::<Line>(), Err(LineError::Version));
        assert_eq!(text[..40].parse::<Line>(), Err(LineError::Missing("FPS")));
        let twisted = text.replace("3921", "39x1").parse::<Line>();
        assert_eq!(twisted, Err(LineError::Value { key: "mV", value: "39x1".into() }));
        assert!(text.replace(")", "").parse::<Line>().is_err());
    }

    fn rounded(decimals: i32) -> impl Strategy<Value = Option<f64>> {
        let scale = 10f64.powi(decimals);
        proptest::option::of(-1_000_000i32..1_000_000).prop_map(move |n| n.map(|n| n as f64 / scale))
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_again(
            fps in rounded(1), frame in rounded(2), mah in rounded(1), headroom in rounded(2),
            raw in proptest::option::of(any::<i64>()), stale in proptest::option::of(any::<u32>()),
            level in proptest::option::of(any::<i32>()), names in proptest::collection::vec("[a-z][a-z-]{0,8}", 0..6),
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
