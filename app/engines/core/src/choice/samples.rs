//! Frame times, and the mean of their middle half.

/// The largest number of times that are kept.
const MAX: usize = 256;
/// The smallest number of times that have a middle.
const FEWEST: usize = 4;

/// Frame times in milliseconds.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    times: [f32; MAX],
    len: usize,
}

impl Default for Samples {
    fn default() -> Samples {
        Samples { times: [0.0; MAX], len: 0 }
    }
}

impl Samples {
    pub fn add(&mut self, ms: f32) {
        if let Some(free) = self.times.get_mut(self.len) {
            *free = ms;
            self.len += 1;
        }
    }

    pub fn clear(&mut self) {
        self.len = 0;
    }

    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns the share of times above a limit, or `None` for fewer than four times.
    pub fn share_above(&self, ms: f32) -> Option<f32> {
        let times = &self.times[..self.len];
        let above = times.iter().filter(|time| **time > ms).count();
        (times.len() >= FEWEST).then(|| above as f32 / times.len() as f32)
    }

    /// Returns the mean of the middle half, or `None` for fewer than four times. Unlike a median, it distinguishes
    /// between times that a coarse clock has rounded.
    pub fn interquartile_mean(&self) -> Option<f32> {
        let mut times = self.times;
        let times = &mut times[..self.len];
        if times.len() < FEWEST {
            return None;
        }
        times.sort_unstable_by(f32::total_cmp);
        let quarter = times.len() / 4;
        let middle = &times[quarter..times.len() - quarter];
        Some(middle.iter().sum::<f32>() / middle.len() as f32)
    }
}
