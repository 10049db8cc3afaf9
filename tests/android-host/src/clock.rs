//! Virtual time. The application's clock advances with each frame that it shows, by the display's rate. Otherwise it
//! only advances while all threads wait, to the earliest time that one of them waits for. A run therefore has the same
//! pictures and the same log on fast and on slow machines.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::host::{host, lock};
use crate::threads;

/// The clock that the application sees: time since boot in nanoseconds.
pub struct Clock {
    now: AtomicU64,
    /// The time between two refreshes in nanoseconds.
    pub period: u64,
    slept: u64,
    realtime_offset: u64,
    waiting: Mutex<BTreeMap<u64, u64>>,
    last_wait: AtomicU64,
}

/// A thread that waits for a time, until this is dropped.
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
    /// True if the time has come.
    pub fn is_over(&self) -> bool {
        self.clock.now() >= self.instant
    }

    /// Advances the clock to the time waited for, if no other thread waits for an earlier one, the script lets time
    /// pass, and no thread of the process is running. Call it repeatedly, with short sleeps in between.
    pub fn try_advance(&self) {
        let is_next = || lock(&self.clock.waiting).values().all(|other| *other >= self.instant);
        // `is_next` is checked again at the end, since a thread that was running may now wait for an earlier time.
        if is_next() && host().frames.time_may_pass() && nobody_runs() && is_next() {
            self.clock.advance_to(self.instant);
        }
    }
}

/// True if all other threads of the process sleep. A thread that is ready but gets no processor counts as running, so a
/// busy machine does not make time pass.
fn nobody_runs() -> bool {
    threads::others().is_some_and(|mut others| others.all(|(_, state)| !matches!(state, 'R' | 'D')))
}

/// Virtual time at the start of a run in nanoseconds: a device is never used at the moment of its boot.
const BOOTED: u64 = 1_000_000_000_000;

/// Refresh rate of the display. Virtual time advances by one period per frame.
pub const REFRESH_HZ: f64 = 60.0;

impl Clock {
    /// Creates the clock of a device that has slept for this time.
    pub fn new(slept_seconds: f64) -> Self {
        let realtime = std::time::SystemTime::now()
            .duration_since(std::time::UNIX_EPOCH)
            .map_or(BOOTED, |time| time.as_nanos() as u64);
        Self {
            now: AtomicU64::new(BOOTED),
            period: (1e9 / REFRESH_HZ).round() as u64,
            slept: (slept_seconds * 1e9) as u64,
            realtime_offset: realtime.saturating_sub(BOOTED),
            waiting: Mutex::default(),
            last_wait: AtomicU64::new(0),
        }
    }

    /// Returns the time of CLOCK_MONOTONIC in nanoseconds.
    pub fn now(&self) -> u64 {
        self.now.load(Ordering::Acquire)
    }

    /// Converts a time of CLOCK_MONOTONIC to one of CLOCK_BOOTTIME, which also advances while the device sleeps.
    pub fn boottime_of(&self, instant: u64) -> u64 {
        instant + self.slept
    }

    /// Returns the time of CLOCK_REALTIME in nanoseconds.
    pub fn realtime(&self) -> u64 {
        self.now() + self.realtime_offset
    }

    /// Converts a time of CLOCK_REALTIME to one of CLOCK_MONOTONIC.
    pub fn monotonic_of(&self, instant: u64) -> u64 {
        instant.saturating_sub(self.realtime_offset)
    }

    /// Returns the seconds since the start of the run.
    pub fn seconds(&self) -> f64 {
        (self.now() - BOOTED) as f64 * 1e-9
    }

    /// Advances the clock. It never goes back: several threads that wait for the same time advance it only once.
    pub fn advance_to(&self, instant: u64) {
        self.now.fetch_max(instant, Ordering::AcqRel);
    }

    /// Registers that the calling thread waits for a time.
    pub fn wait_for(&self, instant: u64) -> Wait<'_> {
        let number = self.last_wait.fetch_add(1, Ordering::Relaxed);
        lock(&self.waiting).insert(number, instant);
        Wait { clock: self, number, instant }
    }

    /// Returns the time of the first refresh after `instant`.
    pub fn next_refresh(&self, instant: u64) -> u64 {
        let since = instant.saturating_sub(BOOTED);
        BOOTED + (since / self.period + 1) * self.period
    }
}
