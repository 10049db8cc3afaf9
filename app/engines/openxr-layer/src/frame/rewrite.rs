//! The layers that the runtime receives instead of the application's.

use openxr_sys as sys;
use smallvec::SmallVec;

use super::chain::{Layers, depth_of, projection};

/// Two views that replace one, and their depth if it is passed on to the runtime.
pub struct Eyes {
    pub views: [sys::CompositionLayerProjectionView; 2],
    pub depths: Option<[sys::CompositionLayerDepthInfoKHR; 2]>,
}

impl Eyes {
    /// Returns the same image for both eyes, with its depth for runtimes that take it. Other structures chained to the view
    /// are meant for one eye.
    ///
    /// # Safety
    /// The view belongs to a submitted layer.
    pub unsafe fn same(view: &sys::CompositionLayerProjectionView, takes_depth: bool) -> Eyes {
        let next = std::ptr::null();
        // SAFETY: same contract.
        let depth = unsafe { depth_of(view) }.filter(|_| takes_depth);
        let depths = depth.map(|depth| [sys::CompositionLayerDepthInfoKHR { next, ..*depth }; 2]);
        Eyes { views: [sys::CompositionLayerProjectionView { next, ..*view }; 2], depths }
    }
}

/// The layers of a frame, which point to one another. This is a local variable of xrEndFrame. It must not move after
/// [`Rewritten::link`], whose borrow ensures that. Usual numbers of layers need no allocation.
#[derive(Default)]
pub struct Rewritten {
    /// The views of each layer, in the runtime's order, and their depth.
    views: SmallVec<[SmallVec<[sys::CompositionLayerProjectionView; 4]>; 2]>,
    depths: SmallVec<[SmallVec<[Option<sys::CompositionLayerDepthInfoKHR>; 4]>; 2]>,
    projections: SmallVec<[sys::CompositionLayerProjection; 2]>,
    layers: SmallVec<[*const sys::CompositionLayerBaseHeader; 16]>,
}

impl Rewritten {
    /// Adds the views for the next layer to be rewritten: two for each of the application's rendered views.
    pub fn push(&mut self, layer: &sys::CompositionLayerProjection, eyes: SmallVec<[Eyes; 2]>) {
        self.views.push(eyes.iter().flat_map(|eyes| eyes.views).collect());
        let depths = |eyes: &Eyes| eyes.depths.map_or([None; 2], |depths| depths.map(Some));
        self.depths.push(eyes.iter().flat_map(depths).collect());
        self.projections
            .push(sys::CompositionLayerProjection { view_count: 2 * eyes.len() as u32, ..*layer });
    }

    /// Returns the application's layers, in which the rewritten layers replace those with this number of views.
    ///
    /// # Safety
    /// The layers are those of a call of xrEndFrame, and all of them with this number of views were pushed in their
    /// order.
    pub unsafe fn link(&mut self, layers: Layers, views: usize) -> Layers<'_> {
        let parts = self.views.iter_mut().zip(&self.depths);
        for (projection, (views, depths)) in self.projections.iter_mut().zip(parts) {
            for (view, depth) in views.iter_mut().zip(depths) {
                view.next = depth.as_ref().map_or(std::ptr::null(), |depth| std::ptr::from_ref(depth).cast());
            }
            projection.views = views.as_ptr();
        }
        self.layers.clear();
        let mut rewritten = self.projections.iter();
        self.layers.extend(layers.iter().map(|&layer| {
            // SAFETY: one of the application's layers.
            let replaced = unsafe { projection(layer, views) }.and_then(|_| rewritten.next());
            replaced.map_or(layer, |replaced| std::ptr::from_ref(replaced).cast())
        }));
        &self.layers
    }
}
