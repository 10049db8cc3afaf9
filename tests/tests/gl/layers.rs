//! Compares synthesis from anti-aliased sources with a simple reference in f64, whose rows are in forward columns.

use std::rc::Rc;

use yoro::eyes::{DepthConvention, Eye, GuardBand, Warp};
use yoro::synthesis::{Edges, SOURCE_MAP_HOLE};
use yoro_gl::Context;
use yoro_test_support::samples::{GIVEN, STANDARD, Samples, example, on_opengl};
use yoro_tests::on_every_backend;

const LINK: f64 = 0.5;
const TILE: [usize; 2] = [16, 8];

type Color = [f64; 3];

fn mix(parts: &[(f64, Color)]) -> Color {
    std::array::from_fn(|c| parts.iter().map(|(weight, color)| weight * color[c]).sum())
}

fn distance_squared(a: Color, b: Color) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum()
}

/// A picture in forward columns. Coordinates outside of it are clamped to the border.
pub struct Image<T> {
    size: [usize; 2],
    values: Vec<T>,
}

impl<T: Copy> Image<T> {
    fn of(size: [usize; 2], value: impl Fn(usize, usize) -> T) -> Image<T> {
        let [w, h] = size;
        Image { size, values: (0..w * h).map(|i| value(i % w, i / w)).collect() }
    }

    pub fn at(&self, x: i64, y: i64) -> T {
        let [w, h] = self.size.map(|n| n as i64);
        self.values[(y.clamp(0, h - 1) * w + x.clamp(0, w - 1)) as usize]
    }
}

#[derive(Clone, Copy, Debug)]
struct Back {
    reach: f64,
    color: Color,
}

/// The surfaces of a pixel. Displacements are in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    front: f64,
    color: Color,
    /// The colour of the whole pixel.
    resolved: Color,
    mask: [f64; 4],
    back: Option<Back>,
}

impl Layer {
    pub fn is_split(&self) -> bool {
        self.back.is_some()
    }

    fn share(&self) -> f64 {
        self.mask.iter().sum::<f64>() / 4.0
    }

    /// Returns the displacement of the back, or a large value without a back. Colour and links follow likewise.
    fn reach(&self) -> f64 {
        self.back.map_or(1e9, |back| back.reach)
    }
}

const RING: [(i64, i64); 8] = [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)];
const NEXT: [(i64, i64); 4] = [(-2, 0), (2, 0), (0, -2), (0, 2)];

/// Colours and displacements of each pixel's four stripes.
pub struct Pixels {
    colors: Image<[Color; 4]>,
    reaches: Image<[f64; 4]>,
    resolved: Image<Color>,
}

/// Returns which samples the front covers, and the displacements of the front and, if there is one, the back.
fn surfaces(reaches: [f64; 4]) -> ([bool; 4], f64, Option<f64>) {
    let nearest = reaches.into_iter().fold(f64::MIN, f64::max);
    let front = reaches.map(|reach| reach > nearest - LINK);
    let mean = |taken: [bool; 4]| {
        let taken: Vec<_> = (0..4).filter(|&k| taken[k]).map(|k| reaches[k]).collect();
        taken.iter().sum::<f64>() / taken.len() as f64
    };
    let second = (0..4).filter(|&k| !front[k]).map(|k| reaches[k]).fold(f64::MIN, f64::max);
    let behind = std::array::from_fn(|k| !front[k] && reaches[k] > second - LINK);
    (front, mean(front), (front != [true; 4]).then(|| mean(behind)))
}

