//! Chooses how both eyes are made on this device: by two renders, or by one render with synthesis.
//!
//! Synthesis costs the same for any scene, so two renders are cheaper where a view is cheap to render. This cannot be
//! predicted: it depends on the GPU, the scene, the resolution and the temperature. A [`Chooser`] alternates between
//! the ways for about a second, takes one by its [`Aim`], and measures again when that may have changed. It uses no GL
//! and no clock: it is told when frames ended and what they cost, and says what to render next.
//!
//! ```
//! use yoro::choice::{Aim, Chooser, Cost, FrameEnd, StereoPath};
//!
//! let mut chooser = Chooser::new(Aim::Cheapest, StereoPath::Synthesis);
//! # let mut now_ns = 0;
//! # let render = |_: StereoPath| ();
//! # let timer = |path| Some(if path == StereoPath::Synthesis { 6.1 } else { 8.9 });
//! # for _ in 0..200 {
//! // Each frame:
//! let path = chooser.path();
//! render(path);
//! # now_ns += 11_111_111;
//! chooser.end_frame(&FrameEnd {
//!     now_ns,
//!     refresh_hz: 90.0,
//!     rendered: Some(path),
//!     cost: timer(path).map(|ms| Cost { frames_ago: 0, ms }),
//!     heat: None,
//! });
//! # }
//! # assert_eq!((chooser.path(), chooser.is_measuring()), (StereoPath::Synthesis, false));
//! ```

mod samples;
#[cfg(test)]
mod tests;

use samples::Samples;

/// A way to make both eyes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StereoPath {
    /// Both eyes are rendered.
    TwoViews,
    /// One eye is rendered, the other synthesized except for its [open holes](crate::synthesis::Holes::Open), which are
    /// rendered.
    RenderedHoles,
    /// One eye is rendered, the other synthesized.
    Synthesis,
}

impl StereoPath {
    /// All ways, the best picture first, in the order of [`StereoPath::index`].
    pub const ALL: [StereoPath; 3] = [StereoPath::TwoViews, StereoPath::RenderedHoles, StereoPath::Synthesis];

    /// Returns the index in arrays of all ways.
    pub fn index(self) -> usize {
        self as usize
    }
}

/// Milliseconds by [`StereoPath::index`]; `None` for a way that was not measured.
pub type PathTimes = [Option<f32>; StereoPath::ALL.len()];

/// What a way is chosen by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// The cheaper one of two views and synthesis.
    Cheapest,
    /// The best picture of all ways that holds the display's rate; the cheapest way where none does, or where the rate is
    /// unknown.
    BestThatHolds,
}

impl Aim {
    /// Returns the ways that are measured, the best picture first.
    pub fn paths(self) -> &'static [StereoPath] {
        match self {
            Aim::Cheapest => &[StereoPath::TwoViews, StereoPath::Synthesis],
            Aim::BestThatHolds => &StereoPath::ALL,
        }
    }
}

/// The measured cost of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The number of calls of [`Chooser::end_frame`] since the measured frame's own: 0 for the frame that ends now.
    /// Costs of frames more than 63 calls ago are ignored.
    pub frames_ago: u32,
    /// The cost in milliseconds: the GPU's time for the frame if there is a timer; otherwise the time from the start of
    /// the frame's work until the GPU has finished, if the host waits for that. Use the same kind for all ways.
    pub ms: f32,
}

/// A frame that was handed to the display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameEnd {
    /// The time now, in nanoseconds of a monotonic clock.
    pub now_ns: i64,
    /// The display's refreshes per second; 0 if unknown, or if the display did not set the pace of this frame, for
    /// example because the host waited for the GPU to measure it.
    pub refresh_hz: f32,
    /// The way in which the frame was rendered; `None` if none of them, for example if both eyes were rendered because
    /// synthesis was not possible. Such a frame counts for no way.
    pub rendered: Option<StereoPath>,
    /// The cost of this or an earlier frame, if it has become known.
    pub cost: Option<Cost>,
    /// The device's heat, if known, on a scale where 0.1 is a significant change, such as Android's thermal headroom.
    pub heat: Option<f32>,
}

