//! A frame as stereo methods see it.

use std::cell::RefCell;

use super::fallback::NearSwitch;
use super::method::{EyeTarget, StereoError};
use crate::view::{DepthImage, GpuScene, LitScene, Renderer};
use yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyePair, EyesError, GuardBand, SynthesisViews, ViewLayer,
};
use yoro_gl::GlError;

/// A frame to render: its scene, its eyes and their targets.
pub(super) struct Frame<'a> {
    pub(super) renderer: &'a Renderer,
    pub(super) scene: LitScene<'a>,
    /// The eyes. Their depth is reversed, as everywhere in the renderer.
    pub(super) pair: EyePair,
    pub(super) layer: ViewLayer,
    /// The convention of the depth that targets receive.
    convention: DepthConvention,
    to: &'a [EyeTarget<'a>; 2],
    /// True if holes are filled, even if they could be rendered.
    pub(super) fills_holes: bool,
    /// Measures the dominant eye's depth for later frames.
    near: RefCell<Option<&'a mut NearSwitch>>,
}

impl<'a> Frame<'a> {
    /// Checks that the renderer was made for the scene. `shown` are the whole eyes of which the layer is a part.
    pub(super) fn new(
        renderer: &'a Renderer,
        scene: &'a GpuScene,
        layer: &ViewLayer,
        shown: Option<&EyePair>,
        to: &'a [EyeTarget<'a>; 2],
    ) -> Result<Frame<'a>, StereoError> {
        renderer.check_scene(scene)?;
        let convention = layer.eyes.depth.convention;
        let layer = Frame::rendered_layer(layer);
        let scene = shown.map_or(scene.into(), |shown| LitScene::of_eyes(scene, shown));
        let near = RefCell::new(None);
        let pair = layer.eyes;
        Ok(Frame { renderer, scene, pair, layer, convention, to, fills_holes: false, near })
    }

    /// Returns a layer with reversed depth, which half floats and samples can carry.
    pub(super) fn rendered_layer(layer: &ViewLayer) -> ViewLayer {
        let depth = DepthRange { convention: DepthConvention::Reversed, ..layer.eyes.depth };
        ViewLayer { eyes: EyePair { depth, ..layer.eyes }, ..*layer }
    }

    /// Gives the frame what measures the dominant eye's depth, if anything does.
    pub(super) fn measured_by(self, near: Option<&'a mut NearSwitch>) -> Frame<'a> {
        Frame { near: RefCell::new(near), ..self }
    }

    /// Has holes filled, even if they could be rendered.
    pub(super) fn with_filled_holes(self, fills_holes: bool) -> Frame<'a> {
        Frame { fills_holes, ..self }
    }

    /// True if the dominant eye's depth is measured.
    pub(super) fn measures_depth(&self) -> bool {
        self.near.borrow().is_some()
    }

    /// Starts to measure the dominant eye's depth, from the image's origin on, if it is measured.
    pub(super) fn measure_depth(&self, depth: &DepthImage) -> Result<(), GlError> {
        let mut near = self.near.borrow_mut();
        near.as_mut().map_or(Ok(()), |near| near.measure(depth, self.pair.size, &self.pair.depth))
    }

    /// Returns the view to render for both eyes, and how its pixels move.
    pub(super) fn synthesis_views(&self, guard: GuardBand) -> Result<SynthesisViews, EyesError> {
        self.layer.synthesis_views(guard)
    }

    /// Returns a depth range with the convention of the depth that targets receive.
    pub(super) fn written(&self, depth: DepthRange) -> DepthRange {
        DepthRange { convention: self.convention, ..depth }
    }

    /// Returns the target of an eye.
    pub(super) fn to(&self, eye: Eye) -> &EyeTarget<'_> {
        &self.to[eye.index()]
    }

    /// True if an eye's target has depth.
    pub(super) fn wants_depth(&self, eye: Eye) -> bool {
        self.to(eye).depth.is_some()
    }

    /// Writes an eye's depth, if its target has depth.
    pub(super) fn write_depth(&self, eye: Eye, from: &DepthImage) {
        if let Some(to) = &self.to(eye).depth {
            to.copy.run(from, &to.to, self.convention);
        }
    }
}
