//! Telea's and the Navier-Stokes patcher: a front marches inwards from the border of a hole at unit speed, and each
//! pixel that it reaches becomes a weighted mean of the known pixels around it.
//!
//! Holes that are so far apart that no pixel is read for both are filled on separate threads. The result is the same as
//! on one thread.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::{Duration, Instant};

use image::Rgb;
use rayon::prelude::*;

use super::patcher::{HOLE, PatchTime, Patched, Patcher, Reprojected, around};

/// The radius in pixels within which known pixels are averaged.
const RADIUS: i32 = 3;
/// The cosine or projection below which a direction does not count.
const SIDEWAYS: f64 = 0.01;
/// The weight that such a direction gets instead, so that the mean is always defined.
const LEAST_WEIGHT: f64 = 1e-6;

/// The weighting of the surrounding pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// A. Telea, "An image inpainting technique based on the fast marching method", 2004, equations 3 and 4: by the
    /// front's direction, the distance, and the distance from the hole's border. The gradient term of equation 2 is
    /// left out, because it amplifies noise, and OpenCV limits it to 1.4 grey levels.
    Telea,
    /// M. Bertalmio, A. Bertozzi, G. Sapiro, "Navier-Stokes, fluid dynamics, and image and video inpainting", 2001, as
    /// commonly implemented in the order of the fast marching method: the weight of a pixel grows with how well the
    /// isophote through it points to the pixel to be filled.
    NavierStokes,
}

/// A patcher with one of the two rules.
pub(super) struct March {
    rule: Rule,
}

impl March {
    pub(super) fn new(rule: Rule) -> March {
        March { rule }
    }
}

impl Patcher for March {
    fn patch(&mut self, image: &Reprojected) -> anyhow::Result<Patched> {
        let start = Instant::now();
        let regions = regions(image);
        let colors: Vec<Vec<Rgb<u8>>> =
            regions.par_iter().map(|region| fill(image, region, self.rule)).collect();
        let mut patched = image.color.clone();
        for (region, colors) in regions.iter().zip(colors) {
            for (&[x, y], color) in region.iter().zip(colors) {
                patched.put_pixel(x, y, color);
            }
        }
        let time = PatchTime { patching: start.elapsed(), transfer: Duration::ZERO };
        Ok(Patched { image: patched, time })
    }
}

/// Returns the pixels of all holes in groups that do not influence each other, row by row in each.
pub(super) fn regions(image: &Reprojected) -> Vec<Vec<[u32; 2]>> {
    let [width, _] = image.size().map(|n| n as usize);
    // Filling reads the pixels within RADIUS and their neighbours.
    let near = near_holes(image, RADIUS as usize + 1);
    const UNSEEN: u32 = u32::MAX;
    let mut labels = vec![UNSEEN; near.len()];
    let mut count = 0;
    let mut waiting = Vec::new();
    for first in 0..near.len() {
        if !near[first] || labels[first] != UNSEEN {
            continue;
        }
        labels[first] = count;
        waiting.push(first);
        while let Some(i) = waiting.pop() {
            for j in around(i, image.size()) {
                if near[j] && labels[j] == UNSEEN {
                    labels[j] = count;
                    waiting.push(j);
                }
            }
        }
        count += 1;
    }
    let mut regions = vec![Vec::new(); count as usize];
    for (x, y, mask) in image.mask.enumerate_pixels() {
        if mask.0[0] == HOLE {
            regions[labels[y as usize * width + x as usize] as usize].push([x, y]);
        }
    }
    regions
}

/// Returns for each pixel whether a hole is within `reach` pixels along both axes.
fn near_holes(image: &Reprojected, reach: usize) -> Vec<bool> {
    let [width, height] = image.size().map(|n| n as usize);
    let mut along_rows = vec![false; width * height];
    for (x, y, _) in image.mask.enumerate_pixels().filter(|(_, _, mask)| mask.0[0] == HOLE) {
        let (x, row) = (x as usize, y as usize * width);
        along_rows[row + x.saturating_sub(reach)..row + (x + reach + 1).min(width)].fill(true);
    }
    let mut near = along_rows.clone();
    for y in 0..height {
        for x in (0..width).filter(|x| along_rows[y * width + x]) {
            for v in y.saturating_sub(reach)..(y + reach + 1).min(height) {
                near[v * width + x] = true;
            }
        }
    }
    near
}

