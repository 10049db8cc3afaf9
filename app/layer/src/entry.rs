//! The functions that loader and application call.

use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use openxr_sys as sys;
use sys::{ViewConfigurationType as ViewsOf, pfn};

use crate::dispatch::{Dispatch, XrResult, check};
use crate::frame;
use crate::geometry::{xr_fov, xr_pose};
use crate::graphics::Binding;
use crate::instance::Instance;
use crate::session::Session;
use crate::settings::Settings;
use crate::swapchain::{Content, Swapchain};
use crate::{lock, say};

/// The application's objects. They are few: a list is as fast as a map.
static INSTANCES: Mutex<Vec<Arc<Instance>>> = Mutex::new(Vec::new());
static SESSIONS: Mutex<Vec<Arc<Session>>> = Mutex::new(Vec::new());
static SWAPCHAINS: Mutex<Vec<Arc<Swapchain>>> = Mutex::new(Vec::new());

const DEPTH: &CStr = c"XR_KHR_composition_layer_depth";
const GRAPHICS: [&CStr; 4] =
    [c"XR_KHR_vulkan_enable", c"XR_KHR_vulkan_enable2", c"XR_KHR_opengl_enable", c"XR_KHR_opengl_es_enable"];

/// Runs what a C function does; no panic crosses into the caller.
fn shielded(work: impl FnOnce() -> XrResult<sys::Result>) -> sys::Result {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(result) | Err(result)) => result,
        Err(_) => sys::Result::ERROR_RUNTIME_FAILURE,
    }
}

fn instance(handle: sys::Instance) -> XrResult<Arc<Instance>> {
    let known = lock(&INSTANCES).iter().find(|instance| instance.handle == handle).cloned();
    known.ok_or(sys::Result::ERROR_HANDLE_INVALID)
}

fn session(handle: sys::Session) -> XrResult<Arc<Session>> {
    let known = lock(&SESSIONS).iter().find(|session| session.handle == handle).cloned();
    known.ok_or(sys::Result::ERROR_HANDLE_INVALID)
}

fn swapchain(handle: sys::Swapchain) -> XrResult<Arc<Swapchain>> {
    let known = lock(&SWAPCHAINS).iter().find(|swapchain| swapchain.handle == handle).cloned();
    known.ok_or(sys::Result::ERROR_HANDLE_INVALID)
}

/// What a loader calls first.
///
/// # Safety
/// `info` and `request` point to structures of the sizes that they say; `name` is a string or null.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn xrNegotiateLoaderApiLayerInterface(
    info: *const sys::NegotiateLoaderInfo,
    _name: *const c_char,
    request: *mut sys::NegotiateApiLayerRequest,
) -> sys::Result {
    // SAFETY: promised by the caller.
    let (Some(info), Some(request)) = (unsafe { info.as_ref() }, unsafe { request.as_mut() }) else {
        return sys::Result::ERROR_INITIALIZATION_FAILED;
    };
    let sound = info.struct_type == sys::NegotiateLoaderInfo::TYPE
        && info.struct_version == sys::NegotiateLoaderInfo::VERSION
        && info.struct_size == size_of::<sys::NegotiateLoaderInfo>()
        && request.struct_type == sys::NegotiateApiLayerRequest::TYPE
        && request.struct_version == sys::NegotiateApiLayerRequest::VERSION
        && request.struct_size == size_of::<sys::NegotiateApiLayerRequest>();
    let version = sys::CURRENT_LOADER_API_LAYER_VERSION as u32;
    if !sound || !(info.min_interface_version..=info.max_interface_version).contains(&version) {
        return sys::Result::ERROR_INITIALIZATION_FAILED;
    }
    request.layer_interface_version = version;
    request.layer_api_version = sys::CURRENT_API_VERSION;
    request.get_instance_proc_addr = Some(get_instance_proc_addr);
    request.create_api_layer_instance = Some(create_api_layer_instance);
    sys::Result::SUCCESS
}

