//! Requests for one view.

use super::cluster::{Culler, Selection};
use yoro::eyes::{Frustum, View};

/// Columns of a view of which only a part is needed. Each range is `[first, end]`, counted from the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// The columns to draw. In the others, depth is the far plane's, and colour is that of the nearest drawn column.
    pub drawn: [u32; 2],
    /// The columns that are drawn in every frame. Ambient occlusion and bloom do not reach into them from other
    /// columns, so that they do not depend on what is drawn there.
    pub always: [u32; 2],
}

/// The depth that is read after a view is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelDepth {
    /// None. A renderer with several samples in each pixel then spends nothing on depth.
    Unread,
    /// The nearest of each pixel's samples.
    #[default]
    Nearest,
    /// The depth of each pixel's first sample, as drivers resolve it; the only choice without multisample textures. Not
    /// available with [`RenderSettings::depth_bits`](super::RenderSettings::depth_bits) of 16, because drivers copy
    /// between equal formats only.
    FirstSample,
}

/// The samples that are needed after a view is rendered, to be read or drawn into. The others stay in the tiles of a
/// tile-based GPU, if its driver can do that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeptSamples {
    /// The samples' colour.
    pub color: bool,
    /// The samples' depth.
    pub depth: bool,
}

/// The part of a scene to draw, and what is read of it afterwards. The default is all opaque surfaces and their depth.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewRequest {
    /// The objects to draw.
    pub selection: Selection,
    /// The columns to draw; all if `None`.
    pub columns: Option<Columns>,
    /// The depth to provide.
    pub depth: PixelDepth,
    /// The samples to keep.
    pub samples: KeptSamples,
}

impl ViewRequest {
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
