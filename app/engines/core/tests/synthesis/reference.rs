//! A plain f64 version of gather, without tiles, and the fill of holes that any view shares: what the shaders must
//! compute.

use yoro::eyes::{Eye, Warp};
use yoro_test_support::laws::{positions, row};

/// One target pixel, in forward columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// What the source map tells of the pixel.
    pub hole: bool,
    pub source: f64,
    /// The column that is seen behind a silhouette.
    column: f64,
    /// For a hole, how many pixels its edge, which is at `column`, is away.
    away: Option<f64>,
    /// A silhouette in front: its column, and the share of the pixel that it covers.
    rim: Option<(usize, f64)>,
    /// True if a pipeline with open holes leaves the pixel open.
    pub open: bool,
}

impl Entry {
    fn new(column: f64, away: Option<f64>, rim: Option<(usize, f64)>, outermost: bool) -> Entry {
        let is_covered = rim.filter(|(_, coverage)| *coverage >= 0.5);
        let source = is_covered.map_or(column, |(x, _)| x as f64);
        let open = away.is_some() || rim.is_some() || outermost;
        Entry { hole: away.is_some() && is_covered.is_none(), source, column, away, rim, open }
    }

    /// True if the colour is a mean of several surfaces or samples.
    pub fn is_blended(&self) -> bool {
        self.away.is_some() || self.rim.is_some()
    }

    /// Returns the entry with the column that a shader has found, except where several columns make the colour.
    pub fn at(self, source: f64) -> Entry {
        if self.is_blended() { self } else { Entry { column: source, ..self } }
    }
}

pub type Color = [f64; 4];

pub fn mix(a: Color, b: Color, t: f64) -> Color {
    std::array::from_fn(|c| a[c] + t * (b[c] - a[c]))
}

/// Returns the colour of a hole. `color` is that of its edge, which is `away` pixels from it. `tap` returns the sample
/// at a distance beside the edge: how much nearer it is, in pixels of disparity, and its colour.
pub fn filled(color: Color, away: f64, tap: impl Fn(f64) -> (f64, Color)) -> Color {
    let spread = 0.5 * away.abs().clamp(1.0, 12.0);
    let mut sum = color.map(|v| 2.0 * v);
    let mut weights = 2.0;
    for k in [-2.0, -1.0, 1.0, 2.0] {
        let (nearer, color) = tap((k * spread).round_ties_even());
        if nearer <= 1.0 {
            sum = std::array::from_fn(|c| sum[c] + color[c]);
            weights += 1.0;
        }
    }
    sum.map(|v| v / weights)
}

/// A rendered eye, with rows from the bottom.
pub struct Picture<'a> {
    pub rgba: &'a [u8],
    pub depth: &'a [f32],
    pub warp: &'a Warp,
}

impl Picture<'_> {
    /// Returns the index of a pixel by its forward column and its row. Beyond the borders these repeat.
    fn pixel(&self, x: f64, row: f64) -> usize {
        let last = self.warp.source_size.map(|n| f64::from(n) - 1.0);
        let x = x.clamp(0.0, last[0]);
        let column = if self.is_mirrored() { last[0] - x } else { x };
        row.clamp(0.0, last[1]) as usize * self.warp.source_size[0] as usize + column as usize
    }

    fn is_mirrored(&self) -> bool {
        self.warp.target_eye == Eye::Right
    }

    /// Returns how far a pixel moves, without the offset that all have.
    fn displacement(&self, x: f64, row: f64) -> f64 {
        let scale = if self.is_mirrored() { -self.warp.law.scale } else { self.warp.law.scale };
        scale * f64::from(self.depth[self.pixel(x, row)])
    }

    fn color_at(&self, x: f64, row: f64) -> Color {
        let texel = |x| self.rgba[self.pixel(x, row) * 4..][..4].iter().map(|v| f64::from(*v));
        let [a, b] = [x.floor(), x.floor() + 1.0].map(|x| {
            let mut channels = texel(x);
            std::array::from_fn(|_| channels.next().unwrap())
        });
        mix(a, b, x - x.floor())
    }

    /// Returns the colour of an entry of a row, which may lie beyond the picture.
    pub fn color(&self, entry: &Entry, row: f64) -> Color {
        let mut seen = self.color_at(entry.column, row);
        if let Some(away) = entry.away {
            let edge = self.displacement(entry.column, row);
            seen = filled(seen, away, |distance| {
                let row = row + distance;
                (self.displacement(entry.column, row) - edge, self.color_at(entry.column, row))
            });
        }
        entry.rim.map_or(seen, |(x, coverage)| mix(seen, self.color_at(x as f64, row), coverage))
    }
}

const MAX_STRETCH: f64 = 2.0;

/// True if the neighbour before a column, or the one after it, is farther by more than a pixel of displacement.
fn ends(p: &[f64], x: usize, after: bool) -> bool {
    match after {
        false => x > 0 && p[x] - p[x - 1] >= MAX_STRETCH,
        true => p.get(x + 1).is_some_and(|next| *next < p[x]),
    }
}

/// A surface ends in a row if a row beside shows something farther by more pixels of displacement than this.
const ROW_GAP: f64 = 4.0;

/// Returns which pixels of the target a pipeline with open holes leaves open.
pub fn open_pixels(depth: &[f32], warp: &Warp) -> Vec<bool> {
    let [[ws, hs], [wt, ht]] = [warp.source_size, warp.target_size].map(|s| s.map(|n| n as i32));
    let rows = (0..ht).flat_map(|y| {
        let [at, above, below] = [0, 1, -1].map(|away| {
            let source_y = (y - warp.row_offset + away).clamp(0, hs - 1);
            positions(row(depth, source_y as usize, ws as usize), warp)
        });
        let mut entries = gather_row(&at, &[above, below], wt as usize);
        if warp.target_eye == Eye::Right {
            entries.reverse();
        }
        entries
    });
    rows.map(|entry| entry.open).collect()
}

/// Runs the gather pipeline's march for each target pixel, over the whole row. Open pixels depend on the rows beside, too.
pub fn gather_row(p: &[f64], beside: &[Vec<f64>], width: usize) -> Vec<Entry> {
    let ends_in_row = |x: usize| beside.iter().any(|row| p[x] - row[x] > ROW_GAP);
    (0..width)
        .map(|t| {
            let target = t as f64;
            let mut rim = None;
            let mut hit = None;
            // True if the surface that is hit ends at one of the columns that make the pixel's colour.
            let mut outermost = false;
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
                        outermost = ends(p, x - 1, false) || ends(p, x, true);
                        continue;
                    }
                    if b - target < 1.0 {
                        rim = rim.or(Some((x, 1.0 - (b - target))));
                    }
                    let displacement = a - (x - 1) as f64;
                    if target - a < 0.5 {
                        hit = Some((x - 1) as f64);
                        outermost = ends(p, x - 1, false);
                    } else if edge.is_none_or(|(d, _)| displacement < d) {
                        edge = Some((displacement, x - 1));
                    }
                } else if target - a < 1.0 && b < a {
                    rim = rim.or(Some((x - 1, 1.0 - (target - a))));
                }
            }
            let last = p.len() - 1;
            let away = |x: usize| (p[x] - target).abs();
            match (hit, edge) {
                (Some(column), _) => Entry::new(column, None, rim, outermost || ends_in_row(column as usize)),
                (None, Some((_, x))) => Entry::new(x as f64, Some(away(x)), rim, false),
                (None, None) => {
                    Entry::new(last as f64, Some(away(last)).filter(|away| *away >= 0.5), rim, false)
                }
            }
        })
        .collect()
}
