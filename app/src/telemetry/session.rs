//! A session: second after second of telemetry, and what remains of it at the end.

use std::fmt;

use super::DeviceState;
use super::frames::{FrameStatistics, SecondStatistics};
use super::line::{Line, StageTime, VERSION};
use super::power::{CurrentNormalizer, Energy};
use super::process::{ProcessSample, cpu_load};
use crate::gl::PassTime;

/// Length of a period in nanoseconds.
const PERIOD_NS: i64 = 1_000_000_000;
/// Frames of the fastest display in a period, with room for a late line.
const FRAMES: usize = 512;

/// What the viewer says of itself in a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViewerState {
    /// Stereo method.
    pub method: String,
    /// Synthesis pipeline, for methods with synthesis.
    pub pipeline: Option<String>,
    /// Scene.
    pub scene: String,
    /// Render scale per axis.
    pub render_scale: f32,
    /// Divisor of the ImBuffer's resolution, for pipelines with one.
    pub imbuffer: Option<u32>,
    /// What the settings call this run.
    pub run: Option<String>,
}

/// Sum of one stage's GPU times.
#[derive(Clone, Copy, Debug)]
struct Stage {
    name: &'static str,
    nanoseconds: u64,
}

/// Collects frames and device states.
pub struct Telemetry {
    begin_ns: Option<i64>,
    refresh_hz: f32,
    second: FrameStatistics,
    stages: Vec<Stage>,
    timed_frames: u32,
    process: ProcessSample,
    process_ns: Option<i64>,
    normalizer: CurrentNormalizer,
    totals: Totals,
}

/// What adds up over a session.
#[derive(Clone, Debug, Default)]
struct Totals {
    frames: u64,
    stale: u64,
    frame_ms: f64,
    worst_p99_ms: f64,
    energy: Energy,
    last_line_ns: Option<i64>,
    /// Level in percent and charge counter in microampere-hours, at the first and the last line.
    level: Option<[i32; 2]>,
    charge: Option<[i64; 2]>,
    was_plugged: bool,
    plug_known: bool,
}

impl Default for Telemetry {
    fn default() -> Telemetry {
        Telemetry {
            begin_ns: None,
            refresh_hz: 0.0,
            second: FrameStatistics::with_capacity(FRAMES),
            stages: Vec::with_capacity(32),
            timed_frames: 0,
            process: ProcessSample::default(),
            process_ns: None,
            normalizer: CurrentNormalizer::default(),
            totals: Totals::default(),
        }
    }
}

impl Telemetry {
    /// A frame was finished. Returns how many refreshes it was late.
    pub fn frame(&mut self, now_ns: i64, refresh_hz: f32) -> u32 {
        self.begin_ns.get_or_insert(now_ns);
        if self.process_ns.is_none() {
            self.process = ProcessSample::take();
            self.process_ns = Some(now_ns);
        }
        self.refresh_hz = refresh_hz;
        self.second.add(now_ns, refresh_hz)
    }

    /// Adds the GPU times of some frames.
    pub fn gpu(&mut self, passes: &[PassTime], frames: u32) {
        self.timed_frames += frames;
        for pass in passes {
            let nanoseconds = pass.time.as_nanos() as u64;
            match self.stages.iter_mut().find(|stage| stage.name == pass.name) {
                Some(stage) => stage.nanoseconds += nanoseconds,
                None => self.stages.push(Stage { name: pass.name, nanoseconds }),
            }
        }
    }

    /// Frames stop; the time until the next one counts for nothing.
    pub fn pause(&mut self) {
        self.second.pause();
        self.totals.last_line_ns = None;
        self.process_ns = None;
    }

    /// Whether a second has passed since the last line.
    pub fn is_due(&self, now_ns: i64) -> bool {
        self.second.elapsed_ns(now_ns) >= PERIOD_NS
    }

    /// Seconds since the first frame.
    pub fn seconds(&self, now_ns: i64) -> f64 {
        self.begin_ns.map_or(0.0, |begin| (now_ns - begin) as f64 * 1e-9)
    }

