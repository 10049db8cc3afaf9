//! Plans of studies: scenes and methods in each participant's order.

use std::collections::BTreeMap;
use std::path::Path;

use rand::SeedableRng as _;
use rand::seq::SliceRandom as _;
use rand_pcg::Pcg32;
use serde::Serialize;

use crate::DataError;
use crate::latin_square::balanced_square;
use crate::table::csv_text;
use yoro_files as files;

/// A method of a study: a name and settings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// The method's name.
    pub name: String,
    /// Viewer settings of the method, without `scene`.
    pub settings: BTreeMap<String, String>,
}

/// One stimulus that a participant looks at and rates.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
struct Trial {
    /// The participant, `P01` and so on.
    participant: String,
    /// Place in the participant's order, from 1.
    trial: u32,
    scene: String,
    method: String,
    settings: BTreeMap<String, String>,
}

/// The orders of all participants.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Plan {
    seed: u64,
    /// Trials by participant, in the participant's order.
    trials: Vec<Trial>,
    /// Number of participants per balanced block. If the number of participants is a multiple of it, every scene
    /// follows every other scene equally often, and every method is equally often in each place.
    pub balanced_at: usize,
}

impl Plan {
    /// Plans a study in which each participant sees each scene with each method. All methods of a scene follow one
    /// another, so that the things to compare are close in time.
    ///
    /// The order of scenes is a balanced Latin square (Williams 1949), and so is the order of methods within a scene.
    /// Which scene, method and participant gets which row is drawn from the seed. The rows of the methods shift from
    /// scene to scene, so that no participant always starts with the same method.
    ///
    /// The settings of a trial name participant and trial for the log, hide the HUD, which shows the method, and make
    /// the viewer ask the `questions`, if there are any.
    pub fn new(
        participants: usize,
        scenes: &[String],
        methods: &[Condition],
        questions: &[String],
        seed: u64,
    ) -> Plan {
        let mut random = Pcg32::seed_from_u64(seed);
        let mut shuffled = |n: usize| {
            let mut order: Vec<usize> = (0..n).collect();
            order.shuffle(&mut random);
            order
        };
        let (scene_square, method_square) = (balanced_square(scenes.len()), balanced_square(methods.len()));
        let (scene_names, method_names) = (shuffled(scenes.len()), shuffled(methods.len()));
        // Drawn independently. Otherwise a scene's place would decide which of its methods comes first.
        let (scene_rows, method_rows) = (shuffled(participants), shuffled(participants));
        let shifts = shuffled(scenes.len());

        let width = participants.to_string().len().max(2);
        let mut trials = Vec::new();
        for (participant, (scene_row, method_row)) in scene_rows.into_iter().zip(method_rows).enumerate() {
            let (mut trial, participant) = (0, format!("P{:0width$}", participant + 1));
            for &place in &scene_square[scene_row % scene_square.len()] {
                let scene = scene_names[place];
                for &place in &method_square[(method_row + shifts[scene]) % method_square.len()] {
                    let method = &methods[method_names[place]];
                    trial += 1;
                    let mut settings = method.settings.clone();
                    settings.insert("scene".into(), scenes[scene].clone());
                    settings.insert("participant".into(), participant.clone());
                    settings.insert("trial".into(), trial.to_string());
                    settings.insert("hud".into(), "false".into());
                    if !questions.is_empty() {
                        settings.insert("questions".into(), questions.join(","));
                    }
                    trials.push(Trial {
                        participant: participant.clone(),
                        trial,
                        scene: scenes[scene].clone(),
                        method: method.name.clone(),
                        settings,
                    });
                }
            }
        }
        let balanced_at = least_common_multiple(scene_square.len(), method_square.len());
        Plan { seed, trials, balanced_at }
    }

    /// Returns the CSV table `participant,trial,scene,method,settings`. Settings are `key=value`, separated by spaces.
    pub fn to_csv(&self) -> String {
        let head = ["participant", "trial", "scene", "method", "settings"].map(str::to_owned);
        let rows = self.trials.iter().map(|trial| {
            let settings: Vec<String> =
                trial.settings.iter().map(|(key, value)| format!("{key}={value}")).collect();
            let Trial { participant, scene, method, .. } = trial.clone();
            [participant, trial.trial.to_string(), scene, method, settings.join(" ")]
        });
        csv_text(std::iter::once(head).chain(rows))
    }
}

/// Scene and method, by participant and number of the trial.
pub type Trials = BTreeMap<(String, u32), (String, String)>;