/// A window of the image around one region.
struct Window {
    /// The column and row of its first pixel in the image.
    origin: [i32; 2],
    width: i32,
    height: i32,
    /// Distance from the border of the holes: 0 on the valid pixels next to them, positive in holes, negative outside,
    /// infinite where the front has not been.
    distance: Vec<f64>,
    /// True for pixels that are valid or filled.
    known: Vec<bool>,
    color: Vec<[f64; 3]>,
}

/// Fills one region and returns the colours of its pixels.
pub(super) fn fill(image: &Reprojected, region: &[[u32; 2]], rule: Rule) -> Vec<Rgb<u8>> {
    let mut window = Window::around(image, region);
    let holes: Vec<usize> = region.iter().map(|&[x, y]| window.index(x as i32, y as i32)).collect();
    let mut border: Vec<usize> =
        holes.iter().flat_map(|&i| window.neighbours(i)).flatten().filter(|&i| window.known[i]).collect();
    border.sort_unstable();
    border.dedup();
    for &i in &border {
        window.distance[i] = 0.0;
    }
    if rule == Rule::Telea {
        // Distances outside of the holes are computed on a copy, because the front moves towards larger values.
        let outside = window.known.clone();
        let limit = f64::from(RADIUS) + 1.0;
        window.march(&border, |window, i| outside[i] && window.distance[i].is_infinite(), limit, |_, _| {});
        window.distance.iter_mut().filter(|t| t.is_finite()).for_each(|t| *t = -*t);
    }
    let mut inside = vec![false; window.known.len()];
    holes.iter().for_each(|&i| inside[i] = true);
    window.march(
        &border,
        |window, i| inside[i] && !window.known[i],
        f64::INFINITY,
        |window, i| {
            let color = match rule {
                Rule::Telea => window.telea(i),
                Rule::NavierStokes => window.navier_stokes(i),
            };
            window.color[i] = color.map(|c| c.round().clamp(0.0, 255.0));
            window.known[i] = true;
        },
    );
    holes.iter().map(|&i| Rgb(window.color[i].map(|c| c as u8))).collect()
}

impl Window {
    fn around(image: &Reprojected, region: &[[u32; 2]]) -> Window {
        let size = image.size().map(|n| n as i32);
        let margin = RADIUS + 2;
        let bounds = |axis: usize| {
            let low = region.iter().map(|p| p[axis] as i32).min().unwrap_or(0);
            let high = region.iter().map(|p| p[axis] as i32).max().unwrap_or(0);
            ((low - margin).max(0), (high + margin + 1).min(size[axis]))
        };
        let ((x0, x1), (y0, y1)) = (bounds(0), bounds(1));
        let (width, height) = (x1 - x0, y1 - y0);
        let pixels = || (y0..y1).flat_map(move |y| (x0..x1).map(move |x| (x as u32, y as u32)));
        Window {
            origin: [x0, y0],
            width,
            height,
            distance: vec![f64::INFINITY; (width * height) as usize],
            known: pixels().map(|(x, y)| !image.is_hole(x, y)).collect(),
            color: pixels().map(|(x, y)| image.color.get_pixel(x, y).0.map(f64::from)).collect(),
        }
    }

    /// Returns the index in the window of a pixel of the image.
    fn index(&self, x: i32, y: i32) -> usize {
        ((y - self.origin[1]) * self.width + x - self.origin[0]) as usize
    }

    /// Returns the pixel at the offset `dx`, `dy`, if it is inside the window.
    fn offset(&self, i: usize, dx: i32, dy: i32) -> Option<usize> {
        let (x, y) = (i as i32 % self.width + dx, i as i32 / self.width + dy);
        let inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        inside.then_some((y * self.width + x) as usize)
    }

    fn neighbours(&self, i: usize) -> [Option<usize>; 4] {
        [(0, -1), (-1, 0), (0, 1), (1, 0)].map(|(dx, dy)| self.offset(i, dx, dy))
    }

