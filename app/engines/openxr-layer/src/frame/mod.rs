//! xrEndFrame: turns a projection layer of one view into one of two, and one of which half of the views are tiny into
//! one of whole views.

mod chain;
mod rendered_view;
mod rewrite;
mod statistics;
mod synthesized;
mod target;
mod targets;

use std::collections::HashSet;
use std::mem::Discriminant;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use openxr_sys as sys;
use smallvec::SmallVec;
use yoro::eyes::Eye;

use crate::dispatch::XrResult;
use crate::geometry::{Offer, Rectangle, Split, Submitted, SubmittedDepth, frustum, pose};
use crate::mirror;
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::{Content, Swapchain};
use crate::synthesizer::Image;
use crate::{lock, log_line};
pub use chain::projection;
use chain::{Layers, held, rectangle};
use rendered_view::RenderedView;
use rewrite::{Eyes, Rewritten};
use statistics::{Report, Statistics};

/// The state that xrEndFrame keeps between frames.
#[derive(Default)]
pub struct Frames {
    /// One for each rendered view, in the order of the views.
    views: [RenderedView; 2],
    /// The kinds of reasons that have been logged, and what they were reasons for.
    logged: HashSet<(&'static str, Discriminant<Reason>)>,
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
    let (mut views, next) = (session.views(), session.instance.next.end_frame);
    // SAFETY: the application's structure.
    let layers = unsafe { chain::layers(info) };
    // SAFETY: the application's layers.
    let unsound = if views > 1 { unsafe { unsound_view(session, swapchains, layers) } } else { None };
    if let Some(view) = unsound {
        views = 0;
        if !chain::is_known(swapchains, view) {
            lock(frames).log_once(session, "passed through", &Reason::Unknown("the view to replace"));
        }
    }
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
        let synthesized = views > 0 && unsafe { frames.rewrite(session, swapchains, layers, &mut rewritten) };
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
        unsafe {
            for (layer, views) in rendered_views(session, layers) {
                rewritten.push(layer, same(session, views));
            }
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

/// Returns what both eyes are shown of views that are not synthesized.
///
/// # Safety
/// The views belong to a submitted layer.
unsafe fn same<'a>(
    session: &Session,
    views: impl Iterator<Item = &'a sys::CompositionLayerProjectionView>,
) -> SmallVec<[Eyes; 2]> {
    // SAFETY: same contract.
    views.map(|view| unsafe { Eyes::same(view, session.instance.takes_depth) }).collect()
}

/// Returns the first view that is to be replaced and could not be shown.
///
/// # Safety
/// The layers are those of a call of xrEndFrame in a session of more than one view.
unsafe fn unsound_view<'a>(
    session: &Session,
    swapchains: &[Arc<Swapchain>],
    layers: Layers<'a>,
) -> Option<&'a sys::CompositionLayerProjectionView> {
    // SAFETY: same contract.
    let replaced = unsafe { views_of(session, layers, session.instance.settings.dominant.other()) };
    replaced.into_iter().flat_map(|(_, views)| views).find(|view| !chain::is_sound(swapchains, view))
}

/// Returns the layers to rewrite. Each comes with its one view, or with those of its views that are not tiny.
///
/// # Safety
/// The layers are those of a call of xrEndFrame.
unsafe fn rendered_views<'a>(
    session: &Session,
    layers: Layers<'a>,
) -> impl Iterator<
    Item = (
        &'a sys::CompositionLayerProjection,
        impl Iterator<Item = &'a sys::CompositionLayerProjectionView> + Clone,
    ),
> {
    // SAFETY: same contract.
    unsafe { views_of(session, layers, session.instance.settings.dominant) }
}

/// Returns the layers to rewrite, with their one view or those of an eye.
///
/// # Safety
/// The layers are those of a call of xrEndFrame.
unsafe fn views_of<'a>(
    session: &Session,
    layers: Layers<'a>,
    eye: Eye,
) -> impl Iterator<
    Item = (
        &'a sys::CompositionLayerProjection,
        impl Iterator<Item = &'a sys::CompositionLayerProjectionView> + Clone,
    ),
> {
    let (views, count) = (session.views(), session.roles().len());
    let first = if views == 1 { 0 } else { eye.index() };
    layers.iter().filter_map(move |&layer| {
        // SAFETY: the application's layers. `views` is not 0 in a session that is rewritten.
        let layer = unsafe { projection(layer, views) }?;
        // SAFETY: the layer has this many views.
        Some((layer, (0..count).map(move |i| unsafe { &*layer.views.add(first + 2 * i) })))
    })
}

