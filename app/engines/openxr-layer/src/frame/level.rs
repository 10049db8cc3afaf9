//! The views of both eyes that are made of one rendered view.

use std::sync::Arc;
use std::time::Duration;

use openxr_sys as sys;
use yoro::eyes::Warp;

#[cfg(feature = "capture")]
use super::capture;
use super::chain::{depth_of, is_upside_down};
use super::output::Output;
use super::rewrite::Eyes;
use super::synthesized::{Key, Synthesized};
use super::target::Acquired;
use super::vectors::Vectors;
use super::{source, split_source};
use crate::binding::Binding;
#[cfg(feature = "capture")]
use crate::geometry::Rectangle;
use crate::instance::Part;
use crate::motion::MotionInfo;
use crate::reason::Reason;
use crate::say;
use crate::session::Session;
use crate::swapchain::{Content, Swapchain};
use crate::synthesizer::Job;

/// Indices of colour, or motion vectors, and depth.
pub const COLOR: usize = 0;
pub const DEPTH: usize = 1;

/// What is kept from frame to frame for one of the application's rendered views. Of four views two are rendered, each with
/// sizes of its own.
#[derive(Default)]
pub struct Level {
    /// Colour of the other eye, and its depth if the runtime accepts depth.
    eye: Output<Warp>,
    pub vectors: Vectors,
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
    pub time: Option<Duration>,
    /// The reason why the application's motion vectors do not go on to the runtime.
    pub no_vectors: Option<Reason>,
}

impl Level {
    /// Returns the two views that replace one. `captures` is true in the frame of which pictures are written.
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
    ) -> Result<Synthesis, Reason> {
        // SAFETY: a submitted view.
        let (info, motion) = unsafe { (depth_of(view).ok_or(Reason::NoDepth)?, MotionInfo::of(view)) };
        let motion = motion.filter(|_| !self.vectors.are_refused);
        // SAFETY: a submitted layer.
        let upside_down = unsafe { is_upside_down(layer) };
        let key = Key::new(swapchains, view, info, upside_down);
        if let Some(last) = self.last.as_ref().filter(|last| last.key == key) {
            let motions = last.motions(swapchains, motion);
            // Of an image that was not released again, no vectors can be made.
            let no_vectors = (motion.is_some() && motions.is_none()).then_some(Reason::Old("colour"));
            let eyes = Eyes { motions, ..last.again(view, info) };
            return Ok(Synthesis { eyes, time: None, no_vectors });
        }
        self.last = None;
        let binding = session.binding.ok_or(Reason::NoGraphics)?;
        let offer = session.last_offer(part).ok_or(Reason::NoViews)?.map_err(Reason::Views)?;
        let source = source(swapchains, view, info, upside_down)?;
        let split = split_source(&offer, &source)?;
        self.eye.synthesizer(binding)?;
        let (color, depth) = self.acquire(session, &binding, source.contents)?;
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
        let synthesizer = self.eye.synthesizer(binding)?;
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
        // The images are released even after an error, and then not shown.
        self.eye.release(session, (color, depth))?;
        // The driver may not be able to write this format as depth.
        if let (Err(reason @ (Reason::Gl(_) | Reason::Synthesis(_))), Some(_)) = (&result, depth) {
            self.give_up_depth(session, source.contents[DEPTH].format, reason);
        }
        let mut time = result?;
        let dominant = offer.eyes.dominant;
        if motion.is_none() {
            self.vectors.former = None;
        }
        let vectors = motion.map(|motion| {
            // SAFETY: a structure in the submitted view's chain.
            unsafe { self.vectors.make(session, binding, swapchains, &motion, (&source, &split)) }
        });
        let (vectors, no_vectors) = match vectors.transpose() {
            Ok(made) => {
                time = made.and_then(|(_, more)| Some(time? + more?)).or(time);
                (made.map(|(vectors, _)| vectors), None)
            }
            Err(reason) => (None, Some(reason)),
        };
        let synthesized = Synthesized { key, split, crop, dominant, color, depth, vectors };
        let motions = synthesized.motions(swapchains, motion);
        let eyes = Eyes { motions, ..synthesized.eyes(view, info) };
        self.last = Some(synthesized);
        Ok(Synthesis { eyes, time, no_vectors })
    }

    /// Acquires images for the other eye, in swapchains like the application's: colour, and depth if the runtime
    /// accepts it.
    fn acquire(
        &mut self,
        session: &Session,
        binding: &Binding,
        [color, depth]: [&Content; 2],
    ) -> Result<(Acquired, Option<Acquired>), Reason> {
        self.eye.fit(session, binding, COLOR, color)?;
        let mut takes_depth = session.instance.takes_depth && !self.without_depth.contains(&depth.format);
        if takes_depth && let Err(reason) = self.eye.fit(session, binding, DEPTH, depth) {
            self.give_up_depth(session, depth.format, &reason);
            takes_depth = false;
        }
        self.eye.acquire(session, takes_depth)
    }

    /// Stops submitting depth of a format to the runtime. The layer still needs the application's depth.
    fn give_up_depth(&mut self, session: &Session, format: i64, reason: &Reason) {
        self.without_depth.push(format);
        self.eye.drop_target(session, DEPTH);
        self.last = None;
        let application = &session.instance.application;
        say(format_args!("{application}: depth of format {format} does not go on to the runtime: {reason}"));
    }

    /// Forgets images that are about to be destroyed.
    pub fn forget(&mut self, content: &Content) {
        self.last = None;
        self.eye.forget(content);
        self.vectors.outputs.iter_mut().for_each(|output| output.forget(content));
    }
}
