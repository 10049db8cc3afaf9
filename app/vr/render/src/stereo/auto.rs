//! The choice of the cheaper of two methods, two renders or one with synthesis, by measuring both in use.

use std::fmt::{self, Display};
use std::rc::Rc;
#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;

#[cfg(target_arch = "wasm32")]
use web_time::Instant;

use super::method::{EyeTarget, GuardBandUse, StereoError, StereoMethod};
use super::options::{Method, MethodChoice, StereoOptions};
use super::substitute::Substitute;
use crate::render::{GpuScene, RenderSettings, Renderer};
use yoro::choice::{Choice, Chooser, Cost, FrameEnd, Reason, Way};
use yoro::eyes::EyePair;
use yoro_gl::{Context, GlError};

/// The methods by [`Way::index`].
const METHODS: [Method; 2] = [Method::Conventional, Method::Synthesized];

/// A named method, or the cheaper of two.
pub enum SelectedMethod {
    /// Always this method.
    Named(Box<dyn StereoMethod>),
    /// The cheaper one.
    Auto(Box<Auto>),
}

impl SelectedMethod {
    /// Makes the method, or both methods.
    ///
    /// # Errors
    /// As [`super::create`].
    pub fn new(
        gl: &Rc<Context>,
        choice: MethodChoice,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<SelectedMethod, GlError> {
        Ok(match choice {
            MethodChoice::Named(method) => {
                SelectedMethod::Named(super::create(gl, method, settings, options)?)
            }
            // Two renders cannot show a frame again.
            MethodChoice::Auto if options.render_rate.is_some() => {
                SelectedMethod::Named(super::create(gl, Method::Synthesized, settings, options)?)
            }
            MethodChoice::Auto => SelectedMethod::Auto(Box::new(Auto::new(gl, settings, options)?)),
        })
    }

    /// Returns the method to render with.
    pub fn method(&mut self) -> &mut dyn StereoMethod {
        match self {
            SelectedMethod::Named(method) => method.as_mut(),
            SelectedMethod::Auto(auto) => auto.as_mut(),
        }
    }

    /// Returns the choice between two methods, if there is one.
    pub fn auto(&self) -> Option<&Auto> {
        match self {
            SelectedMethod::Named(_) => None,
            SelectedMethod::Auto(auto) => Some(auto),
        }
    }

    /// Returns the choice between two methods, if there is one.
    pub fn auto_mut(&mut self) -> Option<&mut Auto> {
        match self {
            SelectedMethod::Named(_) => None,
            SelectedMethod::Auto(auto) => Some(auto),
        }
    }
}

/// Conventional and yoro, of which a [`Chooser`] picks the cheaper one. Both stay ready, so that switching costs
/// nothing.
///
/// The cost of a frame is its GPU time if passes are timed ([`Context::times_passes`]). Otherwise, while a choice is
/// being made, each frame waits for the GPU before and after its eyes, and the cost is the CPU and GPU time together,
/// by the clock.
pub struct Auto {
    gl: Rc<Context>,
    methods: [Box<dyn StereoMethod>; 2],
    chooser: Chooser,
    /// How the last frame was rendered, and its time by the clock.
    rendered: Option<Way>,
    clock_ms: Option<f32>,
    /// True until the first frame is rendered.
    is_new: bool,
}

impl Auto {
    fn new(gl: &Rc<Context>, settings: &RenderSettings, options: &StereoOptions) -> Result<Auto, GlError> {
        let [two_views, synthesis] = METHODS.map(|method| super::create(gl, method, settings, options));
        Ok(Auto {
            gl: gl.clone(),
            methods: [two_views?, synthesis?],
            chooser: Chooser::new(Way::Synthesis),
            rendered: None,
            clock_ms: None,
            is_new: true,
        })
    }

    /// Returns the chosen method. While a choice is being made, the two methods take turns.
    pub fn method(&self) -> Method {
        METHODS[self.chooser.choice().way.index()]
    }

    /// Returns the last choice.
    pub fn choice(&self) -> Choice {
        self.chooser.choice()
    }

    /// True while a choice is being made. The size of the images should not change meanwhile.
    pub fn is_measuring(&self) -> bool {
        self.chooser.is_measuring()
    }

    /// Starts a new choice, for another place in the scene.
    pub fn scene_changed(&mut self) {
        self.chooser.scene_changed();
    }

