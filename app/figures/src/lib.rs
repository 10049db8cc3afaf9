//! Statistics, plots, tables and self-contained pages for measurements.
//!
//! It takes numbers, titles and captions, and gives SVG, HTML and Markdown. [`inference`] has intervals and tests,
//! [`bd_rate`] compares rate-distortion curves, [`plot`] draws, [`grid`] holds tables, [`page`] fills in templates, and
//! [`paper`] has the figures of the paper that stand beside ours.
//!
//! This crate must never know how anything is rendered or measured.

pub mod bd_rate;
mod error;
pub mod grid;
pub mod inference;
pub mod page;
pub mod palette;
pub mod paper;
pub mod plot;
pub mod stats;
mod student;
pub mod text;

pub use error::ReportError;
