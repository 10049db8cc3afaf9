//! The application without a platform.
//!
//! A [`Viewer`] owns scene, renderer, stereo method, HUD, settings and statistics; where the eyes are, how large their
//! images are and how a person comes to see them is a display's matter. There are two, and each owns its viewer:
//! [`Cardboard`](crate::Cardboard), a phone behind lenses with its own motion sensors, and
//! [`Headset`](crate::openxr::Headset), a headset with an OpenXR runtime. A platform (the Android application,
//! `yoro view` and `yoro xr` on the desktop) gives a GL context, events and somewhere to draw.
//!
//! ```text
//! new ──> attach(gl) ──> [ event()* ── begin() ── render_eyes() ── hud() ── end() ]* ──> summary()
//!             ^   context lost: detach()   |          telemetry() when a report says so
//!             └────────────────────────────┘
//! ```
//!
//! All calls come from one thread; those that may touch GL (`attach`, `event`, `configure`, `begin`, `render_eyes`,
//! `hud`, `end`, `detach`, drop) need the context to be current there. Times are nanoseconds of a monotonic clock.

#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::rc::Rc;

use crate::adaptive::Load;
use crate::caption::{Caption, Status};
use crate::error::ViewerError;
use crate::event::{Action, Event};
use crate::frame::{FrameReport, FrameTiming, SceneState};
use crate::loading::SceneSource;
use crate::method_slot::MethodSlot;
use crate::scene_slot::{SceneSlot, Shown};
use crate::session_stats::SessionStats;
use yoro::eyes::{EyePair, Pose};
use yoro_gl::{Context, Destination, GlError, PassTime, Profiling};
use yoro_lenses::{Content, Hud, Panel, Placement};
use yoro_protocol::telemetry::{DeviceState, Line, Rating, SessionSummary, ViewerState};
use yoro_protocol::{Ipd, Settings};
use yoro_render::stereo::{EyeTarget, Method, Pipeline, StereoOptions};
use yoro_render::{RenderSettings, Renderer};
use yoro_scene::Scene;

/// The IPD changes by this much at a time, in metres.
const IPD_STEP: f32 = 0.001;
/// The images of the eyes are multiples of this many pixels, so that small changes need no new targets.
const SIZE_STEP: f32 = 16.0;
/// The background while there is no scene.
const BACKDROP: [f32; 4] = [0.03, 0.035, 0.05, 1.0];
/// Passes of a frame for whose times there is room from the start.
const MOST_PASSES: usize = 64;

/// Objects that live in the GL context besides scene and method.
struct Attached {
    gl: Rc<Context>,
    hud: Hud,
    pass_times: Vec<PassTime>,
}

/// The sources of the distance between the eyes.
#[derive(Clone, Copy, Debug)]
struct IpdSources {
    /// The settings or the user.
    chosen: Option<Ipd>,
    /// The display by itself.
    native: Ipd,
}

