//! Virtual time. The application sees a clock that advances with the frames that it shows, at the display's rate, and
//! otherwise only when every thread waits: then to the earliest instant that one of them waits for. A run gives the
//! same pictures and the same log on a fast machine and on a slow one.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::host::{host, lock};
use crate::threads;

/// Time since boot, nanoseconds, that the application's clocks show.
pub struct Clock {
    now: AtomicU64,
    period: u64,
    slept: u64,
    realtime_offset: u64,
    waiting: Mutex<BTreeMap<u64, u64>>,
    last_wait: AtomicU64,
}

/// A thread's wait for an instant, until this is dropped.
pub struct Wait<'a> {
    clock: &'a Clock,
    number: u64,
    instant: u64,
}

impl Drop for Wait<'_> {
    fn drop(&mut self) {
        lock(&self.clock.waiting).remove(&self.number);
    }
}

impl Wait<'_> {
    /// True if the instant has come.
    pub fn is_over(&self) -> bool {
        self.clock.now() >= self.instant
    }

    /// Lets the instant come if it is the next that anybody waits for, the script lets time pass, and no thread of the
    /// process has anything to do. To be called again and again, with a short sleep in between.
    pub fn try_advance(&self) {
        let is_next = || lock(&self.clock.waiting).values().all(|other| *other >= self.instant);
        // Asked again at the end: a thread that ran at first may have begun to wait for something earlier.
        if is_next() && host().frames.time_may_pass() && nobody_runs() && is_next() {
            self.clock.advance_to(self.instant);
        }
    }
}

/// True if every other thread of the process sleeps. A thread that is ready but gets no processor counts as running, so
/// a loaded machine does not make time pass.
fn nobody_runs() -> bool {
    threads::others().is_some_and(|mut others| others.all(|(_, state)| !matches!(state, 'R' | 'D')))
}

/// A device is never asked at the moment of its boot.
const BOOTED: u64 = 1_000_000_000_000;

impl Clock {
    /// A clock of a device whose display refreshes `refresh_hz` times a second, and that has slept for a time.
    pub fn new(refresh_hz: f64, slept_seconds: f64) -> Self {
        let realtime = std::time::SystemTime::now()
            .duration_since(std::time::UNIX_EPOCH)
            .map_or(BOOTED, |time| time.as_nanos() as u64);
        Self {
            now: AtomicU64::new(BOOTED),
            period: (1e9 / refresh_hz).round() as u64,
            slept: (slept_seconds * 1e9) as u64,
            realtime_offset: realtime.saturating_sub(BOOTED),
            waiting: Mutex::default(),
            last_wait: AtomicU64::new(0),
        }
    }

    /// Nanoseconds of CLOCK_MONOTONIC.
    pub fn now(&self) -> u64 {
        self.now.load(Ordering::Acquire)
    }

    /// An instant of CLOCK_MONOTONIC as one of CLOCK_BOOTTIME, which goes on while the device sleeps.
    pub fn boottime_of(&self, instant: u64) -> u64 {
        instant + self.slept
    }

    /// Nanoseconds of CLOCK_REALTIME.
    pub fn realtime(&self) -> u64 {
        self.now() + self.realtime_offset
    }

    /// A CLOCK_REALTIME instant as one of CLOCK_MONOTONIC.
    pub fn monotonic_of(&self, instant: u64) -> u64 {
        instant.saturating_sub(self.realtime_offset)
    }

    /// Seconds since the start of the run.
    pub fn seconds(&self) -> f64 {
        (self.now() - BOOTED) as f64 * 1e-9
    }

    /// Moves the time forward, never back: several threads that wait for the same instant move it once.
    pub fn advance_to(&self, instant: u64) {
        self.now.fetch_max(instant, Ordering::AcqRel);
    }

    /// Notes that the calling thread waits for an instant.
    pub fn wait_for(&self, instant: u64) -> Wait<'_> {
        let number = self.last_wait.fetch_add(1, Ordering::Relaxed);
        lock(&self.waiting).insert(number, instant);
        Wait { clock: self, number, instant }
    }

    /// Nanoseconds between two refreshes.
    pub fn period(&self) -> u64 {
        self.period
    }

    /// The first refresh after `instant`.
    pub fn next_refresh(&self, instant: u64) -> u64 {
        let since = instant.saturating_sub(BOOTED);
        BOOTED + (since / self.period + 1) * self.period
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refreshes_are_periodic_and_time_never_goes_back() {
        let clock = Clock::new(72.0, 0.0);
        let first = clock.next_refresh(clock.now());
        assert_eq!(first - BOOTED, 13_888_889);
        assert_eq!(clock.next_refresh(first) - first, clock.period());
        clock.advance_to(first);
        clock.advance_to(first - 5);
        assert_eq!(clock.now(), first);
        assert_eq!(clock.monotonic_of(clock.realtime()), first);
    }
}
