//! Ratings of participants, from a table or from logs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::plan::Trials;
use crate::DataError;
use crate::log::{self, Kind};
use crate::table::{csv_mistake, csv_text};
use yoro_files as files;
use yoro_settings::telemetry::{LOG_TAG, Rating};

/// The columns of a table of ratings. Others are ignored.
const COLUMNS: [&str; 5] = ["participant", "method", "scene", "question", "rating"];

/// One answer.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub participant: String,
    pub method: String,
    pub scene: String,
    pub question: String,
    pub rating: f64,
}

/// A table of ratings.
#[derive(Clone, Debug, PartialEq)]
pub struct Ratings {
    pub(super) path: PathBuf,
    /// The ratings, at most one per participant, method, scene and question.
    pub(super) rows: Vec<Row>,
}

impl Ratings {
    /// Reads a CSV table with a header. The order of the columns does not matter.
    ///
    /// # Errors
    /// [`DataError`], also if a rating is not a number, lies outside `scale`, or occurs twice.
    pub fn read(path: &Path, scale: [f64; 2]) -> Result<Ratings, DataError> {
        let bytes = files::read(path)?;
        // Excel starts files with a byte order mark.
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&bytes);
        let mut table = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
        let shown = path.display();
        let row_error =
            |line: u64, what: String| DataError::Unusable(format!("{shown}, line {line}: {what}"));
        let csv_error = |error: csv::Error| {
            let (line, what) = csv_mistake(&error);
            row_error(line, format!("{what}: correct the row"))
        };
        let header = table.headers().map_err(csv_error)?.clone();
        let mut at = [0; COLUMNS.len()];
        for (place, column) in at.iter_mut().zip(COLUMNS) {
            *place = header.iter().position(|name| name.eq_ignore_ascii_case(column)).ok_or_else(|| {
                let columns = COLUMNS.join(", ");
                DataError::Unusable(format!("{shown}: there is no column \"{column}\": it needs {columns}"))
            })?;
        }
        let mut rows = Vec::new();
        let mut lines: BTreeMap<[String; 4], u64> = BTreeMap::new();
        for record in table.records() {
            let record = record.map_err(csv_error)?;
            let line = record.position().map_or(0, csv::Position::line);
            let [participant, method, scene, question, text] = at.map(|place| record[place].to_owned());
            let key = [participant, method, scene, question];
            if let Some(empty) = key.iter().position(String::is_empty) {
                return Err(row_error(
                    line,
                    format!("the column \"{}\" is empty: fill it in", COLUMNS[empty]),
                ));
            }
            let [low, high] = scale;
            let rating = text.parse::<f64>().ok().filter(|rating| (low..=high).contains(rating));
            let rating = rating.ok_or_else(|| {
                let remedy = "correct it, remove the row, or give another scale";
                row_error(line, format!("\"{text}\" is not a rating from {low} to {high}: {remedy}"))
            })?;
            if let Some(before) = lines.insert(key.clone(), line) {
                let [participant, method, scene, question] = key;
                let what = format!(
                    "{participant} has rated {question} of {method} on {scene} in line {before} already: keep one of \
                     the two"
                );
                return Err(row_error(line, what));
            }
            let [participant, method, scene, question] = key;
            rows.push(Row { participant, method, scene, question, rating });
        }
        if rows.is_empty() {
            return Err(DataError::Unusable(format!("{shown}: there is no rating in it: add rows")));
        }
        Ok(Ratings { path: path.into(), rows })
    }
}

/// Ratings found in logs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Collected {
    /// The last rating of each participant, trial and question. All have a participant.
    pub ratings: Vec<Rating>,
    /// Number of ratings that were replaced by later ones.
    pub replaced: usize,
    /// Name of the log, line number from 1, and what is wrong with the line.
    pub damaged: Vec<(String, usize, String)>,
}

impl Collected {
    /// Adds the ratings in a log and ignores all other lines. If the trials of a plan are given (see
    /// [`read_trials`](super::read_trials)), methods get the plan's names.
    pub fn add(&mut self, name: &str, log: &str, plan: Option<&Trials>) {
        for (index, line) in log.lines().enumerate() {
            let found = match log::parse(line) {
                Kind::Entry(entry) if entry.tag == LOG_TAG && Rating::is_line(entry.message) => entry.message,
                Kind::Damaged if line.contains("rating,v=") => line,
                _ => continue,
            };
            let rating = found.parse::<Rating>().map_err(|error| error.to_string());
            match rating.and_then(|rating| planned(rating, plan)) {
                Err(what) => self.damaged.push((name.into(), index + 1, what)),
                Ok(rating) => {
                    let same = |other: &Rating| Rating { rating: rating.rating, ..other.clone() } == rating;
                    match self.ratings.iter_mut().find(|other| same(other)) {
                        None => self.ratings.push(rating),
                        Some(other) => {
                            self.replaced += usize::from(*other != rating);
                            *other = rating;
                        }
                    }
                }
            }
        }
    }

