//! An instance of the application, and the view configurations that it is offered.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;
use std::sync::Mutex;

use openxr_sys as sys;
use smallvec::SmallVec;
use sys::ViewConfigurationType as Views;

use crate::dispatch::{Dispatch, XrResult, check};
use crate::settings::{OfferedAs, Settings};
use crate::{lock, sizes, structures};

/// The estimated width of the offered view, relative to an eye's, before it is known from a session. The frusta of the
/// two eyes of common headsets differ by about this much.
const ESTIMATED_WIDTH: f32 = 1.25;

/// The recommended width and height in pixels of an image that is not used.
const TINY: u32 = 16;

/// Returns the string in a null-terminated array of characters.
pub fn text<const N: usize>(characters: &[c_char; N]) -> String {
    let bytes = characters.map(|byte| byte as u8);
    CStr::from_bytes_until_nul(&bytes).unwrap_or_default().to_string_lossy().into_owned()
}

/// Returns the field of view that contains two.
fn both(a: sys::Fovf, b: sys::Fovf) -> sys::Fovf {
    sys::Fovf {
        angle_left: a.angle_left.min(b.angle_left),
        angle_right: a.angle_right.max(b.angle_right),
        angle_up: a.angle_up.max(b.angle_up),
        angle_down: a.angle_down.min(b.angle_down),
    }
}

/// One instance.
pub struct Instance {
    pub handle: sys::Instance,
    pub next: Dispatch,
    pub settings: Settings,
    /// The name that the application states in XrApplicationInfo.
    pub application: String,
    /// True if the application has enabled a graphics interface that the layer knows, and the settings do not turn the
    /// layer off. Otherwise everything is passed through.
    pub serves: bool,
    /// True if the runtime accepts depth: it has the extension, and the application has enabled it.
    pub takes_depth: bool,
    /// The recommended sizes of the rendered views of each system, in pixels. They never change once they have been
    /// returned.
    sizes: Mutex<Vec<RecommendedSize>>,
}

/// A rendered view of a system, and its recommended size in pixels.
#[derive(Clone, Copy)]
struct RecommendedSize {
    system: sys::SystemId,
    role: ViewRole,
    size: [u32; 2],
}

/// What a rendered view stands for in both eyes: all that they see, or, of four views, the wide ones or the insets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewRole {
    /// The two views of PRIMARY_STEREO.
    Eyes,
    /// The first two of PRIMARY_STEREO_WITH_FOVEATED_INSET.
    Wide,
    /// The last two of it.
    Inset,
}

impl ViewRole {
    /// The roles of four views, in the order of the views.
    pub const OF_FOUR: [ViewRole; 2] = [ViewRole::Wide, ViewRole::Inset];
}

impl Instance {
    pub fn new(
        handle: sys::Instance,
        next: Dispatch,
        settings: Settings,
        application: String,
        serves: bool,
        takes_depth: bool,
    ) -> Instance {
        Instance { handle, next, settings, application, serves, takes_depth, sizes: Mutex::default() }
    }

    /// True if the application is offered one view, because the system has two.
    pub fn offers(&self, system: sys::SystemId) -> bool {
        self.serves && self.own_configurations(system).is_ok_and(|own| own.contains(&Views::PRIMARY_STEREO))
    }

    /// True if the application is offered one view, or if the runtime fails to list its configurations.
    pub fn may_offer(&self, system: sys::SystemId) -> bool {
        self.serves
            && self.own_configurations(system).map_or(true, |own| own.contains(&Views::PRIMARY_STEREO))
    }

    /// Returns the runtime's view configuration for one of the application's, to which PRIMARY_MONO may be offered.
    ///
    /// # Errors
    /// ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED for those that the setting `offer = only` hides.
    pub fn runtimes(&self, offers_mono: bool, kind: Views) -> XrResult<Views> {
        match kind {
            _ if !offers_mono => Ok(kind),
            Views::PRIMARY_MONO => Ok(Views::PRIMARY_STEREO),
            _ if self.settings.offer == OfferedAs::Only => {
                Err(sys::Result::ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED)
            }
            _ => Ok(kind),
        }
    }

