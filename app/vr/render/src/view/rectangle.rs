//! Rectangles of images, and regions of several.

/// A rectangle of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Lower left corner in pixels.
    pub origin: [u32; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl Rectangle {
    /// Returns the part that lies within another rectangle; `None` if there is none.
    pub fn within(&self, other: &Rectangle) -> Option<Rectangle> {
        let end = |rectangle: &Rectangle, i: usize| rectangle.origin[i] + rectangle.size[i];
        let origin = [0, 1].map(|i| self.origin[i].max(other.origin[i]));
        let size = [0, 1].map(|i| end(self, i).min(end(other, i)).saturating_sub(origin[i]));
        (!size.contains(&0)).then_some(Rectangle { origin, size })
    }
}

/// Cells of a region along each axis. In a headset's eye they have about 50 pixels, not much more than a GPU's tiles.
const CELLS: u32 = 32;

/// A part of an image: some of its cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Width and height of the image in pixels.
    size: [u32; 2],
    /// A bit for each cell of each row.
    rows: [u32; CELLS as usize],
}

impl Region {
    /// Returns no part of an image.
    pub fn none(size: [u32; 2]) -> Region {
        Region { size, rows: [0; CELLS as usize] }
    }

    /// Returns the whole of an image.
    pub fn whole(size: [u32; 2]) -> Region {
        Region::none(size).rest()
    }

    /// Returns the rest of the image.
    pub fn rest(self) -> Region {
        Region { rows: self.rows.map(|row| !row), ..self }
    }

    /// Adds the cells that a rectangle touches. It must lie within the image, and have pixels.
    pub fn add(&mut self, Rectangle { origin, size }: Rectangle) {
        let cell = |axis: usize, pixel: u32| ((pixel + 1) * CELLS - 1) / self.size[axis];
        let cells = [0, 1].map(|i| cell(i, origin[i])..=cell(i, origin[i] + size[i] - 1));
        let row: u32 = cells[0].clone().map(|column| 1 << column).sum();
        cells[1].clone().for_each(|i| self.rows[i as usize] |= row);
    }

    /// Returns rectangles that do not overlap and are the region.
    pub fn rectangles(mut self) -> impl Iterator<Item = Rectangle> {
        let all = std::iter::from_fn(move || {
            let bottom = self.rows.iter().position(|row| *row != 0)?;
            let row = self.rows[bottom];
            let left = row.trailing_zeros();
            let right = left + (row >> left).trailing_ones();
            let run = (left..right).map(|column| 1 << column).sum::<u32>();
            let rows = self.rows[bottom..].iter_mut().take_while(|row| **row & run == run);
            let height = rows.map(|row| *row &= !run).count();
            let edge = |axis: usize, cell: u32| cell * self.size[axis] / CELLS;
            let (low, high) = ([left, bottom as u32], [right, (bottom + height) as u32]);
            let origin = [0, 1].map(|i| edge(i, low[i]));
            Some(Rectangle { origin, size: [0, 1].map(|i| edge(i, high[i]) - origin[i]) })
        });
        // Cells of a tiny image may have no pixels.
        all.filter(|rectangle| !rectangle.size.contains(&0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_two_rectangles_share_is_within_both() {
        let shown = Rectangle { origin: [4, 0], size: [5, 7] };
        let part = |origin, size| Rectangle { origin, size }.within(&shown);
        assert_eq!(part([2, 3], [4, 1]), Some(Rectangle { origin: [4, 3], size: [2, 1] }));
        assert_eq!(part([0, 0], [9, 7]), Some(Rectangle { origin: [4, 0], size: [5, 7] }));
        assert_eq!(part([0, 0], [4, 7]), None);
    }

    #[test]
    fn a_region_and_its_rest_are_the_image() {
        for size in [[9, 7], [64, 48], [541, 200]] {
            let mut region = Region::none(size);
            let inner = [[size[0] / 3, 0, 2, 1], [0, size[1] - 2, 3, 2], [size[0] - 1, 3, 1, size[1] - 3]];
            let inner = inner.map(|[x, y, w, h]| Rectangle { origin: [x, y], size: [w, h] });
            inner.iter().for_each(|rectangle| region.add(*rectangle));
            let count = |region: Region| {
                let mut seen = vec![0; (size[0] * size[1]) as usize];
                for Rectangle { origin: [x, y], size: [w, h] } in region.rectangles() {
                    (0..w * h).for_each(|i| seen[((y + i / w) * size[0] + x + i % w) as usize] += 1);
                }
                seen
            };
            let (covered, rest) = (count(region), count(region.rest()));
            assert!(covered.iter().zip(&rest).all(|(a, b)| a + b == 1), "{size:?}");
            for Rectangle { origin: [x, y], size: [w, h] } in inner {
                assert!((0..w * h).all(|i| covered[((y + i / w) * size[0] + x + i % w) as usize] == 1));
            }
            let share = covered.iter().sum::<u32>() as f32 / covered.len() as f32;
            assert!(share < 0.5 && count(Region::whole(size)).iter().all(|n| *n == 1), "{share}");
        }
    }
}
