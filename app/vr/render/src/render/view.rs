//! The interface of both kinds of renderer: rendering one view.

use std::rc::Rc;

use super::common::Common;
use super::request::DrawRequest;
use super::scene::GpuScene;
use super::settings::RenderSettings;
use yoro::eyes::View;
use yoro_gl::{Context, GlError, RenderTarget, Texture};

/// A renderer of one kind, made for one scene.
pub(crate) trait ViewRenderer: Sized {
    /// The images of one view.
    type Targets: ViewImages;

    /// Returns what both kinds of renderer share.
    fn common(&self) -> &Common;

    /// Makes targets, to be fitted to each view that is rendered.
    ///
    /// # Errors
    /// As [`RenderTarget::new`]; [`GlError::Unsupported`] if the driver lacks the settings' number of samples.
    fn targets(gl: &Rc<Context>, settings: &RenderSettings) -> Result<Self::Targets, GlError>;

    /// Renders opaque surfaces. Where nothing is drawn, depth is the far value and colour is the sky.
    ///
    /// # Errors
    /// As [`RenderTarget::new`], if the targets must change their size.
    fn render(
        &self,
        targets: &mut Self::Targets,
        scene: &GpuScene,
        view: &View,
        request: &DrawRequest,
    ) -> Result<(), GlError>;

    /// Renders all of a scene, including transparent surfaces. With `depth`, the targets then hold the depth of opaque
    /// surfaces. Without it, a renderer with several samples in each pixel spends nothing on depth.
    ///
    /// # Errors
    /// As [`ViewRenderer::render`].
    fn render_all(
        &self,
        targets: &mut Self::Targets,
        scene: &GpuScene,
        view: &View,
        depth: bool,
    ) -> Result<(), GlError>;
}

/// The images of a rendered view.
pub(crate) trait ViewImages {
    /// Returns display-referred sRGB colour with luma in alpha, filtered linearly.
    fn color(&self) -> &RenderTarget;

    /// Returns window depth in the view's convention.
    fn depth(&self) -> &Texture;
}