/// The reason for a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// Nothing has been measured in this scene yet: the initial or the previous way is kept.
    Unmeasured,
    /// The chosen way costs less.
    Cheaper,
    /// The chosen way costs more, but not by enough to change: the previous way is kept.
    Similar,
    /// The chosen way holds the display's rate, and the other, or every better one, does not.
    HoldsRate,
    /// Both ways hold the display's rate, which hides their costs, and no costs are known: the previous way is kept.
    BothHoldRate,
    /// One of the ways could not be measured: the previous way is kept.
    Incomparable,
}

/// A choice and its reason.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The chosen way.
    pub path: StereoPath,
    /// The reason for the choice.
    pub reason: Reason,
    /// The compared times; all `None` if there was nothing to compare.
    pub costs_ms: PathTimes,
}

/// Measures the ways in turns, and chooses one by its [`Aim`].
///
/// A measurement begins a quarter of a second after the first frame and takes a second, or three turns of 7 frames for
/// each way if that is longer. Each turn lasts an eighth of a second, and its first three frames do not count. Times are
/// means of the middle half of the samples, so that spikes do not count either. With [`Aim::BestThatHolds`], whose
/// pictures differ visibly, each way has two turns of a second.
///
/// 1. With [`Aim::BestThatHolds`], the best picture is chosen that holds the rate by rule 2, with at most 5 % of its frames
///    later than a refresh, and whose cost, if known, is at most 80 % of a refresh, or 90 % for the way in use.
/// 2. Otherwise, if only one way holds the display's rate, it is chosen. A way holds the rate if the time between its
///    frames is at most 1.25 refreshes.
/// 3. Otherwise the cheapest way is chosen of those that hold the rate, or of all if none does. If a choice was already
///    made in this scene, it changes only if another way is cheaper by more than a tenth. Without costs, ways that miss
///    the display's rate are compared by the time between their frames; for ways that hold it, this time says nothing
///    ([`Reason::BothHoldRate`]).
///
/// A new measurement begins when the scene changes; when the frames' cost or pace has changed by 30 % or the heat by
/// 0.1, but not within 30 s of the last measurement; when a way chosen by rule 1 no longer holds the rate, but not within
/// 5 s, or twice as long each time that this changes nothing; and after 1 to 10 min, chosen so that rendering the dearer ways during measurements costs 0.2 % of the time.
///
/// GPU times depend on the clock that the device has chosen. If it lowers the clock for light loads, all ways appear to
/// cost nearly the same.
#[derive(Clone, Debug)]
pub struct Chooser {
    aim: Aim,
    choice: Choice,
    phase: Phase,
    /// The tags of the last frames, by frame number.
    tags: [Tag; REMEMBERED],
    frames: usize,
    last_ns: Option<i64>,
    costs: [Samples; StereoPath::ALL.len()],
    intervals: [Samples; StereoPath::ALL.len()],
    /// The refresh rate during the measurement.
    refresh_hz: f32,
    /// Watches frames of the chosen way, in windows of two seconds.
    watch: Watch,
    /// The heat at the last measurement.
    heat: Option<f32>,
    /// True if the last measurement began because the chosen way missed the rate.
    measured_after_miss: bool,
    /// How many such measurements in a row have chosen the same way again.
    unchanged_after_miss: u32,
}

/// The current phase.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// Waiting a moment before measuring, with the time of the first frame.
    Settling(Option<i64>),
    Measuring {
        begin_ns: i64,
        turn: u32,
        turn_ns: i64,
        turn_frames: u32,
    },
    /// Waiting for at most `left` more frames for the costs of the last measured frames. Where a change is seen, they go on
    /// in the way of the last turn.
    Collecting {
        left: u32,
        begin_ns: i64,
    },
    Resting {
        since_ns: i64,
        until_ns: i64,
    },
}

/// What a frame's cost counts for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tag {
    Nothing,
    Measured(StereoPath),
    Watched,
}

/// Watches the cost and pace of the chosen way.
#[derive(Clone, Debug, Default)]
struct Watch {
    begin_ns: Option<i64>,
    costs: Samples,
    intervals: Samples,
    first: Option<Window>,
}

/// The means of a window in milliseconds, as far as they are known.
#[derive(Clone, Copy, Debug)]
struct Window {
    cost: Option<f32>,
    interval: Option<f32>,
    /// True if too many of its frames were late.
    is_late: bool,
}

