//! Statistics of samples such as frame times.

use serde::{Deserialize, Serialize};

/// Summary statistics of a set of samples, in the samples' unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Number of samples.
    pub count: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// The median.
    pub median: f64,
    /// Sample standard deviation (divided by n - 1); 0 for a single sample.
    pub std: f64,
    /// The smallest.
    pub min: f64,
    /// The largest.
    pub max: f64,
    /// The 95th percentile.
    pub p95: f64,
    /// The 99th percentile.
    pub p99: f64,
}

impl Summary {
    /// Summarizes the samples; `None` if there are none, or if one is not finite.
    pub fn of(samples: &[f64]) -> Option<Summary> {
        if samples.is_empty() || samples.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let mut sorted = samples.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let mean = sorted.iter().sum::<f64>() / count as f64;
        let squares: f64 = sorted.iter().map(|v| (v - mean).powi(2)).sum();
        Some(Summary {
            count,
            mean,
            median: at_share(&sorted, 0.5),
            std: (squares / (count - 1).max(1) as f64).sqrt(),
            min: sorted[0],
            max: sorted[count - 1],
            p95: at_share(&sorted, 0.95),
            p99: at_share(&sorted, 0.99),
        })
    }
}

/// Returns the median; `None` if there are no samples, or if one is not finite.
pub fn median(samples: &[f64]) -> Option<f64> {
    percentile(samples, 50.0)
}

/// Returns the value below which `percent` (0 to 100, clamped) of the samples are, interpolated linearly between
/// neighbours as NumPy does by default; `None` if there are no samples, or if one is not finite.
pub fn percentile(samples: &[f64], percent: f64) -> Option<f64> {
    if samples.is_empty() || samples.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    Some(at_share(&sorted, percent / 100.0))
}

fn at_share(sorted: &[f64], share: f64) -> f64 {
    let at = share.clamp(0.0, 1.0) * (sorted.len() - 1) as f64;
    let below = at.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (at - below as f64) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_equal_numpys() {
        // numpy.mean, median, std(ddof=1), percentile(95), percentile(99) of the same samples.
        let summary = Summary::of(&[9.0, 2.0, 4.0, 4.0, 5.0, 5.0, 7.0, 4.0]).unwrap();
        assert_eq!((summary.count, summary.mean, summary.median), (8, 5.0, 4.5));
        assert!((summary.std - (32.0f64 / 7.0).sqrt()).abs() < 1e-12);
        assert!((summary.p95 - 8.3).abs() < 1e-12 && (summary.p99 - 8.86).abs() < 1e-12);
        assert_eq!((summary.min, summary.max), (2.0, 9.0));
    }

    #[test]
    fn no_statistics_of_no_or_infinite_samples() {
        assert_eq!(Summary::of(&[]), None);
        assert_eq!(Summary::of(&[1.0, f64::NAN]), None);
        assert_eq!(median(&[1.0, f64::INFINITY]), None);
        let one = Summary::of(&[3.0]).unwrap();
        assert_eq!((one.median, one.std, one.p99), (3.0, 0.0, 3.0));
        assert_eq!(percentile(&[1.0, 2.0], 0.0), Some(1.0));
        assert_eq!(percentile(&[1.0, 2.0], 200.0), Some(2.0));
    }
}
