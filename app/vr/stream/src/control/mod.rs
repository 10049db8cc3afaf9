//! Decides when a stream's frames are made, and how finely they are encoded.

mod rate;
#[cfg(test)]
mod simulation;
mod trend;

use std::collections::VecDeque;
use std::time::Duration;

use crate::Report;
use rate::Rate;
use trend::{Queue, Trend};

/// The largest quantizer used. Coarser pictures are useless, so frames are left out instead.
const MAX_QUANTIZER: u8 = 44;
/// The factor by which frames may exceed the frame rate. A client that requests frames at this rate by its own clock
/// must not have to wait for the server's clock.
const RATE_HEADROOM: f32 = 1.05;
/// The share of the rate that frames are made for. Their size is known only afterwards.
const FILL: f64 = 0.95;
/// The time in s for which an intra frame may take up the whole rate.
const INTRA_TIME: f64 = 0.06;
/// By how many times an intra frame is larger than others, before one of the others is known.
const INTRA_FACTOR: f64 = 4.0;
/// The weight of a new frame's size in the mean.
const SIZE_WEIGHT: f64 = 0.25;
/// The fastest round trip is taken over the last one or two windows of this length, in s.
const ROUND_TRIP_WINDOW: f64 = 5.0;
/// No more is on its way than what arrives in the fastest round trip and this time in s, and the noise of the way times a
/// factor, at most the last.
const SLACK: f64 = 0.01;
const NOISE: f64 = 3.0;
const MAX_SLACK: f64 = 0.12;
/// For so many arrivals in a row, too much is on its way because of the rate: for fewer, because of one late frame.
const LONG_FULL: u32 = 3;
/// A frame that is due for this long in s when it is made was requested too late to be made at once.
const LATE_REQUEST: f64 = 0.003;
/// The longest time in s between two requests that make frames larger, and the weight of a new time in the mean.
const MAX_INTERVAL: f64 = 0.2;
const REQUESTED_WEIGHT: f64 = 0.1;
/// If nothing is requested for this long in s, earlier frames say nothing about the present.
const PAUSE: f64 = 1.0;
/// The most frames that have arrived and are not decoded yet.
const MAX_UNDECODED: usize = 4;
/// If nothing arrives of what is on its way for this long, it is not waited for any more. The time doubles with each round
/// that is given up, up to the longest, until a frame arrives.
const GIVE_UP_TIMEOUT: Duration = Duration::from_millis(500);
const MAX_TIMEOUT: Duration = Duration::from_secs(4);
/// The most frames that are remembered.
const MAX_REMEMBERED: usize = 256;

/// A frame that was sent.
#[derive(Clone, Copy, Debug)]
struct Sent {
    number: u32,
    time: f64,
    bytes: f64,
    is_intra: bool,
    has_arrived: bool,
    /// True if it is not waited for any more.
    is_given_up: bool,
}

/// Decides when a frame is made and how finely it is encoded, from the times at which frames have arrived at the client:
/// Google Congestion Control says how much may be sent (`trend`, `rate`), and no more is on its way than what arrives
/// in the fastest round trip and the usual variation of round trips.
///
/// Each frame gets the finest quantizer at which it fits into the rate. If the coarsest one does not, there are fewer
/// frames. Times are of the server's clock, but for those in a [`Report`], which are of the client's; the clocks need not
/// agree.
#[derive(Clone, Debug)]
pub struct RateControl {
    interval: f64,
    min_quantizer: u8,
    trend: Trend,
    rate: Rate,
    /// The usual time in s from a frame to the next if nothing but requests and the frame rate limits them.
    requested: f64,
    /// True if a frame was not made since the last arrival, because too much is on its way.
    is_full: bool,
    /// For how many arrivals in a row that has been so.
    full: u32,
    /// Since when the next frame has been due, in s.
    due_since: Option<f64>,
    /// The earliest time for the next frame in s, and the bytes that were sent beyond the rate at a time.
    next: f64,
    debt: (f64, f64),
    /// Frames that the client has not decoded, and those before that may still be reported.
    frames: VecDeque<Sent>,
    /// The fastest round trips of the present window and the previous one, each with the time that a usual frame took at
    /// the rate then, and the present one's begin, in s.
    fastest: [[f64; 2]; 2],
    window_start: f64,
    round_trip: Option<Duration>,
    /// The bytes that an intra frame and another one would have at quantizer 0.
    sizes: [Option<f64>; 2],
    quantizer: f64,
    /// The usual bytes of a frame.
    usual: Option<f64>,
    decoded: Option<u32>,
    /// When a frame was last known to have arrived or to be decoded, in s.
    progress: f64,
    give_up: Duration,
}

