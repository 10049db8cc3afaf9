//! The bits of a stream, and the quality of what it shows some frames later.

use image::RgbImage;

use super::super::Experiment;
use super::super::job::{Choices, Job, QUICK_SCENES};
use super::super::record::{Measurement, metric};
use super::super::results::{SettingData, SuiteData};
use super::super::runner::{Round, Runner};
use super::super::scenes::LazyObject;
use super::super::tables::{cell, push_refusals, quality_of, table_of};
use super::super::views::{HEADSET_RATE, Motion};
use crate::streaming::Receiver;
use yoro::eyes::{Eye, EyePair};
use yoro_files::interrupt;
use yoro_media::rgb_image;
use yoro_media::video::{Decoder, LiveEncoder};
use yoro_metrics::{Channels, SsimWindow, psnr, ssim};
use yoro_render::{PreparedScene, ViewReader};
use yoro_report::paper::PAPER;
use yoro_report::stats::mean;
use yoro_report::text::fixed;
use yoro_report::text::slug;
use yoro_report::{Cell, Section, Table};
use yoro_stream::{EyeView, FrameRenderer, Mode, Picture, ViewRequest};

const SCENES: [&str; 3] = ["talk", "street", "atrium"];
/// The numbers of frames by which frames are shown late, at 72 per second: at once, after 28 and 69 ms.
const DELAYS: [usize; 3] = [0, 2, 5];
/// The number of frames, and in the short form.
const FRAMES: [usize; 2] = [8, 3];
/// H.264's quantizers.
const QUANTIZERS: [u8; 3] = [20, 26, 32];
/// The modes. The bits that the others save are relative to those of the first.
const MODES: [(Mode, &str); 2] = [(Mode::Eyes, "two eyes, rotation"), (Mode::Depth, "one eye and depth")];
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

    fn moves(&self, _job: &Job) -> bool {
        true
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
                let mut encoder = LiveEncoder::new(HEADSET_RATE as f32)?;
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

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Streaming",
            "Frames of a walking head (1.35 m/s, 72 frames a second) as `yoro serve` sends them, encoded by openh264 at one \
             quantizer: one eye and its depth, from which both eyes are made at the pose where they are shown; and both \
             eyes, turned to that pose. Quality is the mean of both eyes against real renders \
             at that pose, at once and 2 and 5 frames (28 and 69 ms) later. The first frame's bits, an intra frame's, do not \
             count. No times are measured.",
        );
        section.table(bits(suite));
        section.table(quality(suite));
        vec![section]
    }
}

/// Returns a table of bits, and of the savings compared with both eyes. They do not depend on the delay.
fn bits(suite: &SuiteData) -> Table {
    let scenes = suite.scenes();
    let title = "Bit rate in kbit/s, and bits saved against both eyes at the same quantizer";
    let mut table = table_of(title, &["<sent, each with its quantizer"], &scenes);
    let mut saved = Vec::new();
    for name in suite.measured(metric::KBIT_S) {
        let mut cells = vec![Cell::plain(name)];
        for scene in &scenes {
            let setting = suite.settings.iter().find(|setting| setting.conditions.scene == *scene);
            let measured = setting.and_then(|setting| setting.find(name));
            let value = |metric: &str| measured.and_then(|measured| measured.mean(metric));
            let share = value(metric::SAVED);
            saved.extend(share.filter(|_| name.starts_with("one eye")));
            let text = fixed(value(metric::KBIT_S), 0).map(|rate| match fixed(share, 1) {
                Some(share) => format!("{rate}, {share} %"),
                None => rate,
            });
            cells.push(cell(name, text));
        }
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    let percent = |share: f64| format!("{:+.1} %", 100.0 * share);
    let papers = mean(PAPER.scenes.iter().map(|scene| scene.kbit[0] / scene.kbit[1] - 1.0));
    table.note = format!(
        "Mean difference of one eye and depth here {}; the paper's {}. The paper names neither quantizer nor resolution.",
        mean(saved).map_or_else(|| "–".into(), |saved| percent(-saved / 100.0)),
        papers.map_or_else(|| "–".into(), percent),
    );
    table
}

/// Returns a table of the quality of both eyes by delay.
fn quality(suite: &SuiteData) -> Table {
    let labels: Vec<String> = suite.settings.iter().map(SettingData::label).collect();
    let labels: Vec<&str> = labels.iter().map(String::as_str).collect();
    let title = "Quality of both eyes by scene and frames of delay: PSNR in dB / SSIM";
    let mut table = table_of(title, &["<shown by"], &labels);
    for name in suite.contenders() {
        let of = |setting: &SettingData| cell(name, setting.find(name).and_then(quality_of));
        table.push([Cell::plain(name)].into_iter().chain(suite.settings.iter().map(of)).collect());
    }
    table.note = "The same image is not encoded.".into();
    table
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
