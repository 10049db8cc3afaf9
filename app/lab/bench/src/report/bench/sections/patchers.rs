//! Patchers on the same reprojected images.

use super::cells::{cell, milliseconds};
use super::section::Section;
use super::tables::{metric_table, push_refusals};
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_report::grid::{Cell, Table};
use yoro_report::paper;
use yoro_report::plot::{Axis, DotRow, Mark, Panel};
use yoro_report::stats::mean;
use yoro_report::text::fixed;

/// Returns the section of the suite `patchers`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "patchers",
        "Patchers",
        "How each patcher fills the holes of one reprojected image. The paper's times are from a phone, where its GAN \
         runs on the CPU.",
    );
    let contenders = suite.measured(metric::SSIM);
    let paper_of = |name: &str| {
        let name = name.strip_prefix("patcher-").unwrap_or(name);
        paper::PATCHERS.iter().find(|patcher| patcher.name == name)
    };
    let dots = |axis: Axis, ours: &dyn Fn(&str) -> Option<f64>, papers: fn(&paper::PaperPatcher) -> f64| {
        // Each patcher is a row; colours distinguish our figures from the paper's.
        let rows = contenders.iter().map(|name| {
            let paper =
                paper_of(name).map(|patcher| Mark::papers("yoro-paper", "the paper's", papers(patcher)));
            let ours = ours(name).map(|value| Mark::new("yoro-gather", "here", value));
            DotRow { label: (*name).into(), marks: paper.into_iter().chain(ours).collect() }
        });
        Panel::Dots { value: axis, rows: rows.collect() }
    };
    let of_suite = |metric_name: &'static str| move |name: &str| suite.mean(name, metric_name);
    let caption = "Means over the scenes. More is better.";
    let panel = dots(Axis::new("PSNR, dB"), &of_suite(metric::PSNR), |p| p.psnr);
    section.figure("psnr", "PSNR", caption, panel);
    let panel = dots(Axis::new("SSIM, gaussian 11x11"), &of_suite(metric::SSIM), |p| p.ssim);
    section.figure("ssim", "SSIM", caption, panel);
    let time = |name: &str| mean(suite.values(name, |measured| measured.median(metric::PATCH_MS)));
    let panel = dots(Axis::new("patching time, ms").logarithmic(), &time, |p| p.ms);
    section.figure("ms", "Time", "Of the patcher alone. Less is better.", panel);

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
        let value = |metric_name| suite.mean(name, metric_name);
        let paper = paper_of(name);
        table.push(vec![
            Cell::plain(*name),
            cell(name, fixed(value(metric::PSNR), 2)),
            cell(name, fixed(value(metric::SSIM), 4)),
            cell(name, fixed(value(metric::FLIP), 4)),
            cell(name, fixed(value(metric::HOLE_PSNR), 2)),
            cell(name, fixed(value(metric::HOLE_SSIM), 4)),
            cell(name, time(name).map(milliseconds)),
            Cell::paper(fixed(paper.map(|p| p.psnr), 2)),
            Cell::paper(fixed(paper.map(|p| p.ssim), 4)),
            Cell::paper(paper.map(|p| milliseconds(p.ms))),
        ]);
    }
    push_refusals(&mut table, suite);
    section.table(table);
    section.table(metric_table(suite, "Every scene and patcher in full", &contenders));
    section
}
