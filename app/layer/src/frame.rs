//! xrEndFrame: a projection layer of one view becomes one of two.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};

use openxr_sys as sys;
use sys::Handle as _;
use yoro::eyes::Eye;

use crate::dispatch::check;
use crate::geometry::{Rectangle, Submitted, SubmittedDepth, frustum, pose, split, xr_fov, xr_pose};
use crate::graphics::{Binding, Image, Job, PATIENCE, Synthesizer};
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::{Content, Swapchain};
use crate::{capture, lock, say};

/// The two views of a layer, and their depth where it goes on to the runtime.
struct Eyes {
    views: [sys::CompositionLayerProjectionView; 2],
    depths: Option<[sys::CompositionLayerDepthInfoKHR; 2]>,
}

/// Places in lists of what there is of both.
const COLOR: usize = 0;
const DEPTH: usize = 1;
const ATTACHMENTS: [sys::SwapchainUsageFlags; 2] =
    [sys::SwapchainUsageFlags::COLOR_ATTACHMENT, sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT];

/// What xrEndFrame keeps from frame to frame.
#[derive(Default)]
pub struct Frames {
    layers: Vec<*const sys::CompositionLayerBaseHeader>,
    projections: Vec<sys::CompositionLayerProjection>,
    eyes: Vec<Eyes>,
    /// Made with the first frame that needs it; why it cannot be is found out once.
    synthesizer: Option<Result<Box<dyn Synthesizer>, Reason>>,
    /// Colour and, for runtimes that take it, depth of the other eye.
    targets: [Option<Target>; 2],
    /// There cannot be one of depth.
    without_depth: bool,
    /// [`Reason::bit`] of those that the log has.
    told: u32,
    counts: Counts,
    /// What `counts` was at the last line of the log.
    last: Option<(Instant, Counts)>,
}

// SAFETY: the pointers in the lists are to the application's structures and to one another, are used only during the call
// of xrEndFrame that has filled them, and cleared before the next use. A synthesizer's objects are used by one thread at a
// time, and those of OpenGL only while their context is current there.
unsafe impl Send for Frames {}

/// How the frames of a session went.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct Counts {
    /// Frames that were submitted, whatever is in them.
    frames: u64,
    /// Layers of one view that became two by synthesis.
    synthesized: u64,
    /// Layers of one view that were shown to both eyes as they are.
    fallbacks: u64,
    /// From xrBeginFrame to xrEndFrame: what the application does in a frame.
    application: Duration,
    /// What the layer does in xrEndFrame, without the runtime's own.
    layer: Duration,
    /// What the synthesis of `timed` frames took on the GPU.
    gpu: Duration,
    timed: u64,
}

/// The mean of a number of times, in milliseconds; of none it is not available.
struct Mean(Duration, u64);

impl fmt::Display for Mean {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.1 {
            0 => f.write_str("na"),
            _ => write!(f, "{:.2}", self.0.as_secs_f64() * 1e3),
        }
    }
}

/// A swapchain of the other eye.
struct Target {
    handle: sys::Swapchain,
    content: Content,
    /// Acquired, but the runtime did not get ready.
    acquired: Option<u32>,
}

/// xrEndFrame.
///
/// # Safety
/// As the specification says.
pub unsafe fn end_frame(session: &Session, info: &sys::FrameEndInfo) -> sys::Result {
    let next = session.instance.next.end_frame;
    let start = Instant::now();
    let begun = lock(&session.begun).take();
    let frames = &mut *lock(&session.frames);
    frames.counts.frames += 1;
    frames.counts.application += begun.map_or(Duration::ZERO, |begun| start.duration_since(begun));
    let pointers = match info.layers.is_null() {
        true => &[],
        // SAFETY: promised by the caller: as many as the structure says.
        false => unsafe { std::slice::from_raw_parts(info.layers, info.layer_count as usize) },
    };
    // The runtime's xrEndFrame shall find what the application has left.
    // SAFETY: the session is live.
    let current =
        session.binding.filter(|_| session.reads_images()).and_then(|binding| unsafe { binding.hold() });
    let before = frames.counts.synthesized;
    if session.views() > 0 {
        // SAFETY: promised by the caller.
        unsafe { frames.rewrite(session, pointers, true) };
    } else if session.reads_images() && frames.counts.frames == capture::FRAME {
        // SAFETY: promised by the caller.
        unsafe { frames.capture_stereo(session, pointers) };
    }
    let mut released = Ok(());
    for swapchain in lock(&session.swapchains).iter() {
        released = released.and(swapchain.pass_on_release());
    }
    // What xrReleaseSwapchainImage would have returned to the application, it returns now.
    if let Err(error) = released {
        return error;
    }
    drop(current);
    if session.views() == 0 {
        // SAFETY: the application's own.
        return unsafe { next(session.handle, info) };
    }
    frames.counts.layer += start.elapsed();
    let rewritten = sys::FrameEndInfo { layers: frames.layers.as_ptr(), ..*info };
    // SAFETY: the application's layers, or ones like them, which live until the end of this function.
    let mut result = unsafe { next(session.handle, &rewritten) };
    if frames.counts.synthesized > before && is_about_layers(result) {
        frames.counts.synthesized = before;
        frames.fall_back(session, Reason::Runtime("xrEndFrame", result));
        // SAFETY: as above.
        unsafe {
            frames.rewrite(session, pointers, false);
            let rewritten = sys::FrameEndInfo { layers: frames.layers.as_ptr(), ..*info };
            result = next(session.handle, &rewritten);
        }
    }
    frames.log(session);
    result
}

