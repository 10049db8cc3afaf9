//! Decides when a stream's frames are made, and how finely they are encoded.

use std::collections::VecDeque;
use std::time::Duration;

/// The largest quantizer used. Coarser pictures are useless, so frames are dropped instead.
const MAX_QUANTIZER: u8 = 44;
/// A frame whose round trip exceeds the fastest one by this much has waited in a queue and counts as late.
const LATE_DELAY: Duration = Duration::from_millis(15);
/// A frame whose round trip exceeds the fastest one by this much counts as [`LATE_FRAMES_LIMIT`] late frames.
const STALL_DELAY: Duration = Duration::from_millis(60);
/// After this many consecutive late frames, pictures become coarser.
const LATE_FRAMES_LIMIT: u32 = 3;
/// The quantizer decreases by one if the newest frame was not late and the quantizer has not changed for this long.
const QUANTIZER_RECOVERY: Duration = Duration::from_secs(1);
/// The fastest round trip is taken over the last one or two windows of this length.
const ROUND_TRIP_WINDOW: Duration = Duration::from_secs(5);
/// The factor by which frames may exceed the frame rate. A client that requests frames at this rate by its own clock
/// must not have to wait for the server's clock.
const RATE_HEADROOM: f32 = 1.05;
/// If a frame is in flight for this long, all frames in flight are given up, where the transport supports it. The time
/// doubles with each round that is given up, until a frame is decoded.
const GIVE_UP_TIMEOUT: Duration = Duration::from_millis(500);

/// Decides when a frame is made and how finely it is encoded, from the times at which the client has decoded frames.
/// All times are of one clock, the server's, so clocks need not be synchronized.
///
/// Nothing waits in a queue: while the oldest frame in flight takes too long, no frame is made, and the next one that
/// is made shows the newest pose. A frame that is lost or given up is followed by an intra frame.
#[derive(Clone, Debug)]
pub struct RateControl {
    interval: Duration,
    min_quantizer: u8,
    quantizer: u8,
    /// The earliest time for the next frame.
    next: Duration,
    /// Number and sending time of each frame in flight.
    in_flight: VecDeque<(u32, Duration)>,
    /// The fastest round trips of the present window and the previous one.
    fastest: [Option<Duration>; 2],
    window_start: Duration,
    late: u32,
    changed: Duration,
    round_trip: Option<Duration>,
    /// The number of the last intra frame.
    intra: u32,
    /// True if the next frame must be an intra frame.
    needs_intra: bool,
    give_up: Duration,
    lost: u32,
}

impl RateControl {
    /// Starts with quantizer `min_quantizer`, which is also the lower limit, and at most about `frame_rate` frames/s.
    pub fn new(min_quantizer: u8, frame_rate: f32) -> RateControl {
        RateControl {
            interval: Duration::from_secs_f32(1.0 / (RATE_HEADROOM * frame_rate)),
            min_quantizer,
            quantizer: min_quantizer,
            next: Duration::ZERO,
            in_flight: VecDeque::new(),
            fastest: [None; 2],
            window_start: Duration::ZERO,
            late: 0,
            changed: Duration::ZERO,
            round_trip: None,
            intra: 0,
            needs_intra: true,
            give_up: GIVE_UP_TIMEOUT,
            lost: 0,
        }
    }

    /// True if a frame is due.
    pub fn is_due(&self, now: Duration) -> bool {
        let flows = match (self.in_flight.front(), self.fastest()) {
            (None, _) => true,
            (Some((_, sent)), Some(fastest)) => {
                now.saturating_sub(*sent) < fastest + self.interval + 2 * LATE_DELAY
            }
            (Some(_), None) => false,
        };
        // A quarter of an interval of tolerance, since a client's requests are not exactly evenly spaced.
        now + self.interval / 4 >= self.next && flows
    }

    /// Returns the quantizer for the next frame.
    pub fn quantizer(&self) -> u8 {
        self.quantizer
    }

    /// Returns the round trip of the newest decoded frame: the time from sending it to learning that it is decoded.
    pub fn round_trip(&self) -> Option<Duration> {
        self.round_trip
    }

