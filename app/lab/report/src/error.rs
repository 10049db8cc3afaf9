//! The error when a report cannot be made.

use crate::plot::PlotError;
use yoro_files::FileError;

/// The error when a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The template and the data do not match.
    #[error("cannot fill in the report's template: {0}")]
    Template(#[from] minijinja::Error),
    /// A plot could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A picture could not be encoded.
    #[error("cannot encode a picture of the report: {0}")]
    Picture(#[from] image::ImageError),
    /// The figures cannot be written as JSON.
    #[error("cannot write the report as JSON: {0}")]
    Json(#[from] serde_json::Error),
}
