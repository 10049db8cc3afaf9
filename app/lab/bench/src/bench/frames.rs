//! Frames at viewpoints by several contenders: time, passes, memory, quality.

use image::RgbImage;

use super::contender::Contender;
use super::holes::{HoleFinder, OpenPixels};
use super::job::Job;
use super::process;
use super::record::{Measurement, Record, metric};
use super::runner::{Round, Runner, eye_image, left_out, milliseconds};
use super::subject::{PassCosts, Subject};
use super::views::Views;
use yoro_files::interrupt;
use yoro_metrics::Comparison;
use yoro_render::PreparedScene;
use yoro_render::stereo::{HoleMethod, StereoFrame};

/// What is measured of frames at viewpoints.
#[derive(Clone, Copy)]
pub(super) struct FrameMeasures {
    /// Frame times, pass times, CPU time and memory.
    pub cost: bool,
    /// The similarity to the ground truth.
    pub quality: bool,
    /// True if the first view's pictures are saved for the report.
    pub pictures: bool,
}

/// Measures the frames of a job round by round. Contenders take turns.
pub(super) fn measure(
    runner: &mut Runner,
    job: &Job,
    scene: &mut PreparedScene,
    FrameMeasures { cost, quality, pictures }: FrameMeasures,
) -> anyhow::Result<()> {
    let views = runner.viewpoints(job, scene)?;
    let mut field = Field::new(runner, job, scene, &views, cost)?;
    for number in runner.rounds(job) {
        runner.announce(job, number);
        let mut round = field.start_round(job, number);
        let is_compared = quality && number == 0;
        let images =
            field.render(runner, scene, &views, &mut round, RoundParts { number, cost, is_compared })?;
        if is_compared {
            field.compare(runner, scene, &views, &images, &mut round)?;
            for (entry, images) in field.entries.iter().zip(&images).filter(|_| pictures) {
                runner.save_picture(job, &picture_name(entry.contender), &images[0])?;
            }
        }
        if cost && runner.inputs.choices.times_passes {
            field.time_passes(runner, scene, &views, &mut round)?;
        }
        runner.finish(round)?;
    }
    Ok(())
}

/// Returns the name of a contender's picture.
pub(super) fn picture_name(contender: Contender) -> String {
    match contender {
        Contender::CONVENTIONAL => "truth".to_owned(),
        Contender::MONO => "dominant".to_owned(),
        other => other.name(),
    }
}

/// What a round renders for.
#[derive(Clone, Copy)]
struct RoundParts {
    number: u32,
    cost: bool,
    is_compared: bool,
}

/// A contender that can take part.
pub(super) struct Entry {
    pub contender: Contender,
    pub name: String,
    pub subject: Subject,
    /// MiB of its own textures, and with those the process's memory.
    memory: Option<[f64; 2]>,
}

/// The contenders that render the frames of a setting, and records of the facts and of those that cannot.
pub(super) struct Field {
    pub entries: Vec<Entry>,
    pub frame: StereoFrame,
    records: Vec<Record>,
}

impl Field {
    /// Creates every contender. To measure costs, each renders a first frame, which warms it up and shows its memory.
    pub fn new(
        runner: &Runner,
        job: &Job,
        scene: &mut PreparedScene,
        views: &Views,
        cost: bool,
    ) -> anyhow::Result<Field> {
        let frame = StereoFrame::new(runner.gl, job.eyes.size)?;
        let records = vec![Record::Scene(views.facts(job, scene))];
        let mut field = Field { entries: Vec::new(), frame, records };
        let base = process::resident_mib();
        for &contender in &job.contenders {
            let Some((method, pipeline)) = contender.method() else { continue };
            interrupt::check()?;
            let mut options = (runner.inputs.choices.options)(pipeline);
            if contender == Contender::RenderedHoles {
                options.holes = HoleMethod::Rendered;
            }
            let before = runner.gl.texture_bytes();
            let made = Subject::new(runner.gl, method, &job.render, &options).map_err(anyhow::Error::from);
            let made = made.and_then(|mut subject| {
                if cost {
                    subject.render(scene, &views.pairs[0], &mut field.frame)?;
                }
                Ok(subject)
            });
            runner.bar.inc(1);
            match made {
                Ok(subject) => {
                    let memory = cost.then(|| {
                        let own = (runner.gl.texture_bytes() - before) as f64 / f64::from(1 << 20);
                        [own, base.map_or(f64::NAN, |base| base + own)]
                    });
                    field.entries.push(Entry { contender, name: contender.name(), subject, memory });
                }
                // Without the ground truth the others cannot be compared.
                Err(error) if contender == Contender::CONVENTIONAL => return Err(error),
                Err(error) => {
                    field.records.push(left_out(job, contender, &error));
                    runner.bar.inc(u64::from(job.rounds) * job.frames as u64);
                }
            }
        }
        Ok(field)
    }

