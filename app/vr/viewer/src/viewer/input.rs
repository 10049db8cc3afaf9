//! Performs the user's actions, and asks questions.

use super::Viewer;
use crate::error::ViewerError;
use crate::event::{Action, Event};
use yoro_settings::telemetry::{Line, Rating};
use yoro_settings::{Ipd, Settings};

/// The step by which the IPD changes, in metres.
pub(super) const IPD_STEP: f32 = 0.001;

impl Viewer {
    /// Handles an action of the user.
    ///
    /// # Errors
    /// [`ViewerError::Gl`] if a method cannot be compiled; the previous one stays.
    pub fn event(&mut self, event: Event) -> Result<Action, ViewerError> {
        if self.stats.question().is_some() {
            return Ok(self.reply(event));
        }
        let action = match event {
            Event::Press | Event::Release => {
                self.press(event == Event::Press);
                return Ok(Action::Nothing);
            }
            Event::Tap if self.menu.board.is_some() => return self.choose_pointed(),
            Event::Tap => self.other_method(1)?,
            Event::PreviousMethod => self.other_method(-1)?,
            Event::LongPress if self.menu.is_comparing() => return Ok(Action::Nothing),
            Event::LongPress if self.menu.board.is_some() => {
                self.menu.close();
                Action::Recenter
            }
            Event::LongPress => return Ok(self.open_menu()),
            Event::IpdUp => self.change_ipd(IPD_STEP),
            Event::IpdDown => self.change_ipd(-IPD_STEP),
            Event::ToggleHud => {
                self.caption.is_shown = !self.caption.is_shown;
                Action::Hud(self.caption.is_shown)
            }
            Event::NextViewpoint => self.next_viewpoint(),
            Event::NextScene => self.next_scene(),
        };
        let message = match action {
            Action::Method(method) => method.name().to_owned(),
            Action::Recenter => "recentered".into(),
            Action::Ipd(ipd) => format!("IPD {:.0} mm", ipd.metres() * 1e3),
            Action::Viewpoint(n) => format!("viewpoint {n}"),
            Action::Menu(_)
            | Action::Settings
            | Action::StartScreen(_)
            | Action::ShareLog
            | Action::ShareNotices
            | Action::Scan(_)
            | Action::Hud(_)
            | Action::Scene
            | Action::Marker(_)
            | Action::Answer
            | Action::Nothing => String::new(),
        };
        self.caption.announce(message, self.now_ns);
        Ok(action)
    }

    /// Handles an event while a question is shown.
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
            Event::Press
            | Event::Release
            | Event::PreviousMethod
            | Event::ToggleHud
            | Event::NextViewpoint
            | Event::NextScene => Action::Nothing,
        }
    }

    /// Stores and logs the answer to the question shown.
    fn answer(&mut self) {
        let answer = self.stats.question_mut().and_then(|question| question.answer());
        let Some((question, rating)) = answer else { return };
        let Line { method, pipeline, scene, .. } = self.state();
        let Settings { participant, trial, .. } = &self.settings;
        let (participant, trial, rating) = (participant.clone(), *trial, f64::from(rating));
        let rating = Rating { participant, trial, method, pipeline, scene, question, rating };
        log::info!("{rating}");
        self.stats.ratings.push(rating);
    }

    /// Asks the settings' questions when the session's time is up; returns true if no question is left.
    pub(super) fn ask(&mut self) -> bool {
        self.stats.ask(&self.settings);
        if self.stats.question().is_some_and(|question| question.has_settled(self.now_ns)) {
            self.answer();
        }
        self.stats.question().is_none()
    }

    pub(super) fn change_ipd(&mut self, change: f32) -> Action {
        // Whole tenths of a millimetre, so that steps do not add up rounding errors.
        let metres = self.ipd().metres() + change;
        let ipd = Ipd::nearest((metres * 1e4).round() / 1e4);
        self.ipd.chosen = Some(ipd);
        Action::Ipd(ipd)
    }

    pub(super) fn next_viewpoint(&mut self) -> Action {
        let Some(viewpoint) = self.scene.next_viewpoint() else { return Action::Nothing };
        self.measure_again();
        Action::Viewpoint(viewpoint)
    }

    /// Loads the scene after this one.
    pub(super) fn next_scene(&mut self) -> Action {
        let Some(source) = self.scene.next(&self.folders) else { return Action::Nothing };
        self.replace_scene(source, 0);
        Action::Scene
    }

    /// Switches to the next (1) or previous (-1) method of the list that the driver supports.
    pub(super) fn other_method(&mut self, step: isize) -> Result<Action, ViewerError> {
        Ok(self.switch_method(step)?.map_or(Action::Nothing, Action::Method))
    }
}