pub fn multisample_layers(pixels: &Pixels, with_colors: bool) -> Image<Layer> {
    Image::of(pixels.colors.size, |x, y| {
        let (x, y) = (x as i64, y as i64);
        let (in_front, front, back) = surfaces(pixels.reaches.at(x, y));
        let resolved = pixels.resolved.at(x, y);
        let mask = in_front.map(|is| f64::from(u8::from(is)));
        let share = mask.iter().sum::<f64>() / 4.0;
        let Some(reach) = back else { return Layer { front, color: resolved, resolved, mask, back: None } };
        let color = if with_colors {
            let colors = pixels.colors.at(x, y);
            let parts: Vec<_> =
                (0..4).filter(|&k| !in_front[k]).map(|k| (0.25 / (1.0 - share), colors[k])).collect();
            mix(&parts)
        } else {
            let (mut fronts, mut backs) = (Vec::new(), Vec::new());
            for (i, (dx, dy)) in RING.into_iter().enumerate() {
                let (_, other, None) = surfaces(pixels.reaches.at(x + dx, y + dy)) else { continue };
                let tap = (if i < 4 { 2.0 } else { 1.0 }, pixels.resolved.at(x + dx, y + dy));
                if (other - front).abs() < LINK {
                    fronts.push(tap);
                }
                if (other - reach).abs() < LINK {
                    backs.push(tap);
                }
            }
            match (mean(&fronts), mean(&backs)) {
                (Some(front), Some(back)) => {
                    let of = |c: usize, pick: fn(f64, f64) -> f64| {
                        backs.iter().map(|(_, tap)| tap[c]).reduce(pick).expect("there is a back")
                    };
                    let shared = shared_back(resolved, front, back, share);
                    std::array::from_fn(|c| shared[c].clamp(of(c, f64::min), of(c, f64::max)))
                }
                (Some(front), None) => std::array::from_fn(|c| {
                    ((resolved[c] - share * front[c]) / (1.0 - share)).clamp(0.0, 1.0)
                }),
                (None, Some(back)) => back,
                (None, None) => resolved,
            }
        };
        with_back(front, resolved, mask, Back { reach, color })
    })
}

fn mean(taps: &[(f64, Color)]) -> Option<Color> {
    let sum: f64 = taps.iter().map(|(weight, _)| weight).sum();
    (sum > 0.0).then(|| mix(taps).map(|value| value / sum))
}

fn shared_back(resolved: Color, front: Color, back: Color, share: f64) -> Color {
    let n = share.powi(2) + (1.0 - share).powi(2);
    std::array::from_fn(|c| {
        let residual = resolved[c] - share * front[c] - (1.0 - share) * back[c];
        (back[c] + residual * (1.0 - share) / n).clamp(0.0, 1.0)
    })
}

/// Makes a layer with a back. The front's colour is the resolved colour without the back's share.
fn with_back(front: f64, resolved: Color, mask: [f64; 4], back: Back) -> Layer {
    let share = mask.iter().sum::<f64>() / 4.0;
    let color =
        std::array::from_fn(|c| ((resolved[c] - (1.0 - share) * back.color[c]) / share).clamp(0.0, 1.0));
    Layer { front, color, resolved, mask, back: Some(back) }
}

/// Splits a pixel with one depth. Returns the displacements of front and back, and true if the depth is the back's.
fn split(reach: &Image<f64>, x: i64, y: i64, apart: f64, first_sample: bool) -> Option<(f64, f64, bool)> {
    let here = reach.at(x, y);
    let all = RING.map(|(dx, dy)| reach.at(x + dx, y + dy));
    let least = |taps: &[f64]| taps.iter().copied().fold(f64::MAX, f64::min);
    let most = |taps: &[f64]| taps.iter().copied().fold(f64::MIN, f64::max);
    let low = if least(&all[..4]) < here - apart { least(&all[..4]) } else { least(&all) };
    let high = if most(&all[..4]) > here + apart { most(&all[..4]) } else { most(&all) };
    let front_like = low < here - apart;
    let back_like = first_sample && high > here + apart;
    if back_like && !(front_like && here - low > high - here) {
        return Some((high, here, true));
    }
    front_like.then_some((here, low, false)).or(back_like.then_some((high, here, true)))
}

