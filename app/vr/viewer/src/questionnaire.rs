//! Questions at the end of a session, answered on a slider by turning the head or with the volume keys.

use std::f32::consts::{PI, TAU};
use std::fmt::Write;

use glam::{Quat, Vec3};

/// Rotation of the head in radians that moves the marker from one end to the other.
const SPAN: f32 = 0.7;
/// The best rating; the worst is 1.
const BEST: f32 = 5.0;
/// Ratings are multiples of this.
const STEP: f32 = 0.5;
/// A marker that was moved and then left alone for this long, in nanoseconds, is the answer, since some viewers have no
/// button.
const SETTLE_NS: i64 = 5_000_000_000;

/// The open questions, and the marker on the slider of the current one.
#[derive(Clone, Debug)]
pub(crate) struct Questionnaire {
    /// In reverse order.
    questions: Vec<String>,
    /// Between 1 and [`BEST`], not rounded.
    value: f32,
    /// The direction of the head in the last frame, in radians to the left.
    heading: Option<f32>,
    /// The time of the rating's last change; `None` until the marker is moved.
    moved_ns: Option<i64>,
}

impl Questionnaire {
    /// Creates a questionnaire with ratings from 1 to [`BEST`]; the marker starts in the middle.
    pub fn new(questions: &[String]) -> Questionnaire {
        let mut questionnaire = Questionnaire {
            questions: questions.iter().rev().cloned().collect(),
            value: 0.0,
            heading: None,
            moved_ns: None,
        };
        questionnaire.center();
        questionnaire
    }

    fn center(&mut self) {
        self.value = (1.0 + BEST) / 2.0;
        self.heading = None;
        self.moved_ns = None;
    }

    /// True if all questions are answered.
    pub fn is_done(&self) -> bool {
        self.questions.is_empty()
    }

    /// Returns the rating that the marker stands for.
    pub fn rating(&self) -> f32 {
        (self.value / STEP).round() * STEP
    }

    /// Returns the position of the marker, from 0 to 1.
    pub fn position(&self) -> f32 {
        (self.rating() - 1.0) / (BEST - 1.0)
    }

    /// Moves the marker with the head's rotation; to the right is a better rating.
    pub fn look(&mut self, orientation: Quat, now_ns: i64) {
        let ahead = orientation * Vec3::NEG_Z;
        let heading = (-ahead.x).atan2(-ahead.z);
        let before = self.heading.replace(heading).unwrap_or(heading);
        let turn = (heading - before + PI).rem_euclid(TAU) - PI;
        self.shift(-turn / SPAN * (BEST - 1.0), now_ns);
    }

    /// Moves the marker by a number of steps.
    pub fn nudge(&mut self, steps: f32, now_ns: i64) {
        self.value = self.rating();
        self.shift(steps * STEP, now_ns);
    }

    fn shift(&mut self, change: f32, now_ns: i64) {
        let before = self.rating();
        self.value = (self.value + change).clamp(1.0, BEST);
        if self.rating() != before {
            self.moved_ns = Some(now_ns);
        }
    }

    /// Forgets the head's direction, since recentering is not a rotation of the head.
    pub fn recenter(&mut self) {
        self.heading = None;
    }

    /// True if the marker was moved and then left alone.
    pub fn has_settled(&self, now_ns: i64) -> bool {
        self.moved_ns.is_some_and(|moved| now_ns - moved >= SETTLE_NS)
    }

    /// Takes the marker's rating as the answer and moves on to the next question. Returns the question and its rating.
    pub fn answer(&mut self) -> Option<(String, f32)> {
        let answer = (self.questions.pop()?, self.rating());
        self.center();
        Some(answer)
    }

    /// Writes the panel's text.
    pub fn write(&self, text: &mut String) {
        text.clear();
        let Some(question) = self.questions.last() else { return };
        text.extend(question.chars().map(|c| if c == '-' { ' ' } else { c }));
        let rating = self.rating();
        write!(
            text,
            "?\n1 (worst) to {BEST} (best): {rating}\nturn your head to change it\ntap or trigger when done"
        )
        .expect("a string takes everything");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: i64 = 1_000_000_000;

    fn asked() -> Questionnaire {
        Questionnaire::new(&["image-quality".into(), "comfort".into()])
    }

    #[test]
    fn questions_come_in_order_each_from_the_middle() {
        let mut q = asked();
        assert_eq!((q.rating(), q.position()), (3.0, 0.5));
        q.nudge(3.0, 0);
        assert_eq!(q.answer(), Some(("image-quality".into(), 4.5)));
        assert_eq!(q.rating(), 3.0);
        q.nudge(-1.0, 0);
        assert!(!q.is_done());
        assert_eq!(q.answer(), Some(("comfort".into(), 2.5)));
        assert!(q.is_done());
        assert_eq!(q.answer(), None);
    }

    #[test]
    fn turning_right_raises_the_rating_up_to_its_ends() {
        let mut q = asked();
        let look = |q: &mut Questionnaire, left: f32| q.look(Quat::from_rotation_y(left), 0);
        // The head's first direction is not a rotation.
        look(&mut q, 3.0);
        assert_eq!(q.rating(), 3.0);
        look(&mut q, 3.0 - SPAN / 4.0);
        assert_eq!(q.rating(), 4.0);
        look(&mut q, 3.0 - 2.0 * SPAN);
        assert_eq!((q.rating(), q.position()), (5.0, 1.0));
        // At the end of the slider, turning back moves the marker at once.
        look(&mut q, 3.0 - 1.5 * SPAN);
        assert_eq!(q.rating(), 3.0);
        // Through the back, where the angle wraps around.
        let mut q = asked();
        look(&mut q, PI - 0.01);
        look(&mut q, PI - 0.01 + SPAN / 4.0);
        assert_eq!(q.rating(), 2.0);
    }

    #[test]
    fn only_a_moved_marker_answers_by_itself() {
        let mut q = asked();
        assert!(!q.has_settled(100 * SECOND));
        q.nudge(1.0, 2 * SECOND);
        assert!(!q.has_settled(6 * SECOND) && q.has_settled(7 * SECOND));
        q.look(Quat::IDENTITY, 6 * SECOND);
        // Too little to change the rating.
        q.look(Quat::from_rotation_y(0.01), 6 * SECOND);
        assert!(q.has_settled(7 * SECOND));
        q.nudge(1.0, 7 * SECOND);
        assert!(!q.has_settled(8 * SECOND));
    }

    #[test]
    fn the_question_fits_four_lines() {
        let mut text = String::new();
        asked().write(&mut text);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines[..2], ["image quality?", "1 (worst) to 5 (best): 3"]);
        assert!(lines.len() == 4 && lines.iter().all(|line| line.len() <= yoro_lenses::COLUMNS));
    }
}
