//! Frame time by number of triangles.

use super::cells::{CONVENTIONAL, PAPERS, cell, milliseconds};
use super::section::Section;
use super::tables::{push_refusals, sweep_table};
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_report::grid::{Cell, Table};
use yoro_report::paper::{self, COMPLEXITY};
use yoro_report::plot::{Axis, Panel, Series};
use yoro_report::stats::{geometric_mean, line_through, mean};
use yoro_report::text::{fixed, short_count};

/// The paper's frame times of conventional rendering, for the triangles of [`COMPLEXITY`].
const PAPERS_CONVENTIONAL: [f64; 9] = COMPLEXITY.systems[1].1;

/// Milliseconds or ratios by millions of triangles.
type Curve = Vec<(f64, f64)>;

/// Returns the section of the suite `complexity`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "complexity",
        "Complexity",
        "Frame time against the number of triangles of one scene. The slope is the cost of another million triangles, \
         by least squares. Synthesis costs the same in every scene.",
    );
    let x = || Axis::new("triangles, millions").from_zero();
    let y = || Axis::new("frame time, ms").from_zero();
    let time_curves = Panel::Curves { x: x(), y: y(), series: series(suite, times) };
    section.figure("ms", "Frame time here", "Medians on this machine.", time_curves);
    let curves = Panel::Curves { x: x(), y: y(), series: papers_series(|_, ms| ms) };
    section.figure("paper-ms", "The paper's frame time", "Means over its devices, its own scene.", curves);
    let mut series_of_ratios = papers_series(|i, ms| ms / PAPERS_CONVENTIONAL[i]);
    series_of_ratios.extend(series(suite, ratios));
    series_of_ratios.retain(|series| series.method != CONVENTIONAL);
    let y = Axis::new("frame time / conventional").baseline(1.0);
    let curves = Panel::Curves { x: x(), y, series: series_of_ratios };
    section.figure(
        "ratio",
        "Frame time over two full renders",
        "The line is conventional rendering.",
        curves,
    );
    section.table(slopes(suite));
    section.table(sweep_table(suite, "Median frame time, ms", metric::FRAME_MS, "triangles", |point| {
        short_count(point as u64)
    }));
    section
}

/// Returns the median frame times of a contender.
fn times(suite: &Suite, name: &str) -> Curve {
    let curve = suite.curve(|setting| setting.find(name)?.median(metric::FRAME_MS));
    curve.into_iter().map(|(triangles, ms)| (triangles / 1e6, ms)).collect()
}

/// Returns a contender's frame times divided by those of conventional rendering.
fn ratios(suite: &Suite, name: &str) -> Curve {
    let curve = suite.curve(|setting| setting.cost(name).map(|cost| cost.median));
    curve.into_iter().map(|(triangles, ratio)| (triangles / 1e6, ratio)).collect()
}

/// Returns the curve of a series of the paper's values, one for each of its sizes.
fn papers(values: impl IntoIterator<Item = f64>) -> Curve {
    COMPLEXITY.triangles.into_iter().zip(values).collect()
}

/// Returns a curve for each of the paper's systems. `value` maps each time and its index to a value.
fn papers_series(value: impl Fn(usize, f64) -> f64) -> Vec<Series> {
    let series = COMPLEXITY.systems.iter().map(|(method, times)| Series {
        method: (*method).into(),
        papers: true,
        label: format!("{PAPERS}{}", paper::system(method)),
        points: papers(times.iter().enumerate().map(|(i, ms)| value(i, *ms))),
    });
    series.collect()
}

/// Returns a curve for each contender, with the first on top.
fn series(suite: &Suite, curve: fn(&Suite, &str) -> Curve) -> Vec<Series> {
    let contenders = suite.measured(metric::FRAME_MS);
    let series = contenders.iter().rev().map(|name| Series {
        method: (*name).into(),
        papers: false,
        label: (*name).into(),
        points: curve(suite, name),
    });
    series.collect()
}

/// Returns a table of the cost of an additional million triangles, for each contender and for the paper's systems.
fn slopes(suite: &Suite) -> Table {
    let columns = [
        "<method",
        "ms per million triangles",
        "ms without triangles",
        "slope / conventional",
        "mean ratio of times",
        "the paper's slope",
        "the paper's slope / conventional",
        "the paper's mean ratio",
    ];
    let mut table = Table::new("Slope and ratio", &columns);
    let slope_of = |curve: &Curve| line_through(curve).map(|(_, slope)| slope);
    let base = slope_of(&times(suite, CONVENTIONAL));
    let paper_base = slope_of(&papers(PAPERS_CONVENTIONAL));
    let share = |slope: Option<f64>, base: Option<f64>| fixed(slope.zip(base).map(|(s, b)| s / b), 3);
    for name in suite.measured(metric::FRAME_MS) {
        let fit = line_through(&times(suite, name));
        let slope = fit.map(|(_, slope)| slope);
        let system = COMPLEXITY.systems.iter().find(|(method, _)| *method == name);
        let paper_slope = system.and_then(|(_, times)| slope_of(&papers(*times)));
        let paper_ratio = system.and_then(|(_, times)| {
            mean(times.iter().zip(PAPERS_CONVENTIONAL).map(|(ms, conventional)| ms / conventional))
        });
        let ratios = ratios(suite, name).into_iter().map(|(_, ratio)| ratio);
        table.push(vec![
            Cell::plain(name),
            cell(name, slope.map(milliseconds)),
            Cell::plain(fit.map(|(offset, _)| milliseconds(offset)).unwrap_or_default()),
            cell(name, share(slope, base)),
            cell(name, fixed(geometric_mean(ratios), 3)),
            Cell::paper(paper_slope.map(milliseconds)),
            Cell::paper(share(paper_slope, paper_base)),
            Cell::paper(fixed(paper_ratio, 3)),
        ]);
    }
    push_refusals(&mut table, suite);
    table.note =
        "The paper's slopes are least-squares fits to its nine points. Its “51.40 %” omits the smallest scene; the \
         ratio here is the mean of all nine."
            .into();
    table
}