    /// Ends a frame that was handed to the display at `now_ns`. `gpu` is the GPU time of a recent frame, if known. See
    /// [`FrameEnd`] for all parameters.
    pub fn end_frame(&mut self, now_ns: i64, refresh_hz: f32, gpu: Option<Cost>, heat: Option<f32>) {
        let (refresh_hz, cost) = match self.clock_ms.take() {
            Some(ms) => (0.0, Some(Cost { frames_ago: 0, ms })),
            None => (refresh_hz, gpu),
        };
        let rendered = self.rendered.take();
        self.chooser.end_frame(&FrameEnd { now_ns, refresh_hz, rendered, cost, heat });
    }
}

impl StereoMethod for Auto {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        self.methods.iter_mut().try_for_each(|method| method.prepare(renderer, scene))
    }

    fn guard_band(&self) -> Option<GuardBandUse> {
        self.methods[self.rendered?.index()].guard_band()
    }

    /// Renders both eyes if neither can be synthesized from the other.
    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let wanted = self.chooser.way();
        let is_fit = Substitute::reason(Method::Synthesized, pair).is_none();
        let way = if is_fit { wanted } else { Way::TwoViews };
        if std::mem::take(&mut self.is_new) && is_fit {
            // Makes everything that the other method needs now, while the scene comes into view, rather than in its
            // first turn.
            self.methods[way.other().index()].render_to(renderer, scene, pair, to)?;
        }
        let is_clocked = self.chooser.is_measuring() && !self.gl.times_passes();
        let targets = to.map(|eye| eye.color);
        let begin = is_clocked.then(|| {
            self.gl.finish_drawing(&targets);
            Instant::now()
        });
        let method = &mut self.methods[way.index()];
        method.render_to(renderer, scene, pair, to)?;
        self.rendered = (way == wanted && !method.is_substituted()).then_some(way);
        self.clock_ms = begin.map(|begin| {
            self.gl.finish_drawing(&targets);
            begin.elapsed().as_secs_f32() * 1e3
        });
        Ok(())
    }
}

/// Writes the reason for the choice in a word. In `6.1/8.9ms` the times are those of the chosen and the other method.
impl Display for Auto {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Choice { way, reason, costs_ms } = self.choice();
        match (costs_ms, reason) {
            _ if self.is_measuring() => f.write_str("measuring"),
            (Some(costs), _) => write!(f, "{:.1}/{:.1}ms", costs[way.index()], costs[way.other().index()]),
            (None, Reason::BothHoldRate) => f.write_str("both-in-time"),
            (None, _) => f.write_str("not-comparable"),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use yoro::eyes::{DepthConvention, Eye};
    use yoro_context::{Backend, Headless};

    use super::super::NearFieldPolicy;
    use super::super::tests::{Rig, local, pair};
    use super::*;

    const FRAME_NS: i64 = 200_000_000;

    /// Renders a measurement; `shows` checks each frame. Returns the choice, and the number of frames in each way.
    fn measure(
        rig: &mut Rig,
        auto: &mut Auto,
        pair: &EyePair,
        shows: impl Fn(Way, [Vec<u8>; 2]) -> bool,
    ) -> (Choice, [u32; 2]) {
        let (mut now_ns, mut frames) = (0, [0; 2]);
        while auto.is_measuring() {
            let way = auto.chooser.way();
            assert!(shows(way, rig.render(auto, pair)), "frame {frames:?}");
            frames[way.index()] += 1;
            now_ns += FRAME_NS;
            auto.end_frame(now_ns, 60.0, None, None);
        }
        (auto.choice(), frames)
    }

    #[test]
    fn each_turn_shows_what_the_named_method_shows() {
        let head = Headless::open(Backend::Egl).unwrap();
        let (gl, settings, options) = (head.gl(), local(), StereoOptions::default());
        let mut rig = Rig::new(gl, &settings);
        let pair = EyePair { size: [64, 48], ..pair(Eye::Right, DepthConvention::Standard) };
        let named = METHODS.map(|method| {
            rig.render(super::super::create(gl, method, &settings, &options).unwrap().as_mut(), &pair)
        });
        let mut auto = Auto::new(gl, &settings, &options).unwrap();
        let (choice, frames) = measure(&mut rig, &mut auto, &pair, |way, shown| shown == named[way.index()]);
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
            let mut auto = Auto::new(gl, &settings, &options).unwrap();
            let (choice, _) = measure(&mut rig, &mut auto, &pair, |_, _| true);
            assert_eq!((choice.reason, choice.costs_ms), (Reason::Incomparable, None));
        }
    }
}
