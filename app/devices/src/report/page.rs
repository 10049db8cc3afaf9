//! The report's sentences, tables and figures.

use std::fmt::Write as _;

use minijinja::context;
use serde::Serialize;

use super::run::{COUNTER_TOLERANCE, LEAST_COVERED, PAPER_VOLTS};
use super::{CONFIDENCE, Device, DeviceReport, Difference, Note, Quantity, Run};
use yoro_figures::ReportError;
use yoro_figures::grid::{Cell, Table};
use yoro_figures::inference::{Basis, BlockInterval, Interval};
use yoro_figures::page::{Template, figures, fill};
use yoro_figures::paper;
use yoro_figures::plot::{Axis, DotRow, Figure, Mark, Panel, Series};
use yoro_scenes::BUILTINS;

/// Where the scenes of a device are taken together.
const ALL_SCENES: &str = "all scenes";
/// Behind an interval that rests on scenes or devices.
const OVER_BLOCKS: &str = " †";

const FIRST_HALF: [Quantity; 5] =
    [Quantity::Power, Quantity::Fps, Quantity::Stale, Quantity::FrameTime, Quantity::FrameTimeP99];
const SECOND_HALF: [Quantity; 5] =
    [Quantity::GpuTime, Quantity::Temperature, Quantity::Rise, Quantity::Cpu, Quantity::Memory];

const TEMPLATE: Template =
    Template { name: "device.html.j2", text: include_str!("../templates/device.html.j2") };

pub(super) fn html(report: &DeviceReport) -> Result<String, ReportError> {
    let device = |(index, device): (usize, &Device)| -> Result<minijinja::Value, ReportError> {
        let traces = device.scenes.iter().enumerate().map(|(scene, name)| {
            let traces = trace_figures(report, device, &format!("device-{index}-scene-{scene}"), name);
            Ok(context! { scene => name, figures => figures(&traces)? })
        });
        Ok(context! {
            id => format!("device-{index}"),
            name => &device.name,
            facts => facts(report, device),
            figures => figures(&change_figures(report, device, &format!("device-{index}")))?,
            tables => device_tables(report, device),
            traces => traces.collect::<Result<Vec<_>, ReportError>>()?,
        })
    };
    let page = context! {
        simulated => report.simulated,
        baseline => &report.baseline,
        warnings => warnings(report),
        answers => answers(report),
        overview => overview_tables(report),
        devices => report.devices.iter().enumerate().map(device).collect::<Result<Vec<_>, _>>()?,
        left_out => notes_table("What does not count", &report.left_out, simulated_mark(report)),
        faults => notes_table("What went wrong", &report.faults, simulated_mark(report)),
        method => method_notes(report),
        made_by => &report.made_by,
    };
    fill(TEMPLATE, &title(report), page)
}

pub(super) fn markdown(report: &DeviceReport) -> String {
    let mut out = format!("# {}\n\n", title(report));
    for warning in warnings(report) {
        let _ = writeln!(out, "**{warning}**\n");
    }
    for answer in answers(report) {
        let _ = writeln!(out, "- {}", answer.sentence());
    }
    out.push('\n');
    for table in overview_tables(report) {
        let _ = writeln!(out, "{}", table.markdown());
    }
    for device in &report.devices {
        let _ = writeln!(out, "## {}\n\n{}\n", device.name, facts(report, device));
        for table in device_tables(report, device) {
            let _ = writeln!(out, "{}", table.markdown());
        }
    }
    for table in [
        notes_table("What does not count", &report.left_out, simulated_mark(report)),
        notes_table("What went wrong", &report.faults, simulated_mark(report)),
    ] {
        let _ = writeln!(out, "{}", table.markdown());
    }
    let _ = writeln!(out, "## How to read this\n");
    for note in method_notes(report) {
        let _ = writeln!(out, "- {note}");
    }
    let _ = writeln!(out, "\n{}", report.made_by);
    out
}

