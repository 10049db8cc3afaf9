//! Eyes to screen: the whole application without a platform.
//!
//! A [`Viewer`] owns scene, renderer, stereo method, HUD, settings and statistics; where the eyes are, how large
//! their images are and how a person comes to see them is a display's matter. There are two: [`Cardboard`], a phone
//! behind lenses with its own motion sensors, and a headset with an OpenXR runtime (`platform::openxr`). A
//! platform (the Android application, `yoro view` and `yoro xr` on the desktop) gives a GL context, events and
//! somewhere to draw.
//!
//! ```text
//! new ──> attach(gl) ──> [ event()* ── begin() ── render_eyes() ── hud() ── end() ]* ──> summary()
//!             ^   context lost: detach()   |          telemetry() when a report says so
//!             └────────────────────────────┘
//! ```
//!
//! All calls come from one thread; those that may touch GL (`attach`, `event`, `begin`, `render_eyes`, `hud`, `end`,
//! `detach`, drop) need the context to be current there. Times are nanoseconds of a monotonic clock.

mod adaptive;
mod cardboard;
mod configure;
mod head;
mod hud;
mod lens;
mod loading;
mod optics;
mod params;
mod rating;
mod settings;
#[cfg(all(test, feature = "desktop"))]
mod tests;

use std::fmt;
use std::path::PathBuf;
use std::rc::Rc;

use glam::{Quat, Vec3};

pub use adaptive::{Controller, Load, Quality};
pub use cardboard::{Cardboard, HeldHead};
pub use head::{HeadTracker, Sample, neck_offset};
pub use hud::{Panel, Placement};
pub use loading::{SceneSource, list_scenes};
pub use optics::{Distortion, MESH_RESOLUTION, MeshVertex, Optics, Rotation, Screen, mesh_strip};
pub use params::{ParamsError, VerticalAlignment, ViewerParams};
pub use settings::{DisplayKind, KEYS, Performance, Settings, SettingsError, Ssao};

use crate::eyes::{EyePair, EyesError, GuardBand, MAX_IPD, Pose};
use crate::gl::{Context, Destination, GlError, PassTime, Profiling};
use crate::render::{GpuScene, Renderer};
use crate::scene::{Scene, Viewpoint};
use crate::stereo::{self, EyeTarget, Method, StereoError, StereoMethod};
use crate::synthesis::{ImBufferSize, Pipeline};
use crate::telemetry::{DeviceState, Line, Rating, SessionSummary, Telemetry, ViewerState};
use hud::Hud;
use loading::Loader;
use rating::Questionnaire;

/// The IPD changes by this much at a time, in metres.
const IPD_STEP: f32 = 0.001;
/// The images of the eyes are multiples of this many pixels, so that small changes need no new targets.
const SIZE_STEP: f32 = 16.0;
/// How long a message stays in view, in nanoseconds.
const MESSAGE_NS: i64 = 2_000_000_000;
/// The background while there is no scene.
const BACKDROP: [f32; 4] = [0.03, 0.035, 0.05, 1.0];

