//! The activity's life cycle and its main loop.
//!
//! On a headset with an OpenXR runtime the application is immersive: the runtime decides when to draw and where the
//! eyes are. On every other device it is a Cardboard-compatible viewer in Android's window. The choice is made once,
//! when the activity first comes to the front.

mod camera;
mod headset;

use std::io::Read as _;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::{Duration, Instant};

use android_activity::{AndroidApp, MainEvent, PollEvent, WindowManagerFlags};
use yoro_context::android::{Window, WindowError};
use yoro_gl::{Context, Destination};
use yoro_lenses::{MotionSample, Screen};
use yoro_settings::telemetry::DeviceState;
use yoro_viewer::{Action, Cardboard, Event, FrameTiming, PresentReport, ViewerError};

use crate::frame_timing::Refresh;
use crate::platform::camera::Scan;
use crate::platform::configuration::Configuration;
use crate::platform::display::Performance;
use crate::platform::display::ScreenState;
use crate::platform::display::{Display, DisplayError};
use crate::platform::input::Input;
use crate::platform::java::Java;
use crate::platform::measure::Device;
use crate::platform::measure::results;
use crate::platform::motion::MotionThread;
use crate::platform::system::now_ns;

/// The longest wait for a refresh. After this, a frame is drawn without one.
const REFRESH_TIMEOUT: Duration = Duration::from_millis(100);
/// Time between attempts to recreate a lost context or a refused window.
const RETRY: Duration = Duration::from_millis(250);
/// The refresh rate in Hz assumed for a display that does not report one.
const USUAL_HZ: f32 = 60.0;
/// Time between polls of a headset's runtime for events while it wants no frames, in front and in the background.
const HEADSET_POLL: Duration = Duration::from_millis(10);
const HEADSET_BACKGROUND_POLL: Duration = Duration::from_millis(100);
/// The colour of the screen on a device that cannot show anything else, display-referred.
const FAILURE_COLOR: [f32; 3] = [0.45, 0.05, 0.05];

/// Runs the application until Android destroys the activity or the session is over.
pub fn run(app: &AndroidApp) {
    app.set_window_flags(
        WindowManagerFlags::KEEP_SCREEN_ON | WindowManagerFlags::FULLSCREEN,
        WindowManagerFlags::empty(),
    );
    let mut activity = Activity::new(app);
    if activity.configuration.is_unknown_scenario {
        activity.finish();
    }
    while !activity.is_over {
        activity.wait();
        activity.step();
    }
    activity.end();
}

/// The state of one run of `android_main`.
struct Activity {
    // Declared first, since objects in the GL context must be dropped before the context.
    display: Display,
    gl: Option<Rc<Context>>,
    window: Option<Window>,

    app: AndroidApp,
    java: Java,
    configuration: Configuration,
    screen: ScreenState,
    motion: Option<&'static MotionThread>,
    device: Option<Device>,
    input: Input,
    performance: Performance,
    /// The camera while it looks for a viewer's code.
    scan: Option<Scan>,
    /// True while the user is being asked for permission to use the camera.
    is_asking: bool,
    /// GPU time of a frame a few frames ago, if it is measured.
    gpu_time: Duration,
    /// A buffer for the samples of a frame.
    samples: Vec<(MotionSample, i64)>,

    /// True once the display has been chosen.
    is_display_chosen: bool,
    is_resumed: bool,
    /// True while the screen's brightness is raised.
    is_bright: bool,
    is_finishing: bool,
    is_over: bool,
    /// The name of the scene that is shown, and whether the summary of its session has been logged.
    scene: String,
    is_summarized: bool,
    /// The reason why this device cannot show anything.
    failure: Option<String>,
    retry: Option<Instant>,
    last_frame: Instant,
    last_error: String,
}