pub(super) fn text(report: &DeviceReport) -> String {
    let mut out = String::new();
    for line in warnings(report).into_iter().chain(answers(report).iter().map(Answer::sentence)) {
        let _ = writeln!(out, "{line}");
    }
    let runs = report.runs.len();
    let whole = report.runs.iter().filter(|run| run.exclusions.is_empty()).count();
    let _ = writeln!(
        out,
        "{whole} of {runs} runs count in full; {} faults are named in the report.",
        report.faults.len()
    );
    for note in &report.left_out {
        let _ = writeln!(out, "{}: {} ({})", note.of, note.detail, note.name);
    }
    out
}

fn title(report: &DeviceReport) -> String {
    let names: Vec<&str> = report.devices.iter().map(|device| device.name.as_str()).collect();
    match names.len() {
        0..=2 => format!("Measured on {}", names.join(" and ")),
        n => format!("Measured on {n} devices{}", simulated_mark(report)),
    }
}

/// Behind the title of what has replayed figures in it.
fn simulated_mark(report: &DeviceReport) -> &'static str {
    match report.simulated {
        true if report.devices.iter().all(|device| device.simulated) => " (simulated)",
        true => " (partly simulated)",
        false => "",
    }
}

fn warnings(report: &DeviceReport) -> Vec<String> {
    let mut warnings = Vec::new();
    let names: Vec<&str> =
        report.devices.iter().filter(|device| device.simulated).map(|d| d.name.as_str()).collect();
    if !names.is_empty() {
        warnings.push(format!(
            "Simulated: the figures of {} come from replayed logs and say nothing about any device.",
            names.join(", ")
        ));
    }
    for device in &report.devices {
        if !device.methods.contains(&report.baseline) {
            warnings.push(format!(
                "{} has no run of {}: nothing is compared there. Name another baseline, or measure one.",
                device.name, report.baseline
            ));
        }
    }
    warnings
}

/// The answer for a method on a device: the change of a quantity, from what to what, and the interval.
#[derive(Serialize)]
struct Answer {
    device: String,
    method: String,
    changes: Vec<AnswerChange>,
    how_sure: String,
}

#[derive(Serialize)]
struct AnswerChange {
    /// `-22.7 %`; a dash without a pair.
    change: String,
    name: &'static str,
    /// `1939 mW instead of 2510 mW`.
    values: String,
    /// `95 % interval -24.1 to -21.3 %`; nothing without.
    interval: String,
}

impl Answer {
    fn sentence(&self) -> String {
        let change = |c: &AnswerChange| {
            let interval = if c.interval.is_empty() { String::new() } else { format!(", {}", c.interval) };
            format!("{} {} ({}{interval})", c.name, c.change, c.values)
        };
        let changes: Vec<String> = self.changes.iter().map(change).collect();
        format!("{}, {}: {}. {}", self.device, self.method, changes.join("; "), self.how_sure)
    }
}

fn answers(report: &DeviceReport) -> Vec<Answer> {
    let mut answers = Vec::new();
    for device in &report.devices {
        for method in device.methods.iter().filter(|method| **method != report.baseline) {
            let find = |quantity| report.find(Some(&device.name), None, method, quantity);
            let changes = [Quantity::Power, Quantity::Fps].map(|quantity| match find(quantity) {
                None => AnswerChange {
                    change: "–".into(),
                    name: quantity.name(),
                    values: "no two runs to compare".into(),
                    interval: String::new(),
                },
                Some(d) => {
                    let (decimals, unit) = change_format(d);
                    let value = |value| format!("{} {}", number(quantity, value), quantity.unit());
                    let interval =
                        d.interval.map(|BlockInterval { interval: Interval { low, high }, .. }| {
                            if without_scatter(low, high) {
                                return NO_SCATTER.to_owned();
                            }
                            let confidence = 100.0 * CONFIDENCE;
                            let (low, high) = (signed(low, decimals), signed(high, decimals));
                            format!("{confidence:.0} % interval {low} to {high} {unit}")
                        });
                    AnswerChange {
                        change: change(d),
                        name: quantity.name(),
                        values: format!("{} instead of {}", value(d.ours), value(d.baseline)),
                        interval: interval.unwrap_or_default(),
                    }
                }
            });
            let found = find(Quantity::Power).or(find(Quantity::Fps));
            let how_sure = found.map_or("No run of it has a partner.".into(), |d| {
                let scenes = report.scenes_of(&device.name, method, d.quantity);
                let basis = match d.interval {
                    None => "nothing was repeated, so there is no interval",
                    Some(BlockInterval { basis: Basis::Repetitions, .. }) => {
                        "intervals rest on the repetitions"
                    }
                    Some(BlockInterval { basis: Basis::Blocks, .. }) => {
                        "every scene was measured once, so intervals rest on the scenes"
                    }
                };
                let (pairs, scenes) = (count(d.pairs, "pair"), count(scenes, "scene"));
                format!("{pairs} of runs on {scenes}; {basis}.")
            });
            let (device, method) = (device.name.clone(), method.clone());
            answers.push(Answer { device, method, changes: changes.into(), how_sure });
        }
    }
    answers
}

