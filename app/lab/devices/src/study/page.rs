//! The study's sentences, tables and figures.

use std::fmt::Write as _;

use minijinja::context;

use super::analysis::{Question, Study};
use yoro_report::ReportError;
use yoro_report::grid::{Cell, Table};
use yoro_report::inference::{Interval, Sample};
use yoro_report::page::{Template, figures, fill};
use yoro_report::paper;
use yoro_report::plot::{Axis, DotRow, Figure, Mark, Panel};
use yoro_report::text::{fixed, slug};

const TEMPLATE: Template =
    Template { name: "study.html.j2", text: include_str!("../templates/study.html.j2") };

pub(super) fn html(study: &Study) -> Result<String, ReportError> {
    let question = |question: &Question| {
        context! { name => heading(question), words => &question.words, mean => means_in_words(question) }
    };
    let page = context! {
        participants => study.participants,
        questions => study.questions.iter().map(question).collect::<Vec<_>>(),
        unanswered => unanswered(study),
        figures => figures(&plots(study))?,
        tables => tables(study),
        method => method_notes(study),
        made_by => &study.made_by,
    };
    fill(TEMPLATE, "User study", page)
}

pub(super) fn markdown(study: &Study) -> String {
    let mut out = format!("# User study\n\n{} participants.\n\n", study.participants);
    for question in &study.questions {
        let (name, means) = (heading(question), means_in_words(question));
        let _ = writeln!(out, "- **{name}**: {} {means}", question.words);
    }
    for line in unanswered(study) {
        let _ = writeln!(out, "- {line}");
    }
    let _ = writeln!(out);
    for table in tables(study) {
        let _ = writeln!(out, "{}", table.markdown());
    }
    for note in method_notes(study) {
        let _ = writeln!(out, "- {note}");
    }
    let _ = writeln!(out, "\n{}", study.made_by);
    out
}

pub(super) fn text(study: &Study) -> String {
    let mut out = String::new();
    for question in &study.questions {
        let (name, means) = (heading(question), means_in_words(question));
        let _ = writeln!(out, "{name}: {} {means}", question.words);
        for excluded in &question.excluded {
            let _ = writeln!(out, "  left out: {} {}", excluded.participant, excluded.reason);
        }
    }
    for line in unanswered(study) {
        let _ = writeln!(out, "{line}");
    }
    out
}

fn heading(question: &Question) -> String {
    format!("{}, {}", question.question, question.method)
}

fn unanswered(study: &Study) -> Vec<String> {
    let line = |(question, method): &(String, String)| {
        format!("{question}, {method}: nobody has rated it and {} on all scenes.", study.options.baseline)
    };
    study.unanswered.iter().map(line).collect()
}

fn means_in_words(question: &Question) -> String {
    let interval = question.interval.map(|i| format!(", interval {:+.2} to {:+.2}", i.low, i.high));
    format!(
        "Mean {:.2} against {:.2}: {:+.2}{} (n = {}).",
        question.ours.mean,
        question.baseline.mean,
        question.difference.mean,
        interval.unwrap_or_default(),
        question.difference.n
    )
}

/// Formats a p-value. Values below 0.001 are in scientific notation.
fn p_value(p: Option<f64>) -> Option<String> {
    p.map(|p| if p < 1e-3 { format!("{p:.2e}") } else { format!("{p:.4}") })
}

fn interval(interval: Option<Interval>) -> String {
    interval.map(|i| format!(" [{:.3}, {:.3}]", i.low, i.high)).unwrap_or_default()
}

fn tables(study: &Study) -> Vec<Table> {
    let options = &study.options;
    let percent = |confidence: f64| format!("{:.0} %", 100.0 * confidence);
    let (wide, narrow) = (percent(1.0 - options.alpha), percent(1.0 - 2.0 * options.alpha));
    let columns = [
        "<question".to_owned(),
        "<method".into(),
        "n".into(),
        "mean ± sd".into(),
        format!("{} ± sd", options.baseline),
        format!("difference [{wide}]"),
        "t".into(),
        "p".into(),
        format!("d_z [{wide}]"),
        "power".into(),
        "TOST p, lower".into(),
        "TOST p, upper".into(),
        format!("interval of TOST, {narrow}"),
        "participants needed".into(),
    ];
    let mut tests = Table::new("Paired t-test, and TOST for equivalence", &columns);
    let mean = |sample: &Sample| format!("{:.2} ± {:.2}", sample.mean, sample.std);
    for q in &study.questions {
        let tost = q.equivalence;
        tests.push(vec![
            Cell::plain(&q.question),
            Cell::plain(&q.method),
            Cell::plain(q.difference.n.to_string()),
            Cell::ours(Some(mean(&q.ours))),
            Cell::base(Some(mean(&q.baseline))),
            Cell::ours(Some(format!("{:+.3}{}", q.difference.mean, interval(q.interval)))),
            Cell::plain(fixed(q.t, 4).unwrap_or("–".into())),
            Cell::ours(p_value(q.p)),
            Cell::plain(q.d_z.map(|d| format!("{d:.4}{}", interval(q.d_z_interval))).unwrap_or("–".into())),
            Cell::plain(fixed(q.power, 4).unwrap_or("–".into())),
            Cell::ours(p_value(tost.map(|t| t.p_lower))),
            Cell::ours(p_value(tost.map(|t| t.p_upper))),
            Cell::plain(tost.map(|t| interval(Some(t.interval)).trim().to_owned()).unwrap_or("–".into())),
            Cell::plain(q.needed.map(|n| n.to_string()).unwrap_or("–".into())),
        ]);
    }
    push_papers(&mut tests);
    tests.note = format!(
        "Bounds of equivalence: ±{} on a scale from {} to {}. Participants needed: for a true difference as large as \
         the bound, with a power of {}. The paper's interval is the one of 95 % (its t and n allow no other), its \
         difference the middle of it; it gives no means.",
        options.bound, options.scale[0], options.scale[1], options.power
    );
    let mut tables = vec![tests];
    tables.extend(Some(left_out(study)).filter(|table| !table.lines.is_empty()));
    tables
}