    /// True if the next frame must be an intra frame.
    pub fn needs_intra(&self) -> bool {
        self.needs_intra
    }

    /// Returns the number of frames that the client could not decode or that were given up.
    pub fn lost(&self) -> u32 {
        self.lost
    }

    /// Records that a frame was handed to the transport.
    pub fn sent(&mut self, number: u32, is_intra: bool, now: Duration) {
        if is_intra {
            (self.intra, self.needs_intra) = (number, false);
        }
        self.in_flight.push_back((number, now));
        self.next = (self.next + self.interval).max(now);
    }

    /// Records that the client has decoded a frame. Numbers of frames that are not in flight are ignored.
    pub fn decoded(&mut self, number: u32, now: Duration) {
        let Some(at) = self.in_flight.iter().position(|(in_flight, _)| *in_flight == number) else { return };
        // Frames before this one were not shown.
        let (_, sent) = self.in_flight.drain(..=at).next_back().unwrap_or((number, now));
        self.give_up = GIVE_UP_TIMEOUT;
        let round_trip = now.saturating_sub(sent);
        self.round_trip = Some(round_trip);
        if now.saturating_sub(self.window_start) >= ROUND_TRIP_WINDOW {
            self.fastest = [None, self.fastest[0]];
            self.window_start = now;
        }
        self.fastest[0] = Some(self.fastest[0].map_or(round_trip, |fastest| fastest.min(round_trip)));
        let fastest = self.fastest().unwrap_or(round_trip);
        self.late = match round_trip - fastest {
            waited if waited > STALL_DELAY => self.late + LATE_FRAMES_LIMIT,
            waited if waited > LATE_DELAY => self.late + 1,
            _ => 0,
        };
        let since = now.saturating_sub(self.changed);
        // A frame sent before the last change says nothing about that change.
        if self.late >= LATE_FRAMES_LIMIT && sent >= self.changed {
            // Two steps save about a fifth of the bits.
            self.quantizer = (self.quantizer + 2).min(MAX_QUANTIZER.max(self.min_quantizer));
            (self.late, self.changed) = (0, now);
        } else if self.late == 0 && since >= QUANTIZER_RECOVERY && self.quantizer > self.min_quantizer {
            self.quantizer -= 1;
            self.changed = now;
        }
    }

    /// Records that the client misses a frame, without which it cannot decode any before the next intra frame.
    pub fn missing(&mut self, number: u32) {
        if number >= self.intra {
            self.drop_from(number);
        }
    }

    /// True if the frames in flight take so long that they are given up. All of them are useless then, as the next
    /// frame is an intra frame.
    pub fn gives_up(&mut self, now: Duration) -> bool {
        let oldest = self.in_flight.front().filter(|_| self.fastest().is_some());
        let gives_up = oldest.is_some_and(|(_, sent)| now.saturating_sub(*sent) > self.give_up);
        if gives_up {
            self.drop_from(0);
            self.give_up *= 2;
        }
        gives_up
    }

    /// Forgets all frames in flight, and counts those from `number` on as lost.
    fn drop_from(&mut self, number: u32) {
        let kept = self.in_flight.partition_point(|(in_flight, _)| *in_flight < number);
        self.lost = self.lost.saturating_add((self.in_flight.len() - kept) as u32);
        self.in_flight.clear();
        self.needs_intra = true;
    }

    fn fastest(&self) -> Option<Duration> {
        self.fastest.iter().flatten().min().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FromClient, ReorderBuffer};
    use rand::{Rng as _, SeedableRng as _};
    use rand_pcg::Pcg32;

    /// A link, with the times in seconds that it takes.
    #[derive(Clone, Copy)]
    struct Link {
        bytes_per_second: f64,
        delay: f64,
        jitter: f64,
        /// The share of frames of which a part is sent again.
        again: f64,
        /// The share of frames that never arrive.
        lost: f64,
        /// True if frames arrive in order, each after those before it, as with WebSocket. Otherwise each arrives
        /// independently, and frames that were given up take no time, as with WebTransport.
        in_order: bool,
    }

