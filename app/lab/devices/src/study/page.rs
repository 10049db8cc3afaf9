//! What the report of a study consists of.

use std::fmt::Write as _;
use std::path::Path;

use super::analysis::{Opinion, Question, Study};
use yoro_report::paper::{PAPER, STUDY_PARTICIPANTS};
use yoro_report::{
    Axis, CONFIDENCE, Cell, Entry, Interval, Plot, Report, ReportError, ReportFiles, Section, Table, Text,
};

impl Study {
    pub(super) fn report(&self) -> Report {
        let mut ratings = Section::new("Ratings", "");
        plots(self).into_iter().for_each(|plot| ratings.plot(plot));
        ratings.table(table(self));
        ratings.table(left_out(self));
        let mut method = Section::new(
            "How to read this",
            "A participant gives one value for each method: the mean over the scenes. Differences are taken participant by participant; \
         whoever lacks a rating is left out of that comparison only, by name. Intervals are Student's t of the participants' means. \
         They are not corrected for the number of questions, and one around zero is no proof of equality.",
        );
        method.text(Text::quiet(format!("`{}`", self.made_by)));
        let mut summary = vec![Text::quiet(format!("Participants: {}.", self.participants))];
        summary.extend(self.questions.iter().map(|question| {
            let (name, words) = (heading(question), in_words(question));
            Text::from(format!("**{name}**: {words}."))
        }));
        summary.extend(unanswered(self).into_iter().map(Text::warning));
        Report { title: "User study".into(), summary, sections: vec![ratings, method] }
    }

    /// Returns the means and differences for a terminal.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        for question in &self.questions {
            let _ = writeln!(out, "{}: {}", heading(question), in_words(question));
            for excluded in &question.excluded {
                let _ = writeln!(out, "  left out: {} {}", excluded.participant, excluded.reason);
            }
        }
        for line in unanswered(self) {
            let _ = writeln!(out, "{line}");
        }
        out
    }

    /// Writes `study.html`, `study.md` and `study.json` into `folder`.
    ///
    /// # Errors
    /// [`ReportError`]. All three are made before the first one is written.
    pub fn write(&self, folder: &Path) -> Result<ReportFiles, ReportError> {
        self.report().write(folder, "study", Some(&serde_json::to_string_pretty(self)?))
    }
}

fn heading(question: &Question) -> String {
    format!("{}, {}", question.question, question.method)
}

fn unanswered(study: &Study) -> Vec<String> {
    let line = |(question, method): &(String, String)| {
        format!("{question}, {method}: nobody has rated it and {} on all scenes.", study.baseline)
    };
    study.unanswered.iter().map(line).collect()
}

/// Returns the means, their difference and its interval as words.
fn in_words(question: &Question) -> String {
    let Opinion { sample, interval, .. } = question.difference;
    let confidence = 100.0 * CONFIDENCE;
    let interval = interval.map(|i| format!("{confidence:.0} % interval {:+.2} to {:+.2}; ", i.low, i.high));
    let (ours, baseline) = (question.ours.sample.mean, question.baseline.sample.mean);
    let interval = interval.unwrap_or_default();
    format!("{ours:.2} against {baseline:.2}, {:+.2} ({interval}n = {})", sample.mean, sample.n)
}

fn table(study: &Study) -> Table {
    let columns = [
        "<question".to_owned(),
        "<method".into(),
        "participants".into(),
        "mean ± sd (median)".into(),
        format!("{}, mean ± sd (median)", study.baseline),
        format!("difference [{:.0} %]", 100.0 * CONFIDENCE),
    ];
    let mut table =
        Table::new(format!("Ratings on a scale from {} to {}", study.scale[0], study.scale[1]), &columns);
    let opinion = |Opinion { sample, median, .. }: Opinion| {
        Some(format!("{:.2} ± {:.2} ({median:.2})", sample.mean, sample.std))
    };
    let difference = |mean: f64, interval: Option<Interval>| {
        let interval = interval.map(|i| format!(" [{:+.3}, {:+.3}]", i.low, i.high)).unwrap_or_default();
        Some(format!("{mean:+.3}{interval}"))
    };
    for question in &study.questions {
        table.push(vec![
            Cell::plain(&question.question),
            Cell::plain(&question.method),
            Cell::plain(question.difference.sample.n.to_string()),
            Cell::ours(opinion(question.ours)),
            Cell::base(opinion(question.baseline)),
            Cell::ours(difference(question.difference.sample.mean, question.difference.interval)),
        ]);
    }
    for (i, papers) in PAPER.study.iter().enumerate() {
        let [low, high] = papers.interval;
        let cells = vec![
            Cell::paper(Some(format!("the paper's: {}", papers.name))),
            Cell::paper(Some("YORO")),
            Cell::paper(Some(STUDY_PARTICIPANTS.to_string())),
            Cell::paper(None::<String>),
            Cell::paper(None::<String>),
            Cell::paper(difference((low + high) / 2.0, Some(Interval { low, high }))),
        ];
        if i == 0 { table.push_first(cells) } else { table.push(cells) }
    }
    table.note = "The paper gives no means; its difference is the middle of its interval.".into();
    table
}

/// Returns a table of the participants who were left out of a comparison, with the reason.
fn left_out(study: &Study) -> Table {
    let mut left_out = Table::new("Participants left out", &["<question", "<method", "<participant", "<why"]);
    for question in &study.questions {
        for excluded in &question.excluded {
            left_out.push(vec![
                Cell::plain(&question.question),
                Cell::plain(&question.method),
                Cell::plain(&excluded.participant),
                Cell::long(&excluded.reason),
            ]);
        }
    }
    left_out
}

fn plots(study: &Study) -> [Plot; 2] {
    let caption = format!("Means over the participants; bars: {:.0} % intervals.", 100.0 * CONFIDENCE);
    let mut ratings = Plot::rows("Ratings", Axis::new("rating").lines(&study.scale)).caption(caption.clone());
    let axis = Axis::new(format!("difference from {}", study.baseline)).baseline(0.0);
    let mut differences = Plot::rows(format!("Differences from {}", study.baseline), axis).caption(caption);
    for question in &study.questions {
        let row = heading(question);
        for (method, opinion) in [(&study.baseline, question.baseline), (&question.method, question.ours)] {
            ratings.mark_interval(&row, Entry::ours(method), opinion.sample.mean, opinion.interval);
        }
        let Opinion { sample, interval, .. } = question.difference;
        differences.mark_interval(&row, Entry::ours(&question.method), sample.mean, interval);
    }
    [ratings, differences]
}
