//! How much may be sent: the rate controller of Google Congestion Control (draft-ietf-rmcat-gcc-02, sections 5.5 and 5.6).
//! It differs in its speed: a stream of one viewer may double its rate in less than a second, and start as fast as the
//! first frame has come.

use std::collections::VecDeque;

use super::trend::Queue;

/// The least rate in bytes/s.
const MIN_RATE: f64 = 12.5e3;
/// The most.
const MAX_RATE: f64 = 1e9;
/// The rate before anything has arrived, in bytes/s.
const FIRST: f64 = 125e3;
/// The factor by which the rate grows in a second: at the start, and later while the link's capacity is not known.
const START: f64 = 16.0;
const GROWTH: f64 = 4.0;
/// What arrived while a queue grew is taken times this.
const DECREASE: f64 = 0.9;
/// The most that the rate exceeds what has arrived, as a factor: usually, and if what is on its way limits that.
const HEADROOM: f64 = 1.5;
const FULL_HEADROOM: f64 = 1.6;
/// More than what arrives times this is a rate that is not used.
const UNUSED: f64 = 1.3;
/// A link has become much slower if less than this share of what is sent arrives, and late.
const COLLAPSED: f64 = 0.35;
/// The time in s over which what has arrived is counted.
const WINDOW: f64 = 0.25;
/// The weight of a new measurement in the mean capacity, and the least and the most relative variance of that.
const CAPACITY_WEIGHT: f64 = 0.05;
const CAPACITY_VARIANCE: [f64; 2] = [0.0004, 0.003];
/// The share of the capacity by which the rate grows in a second near it. If no queue grows for a time in s, it grows the
/// faster, the longer that is ago, as in CUBIC (RFC 9438): by this factor times the square of the time after that.
const NEAR_GROWTH: f64 = 0.08;
const NEAR_TIME: f64 = 2.0;
const FASTER: f64 = 6.0;

/// The rate at which bytes may be sent.
#[derive(Clone, Debug)]
pub struct Rate {
    pub bytes_per_second: f64,
    /// Sending, arrival (in s, each by the clock of its side) and bytes of the newest frames that have arrived.
    arrivals: VecDeque<[f64; 3]>,
    /// Mean and relative variance of what arrived when queues grew.
    capacity: Option<[f64; 2]>,
    is_starting: bool,
    /// True if nothing is known of the link since the rate was given up.
    is_lost: bool,
    /// When the rate was last changed and last decreased, in s.
    changed: f64,
    decreased: f64,
}

impl Default for Rate {
    fn default() -> Rate {
        Rate {
            bytes_per_second: FIRST,
            arrivals: VecDeque::new(),
            capacity: None,
            is_starting: true,
            is_lost: true,
            changed: 0.0,
            decreased: f64::NEG_INFINITY,
        }
    }
}

impl Rate {
    /// Notes a frame that has arrived: its times in s, and its bytes.
    pub fn arrived(&mut self, sent: f64, arrived: f64, bytes: f64) {
        // A frame that was overtaken counts when it is noted.
        let arrived = self.arrivals.back().map_or(arrived, |last| arrived.max(last[1]));
        self.arrivals.push_back([sent, arrived, bytes]);
        // One before the window stays: the first frame's time begins with it.
        while self.arrivals.len() > 2 && arrived - self.arrivals[1][1] > WINDOW {
            self.arrivals.pop_front();
        }
    }

    /// Forgets what has arrived, as after a pause.
    pub fn forget(&mut self) {
        self.arrivals.clear();
    }

    /// Returns what arrives, in bytes/s; `None` before the second frame.
    pub fn arriving(&self) -> Option<f64> {
        let (first, last) = (self.arrivals.front()?, self.arrivals.back()?);
        let bytes: f64 = self.arrivals.iter().skip(1).map(|arrival| arrival[2]).sum();
        (last[1] > first[1]).then(|| bytes / (last[1] - first[1]))
    }

    /// Returns what arrives as a share of what was sent in the same frames.
    fn arriving_share(&self) -> Option<f64> {
        let (first, last) = (self.arrivals.front()?, self.arrivals.back()?);
        (last[1] > first[1]).then(|| (last[0] - first[0]) / (last[1] - first[1]))
    }

