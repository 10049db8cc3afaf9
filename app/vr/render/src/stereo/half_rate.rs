//! Half the rate of renders: each is shown in several frames, where everything has moved on meanwhile.

use std::rc::Rc;

use super::frame::{Frame, reversed, write_depth};
use super::method::{EyeTarget, LevelEyes, StereoError, StereoMethod};
use super::options::{Pipeline, StereoOptions};
use crate::view::{DepthImage, DepthResolve, GpuScene, Layout, Renderer, Step, Targets, VectorPass};
use yoro::eyes::{
    DepthConvention, Extrapolation, Eye, EyePair, EyesError, GuardBand, HeadMotion, Ndc, PoseWarp, View,
};
use yoro::opengl::{AnyView, Extrapolator, Options, Outputs, Source};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// Degrees per second that a head may turn before its borders are filled, if a render is shown until the next.
const DEGREES_PER_SECOND: f32 = 60.0;
/// Metres per second that it may move.
const METRES_PER_SECOND: f32 = 1.0;
/// Seconds from one render to the next: two frames at 72 Hz.
const SECONDS: f32 = 1.0 / 36.0;
/// Distance in metres of the nearest surfaces for which a guard band without a distance is sized.
const NEAREST: f32 = 1.0;
/// Distance in metres from which on the guard band is wide enough for the head's motion, whatever its own distance is:
/// nearer surfaces move so far that it would cost more than a render.
const NEAREST_MOVED: f32 = 0.5;

/// The largest turn of a head between two renders, in radians. Further is a jump: a snap turn, another viewpoint.
const MAX_RADIANS: f32 = 0.35;
/// The largest distance that a head moves between two renders, in metres.
const MAX_METRES: f32 = 0.25;

/// True if an eye is further from its former pose than a head moves between two renders.
fn has_jumped(from: &View, to: &View) -> bool {
    let (from, to) = (&from.pose, &to.pose);
    from.orientation.angle_between(to.orientation) > MAX_RADIANS
        || from.position.distance(to.position) > MAX_METRES
}

/// Renders with a guard band on all four sides, of one eye or of each, shown in any number of frames: each eye is
/// synthesized from colour, depth and motion vectors at the newest poses. Transparent surfaces and highlights move with
/// what is behind them.
pub struct HalfRate {
    gl: Rc<Context>,
    guard_band: GuardBand,
    /// The motion of a head between two renders that the guard band allows for.
    motion: HeadMotion,
    /// True if each eye has a render of its own.
    each: bool,
    renders: Vec<Render>,
    /// True if the depth of the renders is that of two samples. Where a texture holds one, as after extrapolation, the other
    /// reads as 0, the farthest.
    pairs: bool,
    /// Synthesis without and with depth; the latter is made with the first frame that wants it.
    synthesis: [Option<Synthesizer>; 2],
}

/// What surfaces that move need. Each render has its own: its view may have another size.
struct Moving {
    pass: VectorPass,
    vectors: RenderTarget,
    extrapolator: Extrapolator,
    /// The view before, if there are vectors since; `None` if nothing in the view moves, or there was none before.
    former: Option<View>,
}

/// The images of a rendered view.
struct Render {
    targets: Targets,
    /// The view in the targets; `None` before the first frame.
    view: Option<View>,
    /// Made if anything moves.
    moving: Option<Moving>,
}

/// The synthesis, and the image of an eye whose depth is wanted.
struct Synthesizer {
    any_view: AnyView,
    image: Option<RenderTarget>,
}

impl Synthesizer {
    fn new(gl: &Rc<Context>, pairs: bool, depth: bool) -> Result<Synthesizer, GlError> {
        let outputs = Outputs { depth, ..Outputs::default() };
        let image = depth.then(|| {
            let formats = [(Format::Rgba8, Filter::Linear)];
            RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth32F))
        });
        let options = Options { depth_pairs: pairs, ..Options::default() };
        Ok(Synthesizer { any_view: AnyView::new(gl, &options, outputs)?, image: image.transpose()? })
    }
}

