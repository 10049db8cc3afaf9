//! The layers that the runtime gets in place of the application's.

use openxr_sys as sys;
use smallvec::SmallVec;

use super::chain::{Layers, projection};

/// The two views of a layer, and their depth if it goes on to the runtime.
pub struct Eyes {
    pub views: [sys::CompositionLayerProjectionView; 2],
    pub depths: Option<[sys::CompositionLayerDepthInfoKHR; 2]>,
}

impl Eyes {
    /// The same image for both eyes. What is chained to the view is meant for one eye, and left out.
    pub fn same(view: &sys::CompositionLayerProjectionView) -> Eyes {
        let view = sys::CompositionLayerProjectionView { next: std::ptr::null(), ..*view };
        Eyes { views: [view; 2], depths: None }
    }
}

/// Layers of a frame, which point to one another. A local of xrEndFrame: it must not move after [`Rewritten::link`],
/// which its borrow ensures. Usual numbers of layers need no allocation.
#[derive(Default)]
pub struct Rewritten {
    eyes: SmallVec<[Eyes; 2]>,
    projections: SmallVec<[sys::CompositionLayerProjection; 2]>,
    layers: SmallVec<[*const sys::CompositionLayerBaseHeader; 16]>,
}

impl Rewritten {
    /// Adds the two views in place of the next rewritten layer.
    pub fn push(&mut self, layer: &sys::CompositionLayerProjection, eyes: Eyes) {
        self.eyes.push(eyes);
        self.projections.push(sys::CompositionLayerProjection { view_count: 2, ..*layer });
    }

    /// Returns the application's layers with the rewritten ones in place of those of this number of views.
    ///
    /// # Safety
    /// The layers are those of a call of xrEndFrame; all of them that have this number of views were pushed in their
    /// order.
    pub unsafe fn link(&mut self, layers: Layers, views: usize) -> Layers<'_> {
        for (projection, eyes) in self.projections.iter_mut().zip(&mut self.eyes) {
            for (view, depth) in eyes.views.iter_mut().zip(eyes.depths.iter().flatten()) {
                view.next = std::ptr::from_ref(depth).cast();
            }
            projection.views = eyes.views.as_ptr();
        }
        let mut rewritten = self.projections.iter();
        self.layers.extend(layers.iter().map(|&layer| {
            // SAFETY: a layer of the application's.
            let replaced = unsafe { projection(layer, views) }.and_then(|_| rewritten.next());
            replaced.map_or(layer, |replaced| std::ptr::from_ref(replaced).cast())
        }));
        &self.layers
    }
}
