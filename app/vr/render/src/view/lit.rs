//! A scene in the light of a frame.

use std::ops::Deref;

use super::scene::GpuScene;
use yoro::eyes::{Eye, EyePair, View};

/// A scene, and the eyes whose point lights light it.
///
/// A view may show more lights than it can have. Levels of one pair of eyes have the lights of the whole pair, so that no
/// light ends at the border between two levels.
#[derive(Clone, Copy)]
pub(crate) struct LitScene<'a> {
    scene: &'a GpuScene,
    /// The eyes as they are shown; `None` if each view has the lights that reach into it.
    shown: Option<[View; 2]>,
}

impl<'a> LitScene<'a> {
    /// Returns a scene in the light of a pair of eyes, of which only a level is rendered.
    pub fn of_eyes(scene: &'a GpuScene, shown: &EyePair) -> LitScene<'a> {
        LitScene { scene, shown: Some(Eye::BOTH.map(|eye| shown.view(eye))) }
    }

    /// Returns the scene.
    pub fn scene(&self) -> &'a GpuScene {
        self.scene
    }

    /// Returns the pixel density of a view over that of the eye of which it is a level; 1 if it is no level.
    pub fn detail(&self, view: &View) -> f32 {
        let density = |view: &View| view.size[1] as f32 / view.frustum.height();
        self.shown.as_ref().map_or(1.0, |[shown, _]| density(view) / density(shown))
    }

    /// Returns the views whose lights are chosen for an image of these views.
    pub fn lit<'v>(&'v self, views: &'v [View]) -> &'v [View] {
        self.shown.as_ref().map_or(views, |shown| shown)
    }
}

impl<'a> From<&'a GpuScene> for LitScene<'a> {
    fn from(scene: &'a GpuScene) -> LitScene<'a> {
        LitScene { scene, shown: None }
    }
}

impl Deref for LitScene<'_> {
    type Target = GpuScene;

    fn deref(&self) -> &GpuScene {
        self.scene
    }
}
