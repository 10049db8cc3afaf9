//! A frame as stereo methods see it, with a renderer of the kind that they were made for.

use std::rc::Rc;

use super::method::{EyeTarget, GuardBandUse, StereoError, StereoMethod};
use super::options::StereoOptions;
use crate::render::{GpuScene, RenderSettings, Renderer, RendererOfKind};
use yoro::eyes::{Eye, EyePair};
use yoro_gl::{Context, GlError};

/// The context, renderer and options that a method is made for.
#[derive(Clone, Copy)]
pub(super) struct Setup<'a> {
    pub(super) gl: &'a Rc<Context>,
    pub(super) settings: &'a RenderSettings,
    pub(super) options: &'a StereoOptions,
}

/// A frame to render: its scene, its eyes and their targets.
pub(super) struct Frame<'a, R> {
    pub(super) renderer: &'a R,
    pub(super) scene: &'a GpuScene,
    pub(super) pair: &'a EyePair,
    to: &'a [EyeTarget<'a>; 2],
}

impl<R> Frame<'_, R> {
    /// Returns the target of an eye.
    pub(super) fn to(&self, eye: Eye) -> &EyeTarget<'_> {
        &self.to[eye.index()]
    }

    /// Returns both targets, by [`Eye::index`].
    pub(super) fn targets(&self) -> &[EyeTarget<'_>; 2] {
        self.to
    }

    /// True if an eye's target has depth.
    pub(super) fn wants_depth(&self, eye: Eye) -> bool {
        self.to(eye).depth.is_some()
    }
}

/// A stereo method for one kind of renderer.
pub(super) trait FrameMethod: Sized {
    /// The kind of renderer.
    type Renderer: RendererOfKind;

    /// Compiles what the method needs for the materials of a scene, unless it is compiled already.
    fn compile(&mut self, _renderer: &mut Self::Renderer, _scene: &GpuScene) -> Result<(), GlError> {
        Ok(())
    }

    /// Renders both eyes into their targets.
    fn render_frame(&mut self, frame: &Frame<Self::Renderer>) -> Result<(), StereoError>;

    /// See [`StereoMethod::show_again`].
    fn show_last(&mut self, _pair: &EyePair, _to: &[EyeTarget; 2]) -> Result<bool, StereoError> {
        Ok(false)
    }

    /// See [`StereoMethod::guard_band`].
    fn guard_band_use(&self) -> Option<GuardBandUse> {
        None
    }

    /// See [`StereoMethod::is_substituted`].
    fn has_rendered_both(&self) -> bool {
        false
    }
}

/// Returns the renderer as one of the method's kind, after checking that it was made for this scene.
fn of_kind<'a, R: RendererOfKind>(
    renderer: &'a mut Renderer,
    scene: &GpuScene,
) -> Result<&'a mut R, GlError> {
    let renderer = R::of(renderer).ok_or_else(|| {
        GlError::Unsupported(
            "the stereo method was made for another kind of renderer: make both with the same settings"
                .into(),
        )
    })?;
    renderer.common().check_scene(scene)?;
    Ok(renderer)
}

impl<M: FrameMethod> StereoMethod for M {
    fn prepare(&mut self, renderer: &mut Renderer, scene: &GpuScene) -> Result<(), StereoError> {
        Ok(self.compile(of_kind(renderer, scene)?, scene)?)
    }

    fn guard_band(&self) -> Option<GuardBandUse> {
        self.guard_band_use()
    }

    fn is_substituted(&self) -> bool {
        self.has_rendered_both()
    }

    fn render_to(
        &mut self,
        renderer: &mut Renderer,
        scene: &GpuScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let renderer = of_kind(renderer, scene)?;
        self.compile(renderer, scene)?;
        self.render_frame(&Frame { renderer, scene, pair, to })
    }

    fn show_again(&mut self, pair: &EyePair, to: &[EyeTarget; 2]) -> Result<bool, StereoError> {
        self.show_last(pair, to)
    }
}
