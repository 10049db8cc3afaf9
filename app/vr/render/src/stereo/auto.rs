//! The choice of the cheaper of two methods, two renders or one with synthesis, by measuring both in use.

use std::fmt::{self, Display};
use std::rc::Rc;
#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;

#[cfg(target_arch = "wasm32")]
use web_time::Instant;

use super::levels::{EyeLevels, LevelMethods, LevelTargets};
use super::method::{EyeTarget, LevelEyes, MethodReport, StereoError, StereoMethod, Substituted};
use super::options::{Method, MethodChoice, StereoOptions};
use crate::view::{GpuScene, RenderSettings, Renderer};
use yoro::choice::{Choice, Chooser, Cost, FrameEnd, Reason, StereoPath};
use yoro::eyes::{EyePair, EyesError, GuardBand};
use yoro_gl::{Context, GlError};

/// The methods by [`StereoPath::index`].
const METHODS: [Method; 2] = [Method::Conventional, Method::Synthesized];

/// Returns the reason why a method cannot use a pair of eyes, or `None` if it can.
pub fn unfit(method: Method, pair: &EyePair) -> Option<EyesError> {
    if method.needs_aligned_eyes() { pair.synthesis_views(GuardBand::None).err() } else { None }
}

/// A named method or the cheaper of two, and two renders in its place for eyes that it cannot use.
pub struct SelectedMethod {
    gl: Rc<Context>,
    settings: RenderSettings,
    options: StereoOptions,
    method: Method,
    kind: Kind,
    /// Two renders, made when first needed.
    both: Option<LevelMethods>,
    /// True while both eyes are rendered for a comparison with the method.
    is_comparing: bool,
    /// The reason why the method could not use the last frame's eyes, if so.
    unfit: Option<EyesError>,
}

enum Kind {
    /// Always this method.
    Named(LevelMethods),
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
        let named = |method| LevelMethods::new(gl, method, settings, options).map(Kind::Named);
        let kind = match choice {
            MethodChoice::Named(method) => named(method)?,
            MethodChoice::Auto => Kind::Auto(Box::new(Auto::new(gl, settings, options)?)),
        };
        Ok(SelectedMethod {
            gl: gl.clone(),
            settings: settings.clone(),
            options: *options,
            method: choice.first(),
            kind,
            both: None,
            is_comparing: false,
            unfit: None,
        })
    }

    /// Returns the choice between two methods, if there is one.
    pub fn auto(&self) -> Option<&Auto> {
        match &self.kind {
            Kind::Named(_) => None,
            Kind::Auto(auto) => Some(auto),
        }
    }

    /// Returns the choice between two methods, if there is one.
    pub fn auto_mut(&mut self) -> Option<&mut Auto> {
        match &mut self.kind {
            Kind::Named(_) => None,
            Kind::Auto(auto) => Some(auto),
        }
    }

    /// Starts or ends a comparison, during which both eyes are rendered.
    ///
    /// # Errors
    /// As [`super::create`].
    pub fn compare(&mut self, is_comparing: bool) -> Result<(), GlError> {
        self.is_comparing = is_comparing;
        if is_comparing {
            self.both()?;
        }
        Ok(())
    }

    /// Makes two renders ready, so that the first frame of a comparison need not.
    ///
    /// # Errors
    /// As [`super::create`].
    pub fn prepare_comparison(&mut self) -> Result<(), GlError> {
        self.both().map(drop)
    }

    fn both(&mut self) -> Result<&mut LevelMethods, GlError> {
        let made = match self.both.take() {
            Some(made) => made,
            None => LevelMethods::new(&self.gl, Method::Conventional, &self.settings, &self.options)?,
        };
        Ok(self.both.insert(made))
    }

    /// Renders both eyes of all levels of a frame into their targets; both of each level if neither eye can be synthesized
    /// from the other. Levels need [`StereoOptions::inset`].
    ///
    /// # Errors
    /// As [`StereoMethod::render_level`].
    pub fn render_levels(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        levels: &EyeLevels,
        to: &LevelTargets,
    ) -> Result<(), StereoError> {
        self.unfit = levels.pairs().find_map(|pair| unfit(self.method, pair));
        if self.unfit.is_none() && !self.is_comparing {
            return match &mut self.kind {
                Kind::Named(methods) => methods.render(renderer, scene, levels, to),
                Kind::Auto(auto) => auto.render(renderer, scene, levels, to),
            };
        }
        if let Kind::Auto(auto) = &mut self.kind {
            auto.skip_frame();
        }
        self.both()?.render(renderer, scene, levels, to)
    }
}

