//! The application without a platform.
//!
//! A [`Viewer`] is a stereo session with its scene, panels (HUD, menu, start screen, questions) and telemetry. A display decides where the eyes
//! are, how large their images are and how the user gets to see them. There are two displays, each of which owns its
//! viewer: [`Cardboard`](crate::Cardboard), a phone behind lenses with its own motion sensors, and
//! [`Headset`](crate::openxr::Headset), a headset with an OpenXR runtime. A platform (the Android application, `yoro
//! view` and `yoro xr` on the desktop) provides a GL context, events and a surface to draw on.
//!
//! ```text
//! new ──> attach(gl) ──> [ event()* ── begin() ── render() ── hud()    ── end() ]* ──> summary()
//!             ^   context lost: detach()   |          telemetry() when a report says so
//!             └────────────────────────────┘
//! ```
//!
//! All calls must come from one thread. Those that may use GL (`attach`, `event`, `configure`, `begin`, `render`,
//! `hud`, `end`, `detach`, drop) need a current context. Times are nanoseconds of a monotonic clock.

mod configure;
mod frames;
mod input;
mod menu;
mod session;
mod start;
#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::rc::Rc;

use crate::adaptive::Controller;
use crate::caption::Caption;
use crate::error::ViewerError;
use crate::frame::SceneState;
use crate::loading::SceneSource;
use crate::options::render_settings;
use crate::scene_slot::{SceneSlot, Shown};
use crate::session_stats::SessionStats;
use menu::Menu;
use session::MethodInUse;
use start::StartScreen;
use yoro::eyes::{FoveationLevel, Pose};
use yoro_assets::Scene;
use yoro_gl::{Context, GlError, PassTime, Profiling};
use yoro_lenses::{Board, Hud};
use yoro_render::stereo::{FrameLoad, StereoSession};
use yoro_settings::{Ipd, Settings};

/// Capacity reserved for the times of a frame's passes.
const MAX_PASSES: usize = 64;

/// Objects in the GL context, other than the scene and the method.
struct Attached {
    gl: Rc<Context>,
    hud: Hud,
    board: Board,
    pass_times: Vec<PassTime>,
}

/// The sources of the distance between the eyes.
#[derive(Clone, Copy, Debug)]
struct IpdSources {
    /// Chosen in the settings or by the user.
    chosen: Option<Ipd>,
    /// The display's own.
    native: Ipd,
}

/// The application without a platform.
pub struct Viewer {
    settings: Settings,
    /// The folders that are searched for scenes and viewers given by name.
    pub(crate) folders: Vec<PathBuf>,
    scene: SceneSlot,
    method: MethodInUse,
    /// Made once a scene is loaded.
    session: Option<StereoSession>,
    controller: Controller,
    /// The load of the last frame that was shown.
    load: Option<FrameLoad>,
    /// The device's thermal headroom, if it is known.
    thermal_headroom: Option<f32>,
    stats: SessionStats,
    caption: Caption,
    ipd: IpdSources,
    attached: Option<Attached>,
    now_ns: i64,
    refresh_hz: f32,
    /// The display's refreshes per second, as far as it is known while its runtime makes every second frame.
    display_hz: f32,
    menu: Menu,
    /// The settings from the last call of `new` or `configure`, without the menu's changes.
    given: Settings,
    /// Settings from the menu that the display has not taken yet.
    wanted: Option<Settings>,
    /// The settings that the menu has changed, by key, and whether they have changed since they were last taken.
    kept: Vec<(&'static str, String)>,
    is_kept_new: bool,
    start: StartScreen,
    /// The foveation where the settings give none.
    default_foveation: Option<FoveationLevel>,
}

impl Viewer {
    /// Starts to load the scene in the background. `folders` are searched for scenes given by name.
    ///
    /// # Errors
    /// [`ViewerError::NoScene`] for a mistake in the settings.
    pub fn new(settings: Settings, folders: &[PathBuf]) -> Result<Viewer, ViewerError> {
        let source = SceneSource::find(&settings.scene, folders)?;
        log::info!("settings: {settings}");
        Ok(Viewer {
            folders: folders.to_vec(),
            scene: SceneSlot::new(source, settings.viewpoint),
            method: MethodInUse::new(&settings),
            session: None,
            controller: Controller::new(),
            load: None,
            thermal_headroom: None,
            stats: SessionStats::default(),
            caption: Caption::new(settings.hud),
            ipd: IpdSources { chosen: settings.ipd, native: Ipd::nearest(0.0) },
            attached: None,
            now_ns: 0,
            refresh_hz: 0.0,
            display_hz: 0.0,
            menu: Menu::default(),
            given: settings.clone(),
            wanted: None,
            kept: Vec::new(),
            is_kept_new: false,
            start: StartScreen::default(),
            default_foveation: None,
            settings,
        })
    }

