//! The activity's life, and its main loop.
//!
//! On a headset with an OpenXR runtime the application is immersive: the runtime says when to draw, and where the eyes
//! are. Everywhere else it is a Cardboard-compatible viewer on Android's window. Which one is decided once, when the
//! activity comes to the front for the first time.

use std::ffi::CString;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::{Duration, Instant};

use android_activity::{AndroidApp, MainEvent, PollEvent, WindowManagerFlags};
use yoro::gl::{Context, Destination};
use yoro::platform::android::{Window, WindowError};
use yoro::platform::openxr::{Android, Headset, Options, Step, XrError, runtime};
use yoro::scene::builtin::BUILTINS;
use yoro::viewer::{
    Action, Cardboard, DisplayKind, Event, FrameTiming, Rotation, Screen, Settings, Viewer, ViewerError,
    list_scenes,
};

use crate::device::Device;
use crate::input::Input;
use crate::java::{Display, Java};
use crate::pulse::Pulse;
use crate::settings::{self, Sources};

/// Without a word from the choreographer for so long, a frame is drawn all the same.
const PATIENCE: Duration = Duration::from_millis(100);
/// Time between attempts to get a lost context or a refused window again.
const RETRY: Duration = Duration::from_millis(250);
/// What is assumed of a display that does not say its rate, in Hz.
const USUAL_HZ: f32 = 60.0;
/// A frame that is begun at one refresh is seen at the second one after it.
const REFRESHES_AHEAD: f64 = 2.0;
/// How often a headset's runtime is asked for events while it wants no frames: in front, and in the background.
const HEADSET_POLL: Duration = Duration::from_millis(10);
const HEADSET_BACKGROUND_POLL: Duration = Duration::from_millis(100);
/// The screen of a device that cannot show anything else, display-referred.
const FAILURE_COLOR: [f32; 3] = [0.45, 0.05, 0.05];

/// Runs the application until Android destroys the activity or the session is over.
pub fn run(app: &AndroidApp) {
    app.set_window_flags(
        WindowManagerFlags::KEEP_SCREEN_ON | WindowManagerFlags::FULLSCREEN,
        WindowManagerFlags::empty(),
    );
    let mut activity = Activity::new(app);
    while !activity.is_over {
        activity.wait();
        activity.step();
    }
    activity.end();
}

/// Everything that one run of `android_main` holds.
struct Activity {
    // What lives in the GL context goes before the context.
    headset: Option<Headset>,
    /// What the headset shows.
    immersive: Option<Viewer>,
    cardboard: Option<Cardboard>,
    gl: Option<Rc<Context>>,
    window: Option<Window>,

    app: AndroidApp,
    java: Java,
    sources: Sources,
    settings: Settings,
    folders: Vec<PathBuf>,
    display: Option<Display>,
    refresh_hz: f32,

    pulse: Option<&'static Pulse>,
    device: Option<Device>,
    input: Input,
    events: Vec<Event>,
    samples: Vec<(yoro::viewer::Sample, i64)>,

    /// Whether it is decided on what the eyes are shown.
    is_display_chosen: bool,
    is_resumed: bool,
    is_finishing: bool,
    is_over: bool,
    is_summarized: bool,
    has_input: bool,
    is_display_stale: bool,
    /// Why this device can show nothing.
    failure: Option<String>,
    retry: Option<Instant>,
    last_frame: Instant,
    last_error: String,
    /// What was wrong with the settings when they were last read.
    mistakes: Vec<String>,
}

impl Activity {
    fn new(app: &AndroidApp) -> Activity {
        let java = Java::new(app);
        let external = app.external_data_path();
        let folders: Vec<PathBuf> =
            external.iter().flat_map(|folder| [folder.join("scenes"), folder.clone()]).collect();
        if let Some(scenes) = folders.first()
            && let Err(error) = std::fs::create_dir_all(scenes)
        {
            log::warn!(
                "the folder {} cannot be made ({error}): scenes cannot be pushed there",
                scenes.display()
            );
        }
        let sources = Sources {
            file: external.map(|folder| folder.join(settings::FILE_NAME)),
            extras: java.extras(),
            properties: settings::properties(property),
            saved: Vec::new(),
        };
        Activity {
            headset: None,
            immersive: None,
            cardboard: None,
            gl: None,
            window: None,
            app: app.clone(),
            java,
            sources,
            settings: Settings::default(),
            folders,
            display: None,
            refresh_hz: 0.0,
            pulse: Pulse::get(),
            device: None,
            input: Input::default(),
            events: Vec::new(),
            samples: Vec::new(),
            is_display_chosen: false,
            is_resumed: false,
            is_finishing: false,
            is_over: false,
            is_summarized: false,
            has_input: false,
            is_display_stale: true,
            failure: None,
            retry: None,
            last_frame: Instant::now(),
            last_error: String::new(),
            mistakes: Vec::new(),
        }
    }

