//! `yoro bench`: every method, patcher and knob of the paper, measured side by side.
//!
//! A suite is a list of [settings](Setting): a scene, and where something is swept, one point of the sweep. In
//! each round of a setting every [`Contender`] takes its turn, and the round is appended to a file of
//! [records](record) when it is over.

pub mod bandwidth;
mod contender;
pub mod record;

pub use contender::Contender;
pub use record::{Measurement, Record, RecordError, Results, Setting, Writer, metric};
