//! The report's result for each method, as a sentence.

use serde::Serialize;

use super::format::{NO_SCATTER, change, change_format, count, number, signed, without_scatter};
use crate::capture::FaultKind;
use crate::report::{CONFIDENCE, DeviceReport, Quantity};
use yoro_report::inference::{Basis, BlockInterval, Interval};

/// The result of a method on a device: how much a quantity has changed, from which value to which, and the interval.
#[derive(Serialize)]
pub struct Answer {
    device: String,
    method: String,
    changes: Vec<AnswerChange>,
    how_sure: String,
}

#[derive(Serialize)]
pub struct AnswerChange {
    /// The change, such as `-22.7 %`, or a dash if there is no pair.
    change: String,
    name: &'static str,
    /// `1939 mW instead of 2510 mW`.
    values: String,
    /// The interval, such as `95 % interval -24.1 to -21.3 %`. Empty if there is none.
    interval: String,
}

impl Answer {
    /// Returns the result as a sentence.
    pub fn sentence(&self) -> String {
        let change = |c: &AnswerChange| {
            let interval = if c.interval.is_empty() { String::new() } else { format!(", {}", c.interval) };
            format!("{} {} ({}{interval})", c.name, c.change, c.values)
        };
        let changes: Vec<String> = self.changes.iter().map(change).collect();
        format!("{}, {}: {}. {}", self.device, self.method, changes.join("; "), self.how_sure)
    }
}

/// Returns the results of all methods on all devices.
pub fn answers(report: &DeviceReport) -> Vec<Answer> {
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
            let of_device = report.runs.iter().filter(|run| run.device == device.name);
            let wrong = of_device.flat_map(|run| &run.faults).find(|fault| fault.kind == FaultKind::Pictures);
            let how_sure = match wrong {
                Some(fault) => format!(
                    "WRONG PICTURES on this device, so its figures mean nothing ({}). {how_sure}",
                    fault.detail
                ),
                None => how_sure,
            };
            let (device, method) = (device.name.clone(), method.clone());
            answers.push(Answer { device, method, changes: changes.into(), how_sure });
        }
    }
    answers
}