    fn is_ready(&self) -> bool {
        self.cardboard.as_ref().is_some_and(Cardboard::is_attached)
    }

    /// The application, on whatever it is shown.
    fn viewer(&self) -> Option<&Viewer> {
        self.immersive.as_ref().or(self.cardboard.as_ref().map(Cardboard::viewer))
    }

    fn is_drawing(&self) -> bool {
        let has_window = self.window.as_ref().is_some_and(Window::is_attached);
        self.is_resumed && has_window && self.is_ready() && self.failure.is_none()
    }

    /// Sleeps until there is something to do, and lets Android's events in.
    fn wait(&mut self) {
        let mut timeout = if let Some(headset) = &self.headset {
            Some(match (headset.is_running(), self.is_resumed) {
                // The runtime sets the pace.
                (true, _) => Duration::ZERO,
                (false, true) => HEADSET_POLL,
                (false, false) => HEADSET_BACKGROUND_POLL,
            })
        } else if self.retry.is_some() {
            Some(PATIENCE)
        } else if !self.is_drawing() {
            None
        } else if self.pulse.is_some_and(Pulse::has_refreshes) {
            Some(PATIENCE)
        } else {
            Some(Duration::ZERO)
        };
        let app = self.app.clone();
        let mut is_quiet = false;
        while !is_quiet && !self.is_over {
            app.poll_events(timeout, |event| match event {
                PollEvent::Main(event) => self.on_event(event),
                _ => is_quiet = true,
            });
            timeout = Some(Duration::ZERO);
        }
    }

    fn on_event(&mut self, event: MainEvent) {
        log::debug!("{event:?}");
        match event {
            MainEvent::InitWindow { .. } => {
                self.choose_display();
                self.open_window();
            }
            MainEvent::TerminateWindow { .. } => {
                self.input.cancel();
                if let Some(window) = &mut self.window {
                    window.detach();
                }
            }
            MainEvent::WindowResized { .. }
            | MainEvent::ContentRectChanged { .. }
            | MainEvent::ConfigChanged { .. } => self.is_display_stale = true,
            MainEvent::RedrawNeeded { .. } => {
                if let Some(failure) = self.failure.clone() {
                    self.fail(failure);
                }
            }
            MainEvent::GainedFocus => self.java.hide_system_bars(),
            MainEvent::Resume { loader, .. } => {
                if self.viewer().is_none()
                    && let Some(saved) = loader.load()
                {
                    self.sources.saved = settings::restore(&saved);
                }
                self.choose_display();
                self.resume();
            }
            MainEvent::Pause => self.pause(),
            MainEvent::SaveState { saver, .. } => saver.store(&settings::save(&self.changes())),
            MainEvent::LowMemory => self.free_memory(),
            MainEvent::InputAvailable => self.has_input = true,
            MainEvent::Destroy => self.is_over = true,
            _ => {}
        }
    }

    fn resume(&mut self) {
        self.is_resumed = true;
        self.is_display_stale = true;
        self.last_frame = Instant::now();
        self.device = Some(Device::watch(&self.java));
        if self.headset.is_none()
            && let Some(pulse) = self.pulse
        {
            pulse.resume(self.app.create_waker());
        }
        if let Some(cardboard) = &mut self.cardboard {
            cardboard.resume();
        }
        self.java.hide_system_bars();
    }

    fn pause(&mut self) {
        self.is_resumed = false;
        self.device = None;
        self.input.cancel();
        if let Some(pulse) = self.pulse {
            pulse.pause();
        }
        if let Some(cardboard) = &mut self.cardboard {
            cardboard.pause();
        }
    }

