use std::collections::VecDeque;

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::*;

/// A simulated device in virtual time: the GPU's and the CPU's times by [`StereoPath::index`], and a display.
struct Device {
    chooser: Chooser,
    now_ns: i64,
    gpu_ms: [f32; 3],
    cpu_ms: [f32; 3],
    refresh_hz: f32,
    /// Frames after which the timer's results come; `None` without a timer.
    timer: Option<u32>,
    heat: Option<f32>,
    /// Synthesis is not possible: both eyes are rendered in its place.
    is_near: bool,
    /// Largest deviation from the times, as a share; and the share of frames that take ten times as long.
    noise: f32,
    spikes: f32,
    random: Pcg64Mcg,
    late: VecDeque<f32>,
    /// When the last frame was finished, if the display's queue holds a frame in advance.
    finished_ms: Option<f64>,
    changes: u32,
    frames: [u32; 3],
}

const SIMPLE: [f32; 2] = [8.9, 6.1];

/// Returns the times of two views and synthesis in an array of all ways.
fn of_two([two_views, synthesis]: [f32; 2]) -> [f32; 3] {
    [two_views, f32::NAN, synthesis]
}

impl Device {
    /// A device that compares two views with synthesis.
    fn new(gpu_ms: [f32; 2], timer: Option<u32>) -> Device {
        Device::of_aim(Aim::Cheapest, of_two(gpu_ms), timer)
    }

    fn of_aim(aim: Aim, gpu_ms: [f32; 3], timer: Option<u32>) -> Device {
        Device {
            chooser: Chooser::new(aim, StereoPath::Synthesis),
            now_ns: 5_000_000_000,
            gpu_ms,
            cpu_ms: [1.0; 3],
            refresh_hz: 60.0,
            timer,
            heat: None,
            is_near: false,
            noise: 0.0,
            spikes: 0.0,
            random: Pcg64Mcg::seed_from_u64(7),
            late: VecDeque::new(),
            finished_ms: None,
            changes: 0,
            frames: [0; 3],
        }
    }

    fn noisy(mut self, noise: f32, spikes: f32, seed: u64) -> Device {
        (self.noise, self.spikes, self.random) = (noise, spikes, Pcg64Mcg::seed_from_u64(seed));
        self
    }

    fn frame(&mut self) {
        let path = self.chooser.path();
        self.frames[path.index()] += 1;
        let rendered = if self.is_near { StereoPath::TwoViews } else { path };
        let spike = if self.random.random::<f32>() < self.spikes { 10.0 } else { 1.0 };
        let factor = spike * (1.0 + self.noise * self.random.random_range(-1.0..=1.0));
        let gpu_ms = self.gpu_ms[rendered.index()] * factor;
        let busy_ms = gpu_ms.max(self.cpu_ms[rendered.index()]);
        let refresh_ms = if self.refresh_hz > 0.0 { 1e3 / self.refresh_hz } else { 0.0 };
        let mut frame_ms =
            if refresh_ms > 0.0 { (busy_ms / refresh_ms).ceil() * refresh_ms } else { busy_ms };
        if let Some(finished) = &mut self.finished_ms {
            let (shown, refresh) = (self.now_ns as f64 * 1e-6, f64::from(refresh_ms));
            *finished = finished.max(shown - refresh) + f64::from(busy_ms);
            frame_ms = (((*finished - shown) / refresh).ceil().max(1.0) * refresh) as f32;
        }
        self.now_ns += (f64::from(frame_ms) * 1e6) as i64;
        self.late.push_back(gpu_ms);
        let cost = self.timer.and_then(|frames_ago| {
            let is_there = self.late.len() > frames_ago as usize;
            is_there.then(|| Cost { frames_ago, ms: self.late.pop_front().unwrap_or_default() })
        });
        let before = self.chooser.choice().path;
        self.chooser.end_frame(&FrameEnd {
            now_ns: self.now_ns,
            refresh_hz: self.refresh_hz,
            rendered: (!self.is_near).then_some(path),
            cost,
            heat: self.heat,
        });
        self.changes += u32::from(self.chooser.choice().path != before);
    }

    fn run(&mut self, seconds: f64) -> Choice {
        let end = self.now_ns + (seconds * 1e9) as i64;
        while self.now_ns < end {
            self.frame();
        }
        self.chooser.choice()
    }

    /// Runs until the next measurement has ended; returns how many seconds passed before it began.
    fn measured_after(&mut self) -> f64 {
        let begin = self.now_ns;
        while !self.chooser.is_measuring() {
            self.frame();
        }
        let seconds = (self.now_ns - begin) as f64 * 1e-9;
        while self.chooser.is_measuring() {
            self.frame();
        }
        seconds
    }

