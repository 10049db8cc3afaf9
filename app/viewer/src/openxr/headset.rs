//! A headset: one session after the other.

use std::rc::Rc;
use std::time::{Duration, Instant};

use openxr as xr;

use super::description::{Description, Frame, Options};
use super::error::XrError;
use super::graphics::make_current;
use super::runtime::Runtime;
use super::session::{Progress, Session};
use crate::event::Event;
use crate::viewer::Viewer;
use yoro_context::Graphics;
use yoro_gl::Context;

/// The pause before the first new session; it doubles with each that fails.
const PAUSE: Duration = Duration::from_millis(500);
/// Sessions in a row that fail before the headset is given up.
const MOST_FAILURES: u32 = 3;
/// A session that has shown so many frames was a good one.
const GOOD_FRAMES: u32 = 200;
/// A runtime that was asked to end a session and does not is left alone after this.
const EXIT_TIMEOUT: Duration = Duration::from_secs(3);
/// States that are remembered.
const MOST_STATES: usize = 64;

/// The result of a call of [`Headset::step`].
#[derive(Debug)]
pub enum Step {
    /// The runtime wants no frame now; ask again in some milliseconds.
    Idle,
    /// A frame.
    Frame(Frame),
    /// The session is over for good: the user, the system, or [`Headset::request_exit`] has ended it.
    Ended,
}

/// A [`Viewer`] on a display that is worn.
pub struct Headset {
    // What lives in the runtime's images goes before what is drawn there.
    session: Option<Session>,
    viewer: Viewer,
    runtime: Runtime,
    options: Options,
    gl: Rc<Context>,
    description: Description,
    states: Vec<String>,
    restarts: u32,
    /// Sessions in a row that have failed.
    failures: u32,
    /// Frames of this session.
    frames: u32,
    retry: Option<Instant>,
    exit: Option<Instant>,
    /// The runtime cannot end the session.
    is_refused: bool,
    is_over: bool,
    capture: bool,
}

impl Headset {
    /// Begins the first session. The GL context of `graphics` is current, `gl` is made from it, and the viewer is
    /// attached to it.
    ///
    /// # Errors
    /// [`XrError`]: one sentence that says what the runtime lacks, and the remedy.
    pub fn open(
        runtime: Runtime,
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        viewer: Viewer,
        options: Options,
    ) -> Result<Headset, XrError> {
        let open = || Session::open(&runtime, graphics, gl, viewer.settings(), &options);
        // A runtime that is just being started or replaced loses what was begun.
        let session = open().or_else(|error| {
            if !error.is_loss() {
                return Err(error);
            }
            log::warn!("{error} (after a pause of {:.1} s)", PAUSE.as_secs_f32());
            std::thread::sleep(PAUSE);
            make_current(graphics)?;
            open()
        })?;
        Ok(Headset {
            description: session.description().clone(),
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
        })
    }

    /// Makes a frame, as soon as the runtime wants one: it sets the pace. A session that is lost, or fails, is replaced
    /// after a pause; each time one sentence is logged.
    ///
    /// # Errors
    /// [`XrError`] when several sessions in a row have failed.
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
            if states.len() < MOST_STATES {
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

    /// Gives the session up, and the headset if that happens too often.
    fn fail(&mut self, error: XrError, graphics: &dyn Graphics) -> Result<Step, XrError> {
        self.close(graphics)?;
        self.viewer.pause();
        if self.exit.is_some() {
            log::info!("the session is over anyway: {error}");
            return Ok(Step::Ended);
        }
        self.failures += 1;
        if self.failures > MOST_FAILURES {
            return Err(XrError::GivenUp { sessions: self.failures, last: Box::new(error) });
        }
        let pause = PAUSE * 2u32.pow(self.failures - 1);
        log::warn!("{error} (after a pause of {:.1} s)", pause.as_secs_f32());
        self.retry = Some(Instant::now() + pause);
        Ok(Step::Idle)
    }

    /// Drops the session, which has framebuffers.
    fn close(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        let before = make_current(graphics);
        self.session = None;
        before?;
        make_current(graphics)
    }

    /// Begins a new session, when it is time.
    fn reopen(&mut self, graphics: &dyn Graphics) -> Result<Step, XrError> {
        if self.exit.is_some() {
            return Ok(Step::Ended);
        }
        if self.retry.is_some_and(|time| Instant::now() < time) {
            return Ok(Step::Idle);
        }
        match Session::open(&self.runtime, graphics, &self.gl, self.viewer.settings(), &self.options) {
            Ok(session) => {
                self.description = session.description().clone();
                self.session = Some(session);
                self.frames = 0;
                self.restarts += 1;
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
        // A session that has not begun has nothing to end.
        if let Some(session) = &self.session
            && session.is_running()
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

    /// Does what the user wants in the next frame.
    pub fn event(&mut self, event: Event) {
        if let Some(session) = &mut self.session {
            session.event(event);
        }
    }

    /// Keeps the images of the next frame that has any: [`Frame::capture`].
    pub fn capture(&mut self) {
        self.capture = true;
    }

    /// True if the runtime wants frames: then [`Headset::step`] waits for the display.
    pub fn is_running(&self) -> bool {
        self.session.as_ref().is_some_and(Session::is_running)
    }

    /// The application that is worn.
    pub fn viewer(&self) -> &Viewer {
        &self.viewer
    }

    /// The application that is worn, for what is not the display's own: telemetry, scenes, settings.
    pub fn viewer_mut(&mut self) -> &mut Viewer {
        &mut self.viewer
    }

    /// Returns a description of runtime, system and session.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The states that the sessions went through, the first ones.
    pub fn states(&self) -> &[String] {
        &self.states
    }

    /// Returns the number of sessions after the first.
    pub fn restarts(&self) -> u32 {
        self.restarts
    }
}
