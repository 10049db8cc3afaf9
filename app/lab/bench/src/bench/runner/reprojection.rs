//! One render shown at another pose: after the head has moved, and for canted eyes.

use std::rc::Rc;

use glam::Quat;
use image::RgbImage;

use super::Runner;
use crate::bench::job::{Job, TargetPose};
use crate::bench::picture_folder;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::Views;
use yoro::eyes::{Eye, EyePair, GuardBand, HeadMotion, PoseWarp, View};
use yoro::opengl::{AnyView, Gather, Options, Outputs, Source};
use yoro_files::interrupt;
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};
use yoro_metrics::{Channels, SsimWindow, psnr, ssim};
use yoro_render::{PreparedScene, ViewTargets};

/// Names of the ways of showing a render at another pose.
const SAME_IMAGE: &str = "same-image";
const ROTATION: &str = "rotation";
const ANY_VIEW: &str = "any-view";
/// Gather between parallel eyes at the positions of the canted ones, with the result turned back.
const PARALLEL_EYES: &str = "gather-parallel-eyes";

/// The distance in metres beyond which the source's guard band covers all surfaces.
const NEAREST: f32 = 0.5;
/// The angle in degrees by which each canted eye is turned outwards.
const CANT_DEGREES: f32 = 5.0;

/// The pictures of each way, by its name.
type Shown = Vec<(&'static str, RgbImage)>;

impl Runner<'_> {
    /// Measures the frames of the job, each against a real render at the pose where it is shown.
    pub(super) fn reprojection(
        &mut self,
        job: &Job,
        displaced: TargetPose,
        prepared: &mut PreparedScene,
    ) -> anyhow::Result<()> {
        self.bar.set_message(job.conditions.to_string());
        let mut reprojector = Reprojector::new(self.gl)?;
        let (views, late) = match displaced {
            TargetPose::Late(motion, late) => {
                // The frames are spread over the motion, so that neighbours are not alike.
                let all = Job { frames: job.frames * SPREAD + late, ..job.clone() };
                (Views::of_motion(&all, prepared, motion)?, Some(late))
            }
            TargetPose::Canted => (Views::spread(job, prepared)?, None),
        };
        let mut measurements: Vec<Measurement> = Vec::new();
        for i in 0..job.frames.min(views.pairs.len()) {
            interrupt::check()?;
            let (shown, truth) = match late {
                Some(late) => {
                    let [then, now] = [0, late].map(|n| views.pairs[i * SPREAD + n]);
                    reprojector.late(prepared, &then, &now)?
                }
                None => reprojector.canted(prepared, &canted(&views.pairs[i]))?,
            };
            if i == 0 {
                let folder = picture_folder(&self.before.path, &job.conditions);
                for (name, image) in shown.iter().map(|(way, image)| (*way, image)).chain([("truth", &truth)])
                {
                    yoro_media::save_color(&folder.join(format!("{name}.png")), image)?;
                }
            }
            for (way, image) in shown {
                let measurement = measurement_of(&mut measurements, job, way);
                measurement.push(metric::PSNR, psnr(&image, &truth, Channels::Rgb)?.0);
                measurement.push(metric::SSIM, ssim(&image, &truth, SsimWindow::Gaussian11, Channels::Rgb)?);
            }
            self.bar.inc(1);
        }
        self.finish_round(job, 0, vec![Record::Scene(views.facts(job, prepared))], measurements)
    }
}

/// Returns the measurement of a contender, and creates it if there is none yet.
pub(super) fn measurement_of<'a>(
    all: &'a mut Vec<Measurement>,
    job: &Job,
    name: &str,
) -> &'a mut Measurement {
    let at = all.iter().position(|m| m.contender == name).unwrap_or_else(|| {
        all.push(Measurement::new(&job.conditions, name, 0));
        all.len() - 1
    });
    &mut all[at]
}

/// The number of frames from one measured frame to the next.
pub(super) const SPREAD: usize = 9;

/// Returns the same eyes, turned outwards.
fn canted(pair: &EyePair) -> EyePair {
    let mut eyes = *pair;
    for (pose, side) in eyes.poses.iter_mut().zip([1.0, -1.0]) {
        pose.orientation *= Quat::from_rotation_y(side * CANT_DEGREES.to_radians());
    }
    eyes
}

/// Renders views and shows them at other poses.
struct Reprojector {
    gl: Rc<Context>,
    any_view: AnyView,
    gather: Gather,
    rendered: ViewTargets,
    parallel: RenderTarget,
    shown: RenderTarget,
}

