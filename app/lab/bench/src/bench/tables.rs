//! Tables and plots that several experiments share, and figures as text.

use super::record::metric;
use super::results::{CONVENTIONAL, MONO, Measured, SettingData, Spread, SuiteData};
use yoro_report::paper::{self, PAPER, PaperScene};
use yoro_report::stats::{geometric_mean, mean, percentile, unique};
use yoro_report::text::{fixed, short_count};
use yoro_report::{Axis, Cell, Entry, Plot, Section, Table};

/// A metric of the eye that is not dominant that has a plot.
pub(super) struct QualityPlot {
    pub metric: &'static str,
    pub axis: &'static str,
    /// A note for the reader.
    pub caption: &'static str,
}

/// The metrics of the eye that is not dominant that have plots.
pub(super) const QUALITY_PLOTS: [QualityPlot; 3] = [
    QualityPlot { metric: metric::PSNR, axis: "PSNR, dB", caption: "More is better." },
    QualityPlot { metric: metric::SSIM, axis: "SSIM, gaussian 11x11", caption: "More is better." },
    QualityPlot {
        metric: metric::FLIP,
        axis: "FLIP, 0 to 1",
        caption: "Less is better. The paper has none.",
    },
];

/// A column of a table: the heading, the metric, and its decimals.
pub(super) type MetricColumn = (&'static str, &'static str, usize);

/// Formats a time in ms with two decimals or, from 100 ms on, without: `530` or `12.30`.
pub(super) fn milliseconds(value: f64) -> String {
    // Avoids a minus sign in front of zero.
    let value = if value.abs() < 0.005 { 0.0 } else { value };
    if value >= 100.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}

/// Formats a PSNR in dB. Identical images have no finite one.
fn psnr_text(psnr: Option<f64>) -> String {
    fixed(psnr, 2).unwrap_or_else(|| "∞".into())
}

/// Formats PSNR and SSIM as in the paper's tables; `None` if SSIM was not measured.
pub(super) fn psnr_ssim(psnr: Option<f64>, ssim: Option<f64>) -> Option<String> {
    Some(format!("{} / {:.4}", psnr_text(psnr), ssim?))
}

/// The title of tables of [`psnr_ssim_flip`].
pub(super) const PSNR_SSIM_FLIP: &str = "PSNR in dB/SSIM/FLIP";

/// Formats the three of them; `None` if SSIM or FLIP was not measured. `mean` has the mean of a metric.
pub(super) fn psnr_ssim_flip(mean: impl Fn(&str) -> Option<f64>) -> Option<String> {
    let psnr = psnr_text(mean(metric::PSNR));
    Some(format!("{psnr}/{:.4}/{:.3}", mean(metric::SSIM)?, mean(metric::FLIP)?))
}

/// What the figures of [`cost_of`] are.
pub(super) const QUARTILES: &str = "Medians of all frames, and their quartiles.";

/// Returns a contender's frame time over that of two full renders, which have their own.
pub(super) fn cost_of(setting: &SettingData, name: &str) -> Option<String> {
    if name == CONVENTIONAL {
        return Some(format!("{} ms", milliseconds(setting.find(CONVENTIONAL)?.median(metric::FRAME_MS)?)));
    }
    let Spread { median, quartiles: [low, high] } = setting.cost(name)?;
    Some(format!("{median:.2} ({low:.2}–{high:.2})"))
}

/// Formats the geometric mean of ratios with the lowest and the highest: `0.54 (0.50–0.58)`; `None` if there are none.
pub(super) fn mean_and_range(ratios: impl Iterator<Item = f64>) -> Option<String> {
    let ratios: Vec<f64> = ratios.collect();
    let range = ratios.iter().fold([f64::MAX, f64::MIN], |[low, high], r| [low.min(*r), high.max(*r)]);
    let mean = geometric_mean(ratios)?;
    Some(format!("{mean:.2} ({:.2}–{:.2})", range[0], range[1]))
}

/// Returns PSNR and SSIM of a contender.
pub(super) fn quality_of(measured: &Measured) -> Option<String> {
    psnr_ssim(measured.mean(metric::PSNR), measured.mean(metric::SSIM))
}

