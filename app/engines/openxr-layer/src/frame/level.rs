//! The views of both eyes that are made of one rendered view.

use std::sync::Arc;
use std::time::Duration;

use openxr_sys as sys;

#[cfg(feature = "capture")]
use super::capture;
use super::chain::{depth_of, is_upside_down};
use super::rewrite::Eyes;
use super::synthesized::{Key, Synthesized};
use super::target::{Acquired, Target};
use super::{source, split_source};
use crate::binding::Binding;
#[cfg(feature = "capture")]
use crate::geometry::Rectangle;
use crate::instance::Part;
use crate::reason::Reason;
use crate::say;
use crate::session::Session;
use crate::swapchain::{Content, Swapchain};
use crate::synthesizer::{Job, Synthesizer};

/// Indices of colour and depth.
pub const COLOR: usize = 0;
pub const DEPTH: usize = 1;
const ATTACHMENTS: [sys::SwapchainUsageFlags; 2] =
    [sys::SwapchainUsageFlags::COLOR_ATTACHMENT, sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT];

/// What is kept from frame to frame for one of the application's rendered views. Of four views two are rendered, each with
/// sizes of its own.
#[derive(Default)]
pub struct Level {
    /// Created in the first frame that needs it. An error is final, except [`Reason::NotCurrent`].
    synthesizer: Option<Result<Box<dyn Synthesizer>, Reason>>,
    /// Colour of the other eye, and its depth if the runtime accepts depth.
    targets: [Option<Target>; 2],
    /// Depth formats for which no target can be created.
    without_depth: Vec<i64>,
    /// The last synthesized view, while the targets still show it.
    pub last: Option<Synthesized>,
}

impl Level {
    /// Returns the two views that replace one, and the GPU time of an earlier synthesis once it is known. `captures` is true
    /// in the frame of which pictures are written.
    ///
    /// # Safety
    /// The view belongs to this submitted layer.
    pub unsafe fn synthesize(
        &mut self,
        session: &Session,
        part: Part,
        swapchains: &[Arc<Swapchain>],
        layer: &sys::CompositionLayerProjection,
        view: &sys::CompositionLayerProjectionView,
        #[cfg(feature = "capture")] captures: bool,
    ) -> Result<(Eyes, Option<Duration>), Reason> {
        // SAFETY: a submitted view.
        let info = unsafe { depth_of(view) }.ok_or(Reason::NoDepth)?;
        // SAFETY: a submitted layer.
        let upside_down = unsafe { is_upside_down(layer) };
        let key = Key::new(swapchains, view, info, upside_down);
        if let Some(last) = self.last.as_ref().filter(|last| last.key == key) {
            return Ok((last.again(view, info), None));
        }
        self.last = None;
        let binding = session.binding.ok_or(Reason::NoGraphics)?;
        let offer = session.last_offer(part).ok_or(Reason::NoViews)?.map_err(Reason::Views)?;
        let source = source(swapchains, view, info, upside_down)?;
        let split = split_source(&offer, &source)?;
        self.synthesizer(binding)?;
        let [color, depth] = self.acquire(session, &binding, source.contents)?;
        let color = color.ok_or(Reason::NoGraphics)?;
        let from_top = binding.rows_from_top();
        let crop = source.part.part(split.crop, from_top);
        let job = Job {
            color: source.images[COLOR],
            depth: source.images[DEPTH],
            source: source.part.part(split.source, from_top),
            warp: &split.warp,
            target: color.image,
            target_depth: depth.map(|depth| depth.image),
        };
        let synthesizer = self.synthesizer(binding)?;
        // SAFETY: the runtime owns none of these images: releases of the source's are held back, the target's were
        // acquired. In xrEndFrame the application lets nobody else use the queue (XR_KHR_vulkan_enable) or the context.
        let result = unsafe { synthesizer.synthesize(&job) };
        #[cfg(feature = "capture")]
        if result.is_ok() && captures && part != Part::Inset {
            let dominant = offer.eyes.dominant;
            let whole = Rectangle { origin: [0; 2], size: split.crop.size };
            // SAFETY: as above.
            unsafe {
                capture::write(session, synthesizer, "rendered", job.color, source.part);
                capture::write(session, synthesizer, dominant.name(), job.color, crop);
                capture::write(session, synthesizer, dominant.other().name(), job.target, whole);
            }
        }
        // The images are released even after an error, and then not shown. A target that cannot be released is useless.
        let released = depth.map_or(Ok(()), |depth| depth.release(session));
        if let Err(reason) = color.release(session).and(released) {
            self.drop_target(session, COLOR);
            self.drop_target(session, DEPTH);
            return Err(reason);
        }
        // The driver may not be able to write this format as depth.
        if let (Err(reason @ (Reason::Gl(_) | Reason::Synthesis(_))), Some(_)) = (&result, depth) {
            self.give_up_depth(session, source.contents[DEPTH].format, reason);
        }
        let time = result?;
        let synthesized = Synthesized { key, split, crop, dominant: offer.eyes.dominant, color, depth };
        let eyes = synthesized.eyes(view, info);
        self.last = Some(synthesized);
        Ok((eyes, time))
    }