/// Why the viewer cannot go on. A scene that cannot be loaded is not among these: it is shown in view, see
/// [`Viewer::failure`].
#[derive(Debug, thiserror::Error)]
pub enum ViewerError {
    /// The viewer's parameters.
    #[error(transparent)]
    Params(#[from] ParamsError),
    /// The scene does not exist.
    #[error("{0}")]
    NoScene(String),
    /// GL refused.
    #[error(transparent)]
    Gl(#[from] GlError),
    /// A method cannot render a frame.
    #[error(transparent)]
    Stereo(#[from] StereoError),
    /// A call that needs a GL context came before [`Viewer::attach`] or after [`Viewer::detach`].
    #[error("the viewer has no GL context: attach one first")]
    NoContext,
}

/// What the user does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A tap on the screen, the viewer's trigger, or a controller's: the next method.
    Tap,
    /// The method before.
    PreviousMethod,
    /// A long press: straight ahead is where the head points now.
    LongPress,
    /// Volume up: the eyes a millimetre further apart.
    IpdUp,
    /// Volume down: the eyes a millimetre closer.
    IpdDown,
    /// Shows or hides the HUD.
    ToggleHud,
    /// Goes to the scene's next viewpoint.
    NextViewpoint,
    /// Loads the next scene: the built-in ones, then the files in the scene folders.
    NextScene,
}

/// What an event has led to, for the log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// The method that is used now.
    Method(Method),
    /// The head's direction starts over: that is for the display to do.
    Recenter,
    /// The distance between the eyes in metres.
    Ipd(f32),
    /// Whether the HUD is shown.
    Hud(bool),
    /// The viewpoint's number.
    Viewpoint(usize),
    /// Another scene is being loaded: [`Viewer::scene_name`].
    Scene,
    /// The marker of the slider was moved to this rating.
    Marker(f32),
    /// A question was answered: the last of [`Viewer::ratings`].
    Answer,
    /// Nothing, because a question is being asked, or there is no other method, viewpoint or scene.
    Nothing,
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Action::Method(method) => write!(f, "method: {}", method.name()),
            Action::Recenter => f.write_str("recentered"),
            Action::Ipd(ipd) => write!(f, "ipd: {ipd:.3} m"),
            Action::Hud(is_shown) => write!(f, "HUD: {}", if *is_shown { "on" } else { "off" }),
            Action::Viewpoint(n) => write!(f, "viewpoint: {n}"),
            Action::Scene => f.write_str("another scene"),
            Action::Marker(rating) => write!(f, "marker: {rating}"),
            Action::Answer => f.write_str("answered"),
            Action::Nothing => f.write_str("nothing"),
        }
    }
}

/// The times of a frame, all on the monotonic clock of the sensors' timestamps where the platform has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTiming {
    /// Now, in nanoseconds.
    pub now_ns: i64,
    /// When the frame is expected to be seen, in nanoseconds.
    pub expected_display_ns: i64,
    /// Refresh rate of the display in Hz; 0 if unknown.
    pub refresh_hz: f32,
}

/// Where the scene is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneState {
    /// Being loaded or generated; a progress bar is in view.
    Loading,
    /// In view.
    Ready,
    /// It cannot be loaded; the reason is in view and in [`Viewer::failure`].
    Failed,
}

/// What a presented frame was like and what the platform should do next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameReport {
    /// Where the scene is.
    pub scene: SceneState,
    /// Refreshes of the display for which this frame came too late.
    pub late_refreshes: u32,
    /// GPU time in milliseconds of a frame some frames ago, where it is measured.
    pub gpu_ms: Option<f32>,
    /// A second has passed: collect a [`DeviceState`] and call [`Viewer::telemetry`].
    pub telemetry_due: bool,
    /// The session's `duration` has passed since the scene came into view, and its questions are answered: log
    /// [`Viewer::summary`]. True in one report only.
    pub session_over: bool,
    /// The session is over and `auto-exit` is on: end the program. True from then on.
    pub exit: bool,
}

/// Everything that lives in the GL context.
struct Graphics {
    gl: Rc<Context>,
    hud: Hud,
    stage: Option<Stage>,
    pass_times: Vec<PassTime>,
}

/// A scene on the GPU and what shows it.
struct Stage {
    scene: GpuScene,
    renderer: Renderer,
    method: Box<dyn StereoMethod>,
    /// Renders both eyes, while they are such that none can be synthesized from the other.
    substitute: Option<Box<dyn StereoMethod>>,
}

/// The application without a platform.
pub struct Viewer {
    settings: Settings,
    folders: Vec<PathBuf>,
    /// The distance between the eyes that was asked for, in metres.
    ipd: Option<f32>,
    /// The distance that the display has by itself.
    native_ipd: f32,
    method: Method,
    pipeline: Pipeline,
    hud_shown: bool,
    source: SceneSource,
    scene_name: String,
    loader: Option<Loader>,
    failure: Option<String>,
    viewpoints: Vec<Viewpoint>,
    viewpoint: usize,
    graphics: Option<Graphics>,
    controller: Controller,
    quality: Quality,
    telemetry: Telemetry,
    celsius: Option<f32>,
    last_line: Option<Line>,
    /// Why the eyes of the last frame were such that none can be synthesized from the other.
    unfit: Option<EyesError>,
    message_until_ns: i64,
    message: String,
    /// What the HUD says.
    text: String,
    now_ns: i64,
    ready_ns: Option<i64>,
    /// What is asked after the session; none before its end.
    questionnaire: Option<Questionnaire>,
    ratings: Vec<Rating>,
    is_over: bool,
}

