//! One render of the dominant eye, shown in several frames at the newest poses of both eyes.

use std::rc::Rc;

use super::frame::{reversed, write_depth};
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{Pipeline, StereoOptions};
use crate::view::{DepthImage, GpuScene, Layout, NearestDepth, Renderer, Targets};
use yoro::eyes::{DepthConvention, Eye, EyePair, EyesError, GuardBand, HeadMotion, PoseWarp, View};
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
pub struct Reprojected {
    gl: Rc<Context>,
    guard_band: GuardBand,
    /// The motion of a head between two renders that the guard band allows for.
    motion: HeadMotion,
    targets: Option<Targets>,
    /// The view in the targets; `None` before the first frame.
    rendered: Option<View>,
    /// True if the depth of the view is that of two samples.
    pairs: bool,
    /// Synthesis without and with depth, each made when first needed.
    synthesis: [Option<Synthesizer>; 2],
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

impl Reprojected {
    /// Makes the method for `rate` renders per second. For the paper's pipeline returns [`GlError::Unsupported`].
    pub(super) fn new(gl: &Rc<Context>, options: &StereoOptions, rate: f32) -> Result<Reprojected, GlError> {
        if options.synthesis.pipeline == Pipeline::Paper {
            let message = "the pipeline paper cannot show a render again: choose the pipeline gather, or no render rate";
            return Err(GlError::Unsupported(message.into()));
        }
        Ok(Reprojected {
            gl: gl.clone(),
            guard_band: options.guard_band,
            motion: HeadMotion {
                rotation: DEGREES_PER_SECOND.to_radians() / rate,
                translation: METRES_PER_SECOND / rate,
            },
            targets: None,
            rendered: None,
            pairs: false,
            synthesis: [None, None],
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
        let Some(targets) = &self.targets else { return Ok(()) };
        let eyes = reversed(pair);
        for eye in Eye::BOTH {
            let to = &to[eye.index()];
            let warp = PoseWarp::new(source, &eyes.view(eye))?;
            let slot = &mut self.synthesis[usize::from(to.depth.is_some())];
            let Synthesizer { any_view, image } = match slot {
                Some(made) => made,
                None => slot.insert(Synthesizer::new(&self.gl, self.pairs, to.depth.is_some())?),
            };
            let color = targets.developed.as_ref().unwrap_or(targets.color());
            let depth = targets.depth(source.size, Eye::Left, [0, 0]);
            let images = Source::new(color.color(0).raw(), depth.texture.raw());
            let Some(image) = image else {
                any_view.synthesize(images, &warp, &to.color)?;
                continue;
            };
            image.resize(pair.size)?;
            any_view.synthesize(images, &warp, &Destination::whole(image))?;
            self.gl.pass("copy", || image.copy_color([0, 0], &to.color));
            let convention = DepthConvention::Reversed;
            let depth = DepthImage {
                texture: image.depth(),
                origin: [0, 0],
                layer: None,
                is_pair: false,
                convention,
            };
            write_depth(&depth, to, pair.depth.convention);
        }
        Ok(())
    }
}

impl StereoMethod for Reprojected {
    fn prepare(&mut self, renderer: &mut Renderer, _: &GpuScene) -> Result<(), StereoError> {
        if self.targets.is_none() {
            self.targets = Some(renderer.targets(Layout::Single)?);
            self.pairs = renderer.nearest_depth() == NearestDepth::Carried;
            self.synthesis[0] = Some(Synthesizer::new(&self.gl, self.pairs, false)?);
        }
        Ok(())
    }

    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        self.prepare(renderer, scene)?;
        renderer.check_scene(scene)?;
        let view = self.source_view(&reversed(pair))?;
        let Some(targets) = &mut self.targets else { return Ok(()) };
        self.rendered = None;
        renderer.draw_all(targets, scene, std::slice::from_ref(&view), true, None)?;
        if renderer.develops() {
            let to = Destination::whole(targets.picture(view.size)?);
            renderer.develop(targets, &view, Eye::Left, [0, 0], &to, None);
        }
        self.rendered = Some(view);
        self.show(&view, pair, to)
    }

    fn show_again(&mut self, pair: &EyePair, to: &[EyeTarget; 2]) -> Result<bool, StereoError> {
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

    fn check(gl: &Rc<Context>, settings: &RenderSettings) {
        let options = StereoOptions { render_rate: Some(36.0), ..StereoOptions::default() };
        let mut rig = Rig::new(gl, settings);
        let create = |method, options| super::super::create(gl, method, settings, options).unwrap();
        let mut truth = create(Method::Conventional, &options);
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
            assert!(method.show_again(&now, &shown.targets()).unwrap());
            let expected = rig.render(truth.as_mut(), &now);
            for eye in Eye::BOTH {
                let shown = shown.eye(eye).read_rgba8(0, [0, 0], now.size);
                let [late, same] =
                    [&shown, &rendered[eye.index()]].map(|image| error(image, &expected[eye.index()]));
                let least = if settings.msaa == 1 { 7.0 } else { 8.0 };
                assert!(late < same / least, "{eye:?}: {late}, without motion {same}");
            }
        }
        let away =
            moved(&pair(Eye::Right, DepthConvention::Reversed), Vec3::ZERO, Quat::from_rotation_y(1.5));
        assert!(!method.show_again(&away, &shown.targets()).unwrap());
    }
}
