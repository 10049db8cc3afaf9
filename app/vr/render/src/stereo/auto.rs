//! The choice between two renders and one with synthesis, by measuring them in use.

use std::fmt::{self, Display};
use std::rc::Rc;
#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;

#[cfg(target_arch = "wasm32")]
use web_time::Instant;

use super::images::LayerTargets;
use super::options::HoleMethod;
use super::session::FrameLoad;
use yoro::choice::{Aim, Choice, Chooser, Cost, FrameEnd, Reason, StereoPath};
use yoro_gl::Context;

/// The measurements of two renders and of one with synthesis, of which a [`Chooser`] picks one: the cheaper one, or where
/// holes may be rendered the best that holds the display's rate. All stay ready, so that switching costs nothing.
///
/// The cost of a frame is its GPU time if passes are timed ([`Context::times_passes`]). Otherwise the time between frames
/// says which ways hold a known rate. To find the cheaper one, while a choice is being made, each frame waits for the GPU
/// before and after its eyes, and the cost is the CPU and GPU time together, by the clock.
pub struct Auto {
    gl: Rc<Context>,
    chooser: Chooser,
    /// How the last frame was rendered, if it counts as that path's, and its time by the clock.
    rendered: Option<StereoPath>,
    clock_ms: Option<f32>,
    /// The display's rate in Hz; 0 if unknown.
    refresh_hz: f32,
    /// True until the first frame is rendered.
    is_new: bool,
}

impl Auto {
    pub(super) fn new(gl: &Rc<Context>, holes: HoleMethod) -> Auto {
        let chooser = match holes {
            HoleMethod::Filled => Chooser::new(Aim::Cheapest, StereoPath::Synthesis),
            HoleMethod::Rendered => Chooser::new(Aim::BestThatHolds, StereoPath::RenderedHoles),
        };
        Auto { gl: gl.clone(), chooser, rendered: None, clock_ms: None, refresh_hz: 0.0, is_new: true }
    }

    /// Returns the last choice.
    pub fn choice(&self) -> Choice {
        self.chooser.choice()
    }

    /// True while a choice is being made. The size of the images should not change meanwhile.
    pub fn is_measuring(&self) -> bool {
        self.chooser.is_measuring()
    }

    /// Returns the ways that are measured.
    pub(super) fn paths(&self) -> &'static [StereoPath] {
        self.chooser.aim().paths()
    }

    /// True if the chosen path was preferred to cheaper ones for its picture.
    pub(super) fn has_cheaper(&self) -> bool {
        self.chooser.aim() == Aim::BestThatHolds && self.choice().path != StereoPath::Synthesis
    }

    /// Returns how the next frame is to be rendered.
    pub(super) fn path(&self) -> StereoPath {
        self.chooser.path()
    }

    /// True on the first call.
    pub(super) fn take_new(&mut self) -> bool {
        std::mem::take(&mut self.is_new)
    }

    /// Starts a new choice, for another place in the scene.
    pub(super) fn scene_changed(&mut self) {
        self.chooser.scene_changed();
    }

    /// Begins the eyes of a frame, and returns the time if the clock measures it.
    pub(super) fn begin(&self, to: &LayerTargets) -> Option<Instant> {
        let shows_rate = self.chooser.aim() == Aim::BestThatHolds && self.refresh_hz > 0.0;
        let is_clocked = self.chooser.is_measuring() && !self.gl.times_passes() && !shows_rate;
        is_clocked.then(|| {
            self.finish(to);
            Instant::now()
        })
    }

    /// Ends the eyes of a frame that counts as that of a path, if any.
    pub(super) fn end(&mut self, path: Option<StereoPath>, begin: Option<Instant>, to: &LayerTargets) {
        self.rendered = path;
        self.clock_ms = begin.map(|begin| {
            self.finish(to);
            begin.elapsed().as_secs_f32() * 1e3
        });
    }

    fn finish(&self, to: &LayerTargets) {
        to.layers().for_each(|to| self.gl.finish_drawing(&to.each_ref().map(|eye| eye.color)));
    }

    /// Takes the end of the last frame into account.
    pub(super) fn end_frame(&mut self, load: &FrameLoad) {
        let (refresh_hz, cost) = match self.clock_ms.take() {
            Some(ms) => (0.0, Some(Cost { frames_ago: 0, ms })),
            None => (load.refresh_hz, load.gpu),
        };
        self.refresh_hz = load.refresh_hz;
        let (rendered, heat) = (self.rendered.take(), load.thermal_headroom);
        self.chooser.end_frame(&FrameEnd { now_ns: load.ended_ns, refresh_hz, rendered, cost, heat });
    }
}

