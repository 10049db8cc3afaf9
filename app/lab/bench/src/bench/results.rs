//! The measurements of result files, collected by suite, setting and contender.

use std::collections::BTreeMap;

use super::record::{Conditions, Header, Results, SceneFacts, metric};
use yoro_report::stats::{Summary, geometric_mean, mean, median, percentile, unique};

/// The name of the contender that costs are compared with: two full renders.
pub const CONVENTIONAL: &str = "conventional";
/// The name of the baseline for quality: the same image for both eyes.
pub const MONO: &str = "mono";

/// One suite as measured under one set of conditions.
pub struct SuiteData {
    /// Its name.
    pub name: String,
    /// Machine, command and parameters; those of the first file if several are combined, without its `--shard`.
    pub header: Header,
    /// The settings in the order of measurement.
    pub settings: Vec<SettingData>,
}

/// One setting of a suite.
pub struct SettingData {
    /// Suite, scene, and the point of a sweep.
    pub conditions: Conditions,
    /// Triangles, style and frames; `None` if the file does not have them.
    pub facts: Option<SceneFacts>,
    /// The contenders in the order of measurement.
    pub contenders: Vec<Measured>,
    /// The contenders that could not take part, with the reasons.
    pub unsupported: Vec<(String, String)>,
}

/// Values by metric: one number per frame.
type Values = BTreeMap<String, Vec<Option<f64>>>;

/// All rounds of a contender in one setting.
pub struct Measured {
    /// Its name.
    pub name: String,
    /// The number of each round, with the values by metric.
    rounds: Vec<(u32, Values)>,
}

/// Median and quartiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The value that half of the samples are below.
    pub median: f64,
    /// The values that a quarter and three quarters of the samples are below.
    pub quartiles: [f64; 2],
}

impl Spread {
    fn of(samples: &[f64]) -> Option<Spread> {
        let at = |percent| percentile(samples, percent);
        Some(Spread { median: at(50.0)?, quartiles: [at(25.0)?, at(75.0)?] })
    }
}

impl Measured {
    /// Returns the finite values of a metric in all rounds and frames.
    pub fn samples(&self, metric: &str) -> Vec<f64> {
        let values = self.rounds.iter().filter_map(|(_, values)| values.get(metric));
        values.flatten().filter_map(|value| *value).filter(|value| value.is_finite()).collect()
    }

    /// Returns the names of the metrics with values.
    pub fn metrics(&self) -> impl Iterator<Item = &str> {
        self.rounds.iter().flat_map(|(_, values)| values.keys()).map(String::as_str)
    }

    /// Returns the mean of [`Measured::samples`]. Identical images have no finite PSNR and do not count.
    pub fn mean(&self, metric: &str) -> Option<f64> {
        mean(self.samples(metric))
    }

    /// Returns the statistics of [`Measured::samples`].
    pub fn summary(&self, metric: &str) -> Option<Summary> {
        Summary::of(&self.samples(metric))
    }

    /// Returns the median of [`Measured::samples`].
    pub fn median(&self, metric: &str) -> Option<f64> {
        median(&self.samples(metric))
    }

    /// Returns the ratio of the metric to the baseline's, frame by frame within each round: a temporary slowdown of the
    /// machine affects both.
    pub fn ratio(&self, baseline: &Measured, metric: &str) -> Option<Spread> {
        let mut ratios = Vec::new();
        for (round, values) in &self.rounds {
            let Some((_, base)) = baseline.rounds.iter().find(|(other, _)| other == round) else { continue };
            let (Some(ours), Some(base)) = (values.get(metric), base.get(metric)) else { continue };
            let pairs = ours.iter().zip(base).filter_map(|(a, b)| Some(a.as_ref()? / b.as_ref()?));
            ratios.extend(pairs.filter(|ratio| ratio.is_finite()));
        }
        Spread::of(&ratios)
    }
}

impl SettingData {
    /// Returns the measurements of a contender.
    pub fn find(&self, contender: &str) -> Option<&Measured> {
        self.contenders.iter().find(|measured| measured.name == contender)
    }

    /// Returns the time of a stereo frame divided by that of two full renders.
    pub fn cost(&self, contender: &str) -> Option<Spread> {
        self.find(contender)?.ratio(self.find(CONVENTIONAL)?, metric::FRAME_MS)
    }

