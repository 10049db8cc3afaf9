//! Follows a device's log across lost connections. Each line that the device still has is returned exactly once.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Duration;

use super::adb::{Device, DeviceError, LogEvent, LogStream, now, sleep};
use super::{log, phone};

/// A log is read again from this many seconds before its last line, since simultaneous lines need not be in order.
const OVERLAP_S: f64 = 5.0;
/// Number of lines that are remembered to recognise repeated ones.
const REMEMBERED: usize = 4096;
/// Interval at which reconnecting to a lost device is tried.
const RETRY: Duration = Duration::from_secs(1);

/// An event while a log is followed.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A new line as it came, with its line end.
    Line(Vec<u8>),
    /// No line came in the time given.
    Quiet,
    /// The device was lost.
    Lost,
    /// The device is back.
    Back {
        /// The time for which it was gone, in seconds.
        seconds: f64,
        /// True if it was restarted meanwhile.
        rebooted: bool,
    },
}

/// A log that is followed across lost connections.
pub struct Follower<'a> {
    device: &'a Device,
    stream: Option<LogStream>,
    seen: VecDeque<u64>,
    /// True after a lost connection, when lines may repeat.
    overlaps: bool,
    clock_s: Option<f64>,
    boot: String,
    lost_at: Option<f64>,
}

impl<'a> Follower<'a> {
    /// Starts to follow the log from now on.
    pub fn new(device: &'a Device) -> Result<Follower<'a>, DeviceError> {
        let boot = phone::boot_id(device)?;
        let stream = Some(device.logcat(Some(&phone::clock(device)?))?);
        let seen = VecDeque::with_capacity(REMEMBERED);
        Ok(Follower { device, stream, seen, overlaps: false, clock_s: None, boot, lost_at: None })
    }

    /// Returns the seconds since the device was lost, or `None` if it is connected.
    pub fn lost_for(&self) -> Option<f64> {
        self.lost_at.map(|then| now() - then)
    }

    /// Returns the next event. Waits for `wait`, or somewhat longer if a device does not answer.
    ///
    /// # Errors
    /// [`DeviceError`] for anything but a lost connection.
    pub fn next(&mut self, wait: Duration) -> Result<Event, DeviceError> {
        loop {
            let Some(stream) = &mut self.stream else { return self.come_back() };
            match stream.next(wait) {
                LogEvent::Quiet => return Ok(Event::Quiet),
                LogEvent::Line(line) => {
                    if self.is_new(&line) {
                        return Ok(Event::Line(line));
                    }
                }
                LogEvent::Ended => {
                    self.stream = None;
                    self.lost_at = Some(now());
                    return Ok(Event::Lost);
                }
            }
        }
    }

    fn is_new(&mut self, line: &[u8]) -> bool {
        let text = log::text(line);
        let entry = match log::parse(&text) {
            log::Kind::Entry(entry) => Some(entry),
            // Each connection has marks of its own, so repeated ones are dropped.
            log::Kind::Mark => return !self.overlaps,
            log::Kind::Damaged => None,
        };
        let mut hasher = DefaultHasher::new();
        line.hash(&mut hasher);
        let hash = hasher.finish();
        if self.overlaps && self.seen.contains(&hash) {
            return false;
        }
        if self.seen.len() == REMEMBERED {
            self.seen.pop_front();
        }
        self.seen.push_back(hash);
        self.clock_s = entry.and_then(|entry| entry.time_s).or(self.clock_s);
        true
    }

    fn come_back(&mut self) -> Result<Event, DeviceError> {
        match self.open_again() {
            Ok(event) => Ok(event),
            Err(error) if error.is_lost() => {
                self.device.reconnect();
                sleep(RETRY);
                Ok(Event::Quiet)
            }
            Err(error) => Err(error),
        }
    }

    fn open_again(&mut self) -> Result<Event, DeviceError> {
        let boot = phone::boot_id(self.device)?;
        let rebooted = boot != self.boot;
        // After a restart all lines are new, and the clock may have been set back.
        let since = self.clock_s.filter(|_| !rebooted).map(|clock| format!("{:.6}", clock - OVERLAP_S));
        self.stream = Some(self.device.logcat(since.as_deref())?);
        self.overlaps = true;
        self.boot = boot;
        let seconds = self.lost_for().unwrap_or(0.0);
        self.lost_at = None;
        Ok(Event::Back { seconds, rebooted })
    }
}
