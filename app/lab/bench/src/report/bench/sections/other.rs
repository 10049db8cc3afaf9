//! Suites without a section of their own.

use super::cells::cell;
use super::section::Section;
use super::tables::push_refusals;
use crate::report::bench::data::Suite;
use yoro_report::grid::{Cell, Table};
use yoro_report::stats::unique;
use yoro_report::text::{fixed, slug};

/// Returns a section with every metric of a suite.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(&slug(&suite.name), &format!("Suite {}", suite.name), "");
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
