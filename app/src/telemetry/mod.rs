//! Frame times, power and temperature of a device, once a second as one line of text.
//!
//! [`Telemetry`] collects frames and device states and makes the [`Line`]s and the [`SessionSummary`]. A value
//! that a device does not give is missing ([`None`], `na` in text), never 0.

mod frames;
mod line;
mod power;
mod process;
mod rating;
mod session;

pub use frames::{FrameStatistics, SecondStatistics};
pub use line::{Field, Line, LineError, StageTime, VERSION, fields};
pub use power::{BatteryStatus, CurrentNormalizer, CurrentUnit, Energy};
pub use process::{ProcessSample, cpu_load};
pub use rating::Rating;
pub use session::{SessionSummary, Telemetry, ViewerState};

/// The tag of the log lines on Android.
pub const LOG_TAG: &str = "YORO";

/// What the platform knows of the device, asked about once a second. `None` wherever the device does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeviceState {
    /// Battery current as the device reports it (Android: `BATTERY_PROPERTY_CURRENT_NOW`), in whatever unit and
    /// sign it uses. Leave out the platform's "unsupported" value (`Integer.MIN_VALUE`).
    pub current_raw: Option<i64>,
    /// Whether the battery charges.
    pub status: Option<BatteryStatus>,
    /// Battery voltage in millivolts.
    pub voltage_mv: Option<i32>,
    /// Battery level in percent.
    pub level_percent: Option<i32>,
    /// Remaining charge in microampere-hours.
    pub charge_counter_uah: Option<i64>,
    /// What the device is plugged into, 0 for nothing (Android: `EXTRA_PLUGGED`).
    pub plugged: Option<i32>,
    /// Battery temperature in degrees Celsius.
    pub battery_celsius: Option<f32>,
    /// Temperature of the device's skin in degrees Celsius.
    pub skin_celsius: Option<f32>,
    /// Thermal status, 0 (none) to 6 (shutdown) as `AThermalStatus`.
    pub thermal_status: Option<i32>,
    /// Forecast thermal headroom: 1 is severe throttling (`AThermal_getThermalHeadroom`). Leave out NaN.
    pub thermal_headroom: Option<f32>,
}