impl Moving {
    fn new(gl: &Rc<Context>, pairs: bool) -> Result<Moving, GlError> {
        let options = Options { depth_pairs: pairs, ..Options::default() };
        let formats = [(Format::Rgba16F, Filter::Nearest)];
        Ok(Moving {
            pass: VectorPass::new(gl, pairs)?,
            vectors: RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth24))?,
            extrapolator: Extrapolator::new(gl, &options)?,
            former: None,
        })
    }

    /// Writes the vectors of a view in targets, if anything in it moves. `former` is the view rendered before.
    fn write_vectors(
        &mut self,
        targets: &Targets,
        scene: &GpuScene,
        view: &View,
        former: Option<View>,
    ) -> Result<(), GlError> {
        self.former = former.filter(|former| scene.is_moving_in(view) && !has_jumped(former, view));
        let Some(then) = self.former else { return Ok(()) };
        self.vectors.resize(view.size)?;
        let step = Step { view: *view, now: *view, then, ndc: Ndc::ZeroToOne };
        self.pass.draw_moving(scene, &step)?;
        let depth = targets.depth(view.size, Eye::Left, [0, 0]);
        self.pass.write((&depth, view), &step, [0, 0], &Destination::whole(&self.vectors))
    }
}

impl HalfRate {
    /// Makes the method, with one render for both eyes, or one for `each`. For the paper's pipeline returns
    /// [`GlError::Unsupported`].
    pub(super) fn new(gl: &Rc<Context>, options: &StereoOptions, each: bool) -> Result<HalfRate, GlError> {
        if options.synthesis.pipeline == Pipeline::Paper && !each {
            let message =
                "the pipeline paper cannot show a render again: choose the pipeline gather, or every frame";
            return Err(GlError::Unsupported(message.into()));
        }
        Ok(HalfRate {
            gl: gl.clone(),
            guard_band: options.guard_band,
            motion: HeadMotion {
                rotation: DEGREES_PER_SECOND.to_radians() * SECONDS,
                translation: METRES_PER_SECOND * SECONDS,
            },
            each,
            renders: Vec::new(),
            pairs: false,
            synthesis: Default::default(),
        })
    }

    /// Returns the view of a render: what its eye, or both, see now, and what they will see after the head's motion.
    fn source_view(&self, frame: &Frame, render: usize) -> Result<View, EyesError> {
        let nearest = frame.level().nearest.unwrap_or(match self.guard_band {
            GuardBand::Distance(metres) | GuardBand::Auto(metres) => metres,
            GuardBand::None | GuardBand::Pixels(_) => NEAREST,
        });
        let seen = match self.each {
            true => frame.pair.view(Eye::BOTH[render]),
            false => frame.synthesis_views(self.guard_band)?.source,
        };
        match self.motion.guarded(&seen, nearest.max(NEAREST_MOVED)) {
            // The guard band alone is as wide as a view can be.
            Err(EyesError::Apart) => Ok(seen),
            guarded => Ok(guarded?.view),
        }
    }