/// Returns a cell with one of our figures, or with a baseline if the contender is one.
pub(super) fn cell(contender: &str, text: Option<String>) -> Cell {
    if [CONVENTIONAL, MONO].contains(&contender) { Cell::base(text) } else { Cell::ours(text) }
}

/// Returns the paper's scene that a setting's scene corresponds to.
pub(super) fn paper_scene(setting: &SettingData) -> Option<&'static PaperScene> {
    paper::find(setting.stands_for())
}

/// Returns the entry of the paper's figures of the system that a method here corresponds to.
pub(super) fn papers_entry(method: &str) -> Entry {
    Entry::papers(method, format!("the paper's {}", paper::system(method)))
}

/// Returns a table with the first columns and one for each contender.
pub(super) fn table_of(title: &str, first: &[&str], contenders: &[&str]) -> Table {
    Table::new(title, &[first, contenders].concat())
}

/// Marks a value of each setting and contender in a plot of rows, then the paper's values.
pub(super) fn mark_scenes(
    mut plot: Plot,
    suite: &SuiteData,
    contenders: &[&str],
    value: impl Fn(&SettingData, &str) -> Option<f64>,
    papers: impl Fn(&SettingData) -> Vec<(&'static str, f64)>,
) -> Plot {
    for setting in &suite.settings {
        for name in contenders {
            if let Some(value) = value(setting, name) {
                plot.mark(&setting.label(), Entry::ours(*name), value);
            }
        }
        for (method, value) in papers(setting) {
            plot.mark(&setting.label(), papers_entry(method), value);
        }
    }
    plot
}

/// The paper's column in a [`scene_table`].
pub(super) struct PapersColumn<'a> {
    pub title: &'a str,
    pub of_scene: fn(&SettingData) -> Option<String>,
    pub mean: Option<String>,
}

/// Returns a table with a row for each setting and a column for each contender, followed by the means and by the
/// contenders that were not measured.
pub(super) fn scene_table(
    suite: &SuiteData,
    title: &str,
    contenders: &[&str],
    text: impl Fn(&SettingData, &str) -> Option<String>,
    mean_text: impl Fn(&str) -> Option<String>,
    papers: Option<PapersColumn>,
) -> Table {
    let mut columns = [&["<scene", "triangles"], contenders].concat();
    columns.extend(papers.iter().map(|papers| papers.title));
    let mut table = Table::new(title, &columns);
    for setting in &suite.settings {
        let triangles = setting.facts.as_ref().map_or_else(String::new, |facts| short_count(facts.triangles));
        let mut cells = vec![Cell::plain(setting.label()), Cell::plain(triangles)];
        for name in contenders {
            let refused = setting.unsupported.iter().any(|(other, _)| other == name);
            let text = text(setting, name).or_else(|| refused.then(|| "not measured".to_owned()));
            cells.push(cell(name, text));
        }
        cells.extend(papers.iter().map(|papers| Cell::paper((papers.of_scene)(setting))));
        table.push(cells);
    }
    let mut cells = vec![Cell::plain(format!("mean of {}", suite.settings.len())), Cell::plain("")];
    cells.extend(contenders.iter().map(|name| cell(name, mean_text(name))));
    cells.extend(papers.map(|papers| Cell::paper(papers.mean)));
    table.push_first(cells);
    push_refusals(&mut table, suite);
    table
}

/// Adds a row with the reason for each contender that could not take part, in the whole suite or in some settings.
pub(super) fn push_refusals(table: &mut Table, suite: &SuiteData) {
    for name in suite.contenders() {
        if let Some(reason) = suite.reason(name) {
            table.push_reason(vec![Cell::plain(name)], reason);
            continue;
        }
        for setting in &suite.settings {
            for (_, reason) in setting.unsupported.iter().filter(|(other, _)| other == name) {
                table.push_reason(vec![Cell::plain(name)], &format!("{}: {reason}", setting.label()));
            }
        }
    }
}