    /// Returns the runtime's own view configurations, at most 16.
    fn own_configurations(&self, system: sys::SystemId) -> XrResult<SmallVec<[Views; 17]>> {
        let mut types = [Views::PRIMARY_MONO; 16];
        let mut count = 0;
        // SAFETY: a live instance, and room for 16 types.
        check(unsafe {
            (self.next.enumerate_view_configurations)(
                self.handle,
                system,
                types.len() as u32,
                &mut count,
                types.as_mut_ptr(),
            )
        })?;
        Ok(types.into_iter().take(count as usize).collect())
    }

    /// Returns the view configurations that the application is offered, including the one with a single view.
    pub fn configurations(&self, system: sys::SystemId) -> XrResult<SmallVec<[Views; 17]>> {
        let mut list = self.own_configurations(system)?;
        if !list.contains(&Views::PRIMARY_STEREO) {
            return Ok(list);
        }
        // It replaces the runtime's own configuration with one view.
        list.retain(|kind| *kind != Views::PRIMARY_MONO && self.settings.offer != OfferedAs::Only);
        let place = if self.settings.offer == OfferedAs::Last { list.len() } else { 0 };
        list.insert(place, Views::PRIMARY_MONO);
        Ok(list)
    }

    /// True if the runtime has four views, and all but two of them are made tiny.
    pub fn shrinks_four(&self, system: sys::SystemId) -> bool {
        self.settings.shrink
            && self.serves
            && self
                .own_configurations(system)
                .is_ok_and(|own| own.contains(&Views::PRIMARY_STEREO_WITH_FOVEATED_INSET))
    }

    /// Returns the runtime's views of a configuration with this many, and fills in the structures that are chained to
    /// each.
    pub fn own_views<const N: usize>(
        &self,
        system: sys::SystemId,
        kind: Views,
        chains: [*mut c_void; N],
    ) -> XrResult<[sys::ViewConfigurationView; N]> {
        let mut views = chains.map(|next| sys::ViewConfigurationView {
            ty: sys::ViewConfigurationView::TYPE,
            next,
            recommended_image_rect_width: 0,
            max_image_rect_width: 0,
            recommended_image_rect_height: 0,
            max_image_rect_height: 0,
            recommended_swapchain_sample_count: 0,
            max_swapchain_sample_count: 0,
        });
        let mut count = 0;
        // SAFETY: a live instance, and room for these views.
        check(unsafe {
            (self.next.enumerate_view_configuration_views)(
                self.handle,
                system,
                kind,
                N as u32,
                &mut count,
                views.as_mut_ptr(),
            )
        })?;
        Ok(views)
    }

    /// Returns the one view: the dominant eye's, with more pixels.
    pub fn view(&self, system: sys::SystemId, chain: *mut c_void) -> XrResult<sys::ViewConfigurationView> {
        let mut chains = [ptr::null_mut(); 2];
        chains[self.settings.dominant.index()] = chain;
        let own = self.own_views(system, Views::PRIMARY_STEREO, chains)?[self.settings.dominant.index()];
        Ok(self.enlarged(system, ViewRole::Eyes, own))
    }

    fn enlarged(
        &self,
        system: sys::SystemId,
        role: ViewRole,
        own: sys::ViewConfigurationView,
    ) -> sys::ViewConfigurationView {
        let eye = [own.recommended_image_rect_width, own.recommended_image_rect_height];
        let size = self.announced_size(system, role).unwrap_or_else(|| {
            let known = self.circumstances(system, role).and_then(|key| sizes::recall(&key, eye));
            let size = known.unwrap_or([(eye[0] as f32 * ESTIMATED_WIDTH).ceil() as u32, eye[1]]);
            self.latch_size(system, role, size)
        });
        self.join_fields_of_view(system, role, own.next);
        sys::ViewConfigurationView {
            recommended_image_rect_width: size[0].min(own.max_image_rect_width),
            recommended_image_rect_height: size[1].min(own.max_image_rect_height),
            ..own
        }
    }

