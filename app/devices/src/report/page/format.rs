//! Figures as text.

use crate::report::{Difference, Quantity};
use yoro_figures::inference::{Basis, BlockInterval, Interval};

/// Mark after an interval that rests on scenes or devices.
pub const OVER_BLOCKS: &str = " †";

/// Formats a count: `1 run`, `2 runs`.
pub fn count(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

pub fn number(quantity: Quantity, value: f64) -> String {
    format!("{value:.0$}", quantity.decimals())
}

/// Returns decimals and unit of a change.
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

/// Formats a value with its sign, but for a zero.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    let is_zero = !text.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    if is_zero { text[1..].to_owned() } else { text }
}

/// Formats an interval: `[-31.0, -22.5]`, marked where it does not rest on repetitions; nothing without one.
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

/// An interval of no width says that the device rounds, not that nothing varies.
pub const NO_SCATTER: &str = "no scatter was seen";

pub fn without_scatter(low: f64, high: f64) -> bool {
    (high - low).abs() < 1e-9 * (1.0 + low.abs())
}
