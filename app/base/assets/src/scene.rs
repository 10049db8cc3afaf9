//! The scene: a model in its light, with viewpoints and motion.

use super::model::{Model, PointLight, ShadingStyle, Sky, Viewpoint};
use super::motion::Motion;

/// A scene: a model, its light, its viewpoints, and what moves.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Scene {
    /// Name: a built-in one, or the file's stem.
    pub name: String,
    /// Triangles, materials and pictures.
    pub model: Model,
    /// The shading style that the scene is made for.
    pub style: ShadingStyle,
    /// Sun and sky.
    pub sky: Sky,
    /// Point lights, brightest first; the renderer uses the first few in view.
    pub lights: Vec<PointLight>,
    /// Camera path: key viewpoints, at least one, interpolated by [`crate::path`].
    pub viewpoints: Vec<Viewpoint>,
    /// True if the viewpoints are made up, since no file states any.
    #[serde(default)]
    pub has_made_up_viewpoints: bool,
    /// What moves. The other fields are the scene's state at time 0.
    pub motion: Motion,
}

impl Scene {
    /// Warns if the viewpoints are made up: for programs that use them.
    pub fn warn_of_made_up_viewpoints(&self) {
        if self.has_made_up_viewpoints {
            log::warn!(
                "{0}: {1} viewpoints are made up; write others into {0}.camera.json beside it",
                self.name,
                self.viewpoints.len()
            );
        }
    }

    /// Returns the scene in its state at a time in seconds, without motion.
    pub fn at(&self, seconds: f64) -> Scene {
        let mut scene = Scene { motion: Motion::default(), ..self.clone() };
        let mut moment = self.motion.start();
        self.motion.at(seconds, &mut moment);
        moment.place(&self.motion, &mut scene.model.vertices);
        moment.light(&self.motion, &mut scene.lights, &mut scene.sky);
        scene
    }
}