fn resolved_layers(reach: &Image<f64>, resolved: &Image<Color>, first_sample: bool) -> Image<Layer> {
    const NOISE: f64 = 256.0 / (255.0 * 255.0);
    let apart = if first_sample { 2.0 } else { 0.5 };
    let pure = |x: i64, y: i64| {
        RING.iter().all(|(dx, dy)| {
            let apart_by = reach.at(x + dx, y + dy) - reach.at(x, y);
            apart_by >= -apart && (!first_sample || apart_by <= apart)
        })
    };
    Image::of(reach.size, |x, y| {
        let (x, y) = (x as i64, y as i64);
        let here = resolved.at(x, y);
        let single = Layer { front: reach.at(x, y), color: here, resolved: here, mask: [1.0; 4], back: None };
        let Some((front, back, shows_back)) = split(reach, x, y, apart, first_sample) else { return single };
        // Taps of front and back: the pure ones, and all.
        let mut taps: [[Vec<(f64, Color)>; 2]; 2] = Default::default();
        for (dx, dy) in RING.into_iter().chain(NEXT) {
            let tap = (4.0 / (dx * dx + dy * dy) as f64, resolved.at(x + dx, y + dy));
            for (surface, of) in taps.iter_mut().zip([front, back]) {
                if (reach.at(x + dx, y + dy) - of).abs() < apart {
                    surface[1].push(tap);
                    if pure(
                        (x + dx).clamp(0, reach.size[0] as i64 - 1),
                        (y + dy).clamp(0, reach.size[1] as i64 - 1),
                    ) {
                        surface[0].push(tap);
                    }
                }
            }
        }
        let any_front = mean(&taps[0][1]).unwrap_or(here);
        let mut front_color = mean(&taps[0][0]).unwrap_or(any_front);
        let mut back_color = mean(&taps[1][0]).or(mean(&taps[1][1])).unwrap_or(here);
        if first_sample && taps[1][0].is_empty() {
            let mut most = distance_squared(back_color, front_color);
            for &(_, tap) in &taps[1][1] {
                if distance_squared(tap, front_color) > most {
                    (most, back_color) = (distance_squared(tap, front_color), tap);
                }
            }
        }
        if taps[0][0].is_empty() {
            let (mut most, mut best) =
                if shows_back { (0.0, any_front) } else { (distance_squared(here, back_color), here) };
            for (dx, dy) in RING {
                let tap = resolved.at(x + dx, y + dy);
                let fits = (reach.at(x + dx, y + dy) - front).abs() < apart;
                if fits && distance_squared(tap, back_color) > most {
                    (most, best) = (distance_squared(tap, back_color), tap);
                }
            }
            front_color = best;
        }
        let along: f64 = (0..3).map(|c| (here[c] - back_color[c]) * (front_color[c] - back_color[c])).sum();
        let prior = if shows_back { 0.4 } else { 0.6 };
        let contrast = distance_squared(front_color, back_color);
        let mut share = ((along + NOISE * prior) / (contrast + NOISE)).clamp(0.0, 1.0);
        share = match (first_sample, shows_back) {
            (false, _) => share.max(0.125),
            (true, true) => share.min(0.75),
            (true, false) => share.max(0.25),
        };
        if shows_back && share < 0.1 {
            return single;
        }
        if share > 0.95 {
            return Layer { front, ..single };
        }
        let goes_on = |x: i64| {
            let x = x.clamp(0, reach.size[0] as i64 - 1);
            let beside = split(reach, x, y, apart, first_sample).map_or(reach.at(x, y), |s| s.0);
            (beside - front).abs() < apart
        };
        let mask = std::array::from_fn(|j| match (goes_on(x - 1), goes_on(x + 1)) {
            (true, false) => (4.0 * share - j as f64).clamp(0.0, 1.0),
            (false, true) => (4.0 * share - (3 - j) as f64).clamp(0.0, 1.0),
            _ => share,
        });
        let color = shared_back(here, front_color, back_color, share);
        with_back(front, here, mask, Back { reach: back, color })
    })
}

