//! Measuring on phones and headsets: from a device to figures.
//!
//! ```text
//! adb / replayed device ──> capture (a folder a run) ──> report (power, FPS, ... per method and scene)
//! ```
//!
//! [`adb`] says what is asked of a device; [`program`] asks the program adb, [`replay`] plays a script. [`follow`] reads a
//! log over lost connections, [`reading`] makes samples of its lines ([`foreign`] says which are those of another
//! application than this project's), [`run`] captures one run, [`experiment`] many, and [`report`] makes figures of them.
//! [`study`] plans and evaluates user studies.
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
