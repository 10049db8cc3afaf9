//! What is known of the application's instance, and what it is told about view configurations.

use std::sync::Mutex;

use openxr_sys as sys;
use sys::ViewConfigurationType as Views;

use crate::dispatch::{Dispatch, XrResult, check};
use crate::lock;
use crate::settings::{OfferedAs, Settings};

/// By how much the offered view is wider than an eye's where the application asks for its size before there is a session
/// that could tell: about as much as common headsets' frusta differ.
const ESTIMATED_WIDTH: f32 = 1.25;

/// Width and height in pixels that are recommended for an image that is not used.
const TINY: u32 = 16;

/// One instance.
pub struct Instance {
    pub handle: sys::Instance,
    pub next: Dispatch,
    pub settings: Settings,
    /// The name that the application gives itself.
    pub application: String,
    /// It has enabled a graphics interface that the layer knows; without that everything passes through.
    pub serves: bool,
    /// The runtime takes depth, too: it has the extension that the application has enabled.
    pub takes_depth: bool,
    /// The recommended size of the one view, in pixels: the same in all answers since the first session was made.
    size: Mutex<Option<[u32; 2]>>,
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
        Instance { handle, next, settings, application, serves, takes_depth, size: Mutex::new(None) }
    }

    /// Whether the application is offered one view, on a system that has two.
    pub fn offers(&self, system: sys::SystemId) -> bool {
        let mut types = [Views::PRIMARY_MONO; 16];
        self.serves
            && self
                .own_configurations(system, &mut types)
                .is_ok_and(|count| types[..count].contains(&Views::PRIMARY_STEREO))
    }

    fn own_configurations(&self, system: sys::SystemId, types: &mut [Views; 16]) -> XrResult<usize> {
        let mut count = 0;
        // SAFETY: a live instance, and room for as many as is said.
        check(unsafe {
            (self.next.enumerate_view_configurations)(
                self.handle,
                system,
                types.len() as u32,
                &mut count,
                types.as_mut_ptr(),
            )
        })?;
        Ok((count as usize).min(types.len()))
    }

    /// The list of view configurations with the one of a single view; its length.
    pub fn configurations(&self, system: sys::SystemId, list: &mut [Views; 17]) -> XrResult<usize> {
        let mut own = [Views::PRIMARY_MONO; 16];
        let count = self.own_configurations(system, &mut own)?;
        let own = &own[..count];
        // A runtime's own configuration of one view is replaced.
        let others = own.iter().copied().filter(|&kind| kind != Views::PRIMARY_MONO);
        let mono = std::iter::once(Views::PRIMARY_MONO);
        let fill = |list: &mut [Views; 17], all: &mut dyn Iterator<Item = Views>| {
            let mut length = 0;
            for (place, kind) in list.iter_mut().zip(all) {
                *place = kind;
                length += 1;
            }
            length
        };
        Ok(match self.settings.offer {
            _ if !own.contains(&Views::PRIMARY_STEREO) => fill(list, &mut own.iter().copied()),
            OfferedAs::Only => fill(list, &mut mono.into_iter()),
            OfferedAs::First => fill(list, &mut mono.chain(others)),
            OfferedAs::Last => fill(list, &mut others.chain(mono)),
        })
    }

    /// The runtime's two views.
    pub fn own_views(&self, system: sys::SystemId) -> XrResult<[sys::ViewConfigurationView; 2]> {
        let view = sys::ViewConfigurationView {
            ty: sys::ViewConfigurationView::TYPE,
            next: std::ptr::null_mut(),
            recommended_image_rect_width: 0,
            max_image_rect_width: 0,
            recommended_image_rect_height: 0,
            max_image_rect_height: 0,
            recommended_swapchain_sample_count: 0,
            max_swapchain_sample_count: 0,
        };
        let mut views = [view; 2];
        let mut count = 0;
        // SAFETY: a live instance, and room for as many as is said.
        check(unsafe {
            (self.next.enumerate_view_configuration_views)(
                self.handle,
                system,
                Views::PRIMARY_STEREO,
                2,
                &mut count,
                views.as_mut_ptr(),
            )
        })?;
        Ok(views)
    }

    /// The one view: the dominant eye's, with more pixels.
    pub fn view(&self, system: sys::SystemId) -> XrResult<sys::ViewConfigurationView> {
        let own = self.own_views(system)?[self.settings.dominant.index()];
        let size = lock(&self.size).unwrap_or([
            (own.recommended_image_rect_width as f32 * ESTIMATED_WIDTH).ceil() as u32,
            own.recommended_image_rect_height,
        ]);
        Ok(sys::ViewConfigurationView {
            recommended_image_rect_width: size[0].min(own.max_image_rect_width),
            recommended_image_rect_height: size[1].min(own.max_image_rect_height),
            ..own
        })
    }

    /// Both views, where one is tiny.
    pub fn shrunk_views(&self, system: sys::SystemId) -> XrResult<[sys::ViewConfigurationView; 2]> {
        let mut views = self.own_views(system)?.map(|own| sys::ViewConfigurationView {
            recommended_image_rect_width: TINY.min(own.max_image_rect_width),
            recommended_image_rect_height: TINY.min(own.max_image_rect_height),
            ..own
        });
        views[self.settings.dominant.index()] = self.view(system)?;
        Ok(views)
    }

    /// What the first session knows of the view's size; later ones do not change it.
    pub fn latch_size(&self, size: [u32; 2]) {
        lock(&self.size).get_or_insert(size);
    }
}
