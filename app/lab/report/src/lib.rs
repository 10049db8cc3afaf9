//! Statistics, plots, tables and self-contained pages for measurements.
//!
//! The crate turns numbers, titles and captions into SVG, HTML and Markdown. [`inference`] has intervals and tests,
//! [`stats`] summarizes samples, [`plot`] draws, [`grid`] holds tables, [`page`] fills in templates, and
//! [`paper`] has the paper's figures, which are printed beside ours.
//!
//! This crate must never know how anything is rendered or measured.

mod error;
mod files;
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
pub use files::ReportFiles;
