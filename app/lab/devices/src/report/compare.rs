//! Means of methods, and their comparisons with the baseline.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::Device;
use super::run::{Quantity, Run};
use yoro_report::{BlockInterval, Interval, Sample, mean_of_blocks};

/// The mean of a method in a scene over all runs that count.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mean {
    pub device: String,
    pub scene: String,
    pub method: String,
    pub quantity: Quantity,
    #[serde(flatten)]
    pub sample: Sample,
    /// Confidence interval of the mean, by Student's t over the repetitions. `None` for a single run.
    pub interval: Option<Interval>,
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
    /// Mean of the method over the pairs of each scene, then over the scenes.
    pub ours: f64,
    pub baseline: f64,
    /// Change in percent, from the geometric mean of the pairs' ratios. For quantities that are not compared by ratios,
    /// the mean difference in the quantity's unit.
    pub change: f64,
    /// Confidence interval of the change. `None` if nothing was repeated.
    pub interval: Option<BlockInterval>,
}

/// Returns the means of all methods and scenes on a device.
pub fn means(runs: &[Run], device: &Device) -> Vec<Mean> {
    let mut means = Vec::new();
    for scene in &device.scenes {
        for method in &device.methods {
            for quantity in Quantity::ALL {
                let of = runs.iter().filter(|r| r.device == device.name && r.scene == *scene);
                let of = of.filter(|run| run.method == *method);
                let values: Vec<f64> = of.filter_map(|run| run.values.get(&quantity).copied()).collect();
                if let Some(sample) = Sample::of(&values) {
                    means.push(Mean {
                        device: device.name.clone(),
                        scene: scene.clone(),
                        method: method.clone(),
                        quantity,
                        sample,
                        interval: sample.interval(),
                    });
                }
            }
        }
    }
    means
}

/// What the two runs of a pair have in common.
type Key<'a> = (usize, Option<&'a str>, &'a str, u32);

fn key(run: &Run) -> Key<'_> {
    (run.set, run.experiment.as_deref(), &run.scene, run.repetition)
}

/// Returns the runs that have no run of the baseline to be paired with.
pub fn without_partner<'a>(runs: &'a [Run], device: &Device, baseline: &str) -> Vec<&'a Run> {
    let of =
        || runs.iter().filter(|run| run.device == device.name && run.exclusions.iter().all(|e| e.power_only));
    let partners: BTreeSet<Key> = of().filter(|run| run.method == baseline).map(key).collect();
    of().filter(|run| run.method != baseline && !partners.contains(&key(run))).collect()
}

/// Compares all methods on a device with the baseline, for each scene and then over the scenes.
pub fn differences(runs: &[Run], device: &Device, baseline: &str) -> Vec<Difference> {
    let mut differences = Vec::new();
    for method in device.methods.iter().filter(|method| *method != baseline) {
        for quantity in Quantity::ALL {
            let values = |method: &str| -> BTreeMap<Key, f64> {
                let of = runs.iter().filter(|run| run.device == device.name && run.method == method);
                of.filter_map(|run| Some((key(run), *run.values.get(&quantity)?))).collect()
            };
            let (ours, theirs) = (values(method), values(baseline));
            let pairs = |scene: &str| -> Vec<(f64, f64)> {
                let of_scene = ours.iter().filter(|(key, _)| key.2 == scene);
                of_scene.filter_map(|(key, value)| Some((*value, *theirs.get(key)?))).collect()
            };
            let scenes: Vec<(&String, Vec<(f64, f64)>)> = device
                .scenes
                .iter()
                .map(|scene| (scene, pairs(scene)))
                .filter(|(_, p)| !p.is_empty())
                .collect();
            let difference = |scene: Option<&String>, pairs: &[&Vec<(f64, f64)>]| {
                let (change, interval) = change(quantity, pairs)?;
                let mean = |side: fn(&(f64, f64)) -> f64| {
                    let blocks: Vec<Vec<f64>> = pairs.iter().map(|p| p.iter().map(side).collect()).collect();
                    mean_of_blocks(&blocks).map(|(mean, _)| mean)
                };
                Some(Difference {
                    device: device.name.clone(),
                    scene: scene.cloned(),
                    method: method.clone(),
                    quantity,
                    pairs: pairs.iter().map(|pairs| pairs.len()).sum(),
                    ours: mean(|pair| pair.0)?,
                    baseline: mean(|pair| pair.1)?,
                    change,
                    interval,
                })
            };
            differences.extend(scenes.iter().filter_map(|(scene, pairs)| difference(Some(scene), &[pairs])));
            let all: Vec<&Vec<(f64, f64)>> = scenes.iter().map(|(_, pairs)| pairs).collect();
            differences.extend(difference(None, &all));
        }
    }
    differences
}

/// Returns the mean change over blocks of pairs, and its interval.
fn change(quantity: Quantity, blocks: &[&Vec<(f64, f64)>]) -> Option<(f64, Option<BlockInterval>)> {
    let value = |(ours, baseline): &(f64, f64)| {
        if !quantity.is_ratio() {
            return Some(ours - baseline);
        }
        (*ours > 0.0 && *baseline > 0.0).then(|| (ours / baseline).ln())
    };
    let blocks: Vec<Vec<f64>> = blocks
        .iter()
        .map(|block| block.iter().map(value).collect::<Option<Vec<f64>>>())
        .collect::<Option<_>>()?;
    let (mean, interval) = mean_of_blocks(&blocks)?;
    // The mean that stands for ratios is that of their logarithms, so that half and double cancel out.
    let back = |value: f64| if quantity.is_ratio() { 100.0 * value.exp_m1() } else { value };
    Some((back(mean), interval.map(|interval| interval.map(back))))
}
