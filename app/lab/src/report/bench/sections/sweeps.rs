//! Curves and tables over the points of a sweep.

use super::cells::{CONVENTIONAL, PAPERS};
use super::section::Section;
use super::tables::sweep_table;
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite};
use yoro_figures::grid::{Cell, Column};
use yoro_figures::plot::{Axis, Panel, Series};
use yoro_figures::text::fixed;

/// The eye that is not dominant, by metric, for the page's figures.
pub const QUALITY_FIGURES: [(&str, &str, &str); 3] = [
    (metric::PSNR, "PSNR, dB", "More is better."),
    (metric::SSIM, "SSIM, gaussian 11x11", "More is better."),
    (metric::FLIP, "FLIP, 0 to 1", "Less is better. The paper has none."),
];

/// Curves of quality over a sweep, with the paper's where it has some.
pub fn quality_sweep(
    section: &mut Section,
    suite: &Suite,
    x: &Axis,
    papers: impl Fn(&str) -> Vec<(f64, f64)>,
    label: impl Fn(f64) -> String,
) {
    for (name, axis, caption) in QUALITY_FIGURES {
        let contenders: Vec<&str> =
            suite.measured(name).into_iter().filter(|name| *name != CONVENTIONAL).collect();
        let mut series = vec![Series {
            method: "yoro-paper".into(),
            papers: true,
            label: format!("{PAPERS}YORO"),
            points: papers(name),
        }];
        series.retain(|series| !series.points.is_empty());
        series.extend(contenders.iter().rev().map(|contender| Series {
            method: (*contender).into(),
            papers: false,
            label: (*contender).into(),
            points: suite.curve(|setting| setting.find(contender)?.mean(name)),
        }));
        section.figure(name, axis, caption, Panel::Curves { x: x.clone(), y: Axis::new(axis), series });
    }
    for (title, name) in [("PSNR, dB", metric::PSNR), ("SSIM", metric::SSIM), ("FLIP", metric::FLIP)] {
        let mut table = sweep_table(suite, title, name, &x.name, &label);
        let papers = papers(name);
        if !papers.is_empty() {
            table.columns.push(Column { name: "the paper's YORO".into(), left: false });
            for (line, point) in table.lines.iter_mut().zip(suite.points()) {
                let value = papers.iter().find(|(at, _)| (at - point).abs() < 1e-6).map(|(_, value)| *value);
                let decimals = if name == metric::SSIM { 4 } else { 2 };
                line.cells.push(Cell::paper(fixed(value, decimals)));
            }
            for line in table.lines.iter_mut().skip(suite.points().len()) {
                if let Some(last) = line.cells.last_mut() {
                    last.span += 1;
                }
            }
        }
        let scenes = suite.scenes();
        table.note = format!("Mean over {}.", scenes.join(", "));
        section.table(table);
    }
}

/// Curves and a table of the frame time over a sweep.
pub fn time_sweep(section: &mut Section, suite: &Suite, x: Axis, label: impl Fn(f64) -> String) {
    let contenders = suite.measured(metric::FRAME_MS);
    let curves = |value: &dyn Fn(&SettingData, &str) -> Option<f64>, without: &str| -> Vec<Series> {
        let names = contenders.iter().rev().filter(|name| **name != without);
        let series = names.map(|name| Series {
            method: (*name).into(),
            papers: false,
            label: (*name).into(),
            points: suite.curve(|setting| value(setting, name)),
        });
        series.collect()
    };
    let series = curves(&|setting, name| setting.find(name)?.median(metric::FRAME_MS), "");
    let y = Axis::new("frame time, ms").from_zero();
    let quantity = x.name.clone();
    section.figure("ms", "Frame time", "Medians.", Panel::Curves { x: x.clone(), y, series });
    let series = curves(&|setting, name| setting.cost(name).map(|cost| cost.median), CONVENTIONAL);
    let y = Axis::new("frame time / conventional").baseline(1.0);
    section.figure(
        "ratio",
        "Frame time over two full renders",
        "The line is conventional rendering.",
        Panel::Curves { x, y, series },
    );
    section.table(sweep_table(suite, "Median frame time, ms", metric::FRAME_MS, &quantity, label));
}