/// Returns for each target tile the displacement at which the search begins, and the number of columns to search. The
/// tile passes determine them in sixteenths of a pixel.
pub fn spans(layers: &Image<Layer>, width: usize, range: [f64; 2]) -> Image<Option<(f64, i64)>> {
    let [far, near] = range;
    let [w, h] = layers.size;
    let tiles = [w.div_ceil(TILE[0]), h.div_ceil(TILE[1])];
    let interval = Image::of(tiles, |i, j| {
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for y in j * TILE[1]..(j + 1) * TILE[1] {
            for x in i * TILE[0]..=(i + 1) * TILE[0] {
                let layer = layers.at(x as i64, y as i64);
                low = low.min(layer.back.map_or(layer.front, |back| back.reach));
                high = high.max(layer.front);
            }
        }
        [((low - far) * 16.0).floor(), ((high - far) * 16.0).ceil()]
    });
    Image::of([width.div_ceil(TILE[0]), tiles[1]], |i, j| {
        let first = (i * TILE[0]) as f64;
        let last = first + 15.0;
        let clamp = |tile: f64| tile.clamp(0.0, (tiles[0] - 1) as f64) as usize;
        let from = clamp(((first - near - 1.0) / 16.0).floor() - 1.0);
        let to = clamp(((last - far + 1.0) / 16.0).floor());
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for s in from..=to {
            let least = ((first - 1.0 - far - ((s + 1) * 16) as f64) * 16.0).floor();
            let most = ((last + 1.0 - far - (s * 16) as f64) * 16.0).ceil();
            let [lowest, highest] = interval.at(s as i64, j as i64);
            let (lowest, highest) = (lowest.max(least), highest.min(most));
            if lowest <= highest {
                (low, high) = (low.min(lowest), high.max(highest));
            }
        }
        (high >= low).then(|| (far + high / 16.0, ((high - low) / 16.0).ceil() as i64 + 2))
    })
}

fn covered(mask: [f64; 4], stripe: impl Fn(usize) -> f64) -> f64 {
    (0..4).map(|j| mask[j] * stripe(j)).sum::<f64>() / 4.0
}

fn right_of(place: f64) -> impl Fn(usize) -> f64 {
    move |j| ((j + 1) as f64 - 4.0 * place).clamp(0.0, 1.0)
}

fn left_of(place: f64) -> impl Fn(usize) -> f64 {
    move |j| 1.0 - ((j + 1) as f64 - 4.0 * place).clamp(0.0, 1.0)
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    x: i64,
    back: bool,
    reach: f64,
    weight: f64,
}

/// Numbers of texels that the shader fetches for a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fetches {
    /// Fetches of the layers.
    pub layers: u32,
    /// Fetches of colour: a filtered one for a single surface, or two for each participating layer.
    pub colors: u32,
}

/// Composes the surfaces that cover a target pixel, from front to back.
struct Composition {
    color: Color,
    rest: f64,
    fetches: Fetches,
}

impl Composition {
    fn add(&mut self, share: f64, color: Color) {
        self.fetches.colors += 2 * u32::from(share > 0.0);
        self.color = mix(&[(1.0, self.color), (self.rest * share, color)]);
        self.rest *= 1.0 - share;
    }
}

/// Interpolates between the inner two of four columns, and returns the colour and how many columns were needed. Keys'
/// cubic convolution: "Cubic Convolution Interpolation for Digital Image Processing" (1981), equation 15 for u(s) with
/// a = -3/4, clamped to the inner two.
fn sharp_color(columns: [Color; 4], f: f64) -> (Color, u32) {
    const A: f64 = -0.75;
    let [_, here, next, _] = columns;
    if (0..3).all(|c| (next[c] - here[c]).abs() <= 8.0 / 255.0) {
        return (mix(&[(1.0 - f, here), (f, next)]), 2);
    }
    let kernel = |s: f64| match s.abs() {
        s if s <= 1.0 => (A + 2.0) * s.powi(3) - (A + 3.0) * s.powi(2) + 1.0,
        s => A * (s.powi(3) - 5.0 * s.powi(2) + 8.0 * s - 4.0),
    };
    let sum: Color =
        std::array::from_fn(|c| (0..4).map(|i| kernel(f + 1.0 - i as f64) * columns[i][c]).sum());
    (std::array::from_fn(|c| sum[c].clamp(here[c].min(next[c]), here[c].max(next[c]))), 4)
}

