//! The error when a report cannot be made.

use std::path::PathBuf;

use yoro_media::PictureError;
use yoro_metrics::MetricsError;

/// The error when a report cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The page could not be made or written.
    #[error(transparent)]
    Page(#[from] yoro_report::ReportError),
    /// A file of results holds no finished round.
    #[error("{} holds no finished round: let yoro bench finish one, then report", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A picture that a run saved cannot be used.
    #[error(transparent)]
    PictureFile(#[from] PictureError),
    /// The pictures of a setting do not have the same size.
    #[error("the pictures in {} do not go together ({source}): measure again, or remove the folder", path.display())]
    Sizes {
        /// The folder.
        path: PathBuf,
        /// The mistake.
        source: MetricsError,
    },
    /// The figures cannot be written as JSON.
    #[error("cannot write the report as JSON: {0}")]
    Json(#[from] serde_json::Error),
}