unsafe extern "system" fn create_api_layer_instance(
    info: *const sys::InstanceCreateInfo,
    layer: *const sys::ApiLayerCreateInfo,
    handle: *mut sys::Instance,
) -> sys::Result {
    // SAFETY: the loader's structures.
    shielded(|| unsafe { create_instance(&*info, &*layer, handle) })
}

unsafe fn create_instance(
    info: &sys::InstanceCreateInfo,
    layer: &sys::ApiLayerCreateInfo,
    handle: *mut sys::Instance,
) -> XrResult<sys::Result> {
    // SAFETY: the loader's structures, with names as C has them.
    unsafe {
        let own = layer.next_info.as_ref().ok_or(sys::Result::ERROR_INITIALIZATION_FAILED)?;
        let functions = own.next_create_api_layer_instance.zip(own.next_get_instance_proc_addr);
        let (create, next) = functions.ok_or(sys::Result::ERROR_INITIALIZATION_FAILED)?;
        let below = sys::ApiLayerCreateInfo { next_info: own.next, ..*layer };
        let extensions: &[*const c_char] = match info.enabled_extension_names.is_null() {
            true => &[],
            false => std::slice::from_raw_parts(
                info.enabled_extension_names,
                info.enabled_extension_count as usize,
            ),
        };
        let is = |extension: *const c_char, name: &CStr| CStr::from_ptr(extension) == name;
        let enables = |name: &CStr| extensions.iter().any(|&extension| is(extension, name));
        let mut result = create(info, &below, handle);
        let mut takes_depth = enables(DEPTH);
        if result == sys::Result::ERROR_EXTENSION_NOT_PRESENT && takes_depth {
            takes_depth = false;
            // A runtime without it: the layer takes the depth, and what it does not know it ignores.
            let rest: Vec<*const c_char> =
                extensions.iter().copied().filter(|&extension| !is(extension, DEPTH)).collect();
            let info = sys::InstanceCreateInfo {
                enabled_extension_count: rest.len() as u32,
                enabled_extension_names: rest.as_ptr(),
                ..*info
            };
            result = create(&info, &below, handle);
        }
        check(result)?;
        let handle = *handle;
        let dispatch = Dispatch::new(next, handle)?;
        let name = info.application_info.application_name.map(|byte| byte as u8);
        let name = CStr::from_bytes_until_nul(&name).unwrap_or_default().to_string_lossy().into_owned();
        let (settings, errors) = Settings::of(&name);
        for error in errors {
            say(format_args!("{error}"));
        }
        let serves = GRAPHICS.into_iter().any(enables);
        if !serves {
            say(format_args!("{name}: passed through: it uses neither Vulkan nor OpenGL"));
        }
        lock(&INSTANCES).push(Arc::new(Instance::new(handle, dispatch, settings, name, serves, takes_depth)));
        Ok(result)
    }
}

unsafe extern "system" fn get_instance_proc_addr(
    handle: sys::Instance,
    name: *const c_char,
    function: *mut Option<pfn::VoidFunction>,
) -> sys::Result {
    shielded(|| {
        let instance = instance(handle)?;
        // SAFETY: the caller's string, and its place for a function.
        let (name, function) = unsafe { (CStr::from_ptr(name), &mut *function) };
        // SAFETY: the next layer's function.
        let result = unsafe { (instance.next.get_instance_proc_addr)(handle, name.as_ptr(), function) };
        // What the next does not have, or not for this instance, is not answered either.
        if check(result).is_ok()
            && let Some(own) = own_function(name, &instance)
        {
            *function = Some(own);
        }
        Ok(result)
    })
}

