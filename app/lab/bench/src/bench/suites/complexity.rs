//! Frame time by number of triangles

use super::super::contender::Contender;
use super::super::job::Source;
use super::super::record::metric;
use super::super::results::{CONVENTIONAL, SuiteData};
use super::super::tables::{Sweep, cell, mean_and_range, milliseconds, push_refusals};
use super::{COST, FrameSuite};
use yoro_report::paper::PAPER;
use yoro_report::stats::{line_through, mean};
use yoro_report::text::{fixed, short_count};
use yoro_report::{Axis, Cell, Section, Table};

/// The number of sizes, as in the paper, and in the short form.
const SIZES: [usize; 2] = [9, 5];

pub(super) const COMPLEXITY: FrameSuite = FrameSuite {
    name: "complexity",
    about: "Frame time of every method as the number of triangles grows",
    measures: COST,
    contenders: Contender::methods,
    jobs: |suite, choices, object| {
        // Sizes grow in even steps, the first of which is one step. Slopes are measurable only if all else is equal.
        let sizes = choices.long_or_quick(SIZES[0], SIZES[1]);
        let step = (choices.max_triangles / sizes / object.triangles()).max(1);
        choices.sweep(suite, vec!["swarm".into()], (1..=sizes).map(|i| i * step), |job, copies| {
            job.source = Source::Swarm { copies, places: step * sizes };
            job.conditions.point = Some(object.swarm_triangles(copies) as f64);
            job.frames = 1;
        })
    },
    sections: |suite| {
        let mut section = Section::new(
            "Complexity",
            "Frame time against the number of triangles of one scene. The slope is the cost of another million triangles, \
             by least squares. Synthesis costs the same in every scene.",
        );
        let axis = Axis::new("triangles").from_zero();
        Sweep { axis, text: |point| short_count(point as u64) }.show_times(&mut section, suite);
        section.table(slopes(suite));
        vec![section]
    },
};

/// Milliseconds or ratios by millions of triangles.
type Curve = Vec<(f64, f64)>;

/// Returns the median frame times of a contender.
fn times(suite: &SuiteData, name: &str) -> Curve {
    let curve = suite.curve(|setting| setting.find(name)?.median(metric::FRAME_MS));
    curve.into_iter().map(|(triangles, ms)| (triangles / 1e6, ms)).collect()
}

/// Returns a contender's frame times divided by those of conventional rendering.
fn ratios(suite: &SuiteData, name: &str) -> Curve {
    let curve = suite.curve(|setting| setting.cost(name).map(|cost| cost.median));
    curve.into_iter().map(|(triangles, ratio)| (triangles / 1e6, ratio)).collect()
}

/// Returns the frame times of each of the paper's systems.
fn papers_times() -> impl Iterator<Item = (&'static str, Curve)> {
    let triangles = &PAPER.complexity["triangles"];
    let systems = PAPER.complexity.iter().filter(|(name, _)| *name != "triangles");
    systems.map(|(name, ms)| (name.as_str(), triangles.iter().copied().zip(ms.iter().copied()).collect()))
}

/// Returns a table of the cost of an additional million triangles, for each contender and for the paper's systems.
fn slopes(suite: &SuiteData) -> Table {
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
    let papers_of = |name: &str| papers_times().find(|(method, _)| *method == name).map(|(_, curve)| curve);
    let base = slope_of(&times(suite, CONVENTIONAL));
    let paper_base = papers_of(CONVENTIONAL).as_ref().and_then(slope_of);
    let share = |slope: Option<f64>, base: Option<f64>| fixed(slope.zip(base).map(|(s, b)| s / b), 3);
    for name in suite.measured(metric::FRAME_MS) {
        let fit = line_through(&times(suite, name));
        let slope = fit.map(|(_, slope)| slope);
        let papers = papers_of(name);
        let paper_slope = papers.as_ref().and_then(slope_of);
        let paper_ratio = papers.and_then(|curve| {
            mean(curve.iter().zip(&PAPER.complexity[CONVENTIONAL]).map(|((_, ms), base)| ms / base))
        });
        let ratios = ratios(suite, name).into_iter().map(|(_, ratio)| ratio);
        table.push(vec![
            Cell::plain(name),
            cell(name, slope.map(milliseconds)),
            Cell::plain(fit.map(|(offset, _)| milliseconds(offset)).unwrap_or_default()),
            cell(name, share(slope, base)),
            cell(name, mean_and_range(ratios)),
            Cell::paper(paper_slope.map(milliseconds)),
            Cell::paper(share(paper_slope, paper_base)),
            Cell::paper(fixed(paper_ratio, 3)),
        ]);
    }
    push_refusals(&mut table, suite);
    table.note = "The paper's slopes are least-squares fits to its nine points. Its “51.40 %” omits the smallest scene; \
                  the ratio here is the mean of all nine. Ours is followed by the lowest and the highest."
        .into();
    table
}
