//! Battery current in milliamperes, from devices' own units and signs; energy over a session.
//!
//! By Android's specification the current is in microamperes and negative while the battery discharges. Some
//! devices report milliamperes, and some are positive on discharge.

/// The state of the battery, as Android's `BATTERY_STATUS_*`.
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
    /// Returns the state of Android's number; `None` for unknown (1) and everything else.
    pub fn from_android(number: i32) -> Option<BatteryStatus> {
        Some(match number {
            2 => BatteryStatus::Charging,
            3 => BatteryStatus::Discharging,
            4 => BatteryStatus::NotCharging,
            5 => BatteryStatus::Full,
            _ => return None,
        })
    }

    /// The name in the log line.
    pub fn name(self) -> &'static str {
        match self {
            BatteryStatus::Charging => "charging",
            BatteryStatus::Discharging => "discharging",
            BatteryStatus::NotCharging => "not-charging",
            BatteryStatus::Full => "full",
        }
    }

    /// Returns the state of a name.
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
    /// `uA` or `mA`.
    pub fn name(self) -> &'static str {
        match self {
            CurrentUnit::Microamperes => "uA",
            CurrentUnit::Milliamperes => "mA",
        }
    }
}

/// No phone's battery takes or gives 20 A: a larger number is in microamperes.
const LARGEST_MILLIAMPERES: u64 = 20_000;
/// No device renders stereo from less than 20 mA: a smaller number says nothing about its unit.
const SMALLEST_MILLIAMPERES: u64 = 20;

/// Finds a device's unit and sign.
#[derive(Clone, Copy, Debug, Default)]
pub struct CurrentNormalizer {
    largest: u64,
    largest_discharging: u64,
}

impl CurrentNormalizer {
    /// The current in milliamperes, negative while the battery discharges; `None` while the unit cannot be told.
    ///
    /// The unit is microamperes once any value was too large for milliamperes, and milliamperes if values while
    /// discharging are such that microamperes would be too little to run a device on. The sign is that of the
    /// battery's status; only where that leaves it open it is the device's own.
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

    /// The unit, if it is known by now.
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

/// A smaller voltage is no number of millivolts: some phones give it in whole volts, which is too coarse for energy.
pub(super) const LEAST_MILLIVOLTS: f64 = 100.0;

/// Energy taken from the battery, integrated over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Charge in milliampere-hours, positive when taken from the battery.
    pub milliampere_hours: f64,
    /// Energy in milliwatt-hours, likewise.
    pub milliwatt_hours: f64,
    /// Seconds over which both were integrated.
    pub seconds: f64,
}

impl Energy {
    /// Adds a time at constant current (negative while discharging) and voltage.
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
        // Small values stay in the unit that was found.
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