    const LAN: Link =
        Link { bytes_per_second: 12e6, delay: 0.002, jitter: 0.002, again: 0.0, lost: 0.0, in_order: true };
    const FRAME_RATE: f32 = 60.0;
    /// Bytes of a frame at quantizer 20: 24 Mbit/s at 60 Hz.
    const BYTES_AT_20: f64 = 50e3;
    /// Seconds that it takes to decode a frame.
    const DECODE: f64 = 0.004;

    struct Outcome {
        /// For each frame, the time at which it was made, and the seconds from then until it was decoded.
        ages: Vec<(f64, f64)>,
        quantizer: u8,
        bytes: f64,
        intra: u32,
        /// Frames that the client did not decode, as counted by the client and by the server.
        lost: [u32; 2],
    }

    impl Outcome {
        /// Returns frames/s and the 95th percentile of ages in seconds, of frames made from `start` to `end`.
        fn from(&self, start: f64, end: f64) -> (f64, f64) {
            let within = self.ages.iter().filter(|(made, _)| (start..end).contains(made));
            let mut ages: Vec<f64> = within.map(|(_, age)| *age).collect();
            ages.sort_by(f64::total_cmp);
            (ages.len() as f64 / (end - start), ages[ages.len() * 95 / 100])
        }
    }

    /// Runs a stream for some virtual seconds over a link that may change with time. Checks that the client has every
    /// frame that a decoded one refers to.
    fn run(seconds: f64, link: impl Fn(f64) -> Link) -> Outcome {
        let mut control = RateControl::new(20, FRAME_RATE);
        let mut buffer = ReorderBuffer::default();
        let mut random = Pcg32::seed_from_u64(7);
        let mut outcome = Outcome { ages: Vec::new(), quantizer: 20, bytes: 0.0, intra: 0, lost: [0; 2] };
        let (mut free, mut last_arrival) = (0.0f64, 0.0f64);
        // Frames and the client's messages in flight, each with its time of arrival.
        let mut down: Vec<(f64, Frame)> = Vec::new();
        let mut up: VecDeque<(f64, FromClient)> = VecDeque::new();
        let (mut number, mut decoded) = (0, None);
        for millisecond in 0..(seconds * 1e3) as u64 {
            let now = millisecond as f64 * 1e-3;
            let time = Duration::from_secs_f64(now);
            let link = link(now);
            down.sort_by(|(a, _), (b, _)| a.total_cmp(b));
            let come = down.partition_point(|(at, _)| *at <= now);
            for (_, frame) in down.drain(..come) {
                buffer.insert(frame.number, frame.is_intra, frame);
            }
            while let Some(frame) = buffer.pop() {
                assert!(frame.is_intra || decoded.is_some_and(|before| frame.number == before + 1));
                decoded = Some(frame.number);
                outcome.ages.push((frame.made, now + DECODE - frame.made));
                up.push_back((now + DECODE + link.delay, FromClient::Decoded(frame.number)));
            }
            if let Some(missing) = buffer.missing(time) {
                up.push_back((now + link.delay, FromClient::Missing(missing)));
            }
            while let Some((_, message)) = up.pop_front_if(|(at, _)| *at <= now) {
                match message {
                    FromClient::Decoded(number) => control.decoded(number, time),
                    FromClient::Missing(number) => control.missing(number),
                    _ => unreachable!("the client of this test says nothing else"),
                }
            }
            if !link.in_order && control.gives_up(time) {
                down.clear();
                free = now;
            }
            if !control.is_due(time) {
                continue;
            }
            let is_intra = control.needs_intra();
            let finer = f64::from(control.quantizer()) - 20.0;
            let mut bytes = BYTES_AT_20 * (-finer / 6.0).exp2() * random.random_range(0.8..1.2);
            if is_intra {
                bytes *= 6.0;
                outcome.intra += 1;
            }
            free = free.max(now) + bytes / link.bytes_per_second;
            let again = if random.random_bool(link.again) { 2.0 * link.delay + 0.02 } else { 0.0 };
            let mut arrival = free + link.delay + link.jitter * random.random_range(0.0..1.0) + again;
            if link.in_order {
                last_arrival = last_arrival.max(arrival);
                arrival = last_arrival;
            }
            if !random.random_bool(link.lost) {
                down.push((arrival, Frame { number, is_intra, made: now }));
            }
            outcome.bytes += bytes;
            control.sent(number, is_intra, time);
            number += 1;
        }
        outcome.quantizer = control.quantizer();
        outcome.lost = [buffer.lost(), control.lost()];
        outcome
    }

