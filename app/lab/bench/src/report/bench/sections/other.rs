//! Suites without a section of their own.

use super::cells::cell;
use super::tables::push_refusals;
use crate::bench;
use crate::report::bench::data::Suite;
use yoro_report::stats::unique;
use yoro_report::text::fixed;
use yoro_report::{Cell, Section, Table};

/// Returns a section with every metric of a suite.
pub fn section(suite: &Suite) -> Section {
    let known = bench::Suite::EACH.iter().find(|known| known.name() == suite.name);
    let intro = known.map_or_else(String::new, |known| format!("{}.", known.about()));
    let mut section = Section::new(title(&suite.name), intro);
    let measured = suite.settings.iter().flat_map(|setting| &setting.contenders);
    let metrics = unique(measured.flat_map(|measured| measured.metrics()));
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

/// Returns the name of a suite as a title: "Guard band".
fn title(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters.map(|c| if c == '-' { ' ' } else { c })).collect()
}