    /// Returns the choice after the next measurement.
    fn measured(&mut self) -> Choice {
        self.measured_after();
        self.chooser.choice()
    }
}

/// Returns the compared times, those of the best picture first.
fn compared(choice: &Choice) -> Vec<f32> {
    choice.costs_ms.into_iter().flatten().collect()
}

#[test]
fn the_cheaper_way_is_chosen_by_late_times_of_a_timer() {
    for (gpu_ms, path) in [(SIMPLE, StereoPath::Synthesis), ([6.1, 8.9], StereoPath::TwoViews)] {
        for late in [0, 4, 12] {
            let mut device = Device::new(gpu_ms, Some(late));
            let choice = device.measured();
            assert_eq!((choice.path, choice.reason), (path, Reason::Cheaper), "{late} frames late");
            let costs = compared(&choice);
            assert!(
                costs.len() == 2 && costs.iter().zip(gpu_ms).all(|(a, b)| (a - b).abs() < 1e-3),
                "a time belongs to the frame it was measured in, {late} frames late: {costs:?}"
            );
            let seconds = (device.now_ns - 5_000_000_000) as f64 * 1e-9;
            assert!((1.2..1.9).contains(&seconds), "{seconds} s");
        }
    }
}

#[test]
fn noise_and_spikes_do_not_choose() {
    for seed in 0..50 {
        for (gpu_ms, path) in [([9.0, 7.2], StereoPath::Synthesis), ([7.2, 9.0], StereoPath::TwoViews)] {
            let mut device = Device::new(gpu_ms, Some(4)).noisy(0.2, 0.04, seed);
            device.refresh_hz = 72.0;
            assert_eq!(device.measured().path, path, "seed {seed}: {:?}", device.chooser.choice());
        }
    }
}

#[test]
fn equal_costs_do_not_swing_and_measuring_costs_next_to_nothing() {
    for seed in 0..5 {
        let mut device = Device::new([8.0, 8.0], Some(4)).noisy(0.1, 0.02, seed);
        device.run(3600.0);
        // The first choice may be either.
        assert!(device.changes <= 1, "seed {seed}: {} changes in an hour", device.changes);
    }
    let mut device = Device::new([16.0, 8.0], Some(4));
    device.run(3600.0);
    let [dear, _, cheap] = device.frames.map(|n| n as f32);
    assert!(dear / cheap < 0.002, "{dear} frames in the dearer path, {cheap} in the cheaper one");
}

#[test]
fn heat_is_a_reason_to_measure_again_but_not_at_once() {
    let mut device = Device::new(SIMPLE, Some(4));
    device.heat = Some(0.5);
    device.measured_after();
    device.run(10.0);
    // Memory slows down, which synthesis needs most; not by enough to be seen without heat.
    (device.gpu_ms, device.heat) = (of_two([7.0, 7.9]), Some(0.55));
    device.run(40.0);
    assert_eq!(device.chooser.choice().path, StereoPath::Synthesis, "hardly warmer");
    device.heat = Some(0.62);
    assert!(device.measured_after() < 1.0);
    assert_eq!(device.chooser.choice().path, StereoPath::TwoViews);
    device.heat = Some(0.9);
    let rest = device.measured_after();
    assert!((29.0..31.0).contains(&rest), "{rest} s after the last measurement");
    device.heat = None;
    let rest = device.measured_after();
    assert!(rest > 50.0, "unknown heat is no change: {rest} s");
}

#[test]
fn another_cost_of_the_same_way_is_a_reason_to_measure_again() {
    let mut device = Device::new(SIMPLE, Some(4));
    device.measured_after();
    device.run(40.0);
    assert!(!device.chooser.is_measuring());
    device.gpu_ms = of_two([5.0, 9.0]);
    let seconds = device.measured_after();
    assert!(seconds < 4.5, "{seconds} s");
    assert_eq!((device.chooser.choice().path, device.changes), (StereoPath::TwoViews, 1));
}

#[test]
fn another_scene_is_measured_at_once_and_without_prejudice() {
    let mut device = Device::new(SIMPLE, Some(4));
    device.measured_after();
    // A difference that would not be worth a change in the same scene.
    device.gpu_ms = of_two([5.8, 6.1]);
    device.run(200.0);
    assert_eq!(device.chooser.choice().reason, Reason::Similar);
    device.chooser.scene_changed();
    assert!(device.chooser.is_measuring());
    let unmeasured =
        Choice { path: StereoPath::Synthesis, reason: Reason::Unmeasured, costs_ms: PathTimes::default() };
    assert_eq!(device.chooser.choice(), unmeasured);
    device.now_ns += 20_000_000_000;
    let choice = device.measured();
    assert_eq!((choice.path, choice.reason), (StereoPath::TwoViews, Reason::Cheaper));
}

