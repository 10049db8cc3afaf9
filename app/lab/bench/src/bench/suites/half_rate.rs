//! Half the rate of renders: the frame between two, as a headset's runtime makes it of both eyes' motion or of one's.

use std::rc::Rc;
use std::time::{Duration, Instant};

use anyhow::ensure;
use glam::Vec3;
use image::RgbImage;

use super::super::Experiment;
use super::super::job::{Choices, Job};
use super::super::record::metric;
use super::super::results::SuiteData;
use super::super::runner::{Round, Runner, milliseconds};
use super::super::scenes::LazyObject;
use super::super::subject::Subject;
use super::super::tables::{label_table, mean_and_range, show_labels};
use super::super::views::{HEADSET_RATE, Motion, SPREAD};
use super::foveation::DEGREES;
use yoro::eyes::{DepthConvention, Eye, EyePair, FoveationLevel, Ndc, Pose, View};
use yoro_files::interrupt;
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};
use yoro_metrics::{Channels, EyeCamera, EyePose, SsimWindow, SubmittedEye, psnr, psnr_where, ssim};
use yoro_render::stereo::{EyeTarget, HoleMethod, Method, MotionTarget, StereoFrame};
use yoro_render::{DepthImage, DepthReader, PreparedScene};
use yoro_report::Section;
use yoro_report::text::fixed;

/// The ways of making the frame between. The runtime is emulated.
const TWO_EYES: &str = "runtime-two-eyes";
const ONE_EYE: &str = "runtime-one-eye";
const RENDERED_HOLES: &str = "runtime-one-eye-holes-rendered";
/// The colour of two eyes with the vectors and depth of one: what these alone lose.
const VECTORS: &str = "runtime-made-vectors";
const ROTATION: &str = "rotation";
/// The same frame rendered: by yoro, and the dominant eye's image for both.
const FULL_RATE: &str = "yoro-full-rate";
const SAME_IMAGE: &str = "same-image";
/// Two renders of all pixels of every frame, against which times are to be compared.
const CONVENTIONAL: &str = "conventional";

/// The scenes with people who move.
const SCENES: [&str; 2] = ["talk", "stage"];
/// Pixels of an eye along each axis for one of its vectors.
const DIVISOR: u32 = 4;
/// Pixels around moving things that count as near them.
const NEAR: usize = 3;
/// Seconds of a scene's motion before the first frame.
const BEGIN: f64 = 2.0;

/// A motion of the head, by eyes of one level or of two.
#[derive(Clone, Copy)]
struct Case {
    motion: Motion,
    level: FoveationLevel,
}

const CASES: [Case; 6] = {
    const fn whole(motion: Motion) -> Case {
        Case { motion, level: FoveationLevel::Off }
    }
    [
        whole(Motion::Still),
        whole(Motion::Walk),
        whole(Motion::Strafe),
        whole(Motion::Turn),
        whole(Motion::Reach),
        Case { motion: Motion::Walk, level: FoveationLevel::Medium },
    ]
};

/// Half the rate of renders.
pub struct HalfRate;

