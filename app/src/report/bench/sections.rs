//! What is shown of each suite: figures with the paper's curves beside ours, and tables.

use super::data::{Measured, SettingData, Suite, geometric_mean, mean};
use crate::bench::{bandwidth, metric};
use crate::report::bd_rate::{bd_rate, line_through};
use crate::report::grid::{Cell, Table};
use crate::report::paper;
use crate::report::plot::{Axis, DotRow, Figure, Mark, Panel, Series};
use crate::report::short_count;

/// An experiment on the page.
#[derive(Debug)]
pub struct Section {
    /// Anchor, and beginning of the figures' names.
    pub id: String,
    /// Heading.
    pub title: String,
    /// What was done, and how the paper did it.
    pub intro: String,
    /// In the order to be shown.
    pub figures: Vec<Figure>,
    /// In the order to be shown.
    pub tables: Vec<Table>,
}

impl Section {
    fn new(id: &str, title: &str, intro: &str) -> Section {
        Section {
            id: id.into(),
            title: title.into(),
            intro: intro.into(),
            figures: Vec::new(),
            tables: Vec::new(),
        }
    }

    fn figure(&mut self, id: &str, title: &str, caption: &str, panel: Panel) {
        let (id, title, caption) = (format!("{}-{id}", self.id), title.into(), caption.into());
        let figure = Figure { id, title, caption, panel };
        if !figure.is_empty() {
            self.figures.push(figure);
        }
    }

    fn table(&mut self, table: Table) {
        if !table.lines.is_empty() {
            self.tables.push(table);
        }
    }
}

const CONVENTIONAL: &str = "conventional";
const MONO: &str = "mono";
const PAPERS: &str = "the paper's ";

type MakeSection = fn(&Suite) -> Section;

/// Suites by name in the paper's order, with what makes their sections. One suite can have several: the paper
/// looks at frame time, quality and overhead of the same eight scenes in three places.
const ORDER: [(&str, MakeSection); 13] = [
    ("scenes", frame_time),
    ("complexity", complexity),
    ("scenes", quality),
    ("scenes", overhead),
    ("lights", few_lights),
    ("styles", styles),
    ("ipd", ipd),
    ("distance", distance),
    ("patchers", patchers),
    ("imbuffer", imbuffer),
    ("resolution", resolution),
    ("flicker", flicker),
    ("bandwidth", bandwidth_section),
];

/// The sections of all suites in the paper's order, each with its suite; suites of other names come last.
pub fn sections(suites: &[Suite]) -> Vec<(&Suite, Section)> {
    let mut sections = Vec::new();
    for (name, make) in ORDER {
        sections.extend(suites.iter().filter(|suite| suite.name == name).map(|suite| (suite, make(suite))));
    }
    let known = |suite: &&Suite| ORDER.iter().any(|(name, _)| *name == suite.name);
    sections.extend(suites.iter().filter(|suite| !known(suite)).map(|suite| (suite, other(suite))));
    sections.retain(|(_, section)| !section.figures.is_empty() || !section.tables.is_empty());
    // The same experiment on another machine needs another anchor.
    let mut seen: Vec<String> = Vec::new();
    for (_, section) in &mut sections {
        let before = seen.iter().filter(|id| **id == section.id).count();
        seen.push(section.id.clone());
        if before > 0 {
            let id = format!("{}-{}", section.id, before + 1);
            for figure in &mut section.figures {
                figure.id = figure.id.replacen(&section.id, &id, 1);
            }
            section.id = id;
        }
    }
    sections
}

fn fixed(value: Option<f64>, decimals: usize) -> Option<String> {
    value.map(|value| format!("{value:.decimals$}"))
}

/// `530` or `12.3`: four digits say enough of a time.
fn milliseconds(value: f64) -> String {
    // No minus before a zero.
    let value = if value.abs() < 0.005 { 0.0 } else { value };
    if value >= 100.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}

fn percent(share: f64) -> String {
    format!("{:+.1} %", 100.0 * share)
}

fn psnr_ssim(measured: &Measured) -> Option<String> {
    let ssim = measured.mean(metric::SSIM)?;
    // Identical images have no finite PSNR.
    let psnr = fixed(measured.mean(metric::PSNR), 2).unwrap_or_else(|| "∞".into());
    Some(format!("{psnr} / {ssim:.4}"))
}

fn paper_scene(setting: &SettingData) -> Option<&'static paper::PaperScene> {
    paper::find(setting.stands_for())
}

/// A cell of ours, or of the baseline's if the contender is one.
fn cell(contender: &str, text: Option<String>) -> Cell {
    if [CONVENTIONAL, MONO].contains(&contender) { Cell::base(text) } else { Cell::ours(text) }
}

/// The paper's figure of the system that a method here stands for.
fn papers_mark(method: &str, value: f64) -> Mark {
    Mark::papers(method, format!("{PAPERS}{}", paper::system(method)), value)
}

