//! The functions for the OpenXR loader, and the creation and destruction of instances.

use std::ffi::{CStr, c_char};

use openxr_sys as sys;
use sys::pfn;

use super::{get_instance_proc_addr, sessions, without_panic};
use crate::dispatch::{Dispatch, XrResult, check};
use crate::instance::{Instance, text};
use crate::settings::{OfferedAs, Settings};
use crate::{log, log_line, objects};

const DEPTH: &CStr = c"XR_KHR_composition_layer_depth";
const GRAPHICS: [&CStr; 4] =
    [c"XR_KHR_vulkan_enable", c"XR_KHR_vulkan_enable2", c"XR_KHR_opengl_enable", c"XR_KHR_opengl_es_enable"];

/// Negotiates the interface version. It is the first function that a loader calls.
///
/// # Safety
/// `info` and `request` are null or point to structures of the sizes that they state.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn xrNegotiateLoaderApiLayerInterface(
    info: *const sys::NegotiateLoaderInfo,
    _name: *const c_char,
    request: *mut sys::NegotiateApiLayerRequest,
) -> sys::Result {
    // SAFETY: null, or the loader's structures.
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
    // SAFETY: null, or the loader's structures.
    without_panic(|| match unsafe { (info.as_ref(), layer.as_ref()) } {
        // SAFETY: as above.
        (Some(info), Some(layer)) => unsafe { create_instance(info, layer, handle) },
        _ => Err(sys::Result::ERROR_VALIDATION_FAILURE),
    })
}

/// Creates the instance of the next layer or the runtime, and keeps what the layer needs of it.
///
/// # Safety
/// The structures are the loader's.
unsafe fn create_instance(
    info: &sys::InstanceCreateInfo,
    layer: &sys::ApiLayerCreateInfo,
    handle: *mut sys::Instance,
) -> XrResult<sys::Result> {
    // SAFETY: the loader's structures; names of extensions are null-terminated.
    unsafe {
        let own = layer.next_info.as_ref().ok_or(sys::Result::ERROR_INITIALIZATION_FAILED)?;
        let functions = own.next_create_api_layer_instance.zip(own.next_get_instance_proc_addr);
        let (create, next) = functions.ok_or(sys::Result::ERROR_INITIALIZATION_FAILED)?;
        let below = sys::ApiLayerCreateInfo { next_info: own.next, ..*layer };
        let extensions: &[*const c_char] = if info.enabled_extension_names.is_null() {
            &[]
        } else {
            std::slice::from_raw_parts(info.enabled_extension_names, info.enabled_extension_count as usize)
        };
        let is = |extension: *const c_char, name: &CStr| CStr::from_ptr(extension) == name;
        let enables = |name: &CStr| extensions.iter().any(|&extension| is(extension, name));
        let mut result = create(info, &below, handle);
        let mut takes_depth = enables(DEPTH);
        if result == sys::Result::ERROR_EXTENSION_NOT_PRESENT && takes_depth {
            takes_depth = false;
            // The runtime lacks the extension, so the layer accepts the depth instead.
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
        let dispatch = Dispatch::new(next, handle).inspect_err(|_| destroy(next, handle))?;
        let name = text(&info.application_info.application_name);
        let (settings, errors) = Settings::of(&name);
        for error in errors {
            log_line(format_args!("{error}"));
        }
        let graphics = GRAPHICS.into_iter().any(enables);
        let left_alone = settings.offer == OfferedAs::Off;
        if left_alone {
            log_line(format_args!("{name}: passed through: its settings say offer = off"));
        } else if !graphics {
            log_line(format_args!("{name}: passed through: it uses neither Vulkan nor OpenGL"));
        }
        let serves = graphics && !left_alone;
        objects::add_instance(Instance::new(handle, dispatch, settings, name, serves, takes_depth));
        Ok(result)
    }
}

/// Destroys an instance that lacks a function: runtimes with one instance would refuse the next.
///
/// # Safety
/// `next` is the xrGetInstanceProcAddr for this live instance.
unsafe fn destroy(next: pfn::GetInstanceProcAddr, handle: sys::Instance) {
    let mut function = None;
    // SAFETY: a live instance, and the function of this name has this type.
    unsafe {
        next(handle, c"xrDestroyInstance".as_ptr(), &mut function);
        if let Some(function) = function {
            std::mem::transmute::<pfn::VoidFunction, pfn::DestroyInstance>(function)(handle);
        }
    }
}

/// Implements xrDestroyInstance. Also destroys the sessions that the application has not destroyed.
pub unsafe extern "system" fn destroy_instance(handle: sys::Instance) -> sys::Result {
    without_panic(|| {
        let instance = objects::instance(handle).ok_or(sys::Result::ERROR_HANDLE_INVALID)?;
        for live in objects::sessions_of(handle) {
            sessions::forget(&live);
        }
        if objects::remove_instance(handle) {
            log::close();
        }
        // SAFETY: the application's own call.
        Ok(unsafe { (instance.next.destroy_instance)(handle) })
    })
}