    /// What the user has changed since the settings were read.
    fn changes(&self) -> Vec<settings::Pair> {
        let Some(viewer) = self.viewer() else { return self.sources.saved.clone() };
        let method =
            (viewer.method() != self.settings.method).then(|| ("method", viewer.method().name().to_owned()));
        let ipd = viewer.chosen_ipd().filter(|ipd| Some(*ipd) != self.settings.ipd);
        let ipd = ipd.map(|ipd| ("ipd", ipd.to_string()));
        [method, ipd].into_iter().flatten().map(|(key, value)| (key.to_owned(), value)).collect()
    }

    /// In the background everything on the GPU can go; it is made again with the next window.
    fn free_memory(&mut self) {
        if self.headset.is_some() || self.window.as_ref().is_some_and(Window::is_attached) {
            log::warn!("Android is short of memory: a smaller render-scale or scene needs less");
        } else if let Some(cardboard) = &mut self.cardboard {
            log::info!("Android is short of memory: what is on the GPU is dropped");
            cardboard.detach();
        }
    }

    /// Decides on what the eyes are shown, and says why in one line.
    fn choose_display(&mut self) {
        if std::mem::replace(&mut self.is_display_chosen, true) {
            return;
        }
        let settings = self.resolve();
        if settings.display == DisplayKind::Cardboard {
            log::info!("display: Cardboard-compatible viewer, since the settings say so");
            return;
        }
        // SAFETY: the process's VM, and a global reference that lives as long as `self.app`.
        let android = unsafe { Android::new(self.app.vm_as_ptr(), self.app.activity_as_ptr()) };
        let found = match runtime::find(&runtime::android_places(), &self.java, Some(&android.context())) {
            Ok(found) => found,
            // A phone: nothing is wrong.
            Err(reason) if reason.nothing_installed() && settings.display == DisplayKind::Auto => {
                log::info!("display: Cardboard-compatible viewer, since {reason}");
                return;
            }
            Err(reason) => {
                log::warn!("display: Cardboard-compatible viewer, since {reason}");
                return;
            }
        };
        let line = found.found().to_string();
        match self.open_headset(found, android) {
            Ok(()) => log::info!("display: headset, by {line}"),
            Err(reason) => {
                self.close_headset();
                log::warn!("display: Cardboard-compatible viewer, since {reason}");
            }
        }
    }

    fn open_headset(&mut self, found: runtime::Runtime, android: Android) -> Result<(), HeadsetError> {
        let window = match self.window.take() {
            Some(window) => window,
            None => Window::open()?,
        };
        let window = self.window.insert(window);
        if self.gl.is_none() {
            let gl = window.gl().map_err(ViewerError::Gl)?;
            log::info!("driver: {}", gl.capabilities().summary());
            self.gl = Some(gl);
        }
        let mut viewer = self.make_viewer(Viewer::new)?;
        let (Some(gl), Some(window)) = (&self.gl, &self.window) else { return Ok(()) };
        viewer.attach(gl.clone())?;
        let options = Options { android: Some(android), ..Options::default() };
        self.headset = Some(Headset::open(found, window, gl, &viewer, options)?);
        self.immersive = Some(viewer);
        Ok(())
    }

    /// Leaves the headset; Android's window is next, if there is one.
    fn close_headset(&mut self) {
        self.headset = None;
        self.immersive = None;
    }

    /// One step of the headset: a frame, unless the runtime wants none.
    fn step_headset(&mut self) {
        let (Some(headset), Some(viewer), Some(window)) =
            (&mut self.headset, &mut self.immersive, &self.window)
        else {
            return;
        };
        self.events.drain(..).for_each(|event| headset.event(event));
        let scene = viewer.scene_name().to_owned();
        let frame = match headset.step(window, viewer) {
            Ok(Step::Idle) => return,
            Ok(Step::Frame(frame)) => frame,
            Ok(Step::Ended) => return self.finish(),
            Err(error) => {
                log::error!("display: Cardboard-compatible viewer from now on, since {error}");
                self.summarize();
                self.is_summarized = false;
                self.close_headset();
                self.open_window();
                if self.is_resumed {
                    self.resume();
                }
                return;
            }
        };
        if viewer.scene_name() != scene {
            self.is_summarized = false;
        }
        let Some(report) = frame.report else { return };
        if report.telemetry_due {
            self.every_second();
        }
        if report.session_over {
            self.summarize();
        }
        if report.exit
            && let Some(headset) = &mut self.headset
        {
            headset.request_exit();
        }
    }

