//! One view, rendered by either kind of renderer.

use std::rc::Rc;

use super::common::Common;
use super::request::ViewRequest;
use super::scene::GpuScene;
use super::settings::RenderSettings;
use yoro::eyes::View;
use yoro_gl::{Context, GlError, RenderTarget, Texture};

/// A renderer of one kind, made for one scene.
pub(crate) trait ViewRenderer: Sized {
    /// The images of one view.
    type Targets: ViewImages;

    /// Returns what renderers of both kinds have.
    fn common(&self) -> &Common;

    /// Makes targets, which are fitted to each view that is rendered.
    ///
    /// # Errors
    /// As [`RenderTarget::new`]; [`GlError::Unsupported`] if the driver lacks the settings' number of samples.
    fn targets(gl: &Rc<Context>, settings: &RenderSettings) -> Result<Self::Targets, GlError>;

    /// Renders opaque surfaces. Where nothing is drawn, depth keeps its far value and colour is the sky.
    ///
    /// # Errors
    /// As [`RenderTarget::new`] when the targets have to change their size.
    fn render(
        &self,
        targets: &mut Self::Targets,
        scene: &GpuScene,
        view: &View,
        request: &ViewRequest,
    ) -> Result<(), GlError>;

    /// Renders all of a scene, with transparent surfaces. With `depth` the targets have the depth of opaque surfaces
    /// afterwards; without it, a renderer with several samples in each pixel spends nothing on depth.
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

/// The images of a view that was rendered.
pub(crate) trait ViewImages {
    /// Returns display-referred sRGB colour with luma in alpha, filtered linearly.
    fn color(&self) -> &RenderTarget;

    /// Returns window depth in the view's convention.
    fn depth(&self) -> &Texture;

    /// The window depth of every sample: a float `TEXTURE_2D_MULTISAMPLE` of [`RenderSettings::msaa`] samples. `None`
    /// for one sample a pixel, for drivers without such textures, and if samples are not kept. It shows opaque surfaces
    /// alone until drawing resumes.
    fn depth_samples(&self) -> Option<glow::Texture> {
        None
    }

    /// The colour of every sample, under the same conditions.
    fn color_samples(&self) -> Option<glow::Texture> {
        None
    }
}
