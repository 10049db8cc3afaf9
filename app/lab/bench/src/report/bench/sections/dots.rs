//! Dot plots with a row for each setting.

use super::cells::PAPERS;
use crate::report::bench::data::{SettingData, Suite};
use yoro_report::paper;
use yoro_report::plot::{Axis, DotRow, Mark, Panel};

/// Returns a mark for the paper's figure of the system that a method here corresponds to.
pub fn papers_mark(method: &str, value: f64) -> Mark {
    Mark::papers(method, format!("{PAPERS}{}", paper::system(method)), value)
}

/// Returns a dot plot with a row for each setting.
pub fn scene_dots(
    suite: &Suite,
    axis: Axis,
    contenders: &[&str],
    value: impl Fn(&SettingData, &str) -> Option<f64>,
    papers: impl Fn(&SettingData) -> Vec<(&'static str, f64)>,
) -> Panel {
    let rows = suite.settings.iter().map(|setting| {
        let paper = papers(setting).into_iter().map(|(method, value)| papers_mark(method, value));
        // The first contender is drawn on top of others with equal figures.
        let ours = contenders.iter().rev().filter_map(|name| {
            let value = value(setting, name)?;
            Some(Mark::new(*name, *name, value))
        });
        DotRow { label: setting.label(), marks: paper.chain(ours).collect() }
    });
    Panel::Dots { value: axis, rows: rows.collect() }
}