    /// Synthesizes both eyes from the renders, after a part of the step between the last two of them.
    fn show(&mut self, pair: &EyePair, to: &[EyeTarget; 2], ahead: f32) -> Result<(), StereoError> {
        let eyes = reversed(pair);
        let HalfRate { gl, each, renders, pairs, synthesis, .. } = self;
        for (i, render) in renders.iter_mut().enumerate() {
            let Some(source) = &render.view else { return Ok(()) };
            let targets = &render.targets;
            let color = targets.developed.as_ref().unwrap_or(targets.color());
            let depth = targets.depth(source.size, Eye::Left, [0, 0]);
            let mut images = Source::new(color.color(0).raw(), depth.texture.raw());
            if let Some(Moving { vectors, extrapolator, former: Some(former), .. }) = &mut render.moving
                && ahead > 0.0
            {
                let step = Extrapolation::new(source, former, Ndc::ZeroToOne, f64::from(ahead))?;
                images = extrapolator.extrapolate(images, (vectors.color(0).raw(), source.size), &step)?;
            }
            for eye in Eye::BOTH.into_iter().filter(|eye| !*each || eye.index() == i) {
                let to = &to[eye.index()];
                let warp = PoseWarp::new(source, &eyes.view(eye))?;
                let slot = &mut synthesis[usize::from(to.depth.is_some())];
                let Synthesizer { any_view, image } = match slot {
                    Some(made) => made,
                    None => slot.insert(Synthesizer::new(gl, *pairs, to.depth.is_some())?),
                };
                let Some(image) = image else {
                    any_view.synthesize(images, &warp, &to.color)?;
                    continue;
                };
                image.resize(pair.size)?;
                any_view.synthesize(images, &warp, &Destination::whole(image))?;
                gl.pass("copy", || image.copy_color([0, 0], &to.color));
                let convention = DepthConvention::Reversed;
                let texture = image.depth();
                let depth = DepthImage { texture, origin: [0, 0], layer: None, is_pair: false, convention };
                write_depth(&depth, to, pair.depth.convention);
            }
        }
        Ok(())
    }
}

