//! Plain f64 versions of the pipelines, for tests: what the shaders must compute, without tiles or threads.

use yoro::eyes::{Eye, Warp};

/// One target pixel: a source column in forward columns, and whether it is a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    pub hole: bool,
    pub source: f64,
    /// A silhouette in front: its column, and how much of the pixel it covers.
    pub rim: Option<(usize, f64)>,
}

impl Entry {
    fn new(hole: bool, source: f64) -> Entry {
        Entry { hole, source, rim: None }
    }
}

const MAX_STRETCH: f64 = 2.0;

/// Displaced positions of one source row in forward columns.
pub fn positions(depth_row: &[f32], warp: &Warp) -> Vec<f64> {
    let columns = depth_row.len();
    // For the right eye columns count from the right, in source and target.
    let mirrored = warp.target_eye == Eye::Right;
    (0..columns)
        .map(|x| {
            let column = if mirrored { columns - 1 - x } else { x };
            let target = column as f64 + warp.law.offset + warp.law.scale * depth_row[column] as f64;
            if mirrored { f64::from(warp.target_size[0]) - 1.0 - target } else { target }
        })
        .collect()
}

/// The gather pipeline's march over the whole row for each target pixel.
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

/// One ImBuffer entry of Algorithm 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImBufferEntry {
    Valid(f64),
    Disocclusion { left: i64, width: i64 },
}

/// Algorithm 2 at scale 1, as corrected: first writer wins in forward order, the tracker follows the running
/// maximum, valid entries are never overwritten.
pub fn paper_row(p: &[f64], width: usize, strict: bool) -> Vec<ImBufferEntry> {
    let mut entries: Vec<Option<ImBufferEntry>> = vec![None; width];
    let mut reached = -1i64;
    for (x, &position) in p.iter().enumerate() {
        let target = (position + 0.5).floor() as i64;
        if target < 0 || target >= width as i64 {
            continue;
        }
        if matches!(entries[target as usize], Some(ImBufferEntry::Valid(_))) {
            continue;
        }
        for i in reached + 1..target {
            entries[i as usize] =
                Some(ImBufferEntry::Disocclusion { left: reached, width: target - reached });
        }
        let source = if strict {
            x as f64
        } else {
            (x as f64 + target as f64 - position).clamp(0.0, (p.len() - 1) as f64)
        };
        entries[target as usize] = Some(ImBufferEntry::Valid(source));
        reached = reached.max(target);
    }
    let width = width as i64;
    let rest = ImBufferEntry::Disocclusion { left: reached, width: width - reached };
    entries.into_iter().map(|e| e.unwrap_or(rest)).collect()
}
