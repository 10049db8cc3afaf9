//! Means of methods, and their comparisons with the baseline.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::Device;
use super::run::{Quantity, Run};
use yoro_report::stats::{Sample, mean_of_blocks};

/// The mean of a method in a scene over all runs that count.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mean {
    pub device: String,
    pub scene: String,
    pub method: String,
    pub quantity: Quantity,
    #[serde(flatten)]
    pub sample: Sample,
}

/// The comparison of a method with the baseline, by pairs of runs of the same device, scene and repetition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    pub device: String,
    /// Scene, or `None` for the mean of all scenes.
    pub scene: Option<String>,
    pub method: String,
    pub quantity: Quantity,
    pub pairs: usize,
    /// The number of scenes that the pairs are of.
    pub scenes: usize,
    /// Mean of the method over the pairs of each scene, then over the scenes.
    pub ours: f64,
    pub baseline: f64,
    /// Change in percent, from the geometric mean of the pairs' ratios. For quantities that are not compared by ratios,
    /// the mean difference in the quantity's unit.
    pub change: f64,
    /// Ends of the change's interval. `None` if nothing was repeated.
    pub interval: Option<[f64; 2]>,
}

impl Difference {
    /// True if every scene was measured once, so that the interval rests on the scatter of the scenes.
    pub fn rests_on_scenes(&self) -> bool {
        self.pairs == self.scenes
    }
}

/// Returns the means of all methods and scenes on a device.
pub fn means(runs: &[Run], device: &Device) -> Vec<Mean> {
    let mut means = Vec::new();
    for scene in &device.scenes {
        for method in &device.methods {
            let of =
                || device.runs(runs).filter(|run| run.info.scene == *scene && run.info.method == *method);
            for quantity in Quantity::ALL {
                let values: Vec<f64> = of().filter_map(|run| run.values.get(&quantity).copied()).collect();
                means.extend(Sample::of(&values).map(|sample| Mean {
                    device: device.name.clone(),
                    scene: scene.clone(),
                    method: method.clone(),
                    quantity,
                    sample,
                }));
            }
        }
    }
    means
}

/// What the two runs of a pair have in common.
type Key<'a> = (usize, Option<&'a str>, &'a str, u32);

pub fn key(run: &Run) -> Key<'_> {
    (run.set, run.info.experiment.as_deref(), &run.info.scene, run.info.repetition)
}

/// Returns the runs that have no run of the baseline to be paired with.
pub fn without_partner<'a>(runs: &'a [Run], device: &'a Device, baseline: &str) -> Vec<&'a Run> {
    let of = || device.runs(runs).filter(|run| run.counts(Quantity::Fps));
    let partners: BTreeSet<Key> = of().filter(|run| run.info.method == baseline).map(key).collect();
    of().filter(|run| run.info.method != baseline && !partners.contains(&key(run))).collect()
}

/// Compares all methods on a device with the baseline, for each scene and then over the scenes.
pub fn differences(runs: &[Run], device: &Device, baseline: &str) -> Vec<Difference> {
    let mut differences = Vec::new();
    for method in device.methods.iter().filter(|method| *method != baseline) {
        for quantity in Quantity::ALL {
            let values = |method: &str| -> BTreeMap<Key, f64> {
                let of = device.runs(runs).filter(|run| run.info.method == method);
                of.filter_map(|run| Some((key(run), *run.values.get(&quantity)?))).collect()
            };
            let (ours, theirs) = (values(method), values(baseline));
            let pairs = |scene: &String| -> Vec<[f64; 2]> {
                let of_scene = ours.iter().filter(|(key, _)| key.2 == scene);
                of_scene.filter_map(|(key, value)| Some([*value, *theirs.get(key)?])).collect()
            };
            let scenes = device.scenes.iter().map(|scene| (scene, pairs(scene)));
            let scenes: Vec<_> = scenes.filter(|(_, pairs)| !pairs.is_empty()).collect();
            let each = scenes.chunks(1).map(|one| (Some(one[0].0), one));
            for (scene, of) in each.chain([(None, &scenes[..])]) {
                let mean = |value: &dyn Fn(&[f64; 2]) -> f64| {
                    let blocks = of.iter().map(|(_, pairs)| pairs.iter().map(value).collect());
                    mean_of_blocks(&blocks.collect::<Vec<_>>())
                };
                // The mean that stands for ratios is that of their logarithms, so that half and double cancel out.
                let is_ratio = quantity.shown().is_ratio;
                let change = mean(&|[ours, base]| if is_ratio { (ours / base).ln() } else { ours - base });
                let back = |value: f64| if is_ratio { 100.0 * value.exp_m1() } else { value };
                let all = [change, mean(&|pair| pair[0]), mean(&|pair| pair[1])];
                let [Some((change, interval)), Some((ours, _)), Some((baseline, _))] = all else { continue };
                differences.push(Difference {
                    device: device.name.clone(),
                    scene: scene.cloned(),
                    method: method.clone(),
                    quantity,
                    pairs: of.iter().map(|(_, pairs)| pairs.len()).sum(),
                    scenes: of.len(),
                    ours,
                    baseline,
                    change: back(change),
                    interval: interval.map(|ends| ends.map(back)),
                });
            }
        }
    }
    differences
}