impl Viewer {
    /// Starts to load the scene in the background. `folders` are where scenes given by name are looked for.
    ///
    /// # Errors
    /// [`ViewerError::NoScene`]: a mistake in the settings.
    pub fn new(settings: Settings, folders: &[PathBuf]) -> Result<Viewer, ViewerError> {
        let source = SceneSource::find(&settings.scene, settings.seed, folders)?;
        log::info!("settings: {settings}");
        Ok(Viewer {
            folders: folders.to_vec(),
            ipd: settings.ipd,
            native_ipd: 0.0,
            method: settings.method,
            pipeline: settings.pipeline,
            hud_shown: settings.hud,
            loader: Some(Loader::start(&source)),
            scene_name: source.name(),
            source,
            failure: None,
            viewpoints: Vec::new(),
            viewpoint: settings.viewpoint,
            graphics: None,
            controller: Controller::new(),
            quality: Quality::FULL,
            telemetry: Telemetry::default(),
            celsius: None,
            last_line: None,
            unfit: None,
            message_until_ns: 0,
            message: String::new(),
            text: String::with_capacity(3 * hud::COLUMNS),
            now_ns: 0,
            ready_ns: None,
            questionnaire: None,
            ratings: Vec::new(),
            is_over: false,
            settings,
        })
    }

    /// Takes a GL context and makes everything that lives in it. The scene is shown as soon as it is loaded.
    ///
    /// # Errors
    /// [`ViewerError::Gl`].
    pub fn attach(&mut self, gl: Rc<Context>) -> Result<(), ViewerError> {
        let profiling = if self.settings.profiling { Profiling::Queries } else { Profiling::Off };
        gl.set_profiling(profiling);
        self.choose_pipeline(&gl);
        self.graphics =
            Some(Graphics { hud: Hud::new(&gl)?, stage: None, pass_times: Vec::with_capacity(64), gl });
        if self.loader.is_none() && self.failure.is_none() {
            self.loader = Some(Loader::start(&self.source));
        }
        Ok(())
    }

    /// Drops everything that lives in the GL context, which is lost or about to be destroyed. After another
    /// [`Viewer::attach`] the scene is loaded again.
    pub fn detach(&mut self) {
        self.graphics = None;
    }

    /// Whether there is a GL context.
    pub fn is_attached(&self) -> bool {
        self.graphics.is_some()
    }

    /// Replaces the scene; the old one stays in view until the new one is loaded.
    pub fn load_scene(&mut self, source: SceneSource) {
        self.loader = Some(Loader::start(&source));
        self.scene_name = source.name();
        self.source = source;
        self.failure = None;
        self.ready_ns = None;
        self.questionnaire = None;
        self.is_over = false;
    }

    /// Does what the user wants.
    ///
    /// # Errors
    /// [`ViewerError::Gl`] when a method cannot be made; the one before stays.
    pub fn event(&mut self, event: Event) -> Result<Action, ViewerError> {
        if self.is_asking() {
            return Ok(self.reply(event));
        }
        let action = match event {
            Event::Tap => self.other_method(1)?,
            Event::PreviousMethod => self.other_method(-1)?,
            Event::LongPress => Action::Recenter,
            Event::IpdUp => self.change_ipd(IPD_STEP),
            Event::IpdDown => self.change_ipd(-IPD_STEP),
            Event::ToggleHud => {
                self.hud_shown = !self.hud_shown;
                Action::Hud(self.hud_shown)
            }
            Event::NextViewpoint => match self.viewpoints.len() {
                0 | 1 => Action::Nothing,
                n => {
                    self.viewpoint = (self.viewpoint + 1) % n;
                    Action::Viewpoint(self.viewpoint)
                }
            },
            Event::NextScene => self.next_scene(),
        };
        self.message = match action {
            Action::Method(method) => method.name().to_owned(),
            Action::Recenter => "recentered".into(),
            Action::Ipd(ipd) => format!("IPD {:.0} mm", ipd * 1e3),
            Action::Viewpoint(n) => format!("viewpoint {n}"),
            Action::Hud(_) | Action::Scene | Action::Marker(_) | Action::Answer | Action::Nothing => {
                String::new()
            }
        };
        self.message_until_ns = if self.message.is_empty() { 0 } else { self.now_ns + MESSAGE_NS };
        Ok(action)
    }

    /// Whether a question is in view.
    fn is_asking(&self) -> bool {
        self.questionnaire.as_ref().is_some_and(|questions| !questions.is_done())
    }