/// Errors of xrEndFrame that come before anything has happened, so that it can be called again.
fn is_about_layers(result: sys::Result) -> bool {
    [
        sys::Result::ERROR_LAYER_INVALID,
        sys::Result::ERROR_POSE_INVALID,
        sys::Result::ERROR_SWAPCHAIN_RECT_INVALID,
        sys::Result::ERROR_VALIDATION_FAILURE,
    ]
    .contains(&result)
}

/// A projection layer, if it is one of that many views.
///
/// # Safety
/// The pointer is null or to a layer.
unsafe fn projection<'a>(
    pointer: *const sys::CompositionLayerBaseHeader,
    views: u32,
) -> Option<&'a sys::CompositionLayerProjection> {
    // SAFETY: promised by the caller; the type tells the structure.
    unsafe {
        let header = pointer.as_ref()?;
        if header.ty != sys::CompositionLayerProjection::TYPE {
            return None;
        }
        let layer = &*pointer.cast::<sys::CompositionLayerProjection>();
        (layer.view_count == views && !layer.views.is_null()).then_some(layer)
    }
}

/// The depth of a view.
///
/// # Safety
/// The chain is one of structures.
unsafe fn depth_of(view: &sys::CompositionLayerProjectionView) -> Option<&sys::CompositionLayerDepthInfoKHR> {
    let mut structure = view.next.cast::<sys::BaseInStructure>();
    // SAFETY: promised by the caller; the type tells the structure.
    unsafe {
        while let Some(header) = structure.as_ref() {
            if header.ty == sys::CompositionLayerDepthInfoKHR::TYPE {
                return Some(&*structure.cast::<sys::CompositionLayerDepthInfoKHR>());
            }
            structure = header.next;
        }
    }
    None
}

/// The rectangle of a sub-image, if it lies in the swapchain.
fn rectangle(sub_image: &sys::SwapchainSubImage, content: &Content) -> Result<Rectangle, Reason> {
    let (offset, extent) = (sub_image.image_rect.offset, sub_image.image_rect.extent);
    let fits = |offset: i32, extent: i32, size: u32| {
        let (offset, extent) = (u32::try_from(offset).ok()?, u32::try_from(extent).ok()?);
        (extent > 0 && offset.checked_add(extent)? <= size).then_some((offset, extent))
    };
    let x = fits(offset.x, extent.width, content.size[0]);
    let y = fits(offset.y, extent.height, content.size[1]);
    let (x, y) =
        x.zip(y).filter(|_| sub_image.image_array_index < content.array_size).ok_or(Reason::Beyond)?;
    Ok(Rectangle { origin: [x.0, y.0], size: [x.1, y.1] })
}

fn sub_image(swapchain: sys::Swapchain, part: Rectangle, layer: u32) -> sys::SwapchainSubImage {
    let [x, y] = part.origin.map(|pixels| pixels as i32);
    let [width, height] = part.size.map(|pixels| pixels as i32);
    sys::SwapchainSubImage {
        swapchain,
        image_rect: sys::Rect2Di {
            offset: sys::Offset2Di { x, y },
            extent: sys::Extent2Di { width, height },
        },
        image_array_index: layer,
    }
}

