//! The one place that decides that both eyes must be rendered instead of using the method.

use std::rc::Rc;

use super::near_field_policy::{FrameMode, NearFieldPolicy};
use super::near_fraction::NearFraction;
use super::options::{Method, StereoOptions};
use crate::view::{DepthImage, DepthResolve, Renderer};
use yoro::eyes::{DepthRange, EyePair, EyesError, GuardBand, StereoViews};
use yoro_gl::{Context, GlError};

/// A reason for rendering both eyes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FallbackReason {
    /// Most of the view is too near, as [`NearFieldPolicy`] decides.
    #[error("most of the view is too near")]
    Near,
    /// Neither eye can be synthesized from the other, as with canted eyes.
    #[error(transparent)]
    Eyes(#[from] EyesError),
}

/// Returns the reason why a method cannot use a pair of eyes, or `None` if it can.
pub fn alignment_error(method: Method, pair: &EyePair) -> Option<EyesError> {
    if method.needs_aligned_eyes() { pair.synthesis_views(GuardBand::None).err() } else { None }
}

/// Decides for each frame whether the method's eyes can be used.
pub(super) struct Fallback {
    method: Method,
    near: Option<NearSwitch>,
}

/// The switch to two renders while most of the view is too near, and the measurement that it depends on.
pub(super) struct NearSwitch {
    policy: NearFieldPolicy,
    mode: FrameMode,
    fraction: NearFraction,
}

impl Fallback {
    /// Compiles the measurement if the method synthesizes and the options have a policy.
    pub(super) fn new(
        gl: &Rc<Context>,
        method: Method,
        options: &StereoOptions,
    ) -> Result<Fallback, GlError> {
        let policy = options.policy.filter(|_| method == Method::Synthesized);
        let near = policy.map(|policy| {
            Ok(NearSwitch { policy, mode: FrameMode::default(), fraction: NearFraction::new(gl)? })
        });
        Ok(Fallback { method, near: near.transpose()? })
    }

    /// Compiles what depends on the renderer.
    pub(super) fn prepare(&mut self, renderer: &Renderer) -> Result<(), GlError> {
        let is_pair = renderer.depth_resolve == DepthResolve::InColor;
        self.near.as_mut().map_or(Ok(()), |near| near.fraction.prepare(is_pair))
    }

    /// Returns the reason why the method cannot use these eyes at all.
    pub(super) fn of_eyes(&self, views: &StereoViews) -> Option<FallbackReason> {
        views.layers().find_map(|layer| alignment_error(self.method, &layer.eyes)).map(FallbackReason::Eyes)
    }

    /// Returns [`FallbackReason::Near`] if the last frames were mostly too near.
    pub(super) fn of_content(&mut self) -> Option<FallbackReason> {
        let NearSwitch { policy, mode, fraction } = self.near.as_mut()?;
        if let Some(fraction) = fraction.take() {
            *mode = policy.next(*mode, fraction);
        }
        (*mode == FrameMode::BothRendered).then_some(FallbackReason::Near)
    }

    /// Returns what measures the dominant eye's depth for later frames, if anything does.
    pub(super) fn near(&mut self) -> Option<&mut NearSwitch> {
        self.near.as_mut()
    }
}

impl NearSwitch {
    /// Starts to measure a depth image, from its origin on.
    pub(super) fn measure(
        &mut self,
        depth: &DepthImage,
        size: [u32; 2],
        range: &DepthRange,
    ) -> Result<(), GlError> {
        self.fraction.measure(depth, size, range, self.policy.distance)
    }
}