/// Adds the rows of the paper's study.
fn push_papers(tests: &mut Table) {
    let mut first = true;
    for printed in paper::STUDY {
        let [low, high] = printed.interval;
        let papers = |text: String| Cell::paper(Some(text));
        let cells = vec![
            papers(format!("the paper's: {}", printed.name)),
            papers("YORO".into()),
            papers(paper::STUDY_PARTICIPANTS.to_string()),
            Cell::paper(None::<String>),
            Cell::paper(None::<String>),
            papers(format!("{:+.3} [{low:.3}, {high:.3}]", (low + high) / 2.0)),
            papers(format!("{:.4}", printed.t)),
            papers(format!("{:.4}", printed.p)),
            papers(format!("{:.4}", printed.d_z)),
            papers(format!("{:.4}", printed.power)),
            papers(format!("{:.2e}", printed.p_lower)),
            papers(format!("{:.2e}", printed.p_upper)),
            Cell::paper(None::<String>),
            Cell::paper(None::<String>),
        ];
        tests.push_grouped(cells, std::mem::take(&mut first));
    }
}

/// Returns a table of the participants who were left out of a comparison, with the reason.
fn left_out(study: &Study) -> Table {
    let mut left_out = Table::new("Participants left out", &["<question", "<method", "<participant", "<why"]);
    for q in &study.questions {
        for excluded in &q.excluded {
            left_out.push(vec![
                Cell::plain(&q.question),
                Cell::plain(&q.method),
                Cell::plain(&excluded.participant),
                Cell::plain(&excluded.reason),
            ]);
        }
    }
    left_out
}

fn method_notes(study: &Study) -> Vec<String> {
    vec![
        "A participant gives one value for each method: the mean over the scenes. Differences are taken participant by \
         participant; whoever lacks a rating is left out of that comparison only, by name."
            .into(),
        format!(
            "The t-test asks whether the means differ, the two one-sided tests (TOST; Schuirmann 1987, Lakens 2017) \
             whether they differ by less than ±{}: a t-test that finds nothing is no proof of equality, TOST is. Both at \
             {}; p-values are not corrected for the number of questions.",
            study.options.bound, study.options.alpha
        ),
        "The power given is post hoc, from the effect found: it repeats what p says. Plan with the participants needed."
            .into(),
    ]
}

fn plots(study: &Study) -> Vec<Figure> {
    let options = &study.options;
    let mut found = Vec::new();
    let row = |q: &Question| DotRow {
        label: q.question.clone(),
        marks: vec![Mark {
            interval: q.equivalence.map(|tost| tost.interval),
            ..Mark::new(&q.method, &q.method, q.difference.mean)
        }],
    };
    let value = Axis::new(format!("difference from {}", options.baseline));
    found.push(Figure {
        id: "equivalence".into(),
        title: "Differences and the bounds of equivalence".into(),
        caption: format!(
            "Bars: {:.0} % intervals. Equivalent is what lies inside the outer lines, ±{}.",
            100.0 * (1.0 - 2.0 * options.alpha),
            options.bound
        ),
        panel: Panel::Dots {
            value: value.lines(&[-options.bound, 0.0, options.bound]),
            rows: study.questions.iter().map(row).collect(),
        },
    });
    for q in &study.questions {
        found.push(Figure {
            id: slug(&format!("{}-{}", q.question, q.method)),
            title: format!("{}: {} and {}", q.question, options.baseline, q.method),
            caption: "A thin line for each participant (mean over the scenes). Boxes: quartiles and median; whiskers: \
                      lowest and highest."
                .into(),
            panel: Panel::Paired {
                value: Axis::new("rating").lines(&options.scale),
                methods: vec![options.baseline.clone(), q.method.clone()],
                persons: q.participants.iter().map(|(_, ours, baseline)| vec![*baseline, *ours]).collect(),
            },
        });
    }
    found.retain(|figure| !figure.is_empty());
    found
}
