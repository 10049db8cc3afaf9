//! The report's plots.

use super::ALL_SCENES;
use super::format::change_format;
use super::tables::papers_changes;
use crate::report::{Device, DeviceReport, Quantity};
use yoro_report::{Axis, Entry, Plot};

/// Returns plots of the changes of power, frame rate and temperature by scene, with intervals.
pub fn change_plots(report: &DeviceReport, device: &Device) -> Vec<Plot> {
    let quantities = [Quantity::Power, Quantity::Fps, Quantity::Temperature].into_iter();
    let is_measured = |quantity: &Quantity| {
        report.differences.iter().any(|d| d.device == device.name && d.quantity == *quantity)
    };
    quantities.filter(is_measured).map(|quantity| change_plot(report, device, quantity)).collect()
}

fn change_plot(report: &DeviceReport, device: &Device, quantity: Quantity) -> Plot {
    let mark = if device.info.simulated { " (simulated)" } else { "" };
    let name = format!("{} against {}", quantity.shown().name, report.baseline);
    let axis = Axis::new(format!("{name}, {}{mark}", change_format(quantity).1)).baseline(0.0);
    let mut plot = Plot::rows(format!("{name}{mark}"), axis).caption(format!(
        "Bars: 95 % intervals. The line is {}. Hollow: the paper's, for its own scenes and devices.",
        report.baseline
    ));
    for scene in device.rows() {
        let row = scene.unwrap_or(ALL_SCENES);
        for method in report.compared(device) {
            if let Some(ours) = report.find(&device.name, scene, method, quantity) {
                plot.mark_interval(row, Entry::ours(method), ours.change, ours.interval);
            }
            let papers = papers_changes(scene, method).and_then(|papers| match quantity {
                Quantity::Power => Some(papers[0]),
                Quantity::Fps => Some(papers[1]),
                _ => None,
            });
            let entry = match method.as_str() {
                "hybrid" => Entry::papers("hybrid", "the paper's Fink et al."),
                _ => Entry::papers("yoro-paper", "the paper's YORO"),
            };
            plot.mark(row, entry, papers.unwrap_or(f64::NAN));
        }
    }
    plot
}