/// Returns the colour of target pixel (t, y), true if most of it is filled from beside the hole, and the fetches.
pub fn march(layers: &Image<Layer>, t: f64, y: i64, span: Option<(f64, i64)>) -> (Color, bool, Fetches) {
    let last = layers.size[0] as i64 - 1;
    let (mut x, limit) = match span {
        Some((reach, steps)) => {
            let x = ((t - reach - 1.01).floor() as i64).clamp(0, last);
            (x, (x + steps + 2).min(last))
        }
        // Outside of the picture.
        None => {
            let border = if t < layers.size[0] as f64 / 2.0 { 0 } else { last };
            return (layers.at(border, y).color, true, Fetches { layers: 2, colors: 1 });
        }
    };
    let mut out = Composition { color: [0.0; 3], rest: 1.0, fetches: Fetches { layers: 2, colors: 0 } };
    let (mut edge, mut second): (Option<Candidate>, Option<Candidate>) = (None, None);
    let mut here = layers.at(x, y);
    if x == 0 {
        for (back, reach) in [(false, here.front), (true, here.reach())] {
            if reach > t && reach < edge.map_or(1e9, |e| e.reach) {
                edge = Some(Candidate { x, back, reach, weight: 1.0 });
            }
        }
    }
    let before = layers.at(x - 1, y);
    let linked = |a: f64, b: f64| a < 1e8 && b < 1e8 && (a - b).abs() < LINK;
    let mut on_front = x > 0 && linked(before.front, here.reach());
    let mut on_back = x > 0 && linked(before.reach(), here.reach());
    // The shader's short way handles single surfaces that are linked from the first column on.
    let mut plain = here.back.is_none() && x as f64 + here.front <= t;
    while x < limit && out.rest > 0.01 {
        let next = layers.at(x + 1, y);
        let goes_on = plain && next.back.is_none() && linked(here.front, next.front);
        // The long way fetches again the layer that ended the short way, and the layer before it if it is split.
        let again = u32::from(plain && !goes_on) + u32::from(plain && !goes_on && here.back.is_some());
        out.fetches.layers += 1 + again;
        plain = goes_on;
        let (a, b) = (x as f64 + here.front - t, (x + 1) as f64 + next.front - t);
        let (c, d) = (x as f64 + here.reach() - t, (x + 1) as f64 + next.reach() - t);
        let front_front = linked(here.front, next.front);
        let front_back = linked(here.front, next.reach());
        let back_front = linked(here.reach(), next.front);
        let back_back = linked(here.reach(), next.reach());
        if front_front && a <= 0.0 && b > 0.0 {
            let g = -a / (b - a);
            let (of_here, of_next) = (covered(here.mask, right_of(g)), covered(next.mask, left_of(g)));
            let share = of_here + of_next;
            if share > 0.0 {
                if plain {
                    let (color, fetched) =
                        sharp_color([-1, 0, 1, 2].map(|i| layers.at(x + i, y).resolved), g);
                    out.add(share, color);
                    out.fetches.colors = fetched;
                } else {
                    out.add(share, mix(&[(of_here / share, here.color), (of_next / share, next.color)]));
                    out.fetches.colors += 2;
                }
            }
        }
        let rises = next.front > here.front || next.back.is_some();
        if !front_front && rises && !back_front && b > 0.0 && b < 1.0 {
            out.add(covered(next.mask, left_of(1.0 - b)), next.color);
        }
        let falls = next.front < here.front || here.back.is_some();
        if !front_front && falls && !front_back && a <= 0.0 && a > -1.0 {
            out.add(covered(here.mask, right_of(-a)), here.color);
        }
        let colors = |layer: &Layer| layer.back.map_or(layer.color, |back| back.color);
        for (link, from, from_color, to, to_color) in [
            (front_back, a, here.color, d, colors(&next)),
            (back_front, c, colors(&here), b, next.color),
            (back_back, c, colors(&here), d, colors(&next)),
        ] {
            if link && out.rest > 0.01 && from <= 0.0 && to > 0.0 {
                let g = -from / (to - from);
                out.add(1.0, mix(&[(1.0 - g, from_color), (g, to_color)]));
            }
        }
        let ends = here.back.filter(|_| !back_front && !back_back);
        if let Some(back) = ends
            && out.rest > 0.01
            && !on_front
            && !on_back
            && c.abs() < 1.0
        {
            let others = here.mask.map(|m| 1.0 - m);
            let share =
                if c <= 0.0 { covered(others, right_of(-c)) } else { covered(others, left_of(1.0 - c)) };
            out.add(share, back.color);
        }
        if out.rest > 0.01 {
            let at_back = ends.filter(|back| next.front > back.reach && c <= 0.0);
            let at_front =
                here.back.is_none() && !front_front && !front_back && next.front > here.front && a <= 0.0;
            let found = match at_back {
                Some(back) => {
                    let weight = if on_front { 1.0 } else { 1.0 - here.share() };
                    Some((Candidate { x, back: true, reach: back.reach, weight }, -c, back.color))
                }
                None => at_front.then_some((
                    Candidate { x, back: false, reach: here.front, weight: 1.0 },
                    -a,
                    here.color,
                )),
            };
            if let Some((found, away, color)) = found {
                if found.weight == 1.0 && away < 0.5 {
                    out.add(1.0, color);
                }
                if found.reach < edge.map_or(1e9, |e| e.reach) {
                    if found.weight < 1.0 {
                        second = edge;
                    }
                    edge = Some(found);
                } else if found.reach < second.map_or(1e9, |e| e.reach) {
                    second = Some(found);
                }
            }
        }
        (on_front, on_back) = (front_back, back_back);
        here = next;
        x += 1;
    }
    let mut hole = out.rest > 0.5;
    if out.rest > 0.01 {
        let beyond = edge.is_none();
        let edge = edge.unwrap_or(Candidate {
            x,
            back: here.back.is_some(),
            reach: here.back.map_or(here.front, |back| back.reach),
            weight: 1.0,
        });
        let away = (t - edge.x as f64 - edge.reach).abs();
        let spread = 0.5 * away.clamp(1.0, 12.0);
        let rows = if beyond && away < 0.5 { 0 } else { 2 };
        let taps: Vec<(f64, Color)> = (-rows..=rows)
            .filter_map(|i| {
                let layer = layers.at(edge.x, y + (f64::from(i) * spread).round_ties_even() as i64);
                let middle = if i == 0 { 2.0 } else { 1.0 };
                match layer.back {
                    Some(back) if i == 0 && edge.back => Some((middle, back.color)),
                    _ if i == 0 || layer.front <= edge.reach + 1.0 => Some((middle, layer.color)),
                    Some(back) if back.reach <= edge.reach + 1.0 => Some((1.0 - layer.share(), back.color)),
                    _ => None,
                }
            })
            .collect();
        let mut fill = mean(&taps).expect("the edge itself is there");
        if let Some(second) = second
            && edge.weight < 1.0
        {
            let layer = layers.at(second.x, y);
            let color = if second.back { layer.back.expect("it has one").color } else { layer.color };
            fill = mix(&[(edge.weight, fill), (1.0 - edge.weight, color)]);
        }
        hole = hole && away >= 0.5;
        out.add(1.0, fill);
        out.fetches.layers += 2 * rows as u32 + 1;
        out.fetches.colors += 4 * rows as u32;
    }
    (out.color, hole, out.fetches)
}

