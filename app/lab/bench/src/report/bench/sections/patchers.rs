//! Patchers on the same reprojected images.

use super::cells::{cell, milliseconds};
use super::tables::{metric_table, push_refusals};
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_report::paper::PAPER;
use yoro_report::stats::mean;
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Entry, Plot, Section, Table};

/// Returns the section of the suite `patchers`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Patchers",
        "How each patcher fills the holes of one reprojected image. The paper's times are from a phone, where its GAN \
         runs on the CPU.",
    );
    let contenders = suite.measured(metric::SSIM);
    let paper_of = |name: &str| {
        let name = name.strip_prefix("patcher-").unwrap_or(name);
        PAPER.patchers.get(name)
    };
    let time = |name: &str| mean(suite.values(name, |measured| measured.median(metric::PATCH_MS)));
    let quality = "Means over the scenes. More is better.";
    let of_suite = |metric_name: &'static str| move |name: &str| suite.mean(name, metric_name);
    let plots: [(_, _, _, &dyn Fn(&str) -> Option<f64>); 3] = [
        ("PSNR", Axis::new("PSNR, dB"), quality, &of_suite(metric::PSNR)),
        ("SSIM", Axis::new("SSIM, gaussian 11x11"), quality, &of_suite(metric::SSIM)),
        (
            "Time",
            Axis::new("patching time, ms").logarithmic(),
            "Of the patcher alone. Less is better.",
            &time,
        ),
    ];
    for (i, (title, axis, caption, ours)) in plots.into_iter().enumerate() {
        // Each patcher is a row; colours distinguish our figures from the paper's.
        let mut plot = Plot::rows(title, axis).caption(caption);
        for name in &contenders {
            let here = Entry { label: "here".into(), ..Entry::ours("yoro-gather") };
            plot.mark(name, here, ours(name).unwrap_or(f64::NAN));
            let paper = paper_of(name).map_or(f64::NAN, |figures| figures[i]);
            plot.mark(name, Entry::papers("yoro-paper", "the paper's"), paper);
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
            Cell::paper(fixed(paper.map(|p| p[0]), 2)),
            Cell::paper(fixed(paper.map(|p| p[1]), 4)),
            Cell::paper(paper.map(|p| milliseconds(p[2]))),
        ]);
    }
    push_refusals(&mut table, suite);
    section.table(table);
    section.table(metric_table(suite, "Every scene and patcher in full", &contenders));
    section
}
