//! Formats numbers for the report.

use crate::report::{Difference, Quantity};
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
pub fn change_format(difference: &Difference) -> (usize, &'static str) {
    match difference.quantity {
        _ if difference.in_percent() => (1, "%"),
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
pub fn signed(value: f64, decimals: usize) -> String {
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
