//! Student's t distribution, central and noncentral.

use std::f64::consts::{FRAC_1_SQRT_2, LN_2};

use statrs::distribution::{ContinuousCDF, StudentsT};
use statrs::function::{erf::erfc, gamma::ln_gamma};

/// Returns P(T <= t) of Student's t with `df` degrees of freedom (above 0).
pub fn t_cdf(t: f64, df: f64) -> f64 {
    StudentsT::new(0.0, 1.0, df).map_or(f64::NAN, |student| student.cdf(t))
}

/// Returns the t below which Student's t with `df` degrees of freedom (above 0) lies with probability `p`, 0 < p < 1.
pub fn t_quantile(p: f64, df: f64) -> f64 {
    if p < 0.5 {
        return -t_quantile(1.0 - p, df);
    }
    let mut high = 1.0;
    while t_cdf(high, df) < p && high < 1e12 {
        high *= 2.0;
    }
    bisect(0.0, high, |t| t_cdf(t, df) < p)
}

/// Returns P(T <= t) of the noncentral t with `df` degrees of freedom (at least 1) and noncentrality `delta`.
///
/// T is (Z + delta) / S, where S is the root of a chi-square divided by its degrees of freedom. The result is the
/// probability that Z <= t s - delta, averaged over the density of S.
pub fn noncentral_t_cdf(t: f64, df: f64, delta: f64) -> f64 {
    let half = df / 2.0;
    let constant = LN_2 + half * half.ln() - ln_gamma(half);
    let density = |s: f64| (constant + (df - 1.0) * s.ln() - half * s * s).exp();
    let below = |s: f64| 0.5 * erfc((delta - t * s) * FRAC_1_SQRT_2);
    // The standard deviation of S around 1, approximately.
    let spread = 1.0 / (2.0 * df).sqrt();
    let (from, to) = ((1.0 - 12.0 * spread).max(0.0), 1.0 + 12.0 * spread);
    // `below` is 0 or 1 except within a step of this half-width, which narrows as |t| grows.
    let step = |side: f64| if t == 0.0 { 1.0 + side } else { ((delta + 9.0 * side) / t).clamp(from, to) };
    let (begin, end) = (step(-1.0).min(step(1.0)), step(-1.0).max(step(1.0)));
    let integral = |from: f64, to: f64, width: f64| {
        if from >= to {
            return 0.0;
        }
        let panels = ((to - from) / width).ceil() as usize;
        gauss_legendre(from, to, panels, |s| density(s) * below(s))
    };
    let (before, after) = (integral(from, begin, spread), integral(end, to, spread));
    (before + integral(begin, end, spread.min(1.0 / t.abs())) + after).clamp(0.0, 1.0)
}

/// Returns the point between `low` and `high` where `below` turns from true to false, to 1e-16 of their distance.
pub fn bisect(mut low: f64, mut high: f64, below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..53 {
        let middle = low + (high - low) / 2.0;
        if below(middle) { low = middle } else { high = middle }
    }
    low + (high - low) / 2.0
}

/// Integrates over panels of equal width by Gauss-Legendre quadrature with eight points each.
fn gauss_legendre(from: f64, to: f64, panels: usize, f: impl Fn(f64) -> f64) -> f64 {
    const POINTS: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let half = (to - from) / panels as f64 / 2.0;
    let panel = |i: usize| {
        let middle = from + (2 * i + 1) as f64 * half;
        let pair = |(x, w): &(f64, f64)| w * (f(middle - x * half) + f(middle + x * half));
        POINTS.iter().map(pair).sum::<f64>()
    };
    half * (0..panels).map(panel).sum::<f64>()
}
