//! The parts of methods that depend on the kind of renderer.

use super::hybrid::{DeferredFields, FieldTargets, ForwardFields};
use super::overlay::{DeferredOverlay, ForwardOverlay, Overlay};
use super::single_pass::{DeferredPair, ForwardPair, PairTargets};
use crate::render::{DeferredRenderer, ForwardRenderer, RendererOfKind};

/// A kind of renderer, with the parts of methods that are specific to it.
pub(super) trait StereoRenderer: RendererOfKind {
    /// Both eyes in one set of draw calls.
    type Pair: PairTargets<Renderer = Self>;
    /// The near field for each eye and the far field for both.
    type Fields: FieldTargets<Renderer = Self>;
    /// Drawing after synthesis.
    type Overlay: Overlay<Renderer = Self>;
}

impl StereoRenderer for DeferredRenderer {
    type Pair = DeferredPair;
    type Fields = DeferredFields;
    type Overlay = DeferredOverlay;
}

impl StereoRenderer for ForwardRenderer {
    type Pair = ForwardPair;
    type Fields = ForwardFields;
    type Overlay = ForwardOverlay;
}
