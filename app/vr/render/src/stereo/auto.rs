//! The choice of the cheaper of two methods, two renders or one with synthesis, by measuring both in use.

use std::fmt::{self, Display};
use std::rc::Rc;
#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;

#[cfg(target_arch = "wasm32")]
use web_time::Instant;

use super::images::LayerTargets;
use super::session::FrameLoad;
use yoro::choice::{Choice, Chooser, Cost, FrameEnd, Reason, StereoPath};
use yoro_gl::Context;

/// The measurements of two renders and of one with synthesis, of which a [`Chooser`] picks the cheaper one. Both stay
/// ready, so that switching costs nothing.
///
/// The cost of a frame is its GPU time if passes are timed ([`Context::times_passes`]). Otherwise, while a choice is
/// being made, each frame waits for the GPU before and after its eyes, and the cost is the CPU and GPU time together,
/// by the clock.
pub struct Auto {
    gl: Rc<Context>,
    chooser: Chooser,
    /// How the last frame was rendered, if it counts as that path's, and its time by the clock.
    rendered: Option<StereoPath>,
    clock_ms: Option<f32>,
    /// True until the first frame is rendered.
    is_new: bool,
}

impl Auto {
    pub(super) fn new(gl: &Rc<Context>) -> Auto {
        let chooser = Chooser::new(StereoPath::Synthesis);
        Auto { gl: gl.clone(), chooser, rendered: None, clock_ms: None, is_new: true }
    }

    /// Returns the last choice.
    pub fn choice(&self) -> Choice {
        self.chooser.choice()
    }

    /// True while a choice is being made. The size of the images should not change meanwhile.
    pub fn is_measuring(&self) -> bool {
        self.chooser.is_measuring()
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
        let is_clocked = self.chooser.is_measuring() && !self.gl.times_passes();
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
        let (rendered, heat) = (self.rendered.take(), load.thermal_headroom);
        self.chooser.end_frame(&FrameEnd { now_ns: load.ended_ns, refresh_hz, rendered, cost, heat });
    }
}

/// Writes the reason for the choice in a word. In `6.1/8.9ms` the times are those of the chosen and the other method.
impl Display for Auto {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Choice { path, reason, costs_ms } = self.choice();
        match (costs_ms, reason) {
            _ if self.is_measuring() => f.write_str("measuring"),
            (Some(costs), _) => write!(f, "{:.1}/{:.1}ms", costs[path.index()], costs[path.other().index()]),
            (None, Reason::BothHoldRate) => f.write_str("both-in-time"),
            (None, _) => f.write_str("not-comparable"),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use yoro::eyes::{DepthConvention, Eye, EyePair};
    use yoro_context::{Backend, Headless};

    use super::super::tests::{Rig, local, pair};
    use super::super::{Method, MethodChoice, NearFieldPolicy, StereoOptions, StereoSession};
    use super::*;

    const FRAME_NS: i64 = 200_000_000;
    /// By [`StereoPath::index`].
    const METHODS: [Method; 2] = [Method::Conventional, Method::Synthesized];

    /// Renders a measurement; `shows` checks each frame. Returns the choice, and the number of frames in each way.
    fn measure(
        rig: &mut Rig,
        session: &mut StereoSession,
        pair: &EyePair,
        shows: impl Fn(StereoPath, [Vec<u8>; 2]) -> bool,
    ) -> (Choice, [u32; 2]) {
        let mut frames = [0; 2];
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
        let (gl, settings, options) = (head.gl(), local(), StereoOptions::default());
        let mut rig = Rig::new(gl, &settings);
        let pair = EyePair { size: [64, 48], ..pair(Eye::Right, DepthConvention::Standard) };
        let session = |choice| StereoSession::new(gl, choice, &settings, &options).unwrap();
        let named = METHODS.map(|method| rig.render(&mut session(method.into()), &pair));
        let mut auto = session(MethodChoice::Auto);
        let (choice, frames) =
            measure(&mut rig, &mut auto, &pair, |path, shown| shown == named[path.index()]);
        assert!(frames.iter().all(|n| *n >= 21), "{frames:?}");
        let costs = choice.costs_ms.unwrap();
        assert!(
            costs.iter().all(|ms| *ms < FRAME_NS as f32 * 1e-6),
            "the clock's times, not the display's: {costs:?}"
        );
        assert_eq!(auto.method(), METHODS[usize::from(costs[1] <= costs[0])]);
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
            assert_eq!((choice.reason, choice.costs_ms), (Reason::Incomparable, None));
        }
    }
}
