//! What is known of the application's session.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use openxr_sys as sys;
use sys::Handle as _;
use yoro::eyes::{EyesError, Frustum, Pose};

use crate::dispatch::{XrResult, check};
use crate::frame::Frames;
use crate::geometry::{Offer, frustum, pose};
use crate::graphics::Binding;
use crate::instance::Instance;
use crate::lock;
use crate::swapchain::Swapchain;

/// One session.
pub struct Session {
    pub handle: sys::Session,
    pub instance: Arc<Instance>,
    /// None where it is bound to something that the layer does not know.
    pub binding: Option<Binding>,
    /// What the runtime recommends for the dominant eye, in pixels.
    eye_size: [u32; 2],
    /// [`Session::views`].
    views: AtomicUsize,
    /// What was offered last, or why nothing can be.
    pub offer: Mutex<Option<Result<Offer, EyesError>>>,
    /// The application's swapchains.
    pub swapchains: Mutex<Vec<Arc<Swapchain>>>,
    pub frames: Mutex<Frames>,
    /// When xrBeginFrame returned last.
    pub begun: Mutex<Option<Instant>>,
}

impl Session {
    pub fn new(
        handle: sys::Session,
        instance: Arc<Instance>,
        binding: Option<Binding>,
        system: sys::SystemId,
    ) -> Session {
        let eye = instance.own_views(system).map(|views| views[instance.settings.dominant.index()]);
        let eye_size = eye.map_or([1; 2], |eye| {
            [eye.recommended_image_rect_width.max(1), eye.recommended_image_rect_height.max(1)]
        });
        let session = Session {
            handle,
            instance,
            binding,
            eye_size,
            views: AtomicUsize::new(0),
            offer: Mutex::new(None),
            swapchains: Mutex::new(Vec::new()),
            frames: Mutex::default(),
            begun: Mutex::default(),
        };
        if let Some(size) = session.probe() {
            session.instance.latch_size(size);
        }
        session
    }

    /// The size of the view to offer, from the eyes before the first frame. A runtime may refuse to say.
    fn probe(&self) -> Option<[u32; 2]> {
        let identity = sys::Posef {
            orientation: sys::Quaternionf { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
            position: sys::Vector3f { x: 0.0, y: 0.0, z: 0.0 },
        };
        let info = sys::ReferenceSpaceCreateInfo {
            ty: sys::ReferenceSpaceCreateInfo::TYPE,
            next: std::ptr::null(),
            reference_space_type: sys::ReferenceSpaceType::VIEW,
            pose_in_reference_space: identity,
        };
        let next = &self.instance.next;
        let mut space = sys::Space::NULL;
        // SAFETY: a live session, and a valid description.
        check(unsafe { (next.create_reference_space)(self.handle, &info, &mut space) }).ok()?;
        let info = sys::ViewLocateInfo {
            ty: sys::ViewLocateInfo::TYPE,
            next: std::ptr::null(),
            view_configuration_type: sys::ViewConfigurationType::PRIMARY_STEREO,
            // In the space of the views time matters little, and how to ask for the time is an extension's.
            display_time: sys::Time::from_nanos(self.instance.settings.time.unwrap_or(1)),
            space,
        };
        let mut state = view_state();
        let located = self.locate(&info, &mut state);
        // SAFETY: made above, and used no more.
        unsafe { (next.destroy_space)(space) };
        // Not valid before there is tracking: fields of view are, and where poses are not, nothing can be said.
        self.offer_for(&located.ok()?).ok().map(|offer| offer.size)
    }

    /// The runtime's two views.
    pub fn locate(&self, info: &sys::ViewLocateInfo, state: &mut sys::ViewState) -> XrResult<[sys::View; 2]> {
        let info = sys::ViewLocateInfo {
            view_configuration_type: sys::ViewConfigurationType::PRIMARY_STEREO,
            ..*info
        };
        let zero = sys::Vector3f { x: 0.0, y: 0.0, z: 0.0 };
        let view = sys::View {
            ty: sys::View::TYPE,
            next: std::ptr::null_mut(),
            pose: sys::Posef {
                orientation: sys::Quaternionf { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
                position: zero,
            },
            fov: sys::Fovf { angle_left: 0.0, angle_right: 0.0, angle_up: 0.0, angle_down: 0.0 },
        };
        let mut views = [view; 2];
        let mut count = 0;
        // SAFETY: a live session, and room for as many as is said.
        check(unsafe {
            (self.instance.next.locate_views)(self.handle, &info, state, 2, &mut count, views.as_mut_ptr())
        })?;
        Ok(views)
    }

    fn offer_for(&self, views: &[sys::View; 2]) -> Result<Offer, EyesError> {
        let settings = &self.instance.settings;
        let views: [(Pose, Frustum); 2] = views.map(|view| (pose(view.pose), frustum(view.fov)));
        Offer::new(views, self.eye_size, settings.dominant, settings.guard_band)
    }

    /// The view for the application, from the runtime's two. Where nothing can be synthesized between them it is the
    /// dominant eye's own.
    pub fn offer(&self, views: &[sys::View; 2]) -> (Pose, Frustum) {
        let offer = self.offer_for(views);
        *lock(&self.offer) = Some(offer);
        let own = views[self.instance.settings.dominant.index()];
        offer.map_or((pose(own.pose), frustum(own.fov)), |offer| (offer.pose, offer.frustum))
    }

    /// It begins.
    pub fn begin(&self, views: usize) {
        self.views.store(views, Ordering::Relaxed);
    }

    /// How many views a projection layer of the application's has that becomes one of both eyes: one, or two of which one is
    /// tiny. None where everything passes through.
    pub fn views(&self) -> usize {
        self.views.load(Ordering::Relaxed)
    }

    /// Whether one of two views is tiny, and replaced, if it is begun with two.
    pub fn shrinks(&self) -> bool {
        self.binding.is_some() && self.instance.settings.shrink
    }

    /// Whether images of the application are read at the end of a frame.
    pub fn reads_images(&self) -> bool {
        self.binding.is_some() && (self.views() > 0 || self.instance.settings.capture.is_some())
    }
}

/// A structure for the runtime to fill.
pub fn view_state() -> sys::ViewState {
    sys::ViewState {
        ty: sys::ViewState::TYPE,
        next: std::ptr::null_mut(),
        view_state_flags: sys::ViewStateFlags::EMPTY,
    }
}
