//! Measuring on phones and headsets over adb, and user studies.
//!
//! ```text
//! adb ──> capture (a folder for each run) ──> report (power, FPS, ... by method and scene)
//! plan of a study ──> ratings (CSV, or lines of the log) ──> analysis
//! ```
//!
//! The inputs are devices, plans of experiments and captures; the outputs are captures and reports. [`adb`] reaches devices
//! with the program adb, `follow` reads a log across lost connections, [`reading`] parses its lines into samples,
//! [`run`] captures one run, [`experiment`] many, [`farm`] reads what device farms give back, and [`report`] computes figures from them. [`study`] plans and analyses user studies.
//!
//! This crate must not depend on OpenGL, rendering or the command line.

pub mod adb;
pub mod capture;
mod error;
pub mod experiment;
pub mod farm;
mod follow;
pub mod held_settings;
mod latin_square;
pub mod log;
pub mod phone;
pub mod reading;
pub mod report;
pub mod run;
pub mod study;
mod table;

pub use error::DataError;