/// Returns a table with the frame times of each contender in each setting.
pub(super) fn time_details(suite: &SuiteData, papers: impl Fn(&SettingData, &str) -> Option<f64>) -> Table {
    let columns = [
        "<scene",
        "<method",
        "frames",
        "median, ms",
        "quartiles, ms",
        "std, ms",
        "p95, ms",
        "p99, ms",
        "ratio",
        "quartiles of the ratio",
        "the paper's ratio",
    ];
    let mut table = Table::new("Frame times in full", &columns);
    for setting in &suite.settings {
        for measured in &setting.contenders {
            let Some(times) = measured.summary(metric::FRAME_MS) else { continue };
            let samples = measured.samples(metric::FRAME_MS);
            let quartile = |percent| milliseconds(percentile(&samples, percent).unwrap_or(f64::NAN));
            let cost = setting.cost(&measured.name);
            let spread = cost.map(|c| format!("{:.3} – {:.3}", c.quartiles[0], c.quartiles[1]));
            let cells = vec![
                Cell::plain(setting.label()),
                Cell::plain(&measured.name),
                Cell::plain(times.count.to_string()),
                cell(&measured.name, Some(milliseconds(times.median))),
                Cell::plain(format!("{} – {}", quartile(25.0), quartile(75.0))),
                Cell::plain(milliseconds(times.std)),
                Cell::plain(milliseconds(times.p95)),
                Cell::plain(milliseconds(times.p99)),
                cell(&measured.name, cost.map(|c| format!("{:.3}", c.median))),
                Cell::plain(spread.unwrap_or_default()),
                Cell::paper(fixed(papers(setting, &measured.name), 3)),
            ];
            table.push(cells);
        }
    }
    table.group();
    push_refusals(&mut table, suite);
    table.note = "Ratio: frame time over that of conventional rendering, frame by frame within each interleaved round; \
                  its median and quartiles."
        .into();
    table
}

/// Returns a table of means over the settings, with a row for each contender and a column for each measured metric.
pub(super) fn means_table(
    suite: &SuiteData,
    title: &str,
    contenders: &[&str],
    columns: &[MetricColumn],
) -> Table {
    let measured: Vec<_> = columns.iter().filter(|(_, name, _)| !suite.measured(name).is_empty()).collect();
    let headings: Vec<&str> = measured.iter().map(|(heading, ..)| *heading).collect();
    let mut table = table_of(title, &["<method"], &headings);
    if measured.is_empty() {
        return table;
    }
    for name in contenders {
        let value =
            |(_, metric, decimals): &&MetricColumn| cell(name, fixed(suite.mean(name, metric), *decimals));
        table.push([Cell::plain(*name)].into_iter().chain(measured.iter().map(value)).collect());
    }
    for name in suite.contenders() {
        if let Some(reason) = suite.reason(name) {
            table.push_reason(vec![Cell::plain(name)], reason);
        }
    }
    table
}

/// Returns a table of all figures of quality, with a row for each setting and contender and a column for each metric.
pub(super) fn metric_table(suite: &SuiteData, title: &str, contenders: &[&str]) -> Table {
    const COLUMNS: [MetricColumn; 10] = [
        ("PSNR, dB", metric::PSNR, 2),
        ("SSIM", metric::SSIM, 4),
        ("SSIM 7x7", metric::SSIM_UNIFORM, 4),
        ("FLIP", metric::FLIP, 4),
        ("open: share, %", metric::OPEN_SHARE, 2),
        ("holes: share, %", metric::HOLE_SHARE, 2),
        ("holes: PSNR, dB", metric::HOLE_PSNR, 2),
        ("holes: SSIM", metric::HOLE_SSIM, 4),
        ("elsewhere: PSNR, dB", metric::VISIBLE_PSNR, 2),
        ("elsewhere: SSIM", metric::VISIBLE_SSIM, 4),
    ];
    let measured: Vec<_> = COLUMNS.iter().filter(|(_, name, _)| !suite.measured(name).is_empty()).collect();
    let headings: Vec<&str> = measured.iter().map(|(heading, ..)| *heading).collect();
    let mut table = table_of(title, &["<scene", "<method"], &headings);
    for setting in &suite.settings {
        for name in contenders {
            let Some(of) = setting.find(name) else { continue };
            let mut cells = vec![Cell::plain(setting.label()), Cell::plain(*name)];
            for (_, metric, decimals) in &measured {
                let is_share = [metric::HOLE_SHARE, metric::OPEN_SHARE].contains(metric);
                let scale = if is_share { 100.0 } else { 1.0 };
                cells.push(cell(name, fixed(of.mean(metric).map(|value| value * scale), *decimals)));
            }
            table.push(cells);
        }
    }
    table.group();
    push_refusals(&mut table, suite);
    table
}