/// Converts samples to the reference's form: forward columns, stripes from left to right, displacements.
pub fn forward(samples: &Samples, warp: &Warp) -> (Pixels, [f64; 2]) {
    let mirrored = warp.target_eye == Eye::Right;
    let size = samples.size.map(|n| n as usize);
    let law = warp.law;
    let (offset, scale) = if mirrored {
        let wider = f64::from(warp.target_size[0]) - f64::from(warp.source_size[0]);
        (wider - law.offset, -law.scale)
    } else {
        (law.offset, law.scale)
    };
    let mut stripes = [0, 1, 2, 3];
    stripes.sort_by(|&a: &usize, &b| STANDARD[a][0].total_cmp(&STANDARD[b][0]));
    if mirrored {
        stripes.reverse();
    }
    let column = |x: usize| if mirrored { size[0] - 1 - x } else { x };
    let color =
        |rgba: &[u8], i: usize| -> Color { std::array::from_fn(|c| f64::from(rgba[4 * i + c]) / 255.0) };
    let resolved = samples.resolved();
    let index = |x: usize, y: usize| y * size[0] + column(x);
    let pixels = Pixels {
        colors: Image::of(size, |x, y| stripes.map(|k| color(&samples.rgba[k], index(x, y)))),
        reaches: Image::of(size, |x, y| {
            stripes.map(|k| offset + scale * f64::from(samples.depth[k][index(x, y)]))
        }),
        resolved: Image::of(size, |x, y| color(&resolved, index(x, y))),
    };
    let (near, far) = match warp.convention {
        DepthConvention::Standard => (0.0, 1.0),
        DepthConvention::Reversed => (1.0, 0.0),
    };
    (pixels, [offset + scale * far, offset + scale * near])
}