/// `1 run`, `2 runs`.
pub(super) fn count(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

impl DeviceReport {
    fn find(
        &self,
        device: Option<&str>,
        scene: Option<&str>,
        method: &str,
        quantity: Quantity,
    ) -> Option<&Difference> {
        self.differences.iter().find(|d| {
            d.device.as_deref() == device
                && d.scene.as_deref() == scene
                && d.method == method
                && d.quantity == quantity
        })
    }

    fn scenes_of(&self, device: &str, method: &str, quantity: Quantity) -> usize {
        let of = |d: &&Difference| {
            d.device.as_deref() == Some(device) && d.method == method && d.quantity == quantity
        };
        self.differences.iter().filter(of).filter(|d| d.scene.is_some()).count()
    }

    fn runs_of<'a>(&'a self, device: &'a Device) -> impl Iterator<Item = &'a Run> {
        self.runs.iter().filter(|run| run.device == device.name)
    }
}

fn number(quantity: Quantity, value: f64) -> String {
    format!("{value:.0$}", quantity.decimals())
}

/// Decimals and unit of a change.
fn change_format(difference: &Difference) -> (usize, &'static str) {
    match difference.quantity {
        _ if difference.in_percent() => (1, "%"),
        Quantity::Stale => (2, "1/s"),
        _ => (1, "K"),
    }
}

/// `-26.9 %`.
fn change(difference: &Difference) -> String {
    let (decimals, unit) = change_format(difference);
    format!("{} {unit}", signed(difference.change, decimals))
}

/// With its sign, but for a zero.
fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    let is_zero = !text.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    if is_zero { text[1..].to_owned() } else { text }
}

/// `[-31.0, -22.5]`, marked where it does not rest on repetitions; nothing without an interval.
fn change_interval(difference: &Difference) -> String {
    let (decimals, _) = change_format(difference);
    match difference.interval {
        None => String::new(),
        Some(BlockInterval { interval: Interval { low, high }, .. }) if without_scatter(low, high) => {
            format!(" [{NO_SCATTER}]")
        }
        Some(BlockInterval { interval: Interval { low, high }, basis }) => {
            let mark = if basis == Basis::Blocks { OVER_BLOCKS } else { "" };
            format!(" [{}, {}]{mark}", signed(low, decimals), signed(high, decimals))
        }
    }
}

/// An interval of no width says that the device rounds, not that nothing varies.
const NO_SCATTER: &str = "no scatter was seen";

fn without_scatter(low: f64, high: f64) -> bool {
    (high - low).abs() < 1e-9 * (1.0 + low.abs())
}

fn facts(report: &DeviceReport, device: &Device) -> String {
    let runs = report.runs_of(device).count();
    let whole = report.runs_of(device).filter(|run| run.exclusions.is_empty()).count();
    let capacity = device.capacity_mah.map(|c| format!(", battery {c:.0} mAh")).unwrap_or_default();
    let cells = match device.cells {
        1 => String::new(),
        cells => format!(", current x {cells} cells"),
    };
    let applications: Vec<&str> = device.applications.iter().map(String::as_str).collect();
    let application = match applications.is_empty() {
        true => String::new(),
        false => format!(", application {}", applications.join(" and ")),
    };
    format!("Android {}{capacity}{cells}{application}; {whole} of {runs} runs count in full.", device.android)
}