fn find(session: &Session, handle: sys::Swapchain, what: &'static str) -> Result<Arc<Swapchain>, Reason> {
    let swapchains = lock(&session.swapchains);
    let found = swapchains.iter().find(|swapchain| swapchain.handle == handle);
    found.cloned().ok_or(Reason::Unreadable(what))
}

/// What is in the swapchain, and the image that the application has just released.
fn held<'a>(swapchain: &'a Swapchain, what: &'static str) -> Result<(&'a Content, u64), Reason> {
    match (&swapchain.content, swapchain.held()) {
        (None, _) => Err(Reason::Unreadable(what)),
        (_, None) => Err(Reason::Old(what)),
        (_, Some(held)) => Ok(held),
    }
}

impl Frames {
    /// Fills `layers` with the application's, and with others in place of those of one view, or of one that matters.
    ///
    /// # Safety
    /// The pointers are those of a valid XrFrameEndInfo.
    unsafe fn rewrite(
        &mut self,
        session: &Session,
        pointers: &[*const sys::CompositionLayerBaseHeader],
        synthesize: bool,
    ) {
        self.layers.clear();
        self.projections.clear();
        self.eyes.clear();
        // SAFETY: promised by the caller.
        let of_one_view = |pointer| unsafe { projection(pointer, session.views() as u32) };
        // Of two the other one is tiny.
        let place = if session.views() == 2 { session.instance.settings.dominant.index() } else { 0 };
        let mut done = false;
        for layer in pointers.iter().filter_map(|&pointer| of_one_view(pointer)) {
            // SAFETY: a layer of so many views.
            let view = unsafe { &*layer.views.add(place) };
            let eyes = match (synthesize, done) {
                (false, _) => None,
                (true, true) => Some(Err(Reason::Another)),
                (true, false) => {
                    // SAFETY: promised by the caller.
                    let work = AssertUnwindSafe(|| unsafe { self.synthesize(session, view) });
                    Some(catch_unwind(work).unwrap_or(Err(Reason::Panic)))
                }
            };
            let eyes = match eyes {
                Some(Ok(eyes)) => {
                    self.counts.synthesized += 1;
                    done = true;
                    eyes
                }
                Some(Err(reason)) => {
                    self.fall_back(session, reason);
                    same(view)
                }
                None => same(view),
            };
            self.eyes.push(eyes);
            self.projections.push(sys::CompositionLayerProjection { view_count: 2, ..*layer });
        }
        // From here on the lists stay as they are, and can be pointed to.
        for (projection, eyes) in self.projections.iter_mut().zip(&mut self.eyes) {
            for (view, depth) in eyes.views.iter_mut().zip(eyes.depths.iter().flatten()) {
                view.next = std::ptr::from_ref(depth).cast();
            }
            projection.views = eyes.views.as_ptr();
        }
        let mut rewritten = self.projections.iter();
        for &pointer in pointers {
            let replaced = of_one_view(pointer).and_then(|_| rewritten.next());
            self.layers.push(replaced.map_or(pointer, |layer| std::ptr::from_ref(layer).cast()));
        }
    }