impl RateControl {
    /// Starts with coarse pictures, which become finer up to `min_quantizer`, at most about `frame_rate` a second.
    pub fn new(min_quantizer: u8, frame_rate: f32) -> RateControl {
        RateControl {
            interval: f64::from(1.0 / (RATE_HEADROOM * frame_rate)),
            min_quantizer,
            trend: Trend::new(1e3 / f64::from(frame_rate)),
            rate: Rate::default(),
            requested: f64::from(1.0 / (RATE_HEADROOM * frame_rate)),
            is_full: false,
            full: 0,
            due_since: None,
            next: 0.0,
            debt: (0.0, 0.0),
            frames: VecDeque::new(),
            fastest: [[f64::INFINITY, 0.0]; 2],
            window_start: 0.0,
            round_trip: None,
            sizes: [None; 2],
            quantizer: f64::from(MAX_QUANTIZER.max(min_quantizer)),
            usual: None,
            decoded: None,
            progress: 0.0,
            give_up: GIVE_UP_TIMEOUT,
        }
    }

    /// True if a frame is due.
    pub fn is_due(&mut self, now: Duration) -> bool {
        let now = now.as_secs_f64();
        let (is_wanted, fits) = self.allows(now);
        let is_due = is_wanted && fits;
        self.is_full |= is_wanted && !fits;
        self.due_since = self.due_since.filter(|_| is_due).or(is_due.then_some(now));
        is_due
    }

    /// Returns whether it is time for a frame, and whether what is on its way leaves room for one.
    fn allows(&self, now: f64) -> (bool, bool) {
        // A quarter of an interval of tolerance, since a client's requests are not exactly evenly spaced.
        if now + self.interval / 4.0 < self.next {
            return (false, false);
        }
        let undecoded = self.frames.iter().filter(|frame| frame.has_arrived && !frame.is_given_up).count();
        let in_flight = self.bytes_in_flight();
        if undecoded > MAX_UNDECODED {
            return (false, false);
        }
        if in_flight == 0.0 {
            return (true, true);
        }
        // Nothing is known before the first frame has arrived.
        if self.round_trip.is_none() {
            return (false, false);
        }
        let slack = (SLACK + NOISE * self.trend.noise * 1e-3).min(MAX_SLACK);
        let expected = self.expected(false);
        let rate = self.rate.bytes_per_second;
        // A frame that takes longer than its interval waits for itself long enough.
        let slack = (slack - (expected / rate - self.interval).max(0.0)).max(0.0);
        let is_wanted = self.debt_at(now) <= rate * self.requested / 2.0;
        (is_wanted, in_flight + expected <= rate * (self.fastest() + slack))
    }

    /// Returns the quantizer for the next frame.
    pub fn quantizer(&mut self, is_intra: bool) -> u8 {
        let coarsest = f64::from(MAX_QUANTIZER.max(self.min_quantizer));
        let Some(size) = self.size(is_intra) else { return coarsest as u8 };
        let rate = FILL * self.rate.bytes_per_second;
        let room = rate * if is_intra { INTRA_TIME.max(self.requested) } else { self.requested };
        let wanted = (6.0 * (size / room).log2()).clamp(f64::from(self.min_quantizer), coarsest);
        if is_intra {
            return wanted.max(self.quantizer).ceil() as u8;
        }
        // A step that would be taken back at once is not taken.
        if wanted > self.quantizer || wanted < self.quantizer - 1.0 || wanted <= f64::from(self.min_quantizer)
        {
            self.quantizer = wanted.ceil();
        }
        self.quantizer as u8
    }

    /// Returns the round trip of the newest frame: the time from sending it to learning that it has arrived.
    pub fn round_trip(&self) -> Option<Duration> {
        self.round_trip
    }

    /// Records that a frame with this quantizer and number of bytes was handed to the transport.
    pub fn sent(&mut self, number: u32, is_intra: bool, (quantizer, bytes): (u8, usize), now: Duration) {
        let (now, bytes) = (now.as_secs_f64(), bytes as f64);
        if let Some(last) = self.frames.back() {
            let passed = now - last.time;
            // It was due, but was not made at once.
            if self.due_since.take().is_some_and(|since| now - since > LATE_REQUEST) {
                let interval = passed.clamp(self.interval, MAX_INTERVAL);
                self.requested += REQUESTED_WEIGHT * (interval - self.requested);
            }
            if passed > PAUSE {
                self.trend.forget();
                self.rate.forget();
            }
        }
        // H.264's quantizer step doubles with each 6, and bits halve about then.
        let size = bytes * (f64::from(quantizer) / 6.0).exp2();
        let mean = &mut self.sizes[usize::from(is_intra)];
        *mean = Some(mean.map_or(size, |mean| mean + SIZE_WEIGHT * (size - mean)));
        let time = now;
        self.frames.push_back(Sent { number, time, bytes, is_intra, has_arrived: false, is_given_up: false });
        if self.frames.len() > MAX_REMEMBERED {
            self.frames.pop_front();
        }
        self.debt = (self.debt_at(now) + bytes, now);
        self.next = (self.next + self.interval).max(now);
    }