/// A table in the shape of the paper's for each method, its columns beside ours.
fn overview_tables(report: &DeviceReport) -> Vec<Table> {
    let mut methods: Vec<&String> = Vec::new();
    for method in report.devices.iter().flat_map(|device| &device.methods) {
        if *method != report.baseline && !methods.contains(&method) {
            methods.push(method);
        }
    }
    let means: Vec<&Difference> = report.differences.iter().filter(|d| d.device.is_none()).collect();
    let mut tables = Vec::new();
    for method in methods {
        let mut columns = vec!["<against ".to_owned() + &report.baseline];
        columns.extend(report.devices.iter().map(|device| device.name.clone()));
        let over_devices =
            |quantity| means.iter().filter(move |d| d.method == *method && d.quantity == quantity);
        let mean_columns = over_devices(Quantity::Fps).count().max(over_devices(Quantity::Power).count());
        for i in 0..mean_columns {
            columns.push(if i == 0 { "mean of the devices" } else { "mean of the simulated" }.into());
        }
        // The paper has this table for its own method only.
        let papers: &[paper::PaperDevice] = if method.starts_with("yoro") { &paper::DEVICES } else { &[] };
        columns.extend(papers.iter().map(|device| format!("{}, the paper's", device.name)));
        let mut table =
            Table::new(format!("{method}: change per device{}", simulated_mark(report)), &columns);
        let capacity = |capacity: Option<f64>| capacity.map(|c| format!("{c:.0} mAh"));
        let mut cells = vec![Cell::plain("battery capacity")];
        cells.extend(
            report.devices.iter().map(|d| Cell::plain(capacity(d.capacity_mah).unwrap_or("–".into()))),
        );
        cells.extend((0..mean_columns).map(|_| Cell::plain("")));
        cells.extend(papers.iter().map(|d| Cell::paper(capacity(Some(d.capacity_mah)))));
        table.push(cells);
        type Printed = fn(&paper::PaperDevice) -> f64;
        for (name, quantity, printed) in [
            ("power", Quantity::Power, (|d| d.power) as Printed),
            ("frame rate", Quantity::Fps, |d| d.fps),
            ("execution time of a frame", Quantity::FrameTime, |d| d.time),
            ("memory", Quantity::Memory, |d| d.memory),
        ] {
            let text = |d: &Difference| format!("{}{}", change(d), change_interval(d));
            let mut cells = vec![Cell::plain(name)];
            for device in &report.devices {
                cells.push(Cell::ours(report.find(Some(&device.name), None, method, quantity).map(text)));
            }
            let mut means: Vec<Cell> = over_devices(quantity).map(|d| Cell::ours(Some(text(d)))).collect();
            means.resize(mean_columns, Cell::ours(None::<String>));
            cells.extend(means);
            cells.extend(papers.iter().map(|d| Cell::paper(Some(format!("{:+.1} %", printed(d))))));
            table.push(cells);
        }
        table.note = format!(
            "In brackets: {:.0} % interval of the change; {} rests on the scatter of scenes or devices instead of \
             repetitions.",
            100.0 * CONFIDENCE,
            OVER_BLOCKS.trim(),
        );
        if !papers.is_empty() {
            let _ = write!(
                table.note,
                " The paper (\"You Only Render Once\", MobiSys '25) gives no intervals; its power comes from battery \
                 percent x capacity x {PAPER_VOLTS} V, and its execution time is the inverse of its frame rate (but \
                 for the Quest 3)."
            );
        }
        tables.push(table);
    }
    tables
}

fn device_tables(report: &DeviceReport, device: &Device) -> Vec<Table> {
    let mut tables = Vec::new();
    for half in [FIRST_HALF, SECOND_HALF] {
        tables.push(difference_table(report, device, half));
    }
    for half in [FIRST_HALF, SECOND_HALF] {
        tables.push(mean_table(report, device, half));
    }
    tables.push(power_table(report, device));
    tables.retain(|table| !table.lines.is_empty());
    tables
}

fn names(quantities: [Quantity; 5]) -> String {
    quantities.map(Quantity::name).join(", ")
}

