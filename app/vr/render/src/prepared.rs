//! A scene with its renderer.

use std::rc::Rc;

use yoro_assets::Scene;
use yoro_gl::{Context, GlError};

use crate::render::{GpuScene, RenderSettings, Renderer};

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
}
