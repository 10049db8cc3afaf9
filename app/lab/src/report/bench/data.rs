//! The figures of result files, put together by suite, setting and contender.

use std::collections::BTreeMap;

use crate::bench::record::{Header, Results, SceneFacts, Setting, metric};
use yoro_figures::stats::{Summary, geometric_mean, mean, median, percentile, unique};

/// The name of the contender that costs are relative to: two full renders.
pub const CONVENTIONAL: &str = "conventional";
/// The name of the baseline of quality: the same image to both eyes.
pub const MONO: &str = "mono";

/// One suite as measured under one set of conditions.
pub struct Suite {
    /// Its name.
    pub name: String,
    /// Machine, command, parameters; of the first file where several go together.
    pub header: Header,
    /// Settings in the order of measurement.
    pub settings: Vec<SettingData>,
}

/// One setting of a suite.
pub struct SettingData {
    /// Suite, scene, and the point of a sweep.
    pub setting: Setting,
    /// Triangles, style, frames; none if the file does not say.
    pub facts: Option<SceneFacts>,
    /// Contenders in the order of measurement.
    pub contenders: Vec<Measured>,
    /// Contenders that could not take part, with the reason.
    pub unsupported: Vec<(String, String)>,
}

/// Values by metric: a number for each frame.
type Values = BTreeMap<String, Vec<Option<f64>>>;

/// All rounds of a contender in a setting.
pub struct Measured {
    /// Its name.
    pub name: String,
    /// Number of the round and values by metric.
    rounds: Vec<(u32, Values)>,
}

/// Median and quartiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Half of the samples are below.
    pub median: f64,
    /// A quarter and three quarters of the samples are below.
    pub quartiles: [f64; 2],
}

impl Spread {
    fn of(samples: &[f64]) -> Option<Spread> {
        let at = |percent| percentile(samples, percent);
        Some(Spread { median: at(50.0)?, quartiles: [at(25.0)?, at(75.0)?] })
    }
}

impl Measured {
    /// The finite values of a metric, all rounds and frames.
    pub fn samples(&self, metric: &str) -> Vec<f64> {
        let values = self.rounds.iter().filter_map(|(_, values)| values.get(metric));
        values.flatten().filter_map(|value| *value).filter(|value| value.is_finite()).collect()
    }

    /// The values of a metric in the first round, in the order of the setting's frames.
    pub fn by_frame(&self, metric: &str) -> &[Option<f64>] {
        self.rounds.iter().find_map(|(_, values)| values.get(metric)).map_or(&[], Vec::as_slice)
    }

    /// Returns the names of the metrics that it has values of.
    pub fn metrics(&self) -> impl Iterator<Item = &str> {
        self.rounds.iter().flat_map(|(_, values)| values.keys()).map(String::as_str)
    }

    /// The mean of those values. Identical images have no finite PSNR and do not count.
    pub fn mean(&self, metric: &str) -> Option<f64> {
        mean(self.samples(metric))
    }

    /// The statistics of those values.
    pub fn summary(&self, metric: &str) -> Option<Summary> {
        Summary::of(&self.samples(metric))
    }

    /// The median of those values.
    pub fn median(&self, metric: &str) -> Option<f64> {
        median(&self.samples(metric))
    }

    /// The metric over the baseline's, frame by frame within each round: what slows a machine down for a while
    /// meets both.
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

    /// Returns the measurements of two full renders.
    pub fn conventional(&self) -> Option<&Measured> {
        self.find(CONVENTIONAL)
    }

    /// The time of a stereo frame over that of two full renders.
    pub fn cost(&self, contender: &str) -> Option<Spread> {
        self.find(contender)?.ratio(self.conventional()?, metric::FRAME_MS)
    }

    /// Returns a name for tables: the scene, and the point of a sweep.
    pub fn label(&self) -> String {
        let Setting { suite, scene, label, point } = &self.setting;
        match (label, point) {
            (Some(label), _) => format!("{scene}, {label}"),
            // All of them have the same few lights.
            (None, Some(_)) if suite == "lights" => scene.clone(),
            (None, Some(point)) => format!("{scene}, {point}"),
            (None, None) => scene.clone(),
        }
    }

    /// The paper's scene that it stands for; empty if for none.
    pub fn stands_for(&self) -> &str {
        self.facts.as_ref().map_or("", |facts| &facts.stands_for)
    }
}

impl Suite {
    /// Returns the names of the contenders, measured or not, in the order of measurement.
    pub fn contenders(&self) -> Vec<&str> {
        let measured = self.settings.iter().flat_map(|s| s.contenders.iter().map(|m| m.name.as_str()));
        let refused = self.settings.iter().flat_map(|s| s.unsupported.iter().map(|(name, _)| name.as_str()));
        unique(measured.chain(refused))
    }

    /// Returns the names of the contenders for which a metric was measured.
    pub fn measured(&self, metric: &str) -> Vec<&str> {
        let has = |name: &&str| {
            self.settings.iter().any(|s| s.find(name).is_some_and(|m| !m.samples(metric).is_empty()))
        };
        self.contenders().into_iter().filter(has).collect()
    }