/// Returns a section with the mean of every metric in every setting, for suites that say nothing more.
pub(super) fn everything(about: &str, suite: &SuiteData) -> Section {
    let mut letters = suite.name.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    let heading: String = first.chain(letters.map(|c| if c == '-' { ' ' } else { c })).collect();
    let measured = suite.settings.iter().flat_map(|setting| &setting.contenders);
    let metrics = unique(measured.flat_map(|measured| measured.metrics()));
    let mut table = table_of("Means", &["<setting", "<method"], &metrics);
    for setting in &suite.settings {
        for measured in &setting.contenders {
            let mut cells = vec![Cell::plain(setting.label()), Cell::plain(&measured.name)];
            cells.extend(metrics.iter().map(|name| cell(&measured.name, fixed(measured.mean(name), 4))));
            table.push(cells);
        }
    }
    push_refusals(&mut table, suite);
    let about = if about.is_empty() { String::new() } else { format!("{about}.") };
    let mut section = Section::new(heading, about);
    section.table(table);
    section
}

/// A swept number: its axis, and its values as text.
pub(super) struct Sweep {
    pub axis: Axis,
    pub text: fn(f64) -> String,
}

impl Sweep {
    /// Returns a table with a row for each point and a column for each contender: means over the scenes or, for times,
    /// medians.
    pub fn table(&self, suite: &SuiteData, title: &str, metric: &str) -> Table {
        let contenders = suite.measured(metric);
        let mut table = table_of(title, &[self.axis.name.as_str()], &contenders);
        let times = metric.ends_with("_ms");
        for point in suite.points() {
            let mut cells = vec![Cell::plain((self.text)(point))];
            for name in &contenders {
                let here = suite.settings.iter().filter(|setting| setting.conditions.point == Some(point));
                let value = |setting: &SettingData| {
                    let measured = setting.find(name)?;
                    if times { measured.median(metric) } else { measured.mean(metric) }
                };
                let value = mean(here.filter_map(value));
                let decimals = if metric.contains("ssim") { 4 } else { 2 };
                cells.push(cell(name, if times { value.map(milliseconds) } else { fixed(value, decimals) }));
            }
            table.push(cells);
        }
        push_refusals(&mut table, suite);
        table
    }

    /// Adds curves and tables of quality over the sweep, with the paper's points: quantity, SSIM, PSNR.
    pub fn show_quality(&self, section: &mut Section, suite: &SuiteData, papers: &[[f64; 3]]) {
        let papers = |name: &str| -> Vec<(f64, f64)> {
            let at = match name {
                metric::SSIM => 1,
                metric::PSNR => 2,
                _ => return Vec::new(),
            };
            papers.iter().map(|point| (point[0], point[at])).collect()
        };
        for QualityPlot { metric, axis, caption } in QUALITY_PLOTS {
            let mut plot = Plot::curves(axis, self.axis.clone(), Axis::new(axis)).caption(caption);
            for name in suite.compared(metric) {
                plot.curve(Entry::ours(name), suite.curve(|setting| setting.find(name)?.mean(metric)));
            }
            plot.curve(papers_entry("yoro-paper"), papers(metric));
            section.plot(plot);
        }
        for (title, name) in [("PSNR, dB", metric::PSNR), ("SSIM", metric::SSIM), ("FLIP", metric::FLIP)] {
            let mut table = self.table(suite, title, name);
            let papers = papers(name);
            if !papers.is_empty() {
                let decimals = if name == metric::SSIM { 4 } else { 2 };
                let of = |point: f64| papers.iter().find(|(at, _)| (at - point).abs() < 1e-6);
                let column = suite.points().into_iter().map(|point| fixed(of(point).map(|p| p.1), decimals));
                add_papers_column(&mut table, "the paper's YORO", column.collect());
            }
            table.note = format!("Mean over {}.", suite.scenes().join(", "));
            section.table(table);
        }
    }