    /// Takes a GL context and creates everything that lives in it. The scene is shown once it is loaded.
    ///
    /// # Errors
    /// [`ViewerError::Gl`].
    pub fn attach(&mut self, gl: Rc<Context>) -> Result<(), ViewerError> {
        gl.set_profiling(profiling(&self.settings));
        self.choose_pipeline(&gl);
        // Drops what lived in an earlier context.
        self.detach();
        let (hud, board) = (Hud::new(&gl)?, Board::new(&gl)?);
        self.scene.reload();
        self.attached = Some(Attached { hud, board, pass_times: Vec::with_capacity(MAX_PASSES), gl });
        Ok(())
    }

    /// Drops everything that lives in the GL context, which is lost or about to be destroyed. After the next
    /// [`Viewer::attach`] the scene is loaded again.
    pub fn detach(&mut self) {
        self.session = None;
        self.scene.shown = None;
        self.attached = None;
    }

    /// True if there is a GL context.
    pub fn is_attached(&self) -> bool {
        self.attached.is_some()
    }

    fn replace_scene(&mut self, source: SceneSource, viewpoint: usize) {
        self.scene.replace(source, viewpoint);
        self.stats.expect_scene();
    }

    /// Pauses in the background: animations stop, and the time until the next frame is not counted.
    pub fn pause(&mut self) {
        if let Some(shown) = &mut self.scene.shown {
            shown.pause();
        }
        self.stats.telemetry.pause();
        self.interrupt();
    }

    /// Resumes after [`Viewer::pause`].
    pub fn resume(&mut self) {
        self.interrupt();
    }

    /// Returns the settings in use.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Returns the distance between the eyes.
    pub fn ipd(&self) -> Ipd {
        self.ipd.chosen.unwrap_or(self.ipd.native)
    }

    /// Returns the distance between the eyes that the settings or the user have chosen, if any.
    pub fn chosen_ipd(&self) -> Option<Ipd> {
        self.ipd.chosen
    }

    /// Sets the display's own distance between the eyes.
    pub fn set_native_ipd(&mut self, ipd: Ipd) {
        self.ipd.native = ipd;
    }

    /// Resets the distance between the eyes to that of the settings.
    pub(crate) fn reset_ipd(&mut self) {
        self.ipd.chosen = self.settings.ipd;
    }

    /// Returns the name of the scene that is shown or being loaded.
    pub fn scene_name(&self) -> &str {
        &self.scene.name
    }

    /// Returns the time of the last frame in nanoseconds.
    pub fn now_ns(&self) -> i64 {
        self.now_ns
    }

    /// Transforms a pose relative to the viewpoint (metres, Y up, -Z ahead) into the scene.
    pub fn place(&self, pose: Pose) -> Pose {
        self.scene.place(pose)
    }

    /// Returns the state of the scene.
    pub fn scene_state(&self) -> SceneState {
        self.scene.state()
    }

    /// True while a scene is being loaded, even if another one is shown.
    pub fn is_loading(&self) -> bool {
        self.scene.is_loading()
    }

    /// Returns the reason why the scene cannot be shown, in one sentence.
    pub fn failure(&self) -> Option<&str> {
        self.scene.failure.as_deref()
    }

    /// Uploads the scene if it is loaded; [`Viewer::begin`] calls this.
    pub fn poll_scene(&mut self) {
        let Some(attached) = &self.attached else { return };
        let Some(loaded) = self.scene.take_loaded() else { return };
        let gl = attached.gl.clone();
        let shown = loaded.and_then(|scene| self.show(&gl, scene).map_err(|error| error.to_string()));
        if let Err(reason) = shown {
            // Logged only for information: the platform decides whether this ends the program.
            log::info!("no scene: {reason}");
            self.scene.failure = Some(reason);
        }
    }

    /// Shows a scene.
    fn show(&mut self, gl: &Rc<Context>, scene: Scene) -> Result<(), GlError> {
        // The old scene is dropped first: memory may not suffice for both.
        self.session = None;
        self.scene.shown = None;
        self.scene.set_viewpoints(&scene.viewpoints);
        let shown = Shown::new(gl, scene, &render_settings(&self.settings, Some(gl.capabilities())))?;
        let scene = &shown.prepared.scene;
        log::info!("{}: {} triangles", scene.name, scene.triangle_count());
        self.scene.shown = Some(shown);
        if self.stats.begin(self.now_ns) {
            self.controller = Controller::new();
        }
        self.make_first_session(gl)?;
        Ok(())
    }
}

fn profiling(settings: &Settings) -> Profiling {
    if settings.profiling { Profiling::Queries } else { Profiling::Off }
}
