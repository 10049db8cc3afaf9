//! The report's tables.

use super::format::{NO_SCATTER, OVER_SCENES, change_and_interval, ends, number};
use super::{ALL_SCENES, simulated_mark};
use crate::report::run::{COUNTER_TOLERANCE, PAPER_VOLTS};
use crate::report::{Device, DeviceReport, Mean, Note, Quantity, Run};
use yoro_report::paper::{self, PAPER, PaperDevice, PaperScene};
use yoro_report::stats::unique;
use yoro_report::text::fixed;
use yoro_report::{Cell, Table};
use yoro_scenes::BUILTINS;

/// Returns a table for each method in the layout of the paper's, with the paper's values in further columns.
pub fn overview_tables(report: &DeviceReport) -> Vec<Table> {
    unique(report.devices.iter().flat_map(|device| report.compared(device)))
        .into_iter()
        .map(|method| overview_table(report, method))
        .collect()
}

fn overview_table(report: &DeviceReport, method: &str) -> Table {
    // The paper has this table only for its own method.
    let papers: &[PaperDevice] = if method.starts_with("yoro") { &PAPER.devices } else { &[] };
    let mut columns = vec!["<against ".to_owned() + &report.baseline];
    columns.extend(report.devices.iter().map(|device| device.name.clone()));
    columns.extend(papers.iter().map(|device| format!("{}, the paper's", device.name)));
    let mut table = Table::new(format!("{method}: change per device{}", simulated_mark(report)), &columns);
    let mut push = |name: &str, ours: &dyn Fn(&Device) -> Cell, theirs: &dyn Fn(&PaperDevice) -> String| {
        let papers = papers.iter().map(|device| Cell::paper(Some(theirs(device))));
        let ours = report.devices.iter().map(ours);
        table.push([Cell::plain(name)].into_iter().chain(ours).chain(papers).collect());
    };
    let capacity = |capacity: f64| format!("{capacity:.0} mAh");
    let ours = |d: &Device| Cell::plain(d.info.capacity_mah.map_or("–".into(), capacity));
    push("battery capacity", &ours, &|d| capacity(d.capacity_mah));
    type Printed = fn(&PaperDevice) -> f64;
    for (name, quantity, printed) in [
        ("power", Quantity::Power, (|d| d.power) as Printed),
        ("frame rate", Quantity::Fps, |d| d.fps),
        ("execution time of a frame", Quantity::FrameTime, |d| d.time),
        ("memory", Quantity::Memory, |d| d.memory),
    ] {
        let find = |device: &Device| report.find(&device.name, None, method, quantity);
        let ours = |device: &Device| Cell::ours(find(device).map(change_and_interval));
        push(name, &ours, &|device| format!("{:+.1} %", printed(device)));
    }
    table.note = format!(
        "In brackets: 95 % interval of the change;{OVER_SCENES} rests on the scatter of scenes instead of repetitions."
    );
    if !papers.is_empty() {
        table.note += &format!(
            " The paper (\"You Only Render Once\", MobiSys '25) gives no intervals; its power comes from battery \
             percent x capacity x {PAPER_VOLTS} V, and its execution time is the inverse of its frame rate (but \
             for the Quest 3)."
        );
    }
    table
}