    /// Starts a round with a row for each contender. With the first round come facts, missing contenders, memory.
    pub fn start_round(&mut self, job: &Job, number: u32) -> Round {
        let mut round = Round::new(job, number);
        for entry in &self.entries {
            let measurement = round.of(&entry.name);
            let names = [metric::TEXTURE_MIB, metric::MEMORY_MIB];
            let memory = names.into_iter().zip(entry.memory.into_iter().flatten());
            memory.filter(|_| number == 0).for_each(|(metric, mib)| measurement.push(metric, mib));
        }
        if number == 0 {
            round.records.append(&mut self.records);
        }
        round
    }

    /// Renders every contender at every view, rotating the order so that each is first, second, ... equally often.
    /// Returns the other eye's images, by contender and view, if they are to be compared.
    fn render(
        &mut self,
        runner: &Runner,
        scene: &mut PreparedScene,
        views: &Views,
        round: &mut Round,
        parts: RoundParts,
    ) -> anyhow::Result<Vec<Vec<RgbImage>>> {
        let count = self.entries.len();
        let mut images = vec![Vec::new(); count];
        for (i, pair) in views.pairs.iter().enumerate() {
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i + parts.number as usize) % count;
                let entry = &mut self.entries[at];
                let time = entry.subject.render_settled(scene, pair, &mut self.frame)?;
                if parts.cost {
                    let measurement = round.of(&entry.name);
                    measurement.push(metric::FRAME_MS, milliseconds(time.wall));
                    measurement.push(metric::CPU_MS, milliseconds(time.cpu));
                }
                if parts.is_compared {
                    images[at].push(eye_image(&self.frame, pair.dominant.other()));
                }
                runner.bar.inc(1);
            }
        }
        Ok(images)
    }

    /// Compares the images with those of the conventional method, which comes first.
    fn compare(
        &self,
        runner: &Runner,
        scene: &mut PreparedScene,
        views: &Views,
        images: &[Vec<RgbImage>],
        round: &mut Round,
    ) -> anyhow::Result<()> {
        let mut finder = HoleFinder::new(runner.gl)?;
        let opens = |entry: &&Entry| entry.contender == Contender::RenderedHoles;
        let mut open = match self.entries.iter().find(opens) {
            Some(entry) => Some((OpenPixels::new(runner.gl)?, entry)),
            None => None,
        };
        for (i, pair) in views.pairs.iter().enumerate() {
            let holes = finder.find(scene, pair)?;
            for (entry, images_of) in self.entries.iter().zip(images).skip(1) {
                interrupt::check()?;
                let comparison = Comparison::of(&images_of[i], &images[0][i], Some(&holes))?;
                round.of(&entry.name).push_comparison(&comparison);
            }
            if let Some((pixels, entry)) = &mut open {
                round.of(&entry.name).push(metric::OPEN_SHARE, pixels.share(scene, pair)?);
            }
        }
        Ok(())
    }

    fn time_passes(
        &mut self,
        runner: &Runner,
        scene: &mut PreparedScene,
        views: &Views,
        round: &mut Round,
    ) -> anyhow::Result<()> {
        for entry in &mut self.entries {
            interrupt::check()?;
            let PassCosts { times: passes, draw_calls } =
                entry.subject.pass_costs(scene, &views.pairs[0], &mut self.frame)?;
            let measurement: &mut Measurement = round.of(&entry.name);
            measurement.push(metric::DRAW_CALLS, f64::from(draw_calls));
            if runner.gl.capabilities().timer_queries && !passes.is_empty() {
                measurement.push(metric::GPU_MS, passes.iter().map(|(_, ms)| ms).sum());
            }
            for (name, ms) in passes {
                measurement.push(format!("{}{name}", metric::PASS_MS), ms);
            }
        }
        Ok(())
    }
}
