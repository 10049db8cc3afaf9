//! Statistics of displayed frames.

use crate::telemetry::stats;

/// Longer intervals are pauses, not frames, in nanoseconds.
const LONGEST_NS: i64 = 1_000_000_000;

/// Collects the times at which frames were handed to the display.
#[derive(Clone, Debug, Default)]
pub struct FrameStatistics {
    last_ns: Option<i64>,
    begin_ns: Option<i64>,
    intervals_ms: Vec<f64>,
    stale: u32,
}

/// Statistics of the frames of one second, or of any other period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondStatistics {
    /// Frames per second.
    pub fps: f64,
    /// Number of the display's refreshes that showed an old frame again.
    pub stale: u32,
    /// Mean time between frames in milliseconds.
    pub mean_ms: f64,
    /// The 99th percentile of the times between frames, in milliseconds.
    pub p99_ms: f64,
    /// Number of intervals between frames.
    pub frames: u32,
}

impl FrameStatistics {
    /// Creates statistics with room for the frames of a period, so that adding one does not allocate.
    pub fn with_capacity(frames: usize) -> FrameStatistics {
        FrameStatistics { intervals_ms: Vec::with_capacity(frames), ..FrameStatistics::default() }
    }

    /// Counts a frame that was finished at `now_ns`. Returns by how many refreshes it was late.
    pub fn add(&mut self, now_ns: i64, refresh_hz: f32) -> u32 {
        self.begin_ns.get_or_insert(now_ns);
        let Some(last) = self.last_ns.replace(now_ns) else { return 0 };
        let interval = now_ns - last;
        if !(0..LONGEST_NS).contains(&interval) {
            // The period starts anew, or the pause would count as slowness.
            self.begin_ns = Some(now_ns);
            self.intervals_ms.clear();
            return 0;
        }
        self.intervals_ms.push(interval as f64 * 1e-6);
        if refresh_hz.is_nan() || refresh_hz <= 0.0 {
            return 0;
        }
        let refreshes = (interval as f64 * 1e-9 * refresh_hz as f64).round() as u32;
        let late = refreshes.saturating_sub(1);
        self.stale += late;
        late
    }

    /// Starts a pause: the time until the next frame is not a frame time.
    pub fn pause(&mut self) {
        self.last_ns = None;
    }

    /// Returns the time since the beginning of the period, in nanoseconds.
    pub fn elapsed_ns(&self, now_ns: i64) -> i64 {
        self.begin_ns.map_or(0, |begin| now_ns - begin)
    }

    /// Ends the period and returns its statistics; `None` if it has fewer than two frames.
    pub fn take(&mut self) -> Option<SecondStatistics> {
        let stale = std::mem::take(&mut self.stale);
        self.begin_ns = self.last_ns;
        let total: f64 = self.intervals_ms.iter().sum();
        let frames = self.intervals_ms.len() as u32;
        let p99_ms = stats::percentile(&self.intervals_ms, 99.0);
        self.intervals_ms.clear();
        let mean_ms = total / frames as f64;
        p99_ms.map(|p99_ms| SecondStatistics { fps: 1e3 / mean_ms, stale, mean_ms, p99_ms, frames })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_of_frames_with_one_late() {
        let mut statistics = FrameStatistics::default();
        let mut now = 0;
        let mut late = 0;
        for i in 0..60 {
            now += if i == 30 { 33_333_333 } else { 16_666_667 };
            late += statistics.add(now, 60.0);
        }
        assert_eq!(late, 1);
        let second = statistics.take().unwrap();
        assert_eq!((second.stale, second.frames), (1, 59));
        assert!((second.mean_ms - 16.949).abs() < 1e-2, "{second:?}");
        assert!((second.fps - 59.0).abs() < 1e-2, "{second:?}");
        assert!(second.p99_ms > 16.7 && second.p99_ms <= 33.34);
        assert_eq!(statistics.take(), None);
    }

    #[test]
    fn a_pause_is_no_frame() {
        let mut statistics = FrameStatistics::default();
        statistics.add(0, 60.0);
        assert_eq!(statistics.add(5_000_000_000, 60.0), 0);
        statistics.add(5_016_000_000, 60.0);
        statistics.pause();
        statistics.add(5_500_000_000, 60.0);
        statistics.add(5_516_000_000, 60.0);
        let second = statistics.take().unwrap();
        assert_eq!((second.frames, second.stale), (2, 0));
        assert!((second.fps - 62.5).abs() < 1e-6);
    }

    #[test]
    fn an_unknown_rate_has_no_stale_frames() {
        let mut statistics = FrameStatistics::default();
        statistics.add(0, 0.0);
        assert_eq!(statistics.add(900_000_000, f32::NAN), 0);
    }
}