    /// Makes the fields of view that the runtime has chained to an enlarged view (XR_EPIC_view_configuration_fov) those of
    /// both eyes together.
    fn join_fields_of_view(&self, system: sys::SystemId, role: ViewRole, chain: *mut c_void) {
        let ty = sys::ViewConfigurationViewFovEPIC::TYPE;
        // SAFETY: the application's chain, and the structure of this type.
        let fov = unsafe { structures::find_mut::<sys::ViewConfigurationViewFovEPIC>(chain, ty) };
        let Some(fov) = fov else { return };
        let mut each = [sys::ViewConfigurationViewFovEPIC { next: ptr::null(), ..*fov }; 4];
        let [a, b, c, d] = each.each_mut().map(|fov| ptr::from_mut(fov).cast());
        let four = Views::PRIMARY_STEREO_WITH_FOVEATED_INSET;
        let asked = match role {
            ViewRole::Eyes => self.own_views(system, Views::PRIMARY_STEREO, [a, b]).map(drop),
            ViewRole::Wide => self.own_views(system, four, [a, b, c, d]).map(drop),
            ViewRole::Inset => self.own_views(system, four, [c, d, a, b]).map(drop),
        };
        if asked.is_ok() {
            fov.recommended_fov = both(each[0].recommended_fov, each[1].recommended_fov);
            fov.max_mutable_fov = both(each[0].max_mutable_fov, each[1].max_mutable_fov);
        }
    }

    /// Returns the views of a configuration, of which those of the non-dominant eye are tiny. `roles` are what the views
    /// of each eye stand for, in their order.
    pub fn shrunk_views<const N: usize>(
        &self,
        system: sys::SystemId,
        kind: Views,
        roles: &[ViewRole],
        chains: [*mut c_void; N],
    ) -> XrResult<[sys::ViewConfigurationView; N]> {
        let own = self.own_views(system, kind, chains)?;
        let mut views = own.map(|own| sys::ViewConfigurationView {
            recommended_image_rect_width: TINY.min(own.max_image_rect_width),
            recommended_image_rect_height: TINY.min(own.max_image_rect_height),
            ..own
        });
        let dominant = self.settings.dominant.index();
        for (i, role) in roles.iter().enumerate() {
            let view = 2 * i + dominant;
            views[view] = self.enlarged(system, *role, own[view]);
        }
        Ok(views)
    }

    fn announced_size(&self, system: sys::SystemId, role: ViewRole) -> Option<[u32; 2]> {
        let sizes = lock(&self.sizes);
        sizes.iter().find(|known| known.system == system && known.role == role).map(|known| known.size)
    }

    /// Sets the size of a system's rendered view, unless it is already set: a runtime must always return the same sizes.
    /// Returns the size in force.
    fn latch_size(&self, system: sys::SystemId, role: ViewRole, size: [u32; 2]) -> [u32; 2] {
        let mut sizes = lock(&self.sizes);
        if let Some(known) = sizes.iter().find(|known| known.system == system && known.role == role) {
            return known.size;
        }
        sizes.push(RecommendedSize { system, role, size });
        size
    }

    /// Forgets the sizes of a system, whose views have changed.
    pub fn forget_sizes(&self, system: sys::SystemId) {
        lock(&self.sizes).retain(|known| known.system != system);
    }

    /// Remembers the size of a rendered view, with that of an eye's, for calls to come and for the next start.
    pub fn remember_size(&self, system: sys::SystemId, role: ViewRole, eye: [u32; 2], size: [u32; 2]) {
        self.latch_size(system, role, size);
        if let Some(key) = self.circumstances(system, role) {
            sizes::remember(&key, eye, size);
        }
    }

    /// Returns everything that the frusta of the eyes and of the offered view depend on: runtime, headset and settings.
    fn circumstances(&self, system: sys::SystemId, role: ViewRole) -> Option<String> {
        // SAFETY: plain data, for which zeros are valid; a live instance, and structures with their types set.
        let (runtime, headset) = unsafe {
            let mut runtime =
                sys::InstanceProperties { ty: sys::InstanceProperties::TYPE, ..std::mem::zeroed() };
            check((self.next.get_instance_properties)(self.handle, &mut runtime)).ok()?;
            let mut headset = sys::SystemProperties { ty: sys::SystemProperties::TYPE, ..std::mem::zeroed() };
            check((self.next.get_system_properties)(self.handle, system, &mut headset)).ok()?;
            (runtime, headset)
        };
        let (runtime, headset) = (text(&runtime.runtime_name), text(&headset.system_name));
        let Settings { dominant, guard_band, .. } = &self.settings;
        let role = match role {
            ViewRole::Eyes => "",
            ViewRole::Wide => ", wide",
            ViewRole::Inset => ", inset",
        };
        Some(format!("{runtime}, {headset}, {} eye, guard band {guard_band}{role}", dominant.name()))
    }
}