/// The layer's function of that name, if it has one.
fn own_function(name: &CStr, instance: &Instance) -> Option<pfn::VoidFunction> {
    macro_rules! functions {
        ($($name:literal => $function:ident: $kind:ident,)*) => {
            match name.to_bytes() {
                $($name => {
                    let function: pfn::$kind = $function;
                    // SAFETY: whoever asks for this name calls it as this type.
                    Some(unsafe { std::mem::transmute::<pfn::$kind, pfn::VoidFunction>(function) })
                })*
                _ => None,
            }
        };
    }
    let always = functions! {
        b"xrGetInstanceProcAddr" => get_instance_proc_addr: GetInstanceProcAddr,
        b"xrDestroyInstance" => destroy_instance: DestroyInstance,
    };
    let all = || {
        functions! {
            b"xrCreateSession" => create_session: CreateSession,
            b"xrDestroySession" => destroy_session: DestroySession,
            b"xrBeginSession" => begin_session: BeginSession,
            b"xrEnumerateViewConfigurations" => enumerate_view_configurations: EnumerateViewConfigurations,
            b"xrGetViewConfigurationProperties" => get_view_configuration_properties: GetViewConfigurationProperties,
            b"xrEnumerateViewConfigurationViews" => enumerate_view_configuration_views: EnumerateViewConfigurationViews,
            b"xrEnumerateEnvironmentBlendModes" => enumerate_environment_blend_modes: EnumerateEnvironmentBlendModes,
            b"xrGetVisibilityMaskKHR" => get_visibility_mask: GetVisibilityMaskKHR,
            b"xrLocateViews" => locate_views: LocateViews,
            b"xrBeginFrame" => begin_frame: BeginFrame,
            b"xrEndFrame" => end_frame: EndFrame,
            b"xrCreateSwapchain" => create_swapchain: CreateSwapchain,
            b"xrDestroySwapchain" => destroy_swapchain: DestroySwapchain,
            b"xrAcquireSwapchainImage" => acquire_swapchain_image: AcquireSwapchainImage,
            b"xrWaitSwapchainImage" => wait_swapchain_image: WaitSwapchainImage,
            b"xrReleaseSwapchainImage" => release_swapchain_image: ReleaseSwapchainImage,
        }
    };
    // For tests alone.
    let standing_still = || {
        functions! { b"xrLocateSpace" => locate_space: LocateSpace, }
    };
    always
        .or_else(|| instance.serves.then(all).flatten())
        .or_else(|| instance.settings.time.and_then(|_| standing_still()))
}

unsafe extern "system" fn destroy_instance(handle: sys::Instance) -> sys::Result {
    shielded(|| {
        let own = instance(handle)?;
        let sessions: Vec<_> =
            lock(&SESSIONS).iter().filter(|s| s.instance.handle == handle).cloned().collect();
        for session in sessions {
            forget_session(&session);
        }
        lock(&INSTANCES).retain(|instance| instance.handle != handle);
        // SAFETY: the application's call.
        Ok(unsafe { (own.next.destroy_instance)(handle) })
    })
}

/// How an array is asked for: its length, or, with room, its elements.
///
/// # Safety
/// `count` and `place` are as the specification says of a call with this capacity.
unsafe fn answer<T: Copy>(
    list: &[T],
    capacity: u32,
    count: *mut u32,
    place: *mut T,
) -> XrResult<sys::Result> {
    // SAFETY: promised by the caller.
    unsafe {
        *count.as_mut().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)? = list.len() as u32;
        match capacity {
            0 => {}
            capacity if (capacity as usize) < list.len() => {
                return Err(sys::Result::ERROR_SIZE_INSUFFICIENT);
            }
            _ if place.is_null() => return Err(sys::Result::ERROR_VALIDATION_FAILURE),
            _ => std::ptr::copy_nonoverlapping(list.as_ptr(), place, list.len()),
        }
    }
    Ok(sys::Result::SUCCESS)
}

unsafe extern "system" fn enumerate_view_configurations(
    handle: sys::Instance,
    system: sys::SystemId,
    capacity: u32,
    count: *mut u32,
    types: *mut ViewsOf,
) -> sys::Result {
    shielded(|| {
        let mut list = [ViewsOf::PRIMARY_MONO; 17];
        let length = instance(handle)?.configurations(system, &mut list)?;
        // SAFETY: the application's call.
        unsafe { answer(&list[..length], capacity, count, types) }
    })
}

