//! The bits of a stream, and the quality of what it shows some frames later.

use image::RgbImage;

use super::super::Experiment;
use super::super::job::{Choices, Job, QUICK_SCENES};
use super::super::record::{Measurement, metric};
use super::super::runner::{Round, Runner};
use super::super::scenes::LazyObject;
use super::super::views::{HEADSET_RATE, Motion};
use crate::streaming::Receiver;
use yoro::eyes::{Eye, EyePair};
use yoro_files::interrupt;
use yoro_media::rgb_image;
use yoro_media::video::{Decoder, LiveEncoder, LiveEncoderKind};
use yoro_metrics::{Channels, SsimWindow, psnr, ssim};
use yoro_render::{PreparedScene, ViewReader};
use yoro_report::text::slug;
use yoro_stream::{EyeView, FrameRenderer, Mode, Picture, ViewRequest};

const SCENES: [&str; 3] = ["talk", "street", "atrium"];
/// The numbers of frames by which frames are shown late, at 72 per second: at once, after 28 and 69 ms.
const DELAYS: [usize; 3] = [0, 2, 5];
/// The number of frames, and in the short form.
const FRAMES: [usize; 2] = [8, 3];
/// H.264's quantizers.
const QUANTIZERS: [u8; 3] = [20, 26, 32];
/// The modes. The bits that the others save are relative to those of the first.
const MODES: [(Mode, &str); 3] = [
    (Mode::Eyes, "two eyes, rotation"),
    (Mode::Depth, "one eye and depth"),
    (Mode::EyesDepth, "two eyes, depth of one"),
];
const SAME_IMAGE: &str = "same image, not encoded";

/// The bits of a stream, and the quality of what it shows some frames later.
pub struct Stream;

impl Experiment for Stream {
    fn name(&self) -> &'static str {
        "stream"
    }

    fn about(&self) -> &'static str {
        "Bit rate and quality of a stream of one eye with depth, against both eyes, by quantizer and delay"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let scenes = if choices.quick { &QUICK_SCENES[..] } else { &SCENES };
        Ok(choices.sweep(self, choices.scenes(scenes.iter().copied()), DELAYS, |job, late| {
            job.conditions.label = Some(format!("{late} late"));
            job.frames = choices.long_or_quick(FRAMES[0], FRAMES[1]);
        }))
    }

    fn steps(&self, job: &Job) -> u64 {
        (job.frames * MODES.len() * QUANTIZERS.len()) as u64
    }

    /// Encodes a walking head's frames in all modes at each quantizer, and measures both eyes at the poses of the head
    /// some frames later.
    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        runner.announce(job, 0);
        let views = runner.moving(job, scene, Motion::Walk, job.frames + DELAYS[job.point])?;
        let then = &views.pairs[..job.frames];
        let shown = views.clone().last(job.frames);
        let now = &shown.pairs;
        let mut reader = ViewReader::new(runner.gl)?;
        let mut eye = |scene: &mut PreparedScene, pair: &EyePair, eye| -> anyhow::Result<RgbImage> {
            interrupt::check()?;
            let rgba = reader.color(&mut scene.renderer, &scene.scene, &pair.view(eye))?;
            Ok(rgb_image(&rgba, pair.size))
        };
        let mut round = Round::of_views(job, 0, &shown, scene);
        let mut truths = Vec::new();
        for (then, now) in then.iter().zip(now) {
            let truth = [eye(scene, now, Eye::Left)?, eye(scene, now, Eye::Right)?];
            let image = eye(scene, then, then.dominant)?;
            push_quality(round.of(SAME_IMAGE), &[image.clone(), image], &truth)?;
            truths.push(truth);
        }
        // The pictures that are saved show the left eye in the last frame.
        if let Some([left, _]) = truths.last() {
            runner.save_picture(job, "truth", left)?;
        }
        let mut receiver = Receiver::new(runner.gl)?;
        let pictures = MODES.map(|(mode, _)| pictures(runner.gl, mode, then, scene));
        for quantizer in QUANTIZERS {
            let mut baseline = None;
            for ((_, name), pictures) in MODES.iter().zip(&pictures) {
                let pictures = pictures.as_ref().map_err(|error| anyhow::anyhow!("{error}"))?;
                let name = format!("{name}, QP {quantizer}");
                let measurement = round.of(&name);
                let mut encoder = LiveEncoder::new(LiveEncoderKind::OpenH264, HEADSET_RATE as f32)?;
                let mut decoder = Decoder::new()?;
                let mut bytes = 0;
                for (i, picture) in pictures.iter().enumerate() {
                    interrupt::check()?;
                    let encoded = encoder.encode(&picture.planes, quantizer, picture.new_span)?;
                    // The first frame does not count, because a stream begins only once.
                    bytes += if i == 0 { 0 } else { encoded.data.len() };
                    anyhow::ensure!(i == 0 || !encoded.is_intra, "the distances change within the sequence");
                    let decoded = decoder.decode(&encoded.data)?;
                    let eyes = receiver.eyes(&decoded, &picture.content, picture.size, &now[i])?;
                    push_quality(measurement, &eyes, &truths[i])?;
                    if i + 1 == pictures.len() {
                        runner.save_picture(job, &slug(&name), &eyes[0])?;
                    }
                    runner.bar.inc(1);
                }
                let rate = bytes as f64 * 8e-3 * HEADSET_RATE / (pictures.len() - 1) as f64;
                measurement.push(metric::KBIT_S, rate);
                match baseline {
                    Some(baseline) => measurement.push(metric::SAVED, (1.0 - rate / baseline) * 100.0),
                    None => baseline = Some(rate),
                }
            }
        }
        runner.finish(round)
    }
}

fn pictures(
    gl: &std::rc::Rc<yoro_gl::Context>,
    mode: Mode,
    pairs: &[EyePair],
    prepared: &mut PreparedScene,
) -> anyhow::Result<Vec<Picture>> {
    let mut renderer = FrameRenderer::new(gl, mode)?;
    let request = |pair: &EyePair| ViewRequest {
        time_ms: 0.0,
        eyes: [0, 1].map(|i| EyeView { pose: pair.poses[i], frustum: pair.frusta[i] }),
        dominant: pair.dominant,
        size: pair.size.map(|n| n as u16),
    };
    pairs.iter().map(|pair| Ok(renderer.picture(prepared, &request(pair))?)).collect()
}

/// Records the mean quality of both eyes.
fn push_quality(to: &mut Measurement, eyes: &[RgbImage; 2], truth: &[RgbImage; 2]) -> anyhow::Result<()> {
    let (mut sums, pairs) = ([0.0; 2], eyes.iter().zip(truth));
    for (eye, truth) in pairs {
        // Equal images have no finite PSNR. They count as 60 dB.
        sums[0] += psnr(eye, truth, Channels::Rgb)?.0.min(60.0);
        sums[1] += ssim(eye, truth, SsimWindow::Gaussian11, Channels::Rgb)?;
    }
    to.push(metric::PSNR, sums[0] / 2.0);
    to.push(metric::SSIM, sums[1] / 2.0);
    Ok(())
}
