//! Errors of the viewer.

use yoro_gl::GlError;
use yoro_lenses::ParamsError;
use yoro_render::stereo::StereoError;

/// An error after which the viewer cannot continue. A scene that cannot be loaded is not such an error: its reason is
/// shown to the user, see [`Viewer::failure`](crate::Viewer::failure).
#[derive(Debug, thiserror::Error)]
pub enum ViewerError {
    /// The viewer's parameters are missing or wrong.
    #[error(transparent)]
    Params(#[from] ParamsError),
    /// The scene does not exist.
    #[error("{0}")]
    NoScene(String),
    /// A GL operation failed.
    #[error(transparent)]
    Gl(#[from] GlError),
    /// A method cannot render a frame.
    #[error(transparent)]
    Stereo(#[from] StereoError),
    /// A call that needs a GL context came before [`Viewer::attach`](crate::Viewer::attach) or after
    /// [`Viewer::detach`](crate::Viewer::detach).
    #[error("the viewer has no GL context: attach one first")]
    NoContext,
}