    /// Returns the pipeline, and creates it if necessary.
    fn synthesizer(&mut self, binding: Binding) -> Result<&mut dyn Synthesizer, Reason> {
        // The context may have become free.
        self.synthesizer.take_if(|made| matches!(made, Err(Reason::NotCurrent)));
        // SAFETY: the application keeps its device or context until the session is destroyed, and `end` drops the
        // pipeline before that.
        match self.synthesizer.get_or_insert_with(|| unsafe { binding.synthesizer() }) {
            Ok(synthesizer) => Ok(synthesizer.as_mut()),
            Err(reason) => Err(reason.clone()),
        }
    }

    /// Acquires images for the other eye, in swapchains like the application's: colour, and depth if the runtime
    /// accepts it.
    fn acquire(
        &mut self,
        session: &Session,
        binding: &Binding,
        [color, depth]: [&Content; 2],
    ) -> Result<[Option<Acquired>; 2], Reason> {
        self.fit(session, binding, COLOR, color)?;
        let mut takes_depth = session.instance.takes_depth && !self.without_depth.contains(&depth.format);
        if takes_depth && let Err(reason) = self.fit(session, binding, DEPTH, depth) {
            self.give_up_depth(session, depth.format, &reason);
            takes_depth = false;
        }
        let mut acquired = [None; 2];
        for which in [COLOR, DEPTH].into_iter().filter(|which| *which == COLOR || takes_depth) {
            let target = self.targets[which].as_mut().map(|target| target.acquire(session));
            acquired[which] = match target.transpose() {
                Ok(image) => image,
                Err(reason) => {
                    if let Some(color) = acquired[COLOR]
                        && color.release(session).is_err()
                    {
                        self.drop_target(session, COLOR);
                    }
                    return Err(reason);
                }
            };
        }
        Ok(acquired)
    }

    /// Creates a target like the application's swapchain, unless the existing one fits.
    fn fit(
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

    /// Stops submitting depth of a format to the runtime. The layer still needs the application's depth.
    fn give_up_depth(&mut self, session: &Session, format: i64, reason: &Reason) {
        self.without_depth.push(format);
        self.drop_target(session, DEPTH);
        let application = &session.instance.application;
        say(format_args!("{application}: depth of format {format} does not go on to the runtime: {reason}"));
    }

    fn drop_target(&mut self, session: &Session, which: usize) {
        if let Some(old) = self.targets[which].take() {
            self.forget(&old.content);
            old.destroy(session);
        }
    }

    /// Forgets images that are about to be destroyed.
    pub fn forget(&mut self, content: &Content) {
        self.last = None;
        if let Some(Ok(synthesizer)) = &mut self.synthesizer {
            synthesizer.forget(&content.images);
        }
    }
}
