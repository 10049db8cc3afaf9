//! A renderer of either kind, as the settings say.

use std::rc::Rc;

use super::cluster::Selection;
use super::common::Common;
use super::deferred::{DeferredRenderer, DeferredTargets};
use super::forward::ForwardRenderer;
use super::forward_targets::ForwardTargets;
use super::request::ViewRequest;
use super::scene::GpuScene;
use super::settings::{RenderSettings, RendererKind};
use super::view::{ViewImages, ViewRenderer};
use yoro::eyes::View;
use yoro_gl::{Context, GlError, RenderTarget, Texture};

/// A renderer of one scene: programs for the scene's style and materials, and its shadow map.
///
/// Single views are ready after [`Renderer::new`]. A stereo method compiles the rest once, with its first frame of the
/// scene or in [`crate::stereo::StereoMethod::prepare`]. Nothing is compiled or allocated after that.
pub enum Renderer {
    /// [`RendererKind::Deferred`].
    Deferred(Box<DeferredRenderer>),
    /// [`RendererKind::Forward`].
    Forward(Box<ForwardRenderer>),
}

/// A kind of renderer that a [`Renderer`] may be.
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

/// The images of one view for a renderer of either kind. They are made when a view is rendered, and used again for the
/// next one.
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
    /// Window depth in the view's convention. Deferred: 24 bits for standard, float for reversed depth. Forward: float,
    /// the nearest of each pixel's samples; that of one of them without multisample textures (OpenGL ES 3.0), and after
    /// [`Renderer::render_all`] where samples stay in tiles.
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

    /// Moves everything in a scene to where it is at a time in seconds, and draws its shadow map again. A scene in
    /// which nothing moves, or that is there already, costs nothing.
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

    /// Renders the opaque part of a scene: colour and depth. Where nothing is drawn, depth keeps its far value and
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
        self.draw(targets, scene, view, Some(ViewRequest { selection, ..ViewRequest::default() }))
    }

    /// Renders all of a scene, with transparent surfaces. Depth is that of opaque surfaces.
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

    /// Renders the request, or all surfaces without one.
    fn draw<'a>(
        &self,
        targets: &'a mut ViewTargets,
        scene: &GpuScene,
        view: &View,
        request: Option<ViewRequest>,
    ) -> Result<RenderedView<'a>, GlError> {
        match self {
            Renderer::Deferred(renderer) => {
                draw_with(&**renderer, &mut targets.deferred, scene, view, request)
            }
            Renderer::Forward(renderer) => draw_with(&**renderer, &mut targets.forward, scene, view, request),
        }
    }
}

/// Renders into the targets that are there, or into new ones if those were made for other settings.
fn draw_with<'a, R: ViewRenderer>(
    renderer: &R,
    made: &'a mut Option<(RenderSettings, R::Targets)>,
    scene: &GpuScene,
    view: &View,
    request: Option<ViewRequest>,
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
