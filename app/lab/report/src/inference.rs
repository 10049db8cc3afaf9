//! Statistical inference: intervals, paired tests, effect size, power, equivalence.
//!
//! The values agree with SciPy, statsmodels and mpmath to 1e-6 (`vectors/inference.json`).

use crate::stats::Summary;
use crate::student::{bisect, noncentral_t_cdf, t_cdf, t_quantile};
use serde::{Deserialize, Serialize};

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

    /// True if the whole interval lies strictly inside `other`.
    pub fn inside(self, other: Interval) -> bool {
        other.low < self.low && self.high < other.high
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

    /// Returns the sample of the differences a - b of the pairs; `None` if there are none, or if a value is not finite.
    /// Differences that are equal up to the rounding of a and b, such as 4.1 - 3.1 and 3.2 - 2.2, count as equal.
    pub fn of_differences(pairs: impl IntoIterator<Item = (f64, f64)>) -> Option<Sample> {
        let mut largest = 0.0f64;
        let differences = pairs.into_iter().map(|(a, b)| {
            largest = largest.max(a.abs()).max(b.abs());
            a - b
        });
        let sample = Sample::of(&differences.collect::<Vec<_>>())?;
        // A value may itself be a mean, with the rounding error of a sum of dozens of values.
        let rounding = 64.0 * f64::EPSILON * largest;
        Some(if sample.std > rounding { sample } else { Sample { std: 0.0, ..sample } })
    }

    fn df(&self) -> Option<f64> {
        (self.n > 1).then(|| (self.n - 1) as f64)
    }

    /// Returns the standard deviation of the mean; `None` for a single value.
    pub fn standard_error(&self) -> Option<f64> {
        self.df().map(|_| self.std / (self.n as f64).sqrt())
    }

    /// Returns the interval of the mean by Student's t at a confidence between 0 and 1; `None` for a single value.
    pub fn interval(&self, confidence: f64) -> Option<Interval> {
        let reach = t_quantile(0.5 + confidence / 2.0, self.df()?) * self.standard_error()?;
        Some(Interval { low: self.mean - reach, high: self.mean + reach })
    }

    /// Returns Student's t of the mean against a value. `None` for a single value, or if all values are equal.
    pub fn t(&self, against: f64) -> Option<f64> {
        let error = self.standard_error()?;
        (error > 0.0).then(|| (self.mean - against) / error)
    }

    /// Returns the two-sided p of the t-test against 0, which for differences is the paired t-test.
    pub fn p(&self) -> Option<f64> {
        Some(2.0 * t_cdf(-self.t(0.0)?.abs(), self.df()?))
    }

    /// Returns Cohen's d_z: the mean divided by the standard deviation.
    pub fn d_z(&self) -> Option<f64> {
        (self.n > 1 && self.std > 0.0).then(|| self.mean / self.std)
    }

    /// Returns the confidence interval of d_z for a confidence between 0 and 1: the noncentral t distributions under
    /// which the observed t is not too extreme (Steiger and Fouladi 1997). `None` in the cases of [`Sample::t`], and
    /// for a confidence so close to 1 that f64 cannot tell them apart.
    pub fn d_z_interval(&self, confidence: f64) -> Option<Interval> {
        let (t, df) = (self.t(0.0)?, self.df()?);
        let tail = (1.0 - confidence) / 2.0;
        // The probability falls as the noncentrality grows.
        let noncentrality = |p: f64| {
            let is_enough = |reach: &f64| {
                noncentral_t_cdf(t, df, t - reach) >= p && noncentral_t_cdf(t, df, t + reach) <= p
            };
            let reach = (0..64).map(|doubled| (2.0 + t.abs()) * f64::from(doubled).exp2()).find(is_enough)?;
            Some(bisect(t - reach, t + reach, |delta| noncentral_t_cdf(t, df, delta) > p))
        };
        let root = (self.n as f64).sqrt();
        let interval = Interval { low: noncentrality(1.0 - tail)?, high: noncentrality(tail)? };
        Some(interval.map(|delta| delta / root))
    }

    /// Returns the power of the paired t-test if the true effect were the observed one ("post hoc"). It says nothing
    /// beyond p; to plan a study, use [`pairs_for_power`].
    pub fn power(&self, alpha: f64) -> Option<f64> {
        Some(power_of_t_test(self.d_z()?, self.n, alpha))
    }

    /// Tests whether the mean lies inside `bounds` by two one-sided t-tests (Schuirmann 1987, Lakens 2017). `None` in
    /// the cases of [`Sample::t`].
    pub fn equivalence(&self, bounds: Interval, alpha: f64) -> Option<Equivalence> {
        let df = self.df()?;
        let (t_lower, t_upper) = (self.t(bounds.low)?, self.t(bounds.high)?);
        let (p_lower, p_upper) = (t_cdf(-t_lower, df), t_cdf(t_upper, df));
        let p = p_lower.max(p_upper);
        Some(Equivalence {
            bounds,
            t_lower,
            p_lower,
            t_upper,
            p_upper,
            p,
            interval: self.interval(1.0 - 2.0 * alpha)?,
            equivalent: p < alpha,
        })
    }
}