    /// What an event means while a question is in view.
    fn reply(&mut self, event: Event) -> Action {
        let Some(questions) = &mut self.questionnaire else { return Action::Nothing };
        let mut nudge = |steps| {
            questions.nudge(steps, self.now_ns);
            Action::Marker(questions.rating())
        };
        match event {
            Event::IpdUp => nudge(1.0),
            Event::IpdDown => nudge(-1.0),
            Event::Tap => {
                self.answer();
                Action::Answer
            }
            Event::LongPress => {
                questions.recenter();
                Action::Recenter
            }
            Event::PreviousMethod | Event::ToggleHud | Event::NextViewpoint | Event::NextScene => {
                Action::Nothing
            }
        }
    }

    /// Logs the answer to the question in view.
    fn answer(&mut self) {
        let Some((question, rating)) = self.questionnaire.as_mut().and_then(Questionnaire::answer) else {
            return;
        };
        let rating = Rating {
            participant: self.settings.participant.clone(),
            trial: self.settings.trial,
            method: self.method.name().to_owned(),
            pipeline: self.uses_synthesis().then(|| self.pipeline.name().to_owned()),
            scene: self.scene_name.clone(),
            question,
            rating: f64::from(rating),
        };
        log::info!("{rating}");
        self.ratings.push(rating);
    }

    /// Asks the questions of the settings when the session's time is up; true when there is nothing more to ask.
    fn ask(&mut self) -> bool {
        let Settings { questions, best_rating, .. } = &self.settings;
        let asked = self.questionnaire.get_or_insert_with(|| Questionnaire::new(questions, *best_rating));
        if asked.has_settled(self.now_ns) {
            self.answer();
        }
        !self.is_asking()
    }

    fn change_ipd(&mut self, change: f32) -> Action {
        let ipd = (self.ipd() + change).clamp(0.0, MAX_IPD);
        self.ipd = Some(ipd);
        Action::Ipd(ipd)
    }

    /// Loads the scene after this one.
    fn next_scene(&mut self) -> Action {
        let sources = SceneSource::all(self.settings.seed, &self.folders);
        let at = sources.iter().position(|source| *source == self.source);
        let next = at.map_or(0, |at| at + 1) % sources.len().max(1);
        match sources.into_iter().nth(next) {
            Some(source) if source != self.source => {
                self.viewpoint = 0;
                self.load_scene(source);
                Action::Scene
            }
            _ => Action::Nothing,
        }
    }

    /// Goes to the next (1) or previous (-1) method of the list that the driver can do.
    fn other_method(&mut self, step: isize) -> Result<Action, ViewerError> {
        let methods = self.settings.methods.clone();
        let count = methods.len() as isize;
        let at = methods.iter().position(|m| *m == self.method);
        // A method that is not in the list comes before its first and after its last.
        let start = at.map_or(if step > 0 { 0 } else { -1 }, |at| at as isize + step);
        for next in (0..count).map(|i| methods[(start + i * step).rem_euclid(count) as usize]) {
            if next == self.method {
                continue;
            }
            let before = std::mem::replace(&mut self.method, next);
            match self.make_method() {
                Ok(()) => return Ok(Action::Method(next)),
                Err(ViewerError::Gl(GlError::Unsupported(reason))) => {
                    log::warn!("the method {} is left out: {reason}", next.name());
                    self.method = before;
                }
                Err(error) => {
                    self.method = before;
                    return Err(error);
                }
            }
        }
        Ok(Action::Nothing)
    }

    /// Compiles the current method, if there is a scene to use it on.
    fn make_method(&mut self) -> Result<(), ViewerError> {
        let (settings, method) = (self.method_settings(), self.method);
        if let Some(graphics) = &mut self.graphics
            && let Some(stage) = &mut graphics.stage
        {
            let (render, options) = (settings.render_settings(), settings.stereo_options());
            stage.method = stereo::create(&graphics.gl, method, &render, &options)?;
            stage.substitute = None;
        }
        self.controller.restart();
        Ok(())
    }

