//! Suites that sweep a number: curves and tables over its points.

use super::cells::{CONVENTIONAL, papers};
use super::tables::sweep_table;
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_report::paper::{self, PAPER};
use yoro_report::text::fixed;
use yoro_report::{Axis, Cell, Entry, Plot, Section};

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
    papers_of: impl Fn(&str) -> Vec<(f64, f64)>,
    label: impl Fn(f64) -> String,
) {
    for (name, axis, caption) in QUALITY_FIGURES {
        let mut plot = Plot::curves(axis, x.clone(), Axis::new(axis)).caption(caption);
        for contender in suite.compared(name) {
            let curve = suite.curve(|setting| setting.find(contender)?.mean(name));
            plot.curve(Entry::ours(contender), curve);
        }
        plot.curve(papers("yoro-paper"), papers_of(name));
        section.plot(plot);
    }
    for (title, name) in [("PSNR, dB", metric::PSNR), ("SSIM", metric::SSIM), ("FLIP", metric::FLIP)] {
        let mut table = sweep_table(suite, title, name, &x.name, &label);
        let papers = papers_of(name);
        if !papers.is_empty() {
            table.push_column("the paper's YORO");
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
    let quantity = x.name.clone();
    let mut times =
        Plot::curves("Frame time", x.clone(), Axis::new("frame time, ms").from_zero()).caption("Medians.");
    let y = Axis::new("frame time / conventional").baseline(1.0);
    let ratios = Plot::curves("Frame time over two full renders", x, y);
    let mut ratios = ratios.caption("The line is conventional rendering.");
    for name in contenders {
        let curve = suite.curve(|setting| setting.find(name)?.median(metric::FRAME_MS));
        times.curve(Entry::ours(name), curve);
        if name != CONVENTIONAL {
            let curve = suite.curve(|setting| setting.cost(name).map(|cost| cost.median));
            ratios.curve(Entry::ours(name), curve);
        }
    }
    section.plot(times);
    section.plot(ratios);
    section.table(sweep_table(suite, "Median frame time, ms", metric::FRAME_MS, &quantity, label));
}

/// Returns the section of the suite `ipd`.
pub fn ipd(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Distance between the eyes",
        "Quality of the synthesized eye against the interpupillary distance.",
    );
    let papers = |name: &str| -> Vec<(f64, f64)> {
        match name {
            metric::SSIM => PAPER.sweeps["ipd"].iter().map(|point| (point[0], point[1])).collect(),
            metric::PSNR => PAPER.sweeps["ipd"].iter().map(|point| (point[0], point[2])).collect(),
            _ => Vec::new(),
        }
    };
    quality_sweep(&mut section, suite, &Axis::new("IPD, mm"), papers, |point| format!("{point}"));
    section
}

/// Returns the section of the suite `distance`.
pub fn distance(suite: &Suite) -> Section {
    let [ssim, psnr] = paper::DISTANCE;
    let mut section = Section::new(
        "Distance of the object",
        format!(
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
        "Resolution",
        "Cost and quality against the width of each eye's image. The paper measured at its devices' own resolution \
         only.",
    );
    let x = Axis::new("width of an eye, pixels");
    time_sweep(&mut section, suite, x.clone(), |point| format!("{point}"));
    quality_sweep(&mut section, suite, &x, |_| Vec::new(), |point| format!("{point}"));
    section
}
