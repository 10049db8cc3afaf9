//! Half the rate of renders: the frame between two, as a runtime makes it of both eyes or of one, and as yoro makes it.

use std::rc::Rc;
use std::time::{Duration, Instant};

use anyhow::ensure;
use glam::Vec3;
use image::RgbImage;

use super::foveation::Way;
use super::reprojection::{SPREAD, measurement_of};
use super::{Runner, milliseconds};
use crate::bench::job::Job;
use crate::bench::motion::Motion;
use crate::bench::picture_folder;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::{HEADSET_RATE, Views};
use yoro::eyes::{DepthConvention, Eye, EyePair, FoveationLevel, Ndc, Pose, View};
use yoro_files::interrupt;
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget};
use yoro_metrics::{
    Channels, EyeCamera, EyePose, SsimWindow, SubmittedEye, psnr, psnr_where, ssim,
};
use yoro_render::stereo::{EyeTarget, FramesBetween, Method, MotionTarget, StereoFrame};
use yoro_render::{DepthImage, DepthReader, PreparedScene};

/// The ways of making the frame between. The runtime is emulated.
const TWO_EYES: &str = "runtime-two-eyes";
const ONE_EYE: &str = "runtime-one-eye";
/// The colour of two eyes with the vectors and depth of one: what these alone lose.
const VECTORS: &str = "runtime-made-vectors";
const ROTATION: &str = "rotation";
const DEPTH: &str = "depth-alone";
const ANY_VIEW: &str = "any-view";
/// The same frame rendered: by yoro, and the dominant eye's image for both.
const FULL_RATE: &str = "yoro-full-rate";
const SAME_IMAGE: &str = "same-image";
/// Two renders of all pixels of every frame, against which times are to be compared.
const CONVENTIONAL: &str = "conventional";

/// Pixels of an eye along each axis for one of its vectors.
const DIVISOR: u32 = 4;
/// Pixels around moving things that count as near them.
const NEAR: usize = 3;
/// Seconds of a scene's motion before the first frame.
const BEGIN: f64 = 2.0;

impl Runner<'_> {
    /// Measures the frame between two renders of a moving scene, each against two real renders at that time and pose.
    pub(super) fn half_rate(
        &mut self,
        job: &Job,
        (motion, level): (Motion, FoveationLevel),
        prepared: &mut PreparedScene,
    ) -> anyhow::Result<()> {
        self.bar.set_message(job.conditions.to_string());
        let all = Job { frames: job.frames * SPREAD + 3, ..job.clone() };
        let views = Views::of_motion(&all, prepared, motion)?;
        let mut ways = Ways::new(self.gl, job, level)?;
        let mut measurements: Vec<Measurement> = Vec::new();
        for i in 0..job.frames {
            interrupt::check()?;
            let moments = [0, 2, 3]
                .map(|n| (views.pairs[i * SPREAD + n], BEGIN + (i * SPREAD + n) as f64 / HEADSET_RATE));
            let between = ways.show(prepared, moments)?;
            if i == 0 {
                let folder = picture_folder(&self.before.path, &job.conditions);
                let shown = between.shown.iter().map(|(way, image)| (*way, image));
                for (name, image) in shown.chain([("truth", &between.truth)]) {
                    yoro_media::save_color(&folder.join(format!("{name}.png")), image)?;
                }
            }
            for (way, image) in &between.shown {
                let measurement = measurement_of(&mut measurements, job, way);
                measurement.push(metric::PSNR, psnr(image, &between.truth, Channels::Rgb)?.0);
                let similar = ssim(image, &between.truth, SsimWindow::Gaussian11, Channels::Rgb)?;
                measurement.push(metric::SSIM, similar);
                if let Some(near) = psnr_where(image, &between.truth, &between.moving)? {
                    measurement.push(metric::MOVING_PSNR, near.0);
                }
            }
            for (name, time) in ways.times(prepared, moments)? {
                measurement_of(&mut measurements, job, name).push(metric::FRAME_MS, milliseconds(time));
            }
            self.bar.inc(1);
        }
        self.finish_round(job, 0, vec![Record::Scene(views.facts(job, prepared))], measurements)
    }
}

