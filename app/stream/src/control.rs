use std::collections::VecDeque;
use std::time::Duration;

/// The largest quantizer that is used: coarser pictures are no use, and frames are left out instead.
const MAX_QUANTIZER: u8 = 44;
/// A frame that takes so much longer than the fastest ones has waited in a queue.
const QUEUEING: Duration = Duration::from_millis(15);
/// A frame that takes so much longer stands for several late ones.
const STUCK: Duration = Duration::from_millis(60);
/// So many late frames in a row make pictures coarser.
const MOST_LATE: u32 = 3;
/// The quantizer falls by one when the newest frame was not late and the quantizer has not changed for so long.
const CALM: Duration = Duration::from_secs(1);
/// The fastest round trip is that of the last one or two of these.
const WINDOW: Duration = Duration::from_secs(5);

/// Decides when a frame is made and how finely it is encoded, from the times at which the viewer has decoded frames. All times
/// are of one clock, the server's, so that no clocks need to agree.
///
/// Nothing waits in a queue: while the oldest frame on its way takes too long, none is made, and the next one that is made
/// shows the newest pose.
#[derive(Clone, Debug)]
pub struct RateControl {
    interval: Duration,
    min_quantizer: u8,
    quantizer: u8,
    /// The next frame is not made before.
    next: Duration,
    /// Number and time of the frames that are on their way.
    in_flight: VecDeque<(u32, Duration)>,
    /// The fastest round trips of this window and the one before.
    fastest: [Option<Duration>; 2],
    window_start: Duration,
    late: u32,
    changed: Duration,
    round_trip: Option<Duration>,
}

impl RateControl {
    /// Starts with frames of quantizer `min_quantizer`, which is never undercut, at most `frame_rate` a second.
    pub fn new(min_quantizer: u8, frame_rate: f32) -> RateControl {
        RateControl {
            interval: Duration::from_secs_f32(1.0 / frame_rate),
            min_quantizer,
            quantizer: min_quantizer,
            next: Duration::ZERO,
            in_flight: VecDeque::new(),
            fastest: [None; 2],
            window_start: Duration::ZERO,
            late: 0,
            changed: Duration::ZERO,
            round_trip: None,
        }
    }

    /// True if a frame is due.
    pub fn is_due(&self, now: Duration) -> bool {
        let flows = match (self.in_flight.front(), self.fastest()) {
            (None, _) => true,
            (Some((_, sent)), Some(fastest)) => {
                now.saturating_sub(*sent) < fastest + self.interval + 2 * QUEUEING
            }
            (Some(_), None) => false,
        };
        now >= self.next && flows
    }

    /// Returns the quantizer for the next frame.
    pub fn quantizer(&self) -> u8 {
        self.quantizer
    }

    /// Returns the time from sending a frame to knowing that it is decoded, of the newest that is.
    pub fn round_trip(&self) -> Option<Duration> {
        self.round_trip
    }

    /// Notes that a frame is handed to the transport.
    pub fn sent(&mut self, number: u32, now: Duration) {
        self.in_flight.push_back((number, now));
        self.next = (self.next + self.interval).max(now);
    }

    /// Notes that the viewer has decoded a frame. Numbers that are not on their way change nothing.
    pub fn decoded(&mut self, number: u32, now: Duration) {
        let Some(at) = self.in_flight.iter().position(|(in_flight, _)| *in_flight == number) else { return };
        // Those before it were not shown.
        let (_, sent) = self.in_flight.drain(..=at).next_back().unwrap_or((number, now));
        let round_trip = now.saturating_sub(sent);
        self.round_trip = Some(round_trip);
        if now.saturating_sub(self.window_start) >= WINDOW {
            self.fastest = [None, self.fastest[0]];
            self.window_start = now;
        }
        self.fastest[0] = Some(self.fastest[0].map_or(round_trip, |fastest| fastest.min(round_trip)));
        let fastest = self.fastest().unwrap_or(round_trip);
        self.late = match round_trip - fastest {
            waited if waited > STUCK => self.late + MOST_LATE,
            waited if waited > QUEUEING => self.late + 1,
            _ => 0,
        };
        let since = now.saturating_sub(self.changed);
        // What was on its way at the last change tells nothing about it.
        if self.late >= MOST_LATE && sent >= self.changed {
            // Two steps save about a fifth of the bits.
            self.quantizer = (self.quantizer + 2).min(MAX_QUANTIZER.max(self.min_quantizer));
            (self.late, self.changed) = (0, now);
        } else if self.late == 0 && since >= CALM && self.quantizer > self.min_quantizer {
            self.quantizer -= 1;
            self.changed = now;
        }
    }

