//! Eyes to screen: the whole application without a platform.
//!
//! A [`Viewer`] owns scene, renderer, stereo method, lens distortion, HUD, head tracker, settings and
//! statistics. A platform (the Android application, `yoro view` on the desktop) gives it a GL context, events,
//! sensor samples and a framebuffer, and shows what comes out; all of them get the same picture.
//!
//! ```text
//! Viewer::new ──> attach(gl) ──> [ sensor()* ── event()* ── render() ── sensor()* ── present() ]* ──> summary()
//!                    ^   context lost: detach()   |          telemetry() when a report says so
//!                    └────────────────────────────┘
//! ```
//!
//! All calls come from one thread; those that may touch GL (`attach`, `event`, `render`, `present`, `frame`,
//! `detach`, drop) need the context to be current there. Times are nanoseconds of a monotonic clock.

mod adaptive;
mod configure;
mod head;
mod hud;
mod lens;
mod loading;
mod optics;
mod params;
mod settings;
#[cfg(all(test, feature = "desktop"))]
mod tests;

use std::path::PathBuf;
use std::rc::Rc;

use glam::{Quat, Vec3};

pub use adaptive::{Controller, Load, Quality};
pub use head::{HeadTracker, Sample, neck_offset};
pub use loading::{SceneSource, list_scenes};
pub use optics::{Distortion, MESH_RESOLUTION, MeshVertex, Optics, Rotation, Screen, mesh_strip};
pub use params::{ParamsError, VerticalAlignment, ViewerParams};
pub use settings::{DisplayKind, KEYS, Settings, SettingsError, Ssao};

use crate::eyes::{DepthRange, Eye, EyePair, MAX_IPD, Pose};
use crate::gl::{Context, Destination, GlError, PassTime, Profiling};
use crate::render::{GpuScene, Renderer};
use crate::scene::{Scene, Viewpoint};
use crate::stereo::{self, Method, StereoError, StereoFrame, StereoMethod};
use crate::synthesis::{ImBufferSize, Pipeline};
use crate::telemetry::{DeviceState, Line, SessionSummary, Telemetry, ViewerState};
use hud::Hud;
use lens::LensPass;
use loading::Loader;

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
    /// A tap on the screen, or the viewer's trigger: the next method.
    Tap,
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
}

/// What an event has led to, for the log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// The method that is used now.
    Method(Method),
    /// The head's direction starts over.
    Recenter,
    /// The distance between the eyes in metres.
    Ipd(f32),
    /// Whether the HUD is shown.
    Hud(bool),
    /// The viewpoint's number.
    Viewpoint(usize),
    /// Nothing, because there is no other method or viewpoint.
    Nothing,
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
    /// A second has passed: collect a [`DeviceState`] and call [`Viewer::telemetry`].
    pub telemetry_due: bool,
    /// The session's `duration` has passed since the scene came into view: log [`Viewer::summary`]. True in one
    /// report only.
    pub session_over: bool,
    /// The session is over and `auto-exit` is on: end the program. True from then on.
    pub exit: bool,
}

/// A head that is held still, in place of the sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldHead {
    /// Rotation from head to world at which frames are rendered.
    pub rendered: Quat,
    /// Rotation from head to world at which they are shown: another one than `rendered` is what timewarp
    /// makes up for.
    pub displayed: Quat,
}

/// Everything that lives in the GL context.
struct Graphics {
    gl: Rc<Context>,
    frame: StereoFrame,
    lens: LensPass,
    hud: Hud,
    stage: Option<Stage>,
    /// The last frame that was rendered: rotation from head to world.
    rendered: Option<Quat>,
    pass_times: Vec<PassTime>,
}

/// A scene on the GPU and what shows it.
struct Stage {
    scene: GpuScene,
    renderer: Renderer,
    method: Box<dyn StereoMethod>,
}

/// The application without a platform.
pub struct Viewer {
    settings: Settings,
    screen: Screen,
    params: ViewerParams,
    optics: Optics,
    ipd: f32,
    method: Method,
    pipeline: Pipeline,
    hud_shown: bool,
    tracker: HeadTracker,
    held: Option<HeldHead>,
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
    message_until_ns: i64,
    message: String,
    /// What the HUD says.
    text: String,
    now_ns: i64,
    ready_ns: Option<i64>,
    is_over: bool,
}

