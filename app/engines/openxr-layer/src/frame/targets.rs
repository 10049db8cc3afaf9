//! The synthesizer of a rendered view, and the swapchains of the layer's own that it writes to.

use openxr_sys as sys;

use super::target::{AcquiredImages, Target};
use crate::binding::Binding;
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::Content;
use crate::synthesizer::Synthesizer;

/// Indices of colour and depth.
pub const COLOR: usize = 0;
pub const DEPTH: usize = 1;

const ATTACHMENTS: [sys::SwapchainUsageFlags; 2] =
    [sys::SwapchainUsageFlags::COLOR_ATTACHMENT, sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT];

/// Colour and depth of the other eye.
#[derive(Default)]
pub struct Targets {
    /// Created in the first frame that needs it. An error is final, except [`Reason::NotCurrent`].
    synthesizer: Option<Result<Box<dyn Synthesizer>, Reason>>,
    targets: [Option<Target>; 2],
}

impl Targets {
    /// Returns the pipeline, and creates it if necessary.
    ///
    /// # Errors
    /// A [`Reason`] if the driver lacks a feature.
    pub fn synthesizer(&mut self, binding: Binding) -> Result<&mut dyn Synthesizer, Reason> {
        // The context may have become free.
        self.synthesizer.take_if(|made| matches!(made, Err(Reason::NotCurrent)));
        // SAFETY: the application keeps its device or context until the session is destroyed, and `Frames::end` drops
        // the pipeline before that.
        match self.synthesizer.get_or_insert_with(|| unsafe { binding.synthesizer() }) {
            Ok(synthesizer) => Ok(synthesizer.as_mut()),
            Err(reason) => Err(reason.clone()),
        }
    }

    /// Creates a target like the application's swapchain, unless the existing one is large enough.
    ///
    /// # Errors
    /// [`Reason::Runtime`].
    pub fn resize(
        &mut self,
        session: &Session,
        binding: &Binding,
        which: usize,
        like: &Content,
    ) -> Result<(), Reason> {
        if !self.targets[which].as_ref().is_some_and(|target| target.fits(like)) {
            self.destroy(session, which);
            self.targets[which] = Some(Target::new(session, binding, ATTACHMENTS[which], like)?);
        }
        Ok(())
    }

    /// Acquires images of the targets: colour, and depth if it is to be written.
    ///
    /// # Errors
    /// Those of [`Target::acquire`].
    pub fn acquire(&mut self, session: &Session, takes_depth: bool) -> Result<AcquiredImages, Reason> {
        let mut next = |which: usize| {
            let target = self.targets[which].as_mut().map(|target| target.acquire(session));
            target.unwrap_or(Err(Reason::NoGraphics))
        };
        let color = next(COLOR)?;
        match takes_depth.then(|| next(DEPTH)).transpose() {
            Ok(depth) => Ok(AcquiredImages { color, depth }),
            Err(reason) => {
                if color.release(session).is_err() {
                    self.destroy(session, COLOR);
                }
                Err(reason)
            }
        }
    }

    /// Releases the images. A target that cannot be released is useless.
    ///
    /// # Errors
    /// [`Reason::Runtime`].
    pub fn release(&mut self, session: &Session, images: AcquiredImages) -> Result<(), Reason> {
        let released = images.depth.map_or(Ok(()), |depth| depth.release(session));
        let result = images.color.release(session).and(released);
        if result.is_err() {
            self.destroy(session, COLOR);
            self.destroy(session, DEPTH);
        }
        result
    }

    /// Destroys a target, if there is one.
    pub fn destroy(&mut self, session: &Session, which: usize) {
        if let Some(old) = self.targets[which].take() {
            self.forget(&old.content);
            old.destroy(session);
        }
    }

    /// Forgets images that are about to be destroyed.
    pub fn forget(&mut self, content: &Content) {
        if let Some(Ok(synthesizer)) = &mut self.synthesizer {
            synthesizer.forget(&content.images);
        }
    }
}
