//! Plain f64 versions, for tests, of the patchers that are shaders.

use super::Reprojected;
use yoro::eyes::Eye;

/// An image with holes in forward columns, in the form that the shaders see.
#[derive(Clone)]
pub(super) struct Field {
    pub width: i32,
    pub height: i32,
    pub pixels: Vec<Option<Pixel>>,
}

/// A valid pixel: colour from 0 to 255, disparity in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pixel {
    pub color: [f64; 3],
    pub disparity: f64,
}

impl Field {
    pub fn new(image: &Reprojected) -> Field {
        let [width, height] = image.size();
        let pixel = |x: u32, y: u32| {
            let x = if image.eye == Eye::Right { width - 1 - x } else { x };
            (!image.is_hole(x, y)).then(|| Pixel {
                color: image.color.get_pixel(x, y).0.map(f64::from),
                disparity: f64::from(image.disparity.get_pixel(x, y).0[0]),
            })
        };
        // Rows run from the bottom, as in GL: the paper's kernel takes the row below first.
        let pixels = (0..height).rev().flat_map(|y| (0..width).map(move |x| pixel(x, y))).collect();
        Field { width: width as i32, height: height as i32, pixels }
    }

    /// Returns the colour at a column and row of the image that the field was made from.
    pub fn color(&self, image: &Reprojected, x: u32, y: u32) -> Option<[f64; 3]> {
        let x = if image.eye == Eye::Right { self.width - 1 - x as i32 } else { x as i32 };
        self.at(x, self.height - 1 - y as i32).map(|pixel| pixel.color)
    }

    fn at(&self, x: i32, y: i32) -> Option<Pixel> {
        let inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        inside.then(|| self.pixels[(y * self.width + x) as usize]).flatten()
    }

    fn left(&self, x: i32, y: i32) -> Option<(i32, Pixel)> {
        (0..x).rev().find_map(|x| Some((x, self.at(x, y)?)))
    }

    fn right(&self, x: i32, y: i32) -> Option<(i32, Pixel)> {
        (x + 1..self.width).find_map(|x| Some((x, self.at(x, y)?)))
    }

    fn each_hole(&self, fill: impl Fn(i32, i32) -> Option<Pixel>) -> Field {
        let pixels = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let pixels = pixels.map(|(x, y)| self.at(x, y).or_else(|| fill(x, y))).collect();
        Field { pixels, ..*self }
    }

    /// Fills rows without a valid pixel with the nearest row that has one, the upper one if both are equally near.
    fn repeat_rows(&self) -> Field {
        let known = |y: i32| (0..self.height).contains(&y) && self.at(0, y).is_some();
        let source = |y: i32| {
            (0..self.height).find_map(|d| [y + d, y - d].into_iter().find(|&y| known(y))).unwrap_or(y)
        };
        self.each_hole(|x, y| self.at(x, source(y)))
    }

    /// Returns the field filled by Algorithm 3 as corrected, with kernel height 3.
    pub fn paper(&self) -> Field {
        let filled = self.each_hole(|x, y| {
            let (left, right) = (self.left(x, y), self.right(x, y));
            let (edge, direction) = match (left, right) {
                (Some(left), _) => (left, -1),
                (None, right) => (right?, 1),
            };
            let first = left.map_or(-1, |(x, _)| x);
            let width = right.map_or(self.width, |(x, _)| x) - first;
            let foreground = left.and(right).map_or(f64::INFINITY, |(_, pixel)| pixel.disparity);
            let b = 0.5 + 0.3 * f64::from((x - edge.0).abs()) / f64::from(width);
            let (mut sum, mut remaining) = ([0.0; 3], 1.0);
            for column in (0..width.min(10)).map(|j| edge.0 + direction * j) {
                // The rest is too small to be worth another column.
                if remaining <= 0.001 {
                    break;
                }
                for row in [y, y - 1, y + 1].map(|y| y.clamp(0, self.height - 1)) {
                    if let Some(tap) = self.at(column, row).filter(|tap| tap.disparity <= foreground) {
                        let weight = b * remaining;
                        remaining -= weight;
                        (0..3).for_each(|c| sum[c] += weight * tap.color[c]);
                    }
                }
            }
            let color = if remaining < 1.0 { sum.map(|s| s / (1.0 - remaining)) } else { edge.1.color };
            Some(Pixel { color, disparity: 0.0 })
        });
        filled.repeat_rows()
    }

