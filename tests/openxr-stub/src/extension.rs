//! Functions of extensions.

use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::frame::submitted;
use crate::instance::check_system;
use crate::log::Entry;
use crate::session::views_of;
use crate::world::{Answer, Array, DONE, Event, World, forbid_if, found, in_chain};

pub fn enumerate_display_refresh_rates(
    world: &mut World,
    session: sys::Session,
    rates: Array<f32>,
) -> Answer {
    world.session(session)?;
    rates.fill(&world.script.refresh_rates, |to, from| *to = *from)
}

pub fn request_display_refresh_rate(world: &mut World, session: sys::Session, rate: f32) -> Answer {
    world.session(session)?;
    forbid_if(
        rate != 0.0 && !world.script.refresh_rates.contains(&rate),
        Code::ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB,
        format!("{rate} Hz is not offered"),
    )?;
    world.log.write(&Entry::Request { what: "refresh-rate".into(), value: rate.into() });
    if rate != 0.0 && rate != world.refresh_rate {
        let before = std::mem::replace(&mut world.refresh_rate, rate);
        world.current()?.events.push_back(Event::RefreshRate(before, rate));
    }
    DONE
}

pub fn set_performance_level(
    world: &mut World,
    session: sys::Session,
    domain: sys::PerfSettingsDomainEXT,
    level: sys::PerfSettingsLevelEXT,
) -> Answer {
    world.session(session)?;
    let what = if domain == sys::PerfSettingsDomainEXT::CPU { "cpu-level" } else { "gpu-level" };
    world.log.write(&Entry::Request { what: what.into(), value: level.into_raw().into() });
    DONE
}

pub fn enumerate_reprojection_modes(
    world: &mut World,
    instance: sys::Instance,
    system: sys::SystemId,
    configuration: sys::ViewConfigurationType,
    modes: Array<sys::ReprojectionModeMSFT>,
) -> Answer {
    world.instance(instance)?;
    check_system(system)?;
    views_of(world, configuration)?;
    modes.fill(&[sys::ReprojectionModeMSFT::DEPTH], |to, from| *to = *from)
}

/// Recommends three quarters of the first eye's size for projection layers.
pub fn get_recommended_layer_resolution(
    world: &mut World,
    session: sys::Session,
    info: &sys::RecommendedLayerResolutionGetInfoMETA,
    resolution: &mut sys::RecommendedLayerResolutionMETA,
) -> Answer {
    let views = world.session(session)?.views;
    // SAFETY: a layer of the type that it states.
    unsafe { submitted(world, info.layer, views) }?;
    let [width, height] = world.script.eyes[0].size.map(|pixels| pixels as i32 * 3 / 4);
    resolution.recommended_image_dimensions = sys::Extent2Di { width, height };
    resolution.is_valid = sys::TRUE;
    DONE
}

pub fn create_foveation_profile(
    world: &mut World,
    session: sys::Session,
    info: &sys::FoveationProfileCreateInfoFB,
    out: &mut sys::FoveationProfileFB,
) -> Answer {
    world.session(session)?;
    let ty = sys::FoveationLevelProfileCreateInfoFB::TYPE;
    // SAFETY: a chain of structures, which begin with this header.
    let level = unsafe { in_chain::<sys::FoveationLevelProfileCreateInfoFB>(info.next, ty) };
    let level = level.map_or(sys::FoveationLevelFB::NONE, |profile| profile.level);
    let handle = world.new_handle();
    world.current()?.foveations.insert(handle, level);
    *out = sys::FoveationProfileFB::from_raw(handle);
    DONE
}

pub fn destroy_foveation_profile(world: &mut World, profile: sys::FoveationProfileFB) -> Answer {
    found(world.current()?.foveations.remove(&profile.into_raw()), "not a profile of foveation")?;
    DONE
}