impl StereoMethod for HalfRate {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        if self.renders.is_empty() {
            for _ in 0..1 + usize::from(self.each) {
                let targets = renderer.targets(Layout::Single)?;
                self.renders.push(Render { targets, view: None, moving: None });
            }
            self.pairs = renderer.nearest_depth() == DepthResolve::InColor;
            self.synthesis[0] = Some(Synthesizer::new(&self.gl, self.pairs, false)?);
        }
        // Vectors are floats; where a driver cannot draw any, what moves stays where it was rendered.
        let can_move = scene.moves() && self.gl.capabilities().float_render_targets;
        for render in self.renders.iter_mut().filter(|render| can_move && render.moving.is_none()) {
            render.moving = Some(Moving::new(&self.gl, self.pairs)?);
        }
        Ok(())
    }

    fn render_level(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        level: &LevelEyes,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.prepare(renderer, scene)?;
        let frame = Frame::new(renderer, scene, level, to)?;
        let renderer = frame.renderer;
        for i in 0..self.renders.len() {
            let view = &self.source_view(&frame, i)?;
            let render = &mut self.renders[i];
            let former = render.view.take();
            let targets = &mut render.targets;
            renderer.draw_all(targets, &frame.scene, std::slice::from_ref(view), true, None)?;
            if renderer.develops() {
                let to = Destination::whole(targets.picture(view.size)?);
                renderer.develop(targets, view, Eye::Left, [0, 0], &to, None);
            }
            if let Some(moving) = &mut render.moving {
                moving.write_vectors(&render.targets, scene, view, former)?;
            }
            render.view = Some(*view);
        }
        self.show(&level.eyes, to, 0.0)
    }

    fn show_again(&mut self, pair: &EyePair, to: &[EyeTarget; 2], ahead: f32) -> Result<bool, StereoError> {
        let eye = pair.view(pair.dominant);
        let is_near = |render: &Render| render.view.as_ref().is_some_and(|view| !has_jumped(view, &eye));
        if self.renders.is_empty() || !self.renders.iter().all(is_near) {
            return Ok(false);
        }
        match self.show(pair, to, ahead) {
            // The head has turned away from the render.
            Err(StereoError::Eyes(EyesError::Apart)) => Ok(false),
            shown => shown.map(|()| true),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use yoro::eyes::{DepthConvention, Pose};
    use yoro_context::{Backend, Headless};

    use super::super::method::StereoFrame;
    use super::super::options::{FramesBetween, Method, StereoOptions};
    use super::super::tests::{Rig, local, pair};
    use super::*;
    use crate::view::RenderSettings;

    /// Returns the eyes after the head has moved.
    fn moved(pair: &EyePair, by: Vec3, turn: Quat) -> EyePair {
        let poses = pair
            .poses
            .map(|pose| Pose { position: turn * pose.position + by, orientation: turn * pose.orientation });
        EyePair { poses, ..*pair }
    }

    /// Returns the mean square difference of two images.
    fn error(a: &[u8], b: &[u8]) -> f64 {
        let sum: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
        sum / a.len() as f64
    }

    #[test]
    fn later_frames_show_the_render_where_the_head_is() {
        let head = Headless::open(Backend::Egl).unwrap();
        // An edge of several samples has one depth, so that only single samples stay where they are.
        for msaa in [1, 4] {
            check(head.gl(), &RenderSettings { msaa, ..local() });
        }
        assert_eq!(head.gl().take_errors(), None);
    }

    /// The head's motion makes the view hardly wider if the guard band is for surfaces that are very near.
    #[test]
    fn a_near_guard_band_leaves_the_view_a_view() {
        let head = Headless::open(Backend::Egl).unwrap();
        let (gl, settings) = (head.gl(), local());
        for distance in [0.05, 0.1] {
            let guard_band = GuardBand::Distance(distance);
            let frames_between = FramesBetween::Method;
            let options = StereoOptions { guard_band, frames_between, ..StereoOptions::default() };
            let mut rig = Rig::new(gl, &settings);
            let mut method = super::super::create(gl, Method::Synthesized, &settings, &options).unwrap();
            let pair = pair(Eye::Right, DepthConvention::Reversed);
            rig.render(method.as_mut(), &pair);
            let shown = StereoFrame::new(gl, pair.size).unwrap();
            assert!(method.show_again(&pair, &shown.targets(), 0.5).unwrap(), "{distance} m");
        }
    }

    fn check(gl: &Rc<Context>, settings: &RenderSettings) {
        let options = StereoOptions { frames_between: FramesBetween::Method, ..StereoOptions::default() };
        let mut rig = Rig::new(gl, settings);
        let create = |method, options| super::super::create(gl, method, settings, options).unwrap();
        let every = StereoOptions::default();
        let mut truth = create(Method::Conventional, &every);
        let mut method = create(Method::Synthesized, &options);
        let mut shown = StereoFrame::new(gl, [1, 1]).unwrap();
        for (dominant, convention) in
            [(Eye::Left, DepthConvention::Standard), (Eye::Right, DepthConvention::Reversed)]
        {
            let before = pair(dominant, convention);
            let rendered = rig.render(method.as_mut(), &before);
            let expected = rig.render(truth.as_mut(), &before);
            let kept = error(&rendered[dominant.index()], &expected[dominant.index()]);
            assert!(kept < if settings.msaa == 1 { 1.0 } else { 6.0 }, "{dominant:?}: {kept}");
            let now = moved(&before, Vec3::new(0.01, 0.008, -0.015), Quat::from_rotation_y(0.025));
            shown.resize(now.size).unwrap();
            assert!(method.show_again(&now, &shown.targets(), 0.5).unwrap());
            let expected = rig.render(truth.as_mut(), &now);
            for eye in Eye::BOTH {
                let shown = shown.eye(eye).read_rgba8(0, [0, 0], now.size);
                let [late, same] =
                    [&shown, &rendered[eye.index()]].map(|image| error(image, &expected[eye.index()]));
                let least = if settings.msaa == 1 { 7.0 } else { 8.0 };
                assert!(late < same / least, "{eye:?}: {late}, without motion {same}");
            }
        }
        // A snap turn, and a teleport.
        for (by, turn) in [(Vec3::ZERO, Quat::from_rotation_y(0.5)), (Vec3::X, Quat::IDENTITY)] {
            let away = moved(&pair(Eye::Right, DepthConvention::Reversed), by, turn);
            assert!(!method.show_again(&away, &shown.targets(), 0.5).unwrap());
        }
    }
}