    /// Asks Android to end the activity.
    fn finish(&mut self) {
        // Not by returning: only a loop that still runs gives window and input queue back.
        if !std::mem::replace(&mut self.is_finishing, true) {
            self.java.finish();
        }
    }

    /// Draws on Android's window, if there is one and the headset does not need the context, and makes what is needed
    /// for it.
    fn open_window(&mut self) {
        self.retry = None;
        if self.headset.is_some() {
            return;
        }
        let Some(native) = self.app.native_window() else { return };
        let window = match self.window.take().map_or_else(Window::open, Ok) {
            Ok(window) => self.window.insert(window),
            Err(error) => return self.fail(error.to_string()),
        };
        match window.attach(native) {
            Ok(()) => self.is_display_stale = true,
            Err(error) => return self.on_window_error(&error),
        }
        if self.gl.is_none() && self.failure.is_none() {
            match window.gl() {
                Ok(gl) => {
                    log::info!("driver: {}", gl.capabilities().summary());
                    self.gl = Some(gl);
                }
                Err(error) => return self.fail(error.to_string()),
            }
        }
        match self.failure.clone() {
            Some(failure) => self.fail(failure),
            None => self.attach_viewer(),
        }
    }

    fn attach_viewer(&mut self) {
        let Some(screen) = self.screen() else { return };
        let Some(gl) = self.gl.clone() else { return };
        if self.cardboard.is_none() {
            match self.make_viewer(|settings, folders| Cardboard::new(settings, screen, folders)) {
                Ok(cardboard) => self.cardboard = Some(cardboard),
                Err(error) => return self.fail(error.to_string()),
            }
        }
        let Some(cardboard) = &mut self.cardboard else { return };
        if !cardboard.is_attached()
            && let Err(error) = cardboard.attach(gl)
        {
            self.fail(error.to_string());
        }
    }

    /// A viewer with the settings from outside; mistakes in them are told, and the defaults take their place.
    fn make_viewer<T>(
        &mut self,
        new: impl Fn(Settings, &[PathBuf]) -> Result<T, ViewerError>,
    ) -> Result<T, ViewerError> {
        let settings = self.resolve();
        self.log_scenes();
        self.settings = settings.clone();
        let mut possible = settings;
        let defaults = Settings::default();
        loop {
            let error = match new(possible.clone(), &self.folders) {
                Ok(viewer) => return Ok(viewer),
                Err(error) => error,
            };
            let (setting, default) = match error {
                ViewerError::NoScene(_) => (&mut possible.scene, &defaults.scene),
                ViewerError::Params(_) => (&mut possible.viewer, &defaults.viewer),
                error => return Err(error),
            };
            if setting == default {
                return Err(error);
            }
            log::warn!("{error}; {default} is taken");
            setting.clone_from(default);
        }
    }

    /// The settings from outside; each mistake is told once.
    fn resolve(&mut self) -> Settings {
        let (settings, mistakes) = self.sources.resolve();
        mistakes.iter().filter(|m| !self.mistakes.contains(m)).for_each(|mistake| log::warn!("{mistake}"));
        self.mistakes = mistakes;
        settings
    }

    fn log_scenes(&self) {
        let builtin: Vec<&str> = BUILTINS.iter().map(|scene| scene.name).collect();
        log::info!("built-in scenes: {}", builtin.join(", "));
        let mut files = list_scenes(&self.folders);
        files.dedup();
        files.iter().for_each(|file| log::info!("scene file: {}", file.display()));
    }

    /// Says once, in the log and on the screen, why nothing else can be shown.
    fn fail(&mut self, sentence: String) {
        if self.failure.as_ref() != Some(&sentence) {
            log::error!("{sentence}");
            self.java.toast(&sentence);
        }
        self.failure = Some(sentence);
        if let Some(window) = &self.window {
            // The sentence is in the log and in the toast: a colour that cannot be shown adds nothing.
            let _ = window.show_color(FAILURE_COLOR);
        }
    }

    fn on_window_error(&mut self, error: &WindowError) {
        self.log_error(error.to_string());
        match error {
            WindowError::ContextLost => {
                if let Some(cardboard) = &mut self.cardboard {
                    cardboard.detach();
                }
                self.gl = None;
                self.window = None;
            }
            _ => {
                if let Some(window) = &mut self.window {
                    window.detach();
                }
            }
        }
        self.retry = Some(Instant::now() + RETRY);
    }