/// The eyes of a frame, and the time in the scene in seconds.
type At = (EyePair, f64);

/// The frame between two renders: the eye that is not dominant.
struct Between {
    shown: Vec<(&'static str, RgbImage)>,
    truth: RgbImage,
    /// Row by row from the top: true near things that move.
    moving: Vec<bool>,
}

/// The methods that take part, and what they draw into.
struct Ways {
    gl: Rc<Context>,
    /// Two renders of all pixels: the truth.
    whole: Way,
    conventional: Way,
    synthesized: Way,
    half_rate: Way,
    mono: Way,
    frame: StereoFrame,
    /// Vectors and depth of both eyes.
    vectors: [RenderTarget; 2],
    depth: DepthReader,
}

/// An eye's submission, read back.
struct ReadBack {
    rgba: Vec<u8>,
    vectors: Vec<[f32; 4]>,
    depth: Vec<f32>,
    size: [u32; 2],
}

impl Ways {
    fn new(gl: &Rc<Context>, job: &Job, level: FoveationLevel) -> Result<Ways, GlError> {
        let create =
            |method: Method, level, between| Way::new(gl, job, (method, method.name()), level, between);
        let formats = [(Format::Rgba16F, Filter::Nearest)];
        let target = || RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth32F));
        Ok(Ways {
            gl: gl.clone(),
            whole: create(Method::Conventional, FoveationLevel::Off, FramesBetween::Runtime)?,
            conventional: create(Method::Conventional, level, FramesBetween::Runtime)?,
            synthesized: create(Method::Synthesized, level, FramesBetween::Runtime)?,
            half_rate: create(Method::Synthesized, level, FramesBetween::Method)?,
            mono: create(Method::Mono, level, FramesBetween::Nobody)?,
            frame: StereoFrame::new(gl, job.eyes.size)?,
            vectors: [target()?, target()?],
            depth: DepthReader::new(gl)?,
        })
    }

    /// Returns the targets of a frame with the vectors since a former one.
    fn targets(&self, former: &EyePair) -> [EyeTarget<'static>; 2] {
        let to = self.frame.targets();
        Eye::BOTH.map(|eye| EyeTarget {
            motion: Some(MotionTarget {
                to: Destination::whole(&self.vectors[eye.index()]),
                former: former.view(eye),
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
        Ok(ReadBack {
            rgba: self.frame.rgba(eye),
            vectors: target.read_rgba32f(0, [0, 0], target.size()),
            depth: self.depth.read(),
            size: target.size(),
        })
    }

    /// Shows the frame between by every way, from renders at two moments.
    fn show(
        &mut self,
        prepared: &mut PreparedScene,
        [(then, then_seconds), (now, now_seconds), (newest, newest_seconds)]: [At; 3],
    ) -> anyhow::Result<Between> {
        let eye = now.dominant.other();
        let image = |rgba: &[u8]| yoro_media::rgb_image(rgba, now.size);
        let vector_size = now.size.map(|n| n.div_ceil(DIVISOR));
        self.frame.resize(now.size)?;
        self.resize_vectors(vector_size)?;
        prepared.set_time(then_seconds)?;
        self.half_rate.render(prepared, &then, &self.frame.targets())?;

        prepared.set_time(now_seconds)?;
        let to = self.targets(&then);
        let mut shown = Vec::new();
        let (mut moving, mut true_color) = (Vec::new(), Vec::new());
        for way in [TWO_EYES, ONE_EYE] {
            let method = if way == TWO_EYES { &mut self.conventional } else { &mut self.synthesized };
            method.render(prepared, &now, &to)?;
            ensure!(method.has_motion(), "{way} has no motion vectors");
            let read = self.read(eye, now.depth.convention)?;
            let vectors: Vec<Vec3> = read.vectors.iter().map(|v| Vec3::from_slice(v)).collect();
            let submitted = SubmittedEye {
                rgba: &read.rgba,
                size: now.size,
                vectors: &vectors,
                depth: &read.depth,
                vector_size: read.size,
                camera: camera(&now.view(eye)),
                previous: camera(&then.view(eye)),
            };
            let pose = eye_pose(newest.poses[eye.index()]);
            shown.push((way, image(&submitted.extrapolate(pose, 0.5))));
            if way == ONE_EYE {
                let submitted = SubmittedEye { rgba: &true_color, ..submitted };
                shown.push((VECTORS, image(&submitted.extrapolate(pose, 0.5))));
            } else {
                shown.push((ROTATION, image(&submitted.rotate(pose))));
                moving = moves(&read.vectors, read.size, now.size);
                true_color = read.rgba;
            }
        }
        self.half_rate.render(prepared, &now, &self.frame.targets())?;
        for (way, ahead) in [(DEPTH, 0.0), (ANY_VIEW, 0.5)] {
            let can = self.half_rate.show_again(&newest, &self.frame.targets(), ahead)?;
            ensure!(can, "the head has turned too far");
            shown.push((way, image(&self.frame.rgba(eye))));
        }

        prepared.set_time(newest_seconds)?;
        for (way, method) in [(FULL_RATE, &mut self.synthesized), (SAME_IMAGE, &mut self.mono)] {
            method.render(prepared, &newest, &self.frame.targets())?;
            shown.push((way, image(&self.frame.rgba(eye))));
        }
        self.resize_vectors(now.size)?;
        let to = self.targets(&now);
        self.whole.render(prepared, &newest, &to)?;
        let truth = self.read(eye, now.depth.convention)?;
        for (here, there) in moving.iter_mut().zip(moves(&truth.vectors, truth.size, now.size)) {
            *here |= there;
        }
        Ok(Between { shown, truth: image(&truth.rgba), moving: near(&moving, now.size) })
    }

    /// Returns the time of a shown frame up to glFinish: with every frame rendered, and with every second one, whose vectors
    /// are then counted but not what a runtime does with them.
    fn times(
        &mut self,
        prepared: &mut PreparedScene,
        [(then, _), (now, now_seconds), (newest, _)]: [At; 3],
    ) -> anyhow::Result<[(&'static str, Duration); 5]> {
        self.resize_vectors(now.size.map(|n| n.div_ceil(DIVISOR)))?;
        // Both shadow maps of a moving scene are redrawn by whoever moves it, once for each render.
        prepared.set_time(now_seconds)?;
        let gl = self.gl.clone();
        let (plain, vectors) = (self.frame.targets(), self.targets(&then));
        let mut all =
            [CONVENTIONAL, TWO_EYES, FULL_RATE, ONE_EYE, ANY_VIEW].map(|name| (name, Duration::ZERO));
        for is_timed in [false, true] {
            for (name, time) in &mut all {
                let (method, to, frames) = match *name {
                    CONVENTIONAL => (&mut self.whole, &plain, 1),
                    TWO_EYES => (&mut self.conventional, &vectors, 2),
                    FULL_RATE => (&mut self.synthesized, &plain, 1),
                    ONE_EYE => (&mut self.synthesized, &vectors, 2),
                    _ => (&mut self.half_rate, &plain, 2),
                };
                gl.finish();
                let begin = Instant::now();
                method.render(prepared, &now, to)?;
                if *name == ANY_VIEW {
                    method.show_again(&newest, to, 0.5)?;
                }
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
fn moves(vectors: &[[f32; 4]], from: [u32; 2], size: [u32; 2]) -> Vec<bool> {
    let [width, height] = size.map(|n| n as usize);
    let texel = |i: usize| {
        let [x, y] =
            [(i % width, 0), (i / width, 1)].map(|(at, axis)| at * from[axis] as usize / size[axis] as usize);
        vectors[y * from[0] as usize + x][3] > 0.5
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