/// Logs the level of foveation. Images keep their density: no driver here has foveated textures.
pub fn update_swapchain(
    world: &mut World,
    swapchain: sys::Swapchain,
    state: &sys::SwapchainStateBaseHeaderFB,
) -> Answer {
    let known = world.swapchain(swapchain)?;
    forbid_if(
        !known.is_foveated,
        Code::ERROR_VALIDATION_FAILURE,
        "the swapchain was made without foveation",
    )?;
    forbid_if(
        state.ty != sys::SwapchainStateFoveationFB::TYPE,
        Code::ERROR_VALIDATION_FAILURE,
        "the structure's type is wrong",
    )?;
    // SAFETY: the structure has this type.
    let state = unsafe { &*std::ptr::from_ref(state).cast::<sys::SwapchainStateFoveationFB>() };
    let level = world.current()?.foveations.get(&state.profile.into_raw()).copied();
    let level = found(level, "not a profile of foveation")?;
    world.log.write(&Entry::Request { what: "foveation".into(), value: level.into_raw().into() });
    DONE
}

/// The type of xrSetAndroidApplicationThreadKHR, which openxr-sys declares only on Android.
pub type SetAndroidApplicationThreadKHR =
    unsafe extern "system" fn(sys::Session, sys::AndroidThreadTypeKHR, u32) -> sys::Result;

pub fn set_android_application_thread(
    world: &mut World,
    session: sys::Session,
    kind: sys::AndroidThreadTypeKHR,
    thread: u32,
) -> Answer {
    world.session(session)?;
    forbid_if(
        !std::path::Path::new(&format!("/proc/self/task/{thread}")).exists(),
        Code::ERROR_ANDROID_THREAD_SETTINGS_ID_INVALID_KHR,
        format!("there is no thread {thread}"),
    )?;
    world.log.write(&Entry::Request { what: "thread".into(), value: kind.into_raw().into() });
    DONE
}

/// Returns the hidden triangle that covers the outer upper corner, in the view's plane at distance 1. Nothing else is
/// asked for.
pub fn get_visibility_mask(
    world: &mut World,
    session: sys::Session,
    configuration: sys::ViewConfigurationType,
    view: u32,
    kind: sys::VisibilityMaskTypeKHR,
    mask: &mut sys::VisibilityMaskKHR,
) -> Answer {
    world.session(session)?;
    forbid_if(
        view >= views_of(world, configuration)?,
        Code::ERROR_VALIDATION_FAILURE,
        format!("there is no view {view}"),
    )?;
    forbid_if(
        ![1, 2, 3].contains(&kind.into_raw()),
        Code::ERROR_VALIDATION_FAILURE,
        format!("{kind:?} is no kind of mask"),
    )?;
    // Nothing is hidden in insets.
    let is_masked = world.script.visibility_mask && view < 2;
    let eye = &world.script.eyes[view as usize % 2];
    let [left, right, up, down] = eye.fov_degrees.map(|a| a.to_radians().tan());
    let (outer, inner) = if view == 0 { (left, right) } else { (right, left) };
    let cut = [outer + 0.25 * (inner - outer), up + 0.25 * (down - up)];
    let corner = [[outer, up], [cut[0], up], [outer, cut[1]]];
    let (vertices, indices): (Vec<[f32; 2]>, Vec<u32>) = match kind {
        sys::VisibilityMaskTypeKHR::HIDDEN_TRIANGLE_MESH if is_masked => (corner.into(), orient(&corner)),
        _ => Default::default(),
    };
    // SAFETY: the mask states its own capacity.
    let (to_vertices, to_indices) = unsafe {
        (
            Array::new(mask.vertex_capacity_input, &raw mut mask.vertex_count_output, mask.vertices),
            Array::new(mask.index_capacity_input, &raw mut mask.index_count_output, mask.indices),
        )
    };
    to_vertices.fill(&vertices, |to, [x, y]| *to = sys::Vector2f { x: *x, y: *y })?;
    to_indices.fill(&indices, |to, from| *to = *from)
}

/// Returns the numbers of a triangle's corners in counter-clockwise order.
fn orient([p, q, r]: &[[f32; 2]; 3]) -> Vec<u32> {
    let area = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
    if area >= 0.0 { vec![0, 1, 2] } else { vec![0, 2, 1] }
}