    /// The same without two full renders, which the others are compared with.
    pub fn compared(&self, metric: &str) -> Vec<&str> {
        self.measured(metric).into_iter().filter(|name| *name != CONVENTIONAL).collect()
    }

    /// Returns the reason if a contender could take part nowhere.
    pub fn reason(&self, contender: &str) -> Option<&str> {
        if self.settings.iter().any(|setting| setting.find(contender).is_some()) {
            return None;
        }
        let mut refused = self.settings.iter().flat_map(|setting| &setting.unsupported);
        refused.find(|(name, _)| name == contender).map(|(_, reason)| reason.as_str())
    }

    /// Returns a contender's value in each setting, where it has one.
    pub fn values(&self, contender: &str, value: impl Fn(&Measured) -> Option<f64>) -> Vec<f64> {
        self.settings.iter().filter_map(|setting| value(setting.find(contender)?)).collect()
    }

    /// The mean over the settings of a contender's means of a metric.
    pub fn mean(&self, contender: &str, metric: &str) -> Option<f64> {
        mean(self.values(contender, |measured| measured.mean(metric)))
    }

    /// The geometric mean over the settings of a contender's frame time over two full renders.
    pub fn mean_cost(&self, contender: &str) -> Option<f64> {
        geometric_mean(self.settings.iter().filter_map(|setting| Some(setting.cost(contender)?.median)))
    }

    /// The points of a sweep, ascending, each once.
    pub fn points(&self) -> Vec<f64> {
        let mut points: Vec<f64> = self.settings.iter().filter_map(|setting| setting.setting.point).collect();
        points.sort_by(f64::total_cmp);
        points.dedup();
        points
    }

    /// Returns the labels of a sweep that has no numbers, in order.
    pub fn labels(&self) -> Vec<&str> {
        unique(self.settings.iter().filter_map(|setting| setting.setting.label.as_deref()))
    }

    /// Returns the scenes, in order.
    pub fn scenes(&self) -> Vec<&str> {
        unique(self.settings.iter().map(|setting| setting.setting.scene.as_str()))
    }

    /// Returns a curve over the points: at each the mean over the scenes.
    pub fn curve(&self, value: impl Fn(&SettingData) -> Option<f64>) -> Vec<(f64, f64)> {
        let at = |point: f64| {
            let here = self.settings.iter().filter(|setting| setting.setting.point == Some(point));
            mean(here.filter_map(&value))
        };
        self.points().into_iter().filter_map(|point| Some((point, at(point)?))).collect()
    }
}

/// True if figures of two files may stand in one table.
fn same_conditions(a: &Header, b: &Header) -> bool {
    let (m, n) = (&a.machine, &b.machine);
    a.parameters == b.parameters
        && a.quick == b.quick
        && (&m.cpu, m.cores, &m.gl_renderer, &m.gl_version)
            == (&n.cpu, n.cores, &n.gl_renderer, &n.gl_version)
}

/// The suites of all files, in the order of the files. A suite measured under several conditions is there several
/// times.
pub fn suites(files: &[Results]) -> Vec<Suite> {
    let mut suites: Vec<Suite> = Vec::new();
    for file in files {
        // Rounds of another file with the same settings go on counting.
        let mut first_round: BTreeMap<String, u32> = BTreeMap::new();
        let settings = file.scenes().map(|facts| &facts.setting);
        let settings = settings.chain(file.measurements().map(|m| &m.setting));
        let settings: Vec<&Setting> = settings.chain(file.unsupported().map(|u| &u.setting)).collect();
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
            entry(&mut suites, &file.header, &facts.setting).facts.get_or_insert_with(|| facts.clone());
        }
        for measurement in file.measurements() {
            let first = first_round.get(&format!("{:?}", measurement.setting)).copied().unwrap_or(0);
            let data = entry(&mut suites, &file.header, &measurement.setting);
            let at = data.contenders.iter().position(|m| m.name == measurement.contender);
            let at = at.unwrap_or_else(|| {
                data.contenders.push(Measured { name: measurement.contender.clone(), rounds: Vec::new() });
                data.contenders.len() - 1
            });
            data.contenders[at].rounds.push((first + measurement.round, measurement.values.clone()));
        }
        for refused in file.unsupported() {
            let data = entry(&mut suites, &file.header, &refused.setting);
            if !data.unsupported.iter().any(|(name, _)| *name == refused.contender) {
                data.unsupported.push((refused.contender.clone(), refused.reason.clone()));
            }
        }
    }
    suites
}

fn entry<'a>(suites: &'a mut Vec<Suite>, header: &Header, setting: &Setting) -> &'a mut SettingData {
    let found = suites.iter().position(|s| s.name == setting.suite && same_conditions(&s.header, header));
    let suite = found.unwrap_or_else(|| {
        suites.push(Suite { name: setting.suite.clone(), header: header.clone(), settings: Vec::new() });
        suites.len() - 1
    });
    let settings = &mut suites[suite].settings;
    let found = settings.iter().position(|s| s.setting == *setting);
    let index = found.unwrap_or_else(|| {
        let setting = setting.clone();
        settings.push(SettingData { setting, facts: None, contenders: Vec::new(), unsupported: Vec::new() });
        settings.len() - 1
    });
    &mut settings[index]
}
