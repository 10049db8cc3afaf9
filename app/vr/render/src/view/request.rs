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
