//! A headset: replaces sessions that are lost.

use std::rc::Rc;
use std::time::{Duration, Instant};

use openxr as xr;

use super::description::{Description, Frame, Options};
use super::error::XrError;
use super::graphics::make_current;
use super::runtime::Runtime;
use super::session::{Progress, Session};
use crate::cardboard::FULL_RATE;
use crate::event::Event;
use crate::viewer::Viewer;
use yoro::eyes::FoveationLevel;
use yoro_context::Graphics;
use yoro_gl::Context;
use yoro_settings::FrameRate;

/// The pause before the first new session. It doubles with each session that fails.
const PAUSE: Duration = Duration::from_millis(500);
/// Number of consecutive sessions that may fail; the next failure gives up the headset.
const MAX_FAILURES: u32 = 3;
/// A session that has shown this many frames counts as successful.
const GOOD_FRAMES: u32 = 200;
/// How long to wait for a runtime that was asked to end a session and does not.
const EXIT_TIMEOUT: Duration = Duration::from_secs(3);
/// Number of session states that are kept.
const MAX_STATES: usize = 64;

/// The result of [`Headset::step`].
#[derive(Debug)]
pub enum Step {
    /// The runtime wants no frame now; call again in a few milliseconds.
    Idle,
    /// A frame was handed to the runtime.
    Frame(Frame),
    /// The session is over for good: ended by the user, the system, or [`Headset::request_exit`].
    Ended,
}

/// A [`Viewer`] on a head-mounted display.
pub struct Headset {
    // Dropped first: objects that use the runtime's images must go before those images.
    session: Option<Session>,
    viewer: Viewer,
    runtime: Runtime,
    options: Options,
    gl: Rc<Context>,
    description: Description,
    states: Vec<String>,
    restarts: u32,
    /// Number of consecutive sessions that have failed.
    failures: u32,
    /// Number of frames in this session.
    frames: u32,
    retry: Option<Instant>,
    exit: Option<Instant>,
    /// True if the runtime cannot end the session.
    is_refused: bool,
    is_over: bool,
    capture: bool,
}

impl Headset {
    /// Starts the first session. The GL context of `graphics` must be current, `gl` must be created from it, and the
    /// viewer must be attached to it.
    ///
    /// # Errors
    /// [`XrError`]: one sentence that says what the runtime lacks, and the remedy.
    pub fn open(
        runtime: Runtime,
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        mut viewer: Viewer,
        options: Options,
    ) -> Result<Headset, XrError> {
        let defaulted = viewer.set_default_foveation(FoveationLevel::Medium);
        defaulted.map_err(|error| XrError::Context(error.to_string()))?;
        let open = || Session::open(&runtime, graphics, gl, viewer.settings(), &options);
        // A runtime that is just being started or replaced may lose the first session.
        let session = open().or_else(|error| {
            if !error.is_loss() {
                return Err(error);
            }
            log::warn!("{error} (after a pause of {:.1} s)", PAUSE.as_secs_f32());
            std::thread::sleep(PAUSE);
            make_current(graphics)?;
            open()
        })?;
        let mut headset = Headset {
            description: session.description.clone(),
            session: Some(session),
            viewer,
            runtime,
            options,
            gl: gl.clone(),
            states: Vec::new(),
            restarts: 0,
            failures: 0,
            frames: 0,
            retry: None,
            exit: None,
            is_refused: false,
            is_over: false,
            capture: false,
        };
        headset.share_frames()?;
        Ok(headset)
    }

    /// Tells the viewer what the runtime does.
    fn share_frames(&mut self) -> Result<(), XrError> {
        let makes_frames = self.session.as_ref().is_some_and(Session::makes_frames);
        let wants_half = self.viewer.settings().frame_rate == FrameRate::Half;
        if self.session.is_some() && !makes_frames && wants_half {
            log::warn!("{FULL_RATE}");
        }
        let shared = self.viewer.set_runtime_features(makes_frames);
        shared.map_err(|error| XrError::Context(error.to_string()))
    }

    /// Makes a frame as soon as the runtime wants one; the runtime sets the pace. A session that is lost or fails is
    /// replaced after a pause, and one sentence is logged each time.
    ///
    /// # Errors
    /// [`XrError`] if several consecutive sessions have failed.
    pub fn step(&mut self, graphics: &dyn Graphics) -> Result<Step, XrError> {
        let step = self.advance(graphics);
        self.is_over |= matches!(step, Ok(Step::Ended));
        step
    }