fn difference_table(report: &DeviceReport, device: &Device, quantities: [Quantity; 5]) -> Table {
    let mut columns = vec!["<scene".to_owned(), "<method".into(), "pairs".into()];
    columns.extend(quantities.map(|quantity| quantity.name().to_owned()));
    let with_paper = quantities.contains(&Quantity::Power);
    if with_paper {
        columns.extend(["the paper's power".to_owned(), "the paper's frame rate".into()]);
    }
    let title = format!("{}: change against {}: {}", device.name, report.baseline, names(quantities));
    let mut table = Table::new(title, &columns);
    let scenes = device.scenes.iter().map(|scene| Some(scene.as_str())).chain([None]);
    for scene in scenes {
        let mut first = true;
        for method in device.methods.iter().filter(|method| **method != report.baseline) {
            let find = |quantity| report.find(Some(&device.name), scene, method, quantity);
            let pairs = quantities.iter().filter_map(|q| find(*q)).map(|d| d.pairs).max();
            let Some(pairs) = pairs else { continue };
            let mut cells = vec![
                Cell::plain(scene.unwrap_or(ALL_SCENES)),
                Cell::plain(method),
                Cell::plain(pairs.to_string()),
            ];
            for quantity in quantities {
                cells
                    .push(Cell::ours(find(quantity).map(|d| format!("{}{}", change(d), change_interval(d)))));
            }
            if with_paper {
                let papers = papers_changes(scene, method);
                cells.push(Cell::paper(papers.map(|(power, _)| format!("{power:+.1} %"))));
                cells.push(Cell::paper(papers.map(|(_, fps)| format!("{fps:+.1} %"))));
            }
            table.push_grouped(cells, std::mem::take(&mut first));
        }
    }
    table.note = format!(
        "Geometric mean of the ratios of pairs of runs (same scene and repetition), in brackets its {:.0} % interval. \
         Temperatures and stale frames are compared as differences.",
        100.0 * CONFIDENCE
    );
    table
}

/// Power and frame rate against conventional rendering, in percent, of the system in the paper that a method stands
/// for, on the scene that a scene stands for, or on the mean of all.
fn papers_changes(scene: Option<&str>, method: &str) -> Option<(f64, f64)> {
    let column = match method {
        "hybrid" => 2,
        _ if method.starts_with("yoro") => 0,
        _ => return None,
    };
    let fps = |s: &paper::PaperScene| [s.fps_yoro, s.fps_conventional, s.fps_fink];
    let (power, fps) = match scene {
        Some(scene) => {
            let stands_for = BUILTINS.iter().find(|builtin| builtin.name == scene)?.stands_for;
            let at = paper::SCENES.iter().position(|s| s.name == stands_for)?;
            (paper::POWER[at], fps(&paper::SCENES[at]))
        }
        None => {
            let mean = |column: usize| paper::POWER.iter().map(|row| row[column]).sum::<f64>() / 8.0;
            ([mean(0), mean(1), mean(2)], fps(&paper::AVERAGE))
        }
    };
    let change = |values: [f64; 3]| 100.0 * (values[column] / values[1] - 1.0);
    Some((change(power), change(fps)))
}

fn mean_table(report: &DeviceReport, device: &Device, quantities: [Quantity; 5]) -> Table {
    let mut columns = vec!["<scene".to_owned(), "<method".into(), "runs".into()];
    columns.extend(quantities.map(|quantity| format!("{}, {}", quantity.name(), quantity.unit())));
    let mut table = Table::new(format!("{}: {}", device.name, names(quantities)), &columns);
    for scene in &device.scenes {
        let mut first = true;
        for method in &device.methods {
            let of = |quantity: Quantity| {
                report.means.iter().find(|mean| {
                    mean.device == device.name
                        && mean.scene == *scene
                        && mean.method == *method
                        && mean.quantity == quantity
                })
            };
            let Some(runs) = quantities.iter().filter_map(|q| of(*q)).map(|mean| mean.sample.n).max() else {
                continue;
            };
            let mut cells = vec![Cell::plain(scene), Cell::plain(method), Cell::plain(runs.to_string())];
            for quantity in quantities {
                let text = of(quantity).map(|mean| {
                    let value = number(quantity, mean.sample.mean);
                    match mean.interval {
                        None => value,
                        Some(interval) if without_scatter(interval.low, interval.high) => {
                            format!("{value} [{NO_SCATTER}]")
                        }
                        Some(interval) => format!(
                            "{value} ± {} [{}, {}]",
                            number(quantity, mean.sample.std),
                            number(quantity, interval.low),
                            number(quantity, interval.high)
                        ),
                    }
                });
                cells.push(if *method == report.baseline { Cell::base(text) } else { Cell::ours(text) });
            }
            table.push_grouped(cells, std::mem::take(&mut first));
        }
    }
    table.note = format!(
        "Mean ± standard deviation of the runs [{:.0} % interval of the mean]; of a single run its value alone.",
        100.0 * CONFIDENCE
    );
    table
}

