//! Measuring frames at viewpoints: time, passes, memory, quality.

use anyhow::Context as _;
use image::RgbImage;

use super::{Runner, eye_image, left_out, milliseconds};
use crate::bench::contender::Contender;
use crate::bench::holes::HoleFinder;
use crate::bench::job::{Job, Measure, Source};
use crate::bench::prepared::{FrameTime, PreparedContender};
use crate::bench::process;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::Views;
use yoro_files::interrupt;
use yoro_metrics::Comparison;
use yoro_render::PreparedScene;
use yoro_render::stereo::{ImBufferSize, StereoFrame};

/// The contenders that render the frames of a setting, and records of those that cannot.
pub(super) struct Field {
    pub contenders: Vec<(Contender, PreparedContender)>,
    pub frame: StereoFrame,
    /// Records for the first round: facts, missing contenders, memory.
    pub first: Vec<Record>,
    memory: Vec<Measurement>,
}

impl Field {
    pub fn measurements(&self, job: &Job, round: u32) -> Vec<Measurement> {
        self.contenders
            .iter()
            .map(|(contender, _)| Measurement::new(&job.conditions, contender.name(), round))
            .collect()
    }
}

impl Runner<'_> {
    pub(super) fn frames(
        &mut self,
        job: &Job,
        prepared: &mut PreparedScene,
        done: u32,
    ) -> anyhow::Result<()> {
        let Measure::Frames { cost, quality } = job.measure else { return Ok(()) };
        let views = Views::spread(job, prepared)?;
        let mut field = self.field(job, prepared, &views, cost)?;
        if cost && self.is_too_slow(job, prepared, &views, &mut field)? {
            return Ok(());
        }
        for round in done..job.rounds {
            self.bar.set_message(format!("{}: round {} of {}", job.conditions, round + 1, job.rounds));
            let mut measurements = field.measurements(job, round);
            let keep = quality && round == 0;
            let images = self.render_round(
                prepared,
                &views,
                &mut field,
                round,
                cost.then_some(&mut measurements),
                keep,
            )?;
            if keep {
                self.compare(prepared, &views, &field, &images, &mut measurements)?;
                for ((contender, _), images) in field.contenders.iter().zip(&images) {
                    self.save_picture(job, *contender, &images[0])?;
                }
            }
            if cost {
                self.time_passes(prepared, &views, &mut field, &mut measurements)?;
            }
            let mut records = Vec::new();
            if round == 0 {
                records.append(&mut field.first);
                for (measurement, memory) in measurements.iter_mut().zip(&field.memory) {
                    measurement.values.extend(memory.values.clone());
                }
            }
            self.finish_round(job, round, records, measurements)?;
        }
        Ok(())
    }

    /// Renders every contender at every view, rotating the order so that each is first, second, ... equally often.
    /// Returns the other eye's images, by contender and view, if they are to be kept.
    pub(super) fn render_round(
        &self,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &mut Field,
        round: u32,
        mut times: Option<&mut Vec<Measurement>>,
        keep: bool,
    ) -> anyhow::Result<Vec<Vec<RgbImage>>> {
        let count = field.contenders.len();
        let mut images = vec![Vec::new(); count];
        for (i, pair) in views.pairs.iter().enumerate() {
            for turn in 0..count {
                interrupt::check()?;
                let at = (turn + i + round as usize) % count;
                let time = field.contenders[at].1.render_settled(prepared, pair, &mut field.frame)?;
                if let Some(measurements) = &mut times {
                    measurements[at].push(metric::FRAME_MS, milliseconds(time.wall));
                    measurements[at].push(metric::CPU_MS, milliseconds(time.cpu));
                }
                if keep {
                    images[at].push(eye_image(&field.frame, pair.dominant.other()));
                }
                self.bar.inc(1);
            }
        }
        Ok(images)
    }

    /// Compares the images with those of the conventional method, which comes first.
    pub(super) fn compare(
        &self,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &Field,
        images: &[Vec<RgbImage>],
        measurements: &mut [Measurement],
    ) -> anyhow::Result<()> {
        let mut finder = HoleFinder::new(self.gl)?;
        for (i, pair) in views.pairs.iter().enumerate() {
            let holes = finder.find(prepared, pair)?;
            for at in 1..field.contenders.len() {
                interrupt::check()?;
                let comparison = Comparison::of(&images[at][i], &images[0][i], Some(&holes))?;
                measurements[at].push_comparison(&comparison);
            }
        }
        Ok(())
    }

    pub(super) fn time_passes(
        &self,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &mut Field,
        measurements: &mut [Measurement],
    ) -> anyhow::Result<()> {
        for ((_, ready), measurement) in field.contenders.iter_mut().zip(measurements) {
            interrupt::check()?;
            let passes = ready.pass_times(prepared, &views.pairs[0], &mut field.frame)?;
            if self.gl.capabilities().timer_queries && !passes.is_empty() {
                measurement.push(metric::GPU_MS, passes.iter().map(|(_, ms)| ms).sum());
            }
            for (name, ms) in passes {
                measurement.push(format!("{}{name}", metric::PASS_MS), ms);
            }
        }
        Ok(())
    }

    /// Creates every contender. To measure costs, each renders a first frame, which warms it up and shows its memory.
    pub(super) fn field(
        &self,
        job: &Job,
        prepared: &mut PreparedScene,
        views: &Views,
        cost: bool,
    ) -> anyhow::Result<Field> {
        let mut field = Field {
            contenders: Vec::new(),
            frame: StereoFrame::new(self.gl, job.eyes.size)?,
            first: vec![Record::Scene(views.facts(job, prepared))],
            memory: Vec::new(),
        };
        let base = process::resident_mib();
        for &contender in &job.contenders {
            let Some((method, mut options)) = contender.method() else { continue };
            interrupt::check()?;
            if job.imbuffer > 1 {
                options.synthesis.paper.imbuffer = ImBufferSize::Divisor(job.imbuffer);
            }
            let before = self.gl.texture_bytes();
            let made =
                PreparedContender::new(self.gl, method, &job.render, &options).map_err(anyhow::Error::from);
            let made = made.and_then(|mut ready| {
                if cost {
                    ready.render(prepared, &views.pairs[0], &mut field.frame)?;
                }
                Ok(ready)
            });
            self.bar.inc(1);
            match made {
                Ok(ready) => {
                    let mut memory = Measurement::new(&job.conditions, contender.name(), 0);
                    if cost {
                        let own = (self.gl.texture_bytes() - before) as f64 / f64::from(1 << 20);
                        memory.push(metric::TEXTURE_MIB, own);
                        memory.push(metric::MEMORY_MIB, base.map_or(f64::NAN, |base| base + own));
                    }
                    field.memory.push(memory);
                    field.contenders.push((contender, ready));
                }
                // Without the ground truth the others cannot be compared.
                Err(error) if contender == Contender::CONVENTIONAL => return Err(error),
                Err(error) => {
                    field.first.push(left_out(job, contender, &error));
                    self.bar.inc(u64::from(job.rounds) * job.frames as u64);
                }
            }
        }
        Ok(field)
    }

    /// Leaves out a swarm's setting if one conventional frame takes longer than the limit. Returns whether it did.
    pub(super) fn is_too_slow(
        &mut self,
        job: &Job,
        prepared: &mut PreparedScene,
        views: &Views,
        field: &mut Field,
    ) -> anyhow::Result<bool> {
        if !matches!(job.source, Source::Swarm { .. }) {
            return Ok(false);
        }
        let (_, conventional) =
            field.contenders.first_mut().context("the conventional method comes first")?;
        let FrameTime { wall, .. } = conventional.render(prepared, &views.pairs[0], &mut field.frame)?;
        if wall <= self.inputs.bounds.frame {
            return Ok(false);
        }
        let (takes, allowed) = (milliseconds(wall), milliseconds(self.inputs.bounds.frame));
        self.leave_out(
            job,
            format!("a conventional frame takes {takes:.0} ms, and {allowed:.0} ms are allowed"),
        )?;
        Ok(true)
    }
}
