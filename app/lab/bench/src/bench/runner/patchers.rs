//! Measuring patchers on the same reprojected images.

use anyhow::ensure;

use super::{Runner, left_out, milliseconds};
use crate::bench::contender::Contender;
use crate::bench::job::Job;
use crate::bench::record::{Measurement, Record, metric};
use crate::bench::views::Views;
use crate::dataset::{GroupOptions, GroupRenderer, ImageGroup};
use crate::inpaint::{self, Patcher};
use yoro_files::interrupt;
use yoro_metrics::Comparison;
use yoro_render::PreparedScene;

impl Runner<'_> {
    pub(super) fn patchers(
        &mut self,
        job: &Job,
        prepared: &mut PreparedScene,
        done: u32,
    ) -> anyhow::Result<()> {
        let views = Views::spread(job, prepared)?;
        let mut first = vec![Record::Scene(views.facts(job, prepared))];
        let mut patchers: Vec<(Contender, Box<dyn Patcher>)> = Vec::new();
        for &contender in &job.contenders {
            let Contender::Patcher(kind) = contender else { continue };
            match inpaint::create(self.gl, kind, &self.inputs.patchers) {
                Ok(patcher) => patchers.push((contender, patcher)),
                Err(error) => first.push(left_out(job, contender, &error)),
            }
        }
        let mut renderer = GroupRenderer::new(self.gl, &GroupOptions::default())?;
        let mut groups: Vec<ImageGroup> = Vec::new();
        for pair in &views.pairs {
            interrupt::check()?;
            groups.push(renderer.render(&mut prepared.renderer, &prepared.scene, pair)?);
        }
        for (_, patcher) in &mut patchers {
            interrupt::check()?;
            // The first call compiles and allocates.
            patcher.patch(&groups[0].reprojected)?;
        }
        for round in done..job.rounds {
            self.bar.set_message(format!("{}: round {} of {}", job.conditions, round + 1, job.rounds));
            let mut measurements: Vec<Measurement> =
                patchers.iter().map(|(c, _)| Measurement::new(&job.conditions, c.name(), round)).collect();
            let mut mono = Measurement::new(&job.conditions, Contender::MONO.name(), round);
            for (i, group) in groups.iter().enumerate() {
                let holes: Vec<bool> = group.reprojected.mask().iter().map(|m| *m == inpaint::HOLE).collect();
                for turn in 0..patchers.len() {
                    interrupt::check()?;
                    let at = (turn + i + round as usize) % patchers.len();
                    let patched = patchers[at].1.patch(&group.reprojected)?;
                    measurements[at].push(metric::PATCH_MS, milliseconds(patched.time.patching));
                    measurements[at].push(metric::PATCH_TRANSFER_MS, milliseconds(patched.time.transfer));
                    if round == 0 {
                        let comparison = Comparison::of(&patched.image, &group.truth, Some(&holes))?;
                        measurements[at].push_comparison(&comparison);
                        if i == 0 {
                            self.save_picture(job, patchers[at].0, &patched.image)?;
                        }
                    }
                    self.bar.inc(1);
                }
                if round == 0 {
                    let [x, y] = group.views.dominant_crop;
                    let [width, height] = group.pair.size;
                    let eye = image::imageops::crop_imm(&group.color, x, 0, width, height).to_image();
                    ensure!(
                        y == 0 && eye.dimensions() == group.truth.dimensions(),
                        "the eyes differ in height"
                    );
                    mono.push_comparison(&Comparison::of(&eye, &group.truth, Some(&holes))?);
                    if i == 0 {
                        self.save_picture(job, Contender::MONO, &eye)?;
                        self.save_picture(job, Contender::CONVENTIONAL, &group.truth)?;
                    }
                }
            }
            if round == 0 {
                measurements.insert(0, mono);
            }
            self.finish_round(job, round, std::mem::take(&mut first), measurements)?;
        }
        Ok(())
    }
}