impl Experiment for HalfRate {
    fn name(&self) -> &'static str {
        "half-rate"
    }

    fn about(&self) -> &'static str {
        "Quality and time of the frame between two renders, by a runtime from both eyes' motion or from one eye's"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let scenes = if choices.quick { &SCENES[..1] } else { &SCENES };
        Ok(choices.sweep(
            self,
            choices.scenes(scenes.iter().copied()),
            CASES,
            |job, Case { motion, level }| {
                job.conditions.label = Some(match level {
                    FoveationLevel::Off => motion.name().to_owned(),
                    level => {
                        let [_, degrees] = DEGREES;
                        job.eyes.fov_y = degrees.to_radians();
                        format!("{}, foveation {}, {degrees} degrees", motion.name(), level.name())
                    }
                });
            },
        ))
    }

    fn steps(&self, job: &Job) -> u64 {
        job.frames as u64
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Half rate",
            "At 72 frames a second every second one is rendered. The frame between is made by an emulated runtime, which \
             knows the newest pose exactly, of vectors and depth at a quarter of the size; compared is the eye that is not \
             dominant with that eye really rendered there.",
        );
        show_labels(&mut section, suite, "motion");
        let title = "PSNR in dB within 3 pixels of what moves";
        let contenders = suite.compared(metric::MOVING_PSNR);
        section.table(label_table(suite, title, "motion", &contenders, |label, name| {
            fixed(suite.mean_at(label, name, metric::MOVING_PSNR), 2)
        }));
        let title = "Time of a shown frame over two renders of all pixels in every frame";
        let contenders = suite.compared(metric::FRAME_MS);
        let mut table = label_table(suite, title, "motion", &contenders, |label, name| {
            let ratios = suite.labelled(label).filter_map(|setting| Some(setting.cost(name)?.median));
            mean_and_range(ratios)
        });
        table.note = "The mean of the scenes' medians, with the lowest and the highest. What the runtime does is not counted, nor is \
                      moving the scene's vertices."
            .into();
        section.table(table);
        vec![section]
    }

    fn moves(&self, _job: &Job) -> bool {
        true
    }

    /// Measures the frame between two renders of a moving scene, each against a real render at that time and pose.
    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        runner.announce(job, 0);
        let Case { motion, level } = CASES[job.point];
        let views = runner.moving(job, scene, motion, job.frames * SPREAD + 3)?;
        let mut contenders = Contenders::new(runner.gl, job, level)?;
        let mut round = Round::of_views(job, 0, &views, scene);
        for i in 0..job.frames {
            interrupt::check()?;
            let [previous, now, between] = [0, 2, 3].map(|n| Moment {
                pair: views.pairs[i * SPREAD + n],
                seconds: BEGIN + (i * SPREAD + n) as f64 / HEADSET_RATE,
            });
            let step = Step { previous, now, between };
            let shown = contenders.show(scene, &step)?;
            if i == 0 {
                let images = shown.images.iter().map(|(name, image)| (*name, image));
                for (name, image) in images.chain([("truth", &shown.truth)]) {
                    runner.save_picture(job, name, image)?;
                }
            }
            for (name, image) in &shown.images {
                let measurement = round.of(name);
                measurement.push(metric::PSNR, psnr(image, &shown.truth, Channels::Rgb)?.0);
                let similar = ssim(image, &shown.truth, SsimWindow::Gaussian11, Channels::Rgb)?;
                measurement.push(metric::SSIM, similar);
                if let Some(near) = psnr_where(image, &shown.truth, &shown.moving)? {
                    measurement.push(metric::MOVING_PSNR, near.0);
                }
            }
            for (name, time) in contenders.times(scene, &step)? {
                round.of(name).push(metric::FRAME_MS, milliseconds(time));
            }
            runner.bar.inc(1);
        }
        runner.finish(round)
    }
}

/// The eyes of a frame, and the time in the scene.
#[derive(Clone, Copy)]
struct Moment {
    pair: EyePair,
    seconds: f64,
}

/// Two renders, and the frame half a step after the second.
struct Step {
    previous: Moment,
    now: Moment,
    between: Moment,
}

