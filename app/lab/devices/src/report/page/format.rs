//! Numbers and results as text.

use crate::capture::FaultKind;
use crate::report::{Device, DeviceReport, Difference, Quantity};

/// Mark behind an interval that is based on the scatter of scenes.
pub const OVER_SCENES: &str = " †";

/// Shown instead of an interval of width 0.
pub const NO_SCATTER: &str = "no scatter was seen";

/// Formats a number with a noun: `1 run`, `2 runs`.
pub fn count(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

pub fn number(quantity: Quantity, value: f64) -> String {
    format!("{value:.0$}", quantity.shown().decimals)
}

/// Returns the number of decimals and the unit of a change.
pub fn change_format(quantity: Quantity) -> (usize, &'static str) {
    match quantity {
        _ if quantity.shown().is_ratio => (1, "%"),
        Quantity::Stale => (2, "1/s"),
        _ => (1, "K"),
    }
}

/// Formats a change: `-26.9 %`.
fn change(difference: &Difference) -> String {
    let (decimals, unit) = change_format(difference.quantity);
    format!("{} {unit}", signed(difference.change, decimals))
}

/// Formats a value with its sign. Zero has no sign.
fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    let is_zero = !text.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    if is_zero { text[1..].to_owned() } else { text }
}

/// Formats the ends of an interval. `None` for one of width 0, which means that the device rounds, not that nothing varies.
pub fn ends([low, high]: [f64; 2], between: &str, number: impl Fn(f64) -> String) -> Option<String> {
    let has_width = (high - low).abs() >= 1e-9 * (1.0 + low.abs());
    has_width.then(|| format!("{}{between}{}", number(low), number(high)))
}

/// Formats a change and its interval, such as `-26.9 % [-31.0, -22.5]`, with a mark if it rests on the scenes.
pub fn change_and_interval(difference: &Difference) -> String {
    let (decimals, _) = change_format(difference.quantity);
    let mark = if difference.rests_on_scenes() { OVER_SCENES } else { "" };
    let interval = difference.interval.map(|interval| {
        let ends = ends(interval, ", ", |value| signed(value, decimals));
        ends.map_or(format!(" [{NO_SCATTER}]"), |ends| format!(" [{ends}]{mark}"))
    });
    change(difference) + &interval.unwrap_or_default()
}

/// Returns the results of all methods on all devices: by how much power and frame rate have changed, from which value to
/// which, and how sure that is.
pub fn answers(report: &DeviceReport) -> Vec<String> {
    let compared = report
        .devices
        .iter()
        .flat_map(|device| report.compared(device).map(move |method| answer(report, device, method)));
    compared.collect()
}

fn answer(report: &DeviceReport, device: &Device, method: &str) -> String {
    let find = |quantity| report.find(&device.name, None, method, quantity);
    let changes = [Quantity::Power, Quantity::Fps].map(|quantity| match find(quantity) {
        None => format!("{} – (no two runs to compare)", quantity.shown().name),
        Some(found) => format!("{} **{}** ({})", quantity.shown().name, change(found), values(found)),
    });
    let mut faults = device.runs(&report.runs).flat_map(|run| &run.info.faults);
    let wrong = faults.find(|fault| fault.kind == FaultKind::Pictures).map(|fault| {
        format!("WRONG PICTURES on this device, so its figures mean nothing ({}). ", fault.detail)
    });
    let doubt = wrong.unwrap_or_default();
    let found = find(Quantity::Power).or(find(Quantity::Fps));
    let how_sure = found.map_or("No run of it has a partner.".into(), |found| {
        let basis = match found.interval {
            None => "nothing was repeated, so there is no interval",
            Some(_) if found.rests_on_scenes() => {
                "every scene was measured once, so intervals rest on the scenes"
            }
            Some(_) => "intervals rest on the repetitions",
        };
        format!("{} of runs on {}; {basis}.", count(found.pairs, "pair"), count(found.scenes, "scene"))
    });
    format!("{}, {method}: {}. {doubt}{how_sure}", device.name, changes.join("; "))
}

/// Returns both values and the interval of the change: `406 mW instead of 500 mW, 95 % interval -22.0 to -15.3 %`.
fn values(found: &Difference) -> String {
    let value = |value| format!("{} {}", number(found.quantity, value), found.quantity.shown().unit);
    let (decimals, unit) = change_format(found.quantity);
    let interval = found.interval.map(|interval| {
        let ends = ends(interval, " to ", |value| signed(value, decimals));
        ends.map_or(format!(", {NO_SCATTER}"), |ends| format!(", 95 % interval {ends} {unit}"))
    });
    format!("{} instead of {}{}", value(found.ours), value(found.baseline), interval.unwrap_or_default())
}