    /// Logs an error that may come with every frame once.
    fn log_error(&mut self, sentence: String) {
        if sentence != self.last_error {
            log::error!("{sentence}");
            self.last_error = sentence;
        }
    }

    /// The screen as it is now; none without window.
    fn screen(&mut self) -> Option<Screen> {
        let size = self.window.as_ref()?.size()?;
        if std::mem::take(&mut self.is_display_stale) {
            self.display = self.java.display().or(self.display);
            if let Some(display) = &self.display {
                self.refresh_hz = display.refresh_hz;
            }
        }
        let (dpi, rotation) = match &self.display {
            Some(display) => (display.dpi, rotation(display.rotation)),
            None => ([0.0; 2], Rotation::default()),
        };
        Some(Screen { size, dpi, rotation })
    }

    fn step(&mut self) {
        if self.retry.is_some_and(|time| Instant::now() >= time) {
            self.open_window();
        }
        if std::mem::take(&mut self.has_input) {
            let dpi = self.display.map_or(0.0, |display| display.dpi[0]);
            self.input.collect(&self.app, dpi, &mut self.events);
        }
        if self.headset.is_some() {
            return self.step_headset();
        }
        // A window may have had no size when it came.
        if self.window.as_ref().is_some_and(Window::is_attached) && !self.is_ready() && self.failure.is_none()
        {
            self.attach_viewer();
        }
        let refresh = self.pulse.and_then(Pulse::take_refresh);
        if !self.is_drawing() {
            self.events.clear();
            return;
        }
        self.events.extend(self.input.held(now_ns()));
        let is_paced = self.pulse.is_some_and(Pulse::has_refreshes);
        if refresh.is_none() && is_paced && self.last_frame.elapsed() < PATIENCE {
            return;
        }
        self.last_frame = Instant::now();
        match self.frame(refresh) {
            Ok(()) => {}
            Err(FrameError::Window(error)) => self.on_window_error(&error),
            Err(FrameError::Viewer(error)) => self.log_error(error.to_string()),
        }
    }

    /// One frame, for the refresh that has just begun.
    fn frame(&mut self, refresh_ns: Option<i64>) -> Result<(), FrameError> {
        let Some(screen) = self.screen() else { return Ok(()) };
        let (Some(viewer), Some(window)) = (&mut self.cardboard, &self.window) else { return Ok(()) };
        viewer.resize(screen)?;
        for event in self.events.drain(..) {
            match viewer.event(event) {
                Ok(Action::Nothing) => {}
                Ok(action) => log::info!("{action}"),
                Err(error) => log::error!("{error}"),
            }
        }
        let now = now_ns();
        let hz = if self.refresh_hz > 0.0 { self.refresh_hz } else { USUAL_HZ };
        let ahead = (REFRESHES_AHEAD / f64::from(hz) * 1e9) as i64;
        let timing = FrameTiming {
            now_ns: now,
            expected_display_ns: refresh_ns.unwrap_or(now) + ahead,
            refresh_hz: self.refresh_hz,
        };
        let mut feed = |viewer: &mut Cardboard| {
            if let Some(pulse) = self.pulse {
                pulse.drain(&mut self.samples, |sample, time| viewer.sensor(sample, time));
            }
        };
        feed(viewer);
        viewer.render(&timing)?;
        // The image is turned to where the head is by now.
        feed(viewer);
        let destination = Destination { framebuffer: None, origin: [0, 0], size: screen.size };
        let report = viewer.present(&destination, &FrameTiming { now_ns: now_ns(), ..timing })?;
        window.present()?;
        self.last_error.clear();
        if report.telemetry_due {
            self.every_second();
        }
        if report.session_over {
            self.summarize();
        }
        if report.exit {
            self.finish();
        }
        Ok(())
    }

    fn every_second(&mut self) {
        let report = self.device.as_ref().map(Device::report).unwrap_or_default();
        self.refresh_hz = report.refresh_hz.unwrap_or(self.refresh_hz);
        let viewer = self.immersive.as_mut().or(self.cardboard.as_mut().map(Cardboard::viewer_mut));
        let Some(viewer) = viewer else { return };
        log::info!("{}", viewer.telemetry(viewer.now_ns(), &report.state));
        if let Some(errors) = self.gl.as_ref().and_then(|gl| gl.take_errors()) {
            log::warn!("GL errors in the last second: {errors}");
        }
        if self.sources.set_properties(settings::properties(property)) {
            self.reconfigure();
        }
    }

