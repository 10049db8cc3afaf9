//! Whether a queue grows on the way to the client: the arrival-time filter of Google Congestion Control with a trend
//! line, and its over-use detector.
//!
//! Source: S. Holmer et al., "A Google Congestion Control Algorithm for Real-Time Communication",
//! draft-ietf-rmcat-gcc-02 (2016), sections 5.2 to 5.4, with the linear regression that WebRTC uses instead of the Kalman
//! filter (G. Carlucci et al., "Congestion Control for Web Real-Time Communication", IEEE/ACM Transactions on Networking
//! 25(5), 2017). A frame is a group of packets. There are fewer frames than groups in WebRTC, so smoothing is weaker and
//! the window is limited in time.

use std::collections::VecDeque;

/// The share of the previous value in the smoothed delay.
const SMOOTHING: f64 = 0.7;
/// The most frames that the line is fitted to, the fewest, and the longest time that they span in ms.
const MAX_POINTS: usize = 20;
const MIN_POINTS: usize = 6;
const MAX_SPAN: f64 = 600.0;
/// What the slope is multiplied with before it is compared, for each of up to [`MAX_FRAMES`] frames.
const GAIN: f64 = 4.0;
const MAX_FRAMES: f64 = 60.0;
/// The first threshold in ms, its range, and how fast it follows values above and below it, per ms.
const THRESHOLD: f64 = 12.5;
const THRESHOLDS: [f64; 2] = [6.0, 600.0];
const FOLLOW_UP: f64 = 0.0087;
const FOLLOW_DOWN: f64 = 0.039;
/// A value above the threshold by more than this is an outlier, which the threshold does not follow.
const OUTLIER: f64 = 15.0;
/// The longest time in ms by which the threshold is moved at once.
const MAX_STEP: f64 = 100.0;
/// A queue is one if it delays all frames of this time in ms, more than the fastest frame of the last one or two windows of
/// this length in ms: by the time that a frame's own bytes may take, and the noise times a factor, but
/// at most the last.
const NEWEST: f64 = 1000.0;
const WINDOW: f64 = 5000.0;
const STANDING_NOISE: f64 = 2.0;
const MAX_STANDING: f64 = 42.0;
/// A queue may have begun if it delays this many frames.
const LATE: usize = 3;
/// The weight of a new frame in the noise (the interarrival jitter of RFC 3550).
const NOISE_WEIGHT: f64 = 1.0 / 64.0;
/// A queue must grow for this long in ms.
const OVER_USE_TIME: f64 = 10.0;

/// What is known of the queue on the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Queue {
    /// It stays as it is.
    Steady,
    /// It grows: more is sent than arrives.
    Grows,
    /// It shrinks: wait until it is gone.
    Shrinks,
}

/// Follows the delay of frames. Clocks of both sides may differ by any constant.
#[derive(Clone, Debug)]
pub struct Trend {
    /// When the newest frame was sent and arrived, in ms.
    last: Option<[f64; 2]>,
    /// The sum of all delay variations, and the same smoothed, in ms.
    delay: f64,
    smoothed: f64,
    frames: f64,
    /// Arrival and smoothed delay of the newest frames, in ms.
    points: VecDeque<[f64; 2]>,
    threshold: f64,
    /// The value before, and for how long it has been above the threshold, in ms.
    previous: f64,
    above: f64,
    queue: Queue,
    /// The time in ms that the bytes of a large frame take at most on a link that is wide enough.
    interval: f64,
    /// Arrival and delay of the newest frames in ms, and the least delay of the present window and the previous one, with
    /// the present one's begin.
    delays: VecDeque<[f64; 2]>,
    /// The mean difference between the delays of two frames in ms.
    pub noise: f64,
    least: [f64; 2],
    window_start: f64,
}

impl Trend {
    /// Begins for frames with this interval in ms.
    pub fn new(interval: f64) -> Trend {
        Trend {
            interval,
            last: None,
            delay: 0.0,
            smoothed: 0.0,
            frames: 0.0,
            points: VecDeque::new(),
            threshold: THRESHOLD,
            previous: 0.0,
            above: 0.0,
            queue: Queue::Steady,
            delays: VecDeque::new(),
            noise: 0.0,
            least: [f64::INFINITY; 2],
            window_start: 0.0,
        }
    }
}

impl Trend {
    /// Returns what is known of the queue.
    pub fn queue(&self) -> Queue {
        match self.queue {
            Queue::Grows if !self.stands() => Queue::Steady,
            queue => queue,
        }
    }

    /// True if there is a queue at all: jitter and packets that are sent again delay some frames, a queue delays all.
    pub fn stands(&self) -> bool {
        self.standing() >= self.tolerated()
    }