    fn fastest(&self) -> Option<Duration> {
        self.fastest.iter().flatten().min().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng as _, SeedableRng as _};
    use rand_pcg::Pcg32;

    /// A link as a reliable stream shows it: what is lost is sent again, and what comes after it waits.
    #[derive(Clone, Copy)]
    struct Link {
        bytes_per_second: f64,
        delay: f64,
        jitter: f64,
        loss: f64,
    }

    const LAN: Link = Link { bytes_per_second: 12e6, delay: 0.002, jitter: 0.002, loss: 0.0 };
    const FRAME_RATE: f32 = 60.0;
    /// Bytes of a frame at quantizer 20: 24 Mbit/s at 60 Hz.
    const BYTES_AT_20: f64 = 50e3;

    struct Outcome {
        /// Seconds from making to decoding a frame, by the time of making.
        ages: Vec<(f64, f64)>,
        quantizer: u8,
        bytes: f64,
    }

    impl Outcome {
        /// Frames a second, and the age in seconds that 95 % undercut, from a time on.
        fn from(&self, start: f64, end: f64) -> (f64, f64) {
            let within = self.ages.iter().filter(|(made, _)| (start..end).contains(made));
            let mut ages: Vec<f64> = within.map(|(_, age)| *age).collect();
            ages.sort_by(f64::total_cmp);
            (ages.len() as f64 / (end - start), ages[ages.len() * 95 / 100])
        }
    }

    /// Runs a stream for some virtual seconds over a link that may change with time.
    fn run(seconds: f64, link: impl Fn(f64) -> Link) -> Outcome {
        let mut control = RateControl::new(20, FRAME_RATE);
        let mut random = Pcg32::seed_from_u64(7);
        let mut outcome = Outcome { ages: Vec::new(), quantizer: 20, bytes: 0.0 };
        let (mut free, mut last_arrival) = (0.0f64, 0.0f64);
        let mut acknowledgements: VecDeque<(f64, u32)> = VecDeque::new();
        let mut number = 0;
        for millisecond in 0..(seconds * 1e3) as u64 {
            let now = millisecond as f64 * 1e-3;
            let time = Duration::from_secs_f64(now);
            while let Some((_, number)) = acknowledgements.pop_front_if(|(at, _)| *at <= now) {
                control.decoded(number, time);
            }
            if !control.is_due(time) {
                continue;
            }
            let link = link(now);
            let finer = f64::from(control.quantizer()) - 20.0;
            let mut bytes = BYTES_AT_20 * (-finer / 6.0).exp2() * random.random_range(0.8..1.2);
            if number == 0 {
                bytes *= 6.0;
            }
            free = free.max(now) + bytes / link.bytes_per_second;
            let again = if random.random_bool(link.loss) { 2.0 * link.delay + 0.02 } else { 0.0 };
            let arrival = free + link.delay + link.jitter * random.random_range(0.0..1.0) + again;
            last_arrival = last_arrival.max(arrival);
            let decoded = last_arrival + 0.004;
            acknowledgements.push_back((decoded + link.delay, number));
            outcome.ages.push((now, decoded - now));
            outcome.bytes += bytes;
            control.sent(number, time);
            number += 1;
        }
        outcome.quantizer = control.quantizer();
        outcome
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
        // A third of what the min_quantizer pictures take.
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
        let outcome = run(20.0, |_| Link { delay: 0.01, jitter: 0.01, loss: 0.02, ..LAN });
        let (rate, age) = outcome.from(1.0, 20.0);
        assert!(rate > 50.0 && age < 0.08, "{rate} Hz, {age} s");
    }

    #[test]
    fn a_link_that_stands_still_gets_a_few_frames_and_then_the_newest() {
        let mut control = RateControl::new(20, FRAME_RATE);
        let mut sent = 0;
        for millisecond in 0..7000 {
            let now = Duration::from_millis(millisecond);
            if control.is_due(now) {
                control.sent(sent, now);
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
}