/// The result of two one-sided tests for equivalence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Equivalence {
    /// The bounds within which differences do not matter.
    pub bounds: Interval,
    /// Student's t against the lower bound.
    pub t_lower: f64,
    /// One-sided p for the mean being above the lower bound.
    pub p_lower: f64,
    /// Student's t against the upper bound.
    pub t_upper: f64,
    /// One-sided p for the mean being below the upper bound.
    pub p_upper: f64,
    /// The p of the whole test: the larger of the two.
    pub p: f64,
    /// The interval at confidence 1 - 2 alpha. It lies inside the bounds exactly if `equivalent` is true.
    pub interval: Interval,
    /// True if `p` is below alpha.
    pub equivalent: bool,
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

/// The mean of the block means, all blocks weighing the same.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Blocks {
    /// Number of blocks.
    pub blocks: usize,
    /// Number of values in all blocks together.
    pub n: usize,
    /// The mean of the block means.
    pub mean: f64,
    /// The interval of the mean; `None` for a single value.
    pub interval: Option<BlockInterval>,
}

impl Blocks {
    /// Returns the mean of the blocks and its interval at a confidence between 0 and 1; empty blocks do not count.
    /// `None` if there are no values, or if one is not finite.
    ///
    /// If any block has two or more values, the interval is based on repetitions: the blocks are fixed, and the scatter
    /// around their means is pooled (as in an analysis of variance with a fixed effect for each block). If every block
    /// has a single value, it is based on the blocks.
    pub fn of(blocks: &[Vec<f64>], confidence: f64) -> Option<Blocks> {
        let filled = blocks.iter().filter(|block| !block.is_empty());
        let samples: Vec<Sample> = filled.map(|block| Sample::of(block)).collect::<Option<_>>()?;
        let means: Vec<f64> = samples.iter().map(|sample| sample.mean).collect();
        let over_blocks = Sample::of(&means)?;
        let n = samples.iter().map(|sample| sample.n).sum::<usize>();
        let df = (n - samples.len()) as f64;
        let interval = if df > 0.0 {
            let squares: f64 = samples.iter().map(|s| s.std * s.std * (s.n - 1) as f64).sum();
            let weights: f64 = samples.iter().map(|s| 1.0 / s.n as f64).sum();
            let error = (squares / df * weights).sqrt() / samples.len() as f64;
            let reach = t_quantile(0.5 + confidence / 2.0, df) * error;
            let mean = over_blocks.mean;
            let interval = Interval { low: mean - reach, high: mean + reach };
            Some(BlockInterval { interval, basis: Basis::Repetitions })
        } else {
            let interval = over_blocks.interval(confidence);
            interval.map(|interval| BlockInterval { interval, basis: Basis::Blocks })
        };
        Some(Blocks { blocks: samples.len(), n, mean: over_blocks.mean, interval })
    }
}

