//! What both kinds of renderer share.

use std::rc::Rc;

use super::cluster::Culler;
use super::lights::Lights;
use super::scene::GpuScene;
use super::settings::RenderSettings;
use super::shadow::ShadowMap;
use super::transparent::TransparentPass;
use yoro::eyes::View;
use yoro_gl::{Context, GlError};

/// A scene's shadow map and transparent surfaces, and the settings to render them with.
pub struct Common {
    pub(crate) gl: Rc<Context>,
    pub(super) settings: RenderSettings,
    pub(super) shadow: Option<ShadowMap>,
    pub(super) transparent: TransparentPass,
    scene_id: u64,
}

impl Common {
    /// Draws the shadow map and compiles the programs of transparent surfaces.
    pub(super) fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        scene: &GpuScene,
    ) -> Result<Common, GlError> {
        let has_shadow = scene.has_sun() && settings.shadow_map_size > 0;
        Ok(Common {
            gl: gl.clone(),
            settings: settings.clone(),
            shadow: has_shadow.then(|| ShadowMap::new(gl, scene, settings.shadow_map_size)).transpose()?,
            transparent: TransparentPass::new(gl, scene, settings)?,
            scene_id: scene.id,
        })
    }

    /// Redraws what depends on the scene, after it has moved.
    pub(super) fn renew(&mut self, scene: &GpuScene) {
        if let Some(shadow) = &mut self.shadow {
            shadow.renew(&self.gl, scene);
        }
    }

    /// Returns an error unless this is the scene that the renderer was made for.
    pub fn check_scene(&self, scene: &GpuScene) -> Result<(), GlError> {
        if scene.id == self.scene_id {
            return Ok(());
        }
        Err(GlError::Unsupported(format!(
            "this renderer was made for another scene than {}; make one for each scene",
            scene.name
        )))
    }

    /// Returns the point lights of one view or of both eyes, with positions relative to the first view.
    pub(super) fn lights(&self, scene: &GpuScene, views: &[View]) -> Lights {
        // One culler for each eye. A single view's culler is repeated, and the copy is not used.
        let cullers: [Culler; 2] =
            std::array::from_fn(|i| Culler::of_view(views.get(i).unwrap_or(&views[0])));
        let eye = views[0].pose.position;
        Lights::choose(&scene.lights, eye, &cullers[..views.len()], self.settings.point_lights)
    }
}
