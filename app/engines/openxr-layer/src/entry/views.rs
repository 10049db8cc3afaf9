//! View configurations and views. Each function has the contract of its OpenXR counterpart.

use std::ptr;
use std::sync::Arc;

use openxr_sys as sys;
use smallvec::SmallVec;
use sys::ViewConfigurationType as ViewsOf;

use crate::dispatch::{XrResult, check};
use crate::frame::projection;
use crate::geometry::{xr_fov, xr_pose};
use crate::instance::{Instance, ViewRole};
use crate::objects::{self, LiveSession};
use crate::session::Session;

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

/// Refuses elements of an array that do not state their type.
///
/// # Safety
/// The array has at least `count` structures, which begin with their types.
unsafe fn check_types<T>(array: *const T, count: usize, ty: sys::StructureType) -> XrResult<()> {
    // SAFETY: same contract.
    let states_it = |i| unsafe { (*array.add(i).cast::<sys::BaseInStructure>()).ty == ty };
    (0..count).all(states_it).then_some(()).ok_or(sys::Result::ERROR_VALIDATION_FAILURE)
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
        let runtimes = instance.runtimes(instance.offers(system), kind)?;
        let result = check(next(instance.handle, system, runtimes, properties))?;
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
    instance.runtimes(instance.offers(system), kind)?;
    // SAFETY: the application's arguments.
    unsafe {
        // The runtime fills in what the application has chained to its views.
        let room = if views.is_null() { 0 } else { capacity as usize };
        let chain =
            |i: usize, count: usize| if room < count { ptr::null_mut() } else { (*views.add(i)).next };
        let check = |count| check_types(views, room.min(count), sys::ViewConfigurationView::TYPE);
        match kind {
            ViewsOf::PRIMARY_MONO if instance.offers(system) => {
                check(1)?;
                answer(&[instance.view(system, chain(0, 1))?], capacity, count, views)
            }
            ViewsOf::PRIMARY_STEREO if instance.settings.shrink && instance.offers(system) => {
                check(2)?;
                let chains = [0, 1].map(|i| chain(i, 2));
                let own = instance.shrunk_views(system, kind, &[ViewRole::Eyes], chains)?;
                answer(&own, capacity, count, views)
            }
            ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET if instance.shrinks_four(system) => {
                check(4)?;
                let chains = [0, 1, 2, 3].map(|i| chain(i, 4));
                let own = instance.shrunk_views(system, kind, &ViewRole::OF_FOUR, chains)?;
                answer(&own, capacity, count, views)
            }
            _ => {
                let next = instance.next.enumerate_view_configuration_views;
                Ok(next(instance.handle, system, kind, capacity, count, views))
            }
        }
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
    let kind = instance.runtimes(instance.offers(system), kind)?;
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
    let kind = instance.runtimes(instance.offers(system), kind)?;
    // SAFETY: the application's arguments.
    Ok(unsafe { next(instance.handle, system, kind, capacity, count, modes) })
}

/// Implements xrPollEvent. An event about the runtime's two views becomes one about the offered view.
pub unsafe fn poll_event(instance: &Instance, event: *mut sys::EventDataBuffer) -> XrResult<sys::Result> {
    // SAFETY: the application's own call. The event has the type that it states.
    unsafe {
        let result = check((instance.next.poll_event)(instance.handle, event))?;
        if result != sys::Result::SUCCESS {
            return Ok(result);
        }
        let is_one = |live: &Arc<LiveSession>| live.session.views() == 1;
        if (*event).ty == sys::EventDataVisibilityMaskChangedKHR::TYPE {
            let event = &mut *event.cast::<sys::EventDataVisibilityMaskChangedKHR>();
            let is_one = objects::session(event.session).as_ref().is_some_and(is_one);
            if is_one && event.view_configuration_type == ViewsOf::PRIMARY_STEREO {
                (event.view_configuration_type, event.view_index) = (ViewsOf::PRIMARY_MONO, 0);
            }
        }
        if (*event).ty == sys::EventDataViewConfigurationViewsChangedEXT::TYPE {
            let event = &mut *event.cast::<sys::EventDataViewConfigurationViewsChangedEXT>();
            instance.forget_sizes(event.system_id);
            let is_one = objects::sessions_of(instance.handle).iter().any(is_one);
            if is_one && event.view_configuration_type == ViewsOf::PRIMARY_STEREO {
                event.view_configuration_type = ViewsOf::PRIMARY_MONO;
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
    let runtimes = session.runtimes(kind)?;
    let is_one = kind != runtimes;
    let shrinkable = [ViewsOf::PRIMARY_STEREO, ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET];
    let is_rewritten = is_one || shrinkable.contains(&kind) && session.shrinks();
    // SAFETY: the application's arguments.
    unsafe {
        let Some(mask) = mask.as_mut().filter(|_| is_rewritten) else {
            return Ok(next(session.handle, runtimes, view, mask_kind, mask));
        };
        if is_one && view != 0 {
            return Err(sys::Result::ERROR_VALIDATION_FAILURE);
        }
        // The runtime judges the arguments. One eye may see what is hidden from the other, so nothing is hidden in a view
        // that stands for both, nor in the one that it replaces.
        let mut own = sys::VisibilityMaskKHR { vertex_capacity_input: 0, index_capacity_input: 0, ..*mask };
        let result = check(next(session.handle, runtimes, view, mask_kind, &mut own))?;
        (mask.vertex_count_output, mask.index_count_output) = (0, 0);
        Ok(result)
    }
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
    let next = session.instance.next.locate_views;
    // SAFETY: the application's arguments.
    unsafe {
        let Some(asked) = info.as_ref() else {
            return Ok(next(session.handle, info, state, capacity, count, views));
        };
        let kind = asked.view_configuration_type;
        let runtimes = session.runtimes(kind)?;
        if kind == runtimes {
            let result = check(next(session.handle, info, state, capacity, count, views))?;
            let room = if views.is_null() { 0 } else { capacity as usize };
            widen(session, kind, room, views);
            return Ok(result);
        }
        let chain = match views.as_ref().filter(|_| capacity > 0) {
            Some(view) if view.ty != sys::View::TYPE => return Err(sys::Result::ERROR_VALIDATION_FAILURE),
            view => view.map_or(ptr::null_mut(), |view| view.next),
        };
        let asked = sys::ViewLocateInfo { view_configuration_type: runtimes, ..*asked };
        let located = session.locate(&asked, state, chain)?;
        let (pose, frustum) = session.offer(&located);
        let view = sys::View { ty: sys::View::TYPE, next: chain, pose: xr_pose(pose), fov: xr_fov(frustum) };
        answer(&[view], capacity, count, views)
    }
}

/// Makes each of the dominant eye's located views, of those that are synthesized for the other eye, contain what both
/// eyes see.
///
/// # Safety
/// There are `room` views, and those of the configuration were located.
unsafe fn widen(session: &Session, kind: ViewsOf, room: usize, views: *mut sys::View) {
    let mut offered = SmallVec::<[_; 2]>::new();
    // SAFETY: same contract.
    unsafe {
        match (kind, session.views()) {
            (ViewsOf::PRIMARY_STEREO, 2) if room >= 2 => {
                offered.push(session.offer(&[*views, *views.add(1)]));
            }
            (ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET, 4) if room >= 4 => {
                let all = [0, 1, 2, 3].map(|i| *views.add(i));
                offered.extend(session.offer_two_of_four(&all).into_iter().flatten());
            }
            _ => {}
        }
        for (i, (pose, frustum)) in offered.into_iter().enumerate() {
            let own = &mut *views.add(2 * i + session.instance.settings.dominant.index());
            (own.pose, own.fov) = (xr_pose(pose), xr_fov(frustum));
        }
    }
}