    /// Takes what the client says about frames.
    pub fn report(&mut self, report: &Report, now: Duration) {
        let now = now.as_secs_f64();
        let newest = report.arrivals.iter().flatten().map(|arrival| arrival.number).max();
        let mut arrivals: Vec<_> = report.arrivals.iter().flatten().collect();
        arrivals.sort_by_key(|arrival| arrival.number);
        for arrival in arrivals {
            self.arrived(arrival.number, arrival.time_ms, Some(arrival.number) == newest, now);
        }
        if let Some(decoded) = report.decoded
            && self.decoded.is_none_or(|before| before < decoded)
        {
            (self.decoded, self.progress) = (Some(decoded), now);
            // Frames before this one are not shown any more.
            let done = self.frames.partition_point(|frame| frame.number <= decoded);
            self.frames.drain(..done);
        }
    }

    /// Records that a frame has arrived at a time in ms of the client's clock.
    fn arrived(&mut self, number: u32, time_ms: f64, is_newest: bool, now: f64) {
        let Some(frame) = self.frames.iter_mut().find(|frame| frame.number == number && !frame.has_arrived)
        else {
            return;
        };
        frame.has_arrived = true;
        let Sent { time, bytes, is_intra, is_given_up, .. } = *frame;
        (self.progress, self.give_up) = (now, GIVE_UP_TIMEOUT);
        let round_trip = now - time;
        self.rate.arrived(time, time_ms * 1e-3, bytes);
        // Larger frames take longer, as in the draft's own filter. Of an intra frame, that is most of its delay.
        if let Some(arriving) = self.rate.arriving().filter(|_| !is_intra) {
            let usual = self.usual.get_or_insert(bytes);
            let more = bytes - *usual;
            *usual += SIZE_WEIGHT * more;
            // Of another quantizer's frames, the rate of before says little.
            let longer = (more / arriving).clamp(-self.interval, self.interval);
            self.trend.add(time * 1e3, time_ms - longer * 1e3);
        }
        // What has arrived is in no queue, whatever the rate was when it was sent.
        self.debt = (self.debt_at(now).min(self.bytes_in_flight()), now);
        if !is_newest || is_given_up {
            return;
        }
        if self.rate.begin(bytes, round_trip) {
            self.trend.forget();
        }
        self.round_trip = Some(Duration::from_secs_f64(round_trip.max(0.0)));
        if now - self.window_start >= ROUND_TRIP_WINDOW {
            (self.fastest, self.window_start) = ([[f64::INFINITY, 0.0], self.fastest[0]], now);
        }
        if round_trip < self.fastest[0][0] {
            self.fastest[0] = [round_trip, self.expected(false) / self.rate.bytes_per_second];
        }
        let is_full = std::mem::take(&mut self.is_full);
        self.full = if is_full { self.full + 1 } else { 0 };
        let queue = match self.trend.queue() {
            // It does not grow any more, but only because what is on its way fills it up.
            Queue::Steady if self.full >= LONG_FULL && self.trend.stands() => Queue::Grows,
            // One may have begun.
            Queue::Steady if self.trend.is_late() => Queue::Shrinks,
            queue => queue,
        };
        self.rate.follow(queue, self.trend.is_stalled(), is_full, round_trip, now);
    }

    /// Stops waiting for the frames on their way if nothing has arrived for long: one more is sent, whatever has become
    /// of them.
    pub fn give_up_late(&mut self, now: Duration) {
        let Some(oldest) = self.frames.iter().find(|frame| !frame.is_given_up) else { return };
        let now = now.as_secs_f64();
        let silence = now - self.progress.max(oldest.time);
        if silence < self.give_up.as_secs_f64() {
            return;
        }
        self.give_up = (2 * self.give_up).min(MAX_TIMEOUT);
        self.rate.give_up(silence, now);
        self.trend.forget();
        self.frames.iter_mut().for_each(|frame| frame.is_given_up = true);
    }

    fn bytes_in_flight(&self) -> f64 {
        let in_flight = self.frames.iter().filter(|frame| !frame.has_arrived && !frame.is_given_up);
        in_flight.map(|frame| frame.bytes).sum()
    }

    /// Returns the fastest round trip in s. At a lower rate than then, a frame's own bytes take longer.
    fn fastest(&self) -> f64 {
        let [a, b] = self.fastest;
        let [round_trip, own] = if a[0] <= b[0] { a } else { b };
        round_trip + (self.expected(false) / self.rate.bytes_per_second - own).max(0.0)
    }

    /// Returns the bytes that have been sent beyond the rate.
    fn debt_at(&self, now: f64) -> f64 {
        let (debt, since) = self.debt;
        (debt - (now - since) * self.rate.bytes_per_second).max(0.0)
    }

    /// Returns the bytes that a frame would have at quantizer 0; `None` if none is known.
    fn size(&self, is_intra: bool) -> Option<f64> {
        let [inter, intra] = self.sizes;
        if is_intra {
            intra.or(inter.map(|size| size * INTRA_FACTOR))
        } else {
            inter.or(intra.map(|size| size / INTRA_FACTOR))
        }
    }

    /// Returns the bytes that the next frame will probably have.
    fn expected(&self, is_intra: bool) -> f64 {
        self.size(is_intra).map_or(0.0, |size| size * (-self.quantizer / 6.0).exp2())
    }
}