unsafe extern "system" fn get_view_configuration_properties(
    handle: sys::Instance,
    system: sys::SystemId,
    kind: ViewsOf,
    properties: *mut sys::ViewConfigurationProperties,
) -> sys::Result {
    shielded(|| {
        let instance = instance(handle)?;
        let ours = kind == ViewsOf::PRIMARY_MONO && instance.offers(system);
        let asked = if ours { ViewsOf::PRIMARY_STEREO } else { kind };
        // SAFETY: the application's call.
        unsafe {
            let next = instance.next.get_view_configuration_properties;
            let result = check(next(handle, system, asked, properties))?;
            if ours {
                (*properties).view_configuration_type = kind;
            }
            Ok(result)
        }
    })
}

unsafe extern "system" fn enumerate_view_configuration_views(
    handle: sys::Instance,
    system: sys::SystemId,
    kind: ViewsOf,
    capacity: u32,
    count: *mut u32,
    views: *mut sys::ViewConfigurationView,
) -> sys::Result {
    shielded(|| {
        let instance = instance(handle)?;
        // SAFETY: the application's call.
        unsafe {
            let own = match kind {
                ViewsOf::PRIMARY_MONO if instance.offers(system) => vec![instance.view(system)?],
                ViewsOf::PRIMARY_STEREO if instance.settings.shrink && instance.offers(system) => {
                    instance.shrunk_views(system)?.to_vec()
                }
                _ => {
                    let next = instance.next.enumerate_view_configuration_views;
                    return Ok(next(handle, system, kind, capacity, count, views));
                }
            };
            if views.is_null() || (capacity as usize) < own.len() {
                return answer(&own, capacity, count, views);
            }
            *count.as_mut().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)? = own.len() as u32;
            for (i, view) in own.iter().enumerate() {
                // Type and chain are the application's.
                let place = &mut *views.add(i);
                *place = sys::ViewConfigurationView { ty: place.ty, next: place.next, ..*view };
            }
            Ok(sys::Result::SUCCESS)
        }
    })
}

unsafe extern "system" fn enumerate_environment_blend_modes(
    handle: sys::Instance,
    system: sys::SystemId,
    kind: ViewsOf,
    capacity: u32,
    count: *mut u32,
    modes: *mut sys::EnvironmentBlendMode,
) -> sys::Result {
    shielded(|| {
        let instance = instance(handle)?;
        let ours = kind == ViewsOf::PRIMARY_MONO && instance.offers(system);
        let kind = if ours { ViewsOf::PRIMARY_STEREO } else { kind };
        let next = instance.next.enumerate_environment_blend_modes;
        // SAFETY: the application's call.
        Ok(unsafe { next(handle, system, kind, capacity, count, modes) })
    })
}

unsafe extern "system" fn create_session(
    handle: sys::Instance,
    info: *const sys::SessionCreateInfo,
    created: *mut sys::Session,
) -> sys::Result {
    shielded(|| {
        let instance = instance(handle)?;
        // SAFETY: the application's call.
        unsafe {
            let result = check((instance.next.create_session)(handle, info, created))?;
            let binding = Binding::of(&*info);
            let session = Arc::new(Session::new(*created, instance, binding, (*info).system_id));
            lock(&SESSIONS).push(session);
            Ok(result)
        }
    })
}

/// Drops all that was made for a session, before the runtime destroys it.
fn forget_session(session: &Arc<Session>) {
    lock(&session.frames).end(session);
    lock(&session.swapchains).clear();
    lock(&SWAPCHAINS).retain(|swapchain| swapchain.session.handle != session.handle);
    lock(&SESSIONS).retain(|other| other.handle != session.handle);
}

unsafe extern "system" fn destroy_session(handle: sys::Session) -> sys::Result {
    shielded(|| {
        let session = session(handle)?;
        forget_session(&session);
        // SAFETY: the application's call.
        Ok(unsafe { (session.instance.next.destroy_session)(handle) })
    })
}