const REMEMBERED: usize = 64;
const MS: i64 = 1_000_000;
const SETTLING_NS: i64 = 250 * MS;
const TURN_NS: i64 = 125 * MS;
/// The same where pictures differ so much that a change is seen.
const VISIBLE_TURN_NS: i64 = 1000 * MS;
const MEASURING_NS: i64 = 1000 * MS;
const WATCH_NS: i64 = 2000 * MS;
/// Longer times between frames count as pauses.
const PAUSE_NS: i64 = 1000 * MS;
/// The first frames of a turn do not count: caches are cold, and the display still shows frames of the previous turn.
const UNCOUNTED_FRAMES: u32 = 3;
const TURN_FRAMES: u32 = 7;
/// The smallest number of turns of each way, and that of such long ones.
const TURNS: u32 = 3;
const VISIBLE_TURNS: u32 = 2;
/// The number of frames to wait for late costs.
const LATE_FRAMES: u32 = 16;
/// A way holds the display's rate if the time between its frames is at most this many refreshes.
const MAX_REFRESHES_PER_FRAME: f32 = 1.25;
/// A better but dearer way holds it only if at most this share of its frames took more than one refresh. A display's queue
/// hides a way that is a little too slow from the middle half of the times.
const MAX_LATE_SHARE: f32 = 0.05;
const LATE_REFRESHES: f32 = 1.5;
/// The share of a refresh that the cost of a way may be for it to be chosen as one that holds the rate, and to stay so.
const ROOM_TO_CHOOSE: f32 = 0.8;
const ROOM_TO_STAY: f32 = 0.9;
/// A choice is changed if another way costs less than this share.
const SWITCH_BELOW: f32 = 0.9;
/// The share of the time that measuring may cost.
const OVERHEAD: f32 = 0.002;
/// The shortest time between two measurements, that after which a way may miss the display's rate, and the bounds of
/// that time if nothing changes.
const SHORTEST_REST_NS: i64 = 30_000 * MS;
const REST_BEFORE_MISSES_NS: i64 = 5_000 * MS;
/// How often the rest doubles after measurements that began with a miss and chose the same way again.
const MAX_DOUBLINGS: u32 = 6;
const REST_NS: [i64; 2] = [60_000 * MS, 600_000 * MS];
/// Changes of cost, pace and heat that are worth another measurement.
const DRIFT: f32 = 1.3;
const HEAT_DRIFT: f32 = 0.1;

impl Chooser {
    /// Returns a chooser that begins with the way `first`, or with synthesis if `first` is none of the aim's, and measures as
    /// soon as frames come.
    pub fn new(aim: Aim, first: StereoPath) -> Chooser {
        let path = if aim.paths().contains(&first) { first } else { StereoPath::Synthesis };
        Chooser {
            aim,
            choice: Choice { path, reason: Reason::Unmeasured, costs_ms: PathTimes::default() },
            phase: Phase::Settling(None),
            tags: [Tag::Nothing; REMEMBERED],
            frames: 0,
            last_ns: None,
            costs: Default::default(),
            intervals: Default::default(),
            refresh_hz: 0.0,
            watch: Watch::default(),
            heat: None,
            measured_after_miss: false,
            unchanged_after_miss: 0,
        }
    }

    /// Returns the way to render the next frame.
    pub fn path(&self) -> StereoPath {
        let paths = self.aim.paths();
        let turn = match self.phase {
            Phase::Measuring { turn, .. } => turn,
            Phase::Collecting { .. } if self.aim == Aim::BestThatHolds => paths.len() as u32 - 1,
            _ => return self.choice.path,
        };
        let chosen = paths.iter().position(|path| *path == self.choice.path).unwrap_or_default();
        paths[(chosen + turn as usize) % paths.len()]
    }

    /// Returns what a way is chosen by.
    pub fn aim(&self) -> Aim {
        self.aim
    }

    /// Returns the last choice, which is rendered unless [`Chooser::is_measuring`] is true.
    pub fn choice(&self) -> Choice {
        self.choice
    }

    /// True while a choice is being made. Keep resolution and quality constant meanwhile.
    pub fn is_measuring(&self) -> bool {
        !matches!(self.phase, Phase::Resting { .. })
    }

    /// Starts a new measurement: call it for another scene, another place in it, or another resolution.
    pub fn scene_changed(&mut self) {
        self.phase = Phase::Settling(None);
        self.choice = Choice { reason: Reason::Unmeasured, costs_ms: PathTimes::default(), ..self.choice };
        self.last_ns = None;
    }

