//! xrEndFrame: turns a projection layer of one view into one of two.

#[cfg(feature = "capture")]
mod capture;
mod chain;
mod rewrite;
mod statistics;
mod synthesized;
mod target;

use std::collections::HashSet;
use std::mem::Discriminant;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use openxr_sys as sys;

use crate::binding::Binding;
use crate::dispatch::XrResult;
use crate::geometry::{Offer, Rectangle, Split, Submitted, SubmittedDepth, frustum, pose};
use crate::mirror;
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::{Content, Swapchain};
use crate::synthesizer::{Image, Job, Synthesizer};
use crate::{lock, say};
pub use chain::projection;
use chain::{Layers, depth_of, held, is_upside_down, rectangle};
use rewrite::{Eyes, Rewritten};
use statistics::{Report, Statistics};
use synthesized::{Key, Synthesized};
use target::{Acquired, Target};

/// Indices of colour and depth.
const COLOR: usize = 0;
const DEPTH: usize = 1;
const ATTACHMENTS: [sys::SwapchainUsageFlags; 2] =
    [sys::SwapchainUsageFlags::COLOR_ATTACHMENT, sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT];

/// The state that xrEndFrame keeps between frames.
#[derive(Default)]
pub struct Frames {
    /// Created in the first frame that needs it. An error is final, except [`Reason::NotCurrent`].
    synthesizer: Option<Result<Box<dyn Synthesizer>, Reason>>,
    /// Colour of the other eye, and its depth if the runtime accepts depth.
    targets: [Option<Target>; 2],
    /// Depth formats for which no target can be created.
    without_depth: Vec<i64>,
    /// The last synthesized view, while the targets still show it.
    last: Option<Synthesized>,
    /// The kinds of reasons that have been logged.
    told: HashSet<Discriminant<Reason>>,
    statistics: Statistics,
    report: Report,
}

/// A view that the application submitted, with the images of its swapchains.
struct Source<'a> {
    view: &'a sys::CompositionLayerProjectionView,
    info: &'a sys::CompositionLayerDepthInfoKHR,
    /// Colour and depth.
    contents: [&'a Content; 2],
    images: [Image; 2],
    /// The rectangle, which is the same in both images.
    part: Rectangle,
    /// True if the rows of both images are in the opposite order.
    upside_down: bool,
}

/// Implements xrEndFrame. `swapchains` are all swapchains of the session.
///
/// # Errors
/// The result of the runtime's xrEndFrame, or of a release that was held back.
///
/// # Safety
/// `info` is the structure of the application's call.
pub unsafe fn end_frame(
    session: &Session,
    frames: &Mutex<Frames>,
    swapchains: &[Arc<Swapchain>],
    info: &sys::FrameEndInfo,
) -> XrResult<sys::Result> {
    let start = Instant::now();
    let (views, next) = (session.views(), session.instance.next.end_frame);
    // SAFETY: the application's structure.
    let layers = unsafe { chain::layers(info) };
    // The runtime has begun the session with two views, so it would accept layers of two views, which the application
    // must not submit.
    // SAFETY: the application's layers.
    if views == 1 && !unsafe { chain::all_have(layers, 1) } {
        return Err(sys::Result::ERROR_VALIDATION_FAILURE);
    }
    let begun = lock(&session.begun).take();
    let mut rewritten = Rewritten::default();
    let (synthesized, released) = {
        let mut frames = lock(frames);
        frames.statistics.frames += 1;
        frames.statistics.application += begun.map_or(Duration::ZERO, |begun| start.duration_since(begun));
        // The runtime's xrEndFrame must find the same current context that the application left.
        // SAFETY: the session is live.
        let _current =
            session.binding.filter(|_| session.reads_images()).and_then(|binding| unsafe { binding.hold() });
        // SAFETY: the application's layers, which live as long as `info`.
        let synthesized = unsafe { frames.rewrite(session, swapchains, layers, &mut rewritten) };
        let releases = swapchains.iter().map(|swapchain| swapchain.pass_on_release());
        let released = releases.fold(Ok(()), Result::and);
        frames.statistics.layer += start.elapsed();
        (synthesized, released)
    };
    if let Err(failed) = released {
        // An image that was not released cannot be shown, but the frame must end. The application now receives what
        // xrReleaseSwapchainImage would have returned.
        let empty = sys::FrameEndInfo { layer_count: 0, layers: std::ptr::null(), ..*info };
        // SAFETY: the application's call, without its layers.
        unsafe { next(session.handle, &empty) };
        return Err(failed);
    }
    if views == 0 {
        // SAFETY: the application's own call.
        return Ok(unsafe { next(session.handle, info) });
    }
    let end = |rewritten: &mut Rewritten| {
        // SAFETY: the application's layers, or copies of them, which live until the call returns.
        unsafe {
            let layers = rewritten.link(layers, views);
            let rewritten = sys::FrameEndInfo { layers: layers.as_ptr(), ..*info };
            // A count without layers is the application's mistake, which the runtime reports.
            next(session.handle, if info.layers.is_null() { info } else { &rewritten })
        }
    };
    let mut result = end(&mut rewritten);
    if synthesized && is_about_layers(result) {
        lock(frames).refused(session, Reason::Runtime("xrEndFrame", result));
        let mut rewritten = Rewritten::default();
        // SAFETY: the application's layers.
        for (layer, view) in unsafe { one_view_layers(session, layers) } {
            rewritten.push(layer, Eyes::same(view));
        }
        result = end(&mut rewritten);
    }
    let frames = &mut *lock(frames);
    frames.report.update(&frames.statistics, &session.instance.application);
    Ok(result)
}

