//! A frame as stereo methods see it.

use super::method::{EyeTarget, LevelEyes, StereoError};
use crate::view::{DepthImage, GpuScene, LitScene, Renderer};
use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, EyesError, GuardBand, SynthesisViews};

/// A frame to render: its scene, its eyes and their targets.
pub(super) struct Frame<'a> {
    pub(super) renderer: &'a Renderer,
    pub(super) scene: LitScene<'a>,
    /// The eyes. Their depth is reversed, as everywhere in the renderer.
    pub(super) pair: EyePair,
    level: LevelEyes,
    /// The convention of the depth that targets receive.
    convention: DepthConvention,
    to: &'a [EyeTarget<'a>; 2],
}

impl<'a> Frame<'a> {
    /// Checks that the renderer was made for the scene.
    pub(super) fn new(
        renderer: &'a Renderer,
        scene: &'a GpuScene,
        level: &LevelEyes,
        to: &'a [EyeTarget<'a>; 2],
    ) -> Result<Frame<'a>, StereoError> {
        renderer.check_scene(scene)?;
        let convention = level.eyes.depth.convention;
        let level = LevelEyes { eyes: reversed(&level.eyes), ..*level };
        let scene = level.shown.map_or(scene.into(), |shown| LitScene::of_eyes(scene, &shown));
        Ok(Frame { renderer, scene, pair: level.eyes, level, convention, to })
    }

    /// Returns the eyes as a level, with reversed depth.
    pub(super) fn level(&self) -> &LevelEyes {
        &self.level
    }

    /// Returns the view to render for both eyes, and how its pixels move.
    pub(super) fn synthesis_views(&self, guard: GuardBand) -> Result<SynthesisViews, EyesError> {
        self.level.synthesis_views(guard)
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

/// Returns the same eyes with reversed depth, which half floats and samples can carry.
fn reversed(pair: &EyePair) -> EyePair {
    EyePair { depth: DepthRange { convention: DepthConvention::Reversed, ..pair.depth }, ..*pair }
}
