//! View configurations and views. Each function has the contract of its OpenXR counterpart.

use std::ptr;

use openxr_sys as sys;
use sys::ViewConfigurationType as ViewsOf;

use crate::dispatch::{XrResult, check};
use crate::frame::projection;
use crate::geometry::{xr_fov, xr_pose};
use crate::instance::{Instance, ViewRole};
use crate::objects::{self, LiveSession};

/// Answers a call that asks for an array: writes its length and, if the capacity is not 0, its elements.
///
/// # Safety
/// `count` is writable, and `place` has room for `capacity` elements.
unsafe fn answer<T: Copy>(
    list: &[T],
    capacity: u32,
    count: *mut u32,
    place: *mut T,
) -> XrResult<sys::Result> {
    // SAFETY: the application's arguments, with as much room as it states.
    unsafe {
        *count.as_mut().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)? = list.len() as u32;
        match capacity {
            0 => {}
            capacity if (capacity as usize) < list.len() => {
                return Err(sys::Result::ERROR_SIZE_INSUFFICIENT);
            }
            _ if place.is_null() => return Err(sys::Result::ERROR_VALIDATION_FAILURE),
            _ => ptr::copy_nonoverlapping(list.as_ptr(), place, list.len()),
        }
    }
    Ok(sys::Result::SUCCESS)
}

pub unsafe fn enumerate_configurations(
    instance: &Instance,
    system: sys::SystemId,
    capacity: u32,
    count: *mut u32,
    types: *mut ViewsOf,
) -> XrResult<sys::Result> {
    let list = instance.configurations(system)?;
    // SAFETY: the application's arguments.
    unsafe { answer(&list, capacity, count, types) }
}

pub unsafe fn configuration_properties(
    instance: &Instance,
    system: sys::SystemId,
    kind: ViewsOf,
    properties: *mut sys::ViewConfigurationProperties,
) -> XrResult<sys::Result> {
    let next = instance.next.get_view_configuration_properties;
    // SAFETY: the application's arguments.
    unsafe {
        let result = check(next(instance.handle, system, instance.runtimes(system, kind), properties))?;
        (*properties).view_configuration_type = kind;
        Ok(result)
    }
}

pub unsafe fn enumerate_views(
    instance: &Instance,
    system: sys::SystemId,
    kind: ViewsOf,
    capacity: u32,
    count: *mut u32,
    views: *mut sys::ViewConfigurationView,
) -> XrResult<sys::Result> {
    // SAFETY: the application's arguments.
    unsafe {
        // The runtime fills in what the application has chained to its views.
        let room = if views.is_null() { 0 } else { capacity as usize };
        let chain =
            |i: usize, count: usize| if room < count { ptr::null_mut() } else { (*views.add(i)).next };
        let own = match kind {
            ViewsOf::PRIMARY_MONO if instance.offers(system) => vec![instance.view(system, chain(0, 1))?],
            ViewsOf::PRIMARY_STEREO if instance.settings.shrink && instance.offers(system) => {
                let chains = [0, 1].map(|i| chain(i, 2));
                instance.shrunk_views(system, kind, &[ViewRole::Eyes], chains)?.to_vec()
            }
            ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET if instance.shrinks_four(system) => {
                let chains = [0, 1, 2, 3].map(|i| chain(i, 4));
                instance.shrunk_views(system, kind, &ViewRole::OF_FOUR, chains)?.to_vec()
            }
            _ => {
                let next = instance.next.enumerate_view_configuration_views;
                return Ok(next(instance.handle, system, kind, capacity, count, views));
            }
        };
        if room < own.len() {
            return answer(&own, capacity, count, views);
        }
        *count.as_mut().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)? = own.len() as u32;
        for (i, view) in own.iter().enumerate() {
            let place = &mut *views.add(i);
            *place = sys::ViewConfigurationView { ty: place.ty, next: place.next, ..*view };
        }
        Ok(sys::Result::SUCCESS)
    }
}

pub unsafe fn enumerate_blend_modes(
    instance: &Instance,
    system: sys::SystemId,
    kind: ViewsOf,
    capacity: u32,
    count: *mut u32,
    modes: *mut sys::EnvironmentBlendMode,
) -> XrResult<sys::Result> {
    let next = instance.next.enumerate_environment_blend_modes;
    let kind = instance.runtimes(system, kind);
    // SAFETY: the application's arguments.
    Ok(unsafe { next(instance.handle, system, kind, capacity, count, modes) })
}

pub unsafe fn enumerate_reprojection_modes(
    instance: &Instance,
    system: sys::SystemId,
    kind: ViewsOf,
    capacity: u32,
    count: *mut u32,
    modes: *mut sys::ReprojectionModeMSFT,
) -> XrResult<sys::Result> {
    let next = instance.next.enumerate_reprojection_modes;
    let kind = instance.runtimes(system, kind);
    // SAFETY: the application's arguments.
    Ok(unsafe { next(instance.handle, system, kind, capacity, count, modes) })
}