    fn advance(&mut self, graphics: &dyn Graphics) -> Result<Step, XrError> {
        if self.is_over {
            return Ok(Step::Ended);
        }
        let is_late = self.exit.is_some_and(|since| since.elapsed() > EXIT_TIMEOUT);
        if is_late || self.is_refused {
            if is_late {
                log::warn!(
                    "the OpenXR runtime does not end the session, although it was asked to: it is left"
                );
            }
            self.close(graphics)?;
            return Ok(Step::Ended);
        }
        let Some(session) = &mut self.session else { return self.reopen(graphics) };
        let states = &mut self.states;
        let mut note = |state: xr::SessionState| {
            if states.len() < MAX_STATES {
                states.push(format!("{state:?}"));
            }
        };
        match session.step(graphics, &mut self.viewer, &mut note, self.capture) {
            Ok(Progress::Idle) => Ok(Step::Idle),
            Ok(Progress::Frame(frame)) => {
                self.capture &= frame.capture.is_none();
                self.frames += 1;
                if self.frames == GOOD_FRAMES {
                    self.failures = 0;
                }
                Ok(Step::Frame(frame))
            }
            Ok(Progress::Ended) => {
                self.close(graphics)?;
                Ok(Step::Ended)
            }
            Err(error) => self.fail(error, graphics),
        }
    }

    /// Gives up the session, and after several consecutive failures the headset.
    fn fail(&mut self, error: XrError, graphics: &dyn Graphics) -> Result<Step, XrError> {
        self.close(graphics)?;
        self.viewer.pause();
        if self.exit.is_some() {
            log::info!("the session is over anyway: {error}");
            return Ok(Step::Ended);
        }
        self.failures += 1;
        if self.failures > MAX_FAILURES {
            let count = self.failures;
            let what = format!("{count} OpenXR sessions in a row have failed; the last one: {error}");
            return Err(XrError::Unusable(what));
        }
        let pause = PAUSE * 2u32.pow(self.failures - 1);
        log::warn!("{error} (after a pause of {:.1} s)", pause.as_secs_f32());
        self.retry = Some(Instant::now() + pause);
        Ok(Step::Idle)
    }

    /// Drops the session, which owns framebuffers.
    fn close(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        let before = make_current(graphics);
        self.session = None;
        before?;
        make_current(graphics)
    }

    /// Starts a new session once the pause is over.
    fn reopen(&mut self, graphics: &dyn Graphics) -> Result<Step, XrError> {
        if self.exit.is_some() {
            return Ok(Step::Ended);
        }
        if self.retry.is_some_and(|time| Instant::now() < time) {
            return Ok(Step::Idle);
        }
        match Session::open(&self.runtime, graphics, &self.gl, self.viewer.settings(), &self.options) {
            Ok(session) => {
                self.description = session.description.clone();
                self.session = Some(session);
                self.frames = 0;
                self.restarts += 1;
                self.share_frames()?;
                Ok(Step::Idle)
            }
            Err(error) => self.fail(error, graphics),
        }
    }

    /// Asks the runtime to end the session; [`Step::Ended`] follows.
    pub fn request_exit(&mut self) {
        if self.exit.is_some() {
            return;
        }
        self.exit = Some(Instant::now());
        // A session that is not running has nothing to end.
        if let Some(session) = &self.session
            && session.is_running
        {
            match session.request_exit() {
                Ok(()) => return,
                Err(error) => log::warn!("{error}"),
            }
        }
        self.is_refused = true;
    }

    /// True if the session is being ended.
    pub fn is_exiting(&self) -> bool {
        self.exit.is_some()
    }

    /// Queues an action of the user for the next frame.
    pub fn event(&mut self, event: Event) {
        if let Some(session) = &mut self.session {
            session.events.push(event);
        }
    }

    /// Keeps the images of the next frame that has any, see [`Frame::capture`].
    pub fn capture(&mut self) {
        self.capture = true;
    }

    /// True if the runtime wants frames; then [`Headset::step`] waits for the display.
    pub fn is_running(&self) -> bool {
        self.session.as_ref().is_some_and(|session| session.is_running)
    }

    /// Returns the application.
    pub fn viewer(&self) -> &Viewer {
        &self.viewer
    }

    /// Returns the application, for what does not depend on the display: telemetry, scenes, settings.
    pub fn viewer_mut(&mut self) -> &mut Viewer {
        &mut self.viewer
    }

    /// Returns a description of runtime, system and session.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Returns the first states that the sessions went through.
    pub fn states(&self) -> &[String] {
        &self.states
    }

    /// Returns the number of sessions after the first.
    pub fn restarts(&self) -> u32 {
        self.restarts
    }
}