    /// Ends a period and makes its line.
    pub fn line(&mut self, now_ns: i64, viewer: &ViewerState, device: &DeviceState) -> Line {
        let frames = self.second.take();
        let process = ProcessSample::take();
        let since_sample = self.process_ns.map_or(0.0, |then| (now_ns - then) as f64 * 1e-9);
        let cpu_percent = cpu_load(&self.process, &process, since_sample);
        (self.process, self.process_ns) = (process, Some(now_ns));
        let raw = device.current_raw;
        let current_ma = raw.and_then(|raw| self.normalizer.add(raw, device.status, device.plugged));
        self.totals.add(now_ns, frames.as_ref(), device, current_ma);
        let milliseconds = |ns: u64| ns as f64 * 1e-6 / self.timed_frames as f64;
        let stages: Vec<StageTime> = (self.stages.drain(..))
            .map(|s| StageTime { name: s.name.replace(' ', "-"), milliseconds: milliseconds(s.nanoseconds) })
            .collect();
        self.timed_frames = 0;
        let optional = |value: Option<f32>| value.filter(|v| v.is_finite()).map(f64::from);
        Line {
            time_s: self.seconds(now_ns),
            method: viewer.method.clone(),
            pipeline: viewer.pipeline.clone(),
            scene: viewer.scene.clone(),
            fps: frames.map(|f| f.fps),
            refresh_hz: Some(self.refresh_hz as f64).filter(|hz| *hz > 0.0),
            stale: frames.map(|f| f.stale),
            frame_ms: frames.map(|f| f.mean_ms),
            p99_ms: frames.map(|f| f.p99_ms),
            gpu_ms: (!stages.is_empty()).then(|| stages.iter().map(|s| s.milliseconds).sum()),
            stages,
            cpu_percent,
            rss_mb: process.resident_bytes.map(|bytes| bytes as f64 / 1e6),
            current_raw: raw,
            current_ma,
            voltage_mv: device.voltage_mv,
            level_percent: device.level_percent,
            charge_uah: device.charge_counter_uah,
            plugged: device.plugged,
            battery_celsius: optional(device.battery_celsius),
            skin_celsius: optional(device.skin_celsius),
            thermal_status: device.thermal_status,
            thermal_headroom: optional(device.thermal_headroom),
            render_scale: viewer.render_scale as f64,
            imbuffer: viewer.imbuffer,
            frames: frames.map(|f| f.frames),
            status: device.status,
            run: viewer.run.clone(),
        }
    }

    /// The session so far, up to its last line.
    pub fn summary(&self, now_ns: i64) -> SessionSummary {
        let totals = &self.totals;
        let some = |value: f64| (totals.frames > 0).then_some(value);
        let mean_ms = totals.frame_ms / totals.frames as f64;
        // A charging battery says nothing of what the device uses.
        let trusted = totals.plug_known && !totals.was_plugged;
        let energy = Some(totals.energy).filter(|e| trusted && e.seconds > 0.0);
        SessionSummary {
            seconds: self.seconds(now_ns),
            frames: totals.frames,
            fps: some(1e3 / mean_ms),
            stale: totals.stale,
            frame_ms: some(mean_ms),
            worst_p99_ms: some(totals.worst_p99_ms),
            plugged: totals.plug_known.then_some(totals.was_plugged),
            energy,
            counter_mah: totals.charge.filter(|_| trusted).map(|[a, b]| (a - b) as f64 / 1e3),
            level_change: totals.level.map(|[first, last]| last - first),
        }
    }
}

impl Totals {
    fn add(
        &mut self,
        now_ns: i64,
        frames: Option<&SecondStatistics>,
        device: &DeviceState,
        current_ma: Option<f64>,
    ) {
        if let Some(frames) = frames {
            self.frames += frames.frames as u64;
            self.stale += frames.stale as u64;
            self.frame_ms += frames.mean_ms * frames.frames as f64;
            self.worst_p99_ms = self.worst_p99_ms.max(frames.p99_ms);
        }
        if let Some(plugged) = device.plugged {
            self.plug_known = true;
            self.was_plugged |= plugged != 0;
        }
        if let Some(level) = device.level_percent {
            self.level = Some([self.level.map_or(level, |l| l[0]), level]);
        }
        if let Some(charge) = device.charge_counter_uah {
            self.charge = Some([self.charge.map_or(charge, |c| c[0]), charge]);
        }
        if let Some(last) = self.last_line_ns.replace(now_ns)
            && let (Some(current), Some(voltage)) = (current_ma, device.voltage_mv)
        {
            self.energy.add(current, voltage as f64, (now_ns - last) as f64 * 1e-9);
        }
    }
}

/// What remains of a session: one line at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct SessionSummary {
    /// Length in seconds.
    pub seconds: f64,
    /// Frames in complete periods.
    pub frames: u64,
    /// Mean frames per second.
    pub fps: Option<f64>,
    /// Refreshes that showed an old frame again.
    pub stale: u64,
    /// Mean time between frames in milliseconds.
    pub frame_ms: Option<f64>,
    /// The largest of the seconds' 99th percentiles in milliseconds.
    pub worst_p99_ms: Option<f64>,
    /// Whether the device was plugged in at any time, which makes its power figures worthless.
    pub plugged: Option<bool>,
    /// Charge and energy by integration; missing when plugged in or not measured.
    pub energy: Option<Energy>,
    /// Charge in milliampere-hours by the device's own counter, to check the integral with.
    pub counter_mah: Option<f64>,
    /// Change of the battery level in percent points.
    pub level_change: Option<i32>,
}

