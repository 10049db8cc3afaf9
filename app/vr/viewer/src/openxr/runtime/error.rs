//! Reasons why no runtime was found.

use std::fmt;

use super::places::RuntimeSource;

/// No place led to a runtime. `Display` writes all failures in one line.
#[derive(Debug)]
pub struct NotFound {
    /// The places in the order in which they were tried. A broker that offers several runtimes appears once for each.
    pub attempts: Vec<(RuntimeSource, Failure)>,
}

impl NotFound {
    /// True if no place names a library, as on a phone: nothing is installed. Otherwise a runtime is installed but does
    /// not work.
    pub fn nothing_installed(&self) -> bool {
        self.attempts.iter().all(|(place, failure)| {
            matches!(
                (place, failure),
                (_, Failure::Absent(_)) | (RuntimeSource::Loader(_), Failure::Unloadable(_))
            )
        })
    }
}

impl fmt::Display for NotFound {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "no OpenXR runtime was found")?;
        for (i, (_, failure)) in self.attempts.iter().enumerate() {
            write!(f, "{} {failure}", if i == 0 { ":" } else { ";" })?;
        }
        Ok(())
    }
}

impl std::error::Error for NotFound {}

/// A failure at one place. Its sentence names the failed step, and the file, library or broker.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// Nothing is installed here: no manifest, no broker, or none with an active runtime.
    #[error("{0}")]
    Absent(String),
    /// The library cannot be loaded.
    #[error("{0}")]
    Unloadable(String),
    /// What is installed here does not work.
    #[error("{0}")]
    Unusable(String),
}
