//! One render of the dominant eye, shown in several frames at the newest poses of both eyes.

use std::rc::Rc;

use super::finish::{EyeImage, Finish};
use super::frame::{Frame, FrameMethod, Setup};
use super::method::{EyeTarget, StereoError};
use super::options::Pipeline;
use crate::render::{DepthImage, RendererOfKind, ViewImages, ViewRenderer};
use yoro::eyes::{Eye, EyePair, EyesError, GuardBand, HeadMotion, PoseWarp, View};
use yoro::opengl::{AnyView, Options, Outputs, Source};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};

/// Degrees per second that a head may turn before its borders are filled, if a render is shown for the whole time until
/// the next.
const DEGREES_PER_SECOND: f32 = 60.0;
/// Metres per second that it may move.
const METRES_PER_SECOND: f32 = 1.0;
/// Distance in metres of the nearest surfaces for which a guard band without a distance is sized.
const NEAREST: f32 = 1.0;

/// One render with a guard band on all four sides, shown in any number of frames: each eye is synthesized from its
/// colour and depth. Surfaces stand still meanwhile; transparent ones and highlights move with what is behind them.
pub struct Reprojected<R: ViewRenderer> {
    gl: Rc<Context>,
    guard_band: GuardBand,
    /// The motion of a head between two renders that the guard band allows for.
    motion: HeadMotion,
    targets: R::Targets,
    /// The view in the targets; `None` before the first frame.
    rendered: Option<View>,
    /// Synthesis without and with depth, each made when first needed.
    synthesis: [Option<Synthesizer>; 2],
    finish: Finish,
}

/// The synthesis, and the image it writes: an eye before anti-aliasing.
struct Synthesizer {
    any_view: AnyView,
    image: RenderTarget,
}

impl Synthesizer {
    fn new(gl: &Rc<Context>, depth: bool) -> Result<Synthesizer, GlError> {
        let outputs = Outputs { depth, ..Outputs::default() };
        let format = depth.then_some(Format::Depth32F);
        Ok(Synthesizer {
            any_view: AnyView::new(gl, &Options::default(), outputs)?,
            image: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Linear)], format)?,
        })
    }
}

impl<R: ViewRenderer> Reprojected<R> {
    /// Makes the targets for `rate` renders per second. For the paper's pipeline returns [`GlError::Unsupported`].
    pub(super) fn new(setup: &Setup, rate: f32) -> Result<Reprojected<R>, GlError> {
        if setup.options.synthesis.pipeline == Pipeline::Paper {
            let message = "the pipeline paper cannot show a render again: choose the pipeline gather, or no render rate";
            return Err(GlError::Unsupported(message.into()));
        }
        Ok(Reprojected {
            gl: setup.gl.clone(),
            guard_band: setup.options.guard_band,
            motion: HeadMotion {
                rotation: DEGREES_PER_SECOND.to_radians() / rate,
                translation: METRES_PER_SECOND / rate,
            },
            targets: R::targets(setup.gl, setup.settings)?,
            rendered: None,
            synthesis: [Some(Synthesizer::new(setup.gl, false)?), None],
            finish: Finish::new(setup)?,
        })
    }

    /// Returns the view to render: what both eyes see now, and what they will see after the head's motion.
    fn source_view(&self, pair: &EyePair) -> Result<View, EyesError> {
        let nearest = match self.guard_band {
            GuardBand::Distance(metres) | GuardBand::Auto(metres) => metres,
            GuardBand::None | GuardBand::Pixels(_) => NEAREST,
        };
        let both = pair.synthesis_views(self.guard_band)?.source;
        Ok(self.motion.guarded(&both, nearest)?.view)
    }

    /// Synthesizes both eyes from a rendered view.
    fn show(&mut self, source: &View, pair: &EyePair, to: &[EyeTarget; 2]) -> Result<(), StereoError> {
        for eye in Eye::BOTH {
            let to = &to[eye.index()];
            let warp = PoseWarp::new(source, &pair.view(eye))?;
            let slot = &mut self.synthesis[usize::from(to.depth.is_some())];
            let Synthesizer { any_view, image } = match slot {
                Some(made) => made,
                None => slot.insert(Synthesizer::new(&self.gl, true)?),
            };
            image.resize(pair.size)?;
            let images = Source::new(self.targets.color().color(0).raw(), self.targets.depth().raw());
            any_view.synthesize(images, &warp, &Destination::whole(image))?;
            let depth = to.depth.is_some().then(|| DepthImage::whole(image.depth()));
            self.finish.run(&EyeImage { color: image, origin: [0, 0], depth }, to);
        }
        Ok(())
    }
}

impl<R: RendererOfKind> FrameMethod for Reprojected<R> {
    type Renderer = R;

    fn render_frame(&mut self, frame: &Frame<R>) -> Result<(), StereoError> {
        let view = self.source_view(frame.pair)?;
        self.rendered = None;
        frame.renderer.render_all(&mut self.targets, frame.scene, &view, true)?;
        self.rendered = Some(view);
        self.show(&view, frame.pair, frame.targets())
    }

    fn show_last(&mut self, pair: &EyePair, to: &[EyeTarget; 2]) -> Result<bool, StereoError> {
        let Some(view) = self.rendered else { return Ok(false) };
        match self.show(&view, pair, to) {
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
    use super::super::options::{Method, StereoOptions};
    use super::super::tests::{Rig, local, pair};
    use super::*;

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
        let (gl, settings) = (head.gl(), local());
        let options = StereoOptions { render_rate: Some(36.0), ..StereoOptions::default() };
        let mut rig = Rig::new(gl, &settings);
        let create = |method, options| super::super::create(gl, method, &settings, options).unwrap();
        let mut truth = create(Method::Conventional, &options);
        let mut method = create(Method::Synthesized, &options);
        let mut shown = StereoFrame::new(gl, [1, 1]).unwrap();
        for (dominant, convention) in
            [(Eye::Left, DepthConvention::Standard), (Eye::Right, DepthConvention::Reversed)]
        {
            let before = pair(dominant, convention);
            let rendered = rig.render(method.as_mut(), &before);
            let expected = rig.render(truth.as_mut(), &before);
            assert!(error(&rendered[dominant.index()], &expected[dominant.index()]) < 1.0);
            let now = moved(&before, Vec3::new(0.01, 0.008, -0.015), Quat::from_rotation_y(0.025));
            shown.resize(now.size).unwrap();
            assert!(method.show_again(&now, &shown.targets()).unwrap());
            let expected = rig.render(truth.as_mut(), &now);
            for eye in Eye::BOTH {
                let shown = shown.eye(eye).read_rgba8(0, [0, 0], now.size);
                let [late, same] =
                    [&shown, &rendered[eye.index()]].map(|image| error(image, &expected[eye.index()]));
                assert!(late < same / 8.0, "{eye:?}: {late}, without motion {same}");
            }
        }
        let away =
            moved(&pair(Eye::Right, DepthConvention::Reversed), Vec3::ZERO, Quat::from_rotation_y(1.5));
        assert!(!method.show_again(&away, &shown.targets()).unwrap());
        assert_eq!(gl.take_errors(), None);
    }
}
