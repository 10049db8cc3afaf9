//! A renderer of either kind, chosen by the settings.

use std::rc::Rc;

use super::cluster::Selection;
use super::common::Common;
use super::deferred::{DeferredRenderer, DeferredTargets};
use super::forward::ForwardRenderer;
use super::forward_targets::ForwardTargets;
use super::request::DrawRequest;
use super::scene::GpuScene;
use super::settings::{RenderSettings, RendererKind};
use super::view::{ViewImages, ViewRenderer};
use yoro::eyes::View;
use yoro_gl::{Context, GlError, RenderTarget, Texture};

/// A renderer of one scene: programs for the scene's style and materials, and its shadow map.
/// After [`Renderer::new`] it is ready for single views. A stereo method compiles what else it needs once, in its first
/// frame of the scene or in [`crate::stereo::StereoMethod::prepare`]. Nothing is compiled or allocated after that.
pub enum Renderer {
    /// [`RendererKind::Deferred`].
    Deferred(Box<DeferredRenderer>),
    /// [`RendererKind::Forward`].
    Forward(Box<ForwardRenderer>),
}

/// A kind of renderer that a [`Renderer`] can be.
pub(crate) trait RendererOfKind: ViewRenderer + 'static {
    /// Returns the renderer if it is of this kind.
    fn of(renderer: &mut Renderer) -> Option<&mut Self>;
}

impl RendererOfKind for DeferredRenderer {
    fn of(renderer: &mut Renderer) -> Option<&mut DeferredRenderer> {
        match renderer {
            Renderer::Deferred(renderer) => Some(renderer),
            Renderer::Forward(_) => None,
        }
    }
}

impl RendererOfKind for ForwardRenderer {
    fn of(renderer: &mut Renderer) -> Option<&mut ForwardRenderer> {
        match renderer {
            Renderer::Forward(renderer) => Some(renderer),
            Renderer::Deferred(_) => None,
        }
    }
}

/// The images of one view, for a renderer of either kind. They are made when the first view is rendered, and reused for
/// the next.
#[derive(Default)]
pub struct ViewTargets {
    deferred: Option<(RenderSettings, DeferredTargets)>,
    forward: Option<(RenderSettings, ForwardTargets)>,
}

/// A view that was rendered.
#[derive(Clone, Copy)]
pub struct RenderedView<'a> {
    /// Display-referred sRGB colour with luma in alpha, filtered linearly. With several samples in each pixel, alpha is
    /// undefined where something is cut out by a texture.
    pub color: &'a RenderTarget,
    /// Window depth in the view's convention. Deferred: 24 bits for standard depth, float for reversed depth. Forward:
    /// float, the nearest of each pixel's samples; without multisample textures (OpenGL ES 3.0), and after
    /// [`Renderer::render_all`] if samples stay in tiles, the depth of one of the samples.
    pub depth: &'a Texture,
}

impl Renderer {
    /// Compiles the programs for a scene and draws its shadow map.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target, or lacks the settings' number of samples.
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> Result<Renderer, GlError> {
        Ok(match settings.renderer {
            RendererKind::Deferred => {
                Renderer::Deferred(Box::new(DeferredRenderer::new(gl, settings, scene)?))
            }
            RendererKind::Forward => Renderer::Forward(Box::new(ForwardRenderer::new(gl, settings, scene)?)),
        })
    }

    /// Moves everything in a scene to its place at a time in seconds, and redraws its shadow map. Costs nothing if the
    /// scene does not move or is there already.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for.
    pub fn set_time(&mut self, scene: &mut GpuScene, seconds: f64) -> Result<(), GlError> {
        let common = match self {
            Renderer::Deferred(renderer) => &mut renderer.common,
            Renderer::Forward(renderer) => &mut renderer.common,
        };
        common.check_scene(scene)?;
        if scene.set_time(seconds) {
            common.renew(scene);
        }
        Ok(())
    }

    /// Renders the opaque part of a scene to colour and depth. Where nothing is drawn, depth is the far value and
    /// colour is the sky.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for; as [`RenderTarget::new`].
    pub fn render<'a>(
        &self,
        targets: &'a mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        selection: Selection,
    ) -> Result<RenderedView<'a>, GlError> {
        self.draw(targets, scene, view, Some(DrawRequest { selection, ..DrawRequest::default() }))
    }

    /// Renders all of a scene, including transparent surfaces. Depth is that of opaque surfaces.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_all<'a>(
        &self,
        targets: &'a mut ViewTargets,
        scene: &GpuScene,
        view: &View,
    ) -> Result<RenderedView<'a>, GlError> {
        self.draw(targets, scene, view, None)
    }

    /// Renders the request, or all surfaces if it is `None`.
    fn draw<'a>(
        &self,
        targets: &'a mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        request: Option<DrawRequest>,
    ) -> Result<RenderedView<'a>, GlError> {
        match self {
            Renderer::Deferred(renderer) => {
                draw_with(&**renderer, &mut targets.deferred, scene, view, request)
            }
            Renderer::Forward(renderer) => draw_with(&**renderer, &mut targets.forward, scene, view, request),
        }
    }
}

/// Renders into the existing targets, or into new ones if those were made for other settings.
fn draw_with<'a, R: ViewRenderer>(
    renderer: &R,
    made: &'a mut Option<(RenderSettings, R::Targets)>,
    scene: &GpuScene,
    view: &View,
    request: Option<DrawRequest>,
) -> Result<RenderedView<'a>, GlError> {
    let Common { gl, settings, .. } = renderer.common();
    renderer.common().check_scene(scene)?;
    let fitting = match made.take().filter(|(made_for, _)| made_for == settings) {
        Some(fitting) => fitting,
        None => (settings.clone(), R::targets(gl, settings)?),
    };
    let (_, targets) = made.insert(fitting);
    match request {
        Some(request) => renderer.render(targets, scene, view, &request)?,
        None => renderer.render_all(targets, scene, view, true)?,
    }
    Ok(RenderedView { color: targets.color(), depth: targets.depth() })
}