    /// Moves the front from `border` over the `open` pixels up to the distance `limit`. `reach` is called once for each
    /// pixel, when the front reaches it.
    fn march(
        &mut self,
        border: &[usize],
        open: impl Fn(&Window, usize) -> bool,
        limit: f64,
        mut reach: impl FnMut(&mut Window, usize),
    ) {
        // Distances are positive, so their bits sort in the same order. Equal ones keep the order of arrival.
        let mut arrivals = 0u64..;
        let mut front: BinaryHeap<Reverse<(u64, u64, usize)>> = BinaryHeap::new();
        let mut push = |front: &mut BinaryHeap<_>, distance: f64, i: usize| {
            front.push(Reverse((distance.to_bits(), arrivals.next().unwrap_or(u64::MAX), i)));
        };
        border.iter().for_each(|&i| push(&mut front, 0.0, i));
        while let Some(Reverse((_, _, i))) = front.pop() {
            for j in self.neighbours(i).into_iter().flatten() {
                if !open(self, j) {
                    continue;
                }
                let distance = self.eikonal(j);
                self.distance[j] = distance;
                reach(self, j);
                if distance <= limit {
                    push(&mut front, distance, j);
                }
            }
        }
    }

    /// Returns the first-order upwind solution of |grad T| = 1 from the neighbours that the front has passed.
    fn eikonal(&self, i: usize) -> f64 {
        let nearest = |a: Option<usize>, b: Option<usize>| {
            let distance = |j: Option<usize>| j.map_or(f64::INFINITY, |j| self.distance[j]);
            distance(a).min(distance(b))
        };
        let [up, left, down, right] = self.neighbours(i);
        let (a, b) = (nearest(up, down), nearest(left, right));
        if (a - b).abs() < 1.0 { 0.5 * (a + b + (2.0 - (a - b) * (a - b)).sqrt()) } else { a.min(b) + 1.0 }
    }

    /// Returns the derivative of `value` along one axis from the known neighbours: central, one-sided, or 0.
    fn derivative(&self, i: usize, axis: [i32; 2], value: impl Fn(usize) -> f64) -> f64 {
        let known = |sign: i32| self.offset(i, sign * axis[0], sign * axis[1]).filter(|&j| self.known[j]);
        match (known(-1), known(1)) {
            (Some(a), Some(b)) => 0.5 * (value(b) - value(a)),
            (Some(a), None) => value(i) - value(a),
            (None, Some(b)) => value(b) - value(i),
            (None, None) => 0.0,
        }
    }

    /// Returns the known pixels within [`RADIUS`] of pixel `i`, each with the vector from it to pixel `i`.
    fn around_known(&self, i: usize) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        let offsets = (-RADIUS..=RADIUS).flat_map(|dy| (-RADIUS..=RADIUS).map(move |dx| (dx, dy)));
        offsets.filter(|(dx, dy)| dx * dx + dy * dy <= RADIUS * RADIUS).filter_map(move |(dx, dy)| {
            let j = self.offset(i, dx, dy).filter(|&j| self.known[j])?;
            Some((j, [f64::from(-dx), f64::from(-dy)]))
        })
    }

    fn telea(&self, i: usize) -> [f64; 3] {
        let distance = |j: usize| self.distance[j];
        let normal = [self.derivative(i, [1, 0], distance), self.derivative(i, [0, 1], distance)];
        let mut sum = [0.0; 3];
        let mut weights = 0.0;
        for (j, way) in self.around_known(i) {
            let squared = way[0] * way[0] + way[1] * way[1];
            let mut direction = (way[0] * normal[0] + way[1] * normal[1]).abs();
            if direction <= SIDEWAYS {
                direction = LEAST_WEIGHT;
            }
            let direction = direction / squared.sqrt();
            let level = 1.0 / (1.0 + (self.distance[j] - self.distance[i]).abs());
            let weight = direction * level / squared;
            for (sum, color) in sum.iter_mut().zip(self.color[j]) {
                *sum += weight * color;
            }
            weights += weight;
        }
        sum.map(|s| s / weights)
    }

    fn navier_stokes(&self, i: usize) -> [f64; 3] {
        std::array::from_fn(|c| {
            let value = |j: usize| self.color[j][c];
            let mut sum = 0.0;
            let mut weights = 0.0;
            for (j, way) in self.around_known(i) {
                let squared = way[0] * way[0] + way[1] * way[1];
                let gradient = [self.derivative(j, [1, 0], value), self.derivative(j, [0, 1], value)];
                // The isophote is perpendicular to the gradient.
                let along = (way[1] * gradient[0] - way[0] * gradient[1]).abs();
                let lengths = (squared * (gradient[0] * gradient[0] + gradient[1] * gradient[1])).sqrt();
                let direction = if along <= SIDEWAYS { LEAST_WEIGHT } else { along / lengths };
                let weight = direction / (squared * squared + 1.0);
                sum += weight * value(j);
                weights += weight;
            }
            sum / weights
        })
    }
}
