//! What the layer knows about one of the application's sessions.

use std::ffi::c_void;
use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use openxr_sys as sys;
use sys::ViewConfigurationType as Views;
use yoro::eyes::{EyesError, Frustum, Pose};

use crate::binding::Binding;
use crate::dispatch::{XrResult, check};
use crate::geometry::{IDENTITY, Offer, frustum, pose};
use crate::instance::{Instance, ViewRole};
use crate::{lock, sizes};

/// One session.
pub struct Session {
    pub handle: sys::Session,
    pub instance: Arc<Instance>,
    /// `None` if the layer does not know the graphics interface.
    pub binding: Option<Binding>,
    /// True if PRIMARY_MONO is implemented by the layer, because the runtime shows two views on this system.
    pub offers_mono: bool,
    system: sys::SystemId,
    /// The sizes in pixels that the runtime recommends for the dominant eye's views, by [`ViewRole`].
    eye_sizes: [[u32; 2]; 3],
    /// The value of [`Session::views`].
    views: AtomicUsize,
    /// True if the size of the offered view is remembered for the next start, by [`ViewRole`].
    remembered: [AtomicBool; 3],
    /// The last offers by [`ViewRole`], or the reasons why nothing can be offered.
    offers: Mutex<[Option<Result<Offer, EyesError>>; 3]>,
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
        let shrinks_four = instance.shrinks_four(system);
        let dominant = instance.settings.dominant.index();
        let size = |eye: &sys::ViewConfigurationView| {
            [eye.recommended_image_rect_width.max(1), eye.recommended_image_rect_height.max(1)]
        };
        let mut eye_sizes = [[1; 2]; 3];
        if offers_mono
            && let Ok(views) = instance.own_views(system, Views::PRIMARY_STEREO, [ptr::null_mut(); 2])
        {
            eye_sizes[ViewRole::Eyes as usize] = size(&views[dominant]);
        }
        let four = Views::PRIMARY_STEREO_WITH_FOVEATED_INSET;
        if shrinks_four && let Ok(views) = instance.own_views(system, four, [ptr::null_mut(); 4]) {
            eye_sizes[ViewRole::Wide as usize] = size(&views[dominant]);
            eye_sizes[ViewRole::Inset as usize] = size(&views[2 + dominant]);
        }
        Session {
            handle,
            offers_mono,
            instance,
            system,
            binding,
            eye_sizes,
            views: AtomicUsize::new(0),
            remembered: Default::default(),
            offers: Mutex::default(),
            begun: Mutex::default(),
        }
    }

    /// Locates the runtime's two views. `info` names their configuration, and `chain` is chained to the dominant eye's.
    ///
    /// # Errors
    /// The result of xrLocateViews.
    ///
    /// # Safety
    /// The arguments are those of the application's call.
    pub unsafe fn locate(
        &self,
        info: &sys::ViewLocateInfo,
        state: *mut sys::ViewState,
        chain: *mut c_void,
    ) -> XrResult<[sys::View; 2]> {
        let fov = sys::Fovf { angle_left: 0.0, angle_right: 0.0, angle_up: 0.0, angle_down: 0.0 };
        let mut views = [sys::View { ty: sys::View::TYPE, next: ptr::null_mut(), pose: IDENTITY, fov }; 2];
        views[self.instance.settings.dominant.index()].next = chain;
        let mut count = 0;
        // SAFETY: a live session, room for these views, and the application's own arguments.
        check(unsafe {
            let locate = self.instance.next.locate_views;
            locate(self.handle, info, state, views.len() as u32, &mut count, views.as_mut_ptr())
        })?;
        Ok(views)
    }

    fn offer_for(&self, role: ViewRole, views: &[sys::View; 2]) -> Result<Offer, EyesError> {
        let settings = &self.instance.settings;
        let views = views.map(|view| (pose(view.pose), frustum(view.fov)));
        Offer::new(views, self.eye_sizes[role as usize], settings.dominant, settings.guard_band)
    }

    /// Returns the view that the application gets instead of the runtime's two, and remembers the offer. If nothing can
    /// be synthesized between them, it is the dominant eye's own view.
    pub fn offer(&self, views: &[sys::View; 2]) -> (Pose, Frustum) {
        let own = &views[self.instance.settings.dominant.index()];
        self.remember(ViewRole::Eyes, self.offer_for(ViewRole::Eyes, views))
            .unwrap_or((pose(own.pose), frustum(own.fov)))
    }

    /// Returns the wide view and the inset that the application gets instead of the runtime's four views, and remembers
    /// the offers. `None` if nothing can be synthesized between one of the pairs: the pose of both views must be the
    /// same, so neither is changed then.
    pub fn offer_two_of_four(&self, views: &[sys::View; 4]) -> Option<[(Pose, Frustum); 2]> {
        let [left, right, left_inset, right_inset] = *views;
        let wide = self.offer_for(ViewRole::Wide, &[left, right]);
        let inset = self.offer_for(ViewRole::Inset, &[left_inset, right_inset]);
        let failed = wide.err().or(inset.err());
        let of = |offer| failed.map_or(offer, Err);
        self.remember(ViewRole::Wide, of(wide))
            .zip(self.remember(ViewRole::Inset, of(inset)))
            .map(|(a, b)| [a, b])
    }

    fn remember(&self, role: ViewRole, offer: Result<Offer, EyesError>) -> Option<(Pose, Frustum)> {
        lock(&self.offers)[role as usize] = Some(offer);
        let offer = offer.ok()?;
        if !self.remembered[role as usize].swap(true, Ordering::Relaxed) {
            let eye = self.eye_sizes[role as usize];
            self.instance.remember_size(self.system, role, eye, offer.size);
        }
        Some((offer.pose, offer.frustum))
    }

    /// Returns the last offer for a role, or the reason why nothing can be offered; `None` before views were located.
    pub fn last_offer(&self, role: ViewRole) -> Option<Result<Offer, EyesError>> {
        lock(&self.offers)[role as usize]
    }

    /// Returns the size in pixels of the offered view for an eye of this size.
    pub fn enlarged(&self, size: [u32; 2]) -> [u32; 2] {
        let own = self.eye_sizes[ViewRole::Eyes as usize];
        let offered = self.last_offer(ViewRole::Eyes).and_then(Result::ok).map_or(own, |offer| offer.size);
        sizes::scaled(size, own, offered)
    }

    /// Begins the session, or ends it with 0. See [`Session::views`] for `views`.
    pub fn begin(&self, views: usize) {
        self.views.store(views, Ordering::Relaxed);
    }

    /// Returns the number of views in the projection layers that are rewritten: 1, or 2 or 4 if half of them are tiny. It
    /// is 0 if everything is passed through, and while the session is not running.
    pub fn views(&self) -> usize {
        self.views.load(Ordering::Relaxed)
    }

    /// Returns the runtime's view configuration for one of the application's, by [`Instance::runtimes`].
    pub fn runtimes(&self, kind: Views) -> XrResult<Views> {
        self.instance.runtimes(self.offers_mono, kind)
    }

    /// True if, should the application begin with two or four views, those of one eye are made tiny and replaced.
    pub fn shrinks(&self) -> bool {
        self.binding.is_some() && self.instance.settings.shrink
    }

    /// Returns what the rewritten views of each eye stand for, in their order.
    pub fn roles(&self) -> &'static [ViewRole] {
        if self.views() == 4 { &ViewRole::OF_FOUR } else { &[ViewRole::Eyes] }
    }

    /// True if the application's images are read at the end of a frame.
    pub fn reads_images(&self) -> bool {
        self.binding.is_some() && self.views() > 0
    }
}
