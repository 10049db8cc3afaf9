//! Statistics of a session's frames, for the log.

use std::fmt;
use std::time::{Duration, Instant};

use crate::log_line;

/// Counts and times since the session was created.
#[derive(Clone, Copy, Default)]
pub struct Statistics {
    /// Calls of xrEndFrame.
    pub frames: u64,
    /// Layers whose second view was synthesized.
    pub synthesized: u64,
    /// Layers that were shown unchanged to both eyes.
    pub fallbacks: u64,
    /// The application's time from xrBeginFrame to xrEndFrame.
    pub application: Duration,
    /// The layer's time in xrEndFrame, without the runtime's.
    pub layer: Duration,
    /// The GPU time of the synthesis, as far as it is known.
    pub gpu: GpuTime,
}

/// The GPU time of the synthesis of a number of frames.
#[derive(Clone, Copy, Default)]
pub struct GpuTime {
    pub sum: Duration,
    pub frames: u64,
}

/// The mean of a number of times, in milliseconds. Displayed as `na` if there are none.
struct Mean {
    sum: Duration,
    count: u64,
}

impl fmt::Display for Mean {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.count {
            0 => f.write_str("na"),
            count => write!(f, "{:.2}", (self.sum / count as u32).as_secs_f64() * 1e3),
        }
    }
}

/// Writes a line to the log once a second.
#[derive(Default)]
pub struct Report {
    /// The time of the last line, and the statistics at that time.
    last: Option<(Instant, Statistics)>,
}

impl Report {
    /// Writes the line for the last second, if it is over.
    pub fn update(&mut self, now: &Statistics, application: &str) {
        let time = Instant::now();
        let (start, last) = *self.last.get_or_insert((time, *now));
        let passed = time.duration_since(start);
        if passed < Duration::from_secs(1) {
            return;
        }
        self.last = Some((time, *now));
        let frames = now.frames - last.frames;
        let rate = frames as f64 / passed.as_secs_f64();
        let synthesized = now.synthesized - last.synthesized;
        let fallbacks = now.fallbacks - last.fallbacks;
        let gpu = Mean { sum: now.gpu.sum - last.gpu.sum, count: now.gpu.frames - last.gpu.frames };
        let own = Mean { sum: now.application - last.application, count: frames };
        let layer = Mean { sum: now.layer - last.layer, count: frames };
        log_line(format_args!(
            "{application}: {rate:.1} frames a second, {synthesized} synthesized in {gpu} ms of GPU time each, \
             {fallbacks} not; {own} ms of a frame the application's, {layer} ms the layer's"
        ));
    }
}
