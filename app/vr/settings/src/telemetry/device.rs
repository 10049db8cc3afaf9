//! The state of the device.

use super::power::BatteryStatus;

/// The state of the device, queried about once a second. Values that the device does not report are `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeviceState {
    /// Battery current as the device reports it (Android: `BATTERY_PROPERTY_CURRENT_NOW`), in the device's own unit and
    /// sign. `None` for the platform's "unsupported" value (`Integer.MIN_VALUE`).
    pub current_raw: Option<i64>,
    /// The state of the battery.
    pub status: Option<BatteryStatus>,
    /// Battery voltage in millivolts.
    pub voltage_mv: Option<i32>,
    /// Battery level in percent.
    pub level_percent: Option<i32>,
    /// Remaining charge in microampere-hours.
    pub charge_counter_uah: Option<i64>,
    /// The kind of power supply, 0 for none (Android: `EXTRA_PLUGGED`).
    pub plugged: Option<i32>,
    /// Battery temperature in degrees Celsius.
    pub battery_celsius: Option<f32>,
    /// Temperature of the device's skin in degrees Celsius.
    pub skin_celsius: Option<f32>,
    /// Thermal status, 0 (none) to 6 (shutdown), as in `AThermalStatus`.
    pub thermal_status: Option<i32>,
    /// Forecast thermal headroom, where 1 is severe throttling (`AThermal_getThermalHeadroom`). `None` instead of NaN.
    pub thermal_headroom: Option<f32>,
    /// The performance modes in use: `sustained` (Android's sustained performance mode), `hints` (performance hints),
    /// `sustained/hints` or `none`. `None` on headsets, where the request goes to the runtime.
    pub performance: Option<&'static str>,
}