impl Activity {
    fn new(app: &AndroidApp) -> Activity {
        let java = Java::new(app);
        Activity {
            display: Display::None,
            gl: None,
            window: None,
            app: app.clone(),
            configuration: Configuration::new(app, &java),
            java,
            screen: ScreenState::new(),
            motion: MotionThread::get(),
            device: None,
            input: Input::default(),
            performance: Performance::new(),
            scan: None,
            is_asking: false,
            gpu_time: Duration::ZERO,
            samples: Vec::new(),
            is_display_chosen: false,
            is_resumed: false,
            is_bright: false,
            is_finishing: false,
            is_over: false,
            scene: String::new(),
            is_summarized: false,
            failure: None,
            retry: None,
            last_frame: Instant::now(),
            last_error: String::new(),
        }
    }

    fn is_ready(&self) -> bool {
        self.display.cardboard().is_some_and(Cardboard::is_attached)
    }

    fn is_drawing(&self) -> bool {
        let has_window = self.window.as_ref().is_some_and(Window::is_attached);
        self.is_resumed && has_window && self.is_ready() && self.failure.is_none()
    }

    /// Sleeps until there is something to do, and handles Android's events.
    fn wait(&mut self) {
        let mut timeout = if let Display::Headset(headset) = &self.display {
            Some(match (headset.is_running(), self.is_resumed) {
                // The runtime sets the pace.
                (true, _) => Duration::ZERO,
                (false, true) => HEADSET_POLL,
                (false, false) => HEADSET_BACKGROUND_POLL,
            })
        } else if self.retry.is_some() {
            Some(REFRESH_TIMEOUT)
        } else if !self.is_drawing() {
            None
        } else if self.motion.is_some_and(MotionThread::has_refreshes) {
            Some(REFRESH_TIMEOUT)
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
            | MainEvent::ConfigChanged { .. } => self.screen.is_stale = true,
            MainEvent::RedrawNeeded { .. } => {
                if let Some(failure) = self.failure.clone() {
                    self.fail(failure);
                }
            }
            MainEvent::GainedFocus => self.java.hide_system_bars(),
            MainEvent::Resume { loader, .. } => {
                if self.display.viewer().is_none()
                    && let Some(saved) = loader.load()
                {
                    self.configuration.restore(&saved);
                }
                self.choose_display();
                self.resume();
            }
            MainEvent::Pause => self.pause(),
            MainEvent::Stop => self.leave(),
            MainEvent::SaveState { saver, .. } => {
                saver.store(&self.configuration.save(self.display.viewer()));
            }
            MainEvent::LowMemory => self.free_memory(),
            MainEvent::InputAvailable => self.input.is_available = true,
            MainEvent::Destroy => self.is_over = true,
            _ => {}
        }
    }

    fn resume(&mut self) {
        self.is_resumed = true;
        self.screen.is_stale = true;
        self.last_frame = Instant::now();
        self.device = Some(Device::watch(&self.java));
        if !self.display.is_headset()
            && let Some(motion) = self.motion
        {
            motion.resume(self.app.create_waker());
        }
        if let Some(cardboard) = self.display.cardboard_mut() {
            cardboard.resume();
        }
        self.java.hide_system_bars();
        if std::mem::take(&mut self.is_asking) {
            self.begin_scan();
        }
    }

    fn pause(&mut self) {
        self.is_resumed = false;
        self.device = None;
        // Android takes the camera from applications that are not in the foreground.
        if self.scan.take().is_some() {
            self.say("The camera was given back: touch the tile again.");
        }
        self.input.cancel();
        if let Some(motion) = self.motion {
            motion.pause();
        }
        if let Some(cardboard) = self.display.cardboard_mut() {
            cardboard.pause();
        }
    }

    /// Ends an activity that was started by hand when the user leaves it, since only a new activity receives what other
    /// applications share. A device that goes to sleep does not count as left.
    fn leave(&mut self) {
        let is_left = !self.is_asking && self.java.is_awake();
        if self.configuration.is_by_hand() && !self.display.is_headset() && is_left {
            self.configuration.leave(self.display.viewer());
            self.finish();
        }
    }