    /// Returns the table that [`Ratings::read`] reads, with the trials as a further column. A method that was rated
    /// with several pipelines becomes several methods.
    pub fn to_csv(&self) -> String {
        let mut pipelines: BTreeMap<&str, BTreeSet<Option<&str>>> = BTreeMap::new();
        for rating in &self.ratings {
            pipelines.entry(&rating.method).or_default().insert(rating.pipeline.as_deref());
        }
        let head = ["participant", "trial", "method", "scene", "question", "rating"].map(str::to_owned);
        let rows = self.ratings.iter().map(|r| {
            let method = match &r.pipeline {
                Some(pipeline) if pipelines[r.method.as_str()].len() > 1 => {
                    format!("{}-{pipeline}", r.method)
                }
                _ => r.method.clone(),
            };
            let trial = r.trial.map(|trial| trial.to_string()).unwrap_or_default();
            let participant = r.participant.clone().unwrap_or_default();
            [participant, trial, method, r.scene.clone(), r.question.clone(), r.rating.to_string()]
        });
        csv_text(std::iter::once(head).chain(rows))
    }
}

/// Returns a rating with the plan's names. The error is the reason why it is not part of the study.
fn planned(rating: Rating, plan: Option<&Trials>) -> Result<Rating, String> {
    let Some(participant) = rating.participant.clone() else {
        return Err("the rating names no participant: set participant in the viewer".into());
    };
    let Some(plan) = plan else { return Ok(rating) };
    let key = (participant, rating.trial.unwrap_or_default());
    match plan.get(&key) {
        None => Err(format!("the plan has no trial {} of {}", key.1, key.0)),
        Some((scene, _)) if *scene != rating.scene => {
            Err(format!("in trial {} of {} the plan has {scene}, not {}", key.1, key.0, rating.scene))
        }
        Some((_, method)) => Ok(Rating { method: method.clone(), pipeline: None, ..rating }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Ratings, String> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("ratings.csv");
        std::fs::write(&path, text).unwrap();
        Ratings::read(&path, [1.0, 5.0]).map_err(|error| error.to_string())
    }

    #[test]
    fn columns_are_found_by_name() {
        let ratings =
            read("\u{FEFF}Rating, question,participant,extra,scene,method\n4.5, q ,P01,x,street,yoro\n")
                .unwrap();
        let row = Row {
            participant: "P01".into(),
            method: "yoro".into(),
            scene: "street".into(),
            question: "q".into(),
            rating: 4.5,
        };
        assert_eq!(ratings.rows, [row]);
    }

    #[test]
    fn mistakes_are_named() {
        let head = "participant,method,scene,question,rating\n";
        for (text, naming) in [
            ("participant,method,scene,rating\n", "no column \"question\""),
            (head, "no rating in it"),
            (&format!("{head}P1,yoro,street,q,five\n"), "line 2: \"five\" is not a rating from 1 to 5"),
            (&format!("{head}P1,yoro,street,q,5.5\n"), "5.5"),
            (&format!("{head}P1,yoro,street,q,NaN\n"), "NaN"),
            (&format!("{head}P1,yoro,,q,5\n"), "\"scene\" is empty"),
            (&format!("{head}P1,yoro,street,q\n"), "4 cells where the header has 5"),
            (
                &format!("{head}P1,yoro,street,q,5\nP1,yoro,street,q,4\n"),
                "line 3: P1 has rated q of yoro on street in line 2",
            ),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(naming), "{naming}: {error}");
        }
    }

    #[test]
    fn logs_give_ratings_and_name_damage() {
        let line = |trial: u32, pipeline: &str, value: &str| {
            format!(
                "11-21 10:00:01.000  4242  4260 I YORO    : rating,v=2,participant=P01,trial={trial},method=yoro,\
                 pipeline={pipeline},scene=street,question=q,value={value}\n"
            )
        };
        let log = [
            "11-21 10:00:01.000  4242  4260 I YORO    : v=2,t=1.0s\n".to_owned(),
            line(1, "gather", "3.0"),
            line(2, "paper", "4.0"),
            line(1, "gather", "3.5"),
            line(3, "paper", "4."),
            line(4, "paper", "4.0").replace("P01", "na"),
            "11-21 10:00:01.000 rating,v=1\n".to_owned(),
        ];
        let mut collected = Collected::default();
        collected.add("log.txt", &log.concat(), None);
        let found: Vec<(u32, f64)> = collected.ratings.iter().map(|r| (r.trial.unwrap(), r.rating)).collect();
        assert_eq!((found, collected.replaced), (vec![(1, 3.5), (2, 4.0)], 1));
        let lines: Vec<usize> = collected.damaged.iter().map(|(_, line, _)| *line).collect();
        assert_eq!(lines, [5, 6, 7], "{:?}", collected.damaged);
        let csv = collected.to_csv();
        assert!(csv.contains("P01,1,yoro-gather,street,q,3.5\nP01,2,yoro-paper,street,q,4\n"), "{csv}");

        let trial = |number: u32, scene: &str, method: &str| {
            (("P01".to_owned(), number), (scene.to_owned(), method.to_owned()))
        };
        let plan = [trial(1, "street", "ours"), trial(2, "atrium", "paper's")].into();
        let mut planned = Collected::default();
        planned.add(
            "log.txt",
            &(line(1, "gather", "3.0") + &line(2, "paper", "4.0") + &line(9, "paper", "4.0")),
            Some(&plan),
        );
        assert_eq!(planned.to_csv().lines().nth(1), Some("P01,1,ours,street,q,3"));
        let reasons: Vec<&str> = planned.damaged.iter().map(|(_, _, what)| what.as_str()).collect();
        assert_eq!(
            reasons,
            ["in trial 2 of P01 the plan has atrium, not street", "the plan has no trial 9 of P01"]
        );
    }
}
