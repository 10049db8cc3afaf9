//! Statistics of samples, and intervals of their means.

use serde::Serialize;

pub use yoro_settings::telemetry::stats::{Summary, median, percentile};

/// Returns the arithmetic mean; `None` if there are no values.
pub fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let values: Vec<f64> = values.into_iter().collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Returns the geometric mean; `None` if there are no values.
pub fn geometric_mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    mean(values.into_iter().map(f64::ln)).map(f64::exp)
}

/// Returns each value once, in the order of first occurrence.
pub fn unique<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for value in values {
        if !found.contains(&value) {
            found.push(value);
        }
    }
    found
}

/// Returns the offset and slope of the least-squares line; `None` if there are fewer than two different x.
pub fn line_through(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xx, xy) = points
        .iter()
        .fold((0.0, 0.0), |(xx, xy), p| (xx + (p.0 - x) * (p.0 - x), xy + (p.0 - x) * (p.1 - y)));
    (xx > 0.0).then(|| (y - xy / xx * x, xy / xx))
}

/// Middle and scatter of a sample: of plain values, or of the differences of a paired comparison.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sample {
    /// Number of values, at least one.
    pub n: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// The median.
    pub median: f64,
    /// Sample standard deviation (divided by n - 1); 0 for a single value.
    pub std: f64,
    /// Ends of the mean's 95 % interval by Student's t; `None` for a single value.
    pub interval: Option<[f64; 2]>,
}

impl Sample {
    /// Returns the sample of these values; `None` if there are none, or if one is not finite.
    pub fn of(values: &[f64]) -> Option<Sample> {
        let Summary { count: n, mean, median, std, .. } = Summary::of(values)?;
        Some(Sample { n, mean, median, std, interval: interval(mean, n - 1, std / (n as f64).sqrt()) })
    }
}

/// Returns the mean of the blocks' means, all blocks weighing the same, and the ends of its 95 % interval, which a single
/// value does not have. `None` if there are no blocks, if one is empty, or if a value is not finite.
///
/// If any block has two or more values, the interval says what to expect when these blocks are measured again: the
/// scatter around the blocks' means is pooled, as in an analysis of variance with a fixed effect for each block. If every
/// block has a single value, it says what to expect from other blocks of this kind.
pub fn mean_of_blocks(blocks: &[Vec<f64>]) -> Option<(f64, Option<[f64; 2]>)> {
    let samples: Vec<Sample> = blocks.iter().map(|block| Sample::of(block)).collect::<Option<_>>()?;
    let over_blocks = Sample::of(&samples.iter().map(|sample| sample.mean).collect::<Vec<_>>())?;
    let freedom = samples.iter().map(|sample| sample.n - 1).sum::<usize>();
    let squares: f64 = samples.iter().map(|s| s.std * s.std * (s.n - 1) as f64).sum();
    let weights: f64 = samples.iter().map(|s| 1.0 / s.n as f64).sum();
    let error = (squares / freedom as f64 * weights).sqrt() / samples.len() as f64;
    Some((over_blocks.mean, interval(over_blocks.mean, freedom, error).or(over_blocks.interval)))
}

/// Returns the 95 % interval of a mean with this standard error; `None` without a degree of freedom.
fn interval(mean: f64, freedom: usize, error: f64) -> Option<[f64; 2]> {
    let reach = t_quantile(freedom)? * error;
    Some([mean - reach, mean + reach])
}

/// Returns the 97.5th percentile of Student's t.
fn t_quantile(freedom: usize) -> Option<f64> {
    const FEW: [f64; 9] =
        [12.7062047, 4.3026527, 3.1824463, 2.7764451, 2.5705818, 2.4469119, 2.3646243, 2.3060041, 2.2621572];
    // The expansion of Cornish and Fisher, to 1e-5 from 10 degrees of freedom on.
    let terms = [1.58953405, 2.55584968, 2.82249862, 2.37227123];
    let many = terms.iter().fold(0.0, |sum, term| (sum + term) / freedom as f64) + 1.95996398;
    FEW.get(freedom.checked_sub(1)?).copied().or(Some(many))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_recover_a_line() {
        let points = [(1.0, 5.0), (2.0, 7.0), (4.0, 11.0)];
        let (offset, slope) = line_through(&points).unwrap();
        assert!((offset - 3.0).abs() < 1e-12 && (slope - 2.0).abs() < 1e-12);
        assert_eq!(line_through(&points[..1]), None);
    }

    #[test]
    fn quantiles_agree_with_scipy() {
        // scipy.stats.t.ppf(.975, n)
        for (n, expected) in
            [(1, 12.706204736), (9, 2.262157163), (10, 2.228138852), (30, 2.042272456), (1000, 1.962339081)]
        {
            assert!((t_quantile(n).unwrap() - expected).abs() < 2e-5, "{n}: {:?}", t_quantile(n));
        }
    }

    #[test]
    fn repetitions_are_pooled_and_single_values_are_blocks() {
        // SciPy: t.interval(.95, 4, mean, sqrt(s2 / 3 * 2) / 2) with the pooled variance s2 of both blocks.
        let (mean, interval) = mean_of_blocks(&[vec![1.0, 2.0, 3.0], vec![11.0, 12.0, 13.0]]).unwrap();
        let reach = 2.776445105 * (2.0f64 / 3.0).sqrt() / 2.0;
        assert!(mean == 7.0 && (interval.unwrap()[1] - 7.0 - reach).abs() < 1e-7);
        let (mean, interval) = mean_of_blocks(&[vec![1.0], vec![3.0]]).unwrap();
        assert!(mean == 2.0 && (interval.unwrap()[1] - 14.706).abs() < 1e-3);
        assert_eq!(mean_of_blocks(&[vec![5.0]]), Some((5.0, None)));
        assert_eq!(mean_of_blocks(&[vec![]]), None);
    }
}
