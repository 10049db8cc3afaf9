//! What guard bands cost, and what they save at the border.

use image::RgbImage;

use super::super::Experiment;
use super::super::contender::{Band, Contender};
use super::super::frames::Field;
use super::super::job::{Choices, Job};
use super::super::record::metric;
use super::super::runner::{Runner, eye_image, milliseconds};
use super::super::scenes::LazyObject;
use super::super::views;
use yoro::eyes::{Eye, EyePair};
use yoro_files::interrupt;
use yoro_metrics::{Channels, psnr};
use yoro_render::PreparedScene;

/// The number of frames, and in the short form.
const FRAMES: [usize; 2] = [36, 6];

/// What guard bands cost, and what they save at the border.
pub struct GuardBands;

impl Experiment for GuardBands {
    fn name(&self) -> &'static str {
        "guard-band"
    }

    fn about(&self) -> &'static str {
        "Frame time and quality at the border by guard band, along a camera path"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let own = [vec![Contender::MONO], Contender::bands()].concat();
        let contenders = choices.contenders(self.name(), own, &Contender::BASELINES)?;
        Ok(choices.sweep(self, choices.all_scenes(), [()], |job, ()| {
            job.contenders.clone_from(&contenders);
            job.frames = choices.long_or_quick(FRAMES[0], FRAMES[1]);
        }))
    }

    /// Renders every contender's frames in order, each once, as a viewer does.
    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        let views = runner.path(job, scene, views::HEADSET_STEP)?;
        let mut field = Field::new(runner, job, scene, &views, true)?;
        let mut round = field.start_round(job, 0);
        runner.announce(job, 0);
        let count = field.entries.len();
        for (i, pair) in views.pairs.iter().enumerate() {
            scene.set_time(i as f64 / views::HEADSET_RATE)?;
            let mut images = vec![RgbImage::default(); count];
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i) % count;
                let entry = &mut field.entries[at];
                let time = entry.subject.render(scene, pair, &mut field.frame)?;
                round.of(&entry.name).push(metric::FRAME_MS, milliseconds(time.wall));
                images[at] = eye_image(&field.frame, pair.dominant.other());
                runner.bar.inc(1);
            }
            let truth = border(&images[0], pair)?;
            for (entry, image) in field.entries.iter().zip(&images).skip(1) {
                let measurement = round.of(&entry.name);
                measurement.push(metric::PSNR, psnr(image, &images[0], Channels::Rgb)?.0);
                measurement.push(metric::BORDER_PSNR, psnr(&border(image, pair)?, &truth, Channels::Rgb)?.0);
            }
        }
        scene.set_time(0.0)?;
        runner.finish(round)
    }
}

/// Returns the columns at the outer border of the eye that is not dominant in which surfaces at half a metre need a
/// guard band, the widest one that is measured.
fn border(image: &RgbImage, pair: &EyePair) -> anyhow::Result<RgbImage> {
    let width = pair.synthesis_views(Band::HalfMetre.guard_band())?.guard_columns.min(image.width());
    let left = match pair.dominant.other() {
        Eye::Left => 0,
        Eye::Right => image.width() - width,
    };
    Ok(image::imageops::crop_imm(image, left, 0, width, image.height()).to_image())
}
