//! The views of both eyes that are made of one rendered view.

use std::sync::Arc;
use std::time::Duration;

use openxr_sys as sys;

use super::chain::{depth_of, is_upside_down};
use super::rewrite::Eyes;
use super::synthesized::{Key, Synthesized};
use super::target::AcquiredImages;
use super::targets::{COLOR, DEPTH, Targets};
use super::{source, split_source};
use crate::binding::Binding;
use crate::instance::ViewRole;
use crate::log_line;
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::{Content, Swapchain};
use crate::synthesizer::Job;

/// What is kept from frame to frame for one of the application's rendered views. Of four views two are rendered, each
/// with sizes of its own.
#[derive(Default)]
pub struct RenderedView {
    /// Colour of the other eye, and its depth if the runtime accepts depth.
    targets: Targets,
    /// Depth formats for which no target can be created.
    without_depth: Vec<i64>,
    /// The last synthesized view, while the targets still show it.
    pub last: Option<Synthesized>,
}

/// What was made of one view.
pub struct Synthesis {
    /// The two views that replace it.
    pub eyes: Eyes,
    /// The GPU time of an earlier synthesis once it is known.
    pub gpu_time: Option<Duration>,
}

impl RenderedView {
    /// Returns the two views that replace one.
    ///
    /// # Errors
    /// The reason why the view is shown unchanged to both eyes.
    ///
    /// # Safety
    /// The view belongs to this submitted layer.
    pub unsafe fn synthesize(
        &mut self,
        session: &Session,
        role: ViewRole,
        swapchains: &[Arc<Swapchain>],
        layer: &sys::CompositionLayerProjection,
        view: &sys::CompositionLayerProjectionView,
    ) -> Result<Synthesis, Reason> {
        // SAFETY: a submitted view and its layer.
        let (info, upside_down) = unsafe { (depth_of(view).ok_or(Reason::NoDepth)?, is_upside_down(layer)) };
        let key = Key::new(swapchains, view, info, upside_down);
        if let Some(last) = self.last.as_ref().filter(|last| last.key == key) {
            return Ok(Synthesis { eyes: last.again(view, info), gpu_time: None });
        }
        self.last = None;
        let binding = session.binding.ok_or(Reason::NoGraphics)?;
        let offer = session.last_offer(role).ok_or(Reason::NoViews)?.map_err(Reason::Views)?;
        let source = source(swapchains, view, info, upside_down)?;
        let split = split_source(&offer, &source)?;
        self.targets.synthesizer(binding)?;
        let images = self.acquire(session, &binding, source.contents)?;
        let from_top = binding.rows_from_top();
        let job = Job {
            color: source.images[COLOR],
            depth: source.images[DEPTH],
            source: source.part.part(split.source, from_top),
            warp: &split.warp,
            target: images.color.image,
            target_depth: images.depth.map(|depth| depth.image),
        };
        // SAFETY: the runtime owns none of these images: releases of the source's are held back, the target's were
        // acquired. In xrEndFrame the application lets nobody else use the queue (XR_KHR_vulkan_enable) or the context.
        let result = unsafe { self.targets.synthesizer(binding)?.synthesize(&job) };
        // The images are released even after an error, and then not shown.
        self.targets.release(session, images)?;
        // The driver may not be able to write this format as depth.
        if let (Err(reason @ (Reason::Gl(_) | Reason::Synthesis(_))), Some(_)) = (&result, images.depth) {
            self.give_up_depth(session, source.contents[DEPTH].format, reason);
        }
        let gpu_time = result?;
        let crop = source.part.part(split.crop, from_top);
        let synthesized = Synthesized { key, split, crop, dominant: offer.eyes.dominant, images };
        let eyes = synthesized.eyes(view, info);
        self.last = Some(synthesized);
        Ok(Synthesis { eyes, gpu_time })
    }

    /// Acquires images for the other eye, in swapchains like the application's: colour, and depth if the runtime
    /// accepts it.
    fn acquire(
        &mut self,
        session: &Session,
        binding: &Binding,
        [color, depth]: [&Content; 2],
    ) -> Result<AcquiredImages, Reason> {
        self.targets.resize(session, binding, COLOR, color)?;
        let mut takes_depth = session.instance.takes_depth && !self.without_depth.contains(&depth.format);
        if takes_depth && let Err(reason) = self.targets.resize(session, binding, DEPTH, depth) {
            self.give_up_depth(session, depth.format, &reason);
            takes_depth = false;
        }
        self.targets.acquire(session, takes_depth)
    }

    /// Stops submitting depth of a format to the runtime. The layer still needs the application's depth.
    fn give_up_depth(&mut self, session: &Session, format: i64, reason: &Reason) {
        self.without_depth.push(format);
        self.targets.destroy(session, DEPTH);
        self.last = None;
        let application = &session.instance.application;
        log_line(format_args!(
            "{application}: depth of format {format} does not go on to the runtime: {reason}"
        ));
    }

    /// Forgets images that are about to be destroyed.
    pub fn forget(&mut self, content: &Content) {
        self.last = None;
        self.targets.forget(content);
    }
}
