//! The summary of a session.

use std::fmt;

use super::device::DeviceState;
use super::frames::SecondStatistics;
use super::power::{Energy, LEAST_MILLIVOLTS};
use super::text::{MISSING, Na, VERSION};

/// Sums over a session.
#[derive(Clone, Debug, Default)]
pub(super) struct Totals {
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

impl Totals {
    /// Adds one second.
    pub fn add(
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
            && let (Some(current), Some(voltage)) = (current_ma, device.voltage_mv.map(f64::from))
            && voltage >= LEAST_MILLIVOLTS
        {
            self.energy.add(current, voltage, (now_ns - last) as f64 * 1e-9);
        }
    }

    /// Starts a pause: the time until the next line does not count for the energy.
    pub fn pause(&mut self) {
        self.last_line_ns = None;
    }

    /// Returns the summary of the session so far, of `seconds` seconds.
    pub fn summary(&self, seconds: f64) -> SessionSummary {
        let some = |value: f64| (self.frames > 0).then_some(value);
        let mean_ms = self.frame_ms / self.frames as f64;
        // The current of a charging battery does not show what the device uses.
        let trusted = self.plug_known && !self.was_plugged;
        let energy = Some(self.energy).filter(|e| trusted && e.seconds > 0.0);
        SessionSummary {
            seconds,
            frames: self.frames,
            fps: some(1e3 / mean_ms),
            stale: self.stale,
            frame_ms: some(mean_ms),
            worst_p99_ms: some(self.worst_p99_ms),
            plugged: self.plug_known.then_some(self.was_plugged),
            energy,
            counter_mah: self.charge.filter(|_| trusted).map(|[a, b]| (a - b) as f64 / 1e3),
            level_change: self.level.map(|[first, last]| last - first),
        }
    }
}

/// The summary of a session, one line at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct SessionSummary {
    /// Length in seconds.
    pub seconds: f64,
    /// Frames in complete periods.
    pub frames: u64,
    /// Mean frames per second.
    pub fps: Option<f64>,
    /// Number of refreshes that showed an old frame again.
    pub stale: u64,
    /// Mean time between frames in milliseconds.
    pub frame_ms: Option<f64>,
    /// The largest of the seconds' 99th percentiles in milliseconds.
    pub worst_p99_ms: Option<f64>,
    /// True if the device was plugged in at any time, which invalidates its power figures.
    pub plugged: Option<bool>,
    /// Charge and energy by integration; missing if plugged in or not measured.
    pub energy: Option<Energy>,
    /// Charge in milliampere-hours by the device's own counter, for checking the integral.
    pub counter_mah: Option<f64>,
    /// Change of the battery level in percentage points.
    pub level_change: Option<i32>,
}

impl fmt::Display for SessionSummary {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let watts = self.energy.map(|e| e.milliwatt_hours * 3.6 / e.seconds);
        write!(
            f,
            "v={VERSION},summary=1,t={:.1}s,frames={},FPS={},Stale={},frame={},p99max={},plugged={},mAh={},mAh_counter={},mWh={},W={},level={}",
            self.seconds,
            self.frames,
            Na(self.fps, 1, ""),
            self.stale,
            Na(self.frame_ms, 2, "ms"),
            Na(self.worst_p99_ms, 2, "ms"),
            self.plugged.map_or(MISSING, |p| if p { "1" } else { "0" }),
            Na(self.energy.map(|e| e.milliampere_hours), 3, ""),
            Na(self.counter_mah, 3, ""),
            Na(self.energy.map(|e| e.milliwatt_hours), 3, ""),
            Na(watts, 3, ""),
            self.level_change.map_or_else(|| MISSING.to_owned(), |change| format!("{change:+}%")),
        )
    }
}