/// Returns the tables of a device.
pub fn device_tables(report: &DeviceReport, device: &Device) -> Vec<Table> {
    let halves = || Quantity::ALL.chunks(5);
    let mut tables: Vec<Table> = halves().map(|half| difference_table(report, device, half)).collect();
    tables.extend(halves().map(|half| mean_table(report, device, half)));
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

fn names(quantities: &[Quantity]) -> Vec<String> {
    quantities.iter().map(|quantity| quantity.shown().name.to_owned()).collect()
}

fn difference_table(report: &DeviceReport, device: &Device, quantities: &[Quantity]) -> Table {
    let mut columns = names(quantities);
    let with_paper = quantities.contains(&Quantity::Power);
    if with_paper {
        columns.extend(["the paper's power", "the paper's frame rate"].map(str::to_owned));
    }
    let row = |scene: Option<&str>, method: &String| {
        let find = |quantity: &Quantity| report.find(&device.name, scene, method, *quantity);
        let pairs = quantities.iter().filter_map(find).map(|d| d.pairs).max()?;
        let first = [scene.unwrap_or(ALL_SCENES).to_owned(), method.clone(), pairs.to_string()];
        let mut cells = first.map(Cell::plain).to_vec();
        cells.extend(quantities.iter().map(|quantity| Cell::ours(find(quantity).map(change_and_interval))));
        if with_paper {
            let papers = papers_changes(scene, method);
            cells.extend([0, 1].map(|i| Cell::paper(papers.map(|papers| format!("{:+.1} %", papers[i])))));
        }
        Some(cells)
    };
    let rows = device.rows().flat_map(|scene| report.compared(device).map(move |method| (scene, method)));
    let names = names(quantities).join(", ");
    let title = format!("{}: change against {}: {names}", device.name, report.baseline);
    let rows = rows.map(|(scene, method)| row(scene, method)).collect();
    let mut table = value_table(title, "pairs", columns, rows);
    table.note = "Geometric mean of the ratios of pairs of runs (same scene and repetition), in brackets its 95 % interval. \
                  Temperatures and stale frames are compared as differences."
        .into();
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

fn mean_table(report: &DeviceReport, device: &Device, quantities: &[Quantity]) -> Table {
    let text = |Mean { sample, quantity, .. }: &Mean| {
        let number = |value| number(*quantity, value);
        let value = number(sample.mean);
        match sample.interval.map(|interval| ends(interval, ", ", number)) {
            None => value,
            Some(None) => format!("{value} [{NO_SCATTER}]"),
            Some(Some(interval)) => format!("{value} ± {} [{interval}]", number(sample.std)),
        }
    };
    let row = |scene: &String, method: &String| {
        let here = |mean: &&Mean| (&mean.device, &mean.scene, &mean.method) == (&device.name, scene, method);
        let of = |quantity: &Quantity| report.means.iter().filter(here).find(|m| m.quantity == *quantity);
        let runs = quantities.iter().filter_map(of).map(|mean| mean.sample.n).max()?;
        let mut cells = [scene.clone(), method.clone(), runs.to_string()].map(Cell::plain).to_vec();
        let is_baseline = *method == report.baseline;
        let cell = |text: Option<String>| if is_baseline { Cell::base(text) } else { Cell::ours(text) };
        cells.extend(quantities.iter().map(|quantity| cell(of(quantity).map(text))));
        Some(cells)
    };
    let rows = device.scenes.iter().flat_map(|scene| device.methods.iter().map(move |m| (scene, m)));
    let columns = quantities.iter().map(|q| format!("{}, {}", q.shown().name, q.shown().unit)).collect();
    let title = format!("{}: {}", device.name, names(quantities).join(", "));
    let rows = rows.map(|(scene, method)| row(scene, method)).collect();
    let mut table = value_table(title, "runs", columns, rows);
    table.note =
        "Mean ± standard deviation of the runs [95 % interval of the mean]; of a single run its value alone."
            .into();
    table
}

fn power_table(report: &DeviceReport, device: &Device) -> Table {
    let papers_way = format!("percent x capacity x {PAPER_VOLTS} V (the paper's way), mW");
    type Column<'a> = (&'a str, fn(&Run) -> Cell);
    let columns: [Column; 10] = [
        ("<scene", |run| Cell::plain(&run.info.scene)),
        ("<method", |run| Cell::plain(&run.info.method)),
        ("repetition", |run| Cell::plain(run.info.repetition.to_string())),
        ("seconds", |run| Cell::plain(run.integrated.map_or("–".into(), |i| format!("{:.0}", i.seconds)))),
        ("current x voltage, mW", |run| Cell::ours(fixed(run.integrated.map(|i| i.milliwatts), 0))),
        ("charge counter, mW", |run| Cell::base(fixed(run.counted.map(|c| c.milliwatts), 0))),
        ("differs", |run| Cell::base(run.counted.map(|c| format!("{:+.1} %", 100.0 * c.disagreement())))),
        (&papers_way, |run| Cell::paper(fixed(run.by_level.map(|level| level.milliwatts), 0))),
        ("one percent is, mW", |run| Cell::paper(fixed(run.by_level.map(|level| level.step_milliwatts), 0))),
        ("<counts", |run| {
            let reasons: Vec<&str> = run.exclusions.iter().map(|exclusion| exclusion.name).collect();
            Cell::plain(if reasons.is_empty() { "yes".into() } else { format!("no: {}", reasons.join(", ")) })
        }),
    ];
    let title = format!("{}: power of each run, three ways", device.name);
    let mut table = Table::new(title, &columns.map(|(name, _)| name));
    let mut runs: Vec<&Run> = device.runs(&report.runs).collect();
    runs.sort_by_key(|run| {
        let scene = device.scenes.iter().position(|scene| *scene == run.info.scene);
        let method = device.methods.iter().position(|method| *method == run.info.method);
        (scene, method, run.set, run.info.repetition)
    });
    for run in runs {
        table.push(columns.map(|(_, cell)| cell(run)).to_vec());
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
