//! The user's request to stop: long work checks for it between two steps, so that no unfinished file is left.

use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Asks all long work of this process to end at its next step, and returns whether this was requested before. May be
/// called from a signal handler.
pub fn request() -> bool {
    REQUESTED.swap(true, Ordering::Relaxed)
}

/// True if long work should end.
pub fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// The error for work that the user has interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("interrupted: nothing of an unfinished step was written")]
pub struct Interrupted;

/// Checks whether the user has asked to stop.
///
/// # Errors
/// [`Interrupted`] if so.
pub fn check() -> Result<(), Interrupted> {
    if requested() { Err(Interrupted) } else { Ok(()) }
}
