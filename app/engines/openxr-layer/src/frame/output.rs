//! An image with depth that the layer makes in each frame: the passes, and swapchains of its own.

use openxr_sys as sys;
use yoro::synthesis::backend::WarpKind;

use super::level::{COLOR, DEPTH};
use super::target::{Acquired, Target};
use crate::binding::Binding;
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::Content;
use crate::synthesizer::Synthesizer;

const ATTACHMENTS: [sys::SwapchainUsageFlags; 2] =
    [sys::SwapchainUsageFlags::COLOR_ATTACHMENT, sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT];

/// Colour and depth of an eye, or its motion vectors and their depth.
pub struct Output<W> {
    /// Created in the first frame that needs it. An error is final, except [`Reason::NotCurrent`].
    synthesizer: Option<Result<Box<dyn Synthesizer<W>>, Reason>>,
    /// Colour or vectors, and depth.
    targets: [Option<Target>; 2],
}

impl<W> Default for Output<W> {
    fn default() -> Output<W> {
        Output { synthesizer: None, targets: [None, None] }
    }
}

impl<W: WarpKind + Send + 'static> Output<W> {
    /// Returns the pipeline, and creates it if necessary.
    pub fn synthesizer(&mut self, binding: Binding) -> Result<&mut dyn Synthesizer<W>, Reason> {
        // The context may have become free.
        self.synthesizer.take_if(|made| matches!(made, Err(Reason::NotCurrent)));
        // SAFETY: the application keeps its device or context until the session is destroyed, and `Frames::end` drops the
        // pipeline before that.
        match self.synthesizer.get_or_insert_with(|| unsafe { binding.synthesizer() }) {
            Ok(synthesizer) => Ok(synthesizer.as_mut()),
            Err(reason) => Err(reason.clone()),
        }
    }

    /// Creates a target like the application's swapchain, unless the existing one fits.
    pub fn fit(
        &mut self,
        session: &Session,
        binding: &Binding,
        which: usize,
        like: &Content,
    ) -> Result<(), Reason> {
        if !self.targets[which].as_ref().is_some_and(|target| target.fits(like)) {
            self.drop_target(session, which);
            self.targets[which] = Some(Target::new(session, binding, ATTACHMENTS[which], like)?);
        }
        Ok(())
    }

    /// Acquires images of the targets: colour, and depth if there is one to be written.
    pub fn acquire(
        &mut self,
        session: &Session,
        takes_depth: bool,
    ) -> Result<(Acquired, Option<Acquired>), Reason> {
        let mut next = |which: usize| {
            let target = self.targets[which].as_mut().map(|target| target.acquire(session));
            target.unwrap_or(Err(Reason::NoGraphics))
        };
        let color = next(COLOR)?;
        match takes_depth.then(|| next(DEPTH)).transpose() {
            Ok(depth) => Ok((color, depth)),
            Err(reason) => {
                if color.release(session).is_err() {
                    self.drop_target(session, COLOR);
                }
                Err(reason)
            }
        }
    }

    /// Releases the images. A target that cannot be released is useless.
    pub fn release(
        &mut self,
        session: &Session,
        (color, depth): (Acquired, Option<Acquired>),
    ) -> Result<(), Reason> {
        let released = depth.map_or(Ok(()), |depth| depth.release(session));
        let result = color.release(session).and(released);
        if result.is_err() {
            self.drop_target(session, COLOR);
            self.drop_target(session, DEPTH);
        }
        result
    }

    pub fn drop_target(&mut self, session: &Session, which: usize) {
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