/// Returns the power of the two-sided paired t-test at level `alpha` with `n` pairs if the true effect is `d_z`; with
/// fewer than two pairs it is `alpha`.
fn power_of_t_test(d_z: f64, n: usize, alpha: f64) -> f64 {
    if n < 2 {
        return alpha;
    }
    let df = (n - 1) as f64;
    let delta = d_z.abs() * (n as f64).sqrt();
    let critical = t_quantile(1.0 - alpha / 2.0, df);
    1.0 - noncentral_t_cdf(critical, df, delta) + noncentral_t_cdf(-critical, df, delta)
}

/// Returns the smallest number of pairs that gives the two-sided paired t-test at level `alpha` this power if the true
/// effect is `d_z`; `None` if a million are not enough.
pub fn pairs_for_power(d_z: f64, power: f64, alpha: f64) -> Option<usize> {
    const MOST: usize = 1_000_000;
    let enough = |n: usize| power_of_t_test(d_z, n, alpha) >= power;
    let mut high = 2;
    while !enough(high) {
        if high >= MOST {
            return None;
        }
        high *= 2;
    }
    let mut low = high / 2;
    while low + 1 < high {
        let middle = (low + high) / 2;
        if enough(middle) { high = middle } else { low = middle }
    }
    Some(high.max(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper;

    const ALPHA: f64 = 0.05;

    #[derive(Deserialize)]
    struct Vectors {
        t_cdf: Vec<[f64; 3]>,
        t_quantile: Vec<[f64; 3]>,
        noncentral_t_cdf: Vec<[f64; 4]>,
        power: Vec<(f64, usize, f64, f64)>,
        sample_size: Vec<(f64, f64, usize)>,
        paired: Vec<Paired>,
        ratio: Vec<Ratio>,
        blocks: Vec<BlocksVector>,
    }

    #[derive(Deserialize)]
    struct Paired {
        name: String,
        a: Vec<f64>,
        b: Vec<f64>,
        bound: f64,
        mean: f64,
        std: f64,
        t: f64,
        p: f64,
        interval: [f64; 2],
        d_z: f64,
        d_z_interval: [f64; 2],
        power: f64,
        tost: Tost,
    }

    #[derive(Deserialize)]
    struct Tost {
        p: f64,
        t_lower: f64,
        p_lower: f64,
        t_upper: f64,
        p_upper: f64,
        interval: [f64; 2],
    }

    #[derive(Deserialize)]
    struct Ratio {
        name: String,
        a: Vec<f64>,
        b: Vec<f64>,
        ratio: f64,
        interval: [f64; 2],
    }

    #[derive(Deserialize)]
    struct BlocksVector {
        name: String,
        groups: Vec<Vec<f64>>,
        mean: f64,
        interval: [f64; 2],
    }

    fn vectors() -> Vectors {
        serde_json::from_str(include_str!("vectors/inference.json")).unwrap()
    }

    #[track_caller]
    fn near(ours: f64, reference: f64, what: impl std::fmt::Debug) {
        let off = (ours - reference).abs() / reference.abs().max(1.0);
        assert!(off < 1e-6, "{what:?}: {ours} is not {reference}");
    }

    /// Compares by the relative error, for p-values far below 1e-6.
    #[track_caller]
    fn near_relatively(ours: f64, reference: f64, what: impl std::fmt::Debug) {
        assert!((ours / reference - 1.0).abs() < 1e-6, "{what:?}: {ours} is not {reference}");
    }

    #[track_caller]
    fn near_interval(ours: Interval, reference: [f64; 2], what: impl std::fmt::Debug) {
        near(ours.low, reference[0], &what);
        near(ours.high, reference[1], &what);
    }

    #[test]
    fn distributions_agree_with_the_references() {
        let vectors = vectors();
        for v in &vectors.t_cdf {
            near_relatively(t_cdf(v[0], v[1]), v[2], v);
        }
        for v in &vectors.t_quantile {
            near(t_quantile(v[0], v[1]), v[2], v);
        }
        for v in &vectors.noncentral_t_cdf {
            let ours = noncentral_t_cdf(v[0], v[1], v[2]);
            assert!((ours - v[3]).abs() < 1e-9, "{v:?}: {ours}");
        }
        assert!(vectors.noncentral_t_cdf.len() > 200);
    }

    #[test]
    fn power_agrees_with_the_references() {
        let vectors = vectors();
        for v in &vectors.power {
            near(power_of_t_test(v.0, v.1, v.2), v.3, v);
        }
        for v in &vectors.sample_size {
            assert_eq!(pairs_for_power(v.0, v.1, ALPHA), Some(v.2), "{v:?}");
        }
        assert_eq!(pairs_for_power(0.0, 0.8, ALPHA), None);
        assert_eq!(power_of_t_test(2.0, 1, ALPHA), ALPHA);
    }

    #[test]
    fn paired_samples_agree_with_the_references() {
        for v in vectors().paired {
            let sample = Sample::of_differences(v.a.into_iter().zip(v.b)).unwrap();
            let name = &v.name;
            near(sample.mean, v.mean, name);
            near(sample.std, v.std, name);
            near(sample.t(0.0).unwrap(), v.t, name);
            near_relatively(sample.p().unwrap(), v.p, name);
            near_interval(sample.interval(1.0 - ALPHA).unwrap(), v.interval, name);
            near(sample.d_z().unwrap(), v.d_z, name);
            near_interval(sample.d_z_interval(1.0 - ALPHA).unwrap(), v.d_z_interval, name);
            near(sample.power(ALPHA).unwrap(), v.power, name);
            let bounds = Interval { low: -v.bound, high: v.bound };
            let tost = sample.equivalence(bounds, ALPHA).unwrap();
            near(tost.t_lower, v.tost.t_lower, name);
            near(tost.t_upper, v.tost.t_upper, name);
            near_relatively(tost.p_lower, v.tost.p_lower, name);
            near_relatively(tost.p_upper, v.tost.p_upper, name);
            near_relatively(tost.p, v.tost.p, name);
            near_interval(tost.interval, v.tost.interval, name);
            assert_eq!(tost.equivalent, tost.interval.inside(bounds), "{name}");
        }
    }

    /// The values of R's manual for its data set `sleep`, and of G*Power's manual for its first example.
    #[test]
    fn published_examples() {
        let sleep = &vectors().paired[0];
        let sample = Sample::of_differences(sleep.a.iter().copied().zip(sleep.b.iter().copied())).unwrap();
        assert!((sample.t(0.0).unwrap() - -4.0621).abs() < 5e-5);
        assert!((sample.p().unwrap() - 0.002833).abs() < 5e-7);
        assert!((sample.mean - -1.58).abs() < 1e-12);
        let interval = sample.interval(0.95).unwrap();
        assert!((interval.low - -2.4598858).abs() < 5e-8 && (interval.high - -0.7001142).abs() < 5e-8);
        assert_eq!(pairs_for_power(0.5, 0.8, 0.05), Some(34));
    }

    /// "You Only Render Once", section "User Study": everything printed follows from n, t and the interval, if that is
    /// read as a 95 % interval. A 90 % interval, which belongs to two one-sided tests, would give another t.
    #[test]
    fn the_papers_user_study_agrees_with_itself() {
        for printed in paper::STUDY {
            let mean = (printed.interval[0] + printed.interval[1]) / 2.0;
            let n = paper::STUDY_PARTICIPANTS;
            let sample = Sample { n, mean, std: mean / printed.t * (n as f64).sqrt() };
            assert!((sample.p().unwrap() - printed.p).abs() < 1e-4);
            assert!((sample.d_z().unwrap() - printed.d_z).abs() < 1e-4);
            assert!((sample.power(0.05).unwrap() - printed.power).abs() < 1e-4);
            let interval = sample.interval(0.95).unwrap();
            assert!((interval.low - printed.interval[0]).abs() < 3e-4, "{interval:?}");
            assert!(
                (sample.interval(0.9).unwrap().low - printed.interval[0]).abs() > 0.01,
                "an interval of 90 % would be narrower"
            );
            let tost = sample.equivalence(Interval { low: -0.5, high: 0.5 }, 0.05).unwrap();
            // The figures have four digits, so that a t near 14 is uncertain by a few hundredths.
            assert!((tost.p_lower / printed.p_lower).ln().abs() < 0.1, "{}", tost.p_lower);
            assert!((tost.p_upper / printed.p_upper).ln().abs() < 0.1, "{}", tost.p_upper);
        }
    }

    #[test]
    fn ratios_and_blocks_agree_with_the_references() {
        let vectors = vectors();
        for v in vectors.ratio {
            let logs = v.a.iter().zip(&v.b).map(|(a, b)| (a.ln(), b.ln()));
            let sample = Sample::of_differences(logs).unwrap();
            near(sample.mean.exp(), v.ratio, &v.name);
            near_interval(sample.interval(0.95).unwrap().map(f64::exp), v.interval, &v.name);
        }
        for v in vectors.blocks {
            let blocks = Blocks::of(&v.groups, 0.95).unwrap();
            near(blocks.mean, v.mean, &v.name);
            let found = blocks.interval.unwrap();
            assert_eq!(found.basis, Basis::Repetitions);
            near_interval(found.interval, v.interval, &v.name);
        }
    }

    #[test]
    fn differences_that_are_equal_but_for_rounding_have_no_scatter() {
        let sample = Sample::of_differences([(4.1, 3.1), (3.2, 2.2), (2.3, 1.3)]).unwrap();
        assert_eq!((sample.std, sample.t(0.0), sample.d_z_interval(0.95)), (0.0, None, None));
        let sample = Sample::of_differences([(4.1, 3.1), (3.2, 2.2), (2.3, 1.3 + 1e-9)]).unwrap();
        assert!(sample.std > 0.0);
    }

    /// The work used to grow in proportion to |t|, and never ended for a confidence that is 1 in f64.
    #[test]
    fn extreme_samples_and_levels_end() {
        let sample = Sample { n: 3, mean: 1.0, std: 1e-12 };
        let interval = sample.d_z_interval(0.95).unwrap();
        assert!(interval.low > 0.0 && interval.high > 1e12, "{interval:?}");
        let sample = Sample { n: 3, mean: 0.2, std: 0.1 };
        let interval = sample.d_z_interval(1.0 - 1e-9).unwrap();
        assert!(interval.low < 0.0 && interval.high > 2.0, "{interval:?}");
        assert!(sample.d_z_interval(1.0 - 1e-18).is_none_or(|wide| wide.low < -1.0 && wide.high > 5.0));
        for alpha in [1e-9, 1e-18, 1e-300] {
            let needed = pairs_for_power(5.0, 0.8, alpha).unwrap();
            assert!((4..100).contains(&needed), "{needed}");
        }
    }

    #[test]
    fn statistics_without_enough_values_are_none() {
        let one = Sample::of(&[3.0]).unwrap();
        assert_eq!((one.interval(0.95), one.t(0.0), one.p(), one.d_z()), (None, None, None, None));
        let equal = Sample::of(&[2.0, 2.0, 2.0]).unwrap();
        assert_eq!((equal.p(), equal.d_z(), equal.power(0.05)), (None, None, None));
        assert_eq!(equal.interval(0.95), Some(Interval { low: 2.0, high: 2.0 }));
        assert_eq!((Sample::of(&[]), Sample::of(&[f64::NAN])), (None, None));
        let once = Blocks::of(&[vec![1.0], vec![], vec![3.0]], 0.95).unwrap();
        assert_eq!((once.blocks, once.n, once.mean), (2, 2, 2.0));
        assert_eq!(once.interval.unwrap().basis, Basis::Blocks);
        assert_eq!(Blocks::of(&[vec![1.0]], 0.95).unwrap().interval, None);
        assert_eq!(Blocks::of(&[vec![]], 0.95), None);
    }
}
