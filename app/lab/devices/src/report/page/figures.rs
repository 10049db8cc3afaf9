//! The report's figures.

use super::ALL_SCENES;
use super::tables::papers_changes;
use crate::report::{CONFIDENCE, Device, DeviceReport, Quantity, Run};
use yoro_report::plot::{Axis, DotRow, Figure, Mark, Panel, Series};
use yoro_report::text::slug;

/// Returns figures of the changes of power, frame rate and temperature by scene, with intervals.
pub fn change_figures(report: &DeviceReport, device: &Device, id: &str) -> Vec<Figure> {
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
            id: format!("{id}-{}", slug(quantity.name())),
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

/// Returns a device's name without `(simulated)`.
fn device_plain(device: &Device) -> &str {
    device.name.trim_end_matches(" (simulated)")
}

/// Returns figures of power, frame rate and temperature over time, with a thin line for each run that counts.
pub fn trace_figures(report: &DeviceReport, device: &Device, id: &str, scene: &str) -> Vec<Figure> {
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
            id: format!("{id}-{}", slug(quantity.name())),
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