    /// A frame in flight.
    struct Frame {
        number: u32,
        is_intra: bool,
        /// The time at which it was made, in seconds.
        made: f64,
    }

    #[test]
    fn on_a_wide_link_frames_come_at_the_full_rate_and_quality() {
        let outcome = run(10.0, |_| LAN);
        let (rate, age) = outcome.from(1.0, 10.0);
        assert!(
            rate > 57.0 && age < 0.02 && outcome.quantizer == 20,
            "{rate} Hz, {age} s, {}",
            outcome.quantizer
        );
    }

    #[test]
    fn on_a_narrow_link_pictures_become_coarser_until_nothing_waits() {
        // A third of what pictures at `min_quantizer` take.
        let narrow = Link { bytes_per_second: 1e6, ..LAN };
        let outcome = run(20.0, |_| narrow);
        let (rate, age) = outcome.from(5.0, 20.0);
        assert!(rate > 45.0 && age < 0.06, "{rate} Hz, {age} s");
        let share = outcome.bytes / 20.0 / narrow.bytes_per_second;
        assert!(share > 0.6, "{share} of the link is used");
    }

    #[test]
    fn a_link_that_narrows_and_widens_is_followed() {
        let outcome = run(50.0, |now| match now {
            10.0..20.0 => Link { bytes_per_second: 0.8e6, ..LAN },
            _ => LAN,
        });
        let (rate, age) = outcome.from(13.0, 20.0);
        assert!(rate > 40.0 && age < 0.07, "{rate} Hz, {age} s");
        let (rate, age) = outcome.from(45.0, 50.0);
        assert!(
            rate > 57.0 && age < 0.02 && outcome.quantizer <= 21,
            "{rate} Hz, {age} s, {}",
            outcome.quantizer
        );
    }

    #[test]
    fn lost_packets_and_jitter_delay_frames_and_do_not_pile_them_up() {
        let outcome = run(20.0, |_| Link { delay: 0.01, jitter: 0.01, again: 0.02, ..LAN });
        let (rate, age) = outcome.from(1.0, 20.0);
        assert!(rate > 50.0 && age < 0.08, "{rate} Hz, {age} s");
    }

    #[test]
    fn frames_that_overtake_others_cost_no_intra_frame() {
        let outcome = run(20.0, |_| Link { jitter: 0.03, again: 0.02, in_order: false, ..LAN });
        let (rate, age) = outcome.from(1.0, 20.0);
        assert!(rate > 50.0 && age < 0.08, "{rate} Hz, {age} s");
        assert_eq!((outcome.intra, outcome.lost), (1, [0, 0]));
    }

    #[test]
    fn a_lost_frame_costs_an_intra_frame_and_those_that_refer_to_it() {
        let outcome = run(20.0, |_| Link { lost: 0.01, in_order: false, ..LAN });
        let (rate, age) = outcome.from(1.0, 20.0);
        assert!(rate > 45.0 && age < 0.06, "{rate} Hz, {age} s");
        assert!((2..30).contains(&outcome.intra), "{} intra frames", outcome.intra);
        let [seen, known] = outcome.lost;
        assert!(seen > 0 && seen.abs_diff(known) < 10, "{seen} frames are lost, {known} to the server");
    }

    #[test]
    fn after_a_gap_the_newest_frame_comes_first_where_others_can_be_given_up() {
        // For two seconds nothing arrives.
        let delay = |now| LAN.delay + if (5.0..7.0).contains(&now) { 7.0 - now } else { 0.0 };
        let outcome = run(10.0, |now| Link { delay: delay(now), in_order: false, ..LAN });
        assert!(outcome.lost[0] > 0 && outcome.intra < 6, "{:?}, {} intra", outcome.lost, outcome.intra);
        let (rate, age) = outcome.from(7.1, 10.0);
        assert!(rate > 57.0 && age < 0.02, "{rate} Hz, {age} s");
    }