    /// Returns the field filled from five rows at the farther end.
    pub fn gather(&self) -> Field {
        let filled = self.each_hole(|x, y| {
            let (edge, end) = match (self.left(x, y), self.right(x, y)) {
                (Some(left), Some(right)) if right.1.disparity < left.1.disparity => right,
                (Some(left), _) => left,
                (None, right) => right?,
            };
            let spread = 0.5 * f64::from((x - edge).clamp(-12, 12).abs().max(1));
            let (mut sum, mut weights) = (end.color.map(|c| 2.0 * c), 2.0);
            for j in [-2.0, -1.0, 1.0, 2.0] {
                let row = (y + (j * spread + 0.5).floor() as i32).clamp(0, self.height - 1);
                if let Some(tap) = self.at(edge, row).filter(|tap| tap.disparity <= end.disparity + 1.0) {
                    (0..3).for_each(|c| sum[c] += tap.color[c]);
                    weights += 1.0;
                }
            }
            Some(Pixel { color: sum.map(|s| s / weights), disparity: 0.0 })
        });
        filled.repeat_rows()
    }

    fn window(&self, x: i32, y: i32, radius: i32) -> Vec<(f64, Pixel)> {
        let offsets = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| (dx, dy)));
        let pixel = |(dx, dy): (i32, i32)| Some((f64::from(dx * dx + dy * dy), self.at(x + dx, y + dy)?));
        offsets.filter_map(pixel).collect()
    }

    /// Fills the holes that have valid pixels around them, until no hole is left.
    fn until_closed(mut self, fill: impl Fn(&[(f64, Pixel)]) -> Pixel, radius: i32) -> Field {
        while self.pixels.iter().any(Option::is_none) {
            self = self.each_hole(|x, y| {
                let near = self.window(x, y, radius);
                (!near.is_empty()).then(|| fill(&near))
            });
        }
        self
    }

    /// Returns the field filled by the lower median of the valid neighbours in 5x5 pixels.
    pub fn median(&self) -> Field {
        let fill = |near: &[(f64, Pixel)]| {
            let middle = |c: usize| {
                let mut values: Vec<f64> = near.iter().map(|(_, pixel)| pixel.color[c]).collect();
                values.sort_by(f64::total_cmp);
                values[(values.len() - 1) / 2]
            };
            Pixel { color: [middle(0), middle(1), middle(2)], disparity: 0.0 }
        };
        self.clone().until_closed(fill, 2)
    }

    /// Returns the field filled from the far half of a window of 29x29 pixels.
    pub fn xiao(&self) -> Field {
        let fill = |near: &[(f64, Pixel)]| {
            let disparities = || near.iter().map(|(_, pixel)| pixel.disparity);
            let limit = 0.5
                * (disparities().fold(f64::INFINITY, f64::min)
                    + disparities().fold(f64::NEG_INFINITY, f64::max));
            let kept = || near.iter().filter(|(_, pixel)| pixel.disparity <= limit);
            let mean = |value: &dyn Fn(&Pixel) -> f64| {
                let weight = |squared: f64| (-0.01 * squared).exp();
                let sum: f64 = kept().map(|(squared, pixel)| weight(*squared) * value(pixel)).sum();
                sum / kept().map(|(squared, _)| weight(*squared)).sum::<f64>()
            };
            // Colours have 8 bits between the passes.
            let color = std::array::from_fn(|c| mean(&|pixel| pixel.color[c]).round());
            Pixel { color, disparity: mean(&|pixel| pixel.disparity) }
        };
        self.clone().until_closed(fill, 14)
    }
}
