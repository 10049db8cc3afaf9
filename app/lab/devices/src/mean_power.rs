//! Checks whether a measured power is plausible.

use std::ops::RangeInclusive;

use super::capture::{Fault, FaultKind, Sample};

/// Plausible power of a phone or headset while rendering, in milliwatts. Outside this range current or voltage are
/// wrong, usually by their unit.
const PLAUSIBLE_MILLIWATTS: RangeInclusive<f64> = 100.0..=30_000.0;

/// Returns a sentence if a mean power in milliwatts is implausible, but `None` while charging (up to 0).
pub fn implausible(milliwatts: f64) -> Option<String> {
    let is_wrong = milliwatts > 0.0 && !PLAUSIBLE_MILLIWATTS.contains(&milliwatts);
    let (least, most) = (PLAUSIBLE_MILLIWATTS.start(), PLAUSIBLE_MILLIWATTS.end() / 1e3);
    is_wrong.then(|| {
        format!(
            "a mean power of {milliwatts:.1} mW is implausible (below {least} mW or above {most} W): the unit of the \
             battery's current or voltage is another one"
        )
    })
}

/// The mean power of a run so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeanPower {
    sum_milliwatts: f64,
    seconds: u64,
}

impl MeanPower {
    /// Adds one second. Ignores it if current or voltage are missing or a charger is plugged in.
    pub fn add(&mut self, sample: &Sample) {
        if let (Some(current), Some(voltage), None | Some(0)) =
            (sample.current_ma, sample.voltage_mv, sample.plugged)
        {
            self.sum_milliwatts -= current * voltage / 1e3;
            self.seconds += 1;
        }
    }

    /// Returns a fault if the mean power is implausible.
    pub fn fault(&self) -> Option<Fault> {
        let detail = implausible(self.sum_milliwatts / self.seconds.max(1) as f64)?;
        Some(Fault { kind: FaultKind::ImplausiblePower, at_s: None, detail })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_outside_of_plausible_bounds_is_named() {
        for (milliwatts, wrong) in
            [(2.1, true), (99.0, true), (101.0, false), (3500.0, false), (38_000.0, true), (-5.0, false)]
        {
            assert_eq!(implausible(milliwatts).is_some(), wrong, "{milliwatts}");
        }
        let mut mean = MeanPower::default();
        assert_eq!(mean.fault(), None);
        let second = Sample { current_ma: Some(-0.5), voltage_mv: Some(4000.0), ..Sample::default() };
        mean.add(&second);
        mean.add(&Sample { plugged: Some(2), current_ma: Some(-9e9), ..second.clone() });
        assert!(mean.fault().is_some_and(|fault| fault.detail.contains("2.0 mW")), "{mean:?}");
    }
}
