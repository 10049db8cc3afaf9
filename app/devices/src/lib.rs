//! Measuring on phones and headsets over adb, and user studies.
//!
//! ```text
//! adb or a replay ──> capture (a folder for each run) ──> report (power, FPS, ... by method and scene)
//! plan of a study ──> ratings (CSV, or lines of the log) ──> analysis
//! ```
//!
//! It takes devices, plans of experiments and captures, and gives captures and reports. [`adb`] is the interface to
//! devices: [`program`] implements it by the program adb, [`replay`] by a script. [`follow`] reads a log over lost
//! connections, [`reading`] makes samples of its lines ([`foreign`] finds those of other applications), [`run`] captures
//! one run, [`experiment`] many, and [`report`] makes figures of them. [`study`] plans and analyses user studies.
//!
//! This crate must never know OpenGL, how anything is rendered, or the command line.

pub mod adb;
pub mod capture;
pub mod experiment;
pub mod follow;
pub mod foreign;
mod latin;
pub mod log;
pub mod phone;
pub mod pins;
pub mod plausible;
pub mod program;
pub mod reading;
pub mod replay;
pub mod report;
pub mod run;
pub mod study;
mod table;
