//! The report's tables.

use std::fmt::Write as _;

use super::format::{NO_SCATTER, OVER_BLOCKS, change, change_interval, number, without_scatter};
use super::{ALL_SCENES, simulated_mark};
use crate::report::run::{COUNTER_TOLERANCE, PAPER_VOLTS};
use crate::report::{CONFIDENCE, Device, DeviceReport, Difference, Mean, Note, Quantity, Run};
use yoro_report::paper::{self, PAPER, PaperDevice, PaperScene};
use yoro_report::stats::unique;
use yoro_report::{Cell, Table};
use yoro_scenes::BUILTINS;

const FIRST_HALF: [Quantity; 5] =
    [Quantity::Power, Quantity::Fps, Quantity::Stale, Quantity::FrameTime, Quantity::FrameTimeP99];
const SECOND_HALF: [Quantity; 5] =
    [Quantity::GpuTime, Quantity::Temperature, Quantity::Rise, Quantity::Cpu, Quantity::Memory];

/// Returns a table for each method in the layout of the paper's, with the paper's values in further columns.
pub fn overview_tables(report: &DeviceReport) -> Vec<Table> {
    let methods = report.devices.iter().flat_map(|device| &device.methods);
    let methods = unique(methods.filter(|method| **method != report.baseline));
    let mut tables = Vec::new();
    for method in methods {
        let mut columns = vec!["<against ".to_owned() + &report.baseline];
        columns.extend(report.devices.iter().map(|device| device.name.clone()));
        // The paper has this table only for its own method.
        let papers: &[PaperDevice] = if method.starts_with("yoro") { &PAPER.devices } else { &[] };
        columns.extend(papers.iter().map(|device| format!("{}, the paper's", device.name)));
        let mut table =
            Table::new(format!("{method}: change per device{}", simulated_mark(report)), &columns);
        let capacity = |capacity: Option<f64>| capacity.map(|c| format!("{c:.0} mAh"));
        let mut cells = vec![Cell::plain("battery capacity")];
        cells.extend(
            report.devices.iter().map(|d| Cell::plain(capacity(d.capacity_mah).unwrap_or("–".into()))),
        );
        cells.extend(papers.iter().map(|d| Cell::paper(capacity(Some(d.capacity_mah)))));
        table.push(cells);
        type Printed = fn(&PaperDevice) -> f64;
        for (name, quantity, printed) in [
            ("power", Quantity::Power, (|d| d.power) as Printed),
            ("frame rate", Quantity::Fps, |d| d.fps),
            ("execution time of a frame", Quantity::FrameTime, |d| d.time),
            ("memory", Quantity::Memory, |d| d.memory),
        ] {
            let text = |d: &Difference| format!("{}{}", change(d), change_interval(d));
            let mut cells = vec![Cell::plain(name)];
            for device in &report.devices {
                cells.push(Cell::ours(report.find(&device.name, None, method, quantity).map(text)));
            }
            cells.extend(papers.iter().map(|d| Cell::paper(Some(format!("{:+.1} %", printed(d))))));
            table.push(cells);
        }
        table.note = format!(
            "In brackets: {:.0} % interval of the change; {} rests on the scatter of scenes instead of \
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

/// Returns the tables of a device.
pub fn device_tables(report: &DeviceReport, device: &Device) -> Vec<Table> {
    let halves = [FIRST_HALF, SECOND_HALF];
    let mut tables: Vec<Table> = halves.map(|half| difference_table(report, device, half)).into();
    tables.extend(halves.map(|half| mean_table(report, device, half)));
    tables.push(power_table(report, device));
    tables
}

/// Returns a table with a row for each scene and method that has values, and their columns after that of a number.
fn value_table(title: String, number: &str, columns: Vec<String>, rows: Vec<Option<Vec<Cell>>>) -> Table {
    let first = ["<scene", "<method", number].map(str::to_owned);
    let mut table = Table::new(title, &[first.to_vec(), columns].concat());
    rows.into_iter().flatten().for_each(|cells| table.push(cells));
    table.group();
    table
}

fn names(quantities: [Quantity; 5]) -> String {
    quantities.map(Quantity::name).join(", ")
}

fn difference_table(report: &DeviceReport, device: &Device, quantities: [Quantity; 5]) -> Table {
    let mut columns = quantities.map(|quantity| quantity.name().to_owned()).to_vec();
    let with_paper = quantities.contains(&Quantity::Power);
    if with_paper {
        columns.extend(["the paper's power", "the paper's frame rate"].map(str::to_owned));
    }
    let row = |scene: Option<&str>, method: &String| {
        let find = |quantity| report.find(&device.name, scene, method, quantity);
        let pairs = quantities.iter().filter_map(|q| find(*q)).map(|d| d.pairs).max()?;
        let first = [scene.unwrap_or(ALL_SCENES).to_owned(), method.clone(), pairs.to_string()];
        let mut cells = first.map(Cell::plain).to_vec();
        let text = |d: &Difference| format!("{}{}", change(d), change_interval(d));
        cells.extend(quantities.map(|quantity| Cell::ours(find(quantity).map(text))));
        if with_paper {
            let papers = papers_changes(scene, method);
            cells.extend([0, 1].map(|i| Cell::paper(papers.map(|papers| format!("{:+.1} %", papers[i])))));
        }
        Some(cells)
    };
    let methods = || device.methods.iter().filter(|method| **method != report.baseline);
    let scenes = device.scenes.iter().map(|scene| Some(scene.as_str())).chain([None]);
    let rows = scenes.flat_map(|scene| methods().map(move |method| (scene, method)));
    let title = format!("{}: change against {}: {}", device.name, report.baseline, names(quantities));
    let mut table =
        value_table(title, "pairs", columns, rows.map(|(scene, method)| row(scene, method)).collect());
    table.note = format!(
        "Geometric mean of the ratios of pairs of runs (same scene and repetition), in brackets its {:.0} % interval. \
         Temperatures and stale frames are compared as differences.",
        100.0 * CONFIDENCE
    );
    table
}

/// Returns the paper's changes of power and of the frame rate against conventional rendering, in percent, for the system
/// and scene that correspond to a method and a scene. `None` for the scene stands for the mean over all scenes.
pub fn papers_changes(scene: Option<&str>, method: &str) -> Option<[f64; 2]> {
    let system = if method.starts_with("yoro") { "yoro-paper" } else { method };
    let at = paper::SYSTEMS.iter().position(|name| *name == system).filter(|at| *at != 1)?;
    let (power, fps) = match scene {
        Some(scene) => {
            let builtin = BUILTINS.iter().find(|builtin| builtin.name == scene)?;
            let PaperScene { power, fps, .. } = paper::find(builtin.stands_for)?;
            (*power, *fps)
        }
        None => {
            let mean = |at: usize| PAPER.scenes.iter().map(|scene| scene.power[at]).sum::<f64>() / 8.0;
            ([mean(0), mean(1), mean(2)], PAPER.average.fps)
        }
    };
    Some([power, fps].map(|values| 100.0 * (values[at] / values[1] - 1.0)))
}

fn mean_table(report: &DeviceReport, device: &Device, quantities: [Quantity; 5]) -> Table {
    let text = |mean: &Mean| {
        let [value, std] = [mean.sample.mean, mean.sample.std].map(|value| number(mean.quantity, value));
        match mean.interval {
            None => value,
            Some(interval) if without_scatter(interval.low, interval.high) => {
                format!("{value} [{NO_SCATTER}]")
            }
            Some(interval) => {
                let [low, high] = [interval.low, interval.high].map(|value| number(mean.quantity, value));
                format!("{value} ± {std} [{low}, {high}]")
            }
        }
    };
    let row = |scene: &String, method: &String| {
        let is_here =
            |mean: &&Mean| mean.device == device.name && mean.scene == *scene && mean.method == *method;
        let of =
            |quantity: Quantity| report.means.iter().filter(is_here).find(|mean| mean.quantity == quantity);
        let runs = quantities.iter().filter_map(|q| of(*q)).map(|mean| mean.sample.n).max()?;
        let mut cells = [scene.clone(), method.clone(), runs.to_string()].map(Cell::plain).to_vec();
        let cell: fn(Option<String>) -> Cell =
            if *method == report.baseline { Cell::base } else { Cell::ours };
        cells.extend(quantities.map(|quantity| cell(of(quantity).map(text))));
        Some(cells)
    };
    let rows = device.scenes.iter().flat_map(|scene| device.methods.iter().map(move |m| (scene, m)));
    let columns = quantities.map(|quantity| format!("{}, {}", quantity.name(), quantity.unit()));
    let title = format!("{}: {}", device.name, names(quantities));
    let rows = rows.map(|(scene, method)| row(scene, method)).collect();
    let mut table = value_table(title, "runs", columns.to_vec(), rows);
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
    for run in runs {
        let milliwatts = |value: Option<f64>| value.map(|value| format!("{value:.0}"));
        let reasons: Vec<&str> = run.exclusions.iter().map(|exclusion| exclusion.name).collect();
        let counts = if run.counts(Quantity::Power) {
            "yes".to_owned()
        } else {
            format!("no: {}", reasons.join(", "))
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
        table.push(cells);
    }
    table.group();
    table.note = format!(
        "The counter is read between its first and last step; more than {:.0} % apart from current x voltage over the \
         same time is named as a fault. A battery's level comes in whole percents: the paper's way cannot tell less \
         apart than one of them.",
        100.0 * COUNTER_TOLERANCE
    );
    table
}

/// Returns notes as a table.
pub fn notes_table(title: &str, notes: &[Note], mark: &str) -> Table {
    let mut table = Table::new(format!("{title}{mark}"), &["<what", "<where", "<in detail"]);
    for note in notes {
        table.push(vec![Cell::plain(note.name), Cell::long(&note.of), Cell::long(&note.detail)]);
    }
    if notes.is_empty() {
        table.push(vec![Cell::plain("nothing"), Cell::plain(""), Cell::plain("")]);
    }
    table
}
