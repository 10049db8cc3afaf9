//! Statistics and questions of a session.

use glam::Quat;

use crate::questionnaire::Questionnaire;
use yoro_gl::PassTime;
use yoro_settings::Settings;
use yoro_settings::telemetry::{DeviceState, Line, Rating, Telemetry};

/// Counts frames and asks questions, from the time at which a scene is first shown to the end of the session.
#[derive(Default)]
pub(crate) struct SessionStats {
    pub telemetry: Telemetry,
    /// The line of the last second.
    pub last_line: Option<Line>,
    /// The device's temperature in degrees Celsius.
    pub celsius: Option<f32>,
    /// The time at which the scene was first shown.
    begin_ns: Option<i64>,
    /// The questions at the end of the session; `None` before its end.
    questionnaire: Option<Questionnaire>,
    pub ratings: Vec<Rating>,
    pub is_over: bool,
}

impl SessionStats {
    /// Starts a session when a scene is first shown, and returns true. A scene that is shown again after a lost context
    /// continues its session.
    pub fn begin(&mut self, now_ns: i64) -> bool {
        let is_new = self.begin_ns.is_none();
        if is_new {
            self.telemetry = Telemetry::default();
            self.begin_ns = Some(now_ns);
        }
        is_new
    }

    /// Makes the next scene start a new session.
    pub fn expect_scene(&mut self) {
        self.begin_ns = None;
        self.reopen();
    }

    /// Reverts the end of the session and discards its questions.
    pub fn reopen(&mut self) {
        self.questionnaire = None;
        self.is_over = false;
    }

    /// Counts a frame, with the GPU times of `timed` earlier ones. Returns by how many refreshes it was late.
    pub fn frame(&mut self, now_ns: i64, refresh_hz: f32, passes: &[PassTime], timed: u32) -> u32 {
        self.telemetry.gpu(passes.iter().map(|pass| (pass.name, pass.time)), timed);
        self.telemetry.frame(now_ns, refresh_hz)
    }

    /// Ends a second and returns its line.
    pub fn line(&mut self, now_ns: i64, viewer: Line, device: &DeviceState) -> Line {
        self.celsius = device.skin_celsius.or(device.battery_celsius);
        let line = self.telemetry.line(now_ns, viewer, device);
        self.last_line = Some(line.clone());
        line
    }

    /// True if the session's duration has passed.
    pub fn is_time_up(&self, settings: &Settings, now_ns: i64) -> bool {
        let shown_ns = self.begin_ns.map_or(0, |begin| now_ns - begin);
        settings.duration.is_some_and(|s| shown_ns as f64 >= s as f64 * 1e9)
    }

    /// Asks the settings' questions, unless they are being asked already.
    pub fn ask(&mut self, settings: &Settings) {
        self.questionnaire.get_or_insert_with(|| Questionnaire::new(&settings.questions));
    }

    /// Returns the current question.
    pub fn question(&self) -> Option<&Questionnaire> {
        self.questionnaire.as_ref().filter(|questions| !questions.is_done())
    }

    /// Returns the current question, to be answered.
    pub fn question_mut(&mut self) -> Option<&mut Questionnaire> {
        self.questionnaire.as_mut().filter(|questions| !questions.is_done())
    }

    /// Moves the slider with the head's orientation.
    pub fn look(&mut self, orientation: Quat, now_ns: i64) {
        if let Some(questions) = &mut self.questionnaire {
            questions.look(orientation, now_ns);
        }
    }
}
