//! Analysis of ratings: for each question, each method is compared with the baseline.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::error::StudyError;
use super::ratings::Ratings;
use yoro_files::interrupt;
use yoro_report::inference::{Equivalence, Interval, Sample, pairs_for_power};
use yoro_report::stats::unique;

/// Lowest and highest rating.
pub type Scale = [f64; 2];

/// Options of the analysis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Options {
    /// The method that the others are compared with.
    pub baseline: String,
    /// Lowest and highest rating.
    pub scale: Scale,
    /// Equivalence margin of the mean difference, in units of the scale.
    pub bound: f64,
    /// Significance level of all tests.
    pub alpha: f64,
    /// Power for which the sample size is computed.
    pub power: f64,
}

/// A participant who was left out of a comparison.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Excluded {
    /// Participant.
    pub participant: String,
    /// Which ratings are missing.
    pub reason: String,
}

/// The verdict about a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// No difference was shown, and it was shown that any difference is smaller than the bound.
    Equivalent,
    /// A difference was shown, and it was shown to be smaller than the bound.
    SmallDifference,
    /// A difference was shown, and it was not shown to be smaller than the bound.
    Different,
    /// Neither was shown.
    Undecided,
    /// There is no data to test.
    Untestable,
}

/// The comparison of a method with the baseline by one question.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Question {
    /// The question's name.
    pub question: String,
    /// The method that was rated.
    pub method: String,
    /// Scenes that each participant of the comparison has rated.
    pub scenes: Vec<String>,
    /// Each participant with the mean ratings of the method and of the baseline over the scenes.
    pub participants: Vec<(String, f64, f64)>,
    /// Participants left out of this comparison, with the reason.
    pub excluded: Vec<Excluded>,
    /// Ratings of the method.
    pub ours: Sample,
    /// Ratings of the baseline.
    pub baseline: Sample,
    /// Method minus baseline, by participant.
    pub difference: Sample,
    /// Confidence interval of the mean difference, at 1 - alpha.
    pub interval: Option<Interval>,
    /// Statistic of the paired t-test. `None` if all differences are equal.
    pub t: Option<f64>,
    /// Two-sided p-value.
    pub p: Option<f64>,
    /// Cohen's d_z.
    pub d_z: Option<f64>,
    /// Confidence interval of d_z, at 1 - alpha.
    pub d_z_interval: Option<Interval>,
    /// Post hoc power of the test: its power if the true effect were the one found.
    pub power: Option<f64>,
    /// Number of participants needed to find a true difference as large as the bound with the requested power.
    pub needed: Option<usize>,
    /// Result of the two one-sided tests (TOST).
    pub equivalence: Option<Equivalence>,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict as a sentence.
    pub words: String,
}

/// An analysed study.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// The options.
    pub options: Options,
    /// Program, version and command that made the analysis.
    pub made_by: String,
    /// Number of participants.
    pub participants: usize,
    /// Comparisons by question, then by method.
    pub questions: Vec<Question>,
    /// Question and method of the comparisons for which nobody has answered completely.
    pub unanswered: Vec<(String, String)>,
}

