//! The rate of renders with `frame-rate=auto`, where a runtime makes the frames between.

use super::session::FrameLoad;

/// Seconds over which frames are counted.
const WINDOW_NS: i64 = 2_000_000_000;
/// The share of late frames at which every second frame is left to the runtime.
const LATE: f32 = 0.1;
/// The share of a refresh that a render may take, on the GPU, for every frame to be rendered again.
const ROOM: f32 = 0.7;

/// Leaves every second frame to the runtime while the full rate is missed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RateChooser {
    pub(super) is_half: bool,
    begin_ns: Option<i64>,
    frames: u32,
    late: u32,
    /// The longest time of a frame on the GPU, in milliseconds; `None` if it is unknown.
    slowest_ms: Option<f32>,
}

impl RateChooser {
    /// Takes a frame into account. Returns true if the rate has changed.
    pub(super) fn frame(&mut self, load: &FrameLoad) -> bool {
        let begin = *self.begin_ns.get_or_insert(load.ended_ns);
        self.frames += 1;
        self.late += u32::from(load.late_refreshes > 0);
        self.slowest_ms = load.gpu.map(|gpu| gpu.ms.max(self.slowest_ms.unwrap_or(0.0))).or(self.slowest_ms);
        if load.ended_ns - begin < WINDOW_NS {
            return false;
        }
        let misses = self.late as f32 >= LATE * self.frames as f32;
        let has_room = self.slowest_ms.is_some_and(|ms| ms * load.display_hz < ROOM * 1e3);
        let is_half = if self.is_half { !has_room } else { misses };
        let has_changed = is_half != self.is_half;
        *self = RateChooser { is_half, ..RateChooser::default() };
        has_changed
    }

    /// Forgets the frames counted so far, which no longer describe the load.
    pub(super) fn interrupt(&mut self) {
        *self = RateChooser { is_half: self.is_half, ..RateChooser::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::choice::Cost;

    /// Runs three seconds of frames, every `late`th of them late; returns true if the rate has changed.
    fn run(chooser: &mut RateChooser, from: i64, late: u32, gpu_ms: Option<f32>) -> bool {
        (0..216).any(|i| {
            let load = FrameLoad {
                ended_ns: from + i64::from(i) * 13_888_889,
                refresh_hz: 72.0,
                display_hz: 72.0,
                late_refreshes: u32::from(late > 0 && i % late == 0),
                gpu: gpu_ms.map(|ms| Cost { frames_ago: 0, ms }),
                ..FrameLoad::default()
            };
            chooser.frame(&load)
        })
    }

    #[test]
    fn half_the_rate_while_the_full_one_is_missed() {
        let mut chooser = RateChooser::default();
        assert!(!run(&mut chooser, 0, 20, Some(9.0)) && !chooser.is_half);
        chooser.interrupt();
        assert!(run(&mut chooser, 0, 5, Some(15.0)) && chooser.is_half);
        chooser.interrupt();
        assert!(!run(&mut chooser, 0, 0, Some(10.0)), "no room for every frame");
        chooser.interrupt();
        assert!(!run(&mut chooser, 0, 0, None), "nobody knows");
        chooser.interrupt();
        assert!(run(&mut chooser, 0, 0, Some(9.0)) && !chooser.is_half);
    }
}