fn power_table(report: &DeviceReport, device: &Device) -> Table {
    let columns = [
        "<scene".to_owned(),
        "<method".into(),
        "repetition".into(),
        "seconds".into(),
        "current x voltage, mW".into(),
        "charge counter, mW".into(),
        "differs".into(),
        format!("percent x capacity x {PAPER_VOLTS} V (the paper's way), mW"),
        "one percent is, mW".into(),
        "<counts".into(),
    ];
    let mut table = Table::new(format!("{}: power of each run, three ways", device.name), &columns);
    let mut runs: Vec<&Run> = report.runs_of(device).collect();
    let place = |run: &Run| {
        let scene = device.scenes.iter().position(|scene| *scene == run.scene);
        let method = device.methods.iter().position(|method| *method == run.method);
        (scene, method, run.set, run.repetition)
    };
    runs.sort_by_key(|run| place(run));
    let mut scene = "";
    for run in runs {
        let milliwatts = |value: Option<f64>| value.map(|value| format!("{value:.0}"));
        let counts = match run.counts(Quantity::Power) {
            true => "yes".to_owned(),
            false => {
                let names: Vec<&str> = run.exclusions.iter().map(|exclusion| exclusion.name).collect();
                format!("no: {}", names.join(", "))
            }
        };
        let cells = vec![
            Cell::plain(&run.scene),
            Cell::plain(&run.method),
            Cell::plain(run.repetition.to_string()),
            Cell::plain(run.integrated.map(|i| format!("{:.0}", i.seconds)).unwrap_or("–".into())),
            Cell::ours(milliwatts(run.integrated.map(|i| i.milliwatts))),
            Cell::base(milliwatts(run.counted.map(|c| c.milliwatts))),
            Cell::base(run.counted.map(|c| format!("{:+.1} %", 100.0 * c.disagreement()))),
            Cell::paper(milliwatts(run.by_level.map(|l| l.milliwatts))),
            Cell::paper(milliwatts(run.by_level.map(|l| l.step_milliwatts))),
            Cell::plain(counts),
        ];
        table.push_grouped(cells, run.scene != scene);
        scene = &run.scene;
    }
    table.note = format!(
        "The counter is read between its first and last step; more than {:.0} % apart from current x voltage over the \
         same time is named as a fault. A battery's level comes in whole percents: the paper's way cannot tell less \
         apart than one of them.",
        100.0 * COUNTER_TOLERANCE
    );
    table
}

fn notes_table(title: &str, notes: &[Note], mark: &str) -> Table {
    let mut table = Table::new(format!("{title}{mark}"), &["<what", "<where", "<in detail"]);
    for note in notes {
        table.push(vec![Cell::plain(note.name), Cell::plain(&note.of), Cell::plain(&note.detail)]);
    }
    if notes.is_empty() {
        table.push(vec![Cell::plain("nothing"), Cell::plain(""), Cell::plain("")]);
    }
    table
}

fn method_notes(report: &DeviceReport) -> Vec<String> {
    vec![
        "Power is current x voltage, integrated by trapezoids over the times of the samples. Gaps are not bridged: \
         what is inside them counts for nothing."
            .into(),
        "A run gives one value of each quantity: its seconds depend on each other. Intervals rest on repetitions, and \
         two methods are compared by runs of the same device, scene and repetition."
            .into(),
        "A change in percent is the geometric mean of the pairs' ratios, its interval Student's t of their logarithms. \
         Over scenes, each weighs the same; the scatter of the repetitions around their scenes is pooled. Where each \
         scene was measured once, the interval rests on the scatter of the scenes, and is marked."
            .into(),
        format!(
            "A run does not count if it was interrupted or failed, the device or the application was started anew, or \
             less than {:.0} % of it was measured. Its power does not count while plugged in, or without current.",
            100.0 * LEAST_COVERED
        ),
        format!(
            "The baseline is {}. The CPU's load is in percent of one core; MB are 10^6 bytes; frame and GPU times are \
             means over frames.",
            report.baseline
        ),
    ]
}

