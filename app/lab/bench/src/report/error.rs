//! The error when a report cannot be made.

use std::path::PathBuf;

use yoro_files::FileError;
use yoro_media::PictureError;
use yoro_metrics::MetricsError;

/// The error when a report cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A picture could not be encoded.
    #[error("cannot encode a picture of the report: {0}")]
    Picture(#[from] image::ImageError),
    /// A page or a figure could not be made.
    #[error(transparent)]
    Figures(#[from] yoro_report::ReportError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Plot(#[from] yoro_report::plot::PlotError),
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