fn agrees(
    gl: &Rc<Context>,
    given: (Edges, bool),
    dominant: Eye,
    convention: DepthConvention,
    guard: GuardBand,
) {
    let (warp, samples) = example(dominant, convention, guard);
    let (rgba, map) = on_opengl(gl, &samples, given, &warp);
    let (pixels, range) = forward(&samples, &warp);
    let one_depth = |choose: fn([f64; 4]) -> f64| {
        Image::of(pixels.reaches.size, |x, y| choose(pixels.reaches.at(x as i64, y as i64)))
    };
    let layers = match given {
        (Edges::Nearest, _) => {
            resolved_layers(&one_depth(|r| r.into_iter().fold(f64::MIN, f64::max)), &pixels.resolved, false)
        }
        (Edges::Sample, _) => {
            // Sample 0 is the second from the left.
            let reach = match warp.target_eye {
                Eye::Left => one_depth(|r| r[1]),
                Eye::Right => one_depth(|r| r[2]),
            };
            resolved_layers(&reach, &pixels.resolved, true)
        }
        (_, colors) => multisample_layers(&pixels, colors),
    };
    let [w, h] = warp.target_size.map(|n| n as usize);
    let spans = spans(&layers, w, range);
    let (mut different, mut holes) = (0, 0);
    for y in 0..h {
        for t in 0..w {
            let span = spans.at((t / TILE[0]) as i64, (y / TILE[1]) as i64);
            let (color, hole, _) = march(&layers, t as f64, y as i64, span);
            let at = y * w + if warp.target_eye == Eye::Right { w - 1 - t } else { t };
            let got = &rgba[4 * at..];
            let error = (0..3).map(|c| (f64::from(got[c]) - 255.0 * color[c]).abs()).fold(0.0, f64::max);
            holes += usize::from(hole);
            different += usize::from(error > 3.0 || hole != (map[at] & SOURCE_MAP_HOLE != 0));
        }
    }
    assert!(holes > w * h / 100, "{given:?}: {holes} holes: the picture shows too little");
    assert!(
        different * 1000 <= w * h,
        "{given:?}, {dominant:?}, {convention:?}: {different} of {} pixels differ",
        w * h
    );
}

#[test]
fn anti_aliased_sources_equal_the_f64_reference() {
    on_every_backend(|gl| {
        for given in GIVEN {
            agrees(gl, given, Eye::Right, DepthConvention::Standard, GuardBand::Pixels(21));
            agrees(gl, given, Eye::Left, DepthConvention::Reversed, GuardBand::None);
        }
        Ok(())
    })
    .unwrap();
}