unsafe extern "system" fn begin_session(
    handle: sys::Session,
    info: *const sys::SessionBeginInfo,
) -> sys::Result {
    shielded(|| {
        let session = session(handle)?;
        let next = session.instance.next.begin_session;
        let name = &session.instance.application;
        // SAFETY: the application's call.
        unsafe {
            let kind = (*info).primary_view_configuration_type;
            let other = session.instance.settings.dominant.other().name();
            if kind == ViewsOf::PRIMARY_STEREO && session.shrinks() {
                let result = check(next(handle, info))?;
                session.begin(2);
                say(format_args!("{name}: renders a tiny image for the {other} eye, which is synthesized"));
                return Ok(result);
            }
            if kind != ViewsOf::PRIMARY_MONO {
                say(format_args!(
                    "{name}: passed through: it begins its session with {kind:?}, not with one view"
                ));
                session.begin(0);
                return Ok(next(handle, info));
            }
            let stereo =
                sys::SessionBeginInfo { primary_view_configuration_type: ViewsOf::PRIMARY_STEREO, ..*info };
            let result = check(next(handle, &stereo))?;
            session.begin(1);
            say(format_args!("{name}: renders one view; the {other} eye is synthesized"));
            Ok(result)
        }
    })
}

unsafe extern "system" fn get_visibility_mask(
    handle: sys::Session,
    kind: ViewsOf,
    view: u32,
    mask_kind: sys::VisibilityMaskTypeKHR,
    mask: *mut sys::VisibilityMaskKHR,
) -> sys::Result {
    shielded(|| {
        let session = session(handle)?;
        let next = session.instance.next.get_visibility_mask;
        let next = next.ok_or(sys::Result::ERROR_FUNCTION_UNSUPPORTED)?;
        // SAFETY: the application's call.
        unsafe {
            let dominant = session.instance.settings.dominant.index() as u32;
            match kind {
                ViewsOf::PRIMARY_MONO if view != 0 => return Err(sys::Result::ERROR_VALIDATION_FAILURE),
                ViewsOf::PRIMARY_MONO => {}
                ViewsOf::PRIMARY_STEREO if session.shrinks() && view == dominant => {}
                _ => return Ok(next(handle, kind, view, mask_kind, mask)),
            }
            // What one eye does not see the other one may: nothing is hidden.
            (*mask).vertex_count_output = 0;
            (*mask).index_count_output = 0;
        }
        Ok(sys::Result::SUCCESS)
    })
}

unsafe extern "system" fn locate_views(
    handle: sys::Session,
    info: *const sys::ViewLocateInfo,
    state: *mut sys::ViewState,
    capacity: u32,
    count: *mut u32,
    views: *mut sys::View,
) -> sys::Result {
    shielded(|| {
        let session = session(handle)?;
        // SAFETY: the application's call.
        unsafe {
            let mut asked = *info;
            if let Some(time) = session.instance.settings.time {
                asked.display_time = sys::Time::from_nanos(time);
            }
            if asked.view_configuration_type != ViewsOf::PRIMARY_MONO {
                let next = session.instance.next.locate_views;
                let result = check(next(handle, &asked, state, capacity, count, views))?;
                if session.views() == 2 && capacity >= 2 && !views.is_null() {
                    // One of them sees what both do.
                    let located = [*views, *views.add(1)];
                    let (pose, frustum) = session.offer(&located);
                    let own = &mut *views.add(session.instance.settings.dominant.index());
                    (own.pose, own.fov) = (xr_pose(pose), xr_fov(frustum));
                }
                return Ok(result);
            }
            let state = state.as_mut().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)?;
            let located = session.locate(&asked, state)?;
            let (pose, frustum) = session.offer(&located);
            let view = sys::View {
                ty: sys::View::TYPE,
                next: views.as_ref().filter(|_| capacity > 0).map_or(std::ptr::null_mut(), |view| view.next),
                pose: xr_pose(pose),
                fov: xr_fov(frustum),
            };
            answer(&[view], capacity, count, views)
        }
    })
}

unsafe extern "system" fn locate_space(
    space: sys::Space,
    base: sys::Space,
    time: sys::Time,
    location: *mut sys::SpaceLocation,
) -> sys::Result {
    shielded(|| {
        // Spaces are not kept account of: with the setting for tests there is one instance.
        let instance = lock(&INSTANCES).first().cloned().ok_or(sys::Result::ERROR_HANDLE_INVALID)?;
        let time = instance.settings.time.map_or(time, sys::Time::from_nanos);
        // SAFETY: the application's call.
        Ok(unsafe { (instance.next.locate_space)(space, base, time, location) })
    })
}