/// True for errors that xrEndFrame returns before anything has happened, after which it can be called again.
fn is_about_layers(result: sys::Result) -> bool {
    [
        sys::Result::ERROR_LAYER_INVALID,
        sys::Result::ERROR_POSE_INVALID,
        sys::Result::ERROR_SWAPCHAIN_RECT_INVALID,
        sys::Result::ERROR_VALIDATION_FAILURE,
    ]
    .contains(&result)
}

/// Returns the layers to rewrite. Each comes with its one view, or with the one of its two views that is not tiny.
///
/// # Safety
/// The layers are those of a call of xrEndFrame.
unsafe fn one_view_layers<'a>(
    session: &Session,
    layers: Layers<'a>,
) -> impl Iterator<Item = (&'a sys::CompositionLayerProjection, &'a sys::CompositionLayerProjectionView)> {
    let views = session.views();
    let index = if views == 2 { session.instance.settings.dominant.index() } else { 0 };
    layers.iter().filter_map(move |&layer| {
        // SAFETY: the application's layers. `views` is not 0 in a session that is rewritten.
        unsafe {
            let layer = projection(layer, views)?;
            Some((layer, &*layer.views.add(index)))
        }
    })
}

/// Finds the images of a view and of its depth.
fn source<'a>(
    swapchains: &'a [Arc<Swapchain>],
    view: &'a sys::CompositionLayerProjectionView,
    info: &'a sys::CompositionLayerDepthInfoKHR,
    upside_down: bool,
) -> Result<Source<'a>, Reason> {
    let (color, color_image) = held(swapchains, view.sub_image.swapchain, "colour")?;
    let (depth, depth_image) = held(swapchains, info.sub_image.swapchain, "depth")?;
    let part = rectangle(&view.sub_image, color)?;
    if rectangle(&info.sub_image, depth)? != part || color.size != depth.size {
        return Err(Reason::Apart);
    }
    let images = [
        color.image(color_image, view.sub_image.image_array_index),
        depth.image(depth_image, info.sub_image.image_array_index),
    ];
    Ok(Source { view, info, contents: [color, depth], images, part, upside_down })
}

/// Splits a submitted view into two eyes.
fn split_source(offer: &Offer, source: &Source) -> Result<Split, Reason> {
    let Source { view, info, part, upside_down, .. } = source;
    let depth =
        SubmittedDepth { near: info.near_z, far: info.far_z, min: info.min_depth, max: info.max_depth };
    let submitted = Submitted { pose: pose(view.pose), frustum: frustum(view.fov), size: part.size, depth };
    mirror::split(&offer.eyes, &submitted, *upside_down).map_err(Reason::Geometry)
}

