//! The range and ticks of an axis.

use super::{Axis, Scale};

/// The range of an axis and its ticks.
pub(super) struct Range {
    pub scale: Scale,
    pub low: f64,
    pub high: f64,
    pub ticks: Vec<f64>,
}

impl Range {
    pub fn of(axis: &Axis, values: impl Iterator<Item = f64>, snap: bool) -> Range {
        let drawable = |v: &f64| v.is_finite() && (axis.scale == Scale::Linear || *v > 0.0);
        let all = values.chain(axis.include.iter().copied()).filter(drawable);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 2.0) };
        match axis.scale {
            Scale::Linear => {
                let spare = if low < high { 0.0 } else { (low.abs() * 0.1).max(1e-3) };
                let (low, high) = (low - spare, high + spare);
                let step = tick_step(high - low);
                let (first, last) = ((low / step + 1e-6).floor(), (high / step - 1e-6).ceil());
                let ticks: Vec<f64> = (first as i64..=last as i64).map(|i| i as f64 * step).collect();
                if snap {
                    return Range { scale: axis.scale, low: first * step, high: last * step, ticks };
                }
                let margin = (high - low) * 0.03;
                let (low, high) = (low - margin, high + margin);
                let ticks = ticks.into_iter().filter(|t| (low..=high).contains(t)).collect();
                Range { scale: axis.scale, low, high, ticks }
            }
            Scale::Logarithmic => {
                let (low, high) = (low / 1.2, high * 1.2);
                let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
                let steps: &[f64] = match high / low {
                    0.0..=12.0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0],
                    0.0..=1e3 => &[1.0, 2.0, 5.0],
                    _ => &[1.0],
                };
                let ticks = powers.flat_map(|p| steps.iter().map(move |s| s * 10f64.powi(p)));
                let ticks = ticks.filter(|t| (low..=high).contains(t)).collect();
                Range { scale: axis.scale, low, high, ticks }
            }
        }
    }

    /// Returns the coordinate at which a value is drawn: on logarithmic axes its decimal logarithm.
    pub fn drawn(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => value.max(f64::MIN_POSITIVE).log10(),
        }
    }

    pub fn coordinate(&self) -> std::ops::Range<f64> {
        self.drawn(self.low)..self.drawn(self.high)
    }
}

/// Returns 1, 2 or 5 times a power of ten, such that `range` holds three to eight steps.
pub(super) fn tick_step(range: f64) -> f64 {
    let power = 10f64.powf((range / 3.0).log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|step| range / step >= 3.0).unwrap_or(power)
}

/// Returns the shortest label that differs from those of its neighbours.
pub(super) fn tick_label(value: f64, ticks: &[f64], scale: Scale) -> String {
    let decimals = |step: f64| (-step.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    let label = match (scale, ticks) {
        (Scale::Linear, [a, b, ..]) => return format!("{:.1$}", value + 0.0, decimals(b - a)),
        // Two digits are enough: 1.5, 20, 0.3.
        _ => format!("{value:.0$}", decimals(value) + 1),
    };
    if label.contains('.') { label.trim_end_matches('0').trim_end_matches('.').to_owned() } else { label }
}
