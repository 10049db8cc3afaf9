//! Battery current in milliamperes, from devices' own units and signs, and energy over a session.
//!
//! By Android's specification the current is in microamperes and negative while the battery discharges. Some devices
//! report milliamperes, and some report positive values while discharging.

/// The state of the battery, as in Android's `BATTERY_STATUS_*`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BatteryStatus {
    /// Charging (2).
    Charging,
    /// Discharging (3).
    Discharging,
    /// Plugged in, not charging (4).
    NotCharging,
    /// Full (5).
    Full,
}

impl BatteryStatus {
    /// Returns the state for Android's number; `None` for unknown (1) and any other number.
    pub fn from_android(number: i32) -> Option<BatteryStatus> {
        Some(match number {
            2 => BatteryStatus::Charging,
            3 => BatteryStatus::Discharging,
            4 => BatteryStatus::NotCharging,
            5 => BatteryStatus::Full,
            _ => return None,
        })
    }

    /// Returns the name in the log line.
    pub fn name(self) -> &'static str {
        match self {
            BatteryStatus::Charging => "charging",
            BatteryStatus::Discharging => "discharging",
            BatteryStatus::NotCharging => "not-charging",
            BatteryStatus::Full => "full",
        }
    }

    /// Returns the state with this name.
    pub fn from_name(name: &str) -> Option<BatteryStatus> {
        (2..=5).filter_map(BatteryStatus::from_android).find(|status| status.name() == name)
    }
}

/// The unit in which a device reports its current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurrentUnit {
    /// Microamperes, as specified.
    Microamperes,
    /// Milliamperes, as some devices do.
    Milliamperes,
}

impl CurrentUnit {
    /// Returns `uA` or `mA`.
    pub fn name(self) -> &'static str {
        match self {
            CurrentUnit::Microamperes => "uA",
            CurrentUnit::Milliamperes => "mA",
        }
    }
}

/// No phone's battery supplies or takes 20 A, so a larger number is in microamperes.
const LARGEST_MILLIAMPERES: u64 = 20_000;
/// No device renders stereo on less than 20 mA, so a smaller number does not determine the unit.
const SMALLEST_MILLIAMPERES: u64 = 20;

/// Determines a device's unit and sign of the battery current.
#[derive(Clone, Copy, Debug, Default)]
pub struct CurrentNormalizer {
    largest: u64,
    largest_discharging: u64,
}

impl CurrentNormalizer {
    /// Returns the current in milliamperes, negative while the battery discharges; `None` while the unit is unknown.
    ///
    /// The unit is microamperes once any value was too large for milliamperes. Before that it is milliamperes if a
    /// value while discharging would be enough to run a device in milliamperes: as microamperes, all values so far
    /// would be too little. The sign is that of the battery's status, if known, or else the device's own.
    pub fn add(&mut self, raw: i64, status: Option<BatteryStatus>, plugged: Option<i32>) -> Option<f64> {
        let size = raw.unsigned_abs();
        let discharging = plugged == Some(0) || status == Some(BatteryStatus::Discharging);
        self.largest = self.largest.max(size);
        if discharging {
            self.largest_discharging = self.largest_discharging.max(size);
        }
        let milliamperes = match self.unit()? {
            CurrentUnit::Microamperes => size as f64 / 1e3,
            CurrentUnit::Milliamperes => size as f64,
        };
        let negative = match status {
            _ if discharging => true,
            Some(BatteryStatus::Charging) => false,
            _ => raw < 0,
        };
        Some(if negative { -milliamperes } else { milliamperes })
    }

    /// Returns the unit, if it is known by now.
    pub fn unit(&self) -> Option<CurrentUnit> {
        if self.largest > LARGEST_MILLIAMPERES {
            Some(CurrentUnit::Microamperes)
        } else if self.largest_discharging >= SMALLEST_MILLIAMPERES {
            Some(CurrentUnit::Milliamperes)
        } else {
            None
        }
    }
}

/// A smaller voltage is not in millivolts: some phones report whole volts, which is too coarse for energy.
pub(super) const LEAST_MILLIVOLTS: f64 = 100.0;

/// Energy taken from the battery, integrated over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Charge in milliampere-hours; positive if taken from the battery.
    pub milliampere_hours: f64,
    /// Energy in milliwatt-hours; positive if taken from the battery.
    pub milliwatt_hours: f64,
    /// Seconds over which both were integrated.
    pub seconds: f64,
}

impl Energy {
    /// Adds an interval of constant current in milliamperes (negative while discharging) and voltage in millivolts.
    pub fn add(&mut self, milliamperes: f64, millivolts: f64, seconds: f64) {
        let charge = -milliamperes * seconds / 3600.0;
        self.milliampere_hours += charge;
        self.milliwatt_hours += charge * millivolts / 1e3;
        self.seconds += seconds;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use BatteryStatus::{Charging, Discharging, Full};

    #[test]
    fn microamperes_as_specified() {
        let mut current = CurrentNormalizer::default();
        assert_eq!(current.add(-512_000, Some(Discharging), Some(0)), Some(-512.0));
        assert_eq!(current.unit(), Some(CurrentUnit::Microamperes));
        // Small values keep the unit that was determined.
        assert_eq!(current.add(-3_000, Some(Discharging), Some(0)), Some(-3.0));
    }

    #[test]
    fn positive_on_discharge_and_milliamperes() {
        let mut current = CurrentNormalizer::default();
        assert_eq!(current.add(512, Some(Discharging), None), Some(-512.0));
        assert_eq!(current.unit(), Some(CurrentUnit::Milliamperes));
        assert_eq!(current.add(-900, Some(Charging), Some(1)), Some(900.0));
    }

    #[test]
    fn unplugged_counts_more_than_a_late_status() {
        let mut current = CurrentNormalizer::default();
        assert_eq!(current.add(300_000, Some(Charging), Some(0)), Some(-300.0));
    }

    #[test]
    fn an_ambiguous_current_is_missing() {
        let mut current = CurrentNormalizer::default();
        assert_eq!(current.add(3_000, Some(Full), Some(1)), None);
        assert_eq!(current.add(0, Some(Discharging), Some(0)), None);
        assert_eq!(current.unit(), None);
    }

    #[test]
    fn extreme_values_are_not_clamped() {
        let mut current = CurrentNormalizer::default();
        assert_eq!(current.add(i64::MIN, None, None), Some(-(2f64.powi(63)) / 1e3));
    }

    #[test]
    fn energy_of_an_hour() {
        let mut energy = Energy::default();
        for _ in 0..3600 {
            energy.add(-500.0, 3700.0, 1.0);
        }
        assert!((energy.milliampere_hours - 500.0).abs() < 1e-6);
        assert!((energy.milliwatt_hours - 1850.0).abs() < 1e-6);
    }
}
