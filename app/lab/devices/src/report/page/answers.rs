//! The report's result for each method, as a sentence.

use super::format::{NO_SCATTER, change, change_format, count, number, signed, without_scatter};
use crate::capture::FaultKind;
use crate::report::{CONFIDENCE, Device, DeviceReport, Difference, Quantity};
use yoro_report::{Basis, BlockInterval, Interval};

/// Returns the results of all methods on all devices: by how much power and frame rate have changed, from which value to
/// which, and how sure that is.
pub fn answers(report: &DeviceReport) -> Vec<String> {
    let compared = report.devices.iter().flat_map(|device| {
        let methods = device.methods.iter().filter(|method| **method != report.baseline);
        methods.map(move |method| (device, method))
    });
    compared.map(|(device, method)| answer(report, device, method)).collect()
}

fn answer(report: &DeviceReport, device: &Device, method: &str) -> String {
    let find = |quantity| report.find(Some(&device.name), None, method, quantity);
    let changes = [Quantity::Power, Quantity::Fps].map(|quantity| match find(quantity) {
        None => format!("{} – (no two runs to compare)", quantity.name()),
        Some(found) => format!("{} **{}** ({})", quantity.name(), change(found), values(found)),
    });
    let of_device = report.runs_of(device).flat_map(|run| &run.faults);
    let wrong = of_device.filter(|fault| fault.kind == FaultKind::Pictures).map(|fault| {
        format!("WRONG PICTURES on this device, so its figures mean nothing ({}). ", fault.detail)
    });
    let doubt = wrong.take(1).collect::<String>();
    let found = find(Quantity::Power).or(find(Quantity::Fps));
    let how_sure = found.map_or("No run of it has a partner.".into(), |found| {
        let scenes = report.scenes_of(&device.name, method, found.quantity);
        let basis = match found.interval.map(|interval| interval.basis) {
            None => "nothing was repeated, so there is no interval",
            Some(Basis::Repetitions) => "intervals rest on the repetitions",
            Some(Basis::Blocks) => "every scene was measured once, so intervals rest on the scenes",
        };
        format!("{} of runs on {}; {basis}.", count(found.pairs, "pair"), count(scenes, "scene"))
    });
    format!("{}, {method}: {}. {doubt}{how_sure}", device.name, changes.join("; "))
}

/// Returns both values and the interval of the change: `406 mW instead of 500 mW, 95 % interval -22.0 to -15.3 %`.
fn values(found: &Difference) -> String {
    let value = |value| format!("{} {}", number(found.quantity, value), found.quantity.unit());
    let interval = found.interval.map(|BlockInterval { interval: Interval { low, high }, .. }| {
        if without_scatter(low, high) {
            return format!(", {NO_SCATTER}");
        }
        let (decimals, unit) = change_format(found);
        let (low, high) = (signed(low, decimals), signed(high, decimals));
        format!(", {:.0} % interval {low} to {high} {unit}", 100.0 * CONFIDENCE)
    });
    format!("{} instead of {}{}", value(found.ours), value(found.baseline), interval.unwrap_or_default())
}