impl Frames {
    /// Adds two views to `rewritten` for each layer to rewrite. Returns true if one was synthesized.
    ///
    /// # Safety
    /// The layers are those of a call of xrEndFrame.
    unsafe fn rewrite(
        &mut self,
        session: &Session,
        swapchains: &[Arc<Swapchain>],
        layers: Layers,
        rewritten: &mut Rewritten,
    ) -> bool {
        if session.views() == 0 {
            #[cfg(feature = "capture")]
            if session.reads_images() && self.statistics.frames == capture::FRAME {
                // SAFETY: the application's layers.
                unsafe { capture::write_stereo(session, swapchains, layers) };
            }
            return false;
        }
        let mut done = false;
        // SAFETY: the application's layers.
        for (layer, view) in unsafe { one_view_layers(session, layers) } {
            let eyes = if done {
                Err(Reason::Another)
            } else {
                // SAFETY: a submitted view.
                let work = AssertUnwindSafe(|| unsafe { self.synthesize(session, swapchains, layer, view) });
                catch_unwind(work).unwrap_or(Err(Reason::Panic))
            };
            let eyes = match eyes {
                Ok(eyes) => {
                    self.statistics.synthesized += 1;
                    done = true;
                    eyes
                }
                Err(reason) => {
                    self.fall_back(session, reason);
                    Eyes::same(view)
                }
            };
            rewritten.push(layer, eyes);
        }
        done
    }

    /// Returns the two views that replace one.
    ///
    /// # Safety
    /// The view belongs to this submitted layer.
    unsafe fn synthesize(
        &mut self,
        session: &Session,
        swapchains: &[Arc<Swapchain>],
        layer: &sys::CompositionLayerProjection,
        view: &sys::CompositionLayerProjectionView,
    ) -> Result<Eyes, Reason> {
        // SAFETY: a submitted view.
        let info = unsafe { depth_of(view) }.ok_or(Reason::NoDepth)?;
        // SAFETY: a submitted layer.
        let upside_down = unsafe { is_upside_down(layer) };
        let key = Key::new(swapchains, view, info, upside_down);
        if let Some(last) = self.last.as_ref().filter(|last| last.key == key) {
            return Ok(last.again(view, info));
        }
        self.last = None;
        let binding = session.binding.ok_or(Reason::NoGraphics)?;
        let offer = lock(&session.offer).ok_or(Reason::NoViews)?.map_err(Reason::Views)?;
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
        #[cfg(feature = "capture")]
        let captures = self.statistics.frames == capture::FRAME;
        let synthesizer = self.synthesizer(binding)?;
        // SAFETY: the runtime owns none of these images: releases of the source's are held back, the target's were
        // acquired. In xrEndFrame the application lets nobody else use the queue (XR_KHR_vulkan_enable) or the context.
        let result = unsafe { synthesizer.synthesize(&job) };
        #[cfg(feature = "capture")]
        if result.is_ok() && captures {
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
        if let Some(time) = result? {
            self.statistics.gpu += time;
            self.statistics.timed += 1;
        }
        let synthesized = Synthesized { key, split, crop, dominant: offer.eyes.dominant, color, depth };
        let eyes = synthesized.eyes(view, info);
        self.last = Some(synthesized);
        Ok(eyes)
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

    /// Counts a layer that is shown unchanged to both eyes. Logs each kind of reason once.
    fn fall_back(&mut self, session: &Session, reason: Reason) {
        self.statistics.fallbacks += 1;
        if self.told.insert(std::mem::discriminant(&reason)) {
            say(format_args!("{}: the same image for both eyes: {reason}", session.instance.application));
        }
    }

    /// Counts a synthesized layer that the runtime refused.
    fn refused(&mut self, session: &Session, reason: Reason) {
        self.last = None;
        self.statistics.synthesized -= 1;
        self.fall_back(session, reason);
    }

    /// Forgets images that are about to be destroyed.
    pub fn forget(&mut self, content: &Content) {
        self.last = None;
        if let Some(Ok(synthesizer)) = &mut self.synthesizer {
            synthesizer.forget(&content.images);
        }
    }

    /// Ends the frames of a session that is about to be destroyed. The runtime destroys its swapchains with it.
    pub fn end(&mut self, session: &Session) {
        self.synthesizer = None;
        let Statistics { frames, synthesized, fallbacks, .. } = self.statistics;
        if session.views() > 0 {
            say(format_args!(
                "{}: session ended after {frames} frames: {synthesized} synthesized, {fallbacks} not",
                session.instance.application
            ));
        }
        *self = Frames::default();
    }
}
