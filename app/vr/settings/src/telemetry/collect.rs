//! Collects frames and device states of a session, and makes a line every second.

use std::time::Duration;

use super::device::DeviceState;
use super::frames::FrameStatistics;
use super::line::{Line, StageTime};
use super::power::CurrentNormalizer;
use super::process::{ProcessSample, cpu_load};
use super::summary::{SessionSummary, Totals};

/// Length of a period in nanoseconds.
const PERIOD_NS: i64 = 1_000_000_000;
/// The number of frames of the fastest display in a period, including a line that is late.
const FRAMES: usize = 512;

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
    /// Counts a finished frame. Returns by how many refreshes it was late.
    pub fn frame(&mut self, now_ns: i64, refresh_hz: f32) -> u32 {
        self.begin_ns.get_or_insert(now_ns);
        if self.process_ns.is_none() {
            self.process = ProcessSample::take();
            self.process_ns = Some(now_ns);
        }
        self.refresh_hz = refresh_hz;
        self.second.add(now_ns, refresh_hz)
    }

    /// Adds the GPU times of the passes of `frames` frames.
    pub fn gpu(&mut self, passes: impl IntoIterator<Item = (&'static str, Duration)>, frames: u32) {
        self.timed_frames += frames;
        for (name, time) in passes {
            let nanoseconds = time.as_nanos() as u64;
            match self.stages.iter_mut().find(|stage| stage.name == name) {
                Some(stage) => stage.nanoseconds += nanoseconds,
                None => self.stages.push(Stage { name, nanoseconds }),
            }
        }
    }

    /// Pauses counting: the time until the next frame does not count.
    pub fn pause(&mut self) {
        self.second.pause();
        self.totals.pause();
        self.process_ns = None;
    }

    /// True if a second has passed since the last line.
    pub fn is_due(&self, now_ns: i64) -> bool {
        self.second.elapsed_ns(now_ns) >= PERIOD_NS
    }

    /// Returns the seconds since the first frame.
    pub fn seconds(&self, now_ns: i64) -> f64 {
        self.begin_ns.map_or(0.0, |begin| (now_ns - begin) as f64 * 1e-9)
    }

    /// Ends a period and returns its line. `viewer` has what the viewer knows: method, pipeline, scene, sizes, run, choice.
    pub fn line(&mut self, now_ns: i64, viewer: Line, device: &DeviceState) -> Line {
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
            frames: frames.map(|f| f.frames),
            status: device.status,
            performance: device.performance.map(str::to_owned),
            ..viewer
        }
    }

    /// Returns the summary of the session up to its last line.
    pub fn summary(&self, now_ns: i64) -> SessionSummary {
        self.totals.summary(self.seconds(now_ns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::BatteryStatus;

    const FRAME: i64 = 16_666_667;

    fn viewer() -> Line {
        Line { method: "yoro".into(), scene: "prototype".into(), render_scale: 1.0, ..Default::default() }
    }

    fn run(telemetry: &mut Telemetry, device: &DeviceState, seconds: usize) -> Vec<Line> {
        let (mut now, mut lines) = (0, Vec::new());
        while lines.len() < seconds {
            telemetry.frame(now, 60.0);
            if telemetry.is_due(now) {
                lines.push(telemetry.line(now, viewer(), device));
            }
            now += FRAME;
        }
        lines
    }

    #[test]
    fn energy_on_battery_is_current_times_voltage_over_time() {
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
        // Ten intervals of one second between eleven lines.
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
    fn a_voltage_in_whole_volts_makes_no_energy() {
        let device = DeviceState {
            current_raw: Some(-600_000),
            status: Some(BatteryStatus::Discharging),
            voltage_mv: Some(4),
            plugged: Some(0),
            ..DeviceState::default()
        };
        let mut telemetry = Telemetry::default();
        let lines = run(&mut telemetry, &device, 3);
        assert_eq!(lines[2].voltage_mv, Some(4), "the line says what the device says");
        let text = telemetry.summary(3_000_000_000).to_string();
        assert!(text.contains("mWh=na") && text.contains("W=na"), "{text}");
    }

    #[test]
    fn an_unknown_device_has_no_power_figures() {
        let mut telemetry = Telemetry::default();
        let lines = run(&mut telemetry, &DeviceState::default(), 2);
        assert_eq!(lines[1].current_ma, None);
        assert!(telemetry.summary(0).to_string().contains("plugged=na,mAh=na"));
    }

    #[test]
    fn gpu_times_are_means_per_frame() {
        let mut telemetry = Telemetry::default();
        for ms in [2, 4] {
            let pass = |name, ms| (name, Duration::from_millis(ms));
            telemetry.gpu([pass("surfaces", ms), pass("resolve", 1), pass("resolve", 1)], 1);
        }
        let line = telemetry.line(0, viewer(), &DeviceState::default());
        let times: Vec<_> = line.stages.iter().map(|s| (s.name.as_str(), s.milliseconds)).collect();
        assert_eq!(times, [("surfaces", 3.0), ("resolve", 2.0)]);
        assert_eq!(line.gpu_ms, Some(5.0));
    }
}
