//! Requests for one view.

use super::cluster::{Culler, Selection};
use yoro::eyes::{Frustum, View};

/// Columns of a view of which only a part is needed. Each range is `[first, end]`, counted from the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// The columns to draw. In the others, depth is the far plane's, and colour is that of the nearest drawn column.
    pub drawn: [u32; 2],
    /// The columns that are drawn in every frame. Bloom does not reach into them from other columns, so that they do not
    /// depend on what is drawn there.
    pub always: [u32; 2],
}

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

/// The part of a scene to draw. The default is all opaque surfaces.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrawRequest {
    /// The objects to draw.
    pub selection: Selection,
    /// The columns to draw; all if `None`.
    pub columns: Option<Columns>,
}

impl DrawRequest {
    /// Returns the columns to which drawing is limited, or `None` for the whole view.
    pub(super) fn bounds(&self, view: &View) -> Option<[u32; 2]> {
        self.columns.map(|columns| columns.drawn).filter(|drawn| *drawn != [0, view.size[0]])
    }

    /// Returns a culler for the requested part of a view.
    pub(super) fn culler(&self, view: &View) -> Culler {
        Culler::selecting(&self.bounds(view).map_or(*view, |drawn| of_columns(view, drawn)), self.selection)
    }
}

/// Returns the part of a view that columns `[first, end]` show.
pub(crate) fn of_columns(view: &View, [first, end]: [u32; 2]) -> View {
    let tangent = view.frustum.width() / view.size[0] as f32;
    let left = view.frustum.left + first as f32 * tangent;
    let right = view.frustum.left + end as f32 * tangent;
    View {
        frustum: Frustum { left, right, ..view.frustum },
        size: [end.saturating_sub(first), view.size[1]],
        ..*view
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