    /// The two views in place of one.
    ///
    /// # Safety
    /// The view is that of a valid layer, in xrEndFrame.
    unsafe fn synthesize(
        &mut self,
        session: &Session,
        view: &sys::CompositionLayerProjectionView,
    ) -> Result<Eyes, Reason> {
        // SAFETY: promised by the caller.
        let info = unsafe { depth_of(view) }.ok_or(Reason::NoDepth)?;
        let binding = session.binding.ok_or(Reason::NoGraphics)?;
        let offer = lock(&session.offer).ok_or(Reason::NoViews)?.map_err(Reason::Views)?;
        let color = find(session, view.sub_image.swapchain, "colour")?;
        let depth = find(session, info.sub_image.swapchain, "depth")?;
        let ((color, color_image), (depth, depth_image)) = (held(&color, "colour")?, held(&depth, "depth")?);
        let part = rectangle(&view.sub_image, color)?;
        if rectangle(&info.sub_image, depth)? != part || color.size != depth.size {
            return Err(Reason::Apart);
        }
        let split = split(
            &offer.eyes,
            &Submitted {
                pose: pose(view.pose),
                frustum: frustum(view.fov),
                size: part.size,
                depth: SubmittedDepth {
                    near: info.near_z,
                    far: info.far_z,
                    min: info.min_depth,
                    max: info.max_depth,
                },
            },
        )
        .map_err(Reason::Geometry)?;

        self.synthesizer(binding)?;
        let target = self.acquire(session, &binding, color, depth)?;
        let color_image = color.image(color_image, view.sub_image.image_array_index);
        let from_top = binding.rows_from_top();
        let job = Job {
            color: color_image,
            depth: depth.image(depth_image, info.sub_image.image_array_index),
            source: part.part(split.source, from_top),
            warp: &split.warp,
            target: target.color.1,
            target_depth: target.depth.map(|(_, image)| image),
        };
        let whole = Rectangle { origin: [0; 2], size: split.crop.size };
        let crop = part.part(split.crop, from_top);
        let (dominant, other) = (offer.eyes.dominant, offer.eyes.dominant.other());
        let captures = self.counts.frames == capture::FRAME;
        let synthesizer = self.synthesizer(binding)?;
        // SAFETY: the application's side has these images: it has not released them, or the layer has kept that back.
        // In xrEndFrame the application lets nobody else use the queue (XR_KHR_vulkan_enable) or the context.
        let result = unsafe {
            let result = synthesizer.synthesize(&job);
            if result.is_ok() && captures {
                capture::write(session, synthesizer, "rendered", color_image, part);
                capture::write(session, synthesizer, dominant.name(), color_image, crop);
                capture::write(session, synthesizer, other.name(), job.target, whole);
            }
            result
        };
        // Released even if nothing is in it: it is not shown then. What cannot be released is of no use any more.
        if let Err(reason) = target.release(session) {
            self.drop_target(session, COLOR);
            self.drop_target(session, DEPTH);
            return Err(reason);
        }
        // A format that the driver cannot write as depth, perhaps.
        if let (Err(reason @ (Reason::Gl(_) | Reason::Synthesis(_))), Some(_)) = (&result, target.depth) {
            self.give_up_depth(session, reason);
        }
        if let Some(time) = result? {
            self.counts.gpu += time;
            self.counts.timed += 1;
        }
        let parts = |own: &sys::SwapchainSubImage, others: sys::Swapchain| {
            Eye::BOTH.map(|eye| match eye == dominant {
                true => sub_image(own.swapchain, crop, own.image_array_index),
                false => sub_image(others, whole, 0),
            })
        };
        let colors = parts(&view.sub_image, target.color.0);
        let views = Eye::BOTH.map(|eye| sys::CompositionLayerProjectionView {
            ty: sys::CompositionLayerProjectionView::TYPE,
            next: std::ptr::null(),
            pose: xr_pose(split.poses[eye.index()]),
            fov: xr_fov(split.frusta[eye.index()]),
            sub_image: colors[eye.index()],
        });
        let depths = target.depth.map(|(handle, _)| {
            parts(&info.sub_image, handle).map(|sub_image| sys::CompositionLayerDepthInfoKHR {
                next: std::ptr::null(),
                sub_image,
                ..*info
            })
        });
        Ok(Eyes { views, depths })
    }

    /// The pipeline, made if there is none yet.
    fn synthesizer(&mut self, binding: Binding) -> Result<&mut dyn Synthesizer, Reason> {
        // The next frame may have it.
        self.synthesizer.take_if(|made| matches!(made, Err(Reason::NotCurrent)));
        // SAFETY: the application keeps its device or context until the session is destroyed, and this is dropped before.
        match self.synthesizer.get_or_insert_with(|| unsafe { binding.synthesizer() }) {
            Ok(synthesizer) => Ok(synthesizer.as_mut()),
            Err(reason) => Err(reason.clone()),
        }
    }

    /// Images for the other eye, in swapchains like the application's.
    fn acquire(
        &mut self,
        session: &Session,
        binding: &Binding,
        color: &Content,
        depth: &Content,
    ) -> Result<Acquired, Reason> {
        self.fit(session, binding, COLOR, color)?;
        if session.instance.takes_depth
            && !self.without_depth
            && let Err(reason) = self.fit(session, binding, DEPTH, depth)
        {
            self.give_up_depth(session, &reason);
        }
        let [color, depth] = &mut self.targets;
        let color = color.as_mut().ok_or(Reason::NoGraphics)?;
        let image = color.acquire(session)?;
        let color = (color.handle, color.content.image(image, 0));
        let depth = match depth {
            None => None,
            Some(target) => match target.acquire(session) {
                Ok(image) => Some((target.handle, target.content.image(image, 0))),
                Err(reason) => {
                    if release(session, color.0).is_err() {
                        self.drop_target(session, COLOR);
                    }
                    return Err(reason);
                }
            },
        };
        Ok(Acquired { color, depth })
    }

