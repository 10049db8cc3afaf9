//! Frame times, power and temperature of a device, once a second as one line of text.
//!
//! [`Telemetry`] collects frames and device states and makes the [`Line`]s and the [`SessionSummary`]. A value that a
//! device does not report is missing ([`None`], `na` in text), never 0.

mod collect;
mod device;
mod frames;
mod line;
mod pictures;
mod power;
mod process;
mod rating;
pub mod stats;
mod summary;
mod text;

pub use collect::Telemetry;
pub use device::DeviceState;
pub use frames::{FrameStatistics, SecondStatistics};
pub use line::{LINE_KEYS, Line, LineKey, StageTime};
pub use pictures::Pictures;
pub use power::{BatteryStatus, CurrentNormalizer, CurrentUnit, Energy};
pub use process::{ProcessSample, cpu_load};
pub use rating::Rating;
pub use summary::SessionSummary;
pub use text::{Field, LineError, VERSION, fields};

/// The tag of the log lines on Android.
pub const LOG_TAG: &str = "YORO";