#[test]
fn the_display_hides_what_fits_into_a_refresh() {
    // (GPU's times, chosen path, reason, compared times), without a timer at 60 Hz.
    for (gpu_ms, path, reason, costs_ms) in [
        ([12.0, 8.0], StereoPath::Synthesis, Reason::BothHoldRate, vec![]),
        ([8.0, 12.0], StereoPath::Synthesis, Reason::BothHoldRate, vec![]),
        ([20.0, 12.0], StereoPath::Synthesis, Reason::HoldsRate, vec![33.333, 16.667]),
        ([12.0, 20.0], StereoPath::TwoViews, Reason::HoldsRate, vec![16.667, 33.333]),
        ([20.0, 40.0], StereoPath::TwoViews, Reason::Cheaper, vec![33.333, 50.0]),
        ([20.0, 30.0], StereoPath::Synthesis, Reason::Cheaper, vec![33.333, 33.333]),
    ] {
        let mut device = Device::new(gpu_ms, None);
        let choice = device.measured();
        assert_eq!((choice.path, choice.reason), (path, reason), "{gpu_ms:?}");
        let rounded: Vec<f32> = compared(&choice).iter().map(|ms| (ms * 1e3).round() / 1e3).collect();
        assert_eq!(rounded, costs_ms, "{gpu_ms:?}");
    }
    // What does not hold the rate any more is measured again.
    let mut device = Device::new([12.0, 8.0], None);
    device.measured_after();
    device.run(100.0);
    assert_eq!(device.chooser.choice().reason, Reason::BothHoldRate);
    device.gpu_ms = of_two([14.0, 20.0]);
    assert!(device.measured_after() < 4.5);
    assert_eq!(device.chooser.choice().path, StereoPath::TwoViews);
    // A display of unknown rate sets no pace.
    let mut device = Device::new([8.0, 12.0], None);
    device.refresh_hz = 0.0;
    assert_eq!(device.measured().path, StereoPath::TwoViews);
}

#[test]
fn holding_the_rate_is_worth_more_than_the_gpus_time() {
    // Two views are cheaper for the GPU, but the CPU cannot draw everything twice in time.
    let mut device = Device::new([6.0, 8.0], Some(4));
    device.cpu_ms = of_two([19.0, 10.0]);
    let choice = device.measured();
    assert_eq!((choice.path, choice.reason), (StereoPath::Synthesis, Reason::HoldsRate));
}

#[test]
fn frames_in_place_of_synthesis_do_not_count_for_it() {
    let mut device = Device::new([6.0, 8.0], Some(4));
    device.is_near = true;
    let choice = device.measured();
    assert_eq!((choice.path, choice.reason), (StereoPath::Synthesis, Reason::Incomparable));
    device.is_near = false;
    let rest = device.measured_after();
    assert!((59.0..61.0).contains(&rest), "{rest} s");
    assert_eq!(device.chooser.choice().path, StereoPath::TwoViews);
}

#[test]
fn a_pause_begins_the_measurement_again() {
    let mut device = Device::new(SIMPLE, Some(4));
    device.run(0.8);
    assert!(device.chooser.is_measuring());
    device.now_ns += 60_000_000_000;
    let begin = device.now_ns;
    device.measured_after();
    let seconds = (device.now_ns - begin) as f64 * 1e-9;
    assert!((1.2..1.9).contains(&seconds), "{seconds} s");
    let costs = compared(&device.chooser.choice());
    assert!(costs.len() == 2 && costs.iter().all(|ms| *ms < 10.0));
    // A choice outlives a pause.
    device.now_ns += 20_000_000_000;
    device.frame();
    assert!(!device.chooser.is_measuring());
}

#[test]
fn nonsense_is_no_time() {
    let mut chooser = Chooser::new(Aim::Cheapest, StereoPath::TwoViews);
    for frame in 0..400i64 {
        let ms = [f32::NAN, -1.0, 0.0, f32::INFINITY][frame as usize % 4];
        chooser.end_frame(&FrameEnd {
            now_ns: frame * 11_000_000,
            refresh_hz: f32::NAN,
            rendered: Some(chooser.path()),
            cost: Some(Cost { frames_ago: [0, 63, 64, u32::MAX][frame as usize % 4], ms }),
            heat: Some(f32::NAN),
        });
    }
    let choice = chooser.choice();
    assert!(!chooser.is_measuring());
    assert_eq!((choice.path, compared(&choice)), (StereoPath::TwoViews, vec![11.0; 2]));
}

/// A device of 60 Hz that takes the best of all three ways.
fn best(gpu_ms: [f32; 3], timer: Option<u32>) -> Device {
    Device::of_aim(Aim::BestThatHolds, gpu_ms, timer)
}

