//! One view of a scene: colour and depth, rendered the deferred way or the forward way.
//!
//! Deferred: sun shadow map (once per scene) -> g-buffer -> ambient occlusion -> lighting -> bloom -> tone mapping. What
//! belongs to the finished image of one eye comes after synthesis: [`Fxaa`] and the transparent surfaces
//! ([`DeferredRenderer::draw_transparent`]).
//!
//! Forward, with several samples in each pixel: sun shadow map -> lit surfaces -> average of the samples -> bloom and
//! outlines. What comes after synthesis is drawn into the same samples ([`ForwardRenderer::resume_samples`]).

mod bloom;
mod cluster;
mod common;
mod deferred;
mod depth_copy;
mod forward;
mod forward_passes;
mod forward_targets;
#[cfg(test)]
mod forward_tests;
mod fxaa;
mod g_buffer;
mod geometry;
mod light_tiles;
mod lighting;
mod lights;
mod request;
mod role;
mod scene;
mod settings;
mod shadow;
mod ssao;
#[cfg(test)]
mod tests;
mod tonemap;
mod transparent;
mod uniforms;

use std::rc::Rc;

pub use cluster::Selection;
pub(crate) use common::Common;
pub use deferred::DeferredRenderer;
use deferred::DeferredTargets;
pub(crate) use deferred::{FinishTargets, LightTargets};
pub use depth_copy::DepthCopy;
pub use forward::ForwardRenderer;
pub(crate) use forward_targets::ForwardTargets;
pub use fxaa::Fxaa;
pub(crate) use g_buffer::{GBuffer, Layout, Seam};
pub(crate) use request::{Columns, KeptSamples, PixelDepth, ViewRequest};
pub(crate) use role::{Reprojection, Role, RoleKind};
pub use scene::GpuScene;
pub use settings::{MAX_POINT_LIGHTS, MSAA, RenderSettings, RendererKind};
pub use transparent::DepthImage;
pub(crate) use uniforms::depth_test;

use yoro::eyes::{Frustum, View};
use yoro_gl::{Context, GlError, RenderTarget, Texture};

/// Renders views of one scene: its programs, made for the scene's style and materials, and the scene's shadow
/// map. Single views are ready after [`Renderer::new`]; what a stereo method needs besides is compiled once, with
/// its first frame of the scene or when [`crate::stereo::StereoMethod::prepare`] asks for it. Nothing is compiled
/// or allocated after that.
pub enum Renderer {
    /// [`RendererKind::Deferred`].
    Deferred(Box<DeferredRenderer>),
    /// [`RendererKind::Forward`].
    Forward(Box<ForwardRenderer>),
}

/// What every stereo method asks of a renderer of either kind.
pub(crate) trait ViewRenderer: Sized {
    /// The images of one view.
    type Targets: ViewImages;

    /// The renderer, if it is of this kind.
    fn of(renderer: &mut Renderer) -> Option<&mut Self>;

    /// What renderers of both kinds have.
    fn common(&self) -> &Common;

    /// Makes targets, which are fitted to each view that is rendered.
    ///
    /// # Errors
    /// As [`RenderTarget::new`]; [`GlError::Unsupported`] when the driver has not as many samples as the settings say.
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

    /// Renders all of a scene, transparent surfaces too. With `depth` the targets have that of the opaque ones afterwards;
    /// without, a renderer with several samples in each pixel spends nothing on it.
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
    /// Display-referred sRGB colour with luma in alpha, filtered linearly.
    fn color(&self) -> &RenderTarget;

    /// Window depth in the view's convention.
    fn depth(&self) -> &Texture;

    /// The window depth of every sample, a `TEXTURE_2D_MULTISAMPLE` of [`RenderSettings::msaa`] samples in float: where a
    /// pixel has several, there are such textures, and they are kept. Opaque surfaces only, until transparent ones are drawn
    /// after synthesis.
    fn depth_samples(&self) -> Option<glow::Texture> {
        None
    }

    /// The colour of every sample, likewise.
    fn color_samples(&self) -> Option<glow::Texture> {
        None
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
    /// [`GlError`] when the driver refuses a program or a target, or has not as many samples as the settings say.
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> Result<Renderer, GlError> {
        Ok(match settings.renderer {
            RendererKind::Deferred => {
                Renderer::Deferred(Box::new(DeferredRenderer::new(gl, settings, scene)?))
            }
            RendererKind::Forward => Renderer::Forward(Box::new(ForwardRenderer::new(gl, settings, scene)?)),
        })
    }

    /// Renders the opaque part of a scene: colour and depth. Where nothing is drawn, depth keeps its far value and colour is
    /// the sky.
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

    /// Renders all of a scene, transparent surfaces too; depth is that of the opaque ones.
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

    /// Renders what is requested, or all.
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

/// The part of a view that some of its columns show, `[first, end]` from the left.
fn of_columns(view: &View, [first, end]: [u32; 2]) -> View {
    let tangent = view.frustum.width() / view.size[0] as f32;
    let left = view.frustum.left + first as f32 * tangent;
    let right = view.frustum.left + end as f32 * tangent;
    View {
        frustum: Frustum { left, right, ..view.frustum },
        size: [end.saturating_sub(first), view.size[1]],
        ..*view
    }
}