/// Change of power and frame rate by scene, with intervals.
fn change_figures(report: &DeviceReport, device: &Device, id: &str) -> Vec<Figure> {
    let mut found = Vec::new();
    for quantity in [Quantity::Power, Quantity::Fps, Quantity::Temperature] {
        let unit = if quantity.is_ratio() { "%" } else { "K" };
        let mark = if device.simulated { " (simulated)" } else { "" };
        let scenes = device.scenes.iter().map(|scene| Some(scene.as_str())).chain([None]);
        let rows = scenes.map(|scene| {
            let mut marks = Vec::new();
            for method in device.methods.iter().filter(|method| **method != report.baseline) {
                let papers = papers_changes(scene, method).and_then(|(power, fps)| match quantity {
                    Quantity::Power => Some(power),
                    Quantity::Fps => Some(fps),
                    _ => None,
                });
                let label = if method == "hybrid" { "the paper's Fink et al." } else { "the paper's YORO" };
                let look = if method == "hybrid" { "hybrid" } else { "yoro-paper" };
                marks.extend(papers.map(|value| Mark::papers(look, label, value)));
                let ours = report.find(Some(&device.name), scene, method, quantity);
                marks.extend(ours.map(|d| Mark {
                    interval: d.interval.map(|found| found.interval),
                    ..Mark::new(method, method, d.change)
                }));
            }
            DotRow { label: scene.unwrap_or(ALL_SCENES).into(), marks }
        });
        let name = format!("{} against {}, {unit}{mark}", quantity.name(), report.baseline);
        let figure = Figure {
            id: format!("{id}-{}", yoro_figures::text::slug(quantity.name())),
            title: format!("{}: {} against {}{mark}", device_plain(device), quantity.name(), report.baseline),
            caption: format!(
                "Bars: {:.0} % intervals. The line is {}. Hollow: the paper's, for its own scenes and devices.",
                100.0 * CONFIDENCE,
                report.baseline
            ),
            panel: Panel::Dots { value: Axis::new(name).baseline(0.0), rows: rows.collect() },
        };
        let measured = report
            .differences
            .iter()
            .any(|d| d.device.as_ref() == Some(&device.name) && d.quantity == quantity);
        if measured {
            found.push(figure);
        }
    }
    found
}

/// Without the mark, where that comes later.
fn device_plain(device: &Device) -> &str {
    device.name.trim_end_matches(" (simulated)")
}

/// Power, frame rate and temperature over time: a thin line for each run that counts.
fn trace_figures(report: &DeviceReport, device: &Device, id: &str, scene: &str) -> Vec<Figure> {
    let mark = if device.simulated { " (simulated)" } else { "" };
    let mut found = Vec::new();
    for (quantity, values) in [
        (Quantity::Power, (|run: &Run| &run.traces.power) as fn(&Run) -> &Vec<(f64, f64)>),
        (Quantity::Fps, |run| &run.traces.fps),
        (Quantity::Temperature, |run| &run.traces.temperature),
    ] {
        let runs = report.runs_of(device).filter(|run| run.scene == scene && run.counts(quantity));
        let mut series: Vec<Series> = runs
            .map(|run| Series {
                method: run.method.clone(),
                papers: false,
                label: run.method.clone(),
                points: values(run).clone(),
            })
            .collect();
        series.sort_by(|a, b| a.method.cmp(&b.method));
        let axis = Axis::new(format!("{}, {}{mark}", quantity.name(), quantity.unit()));
        let figure = Figure {
            id: format!("{id}-{}", yoro_figures::text::slug(quantity.name())),
            title: format!("{scene}: {}{mark}", quantity.name()),
            caption: "A line for each run that counts, warm-up left out.".into(),
            panel: Panel::Traces {
                x: Axis::new("seconds since the run began"),
                y: if quantity == Quantity::Temperature { axis } else { axis.from_zero() },
                series,
            },
        };
        if !figure.is_empty() {
            found.push(figure);
        }
    }
    found
}
