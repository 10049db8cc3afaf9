//! Intervals of means, from the scatter of repetitions.

use serde::{Deserialize, Serialize};

use crate::stats::Summary;

/// Confidence of all intervals.
pub const CONFIDENCE: f64 = 0.95;

/// An interval of plausible values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Returns the interval with both ends mapped by an increasing function.
    pub fn map(self, f: impl Fn(f64) -> f64) -> Interval {
        Interval { low: f(self.low), high: f(self.high) }
    }
}

/// The mean and scatter of a sample: of plain values, or of the differences of a paired comparison.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Number of values, at least one.
    pub n: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation (divided by n - 1); 0 for a single value.
    pub std: f64,
}

impl Sample {
    /// Returns the sample of these values; `None` if there are none, or if one is not finite.
    pub fn of(values: &[f64]) -> Option<Sample> {
        Summary::of(values).map(|summary| Sample { n: summary.count, mean: summary.mean, std: summary.std })
    }

    /// Returns the interval of the mean at [`CONFIDENCE`] by Student's t; `None` for a single value.
    pub fn interval(&self) -> Option<Interval> {
        (self.n > 1).then(|| around(self.mean, self.n - 1, self.std / (self.n as f64).sqrt()))
    }
}

/// The scatter on which the interval of a mean over several blocks is based.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// The scatter of repetitions around the mean of their block: what to expect when these blocks are measured again.
    Repetitions,
    /// The scatter of the blocks, each measured once: what to expect from other blocks of this kind.
    Blocks,
}

/// An interval, and the scatter that it is based on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BlockInterval {
    /// The interval.
    #[serde(flatten)]
    pub interval: Interval,
    /// The scatter that it is based on.
    pub basis: Basis,
}

impl BlockInterval {
    /// Returns the interval with both ends mapped by an increasing function.
    pub fn map(self, f: impl Fn(f64) -> f64) -> BlockInterval {
        BlockInterval { interval: self.interval.map(f), ..self }
    }
}

/// Returns the mean of the blocks' means, all blocks weighing the same, and its interval at [`CONFIDENCE`], which a
/// single value does not have; empty blocks do not count. `None` if there are no values, or if one is not finite.
///
/// If any block has two or more values, the interval is based on repetitions: the blocks are fixed, and the scatter
/// around their means is pooled (as in an analysis of variance with a fixed effect for each block). If every block has a
/// single value, it is based on the blocks.
pub fn mean_of_blocks(blocks: &[Vec<f64>]) -> Option<(f64, Option<BlockInterval>)> {
    let filled = blocks.iter().filter(|block| !block.is_empty());
    let samples: Vec<Sample> = filled.map(|block| Sample::of(block)).collect::<Option<_>>()?;
    let over_blocks = Sample::of(&samples.iter().map(|sample| sample.mean).collect::<Vec<_>>())?;
    let freedom = samples.iter().map(|sample| sample.n - 1).sum::<usize>();
    let found = if freedom > 0 {
        let squares: f64 = samples.iter().map(|s| s.std * s.std * (s.n - 1) as f64).sum();
        let weights: f64 = samples.iter().map(|s| 1.0 / s.n as f64).sum();
        let error = (squares / freedom as f64 * weights).sqrt() / samples.len() as f64;
        Some((around(over_blocks.mean, freedom, error), Basis::Repetitions))
    } else {
        over_blocks.interval().map(|interval| (interval, Basis::Blocks))
    };
    Some((over_blocks.mean, found.map(|(interval, basis)| BlockInterval { interval, basis })))
}

fn around(mean: f64, freedom: usize, error: f64) -> Interval {
    let reach = t_quantile(freedom) * error;
    Interval { low: mean - reach, high: mean + reach }
}

/// Returns the 97.5th percentile of Student's t with at least one degree of freedom.
fn t_quantile(freedom: usize) -> f64 {
    const FEW: [f64; 9] = [
        12.706204736,
        4.302652730,
        3.182446305,
        2.776445105,
        2.570581836,
        2.446911851,
        2.364624252,
        2.306004135,
        2.262157163,
    ];
    if let Some(quantile) = FEW.get(freedom - 1) {
        return *quantile;
    }
    // The expansion of Cornish and Fisher, to 1e-5 from 10 degrees of freedom on.
    let (z, v) = (1.959963985f64, freedom as f64);
    let terms = [
        (z.powi(3) + z) / 4.0,
        (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0,
        (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0,
        (79.0 * z.powi(9) + 776.0 * z.powi(7) + 1482.0 * z.powi(5) - 1920.0 * z.powi(3) - 945.0 * z)
            / 92160.0,
    ];
    terms.iter().rev().fold(0.0, |sum, term| (sum + term) / v) + z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_agree_with_scipy() {
        // scipy.stats.t.ppf(.975, n)
        for (freedom, expected) in
            [(1, 12.706204736), (9, 2.262157163), (10, 2.228138852), (30, 2.042272456), (1000, 1.962339081)]
        {
            assert!((t_quantile(freedom) - expected).abs() < 2e-5, "{freedom}: {}", t_quantile(freedom));
        }
    }

    #[test]
    fn repetitions_are_pooled_and_single_values_are_blocks() {
        // SciPy: t.interval(.95, 4, mean, sqrt(s2 / 3 * 2) / 2) with the pooled variance s2 of both blocks.
        let (mean, interval) =
            mean_of_blocks(&[vec![1.0, 2.0, 3.0], vec![11.0, 12.0, 13.0], vec![]]).unwrap();
        let BlockInterval { interval, basis } = interval.unwrap();
        let reach = 2.776445105 * (2.0f64 / 3.0).sqrt() / 2.0;
        assert!((mean, basis) == (7.0, Basis::Repetitions) && (interval.high - 7.0 - reach).abs() < 1e-9);
        let (mean, interval) = mean_of_blocks(&[vec![1.0], vec![3.0]]).unwrap();
        assert!(
            mean == 2.0
                && interval
                    .is_some_and(|i| i.basis == Basis::Blocks && (i.interval.high - 14.706).abs() < 1e-3)
        );
        assert_eq!(mean_of_blocks(&[vec![5.0]]), Some((5.0, None)));
        assert_eq!(mean_of_blocks(&[vec![]]), None);
    }
}
