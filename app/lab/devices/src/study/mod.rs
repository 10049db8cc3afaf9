//! User studies: the plan of trials, the ratings and their analysis.
//!
//! ```text
//! plan (orders from a seed) ──> the viewer, or paper ──> ratings (CSV, or lines of the log) ──> analysis
//! ```

mod analysis;
mod page;
mod plan;
mod ratings;

pub use analysis::Study;
pub use plan::{Condition, Plan, Trials, read_trials};
pub use ratings::{Collected, Ratings};