/// A pair of eyes is one level.
impl StereoMethod for SelectedMethod {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        match &mut self.kind {
            Kind::Named(methods) => methods.prepare(renderer, scene),
            Kind::Auto(auto) => {
                auto.methods.iter_mut().try_for_each(|methods| methods.prepare(renderer, scene))
            }
        }
    }

    fn render_level(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        level: &LevelEyes,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.render_levels(renderer, scene, &(&level.eyes).into(), &to.into())
    }

    fn report(&self) -> MethodReport {
        let both = || self.both.as_ref().map(LevelMethods::report).unwrap_or_default();
        if let Some(reason) = &self.unfit {
            return MethodReport { substituted: Some(Substituted::Eyes(*reason)), ..both() };
        }
        if self.is_comparing {
            return both();
        }
        match &self.kind {
            Kind::Named(methods) => methods.report(),
            Kind::Auto(auto) => auto.report(),
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
    methods: [LevelMethods; 2],
    chooser: Chooser,
    /// How the last frame was rendered.
    shown: Option<StereoPath>,
    /// The same if it counts as that method's, and its time by the clock.
    rendered: Option<StereoPath>,
    clock_ms: Option<f32>,
    /// True until the first frame is rendered.
    is_new: bool,
}

impl Auto {
    fn new(gl: &Rc<Context>, settings: &RenderSettings, options: &StereoOptions) -> Result<Auto, GlError> {
        let [two_views, synthesis] = METHODS.map(|method| LevelMethods::new(gl, method, settings, options));
        Ok(Auto {
            gl: gl.clone(),
            methods: [two_views?, synthesis?],
            chooser: Chooser::new(StereoPath::Synthesis),
            shown: None,
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

    /// Notes that a frame was rendered by neither method, for its eyes or for a comparison.
    fn skip_frame(&mut self) {
        (self.shown, self.rendered, self.clock_ms) = (None, None, None);
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

impl Auto {
    fn report(&self) -> MethodReport {
        self.shown.map_or(MethodReport::default(), |way| self.methods[way.index()].report())
    }

    fn render(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        levels: &EyeLevels,
        to: &LevelTargets,
    ) -> Result<(), StereoError> {
        let way = self.chooser.way();
        if std::mem::take(&mut self.is_new) {
            // Makes everything that the other method needs now, while the scene comes into view, rather than in its
            // first turn.
            self.methods[way.other().index()].render(renderer, scene, levels, to)?;
        }
        let is_clocked = self.chooser.is_measuring() && !self.gl.times_passes();
        let finish = || to.pairs().for_each(|to| self.gl.finish_drawing(&to.map(|eye| eye.color)));
        let begin = is_clocked.then(|| {
            finish();
            Instant::now()
        });
        let methods = &mut self.methods[way.index()];
        methods.render(renderer, scene, levels, to)?;
        self.shown = Some(way);
        self.rendered = methods.report().substituted.is_none().then_some(way);
        self.clock_ms = begin.map(|begin| {
            finish();
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
        method: &mut SelectedMethod,
        pair: &EyePair,
        shows: impl Fn(StereoPath, [Vec<u8>; 2]) -> bool,
    ) -> (Choice, [u32; 2]) {
        let (mut now_ns, mut frames) = (0, [0; 2]);
        while method.auto().unwrap().is_measuring() {
            let way = method.auto().unwrap().chooser.way();
            assert!(shows(way, rig.render(method, pair)), "frame {frames:?}");
            frames[way.index()] += 1;
            now_ns += FRAME_NS;
            method.auto_mut().unwrap().end_frame(now_ns, 60.0, None, None);
        }
        (method.auto().unwrap().choice(), frames)
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
        let mut auto = SelectedMethod::new(gl, MethodChoice::Auto, &settings, &options).unwrap();
        let (choice, frames) = measure(&mut rig, &mut auto, &pair, |way, shown| shown == named[way.index()]);
        assert!(frames.iter().all(|n| *n >= 21), "{frames:?}");
        let costs = choice.costs_ms.unwrap();
        assert!(
            costs.iter().all(|ms| *ms < FRAME_NS as f32 * 1e-6),
            "the clock's times, not the display's: {costs:?}"
        );
        assert_eq!(auto.auto().unwrap().method(), METHODS[usize::from(costs[1] <= costs[0])]);
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
            let mut auto = SelectedMethod::new(gl, MethodChoice::Auto, &settings, &options).unwrap();
            let (choice, _) = measure(&mut rig, &mut auto, &pair, |_, _| true);
            assert_eq!((choice.reason, choice.costs_ms), (Reason::Incomparable, None));
        }
    }
}
