//! The scene: being loaded, shown, or failed.

use std::path::PathBuf;
use std::rc::Rc;

use glam::{Quat, Vec3};

use crate::frame::SceneState;
use crate::loading::{Loader, SceneSource};
use yoro::eyes::Pose;
use yoro_assets::{Scene, Viewpoint};
use yoro_gl::{Context, GlError};
use yoro_render::{PreparedScene, RenderSettings};

/// A scene on the GPU, and its renderer.
pub(crate) struct Shown {
    pub prepared: PreparedScene,
    /// Animation time in seconds since the scene was first shown.
    seconds: f64,
    /// The time of the previous frame in nanoseconds; `None` after a pause.
    last_ns: Option<i64>,
}

impl Shown {
    /// Uploads a scene and creates its renderer.
    pub fn new(gl: &Rc<Context>, scene: Scene, settings: &RenderSettings) -> Result<Shown, GlError> {
        Ok(Shown { prepared: PreparedScene::new(gl, scene, settings)?, seconds: 0.0, last_ns: None })
    }

    /// Advances the animation to a frame at this time.
    pub fn move_on(&mut self, now_ns: i64) -> Result<(), GlError> {
        let past_ns = self.last_ns.replace(now_ns).map_or(0, |last_ns| (now_ns - last_ns).max(0));
        self.seconds += past_ns as f64 * 1e-9;
        self.prepared.set_time(self.seconds)
    }

    /// Stops the animation until the next frame.
    pub fn pause(&mut self) {
        self.last_ns = None;
    }
}

/// The scene in use. While another one is being loaded, the old one stays shown.
pub(crate) struct SceneSlot {
    source: SceneSource,
    /// The name of the scene that is shown or being loaded.
    pub name: String,
    loader: Option<Loader>,
    /// The reason, in one sentence, why the scene cannot be shown.
    pub failure: Option<String>,
    viewpoints: Vec<Viewpoint>,
    /// The number of the viewpoint in use; not checked until the viewpoints are known.
    pub viewpoint: usize,
    /// The scene that is shown; dropped with the GL context.
    pub shown: Option<Shown>,
}

impl SceneSlot {
    /// Starts to load a scene.
    pub fn new(source: SceneSource, viewpoint: usize) -> SceneSlot {
        SceneSlot {
            loader: Some(Loader::start(&source)),
            name: source.name(),
            source,
            failure: None,
            viewpoints: Vec::new(),
            viewpoint,
            shown: None,
        }
    }

    /// Starts to load another scene.
    pub fn replace(&mut self, source: SceneSource, viewpoint: usize) {
        self.loader = Some(Loader::start(&source));
        self.name = source.name();
        self.source = source;
        self.failure = None;
        self.viewpoint = viewpoint;
    }

    /// Loads the scene again for a new GL context, unless it is being loaded or has failed.
    pub fn reload(&mut self) {
        if self.loader.is_none() && self.failure.is_none() {
            self.loader = Some(Loader::start(&self.source));
        }
    }

    /// Returns the scene, once, when it is loaded.
    pub fn take_loaded(&mut self) -> Option<Result<Scene, String>> {
        let result = self.loader.as_ref()?.poll()?;
        self.loader = None;
        Some(result)
    }

    /// Sets the viewpoints of the scene that is about to be shown.
    pub fn set_viewpoints(&mut self, viewpoints: &[Viewpoint]) {
        self.viewpoints = viewpoints.to_vec();
        self.go_to(self.viewpoint);
    }

    pub fn is_loading(&self) -> bool {
        self.loader.is_some()
    }

    pub fn state(&self) -> SceneState {
        match (&self.shown, &self.failure) {
            (Some(_), _) => SceneState::Ready,
            (None, Some(_)) => SceneState::Failed,
            (None, None) => SceneState::Loading,
        }
    }

    /// Returns the scene after this one, if there is another.
    pub fn next(&self, folders: &[PathBuf]) -> Option<SceneSource> {
        let sources = SceneSource::all(folders);
        let at = sources.iter().position(|source| *source == self.source);
        let next = at.map_or(0, |at| at + 1) % sources.len().max(1);
        sources.into_iter().nth(next).filter(|source| *source != self.source)
    }

    /// Goes to a viewpoint; numbers beyond the last wrap around.
    pub fn go_to(&mut self, viewpoint: usize) {
        self.viewpoint = viewpoint % self.viewpoints.len().max(1);
    }

    /// Goes to the next viewpoint, if there is another.
    pub fn next_viewpoint(&mut self) -> Option<usize> {
        (self.viewpoints.len() > 1).then(|| {
            self.go_to(self.viewpoint + 1);
            self.viewpoint
        })
    }

    /// Transforms a pose relative to the viewpoint (metres, Y up, -Z ahead) into the scene.
    pub fn place(&self, pose: Pose) -> Pose {
        let viewpoint = self.viewpoints.get(self.viewpoint).map_or(Pose::IDENTITY, Viewpoint::pose);
        // Gravity defines the level, so only the viewpoint's heading is used.
        let ahead = viewpoint.orientation * Vec3::NEG_Z;
        let heading = Quat::from_rotation_y((-ahead.x).atan2(-ahead.z));
        Pose {
            position: viewpoint.position + heading * pose.position,
            orientation: heading * pose.orientation,
        }
    }
}