    /// Counts a frame that was handed to the display. Allocates nothing.
    pub fn end_frame(&mut self, end: &FrameEnd) {
        let interval = self.last_ns.replace(end.now_ns).map(|last| end.now_ns - last);
        if interval.is_some_and(|ns| !(0..PAUSE_NS).contains(&ns)) {
            return self.pause(end.now_ns);
        }
        let tag = self.tag(end.rendered);
        self.tags[self.frames % REMEMBERED] = tag;
        self.count(tag, end, interval);
        self.frames += 1;
        self.proceed(end);
    }

    /// Skips the time since the last frame, and restarts a measurement in progress.
    fn pause(&mut self, now_ns: i64) {
        self.tags[self.frames % REMEMBERED] = Tag::Nothing;
        self.frames += 1;
        match self.phase {
            Phase::Resting { .. } => self.watch.restart(),
            _ => self.phase = Phase::Settling(Some(now_ns)),
        }
    }

    /// Returns what the frame that ends now counts for.
    fn tag(&self, rendered: Option<StereoPath>) -> Tag {
        if rendered != Some(self.path()) {
            return Tag::Nothing;
        }
        match self.phase {
            Phase::Measuring { turn_frames, .. } if turn_frames >= UNCOUNTED_FRAMES => {
                Tag::Measured(self.path())
            }
            Phase::Resting { .. } => Tag::Watched,
            _ => Tag::Nothing,
        }
    }

    /// Counts the time before the frame that ends, and the cost that is known now.
    fn count(&mut self, tag: Tag, end: &FrameEnd, interval: Option<i64>) {
        if let Some(ns) = interval {
            let ms = ns as f32 * 1e-6;
            match tag {
                Tag::Measured(path) => {
                    self.intervals[path.index()].add(ms);
                    self.refresh_hz = end.refresh_hz;
                }
                // Without a display's pace, the time between frames says nothing about their cost.
                Tag::Watched if end.refresh_hz > 0.0 => self.watch.intervals.add(ms),
                Tag::Watched | Tag::Nothing => {}
            }
        }
        let Some(Cost { frames_ago, ms }) = end.cost else { return };
        let ago = frames_ago as usize;
        if ago >= REMEMBERED || ago > self.frames || !(ms > 0.0 && ms.is_finite()) {
            return;
        }
        match self.tags[(self.frames - ago) % REMEMBERED] {
            Tag::Measured(path) => self.costs[path.index()].add(ms),
            Tag::Watched => self.watch.costs.add(ms),
            Tag::Nothing => {}
        }
    }

    /// Moves on to the next turn or phase, if it is time.
    fn proceed(&mut self, end: &FrameEnd) {
        let now_ns = end.now_ns;
        let paths = self.aim.paths().len() as u32;
        let (length_ns, least) = match self.aim {
            Aim::Cheapest => (TURN_NS, TURNS),
            Aim::BestThatHolds => (VISIBLE_TURN_NS, VISIBLE_TURNS),
        };
        match &mut self.phase {
            Phase::Settling(begin) => {
                if now_ns - *begin.get_or_insert(now_ns) >= SETTLING_NS {
                    self.measure(end);
                }
            }
            Phase::Measuring { begin_ns, turn, turn_ns, turn_frames } => {
                *turn_frames += 1;
                if *turn_frames < TURN_FRAMES || now_ns - *turn_ns < length_ns {
                    return;
                }
                let turns = *turn + 1;
                if turns >= least * paths && turns.is_multiple_of(paths) && now_ns - *begin_ns >= MEASURING_NS
                {
                    self.phase = Phase::Collecting { left: LATE_FRAMES, begin_ns: *begin_ns };
                    self.collect(now_ns);
                } else {
                    (*turn, *turn_ns, *turn_frames) = (turns, now_ns, 0);
                }
            }
            Phase::Collecting { .. } => self.collect(now_ns),
            Phase::Resting { since_ns, until_ns } => {
                let (rested_ns, is_due) = (now_ns - *since_ns, now_ns >= *until_ns);
                let heat = end.heat.filter(|heat| heat.is_finite());
                let heat_has_drifted =
                    self.heat.zip(heat).is_some_and(|(before, now)| (now - before).abs() >= HEAT_DRIFT);
                self.heat = self.heat.or(heat);
                let window = self.watch.end_window(now_ns, end.refresh_hz);
                let has_drifted = window.is_some_and(|window| self.watch.has_drifted(&window));
                let misses = window.is_some_and(|window| self.misses_rate(&window, end.refresh_hz))
                    && rested_ns >= REST_BEFORE_MISSES_NS << self.unchanged_after_miss;
                self.measured_after_miss = misses;
                if is_due || (rested_ns >= SHORTEST_REST_NS && (has_drifted || heat_has_drifted)) || misses {
                    self.measure(end);
                }
            }
        }
    }

