//! The user's wish to stop: long work looks here between two steps, so that no half-made file stays.

use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Asks all long work of this process to end at its next step; returns whether that had been asked for before. May be
/// called from a signal handler.
pub fn request() -> bool {
    REQUESTED.swap(true, Ordering::Relaxed)
}

/// True if long work is to end.
pub fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// The user has asked for the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("interrupted: nothing of an unfinished step was written")]
pub struct Interrupted;

/// Ends a long loop when the user has asked for it.
///
/// # Errors
/// [`Interrupted`] then.
pub fn check() -> Result<(), Interrupted> {
    if requested() { Err(Interrupted) } else { Ok(()) }
}
