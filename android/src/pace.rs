//! When things happen: samples of the sensors, and frames on the display. Nanoseconds of the monotonic clock.

/// A refresh of the display, and what Android says of a frame that begins with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refresh {
    /// When it begins.
    pub begin_ns: i64,
    /// From Android 13 on.
    pub timeline: Option<Timeline>,
}

/// A frame as Android plans it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    /// The GPU has to be ready by then.
    pub deadline_ns: i64,
    /// And then it is seen.
    pub display_ns: i64,
}

impl Refresh {
    /// When a frame is seen that begins with this refresh and is ready at `ready_ns`, with `period_ns` between refreshes.
    /// Without a timeline it is the second refresh after this one, if it is ready by the first.
    pub fn display_ns(&self, ready_ns: i64, period_ns: i64) -> i64 {
        let usual =
            Timeline { deadline_ns: self.begin_ns + period_ns, display_ns: self.begin_ns + 2 * period_ns };
        let Timeline { deadline_ns, display_ns } = self.timeline.unwrap_or(usual);
        let late = (ready_ns - deadline_ns).max(0);
        // One that is late waits for a later refresh.
        display_ns + (late + period_ns - 1) / period_ns * period_ns
    }
}

/// The time of a sensor's sample, which has `sample_ns` on a clock that Android wants to be CLOCK_BOOTTIME; some drivers
/// take CLOCK_MONOTONIC, which is behind by the time `slept_ns` that the device has slept. The sample has just come, so its
/// clock is the one on which it is the younger.
pub fn of_sample(sample_ns: i64, now_ns: i64, slept_ns: i64) -> i64 {
    let by_boottime = sample_ns - slept_ns;
    if (now_ns - by_boottime).abs() <= (now_ns - sample_ns).abs() { by_boottime } else { sample_ns }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;
    const PERIOD: i64 = 10 * MS;

    #[test]
    fn a_frame_in_time_is_seen_as_planned() {
        let plain = Refresh { begin_ns: 1000 * MS, timeline: None };
        assert_eq!(plain.display_ns(1004 * MS, PERIOD), 1020 * MS);
        assert_eq!(plain.display_ns(1010 * MS, PERIOD), 1020 * MS);
        let timeline = Some(Timeline { deadline_ns: 1012 * MS, display_ns: 1034 * MS });
        let planned = Refresh { timeline, ..plain };
        assert_eq!(planned.display_ns(1011 * MS, PERIOD), 1034 * MS);
    }

    #[test]
    fn a_late_frame_waits_for_a_later_refresh() {
        let plain = Refresh { begin_ns: 1000 * MS, timeline: None };
        assert_eq!(plain.display_ns(1011 * MS, PERIOD), 1030 * MS);
        assert_eq!(plain.display_ns(1031 * MS, PERIOD), 1050 * MS);
        let timeline = Some(Timeline { deadline_ns: 1012 * MS, display_ns: 1034 * MS });
        assert_eq!(Refresh { timeline, ..plain }.display_ns(1013 * MS, PERIOD), 1044 * MS);
    }

    #[test]
    fn samples_are_put_on_the_clock_of_the_refreshes() {
        let slept = 3_600_000 * MS;
        assert_eq!(of_sample(5_000 * MS + slept, 5_003 * MS, slept), 5_000 * MS);
        assert_eq!(
            of_sample(5_000 * MS, 5_003 * MS, slept),
            5_000 * MS,
            "a driver that takes the other clock"
        );
        assert_eq!(of_sample(5_000 * MS, 5_003 * MS, 0), 5_000 * MS);
    }
}
