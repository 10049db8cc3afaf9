//! Rectangles of images.

/// A rectangle of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Lower left corner in pixels.
    pub origin: [u32; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl Rectangle {
    /// Returns the whole of an image.
    pub fn whole(size: [u32; 2]) -> Rectangle {
        Rectangle { origin: [0, 0], size }
    }

    /// Returns the part that lies within another rectangle; `None` if there is none.
    pub fn within(&self, other: &Rectangle) -> Option<Rectangle> {
        let end = |rectangle: &Rectangle, i: usize| rectangle.origin[i] + rectangle.size[i];
        let origin = [0, 1].map(|i| self.origin[i].max(other.origin[i]));
        let size = [0, 1].map(|i| end(self, i).min(end(other, i)).saturating_sub(origin[i]));
        (!size.contains(&0)).then_some(Rectangle { origin, size })
    }

    /// Returns the parts of an image of this size around the rectangle: below, above, left, right. Some are empty.
    pub fn around(&self, size: [u32; 2]) -> [Rectangle; 4] {
        let ([x, y], [w, h]) = (self.origin, self.size);
        let (right, top) = (x + w, y + h);
        [
            Rectangle { origin: [0, 0], size: [size[0], y] },
            Rectangle { origin: [0, top], size: [size[0], size[1] - top] },
            Rectangle { origin: [0, y], size: [x, h] },
            Rectangle { origin: [right, y], size: [size[0] - right, h] },
        ]
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
        assert_eq!(part([0, 0], [9, 7]), Some(shown));
        assert_eq!(part([0, 0], [4, 7]), None);
    }

    #[test]
    fn a_rectangle_and_what_is_around_it_are_the_image() {
        for (origin, size) in [([2, 3], [4, 1]), ([0, 0], [9, 7]), ([0, 6], [3, 1]), ([8, 0], [1, 7])] {
            let inner = Rectangle { origin, size };
            let mut seen = [[0; 9]; 7];
            for part in inner.around([9, 7]).iter().chain([&inner]) {
                for y in 0..part.size[1] {
                    for x in 0..part.size[0] {
                        seen[(part.origin[1] + y) as usize][(part.origin[0] + x) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().flatten().all(|n| *n == 1), "{inner:?}");
        }
    }
}
