//! The layers that the runtime receives instead of the application's.

use openxr_sys as sys;
use smallvec::SmallVec;

use super::chain::{Layers, projection};

/// The two views of a layer, and their depth if it is passed on to the runtime.
pub struct Eyes {
    pub views: [sys::CompositionLayerProjectionView; 2],
    pub depths: Option<[sys::CompositionLayerDepthInfoKHR; 2]>,
}

impl Eyes {
    /// Returns the same image for both eyes, without the structures chained to the view, which are meant for one eye.
    pub fn same(view: &sys::CompositionLayerProjectionView) -> Eyes {
        let view = sys::CompositionLayerProjectionView { next: std::ptr::null(), ..*view };
        Eyes { views: [view; 2], depths: None }
    }
}

/// The layers of a frame, which point to one another. This is a local variable of xrEndFrame. It must not move after
/// [`Rewritten::link`], whose borrow ensures that. Usual numbers of layers need no allocation.
#[derive(Default)]
pub struct Rewritten {
    eyes: SmallVec<[Eyes; 2]>,
    projections: SmallVec<[sys::CompositionLayerProjection; 2]>,
    layers: SmallVec<[*const sys::CompositionLayerBaseHeader; 16]>,
}

impl Rewritten {
    /// Adds the two views for the next layer to be rewritten.
    pub fn push(&mut self, layer: &sys::CompositionLayerProjection, eyes: Eyes) {
        self.eyes.push(eyes);
        self.projections.push(sys::CompositionLayerProjection { view_count: 2, ..*layer });
    }

    /// Returns the application's layers, in which the rewritten layers replace those with this number of views.
    ///
    /// # Safety
    /// The layers are those of a call of xrEndFrame, and all of them with this number of views were pushed in their
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
            // SAFETY: one of the application's layers.
            let replaced = unsafe { projection(layer, views) }.and_then(|_| rewritten.next());
            replaced.map_or(layer, |replaced| std::ptr::from_ref(replaced).cast())
        }));
        &self.layers
    }
}
