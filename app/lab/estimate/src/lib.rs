//! An estimate of what frames cost on mobile GPUs that are not at hand.

mod record;

pub use record::{Command, Draw, Recorder};