    /// True if the chosen way was preferred to cheaper ones since it held the rate, and no longer does.
    fn misses_rate(&self, window: &Window, refresh_hz: f32) -> bool {
        let Choice { path, reason, costs_ms } = self.choice;
        let is_preferred =
            (self.aim, reason) == (Aim::BestThatHolds, Reason::HoldsRate) && path != StereoPath::Synthesis;
        let exceeds = |ms: Option<f32>, refreshes| ms.is_some_and(|ms| ms * refresh_hz > 1e3 * refreshes);
        let had_room = !exceeds(costs_ms[path.index()], ROOM_TO_STAY);
        is_preferred && (window.is_late || (had_room && exceeds(window.cost, ROOM_TO_STAY)))
    }

    /// Begins a measurement.
    fn measure(&mut self, end: &FrameEnd) {
        self.costs.iter_mut().chain(&mut self.intervals).for_each(Samples::clear);
        self.tags.fill(Tag::Nothing);
        self.heat = end.heat.filter(|heat| heat.is_finite());
        let now_ns = end.now_ns;
        self.phase = Phase::Measuring { begin_ns: now_ns, turn: 0, turn_ns: now_ns, turn_frames: 0 };
    }

    /// Chooses, once the costs of all frames are known or the wait for them is over.
    fn collect(&mut self, now_ns: i64) {
        let Phase::Collecting { left, begin_ns } = &mut self.phase else { return };
        let begin_ns = *begin_ns;
        let is_missing =
            |path: &StereoPath| self.costs[path.index()].len() < self.intervals[path.index()].len();
        if *left > 0 && self.aim.paths().iter().any(is_missing) {
            *left -= 1;
            return;
        }
        let choice = self.choose();
        let is_unchanged = self.measured_after_miss && choice.path == self.choice.path;
        self.unchanged_after_miss =
            if is_unchanged { (self.unchanged_after_miss + 1).min(MAX_DOUBLINGS) } else { 0 };
        self.choice = choice;
        let rest_ns = self.rest(now_ns - begin_ns);
        self.watch = Watch::default();
        self.phase = Phase::Resting { since_ns: now_ns, until_ns: now_ns + rest_ns };
    }

    fn choose(&self) -> Choice {
        let stay = |reason| Choice { path: self.choice.path, reason, costs_ms: PathTimes::default() };
        let costs = self.means(&self.costs);
        let Some(intervals) = self.means(&self.intervals) else { return stay(Reason::Incomparable) };
        let is_rate_known = self.refresh_hz > 0.0;
        let is_within = |times: &PathTimes, path: StereoPath, refreshes: f32| {
            times[path.index()].is_some_and(|ms| ms * self.refresh_hz <= 1e3 * refreshes)
        };
        let is_punctual = |path: &StereoPath| {
            let late = self.intervals[path.index()].share_above(1e3 * LATE_REFRESHES / self.refresh_hz);
            self.aim == Aim::Cheapest || late.is_some_and(|share| share <= MAX_LATE_SHARE)
        };
        let is_in_time = |path: &StereoPath| {
            is_rate_known && is_within(&intervals, *path, MAX_REFRESHES_PER_FRAME) && is_punctual(path)
        };
        let has_room = |path: &StereoPath| {
            let is_in_use = *path == self.choice.path && self.choice.reason != Reason::Unmeasured;
            let room = if is_in_use { ROOM_TO_STAY } else { ROOM_TO_CHOOSE };
            costs.is_none_or(|costs| is_within(&costs, *path, room))
        };
        let paths = self.aim.paths();
        let best = paths.iter().find(|path| is_in_time(path) && has_room(path));
        if let (Aim::BestThatHolds, Some(path)) = (self.aim, best) {
            let costs_ms = costs.unwrap_or(intervals);
            return Choice { path: *path, reason: Reason::HoldsRate, costs_ms };
        }
        let in_time = paths.iter().filter(|path| is_in_time(path)).count();
        if let (1, Some(path)) = (in_time, paths.iter().find(|path| is_in_time(path))) {
            return Choice { path: *path, reason: Reason::HoldsRate, costs_ms: intervals };
        }
        if costs.is_none() && in_time > 0 {
            return stay(Reason::BothHoldRate);
        }
        self.cheapest(costs.unwrap_or(intervals), |path| in_time == 0 || is_in_time(path))
    }

