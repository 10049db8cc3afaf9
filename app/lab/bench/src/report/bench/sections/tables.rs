//! Tables that several experiments share.

use super::cells::{cell, milliseconds};
use crate::bench::record::metric;
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::stats::{mean, percentile};
use yoro_report::text::{fixed, short_count};
use yoro_report::{Cell, Table};

/// A column of the paper's figures.
pub struct PaperColumn<'a> {
    /// Its head.
    pub head: &'a str,
    /// The text beside a setting.
    pub text: &'a dyn Fn(&SettingData) -> Option<String>,
    /// The text beside the means.
    pub mean: String,
}

/// Returns a table with a row for each setting and a column for each contender, followed by the means and by the
/// contenders that were not measured.
pub fn scene_table(
    suite: &Suite,
    title: &str,
    contenders: &[&str],
    text: impl Fn(&SettingData, &str) -> Option<String>,
    mean_text: impl Fn(&str) -> Option<String>,
    paper: Option<PaperColumn>,
) -> Table {
    let mut columns = vec!["<scene".to_owned(), "triangles".to_owned()];
    columns.extend(contenders.iter().map(|name| name.to_string()));
    columns.extend(paper.iter().map(|paper| paper.head.to_owned()));
    let mut table = Table::new(title, &columns);
    for setting in &suite.settings {
        let mut cells = vec![Cell::plain(setting.label()), Cell::plain(triangles(setting))];
        for name in contenders {
            let refused = setting.unsupported.iter().any(|(other, _)| other == name);
            let text = text(setting, name).or_else(|| refused.then(|| "not measured".to_owned()));
            cells.push(cell(name, text));
        }
        cells.extend(paper.iter().map(|paper| Cell::paper((paper.text)(setting))));
        table.push(cells);
    }
    let mut cells = vec![Cell::plain(format!("mean of {}", suite.settings.len())), Cell::plain("")];
    cells.extend(contenders.iter().map(|name| cell(name, mean_text(name))));
    cells.extend(paper.map(|paper| Cell::paper(Some(paper.mean))));
    table.push_first(cells);
    push_refusals(&mut table, suite);
    table
}

fn triangles(setting: &SettingData) -> String {
    setting.facts.as_ref().map_or_else(String::new, |facts| short_count(facts.triangles))
}

/// Adds a row with the reason for each contender that could not take part, in the whole suite or in some settings.
pub fn push_refusals(table: &mut Table, suite: &Suite) {
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
pub fn time_details(suite: &Suite, title: &str, ratio: impl Fn(&SettingData, &str) -> Option<f64>) -> Table {
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
            let quartile = |percent| percentile(&samples, percent).unwrap_or(f64::NAN);
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

/// Returns a table with a row for each point of a sweep and a column for each contender: means over the scenes or, for
/// times, medians.
pub fn sweep_table(
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
            let here = suite.settings.iter().filter(|setting| setting.conditions.point == Some(point));
            let value = |setting: &SettingData| {
                let measured = setting.find(name)?;
                if times { measured.median(metric_name) } else { measured.mean(metric_name) }
            };
            let value = mean(here.filter_map(value));
            let decimals = if metric_name.contains("ssim") { 4 } else { 2 };
            let text = if times { value.map(milliseconds) } else { fixed(value, decimals) };
            cells.push(cell(name, text));
        }
        table.push(cells);
    }
    push_refusals(&mut table, suite);
    table
}

/// Returns a table of means over the settings, with a row for each contender and a column for each measured metric.
pub fn means_table(
    suite: &Suite,
    title: &str,
    contenders: &[&str],
    metrics: &[(&str, &str, usize)],
) -> Table {
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
            cells.push(cell(name, fixed(suite.mean(name, metric_name), *decimals)));
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

/// Returns a table of all figures, with a row for each setting and contender and a column for each metric.
pub fn metric_table(suite: &Suite, title: &str, contenders: &[&str]) -> Table {
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
