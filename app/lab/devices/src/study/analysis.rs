//! Analysis of ratings: for each question, each method beside the baseline.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::ratings::Ratings;
use crate::DataError;
use yoro_files::{FileError, interrupt};
use yoro_report::stats::{Sample, unique};

/// A participant who was left out of a comparison.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Excluded {
    pub(super) participant: String,
    /// Which ratings are missing.
    pub(super) reason: String,
}

/// A method beside the baseline by the answers to one question.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Question {
    pub(super) question: String,
    pub(super) method: String,
    /// Scenes that each participant of the comparison has rated.
    pub(super) scenes: Vec<String>,
    /// Each participant with the mean ratings of the method and of the baseline over the scenes.
    pub(super) participants: Vec<(String, f64, f64)>,
    /// Participants left out of this comparison, with the reason.
    pub(super) excluded: Vec<Excluded>,
    /// What participants say of the method: one value for each, the mean over the scenes.
    pub(super) ours: Sample,
    pub(super) baseline: Sample,
    /// Method minus baseline, by participant.
    pub(super) difference: Sample,
}

/// An analysed study.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// The method that the others are compared with.
    pub(super) baseline: String,
    pub(super) scale: [f64; 2],
    /// Program, version and command that made the analysis.
    pub(super) made_by: String,
    pub(super) participants: usize,
    /// Comparisons by question, then by method.
    pub(super) questions: Vec<Question>,
    /// Question and method of the comparisons for which nobody has answered completely.
    pub(super) unanswered: Vec<(String, String)>,
}

impl Study {
    /// Analyses ratings on a scale from its lowest to its highest rating.
    ///
    /// # Errors
    /// [`DataError::Unusable`] if the baseline or any other method is missing; [`FileError::Interrupted`].
    pub fn new(
        ratings: &Ratings,
        baseline: &str,
        scale: [f64; 2],
        made_by: String,
    ) -> Result<Study, DataError> {
        let methods: BTreeSet<&str> = ratings.rows.iter().map(|row| row.method.as_str()).collect();
        let nothing = |what: String| DataError::Unusable(format!("{}: {what}", ratings.path.display()));
        let named = || methods.iter().copied().collect::<Vec<_>>().join(", ");
        if !methods.contains(baseline) {
            let what = format!("nobody has rated {baseline}: name one of {} as the baseline", named());
            return Err(nothing(what));
        }
        if methods.len() < 2 {
            return Err(nothing(format!("only {} was rated: rate another method, too", named())));
        }
        let mut study = Study {
            baseline: baseline.into(),
            scale,
            made_by,
            participants: ratings.rows.iter().map(|row| &row.participant).collect::<BTreeSet<_>>().len(),
            questions: Vec::new(),
            unanswered: Vec::new(),
        };
        for question in unique(ratings.rows.iter().map(|row| row.question.as_str())) {
            for method in methods.iter().filter(|method| **method != baseline) {
                interrupt::check().map_err(FileError::from)?;
                match compare(ratings, question, method, baseline) {
                    Some(found) => study.questions.push(found),
                    None => study.unanswered.push((question.into(), (*method).into())),
                }
            }
        }
        Ok(study)
    }
}

