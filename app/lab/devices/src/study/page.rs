//! What the report of a study consists of.

use std::fmt::Write as _;
use std::path::Path;

use super::analysis::{Question, Study};
use yoro_report::paper::{PAPER, STUDY_PARTICIPANTS};
use yoro_report::stats::Sample;
use yoro_report::{Axis, Cell, Entry, Plot, Report, ReportFiles, Section, Table, Text};

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
    /// One sentence. All three are made before the first one is written.
    pub fn write(&self, folder: &Path) -> anyhow::Result<ReportFiles> {
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
    let Sample { mean, n, interval, .. } = question.difference;
    let interval = interval.map(|[low, high]| format!("95 % interval {low:+.2} to {high:+.2}; "));
    let (ours, baseline) = (question.ours.mean, question.baseline.mean);
    format!("{ours:.2} against {baseline:.2}, {mean:+.2} ({}n = {n})", interval.unwrap_or_default())
}

fn table(study: &Study) -> Table {
    let columns = [
        "<question".to_owned(),
        "<method".into(),
        "participants".into(),
        "mean ± sd (median)".into(),
        format!("{}, mean ± sd (median)", study.baseline),
        "difference [95 %]".into(),
    ];
    let mut table =
        Table::new(format!("Ratings on a scale from {} to {}", study.scale[0], study.scale[1]), &columns);
    let opinion = |of: Sample| Some(format!("{:.2} ± {:.2} ({:.2})", of.mean, of.std, of.median));
    let difference = |mean: f64, interval: Option<[f64; 2]>| {
        let interval = interval.map(|[low, high]| format!(" [{low:+.3}, {high:+.3}]"));
        Some(format!("{mean:+.3}{}", interval.unwrap_or_default()))
    };
    for question in &study.questions {
        table.push(vec![
            Cell::plain(&question.question),
            Cell::plain(&question.method),
            Cell::plain(question.difference.n.to_string()),
            Cell::ours(opinion(question.ours)),
            Cell::base(opinion(question.baseline)),
            Cell::ours(difference(question.difference.mean, question.difference.interval)),
        ]);
    }
    for (i, (name, [low, high])) in PAPER.study.iter().enumerate() {
        let cells = vec![
            Cell::paper(Some(format!("the paper's: {name}"))),
            Cell::paper(Some("YORO")),
            Cell::paper(Some(STUDY_PARTICIPANTS.to_string())),
            Cell::paper(None::<String>),
            Cell::paper(None::<String>),
            Cell::paper(difference((low + high) / 2.0, Some([*low, *high]))),
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
    let caption = "Means over the participants; bars: 95 % intervals.";
    let mut ratings = Plot::rows("Ratings", Axis::new("rating").lines(&study.scale)).caption(caption);
    let axis = Axis::new(format!("difference from {}", study.baseline)).baseline(0.0);
    let mut differences = Plot::rows(format!("Differences from {}", study.baseline), axis).caption(caption);
    for question in &study.questions {
        let row = heading(question);
        let Question { method, baseline, ours, difference, .. } = question;
        for (method, Sample { mean, interval, .. }) in [(&study.baseline, baseline), (method, ours)] {
            ratings.mark_interval(&row, Entry::ours(method), *mean, *interval);
        }
        differences.mark_interval(&row, Entry::ours(method), difference.mean, difference.interval);
    }
    [ratings, differences]
}