impl Viewer {
    /// Puts a screen into a viewer and starts to load the scene in the background. `folders` are where scenes and
    /// viewer files given by name are looked for.
    ///
    /// # Errors
    /// [`ViewerError::Params`] and [`ViewerError::NoScene`]: mistakes in the settings.
    pub fn new(settings: Settings, screen: Screen, folders: &[PathBuf]) -> Result<Viewer, ViewerError> {
        let params = ViewerParams::find_in(&settings.viewer, folders)?;
        let source = SceneSource::find(&settings.scene, settings.seed, folders)?;
        let optics = Optics::new(&params, screen.metres());
        log::info!("settings: {settings}");
        log::info!(
            "viewer: {} {}, screen {:.1?} mm",
            params.vendor,
            params.model,
            screen.metres().map(|m| m * 1e3)
        );
        Ok(Viewer {
            screen,
            optics,
            ipd: settings.ipd.unwrap_or(params.inter_lens).min(MAX_IPD),
            params,
            method: settings.method,
            pipeline: settings.pipeline,
            hud_shown: settings.hud,
            tracker: HeadTracker::new(screen.rotation),
            held: None,
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
            message_until_ns: 0,
            message: String::new(),
            text: String::with_capacity(3 * hud::COLUMNS),
            now_ns: 0,
            ready_ns: None,
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
        self.graphics = Some(Graphics {
            frame: StereoFrame::new(&gl, self.eye_size())?,
            lens: LensPass::new(&gl, &self.optics, self.settings.chromatic)?,
            hud: Hud::new(&gl)?,
            stage: None,
            rendered: None,
            pass_times: Vec::with_capacity(64),
            gl,
        });
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

    /// The screen has another size, or is turned otherwise.
    ///
    /// # Errors
    /// [`ViewerError::Gl`].
    pub fn resize(&mut self, screen: Screen) -> Result<(), ViewerError> {
        if screen == self.screen {
            return Ok(());
        }
        self.screen = screen;
        self.optics = Optics::new(&self.params, screen.metres());
        self.tracker.set_rotation(screen.rotation);
        if let Some(graphics) = &mut self.graphics {
            graphics.lens = LensPass::new(&graphics.gl, &self.optics, self.settings.chromatic)?;
            graphics.rendered = None;
        }
        Ok(())
    }

    /// Replaces the scene; the old one stays in view until the new one is loaded.
    pub fn load_scene(&mut self, source: SceneSource) {
        self.loader = Some(Loader::start(&source));
        self.scene_name = source.name();
        self.source = source;
        self.failure = None;
        self.ready_ns = None;
        self.is_over = false;
    }

    /// Does what the user wants.
    ///
    /// # Errors
    /// [`ViewerError::Gl`] when a method cannot be made; the one before stays.
    pub fn event(&mut self, event: Event) -> Result<Action, ViewerError> {
        let action = match event {
            Event::Tap => self.next_method()?,
            Event::LongPress => {
                self.tracker.recenter();
                Action::Recenter
            }
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
        };
        self.message = match action {
            Action::Method(method) => method.name().to_owned(),
            Action::Recenter => "recentered".into(),
            Action::Ipd(ipd) => format!("IPD {:.0} mm", ipd * 1e3),
            Action::Viewpoint(n) => format!("viewpoint {n}"),
            Action::Hud(_) | Action::Nothing => String::new(),
        };
        self.message_until_ns = if self.message.is_empty() { 0 } else { self.now_ns + MESSAGE_NS };
        Ok(action)
    }

    fn change_ipd(&mut self, change: f32) -> Action {
        self.ipd = (self.ipd + change).clamp(0.0, MAX_IPD);
        Action::Ipd(self.ipd)
    }

    /// Goes to the next method of the list that the driver can do.
    fn next_method(&mut self) -> Result<Action, ViewerError> {
        let methods = self.settings.methods.clone();
        let at = methods.iter().position(|m| *m == self.method);
        let start = at.map_or(0, |at| at + 1);
        for next in (0..methods.len()).map(|i| methods[(start + i) % methods.len()]) {
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

    /// Takes a sample of a motion sensor with its own timestamp in nanoseconds.
    pub fn sensor(&mut self, sample: Sample, timestamp_ns: i64) {
        self.tracker.add(sample, timestamp_ns);
    }

    /// Holds the head still in place of the sensors, or lets it go.
    pub fn hold_head(&mut self, head: Option<HeldHead>) {
        self.held = head;
    }

    /// The application goes to the background: nothing moves on, and the time until the next frame counts for
    /// nothing.
    pub fn pause(&mut self) {
        self.tracker.pause();
        self.telemetry.pause();
        self.controller.restart();
    }

    /// The application is back.
    pub fn resume(&mut self) {
        self.controller.restart();
    }

    /// [`Viewer::render`] and [`Viewer::present`].
    ///
    /// # Errors
    /// As those.
    pub fn frame(&mut self, window: &Destination, timing: &FrameTiming) -> Result<FrameReport, ViewerError> {
        self.render(timing)?;
        self.present(window, timing)
    }

    /// Renders both eyes for the head pose that is expected when the frame is seen. Until the scene is there,
    /// that is a progress bar.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`], [`ViewerError::Gl`], [`ViewerError::Stereo`].
    pub fn render(&mut self, timing: &FrameTiming) -> Result<(), ViewerError> {
        self.now_ns = timing.now_ns;
        self.poll_scene();
        let head = self.head(timing).0;
        let pair = self.eyes(head);
        self.write_text();
        let graphics = self.graphics.as_mut().ok_or(ViewerError::NoContext)?;
        graphics.frame.resize(pair.size)?;
        let mut progress = None;
        match &mut graphics.stage {
            Some(Stage { scene, renderer, method }) => {
                method.render(renderer, scene, &pair, &mut graphics.frame)?;
            }
            None => {
                for eye in Eye::BOTH {
                    graphics.frame.eye(eye).bind();
                    graphics.gl.fill([0, 0], pair.size, BACKDROP);
                }
                // To and fro once in two seconds.
                let phase = (timing.now_ns.rem_euclid(2_000_000_000)) as f32 * 1e-9;
                progress = self.loader.is_some().then_some(1.0 - (1.0 - phase).abs());
            }
        }
        let is_empty = graphics.stage.is_none();
        if self.hud_shown || is_empty || timing.now_ns < self.message_until_ns {
            graphics.hud.set(hud::Content { text: &self.text, progress });
            graphics.hud.draw(&pair, &graphics.frame, is_empty);
        }
        graphics.rendered = Some(head);
        Ok(())
    }

    /// Puts the frame that was rendered last on the screen: through the lenses, turned to where the head points
    /// now. May be called again for the same frame, when the next one is late.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`]; [`ViewerError::Gl`] when an adapted method cannot be made.
    pub fn present(
        &mut self,
        window: &Destination,
        timing: &FrameTiming,
    ) -> Result<FrameReport, ViewerError> {
        self.now_ns = timing.now_ns;
        let displayed = self.head(timing).1;
        let graphics = self.graphics.as_mut().ok_or(ViewerError::NoContext)?;
        let rendered = graphics.rendered.unwrap_or(displayed);
        let turn = if self.settings.timewarp { rendered.inverse() * displayed } else { Quat::IDENTITY };
        graphics.lens.run(&graphics.frame, turn, window);
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
        self.is_over |= self.settings.duration.is_some_and(|s| shown_ns as f64 >= s as f64 * 1e9);
        Ok(FrameReport {
            scene,
            late_refreshes,
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

    /// The settings the viewer was made with.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The viewer's parameters and the screen in it.
    pub fn optics(&self) -> &Optics {
        &self.optics
    }

    /// Where the head points.
    pub fn tracker(&self) -> &HeadTracker {
        &self.tracker
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
        self.ipd
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

    /// Size in pixels of each eye's image.
    pub fn eye_size(&self) -> [u32; 2] {
        let full = self.optics.full_size(self.screen.size);
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

    /// Uploads the scene if its thread is done; [`Viewer::render`] does so by itself.
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
        graphics.stage = Some(Stage { scene, renderer, method });
        // The session is what is seen of the scene; a lost context does not begin another.
        if self.ready_ns.is_none() {
            self.telemetry = Telemetry::default();
            self.controller = Controller::new();
            self.ready_ns = Some(self.now_ns);
        }
        Ok(())
    }

    /// Rotation from head to world at which to render, and at which to show.
    fn head(&self, timing: &FrameTiming) -> (Quat, Quat) {
        if let Some(held) = self.held {
            return (held.rendered, held.displayed);
        }
        let head = self.tracker.world_from_head(timing.now_ns, timing.expected_display_ns);
        (head, head)
    }

    /// The eyes of a head that is turned like this, at the scene's viewpoint.
    fn eyes(&self, head: Quat) -> EyePair {
        let viewpoint = self.viewpoints.get(self.viewpoint).map_or(Pose::IDENTITY, Viewpoint::pose);
        // Gravity says what is level; of the viewpoint only the heading is left.
        let ahead = viewpoint.orientation * Vec3::NEG_Z;
        let heading = Quat::from_rotation_y((-ahead.x).atan2(-ahead.z));
        // At rest the eyes are where the scene's author has put them.
        let moved = neck_offset(head) - neck_offset(Quat::IDENTITY);
        let head = Pose { position: viewpoint.position + heading * moved, orientation: heading * head };
        let poses = Eye::BOTH.map(|eye| head.translated_local(Vec3::X * (eye.side() * self.ipd / 2.0)));
        EyePair {
            poses,
            frusta: Eye::BOTH.map(|eye| self.optics.frustum(eye)),
            depth: DepthRange::PAPER,
            size: self.eye_size(),
            dominant: self.settings.dominant,
        }
    }

    /// What the HUD says now.
    fn write_text(&mut self) {
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