/// The frame between two renders: the eye that is not dominant.
struct Shown {
    images: Vec<(&'static str, RgbImage)>,
    truth: RgbImage,
    /// Row by row from the top: true near things that move.
    moving: Vec<bool>,
}

/// The methods that take part, and what they draw into.
struct Contenders {
    gl: Rc<Context>,
    /// Two renders of all pixels: the truth.
    whole: Subject,
    conventional: Subject,
    synthesized: Subject,
    rendered_holes: Subject,
    mono: Subject,
    frame: StereoFrame,
    /// Vectors and depth of both eyes.
    vectors: [RenderTarget; 2],
    depth: DepthReader,
}

/// An eye's submission, read back.
struct ReadBack {
    rgba: Vec<u8>,
    vectors: Vec<Vec3>,
    /// True where something moves.
    moves: Vec<bool>,
    depth: Vec<f32>,
    size: [u32; 2],
}

impl Contenders {
    fn new(gl: &Rc<Context>, job: &Job, level: FoveationLevel) -> Result<Contenders, GlError> {
        let filled = HoleMethod::Filled;
        let with_motion =
            |method, holes, level| Subject::foveated(gl, (method, holes), &job.render, level, true);
        let formats = [(Format::Rgba16F, Filter::Nearest)];
        let target = || RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth32F));
        Ok(Contenders {
            gl: gl.clone(),
            whole: with_motion(Method::Conventional, filled, FoveationLevel::Off)?,
            conventional: with_motion(Method::Conventional, filled, level)?,
            synthesized: with_motion(Method::Synthesized, filled, level)?,
            rendered_holes: with_motion(Method::Synthesized, HoleMethod::Rendered, level)?,
            mono: Subject::foveated(gl, (Method::Mono, filled), &job.render, level, false)?,
            frame: StereoFrame::new(gl, job.eyes.size)?,
            vectors: [target()?, target()?],
            depth: DepthReader::new(gl)?,
        })
    }

    /// Returns the targets of a frame with the vectors since a previous one.
    fn targets(&self, previous: &EyePair) -> [EyeTarget<'static>; 2] {
        let to = self.frame.targets();
        Eye::BOTH.map(|eye| EyeTarget {
            motion: Some(MotionTarget {
                to: Destination::whole(&self.vectors[eye.index()]),
                previous: previous.view(eye),
                ndc: Ndc::ZeroToOne,
            }),
            ..to[eye.index()]
        })
    }

    fn resize_vectors(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        self.vectors.iter_mut().try_for_each(|target| target.resize(size))
    }

    /// Reads an eye of the last frame.
    fn read(&mut self, eye: Eye, convention: DepthConvention) -> Result<ReadBack, GlError> {
        let target = &self.vectors[eye.index()];
        let image =
            DepthImage { texture: target.depth(), origin: [0, 0], layer: None, is_pair: false, convention };
        self.depth.copy(&image, target.size())?;
        let texels = target.read_rgba32f(0, [0, 0], target.size());
        Ok(ReadBack {
            rgba: self.frame.rgba(eye),
            vectors: texels.iter().map(|texel| Vec3::from_slice(texel)).collect(),
            moves: texels.iter().map(|texel| texel[3] > 0.5).collect(),
            depth: self.depth.read(),
            size: target.size(),
        })
    }

    /// Shows the frame between by every contender.
    fn show(&mut self, scene: &mut PreparedScene, step: &Step) -> anyhow::Result<Shown> {
        let Step { previous, now, between } = step;
        let (eye, size) = (now.pair.dominant.other(), now.pair.size);
        let pose = eye_pose(between.pair.poses[eye.index()]);
        let convention = now.pair.depth.convention;
        let image = |rgba: &[u8]| yoro_media::rgb_image(rgba, size);
        self.frame.resize(size)?;
        self.resize_vectors(size.map(|n| n.div_ceil(DIVISOR)))?;

        // Vectors are those since the previous render.
        scene.set_time(previous.seconds)?;
        scene.set_time(now.seconds)?;
        let to = self.targets(&previous.pair);
        let mut submit = |this: &mut Contenders, name: &str| {
            let subject = match name {
                TWO_EYES => &mut this.conventional,
                RENDERED_HOLES => &mut this.rendered_holes,
                _ => &mut this.synthesized,
            };
            let report = subject.render_to(scene, &now.pair, &to)?;
            ensure!(report.has_motion, "{name} has no motion vectors");
            Ok(this.read(eye, convention)?)
        };
        let [two, one, holes] =
            [submit(self, TWO_EYES)?, submit(self, ONE_EYE)?, submit(self, RENDERED_HOLES)?];
        let [two_eyes, one_eye, holes] = [&two, &one, &holes].map(|read| SubmittedEye {
            rgba: &read.rgba,
            size,
            vectors: &read.vectors,
            depth: &read.depth,
            vector_size: read.size,
            camera: camera(&now.pair.view(eye)),
            previous: camera(&previous.pair.view(eye)),
        });
        let made_vectors = SubmittedEye { rgba: &two.rgba, ..one_eye };
        let mut images: Vec<(&'static str, RgbImage)> =
            [(TWO_EYES, two_eyes), (ONE_EYE, one_eye), (RENDERED_HOLES, holes), (VECTORS, made_vectors)]
                .map(|(name, submitted)| (name, image(&submitted.extrapolate(pose, 0.5))))
                .into();
        images.push((ROTATION, image(&two_eyes.rotate(pose))));

        scene.set_time(between.seconds)?;
        for (name, subject) in [(FULL_RATE, &mut self.synthesized), (SAME_IMAGE, &mut self.mono)] {
            subject.render_to(scene, &between.pair, &self.frame.targets())?;
            images.push((name, image(&self.frame.rgba(eye))));
        }
        self.resize_vectors(size)?;
        let to = self.targets(&now.pair);
        self.whole.render_to(scene, &between.pair, &to)?;
        let truth = self.read(eye, convention)?;
        let moved = moving_pixels(&two, size);
        let moving: Vec<bool> =
            moved.iter().zip(moving_pixels(&truth, size)).map(|(before, after)| *before | after).collect();
        Ok(Shown { images, truth: image(&truth.rgba), moving: near(&moving, size) })
    }

    /// Returns the time of a shown frame up to glFinish: with every frame rendered, and with every second one, whose
    /// vectors are then counted but not what a runtime does with them.
    fn times(
        &mut self,
        scene: &mut PreparedScene,
        Step { previous, now, .. }: &Step,
    ) -> anyhow::Result<[(&'static str, Duration); 4]> {
        self.resize_vectors(now.pair.size.map(|n| n.div_ceil(DIVISOR)))?;
        // Both shadow maps of a moving scene are redrawn by whoever moves it, once for each render.
        scene.set_time(now.seconds)?;
        let gl = self.gl.clone();
        let (plain, vectors) = (self.frame.targets(), self.targets(&previous.pair));
        let mut all = [CONVENTIONAL, TWO_EYES, FULL_RATE, ONE_EYE].map(|name| (name, Duration::ZERO));
        for is_timed in [false, true] {
            for (name, time) in &mut all {
                let (subject, to, frames) = match *name {
                    CONVENTIONAL => (&mut self.whole, &plain, 1),
                    TWO_EYES => (&mut self.conventional, &vectors, 2),
                    FULL_RATE => (&mut self.synthesized, &plain, 1),
                    _ => (&mut self.synthesized, &vectors, 2),
                };
                gl.finish();
                let begin = Instant::now();
                subject.render_to(scene, &now.pair, to)?;
                gl.finish();
                if is_timed {
                    *time = begin.elapsed() / frames;
                }
            }
        }
        Ok(all)
    }
}

fn eye_pose(Pose { position, orientation }: Pose) -> EyePose {
    EyePose { position, orientation }
}

fn camera(view: &View) -> EyeCamera {
    let f = &view.frustum;
    let (at_0, slope) = view.depth.inverse_distance_law();
    EyeCamera {
        pose: eye_pose(view.pose),
        tangents: [f.left, f.right, f.bottom, f.top],
        inverse_distances: [at_0, at_0 + slope],
    }
}

/// Returns for each pixel of an image, from its lower left corner, whether its vector is that of something that moves.
fn moving_pixels(read: &ReadBack, size: [u32; 2]) -> Vec<bool> {
    let [width, height] = size.map(|n| n as usize);
    let texel = |i: usize| {
        let [x, y] = [(i % width, 0), (i / width, 1)]
            .map(|(at, axis)| at * read.size[axis] as usize / size[axis] as usize);
        read.moves[y * read.size[0] as usize + x]
    };
    (0..width * height).map(texel).collect()
}

/// Returns the pixels at most [`NEAR`] away from those of a mask, along both axes; from rows that run from the bottom, with
/// rows that run from the top.
fn near(mask: &[bool], size: [u32; 2]) -> Vec<bool> {
    let [width, height] = size.map(|n| n as usize);
    let grown = |mask: &[bool], count: usize, stride: usize, at: usize, i: usize| {
        (at.saturating_sub(NEAR)..=(at + NEAR).min(count - 1)).any(|n| mask[i + n * stride - at * stride])
    };
    let rows: Vec<bool> = (0..mask.len()).map(|i| grown(mask, width, 1, i % width, i)).collect();
    let all: Vec<bool> = (0..mask.len()).map(|i| grown(&rows, height, width, i / width, i)).collect();
    all.chunks(width).rev().flatten().copied().collect()
}
