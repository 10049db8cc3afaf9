//! A controller that finds the best quality at which the display's refresh rate holds. It has no clock and no GL.

use yoro_render::stereo::FrameLoad;

/// A quality to render with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Render scale per axis, as a factor on the setting.
    pub render_scale: f32,
    /// Factor by which the divisor of the ImBuffer's resolution is multiplied.
    pub imbuffer: u32,
}

impl Quality {
    /// Full quality: exactly what the settings ask for.
    pub const FULL: Quality = Quality { render_scale: 1.0, imbuffer: 1 };
}

/// The qualities, best first. Few and far apart, since each change costs new render targets.
const LADDER: [Quality; 6] = [
    Quality::FULL,
    Quality { render_scale: 0.9, imbuffer: 1 },
    Quality { render_scale: 0.8, imbuffer: 2 },
    Quality { render_scale: 0.7, imbuffer: 2 },
    Quality { render_scale: 0.6, imbuffer: 4 },
    Quality { render_scale: 0.5, imbuffer: 4 },
];

/// Chooses the quality frame by frame.
///
/// Frames are judged in windows of half a second. The quality is lowered after a window with more than 5 % late frames
/// or a mean GPU time above 95 % of a refresh. It is raised after three seconds without a late frame, unless the GPU
/// time is known and expected to exceed 80 % of a refresh then. If raising it fails, the wait before the next attempt
/// doubles, up to 48 s, so that the quality does not oscillate. Heat: the quality is not raised from a thermal headroom
/// of 0.85 and is lowered from 0.95, at most once in ten seconds; 1 is severe throttling.
#[derive(Clone, Debug)]
pub struct Controller {
    level: usize,
    window: Window,
    good_windows: u32,
    needed_windows: u32,
    since_up: u32,
    cooling_until_ns: i64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Window {
    begin_ns: Option<i64>,
    frames: u32,
    late: u32,
    gpu_ms: f32,
    timed: u32,
}

impl Controller {
    const WINDOW_NS: i64 = 500_000_000;
    const COOLING_NS: i64 = 10_000_000_000;
    const LATE_SHARE: f32 = 0.05;
    const FULL_LOAD: f32 = 0.95;
    const ROOM: f32 = 0.80;
    const WARM: f32 = 0.85;
    const HOT: f32 = 0.95;
    const WINDOWS_UP: u32 = 6;
    const MAX_WINDOWS_UP: u32 = 96;
    /// A step up that does not last this many windows has failed.
    const TRIAL: u32 = 10;
    /// Frames longer than this are interruptions, not load.
    const LONGEST_FRAME_NS: i64 = 1_000_000_000;

    /// Creates a controller at full quality.
    pub fn new() -> Controller {
        Controller {
            level: 0,
            window: Window::default(),
            good_windows: 0,
            needed_windows: Self::WINDOWS_UP,
            since_up: Self::TRIAL,
            cooling_until_ns: 0,
        }
    }

    /// Returns the quality to render with.
    pub fn quality(&self) -> Quality {
        LADDER[self.level]
    }

    /// Forgets the frames so far, after a break or a change of the load that is not due to the quality.
    pub fn restart(&mut self) {
        self.window = Window::default();
        self.good_windows = 0;
    }

    /// Records a frame and returns the quality for the next one.
    pub fn frame(&mut self, load: &FrameLoad) -> Quality {
        let begin = *self.window.begin_ns.get_or_insert(load.ended_ns);
        let elapsed = load.ended_ns - begin;
        if !(0..Self::WINDOW_NS + Self::LONGEST_FRAME_NS).contains(&elapsed) {
            self.restart();
            return self.quality();
        }
        self.window.frames += 1;
        self.window.late += (load.late_refreshes > 0) as u32;
        if let Some(gpu) = load.gpu {
            self.window.gpu_ms += gpu.ms;
            self.window.timed += 1;
        }
        if elapsed >= Self::WINDOW_NS {
            self.judge(load);
            self.window = Window { begin_ns: Some(load.ended_ns), ..Window::default() };
        }
        self.quality()
    }

    fn judge(&mut self, load: &FrameLoad) {
        let window = self.window;
        let late_share = window.late as f32 / window.frames as f32;
        // The share of a refresh for which the GPU is busy.
        let gpu = (window.timed > 0 && load.refresh_hz > 0.0)
            .then(|| window.gpu_ms / window.timed as f32 * load.refresh_hz / 1e3);
        self.since_up = self.since_up.saturating_add(1);
        let headroom = load.thermal_headroom.filter(|headroom| headroom.is_finite()).unwrap_or(0.0);
        if headroom >= Self::HOT && load.ended_ns >= self.cooling_until_ns {
            self.cooling_until_ns = load.ended_ns + Self::COOLING_NS;
            self.down();
        } else if late_share > Self::LATE_SHARE || gpu.is_some_and(|g| g > Self::FULL_LOAD) {
            if self.since_up < Self::TRIAL {
                self.needed_windows = (self.needed_windows * 2).min(Self::MAX_WINDOWS_UP);
            }
            self.down();
        } else if window.late > 0 {
            self.good_windows = 0;
        } else {
            self.good_windows += 1;
            if self.since_up == Self::TRIAL {
                self.needed_windows = Self::WINDOWS_UP;
            }
            if self.good_windows >= self.needed_windows && headroom < Self::WARM {
                self.up(gpu);
            }
        }
    }