    /// The system properties have changed while the application runs.
    fn reconfigure(&mut self) {
        let settings = self.resolve();
        if settings == self.settings {
            return;
        }
        if (&settings.scene, settings.seed) != (&self.settings.scene, self.settings.seed) {
            self.summarize();
        }
        let Some(viewer) = self.viewer() else { return };
        // What was not to be found at the start is not looked for again with every change.
        let mut possible = settings.clone();
        if settings.scene == self.settings.scene {
            possible.scene.clone_from(&viewer.settings().scene);
        }
        if settings.viewer == self.settings.viewer {
            possible.viewer.clone_from(&viewer.settings().viewer);
        }
        // Another scene begins another session.
        self.is_summarized = false;
        let configured = match (&mut self.immersive, &mut self.cardboard) {
            (Some(viewer), _) => viewer.configure(possible, &self.folders),
            (None, Some(cardboard)) => cardboard.configure(possible, &self.folders),
            (None, None) => Ok(()),
        };
        match configured {
            Ok(()) => {
                if let Some(viewer) = self.viewer() {
                    log::info!("settings: {}", viewer.settings());
                }
                self.settings = settings;
            }
            Err(error) => log::warn!("{error}; the settings stay as they were"),
        }
    }

    fn summarize(&mut self) {
        if let Some(viewer) = self.viewer()
            && !self.is_summarized
        {
            log::info!("{}", viewer.summary(viewer.now_ns()));
            self.is_summarized = true;
        }
    }

    fn end(&mut self) {
        self.pause();
        self.summarize();
    }
}

/// Why there is a runtime and no headset.
#[derive(Debug)]
enum HeadsetError {
    Window(WindowError),
    Viewer(ViewerError),
    Xr(XrError),
}

impl std::fmt::Display for HeadsetError {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            HeadsetError::Window(error) => error.fmt(f),
            HeadsetError::Viewer(error) => error.fmt(f),
            HeadsetError::Xr(error) => error.fmt(f),
        }
    }
}

impl From<WindowError> for HeadsetError {
    fn from(error: WindowError) -> HeadsetError {
        HeadsetError::Window(error)
    }
}

impl From<ViewerError> for HeadsetError {
    fn from(error: ViewerError) -> HeadsetError {
        HeadsetError::Viewer(error)
    }
}

impl From<XrError> for HeadsetError {
    fn from(error: XrError) -> HeadsetError {
        HeadsetError::Xr(error)
    }
}

/// Why a frame was not shown.
enum FrameError {
    Window(WindowError),
    Viewer(ViewerError),
}

impl From<WindowError> for FrameError {
    fn from(error: WindowError) -> FrameError {
        FrameError::Window(error)
    }
}

impl From<ViewerError> for FrameError {
    fn from(error: ViewerError) -> FrameError {
        FrameError::Viewer(error)
    }
}

/// `Surface.ROTATION_*` says how far the picture is turned against the device's natural position, that of the sensors'
/// axes: upright for phones, on the side for many tablets and for headsets.
fn rotation(surface_rotation: i32) -> Rotation {
    match surface_rotation {
        1 => Rotation::LandscapeLeft,
        3 => Rotation::LandscapeRight,
        _ => Rotation::Portrait,
    }
}

/// The clock of Android's events and refreshes.
fn now_ns() -> i64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the clock exists on every Linux, and the result has a place.
    unsafe { libc::clock_gettime(libc::CLOCK_MONOTONIC, &mut time) };
    time.tv_sec * 1_000_000_000 + time.tv_nsec
}

/// A system property.
fn property(name: &str) -> Option<String> {
    let name = CString::new(name).ok()?;
    let mut value = [0u8; libc::PROP_VALUE_MAX as usize];
    // SAFETY: the name ends in zero, and there is room for the longest value.
    let length = unsafe { libc::__system_property_get(name.as_ptr(), value.as_mut_ptr().cast()) };
    let value = value.get(..usize::try_from(length).ok()?)?;
    Some(String::from_utf8_lossy(value).into_owned())
}
