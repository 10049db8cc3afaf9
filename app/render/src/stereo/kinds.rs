//! What the methods do differently for each kind of renderer.

use super::hybrid::{DeferredFields, FieldTargets, ForwardFields};
use super::overlay::{DeferredOverlay, ForwardOverlay, Overlay};
use super::single_pass::{DeferredPair, ForwardPair, PairTargets};
use crate::render::{DeferredRenderer, ForwardRenderer, RendererOfKind};

/// A kind of renderer with what the methods do differently for it.
pub(super) trait StereoRenderer: RendererOfKind {
    /// Both eyes in one set of draw calls.
    type Pair: PairTargets<Renderer = Self>;
    /// The near field for each eye and the far field for both.
    type Fields: FieldTargets<Renderer = Self>;
    /// What comes after synthesis.
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