/// Reads the trials of a plan from its CSV table.
///
/// # Errors
/// [`DataError`], also if a column is missing or a row is damaged.
pub fn read_trials(path: &Path) -> Result<Trials, DataError> {
    let bytes = files::read(path)?;
    let damaged = |line: u64| {
        let path = path.display();
        DataError::Unusable(format!("{path}, line {line}: this is not a row of a plan: draw the plan again"))
    };
    let mut table = csv::Reader::from_reader(&bytes[..]);
    let header = table.headers().map_err(|_| damaged(1))?.clone();
    let names = ["participant", "trial", "scene", "method"];
    let at = names
        .map(|name| header.iter().position(|column| column == name))
        .into_iter()
        .collect::<Option<Vec<_>>>();
    let at = at.ok_or_else(|| damaged(1))?;
    let mut trials = Trials::new();
    for (row, line) in table.records().zip(2..) {
        let row = row.map_err(|_| damaged(line))?;
        let [participant, trial, scene, method] = [0, 1, 2, 3].map(|i| row[at[i]].to_owned());
        let trial = trial.parse().map_err(|_| damaged(line))?;
        trials.insert((participant, trial), (scene, method));
    }
    Ok(trials)
}

fn least_common_multiple(a: usize, b: usize) -> usize {
    let (mut x, mut y) = (a, b);
    while y > 0 {
        (x, y) = (y, x % y);
    }
    a / x.max(1) * b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(prefix: &str, n: usize) -> Vec<String> {
        (0..n).map(|i| format!("{prefix}{i}")).collect()
    }

    fn conditions(n: usize) -> Vec<Condition> {
        let condition = |name: String| Condition { settings: [("method".into(), name.clone())].into(), name };
        names("m", n).into_iter().map(condition).collect()
    }

    /// Counts how often each key occurs.
    fn counts<K: Ord>(keys: impl Iterator<Item = K>) -> BTreeMap<K, usize> {
        let mut counts = BTreeMap::new();
        for key in keys {
            *counts.entry(key).or_insert(0) += 1;
        }
        counts
    }

    fn all_equal(counts: &BTreeMap<impl Ord, usize>, keys: usize) -> bool {
        counts.len() == keys && counts.values().all(|count| Some(count) == counts.values().next())
    }

    #[test]
    fn every_participant_sees_everything_once() {
        let plan = Plan::new(14, &names("s", 8), &conditions(2), &[], 7);
        assert_eq!((plan.trials.len(), plan.balanced_at), (14 * 16, 8));
        for trials in plan.trials.chunk_by(|a, b| a.participant == b.participant) {
            assert!(trials.iter().map(|t| t.trial).eq(1..=16));
            assert!(all_equal(&counts(trials.iter().map(|t| (&t.scene, &t.method))), 16));
            for pair in trials.chunks(2) {
                assert_eq!(pair[0].scene, pair[1].scene, "the methods of a scene follow each other");
            }
            let first = counts(trials.iter().step_by(2).map(|t| &t.method));
            assert!(all_equal(&first, 2), "each method is first on half of the scenes: {first:?}");
            for trial in trials {
                assert_eq!(trial.settings["scene"], trial.scene);
                assert_eq!(trial.settings["method"], trial.method);
            }
        }
        // Each method is first for half of the participants on every scene.
        let first = counts(plan.trials.iter().step_by(2).map(|t| (&t.scene, &t.method)));
        assert!(all_equal(&first, 16), "{first:?}");
        assert_eq!(plan.trials.last().unwrap().participant, "P14");
    }

    #[test]
    fn sixteen_participants_balance_eight_scenes() {
        let plan = Plan::new(16, &names("s", 8), &conditions(2), &[], 3);
        let scenes: Vec<Vec<&String>> = plan
            .trials
            .chunk_by(|a, b| a.participant == b.participant)
            .map(|trials| trials.iter().step_by(2).map(|t| &t.scene).collect())
            .collect();
        let neighbours = scenes.iter().flat_map(|order| order.windows(2).map(|pair| (pair[0], pair[1])));
        assert!(all_equal(&counts(neighbours), 56));
        let places = scenes.iter().flat_map(|order| order.iter().enumerate());
        assert!(all_equal(&counts(places), 64));
        // The place of a scene does not decide which method comes first.
        let first = counts(plan.trials.iter().step_by(2).map(|t| (t.trial, &t.method)));
        assert_eq!(first.len(), 16, "{first:?}");
    }

    #[test]
    fn the_same_seed_gives_the_same_plan() {
        let plan = |seed| Plan::new(5, &names("s", 3), &conditions(3), &names("q", 2), seed);
        assert_eq!(plan(1), plan(1));
        assert_ne!(plan(1).trials, plan(2).trials);
        let csv = plan(1).to_csv();
        assert_eq!(csv.lines().count(), 1 + 5 * 9);
        assert!(csv.starts_with("participant,trial,scene,method,settings\nP01,1,"), "{csv}");
        let first = csv.lines().nth(1).unwrap();
        for needed in ["method=m", "participant=P01", "trial=1", "hud=false", "questions=q0,q1"] {
            assert!(first.contains(needed), "{needed}: {first}");
        }
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("plan.csv");
        std::fs::write(&path, csv).unwrap();
        let read = read_trials(&path).unwrap();
        for trial in plan(1).trials {
            assert_eq!(read[&(trial.participant, trial.trial)], (trial.scene, trial.method));
        }
        std::fs::write(&path, "participant,trial,scene,method\nP01,x,s,m\n").unwrap();
        assert!(read_trials(&path).unwrap_err().to_string().contains("plan.csv, line 2"));
    }
}
