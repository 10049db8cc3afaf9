//! Measuring on phones and headsets: from a device to figures.
//!
//! ```text
//! adb / replayed device ──> capture (a folder a run) ──> report (power, FPS, ... per method and scene)
//! ```

pub mod capture;
pub mod report;
