//! What the report consists of.

mod format;
mod plots;
mod tables;

use super::run::LEAST_COVERED;
use super::{Device, DeviceReport, Difference, Quantity};
use format::answers;
use plots::change_plots;
use tables::{device_tables, notes_table, overview_tables};
use yoro_report::{Report, Section, Text};

pub(super) use format::count;

/// Label of the mean over all scenes of a device.
const ALL_SCENES: &str = "all scenes";

fn title(report: &DeviceReport) -> String {
    let names: Vec<&str> = report.devices.iter().map(|device| device.name.as_str()).collect();
    match names.len() {
        0..=2 => format!("Measured on {}", names.join(" and ")),
        n => format!("Measured on {n} devices{}", simulated_mark(report)),
    }
}

/// Returns the mark that titles get if values are simulated.
fn simulated_mark(report: &DeviceReport) -> &'static str {
    match report.devices.iter().all(|device| device.info.simulated) {
        _ if !report.simulated => "",
        true => " (simulated)",
        false => " (partly simulated)",
    }
}

fn warnings(report: &DeviceReport) -> Vec<String> {
    let simulated = report.devices.iter().filter(|device| device.info.simulated);
    let simulated: Vec<&str> = simulated.map(|device| device.name.as_str()).collect();
    let simulated = (!simulated.is_empty()).then(|| {
        let names = simulated.join(", ");
        format!(
            "Simulated: the figures of {names} come from simulated devices and say nothing about any device."
        )
    });
    let baseline = &report.baseline;
    let without = report.devices.iter().filter(|device| !device.methods.contains(baseline)).map(|device| {
        let name = &device.name;
        format!("{name} has no run of {baseline}: nothing is compared there. Name another baseline, or measure one.")
    });
    simulated.into_iter().chain(without).collect()
}

impl Device {
    /// Returns the scenes, and `None` for all of them.
    fn rows(&self) -> impl Iterator<Item = Option<&str>> {
        self.scenes.iter().map(|scene| Some(scene.as_str())).chain([None])
    }
}

impl DeviceReport {
    pub(super) fn report(&self) -> Report {
        let mark = simulated_mark(self);
        let mut overview = Section::new(format!("Change per device{mark}"), "");
        overview_tables(self).into_iter().for_each(|table| overview.table(table));
        let mut sections = if overview.is_empty() { vec![] } else { vec![overview] };
        for device in &self.devices {
            let mut section = Section::new(&device.name, "");
            section.text(Text::quiet(facts(self, device)));
            change_plots(self, device).into_iter().for_each(|plot| section.plot(plot));
            device_tables(self, device).into_iter().for_each(|table| section.table(table));
            sections.push(section);
        }
        let mut doubts = Section::new(format!("What does not count, and what went wrong{mark}"), "");
        doubts.table(notes_table("What does not count", &self.left_out, mark));
        doubts.table(notes_table("What went wrong", &self.faults, mark));
        let mut method = Section::new("How to read this", "");
        method_notes(self).into_iter().for_each(|note| method.text(note));
        method.text(Text::quiet(format!("`{}`", self.made_by)));
        sections.extend([doubts, method]);
        let warnings = warnings(self).into_iter().map(Text::warning);
        let summary = warnings.chain(answers(self).into_iter().map(Text::from)).collect();
        Report { title: title(self), summary, sections }
    }

    /// Returns the answers for a terminal.
    pub fn to_text(&self) -> String {
        let mut lines = [warnings(self), answers(self)].concat();
        let whole = self.runs.iter().filter(|run| run.exclusions.is_empty()).count();
        let (runs, faults) = (self.runs.len(), self.faults.len());
        lines.push(format!("{whole} of {runs} runs count in full; {faults} faults are named in the report."));
        lines
            .extend(self.left_out.iter().map(|note| format!("{}: {} ({})", note.of, note.detail, note.name)));
        lines.iter().map(|line| line.replace("**", "") + "\n").collect()
    }

    /// Returns the methods of a device that are compared with the baseline.
    fn compared<'a>(&'a self, device: &'a Device) -> impl Iterator<Item = &'a String> {
        device.methods.iter().filter(|method| **method != self.baseline)
    }

    fn find(
        &self,
        device: &str,
        scene: Option<&str>,
        method: &str,
        quantity: Quantity,
    ) -> Option<&Difference> {
        self.differences.iter().find(|d| {
            d.device == device && d.scene.as_deref() == scene && d.method == method && d.quantity == quantity
        })
    }
}

fn facts(report: &DeviceReport, device: &Device) -> String {
    let runs = device.runs(&report.runs).count();
    let whole = device.runs(&report.runs).filter(|run| run.exclusions.is_empty()).count();
    let mut facts = format!("Android {}", device.info.android);
    facts += &device.info.capacity_mah.map(|c| format!(", battery {c:.0} mAh")).unwrap_or_default();
    if device.cells > 1 {
        facts += &format!(", current x {} cells", device.cells);
    }
    if !device.applications.is_empty() {
        let applications: Vec<&str> = device.applications.iter().map(String::as_str).collect();
        facts += &format!(", application {}", applications.join(" and "));
    }
    format!("{facts}; {whole} of {runs} runs count in full.")
}

fn method_notes(report: &DeviceReport) -> [String; 4] {
    [
        "Power is current x voltage, integrated by trapezoids over the times of the samples. Gaps are not bridged. The CPU's \
         load is in percent of one core; MB are 10^6 bytes; frame and GPU times are means over frames."
            .into(),
        format!(
            "A run gives one value of each quantity. Intervals rest on repetitions: methods are compared with the baseline, \
             {}, by runs of the same device, scene and repetition.",
            report.baseline
        ),
        "A change in percent is the geometric mean of the pairs' ratios, its interval Student's t of their logarithms. \
         Over scenes, each weighs the same, and the scatter of the repetitions around their scenes is pooled. Where each \
         scene was measured once, the interval rests on the scatter of the scenes, and is marked."
            .into(),
        format!(
            "A run does not count if it was interrupted or failed, the device or the application was started anew, or \
             less than {:.0} % of it was measured. Its power does not count while plugged in, or without current.",
            100.0 * LEAST_COVERED
        ),
    ]
}
