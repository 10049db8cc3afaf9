//! Numbers and results as text.

use crate::capture::FaultKind;
use crate::report::{CONFIDENCE, Device, DeviceReport, Difference, Quantity};
use yoro_report::{Basis, BlockInterval, Interval};

/// Mark behind an interval that is based on the scatter of scenes or devices.
pub const OVER_BLOCKS: &str = " †";

/// Formats a number with a noun: `1 run`, `2 runs`.
pub fn count(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

pub fn number(quantity: Quantity, value: f64) -> String {
    format!("{value:.0$}", quantity.decimals())
}

/// Returns the number of decimals and the unit of a change.
fn change_format(difference: &Difference) -> (usize, &'static str) {
    match difference.quantity {
        _ if difference.quantity.is_ratio() => (1, "%"),
        Quantity::Stale => (2, "1/s"),
        _ => (1, "K"),
    }
}

/// Formats a change: `-26.9 %`.
pub fn change(difference: &Difference) -> String {
    let (decimals, unit) = change_format(difference);
    format!("{} {unit}", signed(difference.change, decimals))
}

/// Formats a value with its sign. Zero has no sign.
fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    let is_zero = !text.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    if is_zero { text[1..].to_owned() } else { text }
}

/// Formats an interval, such as `[-31.0, -22.5]`, with a mark if it is not based on repetitions. Returns an empty text
/// if there is no interval.
pub fn change_interval(difference: &Difference) -> String {
    let (decimals, _) = change_format(difference);
    match difference.interval {
        None => String::new(),
        Some(BlockInterval { interval: Interval { low, high }, .. }) if without_scatter(low, high) => {
            format!(" [{NO_SCATTER}]")
        }
        Some(BlockInterval { interval: Interval { low, high }, basis }) => {
            let mark = if basis == Basis::Blocks { OVER_BLOCKS } else { "" };
            format!(" [{}, {}]{mark}", signed(low, decimals), signed(high, decimals))
        }
    }
}

/// Shown instead of an interval of width 0, which means that the device rounds, not that nothing varies.
pub const NO_SCATTER: &str = "no scatter was seen";

pub fn without_scatter(low: f64, high: f64) -> bool {
    (high - low).abs() < 1e-9 * (1.0 + low.abs())
}

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
    let find = |quantity| report.find(&device.name, None, method, quantity);
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