/// Writes the reason for the choice in a word. In `6.1/8.9ms` the times are those of the chosen and the other way. In
/// `14.0/*9.2/8.1` they are those of two renders, rendered holes and filled ones, with an asterisk at the chosen way.
impl Display for Auto {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Choice { path, reason, costs_ms } = self.choice();
        match (costs_ms, reason) {
            _ if self.is_measuring() => f.write_str("measuring"),
            ([Some(two_views), None, Some(synthesis)], _) => {
                let is_first = path == StereoPath::TwoViews;
                let [chosen, other] = if is_first { [two_views, synthesis] } else { [synthesis, two_views] };
                write!(f, "{chosen:.1}/{other:.1}ms")
            }
            ([Some(two_views), Some(rendered), Some(filled)], _) => {
                let mark = |of| if path == of { "*" } else { "" };
                let [a, b, c] = StereoPath::ALL.map(mark);
                write!(f, "{a}{two_views:.1}/{b}{rendered:.1}/{c}{filled:.1}")
            }
            (_, Reason::BothHoldRate) => f.write_str("both-in-time"),
            _ => f.write_str("not-comparable"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use glam::Quat;
    use yoro::choice::PathTimes;
    use yoro::eyes::{DepthConvention, Eye, EyePair};
    use yoro_context::{Backend, Headless};

    use super::super::tests::{Rig, local, pair, session_of, smooth};
    use super::super::{Method, MethodChoice, NearFieldPolicy, StereoOptions, StereoSession};
    use super::*;

    const FRAME_NS: i64 = 200_000_000;

    /// Renders a measurement on a display of 60 Hz, whose frames end 200 ms apart; `shows` checks each frame. Returns the
    /// choice, and the number of frames in each way.
    fn measure(
        rig: &mut Rig,
        session: &mut StereoSession,
        pair: &EyePair,
        shows: impl Fn(StereoPath, [Vec<u8>; 2]) -> bool,
    ) -> (Choice, [u32; 3]) {
        let mut frames = [0; 3];
        let mut load = FrameLoad { refresh_hz: 60.0, display_hz: 60.0, ..FrameLoad::default() };
        let mut previous = None;
        loop {
            let shown = rig.render_after(session, pair, previous.as_ref());
            let auto = session.auto().unwrap();
            if !auto.is_measuring() {
                return (auto.choice(), frames);
            }
            let path = auto.path();
            assert!(shows(path, shown), "frame {frames:?}");
            frames[path.index()] += 1;
            load.ended_ns += FRAME_NS;
            previous = Some(load);
        }
    }

    #[test]
    fn each_turn_shows_what_the_named_method_shows() {
        let head = Headless::open(Backend::Egl).unwrap();
        let (gl, settings) = (head.gl(), smooth());
        let mut rig = Rig::new(gl, &settings);
        let pair = EyePair { size: [64, 48], ..pair(Eye::Right, DepthConvention::Standard) };
        let options = |holes| StereoOptions { holes, ..StereoOptions::default() };
        let named = StereoPath::ALL.map(|path| {
            let (method, holes) = match path {
                StereoPath::TwoViews => (Method::Conventional, HoleMethod::Filled),
                StereoPath::RenderedHoles => (Method::Synthesized, HoleMethod::Rendered),
                StereoPath::Synthesis => (Method::Synthesized, HoleMethod::Filled),
            };
            rig.render(&mut session_of(gl, method, &settings, &options(holes)), &pair)
        });
        assert_ne!(named[1], named[2]);
        for (holes, ways) in [(HoleMethod::Filled, 2), (HoleMethod::Rendered, 3)] {
            let mut auto = StereoSession::new(gl, MethodChoice::Auto, &settings, &options(holes)).unwrap();
            let held = Cell::new(None);
            let (choice, frames) = measure(&mut rig, &mut auto, &pair, |path, shown| {
                let now = (gl.object_count(), gl.texture_bytes());
                // All ways are ready from the first frame on.
                held.replace(Some(now)).is_none_or(|before| before == now) && shown == named[path.index()]
            });
            // Three turns of seven frames, or two long ones, of which there are no more at this pace.
            let least = if ways == 2 { 21 } else { 14 };
            assert_eq!(frames.iter().filter(|n| **n >= least).count(), ways, "{frames:?}");
            let costs: Vec<f32> = choice.costs_ms.into_iter().flatten().collect();
            let is_clock = costs.iter().all(|ms| *ms < FRAME_NS as f32 * 1e-6);
            assert!(costs.len() == ways && is_clock == (ways == 2), "whose times are these? {costs:?}");
            let method =
                if choice.path == StereoPath::TwoViews { Method::Conventional } else { Method::Synthesized };
            assert_eq!((auto.method(), choice.reason), (method, Reason::Cheaper));
            let text = auto.auto().unwrap().to_string();
            assert_eq!(text.split('/').count(), ways, "{text}");
            let marked = text.split('/').position(|time| time.starts_with('*'));
            assert_eq!(marked, (ways == 3).then_some(choice.path.index()), "{text}");
        }
        assert_eq!(gl.take_errors(), None);
    }

    #[test]
    fn two_renders_in_place_of_synthesis_are_not_its_time() {
        let head = Headless::open(Backend::Egl).unwrap();
        let (gl, settings) = (head.gl(), local());
        let mut rig = Rig::new(gl, &settings);
        let straight = EyePair { size: [64, 48], ..pair(Eye::Right, DepthConvention::Standard) };
        let mut canted = straight;
        canted.poses[0].orientation = Quat::from_rotation_y(0.1);
        // Everything is too near.
        let policy = Some(NearFieldPolicy { distance: 400.0, ..NearFieldPolicy::default() });
        for (pair, policy) in [(straight, policy), (canted, None)] {
            let options = StereoOptions { policy, ..StereoOptions::default() };
            let mut auto = StereoSession::new(gl, MethodChoice::Auto, &settings, &options).unwrap();
            let (choice, _) = measure(&mut rig, &mut auto, &pair, |_, _| true);
            assert_eq!((choice.reason, choice.costs_ms), (Reason::Incomparable, PathTimes::default()));
        }
    }
}
