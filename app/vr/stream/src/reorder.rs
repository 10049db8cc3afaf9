//! The order of a stream's frames at the client, and what to do about a lost one.

use std::collections::BTreeMap;
use std::time::Duration;

/// How long a missing frame is waited for after a newer one has arrived.
const REORDER_TIMEOUT: Duration = Duration::from_millis(50);
/// After this time, an intra frame that does not arrive is requested again.
const INTRA_REQUEST_INTERVAL: Duration = Duration::from_millis(250);
/// The most frames that can wait for a missing one.
const MAX_WAITING_FRAMES: usize = 32;

/// Puts a stream's frames in order at the client, as a decoder needs them. Frames that depend on a lost one are not
/// decoded; decoding continues with an intra frame. All times are of one clock, the client's.
#[derive(Clone, Debug)]
pub struct ReorderBuffer<T> {
    /// The number of the next frame to decode.
    next: u32,
    /// Frames that arrived before others, and whether they are intra frames.
    waiting: BTreeMap<u32, (bool, T)>,
    /// The time from which the next frame has been missing, or at which an intra frame was last requested.
    since: Option<Duration>,
    /// True if an intra frame was requested.
    asked: bool,
    lost: u32,
}

impl<T> Default for ReorderBuffer<T> {
    /// Returns the buffer for a new connection, which begins with frame 0.
    fn default() -> ReorderBuffer<T> {
        ReorderBuffer { next: 0, waiting: BTreeMap::new(), since: None, asked: false, lost: 0 }
    }
}

impl<T> ReorderBuffer<T> {
    /// Adds a frame that has arrived, in any order.
    pub fn insert(&mut self, number: u32, is_intra: bool, frame: T) {
        if number < self.next {
            return;
        }
        if self.waiting.len() == MAX_WAITING_FRAMES {
            self.waiting.pop_first();
        }
        self.waiting.insert(number, (is_intra, frame));
    }

    /// Removes and returns the next frame to decode, if it has arrived.
    pub fn pop(&mut self) -> Option<T> {
        if *self.waiting.first_key_value()?.0 != self.next {
            // The newest intra frame does not depend on any frame before it.
            let (&intra, _) = self.waiting.iter().rev().find(|(_, (is_intra, _))| *is_intra)?;
            self.waiting = self.waiting.split_off(&intra);
            self.lost = self.lost.saturating_add(intra - self.next);
            self.next = intra;
        }
        (self.since, self.asked) = (None, false);
        let (_, frame) = self.waiting.remove(&self.next)?;
        self.next = self.next.wrapping_add(1);
        Some(frame)
    }

    /// Returns the number of a missing frame if an intra frame is to be requested now. Call this regularly, after all
    /// frames that can be decoded were taken.
    pub fn missing(&mut self, now: Duration) -> Option<u32> {
        if self.waiting.is_empty() && !self.asked {
            return None;
        }
        let waited = now.saturating_sub(*self.since.get_or_insert(now));
        if waited < if self.asked { INTRA_REQUEST_INTERVAL } else { REORDER_TIMEOUT } {
            return None;
        }
        (self.since, self.asked) = (Some(now), true);
        Some(self.next)
    }

    /// Returns the number of frames that were not decoded, because they or frames before them were lost or late.
    pub fn lost(&self) -> u32 {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: [u32; 0] = [];

    fn ms(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    /// Inserts frames whose content is their number, and returns those that can be decoded then.
    fn decoded(buffer: &mut ReorderBuffer<u32>, frames: &[(u32, bool)]) -> Vec<u32> {
        frames.iter().for_each(|(number, is_intra)| buffer.insert(*number, *is_intra, *number));
        std::iter::from_fn(|| buffer.pop()).collect()
    }

    #[test]
    fn a_lost_frame_is_named_and_an_intra_frame_goes_on() {
        let mut buffer = ReorderBuffer::default();
        assert_eq!(decoded(&mut buffer, &[(0, true), (2, false)]), [0]);
        assert_eq!(buffer.missing(ms(0)), None);
        assert_eq!(buffer.missing(ms(50)), Some(1));
        assert_eq!(decoded(&mut buffer, &[(3, false)]), NONE);
        assert_eq!(buffer.missing(ms(299)), None);
        assert_eq!(buffer.missing(ms(300)), Some(1), "the request was lost, too");
        assert_eq!(decoded(&mut buffer, &[(5, false), (4, true)]), [4, 5]);
        assert_eq!(buffer.lost(), 3);
        assert_eq!(decoded(&mut buffer, &[(1, false), (2, true)]), NONE, "they come too late");
        assert_eq!(buffer.missing(ms(900)), None);
    }

    #[test]
    fn a_missing_frame_that_comes_after_all_is_decoded() {
        let mut buffer = ReorderBuffer::default();
        assert_eq!(decoded(&mut buffer, &[(0, true), (2, false)]), [0]);
        assert_eq!([0, 50].map(|time| buffer.missing(ms(time))), [None, Some(1)]);
        assert_eq!(decoded(&mut buffer, &[(1, false)]), [1, 2]);
        assert_eq!((buffer.missing(ms(900)), buffer.lost()), (None, 0));
    }

    #[test]
    fn frames_that_wait_are_limited_in_number() {
        let mut buffer = ReorderBuffer::default();
        assert_eq!(decoded(&mut buffer, &[(0, true)]), [0]);
        (2..1000).for_each(|number| buffer.insert(number, false, number));
        assert_eq!(buffer.waiting.len(), MAX_WAITING_FRAMES);
        assert_eq!(decoded(&mut buffer, &[(1, false)]), [1]);
    }
}