    /// The settings with the pipeline and the ImBuffer that are in use.
    fn method_settings(&self) -> Settings {
        let imbuffer = match self.settings.imbuffer {
            ImBufferSize::Divisor(n) => ImBufferSize::Divisor(n * self.quality.imbuffer),
            ImBufferSize::Fixed(size) => {
                ImBufferSize::Fixed(size.map(|n| (n / self.quality.imbuffer).max(1)))
            }
        };
        Settings { pipeline: self.pipeline, imbuffer, ..self.settings.clone() }
    }

    /// The application goes to the background: nothing moves on, and the time until the next frame counts for
    /// nothing.
    pub fn pause(&mut self) {
        self.telemetry.pause();
        self.controller.restart();
    }

    /// The application is back.
    pub fn resume(&mut self) {
        self.controller.restart();
    }

    /// Begins a frame: what has been loaded comes into view.
    pub fn begin(&mut self, timing: &FrameTiming) {
        self.now_ns = timing.now_ns;
        self.poll_scene();
    }

    /// Renders both eyes; nothing but a backdrop until the scene is there. Eyes of which none can be synthesized
    /// from the other (canted ones) are both rendered, whatever the method.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`], [`ViewerError::Gl`], [`ViewerError::Stereo`].
    pub fn render_eyes(&mut self, pair: &EyePair, to: &[EyeTarget; 2]) -> Result<(), ViewerError> {
        if let Some(questions) = &mut self.questionnaire {
            questions.look(pair.poses[pair.dominant.index()].orientation, self.now_ns);
        }
        let unfit = self.method.needs_aligned_eyes().then(|| pair.synthesis(GuardBand::None).err()).flatten();
        let substitute = unfit.is_some();
        if unfit.as_ref().map(std::mem::discriminant) != self.unfit.as_ref().map(std::mem::discriminant) {
            match &unfit {
                Some(reason) => {
                    log::warn!("both eyes are rendered in place of {}: {reason}", self.method.name())
                }
                None => log::info!("{} can be used again", self.method.name()),
            }
        }
        self.unfit = unfit;
        let settings = substitute.then(|| self.method_settings());
        let graphics = self.graphics.as_mut().ok_or(ViewerError::NoContext)?;
        let Some(Stage { scene, renderer, method, substitute }) = &mut graphics.stage else {
            for Destination { framebuffer, origin, size } in to.iter().map(|eye| eye.color) {
                graphics.gl.bind_framebuffer(framebuffer, origin, size);
                graphics.gl.fill(origin, size, BACKDROP);
            }
            return Ok(());
        };
        let method = match settings {
            None => method,
            Some(settings) => match substitute {
                Some(made) => made,
                None => {
                    let (render, options) = (settings.render_settings(), settings.stereo_options());
                    let made = stereo::create(&graphics.gl, Method::Conventional, &render, &options)?;
                    substitute.insert(made)
                }
            },
        };
        Ok(method.render_to(renderer, scene, pair, to)?)
    }

