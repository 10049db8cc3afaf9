//! Bjøntegaard's measures of the distance between two rate-distortion curves.
//!
//! Source: G. Bjøntegaard, "Calculation of average PSNR differences between RD-curves", VCEG-M33, 2001. The logarithm
//! of the rate is fitted by a cubic in the quality (by least squares where there are more than four points), and the
//! cubics are integrated over the range of qualities that both curves reach.

/// The mean difference of rates at equal quality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BdRate {
    /// The rate of the tested curve minus that of the anchor, as a share of the anchor's: -0.2 means 20 % less.
    pub share: f64,
    /// The range of qualities over which the mean is taken.
    pub quality: [f64; 2],
    /// The share of the anchor's range of qualities that both curves reach, 0 to 1.
    pub overlap: f64,
}

/// Returns the mean difference between the rates of `test` and `anchor`. Points are (rate, quality) in any order, with
/// rates above 0. `None` if there are fewer than four points, or if the curves have no quality in common, so that their
/// rates cannot be compared at equal quality.
pub fn bd_rate(anchor: &[(f64, f64)], test: &[(f64, f64)]) -> Option<BdRate> {
    let (a, b) = (Curve::fit(anchor)?, Curve::fit(test)?);
    let (low, high) = (a.low.max(b.low), a.high.min(b.high));
    if high - low <= 1e-9 {
        return None;
    }
    let mean = (b.integral(low, high) - a.integral(low, high)) / (high - low);
    Some(BdRate {
        share: 10f64.powf(mean) - 1.0,
        quality: [low, high],
        overlap: (high - low) / (a.high - a.low),
    })
}

/// The logarithm of the rate as a cubic in the quality.
struct Curve {
    /// Coefficients of 1, t, t², t³ with t = quality - low.
    coefficients: [f64; 4],
    low: f64,
    high: f64,
}

impl Curve {
    fn fit(points: &[(f64, f64)]) -> Option<Curve> {
        let usable = |p: &&(f64, f64)| p.0 > 0.0 && p.0.is_finite() && p.1.is_finite();
        let points: Vec<(f64, f64)> = points.iter().filter(usable).map(|p| (p.1, p.0.log10())).collect();
        let low = points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
        if points.len() < 4 || high <= low {
            return None;
        }
        // The normal equations, well conditioned since qualities are counted from the lowest in units of their range.
        let range = high - low;
        let mut system = [[0.0; 5]; 4];
        for (quality, rate) in points {
            let t = (quality - low) / range;
            let powers = [1.0, t, t * t, t * t * t];
            for (row, power) in system.iter_mut().zip(powers) {
                for (entry, other) in row.iter_mut().zip(powers) {
                    *entry += power * other;
                }
                row[4] += power * rate;
            }
        }
        let mut coefficients = solve(system)?;
        for (power, coefficient) in coefficients.iter_mut().enumerate() {
            *coefficient /= range.powi(power as i32);
        }
        Some(Curve { coefficients, low, high })
    }

    fn integral(&self, from: f64, to: f64) -> f64 {
        let primitive = |quality: f64| -> f64 {
            let t = quality - self.low;
            let terms = self.coefficients.iter().enumerate();
            terms.map(|(power, c)| c * t.powi(power as i32 + 1) / (power + 1) as f64).sum()
        };
        primitive(to) - primitive(from)
    }
}

/// Solves by Gaussian elimination with partial pivoting; the last column is the right-hand side. `None` if singular.
fn solve(mut m: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    for column in 0..4 {
        let pivot = (column..4).max_by(|a, b| m[*a][column].abs().total_cmp(&m[*b][column].abs()))?;
        m.swap(column, pivot);
        if m[column][column].abs() < 1e-12 {
            return None;
        }
        for row in 0..4 {
            if row != column {
                let pivot = m[column];
                let factor = m[row][column] / pivot[column];
                for (entry, above) in m[row].iter_mut().zip(pivot) {
                    *entry -= factor * above;
                }
            }
        }
    }
    Some(std::array::from_fn(|i| m[i][4] / m[i][i]))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The points commonly used to check implementations of the measure, with results from NumPy's polyfit and polyint.
    #[test]
    fn agrees_with_known_values() {
        let anchor = [(686.76, 40.28), (309.58, 37.18), (157.11, 34.24), (85.95, 31.42)];
        let test = [(893.34, 40.39), (407.8, 37.21), (204.93, 34.17), (112.75, 31.24)];
        let result = bd_rate(&anchor, &test).unwrap();
        assert!((result.share - 0.3139737405491).abs() < 1e-9, "{result:?}");
        assert_eq!(result.quality, [31.42, 40.28]);
        let anchor =
            [(9487.76, 40.037), (4593.60, 38.615), (2486.44, 36.845), (1358.24, 34.851), (700.1, 32.5)];
        let test =
            [(9787.80, 40.121), (4469.00, 38.651), (2451.52, 36.970), (1356.24, 34.987), (650.4, 32.3)];
        let result = bd_rate(&anchor, &test).unwrap();
        assert!((result.share + 0.0375163067734).abs() < 1e-9, "least squares of five points: {result:?}");
    }

    #[test]
    fn a_constant_ratio_of_rates_is_the_bd_rate() {
        let anchor = [(100.0, 30.0), (210.0, 33.0), (450.0, 36.5), (1000.0, 39.0)];
        let test = anchor.map(|(rate, quality)| (rate * 0.604, quality));
        let result = bd_rate(&anchor, &test).unwrap();
        assert!((result.share + 0.396).abs() < 1e-9 && (result.overlap - 1.0).abs() < 1e-9);
        let shuffled = [anchor[2], anchor[0], anchor[3], anchor[1]];
        assert!(bd_rate(&shuffled, &anchor).unwrap().share.abs() < 1e-9);
    }

    #[test]
    fn curves_without_a_common_quality_have_none() {
        let anchor = [(100.0, 30.0), (200.0, 33.0), (400.0, 36.0), (800.0, 39.0)];
        let worse = anchor.map(|(rate, quality)| (rate, quality - 9.5));
        assert_eq!(bd_rate(&anchor, &worse), None);
        assert_eq!(bd_rate(&anchor[..3], &anchor), None);
        assert_eq!(bd_rate(&[(100.0, 30.0); 4], &anchor), None);
    }

    #[test]
    fn least_squares_recover_a_line() {
        let points = [(1.0, 5.0), (2.0, 7.0), (4.0, 11.0)];
        let (offset, slope) = line_through(&points).unwrap();
        assert!((offset - 3.0).abs() < 1e-12 && (slope - 2.0).abs() < 1e-12);
        assert_eq!(line_through(&points[..1]), None);
    }
}