/// Implements xrPollEvent. An event about one of the runtime's two views becomes one about the offered view.
pub unsafe fn poll_event(instance: &Instance, event: *mut sys::EventDataBuffer) -> XrResult<sys::Result> {
    // SAFETY: the application's own call. The event has the type that it states.
    unsafe {
        let result = check((instance.next.poll_event)(instance.handle, event))?;
        if result == sys::Result::SUCCESS && (*event).ty == sys::EventDataVisibilityMaskChangedKHR::TYPE {
            let event = &mut *event.cast::<sys::EventDataVisibilityMaskChangedKHR>();
            let is_one = objects::session(event.session).is_some_and(|live| live.session.views() == 1);
            if is_one && event.view_configuration_type == ViewsOf::PRIMARY_STEREO {
                (event.view_configuration_type, event.view_index) = (ViewsOf::PRIMARY_MONO, 0);
            }
        }
        Ok(result)
    }
}

/// Implements xrGetRecommendedLayerResolutionMETA. The runtime receives two views instead of one. Its recommendation
/// for an eye is enlarged to the offered view.
pub unsafe fn recommended_layer_resolution(
    live: &LiveSession,
    info: *const sys::RecommendedLayerResolutionGetInfoMETA,
    resolution: *mut sys::RecommendedLayerResolutionMETA,
) -> XrResult<sys::Result> {
    let session = &live.session;
    let next = session.instance.next.get_recommended_layer_resolution;
    // SAFETY: the application's arguments.
    unsafe {
        let layer = info.as_ref().filter(|_| session.views() == 1).and_then(|info| projection(info.layer, 1));
        let Some(layer) = layer else { return Ok(next(session.handle, info, resolution)) };
        let views = [*layer.views; 2];
        let layer = sys::CompositionLayerProjection { view_count: 2, views: views.as_ptr(), ..*layer };
        let asked = sys::RecommendedLayerResolutionGetInfoMETA { layer: (&raw const layer).cast(), ..*info };
        let result = check(next(session.handle, &asked, resolution))?;
        let size = &mut (*resolution).recommended_image_dimensions;
        let enlarged = session.enlarged([size.width, size.height].map(|pixels| pixels.max(0) as u32));
        (size.width, size.height) = (enlarged[0] as i32, enlarged[1] as i32);
        Ok(result)
    }
}

pub unsafe fn visibility_mask(
    live: &LiveSession,
    kind: ViewsOf,
    view: u32,
    mask_kind: sys::VisibilityMaskTypeKHR,
    mask: *mut sys::VisibilityMaskKHR,
) -> XrResult<sys::Result> {
    let session = &live.session;
    let next = session.instance.next.get_visibility_mask;
    let dominant = session.instance.settings.dominant.index() as u32;
    // SAFETY: the application's arguments.
    unsafe {
        match kind {
            ViewsOf::PRIMARY_MONO if session.answers_mono() => {
                if view != 0 {
                    return Err(sys::Result::ERROR_VALIDATION_FAILURE);
                }
            }
            ViewsOf::PRIMARY_STEREO | ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET
                if session.shrinks() && view % 2 == dominant => {}
            _ => return Ok(next(session.handle, kind, view, mask_kind, mask)),
        }
        // One eye may see what is hidden from the other, so nothing is hidden in the one view.
        (*mask).vertex_count_output = 0;
        (*mask).index_count_output = 0;
    }
    Ok(sys::Result::SUCCESS)
}

pub unsafe fn locate(
    live: &LiveSession,
    info: *const sys::ViewLocateInfo,
    state: *mut sys::ViewState,
    capacity: u32,
    count: *mut u32,
    views: *mut sys::View,
) -> XrResult<sys::Result> {
    let session = &live.session;
    let settings = &session.instance.settings;
    // SAFETY: the application's arguments.
    unsafe {
        let mut asked = *info;
        if asked.view_configuration_type != ViewsOf::PRIMARY_MONO || !session.answers_mono() {
            let next = session.instance.next.locate_views;
            let result = check(next(session.handle, &asked, state, capacity, count, views))?;
            let stereo = asked.view_configuration_type == ViewsOf::PRIMARY_STEREO;
            if stereo && session.views() == 2 && capacity >= 2 && !views.is_null() {
                // The dominant view contains what both eyes see.
                let (pose, frustum) = session.offer(&[*views, *views.add(1)]);
                let own = &mut *views.add(settings.dominant.index());
                (own.pose, own.fov) = (xr_pose(pose), xr_fov(frustum));
            }
            let four = asked.view_configuration_type == ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET;
            if four && session.views() == 4 && capacity >= 4 && !views.is_null() {
                let all = [0, 1, 2, 3].map(|i| *views.add(i));
                let offered = session.offer_two_of_four(&all).into_iter().flatten();
                for (i, (pose, frustum)) in offered.enumerate() {
                    let own = &mut *views.add(2 * i + settings.dominant.index());
                    (own.pose, own.fov) = (xr_pose(pose), xr_fov(frustum));
                }
            }
            return Ok(result);
        }
        let state = state.as_mut().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)?;
        let next = views.as_ref().filter(|_| capacity > 0).map_or(ptr::null_mut(), |view| view.next);
        asked.view_configuration_type = ViewsOf::PRIMARY_STEREO;
        let located = session.locate(&asked, state, next)?;
        let (pose, frustum) = session.offer(&located);
        let view = sys::View { ty: sys::View::TYPE, next, pose: xr_pose(pose), fov: xr_fov(frustum) };
        answer(&[view], capacity, count, views)
    }
}
