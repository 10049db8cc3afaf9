//! A scene with its renderer.

use std::rc::Rc;

use yoro::eyes::SynthesisViews;
use yoro::opengl::{Gather, Source};
use yoro_assets::Scene;
use yoro_gl::{Context, Destination, GlError, RenderTarget};

use crate::view::{GpuScene, RenderSettings, Renderer, ViewTargets};

/// A scene on the GPU and the renderer that was compiled for it.
pub struct PreparedScene {
    /// The scene.
    pub scene: GpuScene,
    /// Its renderer.
    pub renderer: Renderer,
}

impl PreparedScene {
    /// Uploads a scene and compiles the programs that it needs.
    ///
    /// # Errors
    /// As [`GpuScene::upload`] and [`Renderer::new`].
    pub fn new(gl: &Rc<Context>, scene: Scene, settings: &RenderSettings) -> Result<PreparedScene, GlError> {
        let scene = GpuScene::upload(gl, scene)?;
        let renderer = Renderer::new(gl, settings, &scene)?;
        Ok(PreparedScene { scene, renderer })
    }

    /// Moves everything to its place at a time in seconds. Costs nothing for a scene in which nothing moves.
    ///
    /// # Errors
    /// As [`Renderer::set_time`].
    pub fn set_time(&mut self, seconds: f64) -> Result<(), GlError> {
        self.renderer.set_time(&mut self.scene, seconds)
    }

    /// Renders the source of some views and synthesizes the other eye into `to`, which is resized to that eye. For
    /// measurements of the synthesis alone.
    ///
    /// # Errors
    /// [`GlError`] beyond the driver's limits.
    pub fn synthesize(
        &self,
        gather: &mut Gather,
        targets: &mut ViewTargets,
        views: &SynthesisViews,
        to: &mut RenderTarget,
    ) -> Result<(), GlError> {
        let rendered = self.renderer.render(targets, &self.scene, &views.source)?;
        to.resize(views.target.size)?;
        let source = Source::new(rendered.color.color(0).raw(), rendered.depth.texture.raw());
        gather.synthesize(source, &views.warp, &Destination::whole(to))
    }
}
