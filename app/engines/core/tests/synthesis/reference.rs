//! A plain f64 version of the pipeline, without tiles: what the shaders must compute, but not the colours of holes:
//! `any_view.rs` has them.

/// One target pixel: its source column in forward columns, and whether it is a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    pub hole: bool,
    pub source: f64,
    /// A silhouette in front: its column, and the share of the pixel that it covers.
    pub rim: Option<(usize, f64)>,
}

impl Entry {
    fn new(hole: bool, source: f64) -> Entry {
        Entry { hole, source, rim: None }
    }
}

const MAX_STRETCH: f64 = 2.0;

/// Runs the gather pipeline's march for each target pixel, over the whole row.
pub fn gather_row(p: &[f64], width: usize) -> Vec<Entry> {
    (0..width)
        .map(|t| {
            let target = t as f64;
            let mut rim = None;
            let mut hit = None;
            let mut edge = if p[0] > target { Some((p[0], 0)) } else { None };
            if p[0] > target && p[0] - target <= 0.5 {
                hit = Some(0.0);
            }
            for x in 1..p.len() {
                let (a, b) = (p[x - 1], p[x]);
                if hit.is_some() {
                    break;
                }
                if a > target {
                    continue;
                }
                if b > target {
                    if b - a < MAX_STRETCH {
                        hit = Some((x - 1) as f64 + (target - a) / (b - a));
                        continue;
                    }
                    if b - target < 1.0 {
                        rim = rim.or(Some((x, 1.0 - (b - target))));
                    }
                    let displacement = a - (x - 1) as f64;
                    if target - a < 0.5 {
                        hit = Some((x - 1) as f64);
                    } else if edge.is_none_or(|(d, _)| displacement < d) {
                        edge = Some((displacement, x - 1));
                    }
                } else if target - a < 1.0 && b < a {
                    rim = rim.or(Some((x - 1, 1.0 - (target - a))));
                }
            }
            let last = p.len() - 1;
            let entry = match (hit, edge) {
                (Some(source), _) => Entry::new(false, source),
                (None, Some((_, x))) => Entry::new(true, x as f64),
                (None, None) => Entry::new(!(p[last] <= target && target - p[last] < 0.5), last as f64),
            };
            match rim {
                Some((x, coverage)) if coverage >= 0.5 => Entry { hole: false, source: x as f64, rim },
                _ => Entry { rim, ..entry },
            }
        })
        .collect()
}
