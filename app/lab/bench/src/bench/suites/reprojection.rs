//! One render shown at another pose: after the head has moved, and for canted eyes.

use std::rc::Rc;

use glam::Quat;
use image::RgbImage;

use super::super::Experiment;
use super::super::job::{Choices, Job, QUICK_SCENES, VARIED_SCENES};
use super::super::record::metric;
use super::super::results::SuiteData;
use super::super::runner::{Round, Runner};
use super::super::scenes::LazyObject;
use super::super::tables::show_labels;
use super::super::views::{Motion, SPREAD};
use yoro::eyes::{Eye, EyePair, GuardBand, HeadMotion, PoseWarp, View};
use yoro::opengl::{AnyView, Gather, Options, Outputs, Source};
use yoro_files::interrupt;
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};
use yoro_metrics::{Channels, SsimWindow, psnr, ssim};
use yoro_render::{PreparedScene, ViewTargets};
use yoro_report::Section;

const SAME_IMAGE: &str = "same-image";
const ROTATION: &str = "rotation";
const ANY_VIEW: &str = "any-view";
/// Gather between parallel eyes at the positions of the canted ones, with the result turned back.
const PARALLEL_EYES: &str = "gather-parallel-eyes";

/// The distance in metres beyond which the source's guard band covers all surfaces.
const NEAREST: f32 = 0.5;
/// The angle in degrees by which each canted eye is turned outwards.
const CANT_DEGREES: f32 = 5.0;
/// The largest delay in frames.
const MAX_LATE: usize = 4;

/// The pose at which a render is shown.
#[derive(Clone, Copy)]
enum TargetPose {
    /// The pose of the same eye this number of frames later, at 72 frames per second.
    Late { motion: Motion, frames: usize },
    /// The pose of the other of two canted eyes.
    Canted,
}

/// Canted eyes, then two motions of the head by delay.
const POSES: [TargetPose; 1 + 2 * MAX_LATE] = {
    let mut poses = [TargetPose::Canted; 1 + 2 * MAX_LATE];
    let mut frames = 1;
    while frames <= MAX_LATE {
        poses[frames] = TargetPose::Late { motion: Motion::Sway, frames };
        poses[MAX_LATE + frames] = TargetPose::Late { motion: Motion::Walk, frames };
        frames += 1;
    }
    poses
};

/// One render shown at another pose: after the head has moved, and for canted eyes.
pub struct Reprojection;

impl Experiment for Reprojection {
    fn name(&self) -> &'static str {
        "reprojection"
    }

    fn about(&self) -> &'static str {
        "Quality of one render shown at a later pose of the head, and of canted eyes"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let scenes = if choices.quick { &QUICK_SCENES[..] } else { &VARIED_SCENES };
        Ok(choices.sweep(self, choices.scenes(scenes.iter().copied()), POSES, |job, pose| {
            job.conditions.label = Some(match pose {
                TargetPose::Canted => "canted eyes".to_owned(),
                TargetPose::Late { motion, frames } => format!("{}, {frames} late", motion.name()),
            });
        }))
    }

    fn steps(&self, job: &Job) -> u64 {
        job.frames as u64
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Any view",
            "One render shown some frames later, 72 a second, at the head's pose then, and to the other of two canted eyes.",
        );
        show_labels(&mut section, suite, "pose");
        vec![section]
    }

    fn moves(&self, job: &Job) -> bool {
        matches!(POSES[job.point], TargetPose::Late { .. })
    }

    /// Measures the frames of the job, each against a real render at the pose where it is shown.
    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        runner.announce(job, 0);
        let mut reprojector = Reprojector::new(runner.gl)?;
        let pose = POSES[job.point];
        let views = match pose {
            // The frames are spread over the motion, so that neighbours are not alike.
            TargetPose::Late { motion, frames } => {
                runner.moving(job, scene, motion, job.frames * SPREAD + frames)?
            }
            TargetPose::Canted => runner.viewpoints(job, scene)?,
        };
        let mut round = Round::of_views(job, 0, &views, scene);
        for i in 0..job.frames.min(views.pairs.len()) {
            interrupt::check()?;
            let Shown { images, truth } = match pose {
                TargetPose::Late { frames, .. } => {
                    let [then, now] = [0, frames].map(|n| views.pairs[i * SPREAD + n]);
                    reprojector.late(scene, &then, &now)?
                }
                TargetPose::Canted => reprojector.canted(scene, &canted(&views.pairs[i]))?,
            };
            if i == 0 {
                for (name, image) in
                    images.iter().map(|(name, image)| (*name, image)).chain([("truth", &truth)])
                {
                    runner.save_picture(job, name, image)?;
                }
            }
            for (name, image) in images {
                let measurement = round.of(name);
                measurement.push(metric::PSNR, psnr(&image, &truth, Channels::Rgb)?.0);
                measurement.push(metric::SSIM, ssim(&image, &truth, SsimWindow::Gaussian11, Channels::Rgb)?);
            }
            runner.bar.inc(1);
        }
        runner.finish(round)
    }
}

/// Returns the same eyes, turned outwards.
fn canted(pair: &EyePair) -> EyePair {
    let mut eyes = *pair;
    for (pose, side) in eyes.poses.iter_mut().zip([1.0, -1.0]) {
        pose.orientation *= Quat::from_rotation_y(side * CANT_DEGREES.to_radians());
    }
    eyes
}

/// One frame as each contender shows it, and as it really is.
struct Shown {
    images: Vec<(&'static str, RgbImage)>,
    truth: RgbImage,
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
    fn late(&mut self, prepared: &PreparedScene, then: &EyePair, now: &EyePair) -> anyhow::Result<Shown> {
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
        let images = vec![
            (SAME_IMAGE, same),
            (ROTATION, self.show(image, &warp.rotation_only())?),
            (ANY_VIEW, self.show(image, &warp)?),
        ];
        Ok(Shown { images, truth })
    }

    /// Synthesizes the other of two canted eyes, directly and by parallel eyes with as many pixels per tangent.
    fn canted(&mut self, prepared: &PreparedScene, eyes: &EyePair) -> anyhow::Result<Shown> {
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
        let images = vec![(SAME_IMAGE, same), (PARALLEL_EYES, turned), (ANY_VIEW, direct)];
        Ok(Shown { images, truth })
    }
}