impl Study {
    /// Analyses ratings.
    ///
    /// # Errors
    /// [`StudyError::Nothing`] if the baseline or any other method is missing; [`StudyError::Interrupted`].
    pub fn new(ratings: &Ratings, options: Options, made_by: String) -> Result<Study, StudyError> {
        let methods: BTreeSet<&str> = ratings.rows.iter().map(|row| row.method.as_str()).collect();
        let nothing = |what: String| StudyError::Nothing { path: ratings.path.clone(), what };
        let named = || methods.iter().copied().collect::<Vec<_>>().join(", ");
        if !methods.contains(options.baseline.as_str()) {
            let what =
                format!("nobody has rated {}: name one of {} as the baseline", options.baseline, named());
            return Err(nothing(what));
        }
        if methods.len() < 2 {
            return Err(nothing(format!("only {} was rated: rate another method, too", named())));
        }
        let questions = unique(ratings.rows.iter().map(|row| row.question.as_str()));
        let mut study = Study {
            made_by,
            participants: ratings.rows.iter().map(|row| &row.participant).collect::<BTreeSet<_>>().len(),
            questions: Vec::new(),
            unanswered: Vec::new(),
            options,
        };
        for question in questions {
            for method in methods.iter().filter(|method| **method != study.options.baseline) {
                interrupt::check()?;
                match compare(ratings, question, method, &study.options) {
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
fn compare(ratings: &Ratings, question: &str, method: &str, options: &Options) -> Option<Question> {
    let rows = || ratings.rows.iter().filter(|row| row.question == question);
    let of_pair = || rows().filter(|row| row.method == method || row.method == options.baseline);
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
        let (ours, baseline) = (side(method), side(&options.baseline));
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
        let missing = [missing(method), missing(&options.baseline)].concat();
        let reason = match missing.len() {
            n if n == 2 * scenes.len() => "has not answered this question".into(),
            n if n > 4 => format!("has not rated {} and {} more", missing[..3].join(", "), n - 3),
            _ => format!("has not rated {}", missing.join(", ")),
        };
        excluded.push(Excluded { participant: participant.into(), reason });
    }
    let difference =
        Sample::of_differences(participants.iter().map(|(_, ours, baseline)| (*ours, *baseline)))?;
    let side = |value: fn(&(String, f64, f64)) -> f64| {
        Sample::of(&participants.iter().map(value).collect::<Vec<_>>())
    };
    let bounds = Interval { low: -options.bound, high: options.bound };
    let equivalence = difference.equivalence(bounds, options.alpha);
    let p = difference.p();
    let verdict = match (p, equivalence) {
        (Some(p), Some(tost)) => match (p < options.alpha, tost.equivalent) {
            (false, true) => Verdict::Equivalent,
            (true, true) => Verdict::SmallDifference,
            (true, false) => Verdict::Different,
            (false, false) => Verdict::Undecided,
        },
        _ => Verdict::Untestable,
    };
    let needed = (difference.std > 0.0)
        .then(|| pairs_for_power(options.bound / difference.std, options.power, options.alpha))
        .flatten();
    Some(Question {
        question: question.into(),
        method: method.into(),
        scenes: scenes.iter().map(|scene| scene.to_string()).collect(),
        ours: side(|p| p.1)?,
        baseline: side(|p| p.2)?,
        excluded,
        interval: difference.interval(1.0 - options.alpha),
        t: difference.t(0.0),
        p,
        d_z: difference.d_z(),
        d_z_interval: difference.d_z_interval(1.0 - options.alpha),
        power: difference.power(options.alpha),
        needed,
        words: words(verdict, &difference, method, needed, options),
        equivalence,
        verdict,
        difference,
        participants,
    })
}

fn words(
    verdict: Verdict,
    difference: &Sample,
    method: &str,
    needed: Option<usize>,
    options: &Options,
) -> String {
    let Options { baseline, bound, power, .. } = options;
    let better = if difference.mean > 0.0 { "higher" } else { "lower" };
    let size = format!("{:.2}", difference.mean.abs());
    match verdict {
        Verdict::Equivalent => format!(
            "Equivalent: {method} and {baseline} differ by less than {bound}, and not shown to differ at all."
        ),
        Verdict::SmallDifference => format!(
            "A small difference: {method} is rated {better} by {size}, which is shown to be real, and to be less than {bound}."
        ),
        Verdict::Different => {
            format!("Different: {method} is rated {better} by {size}, and not shown to be within {bound}.")
        }
        Verdict::Undecided => {
            let more = match needed {
                Some(needed) => format!(
                    " To find a difference of {bound} with a power of {power} takes about {needed} participants of this scatter."
                ),
                None => String::new(),
            };
            format!("Undecided: neither a difference nor equivalence is shown.{more}")
        }
        Verdict::Untestable if difference.n < 2 => "Nothing can be tested with one participant.".into(),
        Verdict::Untestable => {
            format!("All participants differ by the same {size}: there is no scatter to test against.")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Row;

    fn options() -> Options {
        Options { baseline: "conventional".into(), scale: [1.0, 5.0], bound: 0.5, alpha: 0.05, power: 0.8 }
    }

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
        Study::new(&Ratings { path: "made-up.csv".into(), rows }, options(), "a test".into()).unwrap()
    }

    #[test]
    fn verdicts_follow_t_test_and_tost() {
        let verdict = |differences: &[f64]| study(made_up(differences)).questions[0].verdict;
        assert_eq!(verdict(&[0.1, -0.1, 0.05, -0.05, 0.0, 0.02]), Verdict::Equivalent);
        assert_eq!(verdict(&[0.1, 0.12, 0.11, 0.09, 0.1, 0.08]), Verdict::SmallDifference);
        assert_eq!(verdict(&[-1.0, -1.2, -0.9, -1.1, -1.3]), Verdict::Different);
        assert_eq!(verdict(&[-1.0, 1.2, -0.9, 1.5]), Verdict::Undecided);
        assert_eq!(verdict(&[0.2]), Verdict::Untestable);
        assert_eq!(verdict(&[0.25, 0.25, 0.25]), Verdict::Untestable);
    }

    /// From SciPy 1.17.1: ttest_1samp of these differences, its interval, and one-sided of -0.5 and 0.5.
    #[test]
    fn figures_agree_with_scipy() {
        let study = study(made_up(&[0.2, -0.1, 0.4, 0.1, -0.3, 0.25]));
        let question = &study.questions[0];
        let near = |ours: f64, reference: f64| assert!((ours - reference).abs() < 1e-6, "{ours} {reference}");
        near(question.difference.mean, SCIPY[0]);
        near(question.t.unwrap(), SCIPY[1]);
        near(question.p.unwrap(), SCIPY[2]);
        let interval = question.interval.unwrap();
        near(interval.low, SCIPY[3]);
        near(interval.high, SCIPY[4]);
        let tost = question.equivalence.unwrap();
        near(tost.p_lower, SCIPY[5]);
        near(tost.p_upper, SCIPY[6]);
        assert_eq!((question.ours.n, study.participants), (6, 6));
        near(question.baseline.mean, 3.0);
    }

    const SCIPY: [f64; 7] = [
        0.091666666667,
        0.884683526344,
        0.416835454317,
        -0.174684702212,
        0.358018035546,
        0.001150627207,
        0.005475211350,
    ];

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
        assert_eq!(study.questions[1].verdict, Verdict::Untestable);
    }

    #[test]
    fn nothing_to_compare_is_refused() {
        let ratings = |rows| Ratings { path: "made-up.csv".into(), rows };
        let only = |method: &str| {
            made_up(&[0.1, 0.2]).into_iter().filter(|r| r.method == method).collect::<Vec<_>>()
        };
        for (method, naming) in
            [("yoro", "nobody has rated conventional"), ("conventional", "only conventional")]
        {
            let error = Study::new(&ratings(only(method)), options(), String::new()).unwrap_err().to_string();
            assert!(error.contains(naming) && error.contains("made-up.csv"), "{error}");
        }
    }

    #[test]
    fn the_page_says_what_matters() {
        let study = study(made_up(&[0.2, -0.1, 0.4, 0.1, -0.3, 0.25]));
        let html = study.to_html().unwrap();
        for needed in ["image quality", "Equivalent", "0.6196", "<svg", "TOST"] {
            assert!(html.contains(needed), "{needed}");
        }
        let markdown = study.to_markdown();
        assert!(markdown.contains("*0.6196*") && markdown.contains("Equivalent"), "{markdown}");
        assert!(study.to_text().contains("image quality, yoro"), "{}", study.to_text());
    }
}
