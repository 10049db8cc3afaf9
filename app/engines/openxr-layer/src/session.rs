//! What the layer knows about one of the application's sessions.

use std::ffi::c_void;
use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use openxr_sys as sys;
use sys::Handle as _;
use yoro::eyes::{EyesError, Frustum, Pose};

use crate::binding::Binding;
use crate::dispatch::{XrResult, check};
use crate::geometry::{IDENTITY, Offer, frustum, pose};
use crate::instance::Instance;
use crate::{lock, sizes};

/// The value of `Session::views` (the field) before the session begins.
const NOT_BEGUN: usize = usize::MAX;

/// One session.
pub struct Session {
    pub handle: sys::Session,
    pub instance: Arc<Instance>,
    /// `None` if the layer does not know the graphics interface.
    pub binding: Option<Binding>,
    /// True if PRIMARY_MONO is implemented by the layer, because the runtime shows two views on this system.
    pub offers_mono: bool,
    system: sys::SystemId,
    /// The size in pixels that the runtime recommends for the dominant eye.
    eye_size: [u32; 2],
    /// The value of [`Session::views`], or [`NOT_BEGUN`].
    views: AtomicUsize,
    /// True if the size of the offered view is remembered for the next start.
    remembered: AtomicBool,
    /// The last offer, or the reason why nothing can be offered.
    pub offer: Mutex<Option<Result<Offer, EyesError>>>,
    /// When the last xrBeginFrame returned.
    pub begun: Mutex<Option<Instant>>,
}

impl Session {
    pub fn new(
        handle: sys::Session,
        instance: Arc<Instance>,
        binding: Option<Binding>,
        system: sys::SystemId,
    ) -> Session {
        let offers_mono = instance.may_offer(system);
        let eye = if offers_mono { instance.own_views(system, [ptr::null_mut(); 2]).ok() } else { None };
        let eye_size = eye.map(|views| views[instance.settings.dominant.index()]).map_or([1; 2], |eye| {
            [eye.recommended_image_rect_width.max(1), eye.recommended_image_rect_height.max(1)]
        });
        let session = Session {
            handle,
            offers_mono,
            instance,
            system,
            binding,
            eye_size,
            views: AtomicUsize::new(NOT_BEGUN),
            remembered: AtomicBool::new(false),
            offer: Mutex::default(),
            begun: Mutex::default(),
        };
        if offers_mono && let Some(size) = session.size_before_the_first_frame() {
            session.instance.latch_size(system, size);
        }
        session
    }

    /// Returns the size of the offered view, if the runtime locates views before the session begins.
    fn size_before_the_first_frame(&self) -> Option<[u32; 2]> {
        let info = sys::ReferenceSpaceCreateInfo {
            ty: sys::ReferenceSpaceCreateInfo::TYPE,
            next: ptr::null(),
            reference_space_type: sys::ReferenceSpaceType::VIEW,
            pose_in_reference_space: IDENTITY,
        };
        let next = &self.instance.next;
        let mut space = sys::Space::NULL;
        // SAFETY: a live session, and a valid description.
        check(unsafe { (next.create_reference_space)(self.handle, &info, &mut space) }).ok()?;
        let info = sys::ViewLocateInfo {
            ty: sys::ViewLocateInfo::TYPE,
            next: ptr::null(),
            view_configuration_type: sys::ViewConfigurationType::PRIMARY_STEREO,
            // Any time is valid for the VIEW space, and the present time would need an extension.
            display_time: self.instance.settings.time(sys::Time::from_nanos(1)),
            space,
        };
        let mut state = sys::ViewState {
            ty: sys::ViewState::TYPE,
            next: ptr::null_mut(),
            view_state_flags: sys::ViewStateFlags::EMPTY,
        };
        let located = self.locate(&info, &mut state, ptr::null_mut());
        // SAFETY: made above, and no longer used.
        unsafe { (next.destroy_space)(space) };
        // Poses may be invalid before tracking begins, but fields of view are valid.
        self.offer_for(&located.ok()?).ok().map(|offer| offer.size)
    }

    /// Locates the runtime's two views. `chain` is chained to the dominant eye's.
    ///
    /// # Errors
    /// The result of xrLocateViews.
    pub fn locate(
        &self,
        info: &sys::ViewLocateInfo,
        state: &mut sys::ViewState,
        chain: *mut c_void,
    ) -> XrResult<[sys::View; 2]> {
        let info = sys::ViewLocateInfo {
            view_configuration_type: sys::ViewConfigurationType::PRIMARY_STEREO,
            ..*info
        };
        let fov = sys::Fovf { angle_left: 0.0, angle_right: 0.0, angle_up: 0.0, angle_down: 0.0 };
        let view = sys::View { ty: sys::View::TYPE, next: ptr::null_mut(), pose: IDENTITY, fov };
        let mut views = [view; 2];
        views[self.instance.settings.dominant.index()].next = chain;
        let mut count = 0;
        // SAFETY: a live session, and room for two views.
        check(unsafe {
            (self.instance.next.locate_views)(self.handle, &info, state, 2, &mut count, views.as_mut_ptr())
        })?;
        Ok(views)
    }

    fn offer_for(&self, views: &[sys::View; 2]) -> Result<Offer, EyesError> {
        let settings = &self.instance.settings;
        let views = views.map(|view| (pose(view.pose), frustum(view.fov)));
        Offer::new(views, self.eye_size, settings.dominant, settings.guard_band)
    }

    /// Returns the view that the application gets instead of the runtime's two, and remembers the offer. If nothing can
    /// be synthesized between them, it is the dominant eye's own view.
    pub fn offer(&self, views: &[sys::View; 2]) -> (Pose, Frustum) {
        let offer = self.offer_for(views);
        *lock(&self.offer) = Some(offer);
        if let Ok(offer) = offer
            && !self.remembered.swap(true, Ordering::Relaxed)
        {
            self.instance.remember_size(self.system, self.eye_size, offer.size);
        }
        let own = views[self.instance.settings.dominant.index()];
        offer.map_or((pose(own.pose), frustum(own.fov)), |offer| (offer.pose, offer.frustum))
    }

    /// Returns the size in pixels of the offered view for an eye of this size.
    pub fn enlarged(&self, size: [u32; 2]) -> [u32; 2] {
        let offered = lock(&self.offer).and_then(Result::ok).map_or(self.eye_size, |offer| offer.size);
        sizes::scaled(size, self.eye_size, offered)
    }

    /// Begins the session. See [`Session::views`] for `views`.
    pub fn begin(&self, views: usize) {
        self.views.store(views, Ordering::Relaxed);
    }

    /// Returns the number of views in the projection layers that are rewritten: 1, or 2 if one of them is tiny. It is 0
    /// if everything is passed through, and before the session begins.
    pub fn views(&self) -> usize {
        Some(self.views.load(Ordering::Relaxed)).filter(|views| *views != NOT_BEGUN).unwrap_or(0)
    }

    /// True if the layer answers calls for PRIMARY_MONO: until the session begins with another configuration.
    pub fn answers_mono(&self) -> bool {
        self.offers_mono && [NOT_BEGUN, 1].contains(&self.views.load(Ordering::Relaxed))
    }

    /// True if, should the application begin with two views, one is made tiny and replaced.
    pub fn shrinks(&self) -> bool {
        self.binding.is_some() && self.instance.settings.shrink
    }

    /// True if the application's images are read at the end of a frame.
    pub fn reads_images(&self) -> bool {
        self.binding.is_some() && (self.views() > 0 || self.instance.settings.captures())
    }
}
