//! The bits of a stream, and the quality of what it shows some frames later.

use super::Runner;
use crate::bench::job::{Job, STREAM_QUANTIZERS};
use crate::bench::motion::Motion;
use crate::bench::pictures::picture_folder;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::{HEADSET_RATE, Views};
use crate::streaming::Receiver;
use image::RgbImage;
use yoro::eyes::{Eye, EyePair};
use yoro_files::interrupt;
use yoro_media::rgb_image;
use yoro_media::video::{Decoder, LiveEncoder, LiveEncoderKind};
use yoro_metrics::{Channels, SsimWindow, psnr, ssim};
use yoro_render::{PreparedScene, ViewReader};
use yoro_report::text::slug;
use yoro_stream::{EyeView, FrameRenderer, Mode, Picture, ViewRequest};

/// The modes. The bits that the others save are relative to those of the first.
const MODES: [(Mode, &str); 3] = [
    (Mode::Eyes, "two eyes, rotation"),
    (Mode::Depth, "one eye and depth"),
    (Mode::EyesDepth, "two eyes, depth of one"),
];

impl Runner<'_> {
    /// Encodes a walking head's frames in all modes at each quantizer, and measures both eyes at the poses of the head
    /// some frames later.
    pub(super) fn stream(
        &mut self,
        job: &Job,
        late: usize,
        prepared: &mut PreparedScene,
    ) -> anyhow::Result<()> {
        self.bar.set_message(job.conditions.to_string());
        let all = Job { frames: job.frames + late, ..job.clone() };
        let views = Views::of_motion(&all, prepared, Motion::Walk)?;
        let then = &views.pairs[..job.frames];
        let shown = views.clone().last(job.frames);
        let now = &shown.pairs;
        let mut reader = ViewReader::new(self.gl)?;
        let mut eye = |prepared: &mut PreparedScene, pair: &EyePair, eye| -> anyhow::Result<RgbImage> {
            interrupt::check()?;
            let rgba = reader.color(&mut prepared.renderer, &prepared.scene, &pair.view(eye))?;
            Ok(rgb_image(&rgba, pair.size))
        };
        let mut same = Measurement::new(&job.conditions, "same image, not encoded", 0);
        let mut truths = Vec::new();
        for (then, now) in then.iter().zip(now) {
            let truth = [eye(prepared, now, Eye::Left)?, eye(prepared, now, Eye::Right)?];
            let image = eye(prepared, then, then.dominant)?;
            measure(&mut same, &[image.clone(), image], &truth)?;
            truths.push(truth);
        }
        // The pictures that are saved show the left eye in the last frame.
        let folder = picture_folder(&self.before.path, &job.conditions);
        let place = |name: &str| folder.join(format!("{}.png", slug(name)));
        if let Some([left, _]) = truths.last() {
            yoro_media::save_color(&place("truth"), left)?;
        }
        let mut measurements = vec![same];
        let mut receiver = Receiver::new(self.gl)?;
        let pictures = MODES.map(|(mode, _)| pictures(self.gl, mode, then, prepared));
        for quantizer in STREAM_QUANTIZERS {
            let mut baseline = None;
            for ((_, name), pictures) in MODES.iter().zip(&pictures) {
                let pictures = pictures.as_ref().map_err(|error| anyhow::anyhow!("{error}"))?;
                let mut measurement = Measurement::new(&job.conditions, format!("{name}, QP {quantizer}"), 0);
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
                    measure(&mut measurement, &eyes, &truths[i])?;
                    if i + 1 == pictures.len() {
                        yoro_media::save_color(&place(&measurement.contender), &eyes[0])?;
                    }
                    self.bar.inc(1);
                }
                let rate = bytes as f64 * 8e-3 * HEADSET_RATE / (pictures.len() - 1) as f64;
                measurement.push(metric::KBIT_S, rate);
                match baseline {
                    Some(baseline) => measurement.push(metric::SAVED, (1.0 - rate / baseline) * 100.0),
                    None => baseline = Some(rate),
                }
                measurements.push(measurement);
            }
        }
        self.finish_round(job, 0, vec![Record::Scene(shown.facts(job, prepared))], measurements)
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
fn measure(to: &mut Measurement, eyes: &[RgbImage; 2], truth: &[RgbImage; 2]) -> anyhow::Result<()> {
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