    #[test]
    fn a_link_that_stands_still_gets_a_few_frames_and_then_the_newest() {
        let mut control = RateControl::new(20, FRAME_RATE);
        let mut sent = 0;
        for millisecond in 0..7000 {
            let now = Duration::from_millis(millisecond);
            if control.is_due(now) {
                control.sent(sent, sent == 0, now);
                if millisecond < 5000 {
                    control.decoded(sent, now + Duration::from_millis(6));
                } else {
                    assert!(millisecond < 5100, "a frame is made while the link stands still");
                }
                sent += 1;
            }
        }
        let now = Duration::from_millis(7000);
        control.decoded(sent - 1, now);
        assert!(control.is_due(now), "the newest frame that was decoded lets the next one be made");
    }

    /// When a client requests frames.
    #[derive(Clone, Copy, PartialEq)]
    enum Asking {
        /// Every 1/60 s, by a timer of its own.
        Timer,
        /// At each refresh of its display.
        Refresh,
    }

    /// Runs a stream for a virtual minute, with frames that take from `fastest` to `fastest + jitter` seconds from
    /// their request. Returns the mean age in seconds of what is shown: the time since the refresh at which its pose
    /// was drawn.
    fn mean_age(asking: Asking, refresh_rate: f64, fastest: f64, jitter: f64) -> f64 {
        let mut control = RateControl::new(20, FRAME_RATE);
        let mut random = Pcg32::seed_from_u64(3);
        let (mut refresh, mut ask, mut pose, mut number) = (0.0, 0.0, 0.0, 0);
        let (mut request, mut shown, mut sum, mut refreshes) = (None, None, 0.0, 0.0);
        // The frames in flight: the time at which they are decoded, their number and pose.
        let mut down: Vec<(f64, u32, f64)> = Vec::new();
        for step in 0..240_000 {
            let now = f64::from(step) * 0.25e-3;
            let time = Duration::from_secs_f64(now);
            for (_, number, pose) in down.extract_if(.., |(at, ..)| *at <= now) {
                control.decoded(number, time);
                shown = Some(pose);
            }
            if now >= refresh {
                if let Some(shown) = shown {
                    sum += refresh - shown;
                    refreshes += 1.0;
                }
                pose = refresh;
                refresh += 1.0 / refresh_rate;
                if asking == Asking::Refresh {
                    ask = now;
                }
            }
            if now >= ask {
                request = Some(pose);
                // The clocks differ slightly, so that all phases occur.
                ask = if asking == Asking::Timer { ask + 1.001 / 60.0 } else { f64::INFINITY };
            }
            if control.is_due(time)
                && let Some(pose) = request.take()
            {
                control.sent(number, number == 0, time);
                down.push((now + fastest + jitter * random.random_range(0.0..1.0), number, pose));
                number += 1;
            }
        }
        assert!((54 * 60..64 * 60).contains(&number), "{number} frames in a minute");
        sum / refreshes
    }

    #[test]
    fn what_is_asked_for_at_each_refresh_is_newer_when_it_is_shown() {
        for (refresh_rate, fastest, jitter, saved) in [
            (60.0, 0.014, 0.001, 0.01),
            (60.0, 0.014, 0.006, 0.005),
            (60.0, 0.027, 0.003, 0.01),
            (90.0, 0.014, 0.002, 0.0),
        ] {
            let [timer, refresh] = [Asking::Timer, Asking::Refresh]
                .map(|asking| mean_age(asking, refresh_rate, fastest, jitter));
            println!(
                "{refresh_rate} Hz, {:.0} to {:.0} ms: {:.1} ms by a timer, {:.1} ms at each refresh",
                fastest * 1e3,
                (fastest + jitter) * 1e3,
                timer * 1e3,
                refresh * 1e3
            );
            assert!(refresh < timer - saved, "{refresh_rate} Hz: {timer} s by a timer, {refresh} s");
        }
    }
}