/// The application without a platform.
pub struct Viewer {
    settings: Settings,
    folders: Vec<PathBuf>,
    scene: SceneSlot,
    method: MethodSlot,
    stats: SessionStats,
    caption: Caption,
    ipd: IpdSources,
    attached: Option<Attached>,
    now_ns: i64,
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
            scene: SceneSlot::new(source, settings.viewpoint),
            method: MethodSlot::new(&settings),
            stats: SessionStats::default(),
            caption: Caption::new(settings.hud),
            ipd: IpdSources { chosen: settings.ipd, native: Ipd::nearest(0.0) },
            attached: None,
            now_ns: 0,
            settings,
        })
    }

    /// Takes a GL context and makes everything that lives in it. The scene is shown as soon as it is loaded.
    ///
    /// # Errors
    /// [`ViewerError::Gl`].
    pub fn attach(&mut self, gl: Rc<Context>) -> Result<(), ViewerError> {
        gl.set_profiling(profiling(&self.settings));
        self.method.choose_pipeline(&gl, &self.settings);
        // What a context before this one held.
        self.detach();
        let hud = Hud::new(&gl)?;
        self.attached = Some(Attached { hud, pass_times: Vec::with_capacity(MOST_PASSES), gl });
        self.scene.reload();
        Ok(())
    }

    /// Drops everything that lives in the GL context, which is lost or about to be destroyed. After another
    /// [`Viewer::attach`] the scene is loaded again.
    pub fn detach(&mut self) {
        self.method.drop_made();
        self.scene.drop_shown();
        self.attached = None;
    }

    /// True if there is a GL context.
    pub fn is_attached(&self) -> bool {
        self.attached.is_some()
    }

    /// Replaces the scene; the old one stays in view until the new one is loaded.
    pub fn load_scene(&mut self, source: SceneSource) {
        self.replace_scene(source, self.scene.viewpoint());
    }

    fn replace_scene(&mut self, source: SceneSource, viewpoint: usize) {
        self.scene.replace(source, viewpoint);
        self.stats.expect_scene();
    }

    /// Takes over other settings; only what differs from the ones before is made again. What the user has changed by
    /// hand stays, unless that very setting differs.
    ///
    /// # Errors
    /// [`ViewerError::NoScene`], and [`ViewerError::Gl`] when the driver cannot do what is asked for; the settings
    /// before stay.
    pub fn configure(&mut self, settings: Settings, folders: &[PathBuf]) -> Result<(), ViewerError> {
        // What may fail by a mistake in the settings comes first.
        let source = self.other_scene(&settings, folders)?;
        let (render, method_differs) =
            (RenderSettings::of_settings(&settings), settings.method != self.settings.method);
        if let Some(attached) = &self.attached
            && (method_differs || render != RenderSettings::of_settings(&self.settings))
        {
            let method = if method_differs { settings.method } else { self.method.method() };
            render.supports(method, attached.gl.capabilities())?;
        }
        let before = std::mem::replace(&mut self.settings, settings);
        let in_use = self.method.choice();
        if let Err(error) = self.remake(&before) {
            self.settings = before;
            self.method.set_choice(in_use);
            return Err(error.into());
        }
        let settings = &self.settings;
        if settings.ipd != before.ipd {
            self.ipd.chosen = settings.ipd;
        }
        if settings.hud != before.hud {
            self.caption.is_shown = settings.hud;
        }
        if settings.viewpoint != before.viewpoint {
            self.scene.go_to(settings.viewpoint);
        }
        if settings.adaptive != before.adaptive || settings.render_scale != before.render_scale {
            self.method.restore_quality();
        }
        if settings.duration != before.duration {
            self.stats.reopen();
        }
        if let Some(attached) = &self.attached
            && settings.profiling != before.profiling
        {
            attached.gl.set_profiling(profiling(settings));
        }
        self.folders = folders.to_vec();
        if let Some(source) = source {
            self.replace_scene(source, self.settings.viewpoint);
        }
        Ok(())
    }

    fn other_scene(
        &self,
        settings: &Settings,
        folders: &[PathBuf],
    ) -> Result<Option<SceneSource>, ViewerError> {
        if (&settings.scene, settings.seed) == (&self.settings.scene, self.settings.seed) {
            return Ok(None);
        }
        SceneSource::find(&settings.scene, settings.seed, folders).map(Some)
    }

    /// Makes renderer and method again, if the settings before were others.
    fn remake(&mut self, before: &Settings) -> Result<(), GlError> {
        let settings = &self.settings;
        let method_differs = settings.method != before.method;
        if method_differs {
            self.method.set_choice((settings.method, self.method.pipeline()));
        }
        if let Some(attached) = &self.attached {
            self.method.choose_pipeline(&attached.gl, settings);
        }
        let render = RenderSettings::of_settings(settings);
        let renderer_differs = render != RenderSettings::of_settings(before);
        if let Some(attached) = &self.attached
            && let Some(shown) = self.scene.shown()
            && renderer_differs
        {
            shown.renderer = Renderer::new(&attached.gl, &render, &shown.scene)?;
        }
        let options_differ = StereoOptions::of_settings(settings, settings.pipeline)
            != StereoOptions::of_settings(before, before.pipeline);
        if renderer_differs || options_differ || method_differs {
            self.make_method()?;
        }
        Ok(())
    }

    /// Compiles the current method, if there is a scene to use it on.
    fn make_method(&mut self) -> Result<(), GlError> {
        let gl = gl_with_scene(&self.attached, &self.scene);
        self.method.make(gl, &self.settings)
    }

    /// Does what the user wants.
    ///
    /// # Errors
    /// [`ViewerError::Gl`] when a method cannot be made; the one before stays.
    pub fn event(&mut self, event: Event) -> Result<Action, ViewerError> {
        if self.stats.question().is_some() {
            return Ok(self.reply(event));
        }
        let action = match event {
            Event::Tap => self.other_method(1)?,
            Event::PreviousMethod => self.other_method(-1)?,
            Event::LongPress => Action::Recenter,
            Event::IpdUp => self.change_ipd(IPD_STEP),
            Event::IpdDown => self.change_ipd(-IPD_STEP),
            Event::ToggleHud => {
                self.caption.is_shown = !self.caption.is_shown;
                Action::Hud(self.caption.is_shown)
            }
            Event::NextViewpoint => self.scene.next_viewpoint().map_or(Action::Nothing, Action::Viewpoint),
            Event::NextScene => self.next_scene(),
        };
        let message = match action {
            Action::Method(method) => method.name().to_owned(),
            Action::Recenter => "recentered".into(),
            Action::Ipd(ipd) => format!("IPD {:.0} mm", ipd.metres() * 1e3),
            Action::Viewpoint(n) => format!("viewpoint {n}"),
            Action::Hud(_) | Action::Scene | Action::Marker(_) | Action::Answer | Action::Nothing => {
                String::new()
            }
        };
        self.caption.announce(message, self.now_ns);
        Ok(action)
    }

    /// Takes an event while a question is in view.
    fn reply(&mut self, event: Event) -> Action {
        let now_ns = self.now_ns;
        let Some(question) = self.stats.question_mut() else { return Action::Nothing };
        let mut nudge = |steps| {
            question.nudge(steps, now_ns);
            Action::Marker(question.rating())
        };
        match event {
            Event::IpdUp => nudge(1.0),
            Event::IpdDown => nudge(-1.0),
            Event::Tap => {
                self.answer();
                Action::Answer
            }
            Event::LongPress => {
                question.recenter();
                Action::Recenter
            }
            Event::PreviousMethod | Event::ToggleHud | Event::NextViewpoint | Event::NextScene => {
                Action::Nothing
            }
        }
    }

    /// Keeps and logs the answer to the question in view.
    fn answer(&mut self) {
        let answer = self.stats.question_mut().and_then(|question| question.answer());
        let Some((question, rating)) = answer else { return };
        let ViewerState { method, pipeline, scene, .. } = self.state();
        let Settings { participant, trial, .. } = &self.settings;
        let (participant, trial, rating) = (participant.clone(), *trial, f64::from(rating));
        let rating = Rating { participant, trial, method, pipeline, scene, question, rating };
        log::info!("{rating}");
        self.stats.keep(rating);
    }

    /// Asks the questions of the settings when the session's time is up; true when there is nothing more to ask.
    fn ask(&mut self) -> bool {
        self.stats.ask(&self.settings);
        if self.stats.question().is_some_and(|question| question.has_settled(self.now_ns)) {
            self.answer();
        }
        self.stats.question().is_none()
    }

    fn change_ipd(&mut self, change: f32) -> Action {
        let ipd = Ipd::nearest(self.ipd().metres() + change);
        self.ipd.chosen = Some(ipd);
        Action::Ipd(ipd)
    }

    /// Loads the scene after this one.
    fn next_scene(&mut self) -> Action {
        let Some(source) = self.scene.next(self.settings.seed, &self.folders) else { return Action::Nothing };
        self.replace_scene(source, 0);
        Action::Scene
    }

    /// Goes to the next (1) or previous (-1) method of the list that the driver can do.
    fn other_method(&mut self, step: isize) -> Result<Action, ViewerError> {
        let gl = gl_with_scene(&self.attached, &self.scene);
        let other = self.method.switch(gl, &self.settings, step)?;
        Ok(other.map_or(Action::Nothing, Action::Method))
    }

    /// The application goes to the background: nothing moves on, and the time until the next frame is not
    /// counted.
    pub fn pause(&mut self) {
        self.stats.pause();
        self.method.interrupt();
    }

    /// The application is back.
    pub fn resume(&mut self) {
        self.method.interrupt();
    }

    /// Begins a frame: what has been loaded comes into view.
    pub fn begin(&mut self, timing: &FrameTiming) {
        self.now_ns = timing.now_ns;
        self.poll_scene();
    }

    /// Renders both eyes; nothing but a backdrop until the scene is there. Eyes of which neither can be synthesized
    /// from the other (canted ones) are both rendered, whatever the method.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`], [`ViewerError::Gl`], [`ViewerError::Stereo`].
    pub fn render_eyes(&mut self, pair: &EyePair, to: &[EyeTarget; 2]) -> Result<(), ViewerError> {
        self.stats.look(pair.poses[pair.dominant.index()].orientation, self.now_ns);
        self.method.judge(pair);
        let gl = &self.attached.as_ref().ok_or(ViewerError::NoContext)?.gl;
        let Some(shown) = self.scene.shown() else {
            for Destination { framebuffer, origin, size } in to.iter().map(|eye| eye.color) {
                gl.bind_framebuffer(framebuffer, origin, size);
                gl.fill(origin, size, BACKDROP);
            }
            return Ok(());
        };
        self.method.render(gl, &self.settings, shown, pair, to)?;
        if let Some(used) = self.method.guard_band() {
            self.stats.guard_band(used);
        }
        Ok(())
    }

    /// The HUD as it should be seen in this frame, if at all.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`].
    pub fn hud(&mut self) -> Result<Option<Panel<'_>>, ViewerError> {
        self.write_caption();
        let attached = self.attached.as_mut().ok_or(ViewerError::NoContext)?;
        let text = self.caption.text();
        if let Some(question) = self.stats.question() {
            let progress = Some(question.position());
            return Ok(Some(attached.hud.set(Content { text, progress }, Placement::Middle)));
        }
        let is_empty = !self.scene.is_shown();
        if !is_empty && !self.caption.is_in_view(self.now_ns) {
            return Ok(None);
        }
        // To and fro once in two seconds.
        let phase = (self.now_ns.rem_euclid(2_000_000_000)) as f32 * 1e-9;
        let progress = (is_empty && self.scene.is_loading()).then_some(1.0 - (1.0 - phase).abs());
        let placement = if is_empty { Placement::Middle } else { Placement::Below };
        Ok(Some(attached.hud.set(Content { text, progress }, placement)))
    }

    /// Writes what the HUD says now.
    fn write_caption(&mut self) {
        if let Some(question) = self.stats.question() {
            return question.write(self.caption.text_mut());
        }
        if let Some(failure) = self.scene.failure() {
            return self.caption.write_sentence(failure);
        }
        let status = Status {
            frames: self.stats.last_line(),
            celsius: self.stats.celsius(),
            method: self.method.name(),
            pipeline: self.method.pipeline_name(),
            loading: self.scene.is_loading().then(|| self.scene.name()),
        };
        self.caption.write_status(&status, self.now_ns);
    }

    /// Ends a frame that is on its way to the display.
    ///
    /// # Errors
    /// [`ViewerError::NoContext`]; [`ViewerError::Gl`] when an adapted method cannot be made.
    pub fn end(&mut self, timing: &FrameTiming) -> Result<FrameReport, ViewerError> {
        let &FrameTiming { now_ns, refresh_hz, .. } = timing;
        self.now_ns = now_ns;
        let Attached { gl, pass_times, .. } = self.attached.as_mut().ok_or(ViewerError::NoContext)?;
        pass_times.clear();
        let timed = gl.end_timed_frame(pass_times);
        let gpu_ms = (timed > 0).then(|| pass_times.iter().map(|p| p.time.as_secs_f32() * 1e3).sum());
        let late_refreshes = self.stats.frame(now_ns, refresh_hz, pass_times, timed);
        let scene = self.scene.state();
        let load = Load { now_ns, refresh_hz, late_refreshes, gpu_ms };
        if self.settings.adaptive && scene == SceneState::Ready && self.method.adapt(&load, &self.settings) {
            self.make_method()?;
        }
        let was_over = self.stats.is_over();
        if !was_over && self.stats.is_time_up(&self.settings, now_ns) && self.ask() {
            self.stats.end();
        }
        let is_over = self.stats.is_over();
        Ok(FrameReport {
            scene,
            late_refreshes,
            gpu_ms,
            telemetry_due: self.stats.is_line_due(now_ns),
            session_over: is_over && !was_over,
            exit: is_over && self.settings.auto_exit,
        })
    }

    /// Ends a second: makes its line for the log. Call it when a [`FrameReport`] says so, with what the device says
    /// now.
    pub fn telemetry(&mut self, now_ns: i64, device: &DeviceState) -> Line {
        self.method.set_thermal_headroom(device.thermal_headroom);
        let state = self.state();
        self.stats.line(now_ns, &state, device)
    }

    /// Returns the viewer's own part of a log line.
    fn state(&self) -> ViewerState {
        ViewerState {
            method: self.method.name().to_owned(),
            pipeline: self.method.pipeline_name().map(str::to_owned),
            scene: self.scene.name().to_owned(),
            render_scale: self.render_scale(),
            imbuffer: self.method.imbuffer_divisor(&self.settings),
            run: self.settings.run.clone(),
        }
    }

    /// The session since the scene came into view, for the log at its end.
    pub fn summary(&self, now_ns: i64) -> SessionSummary {
        self.stats.summary(now_ns)
    }

    /// The answers to the questions of the settings so far; each is logged when it is given.
    pub fn ratings(&self) -> &[Rating] {
        self.stats.ratings()
    }

    /// The settings the viewer was made with, or has taken over since.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The method in use.
    pub fn method(&self) -> Method {
        self.method.method()
    }

    /// The pipeline in use, which is another one than in the settings where the driver cannot do that.
    pub fn pipeline(&self) -> Pipeline {
        self.method.pipeline()
    }

    /// Distance between the eyes in metres.
    pub fn ipd(&self) -> Ipd {
        self.ipd.chosen.unwrap_or(self.ipd.native)
    }

    /// The distance between the eyes that the settings or the user ask for, if not that of the display.
    pub fn chosen_ipd(&self) -> Option<Ipd> {
        self.ipd.chosen
    }

    /// Sets the distance between the eyes that the display has by itself.
    pub fn set_native_ipd(&mut self, ipd: Ipd) {
        self.ipd.native = ipd;
    }

    /// Takes back what the user has made of the distance between the eyes.
    pub(crate) fn reset_ipd(&mut self) {
        self.ipd.chosen = self.settings.ipd;
    }

    /// The scene that is in view or on its way.
    pub fn scene_name(&self) -> &str {
        self.scene.name()
    }

    /// Number of the viewpoint.
    pub fn viewpoint(&self) -> usize {
        self.scene.viewpoint()
    }

    /// Time of the last frame in nanoseconds.
    pub fn now_ns(&self) -> i64 {
        self.now_ns
    }

    /// Transforms a pose relative to the viewpoint (metres, Y up, -Z ahead) into the scene.
    pub fn place(&self, pose: Pose) -> Pose {
        self.scene.place(pose)
    }

    /// The state of the scene.
    pub fn scene_state(&self) -> SceneState {
        self.scene.state()
    }

    /// The reason why the scene cannot be shown, in one sentence.
    pub fn failure(&self) -> Option<&str> {
        self.scene.failure()
    }

    /// Size in pixels of each eye's image on a display whose full size is `full`.
    pub fn eye_size(&self, full: [f32; 2]) -> [u32; 2] {
        // Methods render a guard band beside the image.
        let limit = self.attached.as_ref().map_or(4096, |g| g.gl.capabilities().max_texture_size) / 2;
        let steps = |pixels: f32| (pixels * self.render_scale() / SIZE_STEP).round().max(4.0) * SIZE_STEP;
        full.map(|n| (steps(n) as u32).min(limit))
    }

    fn render_scale(&self) -> f32 {
        self.settings.render_scale * self.method.render_scale()
    }

    /// Uploads the scene if its thread is done; [`Viewer::begin`] does so by itself.
    pub fn poll_scene(&mut self) {
        let Some(attached) = &self.attached else { return };
        let Some(loaded) = self.scene.take_loaded() else { return };
        let gl = attached.gl.clone();
        let shown = loaded.and_then(|scene| self.show(&gl, scene).map_err(|error| error.to_string()));
        if let Err(reason) = shown {
            // Whether that is the end is for the platform to say.
            log::info!("no scene: {reason}");
            self.scene.fail(reason);
        }
    }

    /// Brings a scene into view.
    fn show(&mut self, gl: &Rc<Context>, scene: Scene) -> Result<(), GlError> {
        // The old scene goes first, or both would need memory.
        self.method.drop_made();
        self.scene.drop_shown();
        self.scene.set_viewpoints(&scene.viewpoints);
        let shown = Shown::new(gl, scene, &RenderSettings::of_settings(&self.settings))?;
        self.method.make_first(gl, &self.settings)?;
        log::info!("{}: {} triangles", shown.scene.name, shown.scene.triangle_count());
        self.scene.show(shown);
        if self.stats.begin(self.now_ns) {
            self.method.restart_controller();
        }
        Ok(())
    }
}

/// The context, where there is a scene in it to use a method on.
fn gl_with_scene<'a>(attached: &'a Option<Attached>, scene: &SceneSlot) -> Option<&'a Rc<Context>> {
    attached.as_ref().filter(|_| scene.is_shown()).map(|attached| &attached.gl)
}

fn profiling(settings: &Settings) -> Profiling {
    if settings.profiling { Profiling::Queries } else { Profiling::Off }
}