    fn down(&mut self) {
        self.level = (self.level + 1).min(LADDER.len() - 1);
        self.good_windows = 0;
        self.since_up = Self::TRIAL;
    }

    fn up(&mut self, gpu: Option<f32>) {
        let Some(better) = self.level.checked_sub(1) else { return };
        let pixels = (LADDER[better].render_scale / LADDER[self.level].render_scale).powi(2);
        if gpu.is_some_and(|g| g * pixels > Self::ROOM) {
            return;
        }
        self.level = better;
        self.good_windows = 0;
        self.since_up = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::choice::Cost;

    fn load(ended_ns: i64, late_refreshes: u32, gpu_ms: Option<f32>) -> FrameLoad {
        FrameLoad {
            ended_ns,
            refresh_hz: 60.0,
            display_hz: 60.0,
            late_refreshes,
            gpu: gpu_ms.map(|ms| Cost { frames_ago: 0, ms }),
            ..FrameLoad::default()
        }
    }

    /// A device whose GPU needs `full_ms` at full quality, on a display of 60 Hz.
    struct Device {
        controller: Controller,
        now_ns: i64,
        full_ms: f32,
        timer_queries: bool,
        headroom: Option<f32>,
        changes: usize,
    }

    impl Device {
        fn new(full_ms: f32, timer_queries: bool) -> Device {
            Device {
                controller: Controller::new(),
                now_ns: 0,
                full_ms,
                timer_queries,
                headroom: None,
                changes: 0,
            }
        }

        fn run(&mut self, seconds: f32) -> f32 {
            let end = self.now_ns + (seconds * 1e9) as i64;
            while self.now_ns < end {
                let before = self.controller.quality();
                let gpu_ms = self.full_ms * before.render_scale * before.render_scale;
                let late_refreshes = (gpu_ms / (1e3 / 60.0)).floor() as u32;
                self.now_ns += (1 + late_refreshes as i64) * 16_666_667;
                let gpu_ms = self.timer_queries.then_some(gpu_ms);
                let load = FrameLoad {
                    thermal_headroom: self.headroom,
                    ..load(self.now_ns, late_refreshes, gpu_ms)
                };
                self.changes += (self.controller.frame(&load) != before) as usize;
            }
            self.controller.quality().render_scale
        }
    }

    #[test]
    fn a_fast_device_keeps_full_quality() {
        for timer_queries in [false, true] {
            let mut device = Device::new(9.0, timer_queries);
            assert_eq!((device.run(30.0), device.changes), (1.0, 0));
        }
    }

    #[test]
    fn a_slow_device_settles_where_it_holds_the_rate() {
        // 24 ms * 0.8^2 = 15.4 ms fits into a refresh; 24 ms * 0.9^2 = 19.4 ms does not.
        let mut device = Device::new(24.0, true);
        assert_eq!(device.run(5.0), 0.8);
        let changes = device.changes;
        assert_eq!(device.run(60.0), 0.8);
        assert_eq!(device.changes, changes, "with known GPU times it does not try in vain");
    }

    #[test]
    fn without_gpu_times_it_tries_less_and_less_often() {
        let mut device = Device::new(24.0, false);
        device.run(60.0);
        let early = std::mem::take(&mut device.changes);
        device.run(60.0);
        let later = std::mem::take(&mut device.changes);
        assert!(later < early && later <= 6, "{early} changes, then {later}");
    }

    #[test]
    fn quality_returns_when_the_load_falls() {
        let mut device = Device::new(24.0, true);
        device.run(5.0);
        device.full_ms = 6.0;
        assert_eq!(device.run(10.0), 1.0);
    }

    #[test]
    fn quality_never_falls_below_the_worst() {
        assert_eq!(Device::new(400.0, true).run(20.0), 0.5);
    }

    #[test]
    fn heat_lowers_quality_slowly_and_keeps_it_low() {
        let mut device = Device::new(6.0, true);
        device.headroom = Some(0.97);
        assert_eq!(device.run(5.0), 0.9);
        assert_eq!(device.run(10.0), 0.8);
        device.headroom = Some(0.9);
        assert_eq!(device.run(30.0), 0.8);
        device.headroom = Some(f32::NAN);
        assert_eq!(device.run(30.0), 1.0);
    }

    #[test]
    fn a_single_late_frame_changes_nothing() {
        let mut device = Device::new(9.0, true);
        device.run(0.6);
        let late = load(device.now_ns + 33_000_000, 1, Some(9.0));
        assert_eq!(device.controller.frame(&late), Quality::FULL);
        device.run(2.0);
        assert_eq!(device.controller.quality(), Quality::FULL);
    }

    #[test]
    fn a_pause_does_not_count_as_load() {
        let mut device = Device::new(9.0, false);
        device.run(1.0);
        device.now_ns += 60_000_000_000;
        let load = load(device.now_ns, 3600, None);
        assert_eq!(device.controller.frame(&load), Quality::FULL);
    }
}