unsafe extern "system" fn begin_frame(handle: sys::Session, info: *const sys::FrameBeginInfo) -> sys::Result {
    shielded(|| {
        let session = session(handle)?;
        // SAFETY: the application's call.
        let result = unsafe { (session.instance.next.begin_frame)(handle, info) };
        *lock(&session.begun) = Some(Instant::now());
        Ok(result)
    })
}

unsafe extern "system" fn end_frame(handle: sys::Session, info: *const sys::FrameEndInfo) -> sys::Result {
    shielded(|| {
        let session = session(handle)?;
        // SAFETY: the application's call.
        unsafe {
            let info = info.as_ref().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)?;
            Ok(frame::end_frame(&session, info))
        }
    })
}

unsafe extern "system" fn create_swapchain(
    handle: sys::Session,
    info: *const sys::SwapchainCreateInfo,
    created: *mut sys::Swapchain,
) -> sys::Result {
    shielded(|| {
        let session = session(handle)?;
        let next = &session.instance.next;
        // SAFETY: the application's call.
        unsafe {
            let asked = *info;
            let attached = sys::SwapchainUsageFlags::COLOR_ATTACHMENT
                | sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT;
            let binding = session.binding.filter(|_| {
                asked.usage_flags.intersects(attached)
                    && (asked.sample_count, asked.face_count) == (1, 1)
                    && !asked.create_flags.contains(sys::SwapchainCreateFlags::PROTECTED_CONTENT)
            });
            let mut result = sys::Result::ERROR_FEATURE_UNSUPPORTED;
            let mut content = None;
            if let Some(binding) = binding {
                let mut usage = asked.usage_flags | sys::SwapchainUsageFlags::SAMPLED;
                if session.instance.settings.capture.is_some() {
                    usage |= sys::SwapchainUsageFlags::TRANSFER_SRC;
                }
                let more = sys::SwapchainCreateInfo { usage_flags: usage, ..asked };
                result = (next.create_swapchain)(handle, &more, created);
                if check(result).is_ok() {
                    content = Content::of(next, &binding, *created, &asked).ok();
                }
            }
            if check(result).is_err() {
                // As the application wants it: it cannot be read then.
                result = check((next.create_swapchain)(handle, info, created))?;
            }
            let swapchain = Arc::new(Swapchain::new(*created, Arc::clone(&session), content));
            lock(&session.swapchains).push(Arc::clone(&swapchain));
            lock(&SWAPCHAINS).push(swapchain);
            Ok(result)
        }
    })
}

unsafe extern "system" fn destroy_swapchain(handle: sys::Swapchain) -> sys::Result {
    shielded(|| {
        let swapchain = swapchain(handle)?;
        let session = &swapchain.session;
        if let Some(content) = &swapchain.content {
            lock(&session.frames).forget(content);
        }
        lock(&session.swapchains).retain(|other| other.handle != handle);
        lock(&SWAPCHAINS).retain(|other| other.handle != handle);
        // SAFETY: the application's call.
        Ok(unsafe { (session.instance.next.destroy_swapchain)(handle) })
    })
}

unsafe extern "system" fn acquire_swapchain_image(
    handle: sys::Swapchain,
    info: *const sys::SwapchainImageAcquireInfo,
    index: *mut u32,
) -> sys::Result {
    // SAFETY: the application's call.
    shielded(|| Ok(unsafe { swapchain(handle)?.acquire(info, index) }))
}

unsafe extern "system" fn wait_swapchain_image(
    handle: sys::Swapchain,
    info: *const sys::SwapchainImageWaitInfo,
) -> sys::Result {
    // SAFETY: the application's call.
    shielded(|| Ok(unsafe { swapchain(handle)?.wait(info) }))
}

unsafe extern "system" fn release_swapchain_image(
    handle: sys::Swapchain,
    info: *const sys::SwapchainImageReleaseInfo,
) -> sys::Result {
    // SAFETY: the application's call.
    shielded(|| Ok(unsafe { swapchain(handle)?.release(info) }))
}
