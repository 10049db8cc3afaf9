//! Suites that sweep a number: curves and tables over its points.

use super::cells::{CONVENTIONAL, PAPERS};
use super::section::Section;
use super::tables::sweep_table;
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::grid::{Cell, Column};
use yoro_report::paper;
use yoro_report::plot::{Axis, Panel, Series};
use yoro_report::text::fixed;

/// The metrics of the eye that is not dominant that have a figure: metric, axis, and a note.
pub const QUALITY_FIGURES: [(&str, &str, &str); 3] = [
    (metric::PSNR, "PSNR, dB", "More is better."),
    (metric::SSIM, "SSIM, gaussian 11x11", "More is better."),
    (metric::FLIP, "FLIP, 0 to 1", "Less is better. The paper has none."),
];

/// Adds curves of quality over a sweep, with the paper's where there are any.
fn quality_sweep(
    section: &mut Section,
    suite: &Suite,
    x: &Axis,
    papers: impl Fn(&str) -> Vec<(f64, f64)>,
    label: impl Fn(f64) -> String,
) {
    for (name, axis, caption) in QUALITY_FIGURES {
        let contenders = suite.compared(name);
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

/// Adds curves and a table of the frame time over a sweep.
fn time_sweep(section: &mut Section, suite: &Suite, x: Axis, label: impl Fn(f64) -> String) {
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

/// Returns the section of the suite `ipd`.
pub fn ipd(suite: &Suite) -> Section {
    let mut section = Section::new(
        "ipd",
        "Distance between the eyes",
        "Quality of the synthesized eye against the interpupillary distance.",
    );
    let papers = |name: &str| -> Vec<(f64, f64)> {
        match name {
            metric::SSIM => paper::IPD.iter().map(|point| (point.0, point.1)).collect(),
            metric::PSNR => paper::IPD.iter().map(|point| (point.0, point.2)).collect(),
            _ => Vec::new(),
        }
    };
    quality_sweep(&mut section, suite, &Axis::new("IPD, mm"), papers, |point| format!("{point}"));
    section
}

/// Returns the section of the suite `distance`.
pub fn distance(suite: &Suite) -> Section {
    let (ssim, psnr) = paper::DISTANCE;
    let mut section = Section::new(
        "distance",
        "Distance of the object",
        &format!(
            "Quality against the distance of one irregular object, scaled so that it keeps its size on the screen. \
             The paper shows its curve as a picture only; its text says SSIM {ssim} and {psnr} dB for 0.5 to 3 m."
        ),
    );
    quality_sweep(&mut section, suite, &Axis::new("distance, m"), |_| Vec::new(), |point| format!("{point}"));
    section
}

/// Returns the section of the suite `imbuffer`.
pub fn imbuffer(suite: &Suite) -> Section {
    let mut section = Section::new(
        "imbuffer",
        "ImBuffer",
        "The paper's pipeline with a smaller ImBuffer: its width and height are the image's over the divisor, with \
         and without linear interpolation.",
    );
    let x = Axis::new("ImBuffer divisor").logarithmic();
    quality_sweep(&mut section, suite, &x, |_| Vec::new(), |point| format!("1/{point}"));
    time_sweep(&mut section, suite, x, |point| format!("1/{point}"));
    section
}

/// Returns the section of the suite `resolution`.
pub fn resolution(suite: &Suite) -> Section {
    let mut section = Section::new(
        "resolution",
        "Resolution",
        "Cost and quality against the width of each eye's image. The paper measured at its devices' own resolution \
         only.",
    );
    let x = Axis::new("width of an eye, pixels");
    time_sweep(&mut section, suite, x.clone(), |point| format!("{point}"));
    quality_sweep(&mut section, suite, &x, |_| Vec::new(), |point| format!("{point}"));
    section
}
