//! Reports of measurements: one page for all of them, its tables as Markdown, and the paper's own figures.
//!
//! A [`Report`] is a list of [`Section`]s; a section consists of [`Text`], [`Table`]s, [`Plot`]s and [`Pictures`]. What
//! measures says what its sections are; this crate knows how they look:
//!
//! ```
//! use yoro_report::{Axis, Cell, Entry, Plot, Report, Section, Table};
//!
//! let mut section = Section::new("Frame time", "A whole stereo frame, **both** eyes.");
//! let mut table = Table::new("Medians", &["<scene", "two renders, ms", "yoro, ms"]);
//! table.push(vec![Cell::plain("street"), Cell::base(Some("18.9")), Cell::ours(Some("11.5"))]);
//! section.table(table);
//! let mut plot = Plot::rows("Frame time over two renders", Axis::new("ratio").baseline(1.0)).caption("Less is better.");
//! plot.mark("street", Entry::ours("yoro"), 0.61);
//! plot.mark("street", Entry::papers("yoro-paper", "the paper's"), 0.51);
//! section.plot(plot);
//! let report = Report { title: "Methods side by side".into(), sections: vec![section], ..Report::default() };
//! assert!(report.to_html()?.contains("<svg") && report.to_markdown().contains("| street | 18.9 | 11.5 |"));
//! # Ok::<(), anyhow::Error>(())
//! ```
//!
//! This crate must never know how anything is rendered or measured.

mod page;
pub mod palette;
pub mod paper;
mod pictures;
mod plot;
mod report;
pub mod stats;
mod table;
pub mod text;

pub use pictures::{OtherEye, Picture, Pictures};
pub use plot::{Axis, Entry, Plot};
pub use report::{Block, Report, ReportFiles, Section, Text, Tone};
pub use table::{Cell, Kind, Table};