#[test]
fn the_best_picture_that_holds_the_rate_is_chosen() {
    use StereoPath::{RenderedHoles, Synthesis, TwoViews};
    let timer = Some(4);
    for (gpu_ms, timer, path, reason) in [
        ([12.0, 9.0, 8.0], timer, TwoViews, Reason::HoldsRate),
        ([12.0, 9.0, 8.0], None, TwoViews, Reason::HoldsRate),
        // Without room, a frame that takes longer is late.
        ([15.0, 12.0, 10.0], timer, RenderedHoles, Reason::HoldsRate),
        ([20.0, 12.0, 10.0], None, RenderedHoles, Reason::HoldsRate),
        ([20.0, 18.0, 12.0], timer, Synthesis, Reason::HoldsRate),
        ([20.0, 18.0, 12.0], None, Synthesis, Reason::HoldsRate),
        // Two views are the cheapest and have room, whatever synthesis costs.
        ([6.0, 12.0, 10.0], timer, TwoViews, Reason::HoldsRate),
        // None holds.
        ([40.0, 30.0, 20.0], timer, Synthesis, Reason::Cheaper),
        ([19.0, 30.0, 20.0], timer, TwoViews, Reason::Cheaper),
        ([60.0, 45.0, 30.0], None, Synthesis, Reason::Cheaper),
    ] {
        let mut device = best(gpu_ms, timer);
        let choice = device.measured();
        assert_eq!((choice.path, choice.reason), (path, reason), "{gpu_ms:?}, timer {timer:?}");
        assert_eq!(compared(&choice).len(), 3);
    }
    // A queue hides most of the refreshes that two views miss.
    let mut device = Device { finished_ms: Some(0.0), ..best([18.3, 9.0, 8.0], None) };
    assert_eq!(device.measured().path, RenderedHoles);
    // The CPU cannot draw everything twice in time, and no way leaves the GPU room.
    let mut device = best([14.0, 15.9, 15.0], Some(4));
    device.cpu_ms = [19.0, 10.0, 10.0];
    assert_eq!(device.measured().path, Synthesis);
    // Of an unknown rate, the cheapest.
    let mut device = best([12.0, 9.0, 8.0], Some(4));
    device.refresh_hz = 0.0;
    let choice = device.measured();
    assert_eq!((choice.path, choice.reason), (Synthesis, Reason::Cheaper));
}

#[test]
fn costs_near_the_limit_do_not_flip() {
    // Around 80 and 90 % of a refresh, and around a whole one.
    for at in [13.33, 15.0, 16.67] {
        for (seed, timer) in (0..3).flat_map(|seed| [(seed, Some(4)), (seed, None)]) {
            let mut device = best([at, at * 0.9, 6.0], timer).noisy(0.05, 0.02, seed);
            let mut last = None;
            let end = device.now_ns + 1_800_000_000_000;
            while device.now_ns < end {
                let changes = device.changes;
                device.frame();
                if device.changes > changes {
                    let since = last.replace(device.now_ns).map_or(i64::MAX, |last| device.now_ns - last);
                    assert!(since > 5_000_000_000, "{at} ms: after {since} ns");
                }
            }
            assert!(device.changes <= 8, "{at} ms, seed {seed}, {timer:?}: {} changes", device.changes);
        }
    }
}

#[test]
fn a_way_that_no_longer_holds_the_rate_is_left_within_seconds() {
    for timer in [Some(4), None] {
        let mut device = best([12.0, 9.0, 8.0], timer);
        device.measured_after();
        device.run(20.0);
        assert_eq!((device.chooser.choice().path, device.changes), (StereoPath::TwoViews, 1));
        device.gpu_ms = [18.0, 13.0, 11.0];
        let seconds = device.measured_after();
        assert!(seconds < 4.5, "{seconds} s");
        assert_eq!(device.chooser.choice().path, StereoPath::RenderedHoles, "{timer:?}");
        // It becomes cheap again: the better way is taken after a rest.
        device.gpu_ms = [12.0, 9.0, 8.0];
        let rest = device.measured_after();
        assert!((29.0..601.0).contains(&rest), "{rest} s");
        assert_eq!((device.chooser.choice().path, device.changes), (StereoPath::TwoViews, 3));
    }
    // What is the best of all is not measured again in vain.
    let mut device = best([8.0, 9.0, 10.0], Some(4));
    device.measured_after();
    device.run(590.0);
    let [_, rendered, filled] = device.frames;
    // The first quarter of a second, two turns of a second each, and what waits for the last costs.
    assert!(rendered + filled <= 15 + 4 * 61 + LATE_FRAMES, "{:?}", device.frames);
}