    /// True if the newest frames were delayed as if there were a queue.
    pub fn is_late(&self) -> bool {
        let newest = self.delays.iter().rev().take(LATE).map(|[_, delay]| *delay);
        newest.fold(f64::INFINITY, f64::min) - self.least[0].min(self.least[1]) >= self.tolerated()
    }

    /// Returns by how much frames may be delayed without a queue, in ms.
    fn tolerated(&self) -> f64 {
        (self.interval + STANDING_NOISE * self.noise).min(MAX_STANDING)
    }

    /// Returns by how much the newest frame was delayed more than the fastest, in ms.
    fn newest(&self) -> f64 {
        self.delays.back().map_or(0.0, |[_, delay]| *delay) - self.least[0].min(self.least[1])
    }

    /// True if the newest frame was delayed by far more than the fastest.
    pub fn is_stalled(&self) -> bool {
        self.newest() > 2.0 * MAX_STANDING + 3.0 * self.noise
    }

    /// Returns by how much all of the newest frames were delayed more than the fastest, in ms.
    fn standing(&self) -> f64 {
        let newest = self.delays.iter().map(|[_, delay]| *delay).fold(f64::INFINITY, f64::min);
        newest - self.least[0].min(self.least[1])
    }

    /// Forgets all frames, as after a pause, but not how the way is.
    pub fn forget(&mut self) {
        let Trend { threshold, least, window_start, noise, .. } = *self;
        *self = Trend { threshold, least, window_start, noise, ..Trend::new(self.interval) };
    }

    /// Takes a frame's times in ms, in the order of sending; the arrival as of a frame of the usual size. A frame that arrives before an earlier one says nothing.
    pub fn add(&mut self, sent: f64, arrived: f64) {
        let Some([last_sent, last_arrived]) = self.last else {
            self.last = Some([sent, arrived]);
            return;
        };
        let passed = arrived - last_arrived;
        if passed < 0.0 {
            return;
        }
        self.last = Some([sent, arrived]);
        let delay = arrived - sent;
        self.delays.push_back([arrived, delay]);
        while self.delays.len() > 3 && arrived - self.delays[0][0] > NEWEST {
            self.delays.pop_front();
        }
        if arrived - self.window_start > WINDOW {
            (self.least, self.window_start) = ([f64::INFINITY, self.least[0]], arrived);
        }
        self.least[0] = self.least[0].min(delay);
        self.frames += 1.0;
        let variation = passed - (sent - last_sent);
        // A link that has become slower is no noise.
        self.noise += NOISE_WEIGHT * (variation.abs().min(MAX_STANDING) - self.noise);
        self.delay += variation;
        self.smoothed = SMOOTHING * self.smoothed + (1.0 - SMOOTHING) * self.delay;
        self.points.push_back([arrived, self.smoothed]);
        while self.points.len() > MAX_POINTS
            || (self.points.len() > MIN_POINTS && arrived - self.points[0][0] > MAX_SPAN)
        {
            self.points.pop_front();
        }
        let Some(slope) = self.slope() else { return };
        self.detect(slope * self.frames.min(MAX_FRAMES) * GAIN, passed);
    }

    /// Returns the slope of the line through the points: by how much the delay grows in a unit of time.
    fn slope(&self) -> Option<f64> {
        if self.points.len() < MIN_POINTS {
            return None;
        }
        let count = self.points.len() as f64;
        let [x, y] = [0, 1].map(|axis| self.points.iter().map(|point| point[axis]).sum::<f64>() / count);
        let [above, below] = self.points.iter().fold([0.0; 2], |[above, below], point| {
            let from_middle = point[0] - x;
            [above + from_middle * (point[1] - y), below + from_middle * from_middle]
        });
        (below > 0.0).then_some(above / below)
    }

    fn detect(&mut self, value: f64, passed: f64) {
        if value > self.threshold {
            self.above += passed;
            if self.above > OVER_USE_TIME && value >= self.previous {
                self.queue = Queue::Grows;
            }
        } else {
            self.above = 0.0;
            self.queue = if value < -self.threshold { Queue::Shrinks } else { Queue::Steady };
        }
        self.previous = value;
        // The threshold grows with the noise of the way.
        let beyond = value.abs() - self.threshold;
        if beyond <= OUTLIER {
            let follow = if beyond < 0.0 { FOLLOW_DOWN } else { FOLLOW_UP };
            self.threshold += follow * beyond * passed.min(MAX_STEP);
            self.threshold = self.threshold.clamp(THRESHOLDS[0], THRESHOLDS[1]);
        }
    }
}