    /// Returns the mean times of all ways, or `None` if one of them lacks its own.
    fn means(&self, samples: &[Samples; StereoPath::ALL.len()]) -> Option<PathTimes> {
        let mut means = PathTimes::default();
        for path in self.aim.paths() {
            means[path.index()] = Some(samples[path.index()].interquartile_mean()?);
        }
        Some(means)
    }

    /// Chooses the cheapest of some ways.
    fn cheapest(&self, costs_ms: PathTimes, is_among: impl Fn(&StereoPath) -> bool) -> Choice {
        let chosen = self.choice.path;
        let cost =
            |path: StereoPath| costs_ms[path.index()].filter(|_| is_among(&path)).unwrap_or(f32::INFINITY);
        let ordered = |a: &StereoPath, b: &StereoPath| cost(*a).total_cmp(&cost(*b));
        let path = self.aim.paths().iter().copied().min_by(ordered).unwrap_or(chosen);
        let share = if self.choice.reason == Reason::Unmeasured { 1.0 } else { SWITCH_BELOW };
        if cost(path) < cost(chosen) * share {
            Choice { path, reason: Reason::Cheaper, costs_ms }
        } else {
            let is_cheapest = cost(chosen) <= cost(path);
            let reason = if is_cheapest { Reason::Cheaper } else { Reason::Similar };
            Choice { path: chosen, reason, costs_ms }
        }
    }

    /// Returns the time until the next measurement in nanoseconds. Measuring renders each way for the same time.
    fn rest(&self, measuring_ns: i64) -> i64 {
        let [shortest, longest] = REST_NS;
        let Choice { path, reason, costs_ms } = &self.choice;
        let costs = || costs_ms.iter().flatten();
        match (costs().copied().reduce(f32::min), reason) {
            // Nothing looks better, and the watch notices when it no longer holds the rate.
            (_, Reason::HoldsRate) if self.aim == Aim::BestThatHolds && *path == StereoPath::TwoViews => {
                longest
            }
            (Some(least), _) => {
                let more = costs().sum::<f32>() / costs().count() as f32 / least - 1.0;
                ((measuring_ns as f32 * more / OVERHEAD) as i64).clamp(shortest, longest)
            }
            // Nothing can be compared while both hold the rate, and the watch notices when the chosen one no longer does.
            (None, Reason::BothHoldRate) => longest,
            (None, _) => shortest,
        }
    }
}

impl Watch {
    /// Forgets the frames of the current window.
    fn restart(&mut self) {
        self.begin_ns = None;
        self.costs.clear();
        self.intervals.clear();
    }

    /// Returns the window that ends now, if one does.
    fn end_window(&mut self, now_ns: i64, refresh_hz: f32) -> Option<Window> {
        if now_ns - *self.begin_ns.get_or_insert(now_ns) < WATCH_NS {
            return None;
        }
        let (cost, interval) = (self.costs.interquartile_mean(), self.intervals.interquartile_mean());
        let late = self.intervals.share_above(1e3 * LATE_REFRESHES / refresh_hz);
        self.restart();
        Some(Window { cost, interval, is_late: late.is_some_and(|share| share > MAX_LATE_SHARE) })
    }

    /// True if the cost or the frame time of a window differs from that of the first one.
    fn has_drifted(&mut self, now: &Window) -> bool {
        let first = *self.first.get_or_insert(*now);
        let drifted = |first: Option<f32>, now: Option<f32>| {
            first.zip(now).is_some_and(|(first, now)| now > first * DRIFT || now * DRIFT < first)
        };
        drifted(first.cost, now.cost) || drifted(first.interval, now.interval)
    }
}