impl fmt::Display for SessionSummary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let number = |value: Option<f64>, decimals: usize, unit: &str| match value {
            Some(value) => format!("{value:.decimals$}{unit}"),
            None => "na".into(),
        };
        let watts = self.energy.map(|e| e.milliwatt_hours * 3.6 / e.seconds);
        write!(
            f,
            "v={VERSION},summary=1,t={:.1}s,frames={},FPS={},Stale={},frame={},p99max={},plugged={},mAh={},mAh_counter={},mWh={},W={},level={}",
            self.seconds,
            self.frames,
            number(self.fps, 1, ""),
            self.stale,
            number(self.frame_ms, 2, "ms"),
            number(self.worst_p99_ms, 2, "ms"),
            self.plugged.map_or("na", |p| if p { "1" } else { "0" }),
            number(self.energy.map(|e| e.milliampere_hours), 3, ""),
            number(self.counter_mah, 3, ""),
            number(self.energy.map(|e| e.milliwatt_hours), 3, ""),
            number(watts, 3, ""),
            self.level_change.map_or("na".into(), |change| format!("{change:+}%")),
        )
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::telemetry::BatteryStatus;

    const FRAME: i64 = 16_666_667;

    fn viewer() -> ViewerState {
        ViewerState {
            method: "yoro".into(),
            scene: "prototype".into(),
            render_scale: 1.0,
            ..Default::default()
        }
    }

    fn run(telemetry: &mut Telemetry, device: &DeviceState, seconds: usize) -> Vec<Line> {
        let (mut now, mut lines) = (0, Vec::new());
        while lines.len() < seconds {
            telemetry.frame(now, 60.0);
            if telemetry.is_due(now) {
                lines.push(telemetry.line(now, &viewer(), device));
            }
            now += FRAME;
        }
        lines
    }

    #[test]
    fn a_session_on_battery() {
        let device = DeviceState {
            current_raw: Some(600_000),
            status: Some(BatteryStatus::Discharging),
            voltage_mv: Some(4000),
            plugged: Some(0),
            level_percent: Some(80),
            charge_counter_uah: Some(2_000_000),
            ..DeviceState::default()
        };
        let mut telemetry = Telemetry::default();
        let lines = run(&mut telemetry, &device, 11);
        let line = &lines[5];
        assert_eq!((line.current_raw, line.current_ma), (Some(600_000), Some(-600.0)));
        assert!((line.fps.unwrap() - 60.0).abs() < 0.1);
        assert_eq!((line.stale, line.skin_celsius, line.gpu_ms), (Some(0), None, None));
        let summary = telemetry.summary(11_000_000_000);
        // Ten intervals of a second between eleven lines.
        let energy = summary.energy.unwrap();
        assert!((energy.milliampere_hours - 600.0 * energy.seconds / 3600.0).abs() < 1e-9);
        assert!((energy.seconds - 10.0).abs() < 0.1);
        let text = summary.to_string();
        assert!(
            text.contains("plugged=0") && text.contains("W=2.400") && text.contains("level=+0%"),
            "{text}"
        );
    }

    #[test]
    fn power_of_a_plugged_device_is_refused() {
        let device = DeviceState {
            current_raw: Some(-600_000),
            status: Some(BatteryStatus::Charging),
            voltage_mv: Some(4000),
            plugged: Some(2),
            ..DeviceState::default()
        };
        let mut telemetry = Telemetry::default();
        let lines = run(&mut telemetry, &device, 3);
        assert_eq!(lines[2].current_ma, Some(600.0));
        let text = telemetry.summary(3_000_000_000).to_string();
        assert!(text.contains("plugged=1,mAh=na") && text.contains("W=na"), "{text}");
    }

    #[test]
    fn nothing_known_of_the_device() {
        let mut telemetry = Telemetry::default();
        let lines = run(&mut telemetry, &DeviceState::default(), 2);
        assert_eq!(lines[1].current_ma, None);
        assert!(telemetry.summary(0).to_string().contains("plugged=na,mAh=na"));
    }

    #[test]
    fn gpu_times_are_means_per_frame() {
        let mut telemetry = Telemetry::default();
        for ms in [2, 4] {
            let pass = |name, ms| PassTime { name, time: Duration::from_millis(ms) };
            telemetry.gpu(&[pass("geometry", ms), pass("fxaa", 1), pass("fxaa", 1)], 1);
        }
        let line = telemetry.line(0, &viewer(), &DeviceState::default());
        let times: Vec<_> = line.stages.iter().map(|s| (s.name.as_str(), s.milliseconds)).collect();
        assert_eq!(times, [("geometry", 3.0), ("fxaa", 2.0)]);
        assert_eq!(line.gpu_ms, Some(5.0));
    }
}