    /// Takes a frame's bytes and its round trip in s, if they are all that is known. Returns true if so.
    pub fn begin(&mut self, bytes: f64, round_trip: f64) -> bool {
        let is_lost = std::mem::take(&mut self.is_lost);
        if is_lost {
            self.bytes_per_second = (bytes / round_trip.max(1e-3)).max(MIN_RATE);
        }
        is_lost
    }

    /// Follows the queue at a time in s, with the present round trip in s. `is_full` is true if more would have been sent,
    /// but for what is on its way.
    pub fn follow(&mut self, queue: Queue, is_stalled: bool, is_full: bool, round_trip: f64, now: f64) {
        let passed = (now - self.changed).clamp(0.0, 0.2);
        self.changed = now;
        // The trend is seen after some frames, but so much slower a link after one.
        let collapsed = is_stalled && self.arriving_share().is_some_and(|share| share < COLLAPSED);
        match queue {
            _ if collapsed => self.decrease(round_trip, now),
            Queue::Shrinks => {}
            Queue::Grows => self.decrease(round_trip, now),
            Queue::Steady => self.increase(passed, is_full, now, round_trip),
        }
    }

    fn decrease(&mut self, round_trip: f64, now: f64) {
        let arriving = self.arriving().unwrap_or(self.bytes_per_second);
        // What was sent before the last decrease says nothing about it.
        let is_new = now - self.decreased > round_trip + 0.1 || arriving < 0.5 * self.bytes_per_second;
        if !is_new {
            return;
        }
        self.is_starting = false;
        self.decreased = now;
        let [low, high] = CAPACITY_VARIANCE;
        self.capacity = Some(match self.capacity {
            Some([mean, variance]) if (arriving / mean - 1.0).powi(2) <= 9.0 * variance => {
                let off = arriving / mean - 1.0;
                let variance = (1.0 - CAPACITY_WEIGHT) * variance + CAPACITY_WEIGHT * off * off;
                [mean + CAPACITY_WEIGHT * (arriving - mean), variance.clamp(low, high)]
            }
            // Another link, or another rival on it.
            _ => [arriving, high],
        });
        // Less was sent than the rate, so what arrives may be all that was sent.
        let share = if self.bytes_per_second > UNUSED * arriving { 1.0 } else { DECREASE };
        self.bytes_per_second = self.bytes_per_second.min(share * arriving).max(MIN_RATE);
    }

    fn increase(&mut self, passed: f64, is_full: bool, now: f64, round_trip: f64) {
        let arriving = self.arriving().unwrap_or(self.bytes_per_second);
        if let Some([mean, variance]) = self.capacity
            && arriving > mean * (1.0 + 3.0 * variance.sqrt())
        {
            self.capacity = None;
        }
        // What is on its way without a queue is too little, so what arrives is, too.
        let most = arriving * if is_full { FULL_HEADROOM } else { HEADROOM };
        // The queue of before is still there, or nothing has come of the present rate.
        let since = now - self.decreased;
        if since < round_trip || self.bytes_per_second > most {
            return;
        }
        let grown = match self.capacity {
            Some([mean, _]) => {
                let faster = 1.0 + FASTER * (since - NEAR_TIME).max(0.0).powi(2);
                self.bytes_per_second + NEAR_GROWTH * faster * mean * passed
            }
            None => self.bytes_per_second * if self.is_starting { START } else { GROWTH }.powf(passed),
        };
        self.bytes_per_second = grown.min(most).min(MAX_RATE);
    }

    /// Takes a half of what has arrived lately, or of the rate if that is less: nothing has for some time in s.
    pub fn give_up(&mut self, silence: f64, now: f64) {
        let bytes: f64 = self.arrivals.iter().map(|arrival| arrival[2]).sum();
        let arriving = bytes / (WINDOW + silence);
        self.bytes_per_second = (0.5 * self.bytes_per_second.min(arriving)).max(MIN_RATE);
        (self.is_starting, self.is_lost, self.capacity) = (true, true, None);
        (self.changed, self.decreased) = (now, now);
        self.arrivals.clear();
    }
}