    /// Returns the name for tables: the scene, and the point of a sweep.
    pub fn label(&self) -> String {
        let Conditions { suite, scene, label, point } = &self.conditions;
        match (label, point) {
            (Some(label), _) => format!("{scene}, {label}"),
            // All settings of this suite have the same number of lights.
            (None, Some(_)) if suite == "lights" => scene.clone(),
            (None, Some(point)) => format!("{scene}, {point}"),
            (None, None) => scene.clone(),
        }
    }

    /// Returns the paper's scene that it corresponds to, or an empty text.
    pub fn stands_for(&self) -> &str {
        self.facts.as_ref().map_or("", |facts| &facts.stands_for)
    }
}

impl SuiteData {
    /// Returns the names of all contenders, measured or not, in the order of measurement.
    pub fn contenders(&self) -> Vec<&str> {
        let measured = self.settings.iter().flat_map(|s| s.contenders.iter().map(|m| m.name.as_str()));
        let refused = self.settings.iter().flat_map(|s| s.unsupported.iter().map(|(name, _)| name.as_str()));
        unique(measured.chain(refused))
    }

    /// Returns the names of the contenders with values of a metric.
    pub fn measured(&self, metric: &str) -> Vec<&str> {
        let has = |name: &&str| {
            self.settings.iter().any(|s| s.find(name).is_some_and(|m| !m.samples(metric).is_empty()))
        };
        self.contenders().into_iter().filter(has).collect()
    }

    /// Returns the same names without two full renders, which the others are compared with.
    pub fn compared(&self, metric: &str) -> Vec<&str> {
        self.measured(metric).into_iter().filter(|name| *name != CONVENTIONAL).collect()
    }

    /// Returns the reason if a contender took part in no setting.
    pub fn reason(&self, contender: &str) -> Option<&str> {
        if self.settings.iter().any(|setting| setting.find(contender).is_some()) {
            return None;
        }
        let mut refused = self.settings.iter().flat_map(|setting| &setting.unsupported);
        refused.find(|(name, _)| name == contender).map(|(_, reason)| reason.as_str())
    }

    /// Returns a contender's value in each setting that has one.
    pub fn values(&self, contender: &str, value: impl Fn(&Measured) -> Option<f64>) -> Vec<f64> {
        self.settings.iter().filter_map(|setting| value(setting.find(contender)?)).collect()
    }

    /// Returns a contender's mean of a metric: the mean over the settings' means.
    pub fn mean(&self, contender: &str, metric: &str) -> Option<f64> {
        mean(self.values(contender, |measured| measured.mean(metric)))
    }

    /// Returns the same over the settings with a label.
    pub fn mean_at(&self, label: &str, contender: &str, metric: &str) -> Option<f64> {
        mean(self.labelled(label).filter_map(|setting| setting.find(contender)?.mean(metric)))
    }

    /// Returns a contender's frame time divided by that of two full renders: the geometric mean over the settings.
    pub fn mean_cost(&self, contender: &str) -> Option<f64> {
        geometric_mean(self.settings.iter().filter_map(|setting| Some(setting.cost(contender)?.median)))
    }

    /// Returns the points of a sweep in ascending order, each once.
    pub fn points(&self) -> Vec<f64> {
        let mut points: Vec<f64> =
            self.settings.iter().filter_map(|setting| setting.conditions.point).collect();
        points.sort_by(f64::total_cmp);
        points.dedup();
        points
    }

    /// Returns the labels of a sweep over something without numbers, in order.
    pub fn labels(&self) -> Vec<&str> {
        unique(self.settings.iter().filter_map(|setting| setting.conditions.label.as_deref()))
    }

    /// Returns the settings with a label.
    pub fn labelled<'a>(&'a self, label: &'a str) -> impl Iterator<Item = &'a SettingData> {
        self.settings.iter().filter(move |setting| setting.conditions.label.as_deref() == Some(label))
    }

    /// Returns the scenes, in order.
    pub fn scenes(&self) -> Vec<&str> {
        unique(self.settings.iter().map(|setting| setting.conditions.scene.as_str()))
    }