/// Compares a method with the baseline by the answers to one question. Returns `None` if nobody rated both in all
/// scenes.
fn compare(ratings: &Ratings, question: &str, method: &str, baseline_method: &str) -> Option<Question> {
    let rows = || ratings.rows.iter().filter(|row| row.question == question);
    let of_pair = || rows().filter(|row| row.method == method || row.method == baseline_method);
    let scenes: BTreeSet<&str> = of_pair().map(|row| row.scene.as_str()).collect();
    let mut answers: BTreeMap<&str, BTreeMap<(&str, &str), f64>> = BTreeMap::new();
    for row in &ratings.rows {
        answers.entry(&row.participant).or_default();
    }
    for row in of_pair() {
        answers.entry(&row.participant).or_default().insert((&row.method, &row.scene), row.rating);
    }
    let (mut participants, mut excluded) = (Vec::new(), Vec::new());
    for (participant, answers) in answers {
        let side = |method: &str| {
            let found: Vec<f64> =
                scenes.iter().filter_map(|scene| answers.get(&(method, *scene)).copied()).collect();
            (found.iter().sum::<f64>() / found.len() as f64, found.len())
        };
        let (ours, baseline) = (side(method), side(baseline_method));
        if ours.1 == scenes.len() && baseline.1 == scenes.len() {
            participants.push((participant.to_owned(), ours.0, baseline.0));
            continue;
        }
        let missing = |method: &str| {
            scenes
                .iter()
                .filter(|scene| !answers.contains_key(&(method, **scene)))
                .map(|scene| format!("{method} on {scene}"))
                .collect::<Vec<_>>()
        };
        let missing = [missing(method), missing(baseline_method)].concat();
        let reason = match missing.len() {
            n if n == 2 * scenes.len() => "has not answered this question".into(),
            n if n > 4 => format!("has not rated {} and {} more", missing[..3].join(", "), n - 3),
            _ => format!("has not rated {}", missing.join(", ")),
        };
        excluded.push(Excluded { participant: participant.into(), reason });
    }
    let values = |value: fn(&(String, f64, f64)) -> f64| {
        Sample::of(&participants.iter().map(value).collect::<Vec<_>>())
    };
    Some(Question {
        question: question.into(),
        method: method.into(),
        scenes: scenes.iter().map(|scene| scene.to_string()).collect(),
        ours: values(|p| p.1)?,
        baseline: values(|p| p.2)?,
        difference: values(|p| p.1 - p.2)?,
        excluded,
        participants,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::ratings::Row;

    /// Makes up ratings: for each participant two scenes, whose differences lie around the given one.
    fn made_up(differences: &[f64]) -> Vec<Row> {
        let mut rows = Vec::new();
        for (i, difference) in differences.iter().enumerate() {
            for (scene, off) in [("street", 0.1), ("atrium", -0.1)] {
                for (method, rating) in [("conventional", 3.0 + off), ("yoro", 3.0 + off + difference)] {
                    rows.push(Row {
                        participant: format!("P{:02}", i + 1),
                        method: method.into(),
                        scene: scene.into(),
                        question: "image quality".into(),
                        rating,
                    });
                }
            }
        }
        rows
    }

    fn study(rows: Vec<Row>) -> Study {
        Study::new(&Ratings { path: "made-up.csv".into(), rows }, "conventional", [1.0, 5.0], "a test".into())
            .unwrap()
    }

    /// From SciPy 1.17.1: the mean of these differences and the interval of ttest_1samp.
    #[test]
    fn figures_agree_with_scipy() {
        let study = study(made_up(&[0.2, -0.1, 0.4, 0.1, -0.3, 0.25]));
        let question = &study.questions[0];
        let near = |ours: f64, reference: f64| assert!((ours - reference).abs() < 1e-6, "{ours} {reference}");
        near(question.difference.mean, 0.091666666667);
        near(question.difference.median, 0.15);
        let [low, high] = question.difference.interval.unwrap();
        near(low, -0.174684702212);
        near(high, 0.358018035546);
        assert_eq!((question.ours.n, study.participants), (6, 6));
        near(question.baseline.mean, 3.0);
    }

    #[test]
    fn incomplete_participants_are_named() {
        let mut rows = made_up(&[0.1, 0.2, -0.1, 0.0]);
        rows.retain(|row| !(row.participant == "P02" && row.method == "yoro" && row.scene == "street"));
        rows.retain(|row| row.participant != "P04");
        let other = Row { question: "comfort".into(), ..rows[0].clone() };
        rows.extend([
            Row { participant: "P04".into(), ..other.clone() },
            Row { participant: "P04".into(), method: "yoro".into(), ..other },
        ]);
        let study = study(rows);
        let named = |question: &Question| -> Vec<(String, String)> {
            question.excluded.iter().map(|e| (e.participant.clone(), e.reason.clone())).collect()
        };
        let image = &study.questions[0];
        assert_eq!(image.participants.len(), 2);
        assert_eq!(named(image)[0], ("P02".into(), "has not rated yoro on street".into()));
        assert_eq!(named(image)[1], ("P04".into(), "has not answered this question".into()));
        // A participant without answers to one question still counts for another.
        assert_eq!(study.questions[1].participants[0].0, "P04");
        assert_eq!(study.questions[1].difference.interval, None);
    }

    #[test]
    fn the_report_says_what_matters() {
        let study = study(made_up(&[0.2, -0.1, 0.4, 0.1, -0.3, 0.25]));
        let markdown = study.report().to_markdown();
        let row = "| image quality | yoro | 6 | 3.09 ± 0.25 (3.15) | 3.00 ± 0.00 (3.00) | +0.092 [-0.175, +0.358] |";
        assert!(markdown.contains(row) && markdown.contains("*+0.022 [-0.056, +0.101]*"), "{markdown}");
        let text = study.to_text();
        assert!(
            text.contains(
                "image quality, yoro: 3.09 against 3.00, +0.09 (95 % interval -0.17 to +0.36; n = 6)"
            ),
            "{text}"
        );
    }
}
