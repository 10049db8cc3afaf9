//! Times of sensor samples and displayed frames, in nanoseconds of the monotonic clock.

/// A refresh of the display, and Android's plan for a frame that begins with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refresh {
    /// The time at which the refresh begins.
    pub begin_ns: i64,
    /// Android's plan, from Android 13 on.
    pub timeline: Option<Timeline>,
}

/// Android's plan for a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    /// The time by which the GPU must have finished.
    pub deadline_ns: i64,
    /// The time at which the frame is displayed.
    pub display_ns: i64,
}

impl Refresh {
    /// Returns when a frame is displayed that begins with this refresh and is ready at `ready_ns`, with `period_ns`
    /// between refreshes. Without a timeline, a frame that is ready by the next refresh is displayed at the second one.
    pub fn display_ns(&self, ready_ns: i64, period_ns: i64) -> i64 {
        let usual =
            Timeline { deadline_ns: self.begin_ns + period_ns, display_ns: self.begin_ns + 2 * period_ns };
        let Timeline { deadline_ns, display_ns } = self.timeline.unwrap_or(usual);
        let late = (ready_ns - deadline_ns).max(0);
        // A late frame is delayed by whole refreshes.
        display_ns + (late + period_ns - 1) / period_ns * period_ns
    }
}

/// Converts the time of a sensor sample that has just arrived to the monotonic clock. `sample_ns` should be
/// CLOCK_BOOTTIME, but some drivers use CLOCK_MONOTONIC, which lags behind by `slept_ns`, the time that the device has
/// slept. The clock on which the sample's time is closer to `now_ns` is taken.
pub fn sample_time_ns(sample_ns: i64, now_ns: i64, slept_ns: i64) -> i64 {
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
        assert_eq!(sample_time_ns(5_000 * MS + slept, 5_003 * MS, slept), 5_000 * MS);
        assert_eq!(
            sample_time_ns(5_000 * MS, 5_003 * MS, slept),
            5_000 * MS,
            "a driver that takes the other clock"
        );
        assert_eq!(sample_time_ns(5_000 * MS, 5_003 * MS, 0), 5_000 * MS);
    }
}