    /// Shows a sentence on the start screen.
    fn say(&mut self, sentence: &str) {
        log::info!("{sentence}");
        if let Some(cardboard) = self.display.cardboard_mut() {
            cardboard.viewer_mut().show_start_screen(sentence);
        }
    }

    /// Drops everything on the GPU while the activity is in the background. It is created again with the next window.
    fn free_memory(&mut self) {
        if self.display.is_headset() || self.window.as_ref().is_some_and(Window::is_attached) {
            log::warn!("Android is short of memory: a smaller render-scale or scene needs less");
        } else if let Some(cardboard) = self.display.cardboard_mut() {
            log::info!("Android is short of memory: what is on the GPU is dropped");
            cardboard.detach();
        }
    }

    /// Finishes a frame, on any display.
    fn after_frame(&mut self, report: &PresentReport) {
        self.configuration.take_shared(&mut self.display);
        if let Some(viewer) = self.display.viewer_mut()
            && self.configuration.keep(viewer)
        {
            let settings = self.configuration.resolve();
            self.configuration.apply(settings, &mut self.display);
        }
        self.note_scene();
        if report.telemetry_due {
            self.every_second();
        }
        if report.session_over {
            self.summarize();
            if let Some(settings) = self.configuration.next_step() {
                self.is_summarized = false;
                self.configuration.apply(settings, &mut self.display);
                return;
            }
            match &mut self.display {
                Display::Headset(headset) => headset.request_exit(),
                Display::Cardboard(_) | Display::None => self.finish(),
            }
        }
    }

    /// Starts a new session, whose summary is not logged yet, if the scene has changed.
    fn note_scene(&mut self) {
        if let Some(viewer) = self.display.viewer()
            && viewer.scene_name() != self.scene
        {
            viewer.scene_name().clone_into(&mut self.scene);
            self.is_summarized = false;
        }
    }

    /// Asks Android to end the activity.
    fn finish(&mut self) {
        // This does not leave the loop: only a running loop returns the window and the input queue to Android.
        if !std::mem::replace(&mut self.is_finishing, true) {
            self.java.finish();
        }
    }

    /// Attaches to Android's window and creates the objects for drawing on it, if there is a window and the context is
    /// not in use by a headset.
    fn open_window(&mut self) {
        self.retry = None;
        if self.display.is_headset() || self.is_finishing {
            return;
        }
        let Some(native) = self.app.native_window() else { return };
        let window = match self.window.take().map_or_else(Window::open, Ok) {
            Ok(window) => self.window.insert(window),
            Err(error) => return self.fail(error.to_string()),
        };
        match window.attach(native) {
            Ok(()) => {
                self.screen.is_stale = true;
                self.performance.forget_window();
            }
            Err(error) => return self.on_window_error(&error),
        }
        if let Some(failure) = self.failure.clone() {
            return self.fail(failure);
        }
        match context(&mut self.gl, window) {
            Ok(_) => self.attach_viewer(),
            Err(error) => self.fail(error.to_string()),
        }
    }

    fn attach_viewer(&mut self) {
        let Some(screen) = self.screen() else { return };
        let Some(gl) = self.gl.clone() else { return };
        if let Display::None = self.display {
            let new = |settings, folders: &[PathBuf]| Cardboard::new(settings, screen, folders);
            match self.configuration.make_viewer(new) {
                Ok(mut cardboard) => {
                    self.configuration.begin(&mut cardboard);
                    self.display = Display::Cardboard(Box::new(cardboard));
                }
                Err(error) => return self.fail(error.to_string()),
            }
        }
        let Some(cardboard) = self.display.cardboard_mut() else { return };
        if !cardboard.is_attached() {
            self.configuration.check_pictures(&gl);
            if let Err(error) = cardboard.attach(gl) {
                return self.fail(error.to_string());
            }
        }
        self.ask_performance();
    }

    /// Requests the settings' refresh rate and performance. On a headset this is up to its runtime instead.
    fn ask_performance(&mut self) {
        if let Display::Cardboard(cardboard) = &self.display
            && let Some(window) = self.app.native_window()
        {
            let settings = cardboard.viewer().settings();
            self.performance.ask(settings, &window, self.screen.refresh_hz, &self.java);
        }
    }