    /// Returns a curve over the points of a sweep, with the mean over the scenes at each.
    pub fn curve(&self, value: impl Fn(&SettingData) -> Option<f64>) -> Vec<(f64, f64)> {
        let at = |point: f64| {
            let here = self.settings.iter().filter(|setting| setting.conditions.point == Some(point));
            mean(here.filter_map(&value))
        };
        self.points().into_iter().filter_map(|point| Some((point, at(point)?))).collect()
    }
}

/// True if the figures of two files may be combined in one table.
fn same_conditions(a: &Header, b: &Header) -> bool {
    let (m, n) = (&a.machine, &b.machine);
    a.parameters == b.parameters
        && a.quick == b.quick
        && (&m.cpu, m.cores, &m.gl_renderer, &m.gl_version)
            == (&n.cpu, n.cores, &n.gl_renderer, &n.gl_version)
}

/// Returns the suites of all files, in the order of the files. A suite that was measured under several conditions
/// occurs once for each.
pub fn suites(files: &[Results]) -> Vec<SuiteData> {
    let mut suites: Vec<SuiteData> = Vec::new();
    for file in files {
        // The numbers of rounds continue from those of earlier files with the same settings.
        let mut first_round: BTreeMap<String, u32> = BTreeMap::new();
        let settings = file.scenes().map(|facts| &facts.conditions);
        let settings = settings.chain(file.measurements().map(|m| &m.conditions));
        let settings: Vec<&Conditions> = settings.chain(file.unsupported().map(|u| &u.conditions)).collect();
        for setting in settings {
            let key = format!("{setting:?}");
            if first_round.contains_key(&key) {
                continue;
            }
            let data = entry(&mut suites, &file.header, setting);
            let rounds = data.contenders.iter().flat_map(|m| &m.rounds).map(|(round, _)| round + 1);
            first_round.insert(key, rounds.max().unwrap_or(0));
        }
        for facts in file.scenes() {
            entry(&mut suites, &file.header, &facts.conditions).facts.get_or_insert_with(|| facts.clone());
        }
        for measurement in file.measurements() {
            let first = first_round.get(&format!("{:?}", measurement.conditions)).copied().unwrap_or(0);
            let data = entry(&mut suites, &file.header, &measurement.conditions);
            let at = data.contenders.iter().position(|m| m.name == measurement.contender);
            let at = at.unwrap_or_else(|| {
                data.contenders.push(Measured { name: measurement.contender.clone(), rounds: Vec::new() });
                data.contenders.len() - 1
            });
            data.contenders[at].rounds.push((first + measurement.round, measurement.values.clone()));
        }
        for refused in file.unsupported() {
            let data = entry(&mut suites, &file.header, &refused.conditions);
            if !data.unsupported.iter().any(|(name, _)| *name == refused.contender) {
                data.unsupported.push((refused.contender.clone(), refused.reason.clone()));
            }
        }
    }
    suites
}

/// Returns a command that measures all parts of the work, given that of one part.
fn without_shard(command: &str) -> String {
    let mut words: Vec<&str> = command.split(' ').collect();
    while let Some(at) = words.iter().position(|word| *word == "--shard" || word.starts_with("--shard=")) {
        let count = if words[at] == "--shard" { 2 } else { 1 };
        words.drain(at..(at + count).min(words.len()));
    }
    words.join(" ")
}

fn entry<'a>(
    suites: &'a mut Vec<SuiteData>,
    header: &Header,
    conditions: &Conditions,
) -> &'a mut SettingData {
    let found = suites.iter().position(|s| s.name == conditions.suite && same_conditions(&s.header, header));
    let suite = found.unwrap_or_else(|| {
        suites.push(SuiteData {
            name: conditions.suite.clone(),
            header: header.clone(),
            settings: Vec::new(),
        });
        suites.len() - 1
    });
    let command = &mut suites[suite].header.machine.command;
    if *command != header.machine.command {
        *command = without_shard(command);
    }
    let settings = &mut suites[suite].settings;
    let found = settings.iter().position(|s| s.conditions == *conditions);
    let index = found.unwrap_or_else(|| {
        let conditions = conditions.clone();
        settings.push(SettingData {
            conditions,
            facts: None,
            contenders: Vec::new(),
            unsupported: Vec::new(),
        });
        settings.len() - 1
    });
    &mut settings[index]
}
