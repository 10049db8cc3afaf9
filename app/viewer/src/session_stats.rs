//! Statistics and questions of a session.

use glam::Quat;

use crate::questionnaire::Questionnaire;
use yoro_gl::PassTime;
use yoro_protocol::Settings;
use yoro_protocol::telemetry::{DeviceState, Line, Rating, SessionSummary, Telemetry, ViewerState};
use yoro_render::stereo::GuardBandUse;

/// Counts frames and asks questions from the time that a scene comes into view to the end of the session.
#[derive(Default)]
pub(crate) struct SessionStats {
    telemetry: Telemetry,
    last_line: Option<Line>,
    celsius: Option<f32>,
    /// The time at which the scene came into view.
    begin_ns: Option<i64>,
    /// The questions after the session; `None` before its end.
    questionnaire: Option<Questionnaire>,
    ratings: Vec<Rating>,
    is_over: bool,
}

impl SessionStats {
    /// Begins a session when a scene comes into view, and returns true. A scene that is only back after a lost context
    /// goes on with its session.
    pub fn begin(&mut self, now_ns: i64) -> bool {
        let is_new = self.begin_ns.is_none();
        if is_new {
            self.telemetry = Telemetry::default();
            self.begin_ns = Some(now_ns);
        }
        is_new
    }

    /// Makes the next scene begin a new session.
    pub fn expect_scene(&mut self) {
        self.begin_ns = None;
        self.reopen();
    }

    /// Takes back the end of the session, and its questions.
    pub fn reopen(&mut self) {
        self.questionnaire = None;
        self.is_over = false;
    }

    /// Stops counting: the time until the next frame is left out.
    pub fn pause(&mut self) {
        self.telemetry.pause();
    }

    /// Counts a frame, with the GPU times of `timed` earlier ones. Returns how many refreshes it was late.
    pub fn frame(&mut self, now_ns: i64, refresh_hz: f32, passes: &[PassTime], timed: u32) -> u32 {
        self.telemetry.gpu(passes.iter().map(|pass| (pass.name, pass.time)), timed);
        self.telemetry.frame(now_ns, refresh_hz)
    }

    /// Adds the use of the guard band in a frame.
    pub fn guard_band(&mut self, used: GuardBandUse) {
        self.telemetry.guard_band(used.columns, used.undrawn);
    }

    /// True if a second has passed since the last line.
    pub fn is_line_due(&self, now_ns: i64) -> bool {
        self.telemetry.is_due(now_ns)
    }

    /// Ends a second, and returns its line.
    pub fn line(&mut self, now_ns: i64, viewer: &ViewerState, device: &DeviceState) -> Line {
        self.celsius = device.skin_celsius.or(device.battery_celsius);
        let line = self.telemetry.line(now_ns, viewer, device);
        self.last_line = Some(line.clone());
        line
    }

    /// The line of the last second.
    pub fn last_line(&self) -> Option<&Line> {
        self.last_line.as_ref()
    }

    /// The device's temperature in degrees Celsius.
    pub fn celsius(&self) -> Option<f32> {
        self.celsius
    }

    pub fn summary(&self, now_ns: i64) -> SessionSummary {
        self.telemetry.summary(now_ns)
    }

    /// True if the session's time is up.
    pub fn is_time_up(&self, settings: &Settings, now_ns: i64) -> bool {
        let shown_ns = self.begin_ns.map_or(0, |begin| now_ns - begin);
        settings.duration.is_some_and(|s| shown_ns as f64 >= s as f64 * 1e9)
    }

    /// Asks the questions of the settings, if they are not being asked already.
    pub fn ask(&mut self, settings: &Settings) {
        let Settings { questions, best_rating, .. } = settings;
        self.questionnaire.get_or_insert_with(|| Questionnaire::new(questions, *best_rating));
    }

    /// The question in view.
    pub fn question(&self) -> Option<&Questionnaire> {
        self.questionnaire.as_ref().filter(|questions| !questions.is_done())
    }

    /// The question in view, to be answered.
    pub fn question_mut(&mut self) -> Option<&mut Questionnaire> {
        self.questionnaire.as_mut().filter(|questions| !questions.is_done())
    }

    /// Takes the head's orientation, which moves the slider.
    pub fn look(&mut self, orientation: Quat, now_ns: i64) {
        if let Some(questions) = &mut self.questionnaire {
            questions.look(orientation, now_ns);
        }
    }

    /// Keeps an answer.
    pub fn keep(&mut self, rating: Rating) {
        self.ratings.push(rating);
    }

    pub fn ratings(&self) -> &[Rating] {
        &self.ratings
    }

    /// True if the session is over.
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Ends the session.
    pub fn end(&mut self) {
        self.is_over = true;
    }
}