    /// Makes a swapchain like the application's, unless there is one that will do.
    fn fit(
        &mut self,
        session: &Session,
        binding: &Binding,
        which: usize,
        like: &Content,
    ) -> Result<(), Reason> {
        let fits = |target: &Target| {
            let Content { format, size, .. } = target.content;
            format == like.format && size[0] >= like.size[0] && size[1] >= like.size[1]
        };
        if self.targets[which].as_ref().is_some_and(fits) {
            return Ok(());
        }
        self.drop_target(session, which);
        self.targets[which] = Some(Target::new(session, binding, ATTACHMENTS[which], like)?);
        Ok(())
    }

    /// From here on it stays with the layer. That of the application's images is needed nevertheless.
    fn give_up_depth(&mut self, session: &Session, reason: &Reason) {
        self.without_depth = true;
        self.drop_target(session, DEPTH);
        let application = &session.instance.application;
        say(format_args!("{application}: depth does not go on to the runtime: {reason}"));
    }

    fn drop_target(&mut self, session: &Session, which: usize) {
        if let Some(old) = self.targets[which].take() {
            self.forget(&old.content);
            // SAFETY: the layer's own, whose images no command uses any more.
            unsafe { (session.instance.next.destroy_swapchain)(old.handle) };
        }
    }

    fn fall_back(&mut self, session: &Session, reason: Reason) {
        self.counts.fallbacks += 1;
        if self.told & reason.bit() == 0 {
            self.told |= reason.bit();
            say(format_args!("{}: the same image for both eyes: {reason}", session.instance.application));
        }
    }

    /// Once a second.
    fn log(&mut self, session: &Session) {
        let now = Instant::now();
        let (start, last) = *self.last.get_or_insert((now, self.counts));
        let taken = now.duration_since(start);
        if taken >= Duration::from_secs(1) {
            self.last = Some((now, self.counts));
            let counts = &self.counts;
            let frames = counts.frames - last.frames;
            let rate = frames as f64 / taken.as_secs_f64();
            let mean =
                |now: Duration, last: Duration, count: u64| Mean((now - last) / count.max(1) as u32, count);
            let gpu = mean(counts.gpu, last.gpu, counts.timed - last.timed);
            let own = mean(counts.application, last.application, frames);
            let layer = mean(counts.layer, last.layer, frames);
            let application = &session.instance.application;
            let (synthesized, fallbacks) =
                (counts.synthesized - last.synthesized, counts.fallbacks - last.fallbacks);
            say(format_args!(
                "{application}: {rate:.1} frames a second, {synthesized} synthesized in {gpu} ms of GPU time each, \
                 {fallbacks} not; {own} ms of a frame the application's, {layer} ms the layer's"
            ));
        }
    }

    /// Both views of what the application renders itself.
    ///
    /// # Safety
    /// As [`Frames::rewrite`].
    unsafe fn capture_stereo(
        &mut self,
        session: &Session,
        pointers: &[*const sys::CompositionLayerBaseHeader],
    ) {
        let Some(binding) = session.binding else { return };
        // SAFETY: promised by the caller.
        let layer = pointers.iter().find_map(|&pointer| unsafe { projection(pointer, 2) });
        let Some(layer) = layer else { return };
        // SAFETY: a layer of two views.
        let views = unsafe { std::slice::from_raw_parts(layer.views, 2) };
        // SAFETY: dropped at the end of this call.
        let Ok(mut synthesizer) = (unsafe { binding.synthesizer() }) else { return };
        for (eye, view) in Eye::BOTH.into_iter().zip(views) {
            let swapchain = find(session, view.sub_image.swapchain, "colour");
            let Ok(swapchain) = swapchain else { continue };
            let Ok((content, image)) = held(&swapchain, "colour") else { continue };
            let Ok(part) = rectangle(&view.sub_image, content) else { continue };
            let layer = view.sub_image.image_array_index;
            // SAFETY: as in `synthesize`.
            unsafe {
                capture::write(session, synthesizer.as_mut(), eye.name(), content.image(image, layer), part)
            };
        }
    }