    /// Reports once, in the log and on the screen, why nothing can be shown.
    fn fail(&mut self, sentence: String) {
        if self.failure.as_ref() != Some(&sentence) {
            log::error!("{sentence}");
            self.java.toast(&sentence);
        }
        self.failure = Some(sentence);
        if let Some(window) = &self.window {
            // An error is ignored: the sentence is in the log and in the toast.
            let _ = window.show_color(FAILURE_COLOR);
        }
    }

    fn on_window_error(&mut self, error: &WindowError) {
        self.log_error(error.to_string());
        match error {
            WindowError::ContextLost => {
                if let Some(cardboard) = self.display.cardboard_mut() {
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

    /// Logs an error only once if it repeats in every frame.
    fn log_error(&mut self, sentence: String) {
        if sentence != self.last_error {
            log::error!("{sentence}");
            self.last_error = sentence;
        }
    }

    /// Returns the present screen; `None` without a window.
    fn screen(&mut self) -> Option<Screen> {
        let size = self.window.as_ref()?.size()?;
        Some(self.screen.of_window(size, &self.java))
    }

    fn step(&mut self) {
        if self.retry.is_some_and(|time| Instant::now() >= time) {
            self.open_window();
        }
        self.input.collect(&self.app, self.screen.dpi());
        if self.display.is_headset() {
            return self.step_headset();
        }
        // The window may have had no size when it was created.
        if self.window.as_ref().is_some_and(Window::is_attached) && !self.is_ready() && self.failure.is_none()
        {
            self.attach_viewer();
        }
        let refresh = self.motion.and_then(MotionThread::take_refresh);
        if !self.is_drawing() {
            self.input.events.clear();
            return;
        }
        self.input.hold(now_ns());
        let is_paced = self.motion.is_some_and(MotionThread::has_refreshes);
        if refresh.is_none() && is_paced && self.last_frame.elapsed() < REFRESH_TIMEOUT {
            return;
        }
        self.last_frame = Instant::now();
        match self.frame(refresh) {
            Ok(()) => {}
            Err(DisplayError::Window(error)) => self.on_window_error(&error),
            Err(error) => self.log_error(error.to_string()),
        }
    }

    /// Performs the user's actions.
    fn take_events(&mut self, screen: Screen) -> Result<(), ViewerError> {
        let Display::Cardboard(cardboard) = &mut self.display else { return Ok(()) };
        cardboard.resize(screen)?;
        let mut wants_scan = false;
        for event in self.input.events.drain(..) {
            let was_start_screen = cardboard.viewer().is_start_screen();
            let done = match event {
                Event::Tap => match cardboard.touch(self.input.touched) {
                    Ok(None) => cardboard.event(event),
                    done => done.map(Option::unwrap_or_default),
                },
                _ if was_start_screen => continue,
                _ => cardboard.event(event),
            };
            if was_start_screen {
                // After any touch the camera is no longer wanted, or it is started again.
                self.scan = None;
            }
            match done {
                Ok(Action::Nothing) => {}
                Ok(action) => {
                    log::info!("{action}");
                    match action {
                        Action::ShareLog => self.java.share("The log of yoro", results::recent()),
                        Action::ShareNotices => {
                            self.java.share("Code of others in yoro", notices(&self.app));
                        }
                        Action::Scan(is_on) => wants_scan = is_on,
                        _ => {}
                    }
                }
                Err(error) => log::error!("{error}"),
            }
        }
        let is_bright = cardboard.viewer().offers_start_screen() && !cardboard.viewer().is_start_screen();
        if is_bright != std::mem::replace(&mut self.is_bright, is_bright) {
            self.java.raise_brightness(is_bright);
        }
        if wants_scan {
            self.ask_for_scan();
        }
        Ok(())
    }

    /// Draws a frame for the refresh that has just begun.
    fn frame(&mut self, refresh: Option<Refresh>) -> Result<(), DisplayError> {
        let Some(screen) = self.screen() else { return Ok(()) };
        self.take_events(screen)?;
        self.follow_scan();
        let (Display::Cardboard(cardboard), Some(window)) = (&mut self.display, &self.window) else {
            return Ok(());
        };
        let begin = now_ns();
        let refresh_hz = self.screen.refresh_hz;
        let period_ns = (1e9 / f64::from(if refresh_hz > 0.0 { refresh_hz } else { USUAL_HZ })) as i64;
        let refresh = refresh.unwrap_or(Refresh { begin_ns: begin, timeline: None });
        let gpu_ns = self.gpu_time.as_nanos() as i64;
        let timing = |now_ns: i64| FrameTiming {
            now_ns,
            expected_display_ns: refresh.display_ns(now_ns + gpu_ns, period_ns),
            refresh_hz,
        };
        let mut feed = |cardboard: &mut Cardboard| {
            if let Some(motion) = self.motion {
                motion.drain(&mut self.samples, |sample, time| cardboard.sensor(sample, time));
            }
        };
        feed(cardboard);
        cardboard.render(&timing(begin))?;
        let rendered = now_ns();
        cardboard.wait();
        let waited = now_ns();
        // Adds the newest samples, for timewarp.
        feed(cardboard);
        let destination = Destination { framebuffer: None, origin: [0, 0], size: screen.size };
        let report = cardboard.present(&destination, &timing(waited))?;
        let worked = (rendered - begin) + (now_ns() - waited);
        self.performance.worked(Duration::from_nanos(worked.max(0).cast_unsigned()));
        self.gpu_time = report.gpu_ms.map_or(self.gpu_time, |ms| Duration::from_secs_f32(ms.max(0.0) * 1e-3));
        window.present()?;
        self.last_error.clear();
        self.after_frame(&report);
        Ok(())
    }

    fn every_second(&mut self) {
        let report = self.device.as_ref().map(Device::report).unwrap_or_default();
        self.screen.refresh_hz = report.refresh_hz.unwrap_or(self.screen.refresh_hz);
        let performance = (!self.display.is_headset()).then(|| self.performance.name());
        let Some(viewer) = self.display.viewer_mut() else { return };
        let state = DeviceState { performance, ..report.state };
        log::info!("{}", viewer.telemetry(viewer.now_ns(), &state));
        if let Some(errors) = self.gl.as_ref().and_then(|gl| gl.take_errors()) {
            log::warn!("GL errors in the last second: {errors}");
        }
        let Some(settings) = self.configuration.poll_properties() else { return };
        if self.configuration.is_other_scene(&settings) {
            self.summarize();
        }
        // The new settings may start the session again.
        self.is_summarized = false;
        self.configuration.apply(settings, &mut self.display);
        self.ask_performance();
    }

    fn summarize(&mut self) {
        if let Some(viewer) = self.display.viewer()
            && !self.is_summarized
        {
            log::info!("{}", viewer.summary(viewer.now_ns()));
            self.is_summarized = true;
        }
    }

    fn end(&mut self) {
        self.pause();
        self.summarize();
        results::end();
    }
}

/// Returns the notices of others' code, which the APK has among its assets.
fn notices(app: &AndroidApp) -> String {
    let mut text = String::new();
    let asset = app.asset_manager().open(c"NOTICES.txt");
    match asset.map(|mut asset| asset.read_to_string(&mut text)) {
        Some(Ok(_)) => log::info!("{} lines of notices", text.lines().count()),
        Some(Err(_)) | None => "This APK was packed without its NOTICES.txt.".clone_into(&mut text),
    }
    text
}

/// Returns a window's context, which is created by the first call.
fn context<'a>(gl: &'a mut Option<Rc<Context>>, window: &Window) -> Result<&'a Rc<Context>, ViewerError> {
    match gl {
        Some(gl) => Ok(gl),
        none => {
            let new = window.gl()?;
            log::info!("driver: {}", new.capabilities().summary());
            Ok(none.insert(new))
        }
    }
}