impl Reprojector {
    fn new(gl: &Rc<Context>) -> Result<Reprojector, GlError> {
        let options = Options::default();
        let formats = [(Format::Rgba8, Filter::Linear)];
        let outputs = Outputs { depth: true, ..Outputs::default() };
        Ok(Reprojector {
            gl: gl.clone(),
            any_view: AnyView::new(gl, &options, Outputs::default())?,
            gather: Gather::new(gl, &options, outputs)?,
            rendered: ViewTargets::default(),
            parallel: RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth32F))?,
            shown: RenderTarget::new(gl, [1, 1], &formats, None)?,
        })
    }

    fn render(&mut self, prepared: &PreparedScene, view: &View) -> Result<(RgbImage, Source), GlError> {
        let rendered = prepared.renderer.render_all(&mut self.rendered, &prepared.scene, view)?;
        let image = yoro_media::rgb_image(&rendered.color.read_rgba8(0, [0, 0], view.size), view.size);
        Ok((image, Source::new(rendered.color.color(0).raw(), rendered.depth.texture.raw())))
    }

    fn show(&mut self, source: Source, warp: &PoseWarp) -> Result<RgbImage, GlError> {
        self.shown.resize(warp.target_size)?;
        self.any_view.synthesize(source, warp, &Destination::whole(&self.shown))?;
        self.gl.finish();
        Ok(yoro_media::rgb_image(&self.shown.read_rgba8(0, [0, 0], warp.target_size), warp.target_size))
    }

    /// Shows the dominant eye of one frame at its pose in a later frame.
    fn late(
        &mut self,
        prepared: &PreparedScene,
        then: &EyePair,
        now: &EyePair,
    ) -> anyhow::Result<(Shown, RgbImage)> {
        let [old, target] = [then, now].map(|pair| pair.view(pair.dominant));
        let motion = HeadMotion {
            rotation: old.pose.orientation.angle_between(target.pose.orientation),
            translation: old.pose.position.distance(target.pose.position),
        };
        let source = motion.guarded(&old, NEAREST)?.view;
        let (truth, _) = self.render(prepared, &target)?;
        let (same, _) = self.render(prepared, &old)?;
        let (_, image) = self.render(prepared, &source)?;
        let warp = PoseWarp::new(&source, &target)?;
        let shown = vec![
            (SAME_IMAGE, same),
            (ROTATION, self.show(image, &warp.rotation_only())?),
            (ANY_VIEW, self.show(image, &warp)?),
        ];
        Ok((shown, truth))
    }

    /// Synthesizes the other of two canted eyes, directly and by parallel eyes with as many pixels per tangent.
    fn canted(&mut self, prepared: &PreparedScene, eyes: &EyePair) -> anyhow::Result<(Shown, RgbImage)> {
        let other = eyes.dominant.other();
        let [own, target] = [eyes.dominant, other].map(|eye| eyes.view(eye));
        let (truth, _) = self.render(prepared, &target)?;
        let (same, _) = self.render(prepared, &own)?;

        let motion = HeadMotion { rotation: 2.0 * CANT_DEGREES.to_radians(), translation: eyes.ipd().abs() };
        let source = motion.guarded(&own, NEAREST)?.view;
        let (_, image) = self.render(prepared, &source)?;
        let direct = self.show(image, &PoseWarp::new(&source, &target)?)?;

        let mut parallel = eyes.rectified().ok_or_else(|| anyhow::anyhow!("the eyes are turned too far"))?;
        let (wide, narrow) = (parallel.frusta[Eye::Left.index()], own.frustum);
        parallel.size = [
            (eyes.size[0] as f32 * wide.width() / narrow.width()).ceil() as u32,
            (eyes.size[1] as f32 * wide.height() / narrow.height()).ceil() as u32,
        ];
        let views = parallel.synthesis_views(GuardBand::Distance(NEAREST))?;
        let (_, image) = self.render(prepared, &views.source)?;
        self.parallel.resize(views.target.size)?;
        self.gather.synthesize(image, &views.warp, &Destination::whole(&self.parallel))?;
        let image = Source::new(self.parallel.color(0).raw(), self.parallel.depth().raw());
        let turned = self.show(image, &PoseWarp::new(&views.target, &target)?.rotation_only())?;
        Ok((vec![(SAME_IMAGE, same), (PARALLEL_EYES, turned), (ANY_VIEW, direct)], truth))
    }
}
