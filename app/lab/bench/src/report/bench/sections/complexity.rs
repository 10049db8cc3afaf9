//! Frame time by number of triangles.

use super::cells::{CONVENTIONAL, cell, milliseconds, papers};
use super::tables::{push_refusals, sweep_table};
use crate::bench::record::metric;
use crate::report::bench::data::Suite;
use yoro_report::paper::PAPER;
use yoro_report::stats::{geometric_mean, line_through, mean};
use yoro_report::text::{fixed, short_count};
use yoro_report::{Axis, Cell, Entry, Plot, Section, Table};

/// The paper's systems.
const PAPERS: [&str; 4] = ["yoro-paper", CONVENTIONAL, "hybrid", "instanced"];

/// Milliseconds or ratios by millions of triangles.
type Curve = Vec<(f64, f64)>;

/// Returns the section of the suite `complexity`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "Complexity",
        "Frame time against the number of triangles of one scene. The slope is the cost of another million triangles, \
         by least squares. Synthesis costs the same in every scene.",
    );
    let plot = |title, caption, y| {
        Plot::curves(title, Axis::new("triangles, millions").from_zero(), y).caption(caption)
    };
    let ms = || Axis::new("frame time, ms").from_zero();
    let mut here = plot("Frame time here", "Medians on this machine.", ms());
    let mut paper = plot("The paper's frame time", "Means over its devices, its own scene.", ms());
    let mut over_two = plot(
        "Frame time over two full renders",
        "The line is conventional rendering.",
        Axis::new("frame time / conventional").baseline(1.0),
    );
    for name in suite.measured(metric::FRAME_MS) {
        here.curve(Entry::ours(name), times(suite, name));
        if name != CONVENTIONAL {
            over_two.curve(Entry::ours(name), ratios(suite, name));
        }
    }
    for name in PAPERS {
        paper.curve(papers(name), paper_times(name));
        if name != CONVENTIONAL {
            over_two.curve(papers(name), paper_ratios(name));
        }
    }
    section.plot(here);
    section.plot(paper);
    section.plot(over_two);
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

/// Returns the paper's frame times of the system that a method corresponds to; none if it has none.
fn paper_times(name: &str) -> Curve {
    let of = |name: &str| PAPER.complexity.get(name).into_iter().flatten().copied();
    of("triangles").zip(of(name)).collect()
}

/// Returns the paper's frame times of a system divided by those of conventional rendering.
fn paper_ratios(name: &str) -> Curve {
    let both = paper_times(name).into_iter().zip(paper_times(CONVENTIONAL));
    both.map(|((triangles, ms), (_, conventional))| (triangles, ms / conventional)).collect()
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
    let paper_base = slope_of(&paper_times(CONVENTIONAL));
    let share = |slope: Option<f64>, base: Option<f64>| fixed(slope.zip(base).map(|(s, b)| s / b), 3);
    for name in suite.measured(metric::FRAME_MS) {
        let fit = line_through(&times(suite, name));
        let slope = fit.map(|(_, slope)| slope);
        let paper_slope = slope_of(&paper_times(name));
        let paper_ratio = mean(paper_ratios(name).into_iter().map(|(_, ratio)| ratio));
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