    /// Forgets images that are about to be destroyed.
    pub fn forget(&mut self, content: &Content) {
        if let Some(Ok(synthesizer)) = &mut self.synthesizer {
            synthesizer.forget(&content.images);
        }
    }

    /// Before the session is destroyed, which destroys its swapchains.
    pub fn end(&mut self, session: &Session) {
        self.synthesizer = None;
        let Counts { frames, synthesized, fallbacks, .. } = self.counts;
        if session.views() > 0 {
            say(format_args!(
                "{}: session ended after {frames} frames: {synthesized} synthesized, {fallbacks} not",
                session.instance.application
            ));
        }
        *self = Frames::default();
    }
}

/// The one image for both eyes. What hangs on the view is for one eye, and goes no further.
fn same(view: &sys::CompositionLayerProjectionView) -> Eyes {
    Eyes { views: [sys::CompositionLayerProjectionView { next: std::ptr::null(), ..*view }; 2], depths: None }
}

/// Images of the other eye's swapchains that can be written.
struct Acquired {
    color: (sys::Swapchain, Image),
    depth: Option<(sys::Swapchain, Image)>,
}

impl Acquired {
    fn release(&self, session: &Session) -> Result<(), Reason> {
        let depth = self.depth.map_or(Ok(()), |(handle, _)| release(session, handle));
        release(session, self.color.0).and(depth)
    }
}

impl Target {
    fn new(
        session: &Session,
        binding: &Binding,
        attachment: sys::SwapchainUsageFlags,
        like: &Content,
    ) -> Result<Target, Reason> {
        let mut usage = attachment | sys::SwapchainUsageFlags::SAMPLED;
        if session.instance.settings.capture.is_some() {
            usage |= sys::SwapchainUsageFlags::TRANSFER_SRC;
        }
        let info = sys::SwapchainCreateInfo {
            ty: sys::SwapchainCreateInfo::TYPE,
            next: std::ptr::null(),
            create_flags: sys::SwapchainCreateFlags::EMPTY,
            usage_flags: usage,
            format: like.format,
            sample_count: 1,
            width: like.size[0],
            height: like.size[1],
            face_count: 1,
            array_size: 1,
            mip_count: 1,
        };
        let next = &session.instance.next;
        let mut handle = sys::Swapchain::NULL;
        // SAFETY: a live session, and a valid description.
        check(unsafe { (next.create_swapchain)(session.handle, &info, &mut handle) })
            .map_err(|result| Reason::Runtime("xrCreateSwapchain", result))?;
        match Content::of(next, binding, handle, &info) {
            Ok(content) => Ok(Target { handle, content, acquired: None }),
            Err(result) => {
                // SAFETY: made above.
                unsafe { (next.destroy_swapchain)(handle) };
                Err(Reason::Runtime("xrEnumerateSwapchainImages", result))
            }
        }
    }

    /// An image to write to.
    fn acquire(&mut self, session: &Session) -> Result<u64, Reason> {
        let next = &session.instance.next;
        let index = match self.acquired {
            Some(index) => index,
            None => {
                let mut index = 0;
                // SAFETY: a live swapchain.
                check(unsafe { (next.acquire_swapchain_image)(self.handle, std::ptr::null(), &mut index) })
                    .map_err(|result| Reason::Runtime("xrAcquireSwapchainImage", result))?;
                *self.acquired.insert(index)
            }
        };
        let info = sys::SwapchainImageWaitInfo {
            ty: sys::SwapchainImageWaitInfo::TYPE,
            next: std::ptr::null(),
            timeout: sys::Duration::from_nanos(PATIENCE.as_nanos() as i64),
        };
        // SAFETY: a live swapchain.
        match unsafe { (next.wait_swapchain_image)(self.handle, &info) } {
            sys::Result::TIMEOUT_EXPIRED => return Err(Reason::Late),
            result => check(result).map_err(|result| Reason::Runtime("xrWaitSwapchainImage", result))?,
        };
        self.acquired = None;
        self.content.images.get(index as usize).copied().ok_or(Reason::Beyond)
    }
}

fn release(session: &Session, target: sys::Swapchain) -> Result<(), Reason> {
    // SAFETY: a live swapchain, of which an image was waited for.
    check(unsafe { (session.instance.next.release_swapchain_image)(target, std::ptr::null()) })
        .map(|_| ())
        .map_err(|result| Reason::Runtime("xrReleaseSwapchainImage", result))
}