    /// The HUD as it should be seen in this frame, if at all.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`].
    pub fn hud(&mut self) -> Result<Option<Panel<'_>>, ViewerError> {
        self.write_text();
        let is_asking = self.is_asking();
        let graphics = self.graphics.as_mut().ok_or(ViewerError::NoContext)?;
        if is_asking {
            let progress = self.questionnaire.as_ref().map(Questionnaire::position);
            return Ok(Some(
                graphics.hud.set(hud::Content { text: &self.text, progress }, Placement::Middle),
            ));
        }
        let is_empty = graphics.stage.is_none();
        if !self.hud_shown && !is_empty && self.now_ns >= self.message_until_ns {
            return Ok(None);
        }
        // To and fro once in two seconds.
        let phase = (self.now_ns.rem_euclid(2_000_000_000)) as f32 * 1e-9;
        let progress = (is_empty && self.loader.is_some()).then_some(1.0 - (1.0 - phase).abs());
        let placement = if is_empty { Placement::Middle } else { Placement::Below };
        Ok(Some(graphics.hud.set(hud::Content { text: &self.text, progress }, placement)))
    }

    /// Ends a frame that is on its way to the display.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`]; [`ViewerError::Gl`] when an adapted method cannot be made.
    pub fn end(&mut self, timing: &FrameTiming) -> Result<FrameReport, ViewerError> {
        self.now_ns = timing.now_ns;
        let graphics = self.graphics.as_mut().ok_or(ViewerError::NoContext)?;
        graphics.pass_times.clear();
        let timed = graphics.gl.end_timed_frame(&mut graphics.pass_times);
        let gpu_ms =
            (timed > 0).then(|| graphics.pass_times.iter().map(|p| p.time.as_secs_f32() * 1e3).sum());
        self.telemetry.gpu(&graphics.pass_times, timed);
        let late_refreshes = self.telemetry.frame(timing.now_ns, timing.refresh_hz);
        let scene = self.scene_state();
        if self.settings.adaptive && scene == SceneState::Ready {
            let refresh_hz = timing.refresh_hz;
            self.adapt(&Load { now_ns: timing.now_ns, refresh_hz, late_refreshes, gpu_ms })?;
        }
        let shown_ns = self.ready_ns.map_or(0, |ready| timing.now_ns - ready);
        let was_over = self.is_over;
        let is_time_up = self.settings.duration.is_some_and(|s| shown_ns as f64 >= s as f64 * 1e9);
        self.is_over = self.is_over || (is_time_up && self.ask());
        Ok(FrameReport {
            scene,
            late_refreshes,
            gpu_ms,
            telemetry_due: self.telemetry.is_due(timing.now_ns),
            session_over: self.is_over && !was_over,
            exit: self.is_over && self.settings.auto_exit,
        })
    }

    /// Lets the controller judge a frame. Another ImBuffer means another method object; the controller sees to it
    /// that this stays rare.
    fn adapt(&mut self, load: &Load) -> Result<(), ViewerError> {
        let before = std::mem::replace(&mut self.quality, self.controller.frame(load));
        if before.imbuffer != self.quality.imbuffer && self.imbuffer_divisor().is_some() {
            self.make_method()?;
        }
        Ok(())
    }

    /// Ends a second: makes its line for the log. Call it when a [`FrameReport`] says so, with what the device says
    /// now.
    pub fn telemetry(&mut self, now_ns: i64, device: &DeviceState) -> Line {
        self.controller.set_thermal_headroom(device.thermal_headroom);
        self.celsius = device.skin_celsius.or(device.battery_celsius);
        let state = ViewerState {
            method: self.method.name().to_owned(),
            pipeline: self.uses_synthesis().then(|| self.pipeline.name().to_owned()),
            scene: self.scene_name.clone(),
            render_scale: self.render_scale(),
            imbuffer: self.imbuffer_divisor(),
            run: self.settings.run.clone(),
        };
        let line = self.telemetry.line(now_ns, &state, device);
        self.last_line = Some(line.clone());
        line
    }

    /// The session since the scene came into view, for the log at its end.
    pub fn summary(&self, now_ns: i64) -> SessionSummary {
        self.telemetry.summary(now_ns)
    }

    /// The answers to the questions of the settings so far; each is logged when it is given.
    pub fn ratings(&self) -> &[Rating] {
        &self.ratings
    }

    /// The settings the viewer was made with.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The method in use.
    pub fn method(&self) -> Method {
        self.method
    }

    /// The pipeline in use, which is another one than in the settings where the driver cannot do that.
    pub fn pipeline(&self) -> Pipeline {
        self.pipeline
    }

    /// Distance between the eyes in metres.
    pub fn ipd(&self) -> f32 {
        self.ipd.unwrap_or(self.native_ipd).clamp(0.0, MAX_IPD)
    }

    /// The distance between the eyes that the settings or the user ask for, if not that of the display.
    pub fn chosen_ipd(&self) -> Option<f32> {
        self.ipd
    }

    /// The display says which distance between the eyes it has by itself, in metres.
    pub fn set_native_ipd(&mut self, ipd: f32) {
        self.native_ipd = ipd;
    }

    /// The scene that is in view or on its way.
    pub fn scene_name(&self) -> &str {
        &self.scene_name
    }

    /// Number of the viewpoint.
    pub fn viewpoint(&self) -> usize {
        self.viewpoint
    }

    /// Time of the last frame in nanoseconds.
    pub fn now_ns(&self) -> i64 {
        self.now_ns
    }

    /// Where something is in the scene that is `pose` as seen from the viewpoint: metres, Y up, -Z ahead.
    pub fn place(&self, pose: Pose) -> Pose {
        let viewpoint = self.viewpoints.get(self.viewpoint).map_or(Pose::IDENTITY, Viewpoint::pose);
        // Gravity says what is level; of the viewpoint only the heading is left.
        let ahead = viewpoint.orientation * Vec3::NEG_Z;
        let heading = Quat::from_rotation_y((-ahead.x).atan2(-ahead.z));
        Pose {
            position: viewpoint.position + heading * pose.position,
            orientation: heading * pose.orientation,
        }
    }

    /// Where the scene is.
    pub fn scene_state(&self) -> SceneState {
        match &self.graphics {
            Some(Graphics { stage: Some(_), .. }) => SceneState::Ready,
            _ if self.failure.is_some() => SceneState::Failed,
            _ => SceneState::Loading,
        }
    }

    /// Why the scene cannot be shown: one sentence.
    pub fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// Size in pixels of each eye's image on a display whose full size is `full`.
    pub fn eye_size(&self, full: [f32; 2]) -> [u32; 2] {
        // Methods render a guard band beside the image.
        let limit = self.graphics.as_ref().map_or(4096, |g| g.gl.capabilities().max_texture_size) / 2;
        let steps = |pixels: f32| (pixels * self.render_scale() / SIZE_STEP).round().max(4.0) * SIZE_STEP;
        full.map(|n| (steps(n) as u32).min(limit))
    }

    fn render_scale(&self) -> f32 {
        self.settings.render_scale * self.quality.render_scale
    }

    fn uses_synthesis(&self) -> bool {
        self.method == Method::Yoro
    }

    fn imbuffer_divisor(&self) -> Option<u32> {
        match self.method_settings().imbuffer {
            ImBufferSize::Divisor(n) if self.uses_synthesis() && self.pipeline == Pipeline::Paper => Some(n),
            _ => None,
        }
    }

    /// Uploads the scene if its thread is done; [`Viewer::begin`] does so by itself.
    pub fn poll_scene(&mut self) {
        let Some(graphics) = &self.graphics else { return };
        let Some(result) = self.loader.as_ref().and_then(Loader::poll) else { return };
        let gl = graphics.gl.clone();
        self.loader = None;
        let shown = result.and_then(|scene| self.show(&gl, scene).map_err(|error| error.to_string()));
        if let Err(reason) = shown {
            // Whether that is the end is for the platform to say.
            log::info!("no scene: {reason}");
            self.failure = Some(reason);
        }
    }

    /// Brings a scene into view.
    fn show(&mut self, gl: &Rc<Context>, scene: Scene) -> Result<(), GlError> {
        let settings = self.method_settings();
        let (render, options) = (settings.render_settings(), settings.stereo_options());
        let Some(graphics) = &mut self.graphics else { return Ok(()) };
        // The old scene goes first, or both would need memory.
        graphics.stage = None;
        self.viewpoints = scene.viewpoints.clone();
        self.viewpoint %= self.viewpoints.len().max(1);
        let scene = GpuScene::upload(gl, scene)?;
        let renderer = Renderer::new(gl, &render, &scene)?;
        let method = match stereo::create(gl, self.method, &render, &options) {
            Err(GlError::Unsupported(reason)) if self.method != Method::Yoro => {
                log::warn!("{} is used in place of {}: {reason}", Method::Yoro.name(), self.method.name());
                self.method = Method::Yoro;
                stereo::create(gl, self.method, &render, &options)
            }
            made => made,
        }?;
        log::info!("{}: {} triangles", scene.name, scene.triangle_count());
        graphics.stage = Some(Stage { scene, renderer, method, substitute: None });
        // The session is what is seen of the scene; a lost context does not begin another.
        if self.ready_ns.is_none() {
            self.telemetry = Telemetry::default();
            self.controller = Controller::new();
            self.ready_ns = Some(self.now_ns);
        }
        Ok(())
    }

    /// What the HUD says now.
    fn write_text(&mut self) {
        if let Some(questions) = self.questionnaire.as_ref().filter(|questions| !questions.is_done()) {
            return questions.write(&mut self.text);
        }
        let pipeline = self.uses_synthesis().then(|| self.pipeline.name());
        let event = match &self.loader {
            Some(_) => hud::Happening::Loading(&self.scene_name),
            None if self.now_ns < self.message_until_ns => hud::Happening::Message(&self.message),
            None => hud::Happening::Nothing,
        };
        match &self.failure {
            Some(failure) => hud::write_sentence(&mut self.text, failure),
            None => {
                let frames = self.last_line.as_ref();
                hud::write_status(&mut self.text, frames, self.celsius, self.method.name(), pipeline, event);
            }
        }
    }
}