/// Finds the images of a view and of its depth.
fn source<'a>(
    swapchains: &'a [Arc<Swapchain>],
    view: &'a sys::CompositionLayerProjectionView,
    info: &'a sys::CompositionLayerDepthInfoKHR,
    upside_down: bool,
) -> Result<Source<'a>, Reason> {
    let color = held(swapchains, &view.sub_image, "colour")?;
    let depth = held(swapchains, &info.sub_image, "depth")?;
    let part = rectangle(&view.sub_image, color.content)?;
    if rectangle(&info.sub_image, depth.content)? != part || color.content.size != depth.content.size {
        return Err(Reason::Apart);
    }
    let (contents, images) = ([color.content, depth.content], [color.image, depth.image]);
    Ok(Source { view, info, contents, images, part, upside_down })
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
        let mut done = false;
        // SAFETY: the application's layers.
        for (layer, views) in unsafe { rendered_views(session, layers) } {
            let eyes: Result<SmallVec<[Eyes; 2]>, Reason> = if done {
                Err(Reason::Another)
            } else {
                // SAFETY: submitted views.
                let each = views
                    .clone()
                    .enumerate()
                    .map(|(i, view)| unsafe { self.synthesize(session, i, swapchains, layer, view) });
                // All or none: the views of four that belong to one eye have one pose.
                catch_unwind(AssertUnwindSafe(|| each.collect())).unwrap_or(Err(Reason::Panic))
            };
            let eyes = match eyes {
                Ok(eyes) => {
                    self.statistics.synthesized += 1;
                    done = true;
                    eyes
                }
                Err(reason) => {
                    self.log_fallback(session, reason);
                    // SAFETY: submitted views.
                    unsafe { same(session, views) }
                }
            };
            rewritten.push(layer, eyes);
        }
        done
    }

    /// Returns the two views that replace one, which is the layer's first or second rendered view.
    ///
    /// # Safety
    /// The view belongs to this submitted layer.
    unsafe fn synthesize(
        &mut self,
        session: &Session,
        index: usize,
        swapchains: &[Arc<Swapchain>],
        layer: &sys::CompositionLayerProjection,
        view: &sys::CompositionLayerProjectionView,
    ) -> Result<Eyes, Reason> {
        let role = session.roles()[index];
        // SAFETY: same contract.
        let synthesis = unsafe { self.views[index].synthesize(session, role, swapchains, layer, view) }?;
        if let Some(time) = synthesis.gpu_time {
            // Both syntheses of four views count as one.
            self.statistics.gpu.sum += time;
            self.statistics.gpu.frames += u64::from(index == 0);
        }
        Ok(synthesis.eyes)
    }

    /// Counts a layer that is shown unchanged to both eyes, and logs each kind of reason once.
    fn log_fallback(&mut self, session: &Session, reason: Reason) {
        self.statistics.fallbacks += 1;
        self.log_once(session, "the same image for both eyes", &reason);
    }

    /// Logs what becomes of a frame, once for each kind of reason.
    fn log_once(&mut self, session: &Session, what: &'static str, reason: &Reason) {
        if self.logged.insert((what, std::mem::discriminant(reason))) {
            log_line(format_args!("{}: {what}: {reason}", session.instance.application));
        }
    }

    /// Counts a synthesized layer that the runtime refused.
    fn refused(&mut self, session: &Session, reason: Reason) {
        self.views.iter_mut().for_each(|view| view.last = None);
        self.statistics.synthesized -= 1;
        self.log_fallback(session, reason);
    }

    /// Forgets images that are about to be destroyed.
    pub fn forget(&mut self, content: &Content) {
        self.views.iter_mut().for_each(|view| view.forget(content));
    }

    /// Ends the frames of a session that is about to be destroyed. The runtime destroys its swapchains with it.
    pub fn end(&mut self, session: &Session) {
        self.views = Default::default();
        let Statistics { frames, synthesized, fallbacks, .. } = self.statistics;
        if synthesized + fallbacks > 0 {
            log_line(format_args!(
                "{}: session ended after {frames} frames: {synthesized} synthesized, {fallbacks} not",
                session.instance.application
            ));
        }
        *self = Frames::default();
    }
}