/// A dot plot with a line for each setting.
fn scene_dots(
    suite: &Suite,
    axis: Axis,
    contenders: &[&str],
    value: impl Fn(&SettingData, &str) -> Option<f64>,
    papers: impl Fn(&SettingData) -> Vec<(&'static str, f64)>,
) -> Panel {
    let rows = suite.settings.iter().map(|setting| {
        let paper = papers(setting).into_iter().map(|(method, value)| papers_mark(method, value));
        // Of equal figures the first contender stays on top.
        let ours = contenders.iter().rev().filter_map(|name| {
            let value = value(setting, name)?;
            Some(Mark::new(*name, *name, value))
        });
        DotRow { label: setting.label(), marks: paper.chain(ours).collect() }
    });
    Panel::Dots { value: axis, rows: rows.collect() }
}

/// A table with a row for each setting and a column for each contender; then the mean, and those that were not
/// measured.
fn scene_table(
    suite: &Suite,
    title: &str,
    contenders: &[&str],
    text: impl Fn(&SettingData, &str) -> Option<String>,
    mean: impl Fn(&str) -> Option<String>,
    paper: (&str, impl Fn(&SettingData) -> Option<String>, Option<String>),
) -> Table {
    let mut columns = vec!["<scene".to_owned(), "triangles".to_owned()];
    columns.extend(contenders.iter().map(|name| name.to_string()));
    columns.push(paper.0.to_owned());
    let mut table = Table::new(title, &columns);
    for setting in &suite.settings {
        let mut cells = vec![Cell::plain(setting.label()), Cell::plain(triangles(setting))];
        for name in contenders {
            let refused = setting.unsupported.iter().any(|(other, _)| other == name);
            let text = text(setting, name).or_else(|| refused.then(|| "not measured".to_owned()));
            cells.push(cell(name, text));
        }
        cells.push(Cell::paper(paper.1(setting)));
        table.push(cells);
    }
    let mut cells = vec![Cell::plain(format!("mean of {}", suite.settings.len())), Cell::plain("")];
    cells.extend(contenders.iter().map(|name| cell(name, mean(name))));
    cells.push(Cell::paper(paper.2));
    table.push_first(cells);
    push_refusals(&mut table, suite);
    table
}

fn triangles(setting: &SettingData) -> String {
    setting.facts.as_ref().map_or_else(String::new, |facts| short_count(facts.triangles))
}

/// A row with the reason for each contender that could not take part, in the whole suite or in some settings.
fn push_refusals(table: &mut Table, suite: &Suite) {
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

/// Frame times of each contender in each setting, in full.
fn time_details(suite: &Suite, title: &str, ratio: impl Fn(&SettingData, &str) -> Option<f64>) -> Table {
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
    let mut table = Table::new(title, &columns);
    for setting in &suite.settings {
        let mut first = true;
        for measured in &setting.contenders {
            let Some(times) = measured.summary(metric::FRAME_MS) else { continue };
            let samples = measured.samples(metric::FRAME_MS);
            let quartile = |percent| crate::metrics::stats::percentile(&samples, percent).unwrap_or(f64::NAN);
            let cost = setting.cost(&measured.name);
            let cells = vec![
                Cell::plain(setting.label()),
                Cell::plain(&measured.name),
                Cell::plain(times.count.to_string()),
                cell(&measured.name, Some(milliseconds(times.median))),
                Cell::plain(format!("{} – {}", milliseconds(quartile(25.0)), milliseconds(quartile(75.0)))),
                Cell::plain(milliseconds(times.std)),
                Cell::plain(milliseconds(times.p95)),
                Cell::plain(milliseconds(times.p99)),
                cell(&measured.name, cost.map(|c| format!("{:.3}", c.median))),
                Cell::plain(
                    cost.map(|c| format!("{:.3} – {:.3}", c.quartiles[0], c.quartiles[1]))
                        .unwrap_or_default(),
                ),
                Cell::paper(fixed(ratio(setting, &measured.name), 3)),
            ];
            table.push_grouped(cells, std::mem::take(&mut first));
        }
    }
    push_refusals(&mut table, suite);
    table.note =
        "Ratio: frame time over that of conventional rendering, frame by frame within each interleaved \
                  round; its median and quartiles."
            .into();
    table
}

fn paper_ratios(setting: &SettingData) -> Vec<(&'static str, f64)> {
    paper_scene(setting).map_or_else(Vec::new, |scene| {
        vec![("yoro-paper", scene.frame_time_ratio()), ("hybrid", scene.fps_conventional / scene.fps_fink)]
    })
}

fn frame_time(suite: &Suite) -> Section {
    let mut section = Section::new(
        "frame-time",
        "Frame time",
        "A whole stereo frame by every method, on scenes that stand for the paper's eight. The paper measured \
         frame rates of its own scenes on six phones and a Quest 2; ratios can be held against each other, times \
         cannot.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    section.figure(
        "ratio",
        "Frame time over two full renders",
        "Less is better; the line is conventional rendering. The paper's from its frame rates (Figure “frame rate”).",
        scene_dots(
            suite,
            Axis::new("frame time / conventional").baseline(1.0),
            &contenders.iter().copied().filter(|name| *name != CONVENTIONAL).collect::<Vec<_>>(),
            |setting, name| setting.cost(name).map(|cost| cost.median),
            paper_ratios,
        ),
    );
    section.figure(
        "ms",
        "Frame time here",
        "Medians on this machine.",
        scene_dots(
            suite,
            Axis::new("frame time, ms").logarithmic(),
            &contenders,
            |setting, name| setting.find(name)?.median(metric::FRAME_MS),
            |_| Vec::new(),
        ),
    );
    let rows = suite.settings.iter().filter_map(paper_scene).map(|scene| {
        let systems = [
            ("hybrid", scene.fps_fink),
            (CONVENTIONAL, scene.fps_conventional),
            ("yoro-paper", scene.fps_yoro),
        ];
        let mark = |(method, fps): (&str, f64)| papers_mark(method, 1000.0 / fps);
        DotRow { label: scene.name.into(), marks: systems.map(mark).to_vec() }
    });
    section.figure(
        "paper-ms",
        "The paper's frame time",
        "1000 / frames a second: means over its seven devices, on its own scenes.",
        Panel::Dots { value: Axis::new("frame time, ms").from_zero(), rows: rows.collect() },
    );
    section.table(scene_table(
        suite,
        "Frame time over two full renders",
        &contenders,
        |setting, name| {
            let median = setting.cost(name)?.median;
            if name == CONVENTIONAL {
                let ms = setting.conventional()?.median(metric::FRAME_MS)?;
                return Some(format!("{} ms", milliseconds(ms)));
            }
            Some(format!("{median:.2}"))
        },
        |name| {
            let costs =
                suite.settings.iter().filter_map(|setting| Some(setting.cost(name)?.median)).collect();
            fixed(geometric_mean(costs), 2)
        },
        (
            "the paper's YORO",
            |setting| {
                let scene = paper_scene(setting)?;
                Some(format!("{}: {:.2}", scene.name, scene.frame_time_ratio()))
            },
            Some(format!("{:.2}", paper::AVERAGE.frame_time_ratio())),
        ),
    ));
    let papers = |setting: &SettingData, name: &str| {
        paper_ratios(setting).into_iter().find(|(method, _)| *method == name).map(|(_, ratio)| ratio)
    };
    section.table(time_details(suite, "Frame times in full", papers));
    section
}

fn complexity(suite: &Suite) -> Section {
    let mut section = Section::new(
        "complexity",
        "Complexity",
        "Frame time against the number of triangles of one scene. The slope is the cost of a million triangles \
         more, by least squares; what synthesis costs does not depend on the scene.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    let times = |name: &str| -> Vec<(f64, f64)> {
        let curve = suite.curve(|setting| setting.find(name)?.median(metric::FRAME_MS));
        curve.into_iter().map(|(triangles, ms)| (triangles / 1e6, ms)).collect()
    };
    let papers = |points: &[f64]| -> Vec<(f64, f64)> {
        paper::COMPLEXITY.triangles.iter().copied().zip(points.iter().copied()).collect()
    };
    let paper_series = |value: &dyn Fn(usize, f64) -> f64| -> Vec<Series> {
        let series = paper::COMPLEXITY.systems.iter().map(|(method, points)| Series {
            method: (*method).into(),
            papers: true,
            label: format!("{PAPERS}{}", paper::system(method)),
            points: papers(&points.iter().enumerate().map(|(i, ms)| value(i, *ms)).collect::<Vec<_>>()),
        });
        series.collect()
    };
    let ours = |value: &dyn Fn(&str) -> Vec<(f64, f64)>| -> Vec<Series> {
        let series = contenders.iter().rev().map(|name| Series {
            method: (*name).into(),
            papers: false,
            label: (*name).into(),
            points: value(name),
        });
        series.collect()
    };
    let x = || Axis::new("triangles, millions").from_zero();
    let y = || Axis::new("frame time, ms").from_zero();
    let time_curves = Panel::Curves { x: x(), y: y(), series: ours(&times) };
    section.figure("ms", "Frame time here", "Medians on this machine.", time_curves);
    let curves = Panel::Curves { x: x(), y: y(), series: paper_series(&|_, ms| ms) };
    section.figure("paper-ms", "The paper's frame time", "Means over its devices, its own scene.", curves);
    let ratio = |name: &str| -> Vec<(f64, f64)> {
        let curve = suite.curve(|setting| setting.cost(name).map(|cost| cost.median));
        curve.into_iter().map(|(triangles, ratio)| (triangles / 1e6, ratio)).collect()
    };
    let conventional = paper::COMPLEXITY.systems[1].1;
    let mut series = paper_series(&|i, ms| ms / conventional[i]);
    series.extend(ours(&ratio));
    series.retain(|series| series.method != CONVENTIONAL);
    let y = Axis::new("frame time / conventional").baseline(1.0);
    let curves = Panel::Curves { x: x(), y, series };
    section.figure(
        "ratio",
        "Frame time over two full renders",
        "The line is conventional rendering.",
        curves,
    );

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
    let base = line_through(&times(CONVENTIONAL)).map(|(_, slope)| slope);
    let paper_base = line_through(&papers(&conventional)).map(|(_, slope)| slope);
    for name in &contenders {
        let fit = line_through(&times(name));
        let system = paper::COMPLEXITY.systems.iter().find(|(method, _)| method == name);
        let paper_slope =
            system.and_then(|(_, points)| line_through(&papers(points))).map(|(_, slope)| slope);
        let share = |slope: Option<f64>, base: Option<f64>| fixed(slope.zip(base).map(|(s, b)| s / b), 3);
        let slope = fit.map(|(_, slope)| slope);
        let paper_ratio = system.and_then(|(_, points)| {
            mean(points.iter().zip(conventional).map(|(ms, conventional)| ms / conventional).collect())
        });
        table.push(vec![
            Cell::plain(*name),
            cell(name, slope.map(milliseconds)),
            Cell::plain(fit.map(|(offset, _)| milliseconds(offset)).unwrap_or_default()),
            cell(name, share(slope, base)),
            cell(name, fixed(geometric_mean(ratio(name).into_iter().map(|p| p.1).collect()), 3)),
            Cell::paper(paper_slope.map(milliseconds)),
            Cell::paper(share(paper_slope, paper_base)),
            Cell::paper(fixed(paper_ratio, 3)),
        ]);
    }
    push_refusals(&mut table, suite);
    table.note =
        "The paper's slopes by least squares from its nine points. Its “51.40 %” leaves out the smallest \
                  scene; the ratio here is the mean over all nine."
            .into();
    section.table(table);
    section.table(sweep_table(suite, "Median frame time, ms", metric::FRAME_MS, "triangles", |point| {
        short_count(point as u64)
    }));
    section
}

/// A table with a row for each point of a sweep and a column for each contender, means over the scenes; medians
/// of times.
fn sweep_table(
    suite: &Suite,
    title: &str,
    metric_name: &str,
    quantity: &str,
    label: impl Fn(f64) -> String,
) -> Table {
    let contenders = suite.measured(metric_name);
    let mut columns = vec![quantity.to_owned()];
    columns.extend(contenders.iter().map(|name| name.to_string()));
    let mut table = Table::new(title, &columns);
    let times = metric_name.ends_with("_ms");
    for point in suite.points() {
        let mut cells = vec![Cell::plain(label(point))];
        for name in &contenders {
            let here = suite.settings.iter().filter(|setting| setting.setting.point == Some(point));
            let value = |setting: &SettingData| {
                let measured = setting.find(name)?;
                if times { measured.median(metric_name) } else { measured.mean(metric_name) }
            };
            let value = mean(here.filter_map(value).collect());
            let decimals = if metric_name.contains("ssim") { 4 } else { 2 };
            let text = if times { value.map(milliseconds) } else { fixed(value, decimals) };
            cells.push(cell(name, text));
        }
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    table
}

/// The eye that is not dominant, by metric, for the page's figures.
const QUALITY_FIGURES: [(&str, &str, &str); 3] = [
    (metric::PSNR, "PSNR, dB", "More is better."),
    (metric::SSIM, "SSIM, gaussian 11x11", "More is better."),
    (metric::FLIP, "FLIP, 0 to 1", "Less is better. The paper has none."),
];

fn paper_quality(scene: &paper::PaperScene, name: &str) -> Option<f64> {
    match name {
        metric::PSNR => Some(scene.psnr),
        metric::SSIM => Some(scene.ssim),
        _ => None,
    }
}

fn quality(suite: &Suite) -> Section {
    let mut section = Section::new(
        "quality",
        "Image quality",
        "The eye that is not dominant, against the same eye really rendered. “mono” shows the dominant eye's image to both: the baseline of doing nothing, \
         without which no figure says much.",
    );
    quality_figures(&mut section, suite);
    // The ground truth has no likeness to itself worth a column.
    let contenders: Vec<&str> =
        suite.measured(metric::SSIM).into_iter().filter(|name| *name != CONVENTIONAL).collect();
    let mean_of = |name: &str| {
        let ssim = mean(suite.values(name, |measured| measured.mean(metric::SSIM)))?;
        let psnr = fixed(mean(suite.values(name, |measured| measured.mean(metric::PSNR))), 2);
        Some(format!("{} / {ssim:.4}", psnr.unwrap_or_else(|| "∞".into())))
    };
    let average = paper::AVERAGE;
    let mut table = scene_table(
        suite,
        "PSNR in dB / SSIM",
        &contenders,
        |setting, name| psnr_ssim(setting.find(name)?),
        mean_of,
        (
            "the paper's YORO",
            |setting| {
                let scene = paper_scene(setting)?;
                Some(format!("{}: {:.2} / {:.4}", scene.name, scene.psnr, scene.ssim))
            },
            Some(format!("{:.2} / {:.4}", average.psnr, average.ssim)),
        ),
    );
    table.note = "RGB; SSIM with a gaussian window 11x11. ∞: identical images.".into();
    section.table(table);
    section.table(parts_table(suite, &contenders));
    section.table(metric_table(suite, "Every scene and method in full", &contenders));
    section
}

fn quality_figures(section: &mut Section, suite: &Suite) {
    for (name, axis, caption) in QUALITY_FIGURES {
        let contenders: Vec<&str> =
            suite.measured(name).into_iter().filter(|name| *name != CONVENTIONAL).collect();
        let panel = scene_dots(
            suite,
            Axis::new(axis),
            &contenders,
            |setting, contender| setting.find(contender)?.mean(name),
            |setting| {
                let value = paper_scene(setting).and_then(|scene| paper_quality(scene, name));
                value.map(|value| ("yoro-paper", value)).into_iter().collect()
            },
        );
        section.figure(name, axis, caption, panel);
    }
}

/// Quality in holes and elsewhere, means over the scenes.
fn parts_table(suite: &Suite, contenders: &[&str]) -> Table {
    let columns = [
        ("PSNR, dB", metric::PSNR, 2),
        ("SSIM", metric::SSIM, 4),
        ("SSIM 7x7", metric::SSIM_UNIFORM, 4),
        ("PSNR of luma, dB", metric::PSNR_LUMA, 2),
        ("SSIM of luma", metric::SSIM_LUMA, 4),
        ("FLIP", metric::FLIP, 4),
        ("holes: PSNR, dB", metric::HOLE_PSNR, 2),
        ("holes: SSIM", metric::HOLE_SSIM, 4),
        ("holes: FLIP", metric::HOLE_FLIP, 4),
        ("elsewhere: PSNR, dB", metric::VISIBLE_PSNR, 2),
        ("elsewhere: SSIM", metric::VISIBLE_SSIM, 4),
        ("elsewhere: FLIP", metric::VISIBLE_FLIP, 4),
    ];
    let mut table = means_table(suite, "Holes and the rest, means over the scenes", contenders, &columns);
    let shares: Vec<f64> = suite
        .contenders()
        .iter()
        .flat_map(|name| suite.values(name, |m| m.mean(metric::HOLE_SHARE)))
        .collect();
    if let Some(share) = mean(shares) {
        table.note = format!(
            "Holes: what the dominant eye's own image does not show, {:.2} % of the pixels. FLIP: less is better.",
            100.0 * share
        );
    }
    table
}

fn flicker(suite: &Suite) -> Section {
    let mut section = Section::new(
        "flicker",
        "Flicker",
        "Change of the synthesized eye from frame to frame, along a piece of the camera path at walking pace, that \
         the really rendered eye does not have. The paper has none.",
    );
    for (id, title, name) in [
        ("all", "Flicker of all pixels", metric::FLICKER),
        ("holes", "Flicker in holes", metric::FLICKER_HOLES),
        ("edges", "Flicker at edges", metric::FLICKER_EDGES),
    ] {
        let panel = scene_dots(
            suite,
            Axis::new("flicker, of 255").from_zero(),
            &suite.measured(name),
            |setting, contender| setting.find(contender)?.mean(name),
            |_| Vec::new(),
        );
        section.figure(id, title, "Less is better.", panel);
    }
    let columns = [
        ("all", metric::FLICKER, 3),
        ("in holes", metric::FLICKER_HOLES, 3),
        ("at edges", metric::FLICKER_EDGES, 3),
        ("elsewhere", metric::FLICKER_REST, 3),
    ];
    let mut table = means_table(
        suite,
        "Flicker, of 255, means over the scenes",
        &suite.measured(metric::FLICKER),
        &columns,
    );
    let changes = [metric::CHANGE, metric::CHANGE_HOLES, metric::CHANGE_EDGES, metric::CHANGE_REST];
    let changes = changes.map(|name| mean(suite.values(CONVENTIONAL, |measured| measured.mean(name))));
    if changes.iter().any(Option::is_some) {
        let mut cells = vec![Cell::plain("the scene's own change")];
        cells.extend(changes.map(|change| Cell::base(fixed(change, 3))));
        cells.truncate(table.columns.len());
        table.push_first(cells);
    }
    section.table(table);
    let of_scenes = ("", |_: &SettingData| None, None);
    let contenders = suite.measured(metric::FLICKER);
    let mut table = scene_table(
        suite,
        "Flicker of all pixels / in holes",
        &contenders,
        |setting, name| {
            let measured = setting.find(name)?;
            let holes = fixed(measured.mean(metric::FLICKER_HOLES), 2).unwrap_or_else(|| "–".into());
            Some(format!("{:.2} / {holes}", measured.mean(metric::FLICKER)?))
        },
        |name| fixed(mean(suite.values(name, |measured| measured.mean(metric::FLICKER))), 2),
        of_scenes,
    );
    table.drop_last_column();
    section.table(table);
    section
}

/// A row for each contender and a column for each metric that was measured, means over the settings.
fn means_table(suite: &Suite, title: &str, contenders: &[&str], metrics: &[(&str, &str, usize)]) -> Table {
    let measured: Vec<_> =
        metrics.iter().filter(|(_, name, _)| !suite.measured(name).is_empty()).copied().collect();
    let mut columns = vec!["<method"];
    columns.extend(measured.iter().map(|(column, _, _)| *column));
    let mut table = Table::new(title, &columns);
    if measured.is_empty() {
        return table;
    }
    for name in contenders {
        let mut cells = vec![Cell::plain(*name)];
        for (_, metric_name, decimals) in &measured {
            cells.push(cell(name, fixed(mean(suite.values(name, |m| m.mean(metric_name))), *decimals)));
        }
        table.push(cells);
    }
    for name in suite.contenders() {
        if let Some(reason) = suite.reason(name) {
            table.push_reason(vec![Cell::plain(name)], reason);
        }
    }
    table
}

/// A row for each setting and contender, a column for each metric: the long form, so that no figure is lost.
fn metric_table(suite: &Suite, title: &str, contenders: &[&str]) -> Table {
    let metrics = [
        ("PSNR, dB", metric::PSNR, 2),
        ("SSIM", metric::SSIM, 4),
        ("SSIM 7x7", metric::SSIM_UNIFORM, 4),
        ("FLIP", metric::FLIP, 4),
        ("holes: share, %", metric::HOLE_SHARE, 2),
        ("holes: PSNR, dB", metric::HOLE_PSNR, 2),
        ("holes: SSIM", metric::HOLE_SSIM, 4),
        ("elsewhere: PSNR, dB", metric::VISIBLE_PSNR, 2),
        ("elsewhere: SSIM", metric::VISIBLE_SSIM, 4),
        ("flicker", metric::FLICKER, 3),
        ("flicker in holes", metric::FLICKER_HOLES, 3),
    ];
    let measured: Vec<_> = metrics.iter().filter(|(_, name, _)| !suite.measured(name).is_empty()).collect();
    let mut columns = vec!["<scene", "<method"];
    columns.extend(measured.iter().map(|(column, _, _)| *column));
    let mut table = Table::new(title, &columns);
    for setting in &suite.settings {
        let mut first = true;
        for name in contenders {
            let Some(of) = setting.find(name) else { continue };
            let mut cells = vec![Cell::plain(setting.label()), Cell::plain(*name)];
            for (_, metric_name, decimals) in &measured {
                let scale = if *metric_name == metric::HOLE_SHARE { 100.0 } else { 1.0 };
                cells.push(cell(name, fixed(of.mean(metric_name).map(|value| value * scale), *decimals)));
            }
            table.push_grouped(cells, std::mem::take(&mut first));
        }
    }
    push_refusals(&mut table, suite);
    table
}

fn overhead(suite: &Suite) -> Section {
    let mut section = Section::new(
        "overhead",
        "Overhead",
        "CPU time and memory of a stereo frame. The paper gives the load of the CPU in percent and the memory of \
         its applications; power and temperature are a phone's matter.",
    );
    let contenders = suite.measured(metric::CPU_MS);
    let others: Vec<&str> = contenders.iter().copied().filter(|name| *name != CONVENTIONAL).collect();
    let papers = |value: fn(&paper::Overhead) -> [f64; 3]| {
        move |setting: &SettingData| -> Vec<(&'static str, f64)> {
            let scene = paper::SCENES.iter().position(|scene| scene.name == setting.stands_for());
            let Some(scene) = scene else { return Vec::new() };
            let values = value(&paper::OVERHEAD[scene]);
            let ratios = paper::OVERHEAD_METHODS.iter().zip(values).map(|(name, v)| (*name, v / values[1]));
            ratios.filter(|(name, _)| *name != CONVENTIONAL).collect()
        }
    };
    section.figure(
        "cpu",
        "CPU time over two full renders",
        "CPU time of a stereo frame, all threads together; where the CPU also rasterizes, that is in it. The \
         paper's: CPU load over conventional rendering's.",
        scene_dots(
            suite,
            Axis::new("CPU time / conventional").baseline(1.0),
            &others,
            |setting, name| Some(setting.find(name)?.ratio(setting.conventional()?, metric::CPU_MS)?.median),
            papers(|o| o.cpu),
        ),
    );
    section.figure(
        "memory",
        "Memory over two full renders",
        "Of the process with the scene and the textures of one method. The paper's: memory of its applications over conventional rendering's.",
        scene_dots(
            suite,
            Axis::new("memory / conventional"),
            &others,
            |setting, name| {
                let base = setting.conventional()?.mean(metric::MEMORY_MIB)?;
                Some(setting.find(name)?.mean(metric::MEMORY_MIB)? / base)
            },
            papers(|o| o.memory),
        ),
    );
    let columns = [
        ("CPU time, ms", metric::CPU_MS, 1),
        ("memory, MiB", metric::MEMORY_MIB, 1),
        ("textures of the method, MiB", metric::TEXTURE_MIB, 1),
        ("GPU time, ms", metric::GPU_MS, 3),
    ];
    section.table(means_table(suite, "Means over the scenes", &contenders, &columns));
    section.table(pass_table(suite));
    section
}

/// Times of passes, medians over the scenes' medians.
fn pass_table(suite: &Suite) -> Table {
    let mut passes: Vec<String> = Vec::new();
    for measured in suite.settings.iter().flat_map(|setting| &setting.contenders) {
        for name in measured.metrics() {
            let pass = name.strip_prefix(metric::PASS_MS);
            passes.extend(pass.map(str::to_owned).filter(|pass| !passes.contains(pass)));
        }
    }
    let mut columns = vec!["<pass, ms".to_owned()];
    let contenders: Vec<&str> = suite
        .contenders()
        .into_iter()
        .filter(|name| {
            passes.iter().any(|pass| !suite.values(name, |m| m.median(&pass_metric(pass))).is_empty())
        })
        .collect();
    columns.extend(contenders.iter().map(|name| name.to_string()));
    let mut table = Table::new("Time of each pass, means over the scenes of the medians", &columns);
    for pass in &passes {
        let mut cells = vec![Cell::plain(pass)];
        for name in &contenders {
            cells.push(cell(name, fixed(mean(suite.values(name, |m| m.median(&pass_metric(pass)))), 2)));
        }
        table.push(cells);
    }
    table.note = match suite.header.pass_clock {
        crate::bench::record::PassClock::TimerQueries => "GPU time by timer queries.".into(),
        crate::bench::record::PassClock::Finish => {
            "Wall clock with glFinish around each pass, on frames of their own: a CPU rasterizer's timer queries \
             are unusable."
                .into()
        }
    };
    table
}

fn pass_metric(pass: &str) -> String {
    format!("{}{pass}", metric::PASS_MS)
}

fn few_lights(suite: &Suite) -> Section {
    let mut section = Section::new(
        "few-lights",
        "Few lights",
        "The paper's setting for single-pass instancing: fewer than five lights, basic post-processing. It gives \
         means over scenes and devices only.",
    );
    let contenders = suite.measured(metric::FRAME_MS);
    let others: Vec<&str> = contenders.iter().copied().filter(|name| *name != CONVENTIONAL).collect();
    let conventional_fps = paper::FEW_LIGHTS[1].1;
    let mut panel = scene_dots(
        suite,
        Axis::new("frame time / conventional").baseline(1.0),
        &others,
        |setting, name| setting.cost(name).map(|cost| cost.median),
        |_| Vec::new(),
    );
    if let Panel::Dots { rows, .. } = &mut panel {
        let papers = paper::FEW_LIGHTS.iter().filter(|(method, ..)| *method != CONVENTIONAL);
        let papers = papers.map(|(method, fps, _)| papers_mark(method, conventional_fps / fps));
        let ours = others.iter().rev().filter_map(|name| {
            let costs =
                suite.settings.iter().filter_map(|setting| Some(setting.cost(name)?.median)).collect();
            let value = geometric_mean(costs)?;
            Some(Mark::new(*name, *name, value))
        });
        let marks = papers.chain(ours).collect();
        rows.push(DotRow { label: "mean".into(), marks });
    }
    section.figure("ratio", "Frame time over two full renders", "The line is conventional rendering.", panel);
    section.table(scene_table(
        suite,
        "Frame time over two full renders",
        &contenders,
        |setting, name| fixed(setting.cost(name).map(|cost| cost.median), 2),
        |name| {
            let costs =
                suite.settings.iter().filter_map(|setting| Some(setting.cost(name)?.median)).collect();
            fixed(geometric_mean(costs), 2)
        },
        (
            "the paper's means",
            |_| None,
            Some(
                paper::FEW_LIGHTS
                    .map(|(method, fps, _)| {
                        format!("{} {:.2}", paper::system(method), conventional_fps / fps)
                    })
                    .join(", "),
            ),
        ),
    ));
    section.table(time_details(suite, "Frame times in full", |_, _| None));
    section
}

fn styles(suite: &Suite) -> Section {
    let mut section = Section::new(
        "styles",
        "Shading styles",
        "The same synthesis under five styles of shading. In the paper each style is another scene of its own.",
    );
    let with_style = |style: &str| -> Vec<&SettingData> {
        suite.settings.iter().filter(|setting| setting.setting.label.as_deref() == Some(style)).collect()
    };
    let value = |style: &str, contender: &str, name: &str| {
        mean(with_style(style).iter().filter_map(|setting| setting.find(contender)?.mean(name)).collect())
    };
    let paper_style = |style: &str| paper::STYLES.iter().find(|(name, ..)| *name == style);
    let contenders: Vec<&str> =
        suite.measured(metric::SSIM).into_iter().filter(|name| *name != CONVENTIONAL).collect();
    for (name, axis, caption) in QUALITY_FIGURES {
        let rows = suite.labels().into_iter().map(|style| {
            let paper = paper_style(style).and_then(|(_, ssim, psnr)| match name {
                metric::SSIM => Some(*ssim),
                metric::PSNR => Some(*psnr),
                _ => None,
            });
            let paper = paper.map(|value| papers_mark("yoro-paper", value));
            let ours = contenders.iter().rev().filter_map(|contender| {
                let value = value(style, contender, name)?;
                Some(Mark::new(*contender, *contender, value))
            });
            DotRow { label: style.into(), marks: paper.into_iter().chain(ours).collect() }
        });
        let panel = Panel::Dots { value: Axis::new(axis), rows: rows.collect() };
        section.figure(name, axis, &format!("{caption} Means over the scenes."), panel);
    }
    let mut columns = vec!["<style"];
    columns.extend(&contenders);
    columns.push("the paper's YORO");
    let mut table = Table::new("PSNR in dB / SSIM, means over the scenes", &columns);
    for style in suite.labels() {
        let mut cells = vec![Cell::plain(style)];
        for name in &contenders {
            let pair = value(style, name, metric::PSNR).zip(value(style, name, metric::SSIM));
            cells.push(cell(name, pair.map(|(psnr, ssim)| format!("{psnr:.2} / {ssim:.4}"))));
        }
        cells.push(Cell::paper(paper_style(style).map(|(_, ssim, psnr)| format!("{psnr:.1} / {ssim:.3}"))));
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    table.note = format!("Scenes: {}.", suite.scenes().join(", "));
    section.table(table);
    section.table(metric_table(suite, "Every scene and style in full", &contenders));
    section
}

/// Curves of quality over a sweep, with the paper's where it has some.
fn quality_sweep(
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
            table.columns.push(crate::report::grid::Column { name: "the paper's YORO".into(), left: false });
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

fn ipd(suite: &Suite) -> Section {
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

fn distance(suite: &Suite) -> Section {
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

fn patchers(suite: &Suite) -> Section {
    let mut section = Section::new(
        "patchers",
        "Patchers",
        "What fills the holes of the same reprojected image. The paper's times are a phone's; its GAN runs on the \
         CPU there.",
    );
    let contenders = suite.measured(metric::SSIM);
    let paper_of = |name: &str| {
        let name = name.strip_prefix("patcher-").unwrap_or(name);
        paper::PATCHERS.iter().find(|patcher| patcher.name == name)
    };
    let dots = |axis: Axis, ours: &dyn Fn(&str) -> Option<f64>, papers: fn(&paper::PaperPatcher) -> f64| {
        // The patcher is the row; colours say whose figure it is.
        let mark = |papers: bool, value: f64| match papers {
            true => Mark::papers("yoro-paper", "the paper's", value),
            false => Mark::new("yoro-gather", "here", value),
        };
        let rows = contenders.iter().map(|name| {
            let paper = paper_of(name).map(|patcher| mark(true, papers(patcher)));
            let ours = ours(name).map(|value| mark(false, value));
            DotRow { label: (*name).into(), marks: paper.into_iter().chain(ours).collect() }
        });
        Panel::Dots { value: axis, rows: rows.collect() }
    };
    let of_suite = |metric_name: &'static str| {
        move |name: &str| mean(suite.values(name, |measured| measured.mean(metric_name)))
    };
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
        let value = |metric_name| mean(suite.values(name, |measured| measured.mean(metric_name)));
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

fn imbuffer(suite: &Suite) -> Section {
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

fn resolution(suite: &Suite) -> Section {
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

/// Curves and a table of the frame time over a sweep.
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

/// The share of the anchor's qualities that a curve must reach to be compared.
const LEAST_OVERLAP: f64 = 0.1;

/// Rate and both eyes' mean quality of a stream, by quantizer.
fn rate_points(setting: &SettingData, stream: &str, metrics: [&str; 2]) -> Vec<(f64, f64)> {
    let Some(measured) = setting.find(stream) else { return Vec::new() };
    let rates = measured.by_frame(bandwidth::metric::KBIT_S);
    let quality = metrics.map(|name| measured.by_frame(name));
    let points = rates.iter().zip(quality[0]).zip(quality[1]);
    let mut points: Vec<(f64, f64)> =
        points.filter_map(|((rate, a), b)| Some(((*rate)?, ((*a)? + (*b)?) / 2.0))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

fn bandwidth_section(suite: &Suite) -> Section {
    use bandwidth::{STEREO_RGB, metric::*};
    let mut section = Section::new(
        "bandwidth",
        "Bandwidth",
        "H.264 of one eye and its depth, from which the receiver synthesizes the other eye, against H.264 of both \
         eyes. The paper compares bit rates alone; at one quantizer the two do not look the same, so that the \
         quality of both eyes after decoding is measured here, and rates are compared at equal quality.",
    );
    let streams = suite.measured(KBIT_S);
    let both_luma = [PSNR_LUMA_DOMINANT, PSNR_LUMA_OTHER];
    let both_rgb = [PSNR_DOMINANT, PSNR_OTHER];
    let both_ssim = [SSIM_DOMINANT, SSIM_OTHER];
    for setting in &suite.settings {
        let series = streams.iter().rev().map(|name| Series {
            method: (*name).into(),
            papers: false,
            label: (*name).into(),
            points: rate_points(setting, name, both_luma),
        });
        let panel = Panel::Curves {
            x: Axis::new("bit rate, kbit/s").logarithmic(),
            y: Axis::new("luma PSNR of both eyes, dB"),
            series: series.collect(),
        };
        let scene = setting.label();
        let caption = "Mean of both eyes after decoding, against the uncompressed renders.";
        section.figure(&super::slug(&scene), &format!("Rate and distortion: {scene}"), caption, panel);
    }
    section.table(rate_table(suite));

    let columns = [
        "<scene",
        "<stream",
        "by luma PSNR",
        "over dB",
        "by RGB PSNR",
        "over dB",
        "by SSIM",
        "over",
        "best luma PSNR of the other eye, dB",
    ];
    let mut equal = Table::new("Bit rate at equal quality against stereo RGB (BD-rate)", &columns);
    for setting in &suite.settings {
        for (i, name) in streams.iter().filter(|name| **name != STEREO_RGB).enumerate() {
            // Over a sliver of common quality the fitted curves say nothing.
            let compare = |metrics: [&str; 2]| {
                let (anchor, tested) =
                    (rate_points(setting, STEREO_RGB, metrics), rate_points(setting, name, metrics));
                bd_rate(&anchor, &tested).filter(|bd| bd.overlap >= LEAST_OVERLAP)
            };
            let mut cells = vec![Cell::plain(setting.label()), Cell::plain(*name)];
            for (metrics, decimals) in [(both_luma, 1), (both_rgb, 1), (both_ssim, 3)] {
                let bd = compare(metrics);
                let share = bd.map_or_else(|| "no quality in common".to_owned(), |bd| percent(bd.share));
                cells.push(Cell::ours(Some(share)));
                let over = bd.map(|bd| format!("{:.2$} – {:.2$}", bd.quality[0], bd.quality[1], decimals));
                cells.push(Cell::plain(over.unwrap_or_default()));
            }
            let best = rate_points(setting, name, [PSNR_LUMA_OTHER; 2]).into_iter().map(|p| p.1);
            cells.push(Cell::ours(fixed(best.reduce(f64::max), 2)));
            equal.push_grouped(cells, i == 0);
        }
    }
    equal.note = "Bjøntegaard's mean difference by the mean quality of both eyes; negative: fewer bits than stereo RGB for \
                  the same quality. A curve counts only over the qualities that both reach: what synthesis cannot \
                  show, no bit rate buys."
        .into();
    section.table(equal);
    section
}

/// Bit rates at one quantizer, as the paper compares them.
fn rate_table(suite: &Suite) -> Table {
    use bandwidth::{RGB_DEPTH, STEREO_RGB, metric::*};
    let columns = [
        "<scene",
        "QP",
        "stereo RGB, kbit/s",
        "RGB + depth, kbit/s",
        "of it depth",
        "difference",
        "stereo RGB: luma PSNR, dB",
        "RGB + depth: luma PSNR, dB",
        "the paper's stereo RGB",
        "the paper's RGB + depth",
        "the paper's difference",
    ];
    let mut table = Table::new("Bit rate at one quantizer", &columns);
    let mut differences = Vec::new();
    for setting in &suite.settings {
        let Some((stereo, depth)) = setting.find(STEREO_RGB).zip(setting.find(RGB_DEPTH)) else { continue };
        let paper = paper::BANDWIDTH.iter().find(|(name, ..)| *name == setting.stands_for());
        for (i, quantizer) in stereo.by_frame(QP).iter().enumerate() {
            let value = |measured: &Measured, name: &str| measured.by_frame(name).get(i).copied().flatten();
            let both = |measured: &Measured| {
                Some((value(measured, PSNR_LUMA_DOMINANT)? + value(measured, PSNR_LUMA_OTHER)?) / 2.0)
            };
            let rates = (value(stereo, KBIT_S), value(depth, KBIT_S));
            let difference = rates.0.zip(rates.1).map(|(stereo, depth)| depth / stereo - 1.0);
            differences.extend(difference);
            let paper = paper.filter(|_| i == 0);
            let cells = vec![
                Cell::plain(setting.label()),
                Cell::plain(quantizer.map(|qp| qp.to_string()).unwrap_or_default()),
                Cell::base(fixed(rates.0, 0)),
                Cell::ours(fixed(rates.1, 0)),
                Cell::plain(fixed(value(depth, KBIT_S_DEPTH), 0).unwrap_or_default()),
                Cell::ours(difference.map(percent)),
                Cell::base(fixed(both(stereo), 2)),
                Cell::ours(fixed(both(depth), 2)),
                Cell::paper(fixed(paper.map(|p| p.2), 0)),
                Cell::paper(fixed(paper.map(|p| p.1), 0)),
                Cell::paper(paper.map(|p| percent(p.1 / p.2 - 1.0))),
            ];
            table.push_grouped(cells, i == 0);
        }
    }
    push_refusals(&mut table, suite);
    let papers = mean(paper::BANDWIDTH.iter().map(|(_, depth, stereo)| depth / stereo - 1.0).collect());
    table.note = format!(
        "Mean difference here {}; the paper's {}. The paper names neither quantizer nor resolution: its rates stand \
         in each scene's first row.",
        mean(differences).map_or_else(|| "–".into(), percent),
        papers.map_or_else(|| "–".into(), percent),
    );
    table
}

/// Every metric of a suite that has no section of its own.
fn other(suite: &Suite) -> Section {
    let mut section = Section::new(&super::slug(&suite.name), &format!("Suite {}", suite.name), "");
    let mut metrics: Vec<&str> = Vec::new();
    for measured in suite.settings.iter().flat_map(|setting| &setting.contenders) {
        for name in measured.metrics() {
            if !metrics.contains(&name) {
                metrics.push(name);
            }
        }
    }
    let mut columns = vec!["<setting", "<method"];
    columns.extend(&metrics);
    let mut table = Table::new("Means", &columns);
    for setting in &suite.settings {
        for measured in &setting.contenders {
            let mut cells = vec![Cell::plain(setting.label()), Cell::plain(&measured.name)];
            cells.extend(metrics.iter().map(|name| cell(&measured.name, fixed(measured.mean(name), 4))));
            table.push(cells);
        }
    }
    push_refusals(&mut table, suite);
    section.table(table);
    section
}
