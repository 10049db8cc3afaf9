//! Patchers on the same reprojected images.

use anyhow::ensure;

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::picture_name;
use super::super::job::{Choices, Job};
use super::super::record::{Record, metric};
use super::super::results::SuiteData;
use super::super::runner::{Round, Runner, left_out, milliseconds};
use super::super::scenes::LazyObject;
use super::super::tables::{cell, metric_table, milliseconds as ms_text, push_refusals};
use crate::dataset::{GroupOptions, GroupRenderer, ImageGroup};
use crate::inpaint::{self, Patcher};
use yoro_files::interrupt;
use yoro_metrics::Comparison;
use yoro_render::PreparedScene;
use yoro_report::paper::PAPER;
use yoro_report::stats::mean;
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Entry, Plot, Section, Table};

/// Patchers on the same reprojected images.
pub struct Patchers;

impl Experiment for Patchers {
    fn name(&self) -> &'static str {
        "patchers"
    }

    fn about(&self) -> &'static str {
        "Quality and time of the patchers on the same reprojected images"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let own = [vec![Contender::MONO], Contender::patchers()].concat();
        let contenders = choices.contenders(self.name(), own, &[Contender::MONO])?;
        Ok(choices.sweep(self, choices.varied_scenes(), [()], |job, ()| {
            job.contenders.clone_from(&contenders);
            job.rounds = choices.rounds;
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        let views = runner.viewpoints(job, scene)?;
        let mut first: Vec<Record> = Vec::new();
        let mut patchers: Vec<(Contender, Box<dyn Patcher>)> = Vec::new();
        for &contender in &job.contenders {
            let Contender::Patcher(kind) = contender else { continue };
            match inpaint::create(runner.gl, kind, &runner.inputs.patchers) {
                Ok(patcher) => patchers.push((contender, patcher)),
                Err(error) => first.push(left_out(job, contender, &error)),
            }
        }
        let mut renderer = GroupRenderer::new(runner.gl, &GroupOptions::default())?;
        let mut groups: Vec<ImageGroup> = Vec::new();
        for pair in &views.pairs {
            interrupt::check()?;
            groups.push(renderer.render(&mut scene.renderer, &scene.scene, pair)?);
        }
        for (_, patcher) in &mut patchers {
            interrupt::check()?;
            // The first call compiles and allocates.
            patcher.patch(&groups[0].reprojected)?;
        }
        for number in runner.rounds(job) {
            runner.announce(job, number);
            let mut round = Round::of_views(job, number, &views, scene);
            round.records.append(&mut first);
            for (i, group) in groups.iter().enumerate() {
                let holes: Vec<bool> = group.reprojected.mask().iter().map(|m| *m == inpaint::HOLE).collect();
                if number == 0 {
                    let eye = dominant_eye(group)?;
                    let comparison = Comparison::of(&eye, &group.truth, Some(&holes))?;
                    round.of(&Contender::MONO.name()).push_comparison(&comparison);
                    if i == 0 {
                        runner.save_picture(job, &picture_name(Contender::MONO), &eye)?;
                        runner.save_picture(job, &picture_name(Contender::CONVENTIONAL), &group.truth)?;
                    }
                }
                let count = patchers.len();
                for (contender, _) in &patchers {
                    // Rows are in this order, whoever is first.
                    round.of(&contender.name());
                }
                for turn in 0..count {
                    interrupt::check()?;
                    let (contender, patcher) = &mut patchers[(turn + i + number as usize) % count];
                    let patched = patcher.patch(&group.reprojected)?;
                    let measurement = round.of(&contender.name());
                    measurement.push(metric::PATCH_MS, milliseconds(patched.time.patching));
                    measurement.push(metric::PATCH_TRANSFER_MS, milliseconds(patched.time.transfer));
                    if number == 0 {
                        let comparison = Comparison::of(&patched.image, &group.truth, Some(&holes))?;
                        measurement.push_comparison(&comparison);
                        if i == 0 {
                            runner.save_picture(job, &picture_name(*contender), &patched.image)?;
                        }
                    }
                    runner.bar.inc(1);
                }
            }
            runner.finish(round)?;
        }
        Ok(())
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Patchers",
            "How each patcher fills the holes of one reprojected image. The paper's times are from a phone, where its GAN \
             runs on the CPU.",
        );
        let contenders = suite.measured(metric::SSIM);
        let paper_of = |name: &str| PAPER.patchers.get(name.strip_prefix("patcher-").unwrap_or(name));
        let time = |name: &str| mean(suite.values(name, |measured| measured.median(metric::PATCH_MS)));
        let caption = "Means over the scenes. More is better.";
        let plots = [
            Plot::rows("PSNR", Axis::new("PSNR, dB")).caption(caption),
            Plot::rows("SSIM", Axis::new("SSIM, gaussian 11x11")).caption(caption),
            Plot::rows("Time", Axis::new("patching time, ms").logarithmic())
                .caption("Of the patcher alone. Less is better."),
        ];
        for (i, mut plot) in plots.into_iter().enumerate() {
            for name in &contenders {
                // Each patcher is a row; colours distinguish our figures from the paper's.
                let ours = [suite.mean(name, metric::PSNR), suite.mean(name, metric::SSIM), time(name)][i];
                if let Some(value) = ours {
                    plot.mark(name, Entry { label: "here".into(), ..Entry::ours("yoro-gather") }, value);
                }
                if let Some(papers) = paper_of(name) {
                    plot.mark(name, Entry::papers("yoro-paper", "the paper's"), papers[i]);
                }
            }
            section.plot(plot);
        }
        let columns = [
            "<patcher",
            "PSNR, dB",
            "SSIM",
            "FLIP",
            "holes: PSNR, dB",
            "holes: SSIM",
            "time, ms",
            "the paper's PSNR",
            "the paper's SSIM",
            "the paper's time, ms",
        ];
        let mut table = Table::new("Means over the scenes", &columns);
        for name in &contenders {
            let value = |metric, decimals| cell(name, fixed(suite.mean(name, metric), decimals));
            let papers = paper_of(name);
            table.push(vec![
                Cell::plain(*name),
                value(metric::PSNR, 2),
                value(metric::SSIM, 4),
                value(metric::FLIP, 4),
                value(metric::HOLE_PSNR, 2),
                value(metric::HOLE_SSIM, 4),
                cell(name, time(name).map(ms_text)),
                Cell::paper(fixed(papers.map(|p| p[0]), 2)),
                Cell::paper(fixed(papers.map(|p| p[1]), 4)),
                Cell::paper(papers.map(|p| ms_text(p[2]))),
            ]);
        }
        push_refusals(&mut table, suite);
        section.table(table);
        section.table(metric_table(suite, "Every scene and patcher in full", &contenders));
        vec![section]
    }
}

/// Returns the dominant eye's own part of a rendered view.
fn dominant_eye(group: &ImageGroup) -> anyhow::Result<image::RgbImage> {
    let [x, y] = group.views.dominant_crop;
    let [width, height] = group.pair.size;
    let eye = image::imageops::crop_imm(&group.color, x, 0, width, height).to_image();
    ensure!(y == 0 && eye.dimensions() == group.truth.dimensions(), "the eyes differ in height");
    Ok(eye)
}