    /// Adds curves and a table of the frame time over the sweep.
    pub fn show_times(&self, section: &mut Section, suite: &SuiteData) {
        let y = Axis::new("frame time, ms").from_zero();
        let mut plot = Plot::curves("Frame time", self.axis.clone(), y).caption("Medians.");
        for name in suite.measured(metric::FRAME_MS) {
            let times = suite.curve(|setting| setting.find(name)?.median(metric::FRAME_MS));
            plot.curve(Entry::ours(name), times);
        }
        section.plot(plot);
        let y = Axis::new("frame time / conventional").baseline(1.0);
        let mut plot = Plot::curves("Frame time over two full renders", self.axis.clone(), y)
            .caption("The line is conventional rendering.");
        for name in suite.compared(metric::FRAME_MS) {
            plot.curve(Entry::ours(name), suite.curve(|setting| setting.cost(name).map(|cost| cost.median)));
        }
        section.plot(plot);
        section.table(self.table(suite, "Median frame time, ms", metric::FRAME_MS));
    }
}

/// Returns a table of means over the scenes, with a row for each label of a sweep, which is called `what`, and a column for
/// each contender. `text` gets the label and the contender.
pub(super) fn label_table(
    suite: &SuiteData,
    title: &str,
    what: &str,
    contenders: &[&str],
    text: impl Fn(&str, &str) -> Option<String>,
) -> Table {
    let mut table = table_of(title, &[&format!("<{what}")], contenders);
    for label in suite.labels() {
        let cells = contenders.iter().map(|name| cell(name, text(label, name)));
        table.push([Cell::plain(label)].into_iter().chain(cells).collect());
    }
    push_refusals(&mut table, suite);
    table.note = format!("Scenes: {}.", suite.scenes().join(", "));
    table
}

/// Adds plots of quality by the label of a sweep, which is called `what`, a table with a row for each, and one with all
/// settings.
pub(super) fn show_labels(section: &mut Section, suite: &SuiteData, what: &str) {
    let contenders = suite.compared(metric::SSIM);
    for QualityPlot { metric, axis, caption } in QUALITY_PLOTS {
        let caption = format!("{caption} Means over the scenes.");
        let mut plot = Plot::rows(axis, Axis::new(axis)).caption(caption);
        for label in suite.labels() {
            for contender in &contenders {
                if let Some(value) = suite.mean_at(label, contender, metric) {
                    plot.mark(label, Entry::ours(*contender), value);
                }
            }
            let at = [metric::SSIM, metric::PSNR].iter().position(|name| *name == metric);
            if let (Some(papers), Some(at)) = (PAPER.styles.get(label), at) {
                plot.mark(label, papers_entry("yoro-paper"), papers[at]);
            }
        }
        section.plot(plot);
    }
    let title = "PSNR in dB / SSIM, means over the scenes";
    let mut table = label_table(suite, title, what, &contenders, |label, name| {
        let [psnr, ssim] = [metric::PSNR, metric::SSIM].map(|metric| suite.mean_at(label, name, metric));
        psnr_ssim(psnr, ssim)
    });
    let papers: Vec<_> = suite.labels().into_iter().map(|label| PAPER.styles.get(label)).collect();
    if papers.iter().any(Option::is_some) {
        let text = |[ssim, psnr]: &[f64; 2]| format!("{psnr:.1} / {ssim:.3}");
        let column = papers.into_iter().map(|papers| papers.map(text));
        add_papers_column(&mut table, "the paper's YORO", column.collect());
    }
    section.table(table);
    section.table(metric_table(suite, &format!("Every scene and {what} in full"), &contenders));
}

/// Adds a column with the paper's figures of a table's first rows. The last cell of the others spans it.
fn add_papers_column(table: &mut Table, name: &str, values: Vec<Option<String>>) {
    if let Some(mut column) = table.columns.last().cloned() {
        column.name = name.into();
        table.columns.push(column);
    }
    let mut values = values.into_iter();
    for line in &mut table.lines {
        match (values.next(), line.cells.last_mut()) {
            (Some(value), _) => line.cells.push(Cell::paper(value)),
            (None, Some(last)) => last.span += 1,
            _ => {}
        }
    }
}
