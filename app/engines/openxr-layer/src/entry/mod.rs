//! The functions that the loader and the application call: a table of the intercepted ones, and modules by topic.
//!
//! No panic leaves them. Calls with handles that the layer does not know, such as swapchains created by an extension,
//! are passed to the runtime unchanged.

mod loader;
mod sessions;
mod swapchains;
mod views;

use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use openxr_sys as sys;
use sys::{ViewConfigurationType, pfn};

use crate::dispatch::{XrResult, check};
use crate::instance::Instance;
use crate::objects;

pub use loader::xrNegotiateLoaderApiLayerInterface;

/// Runs the body of a C function. A panic becomes ERROR_RUNTIME_FAILURE.
fn without_panic(work: impl FnOnce() -> XrResult<sys::Result>) -> sys::Result {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(result) | Err(result)) => result,
        Err(_) => sys::Result::ERROR_RUNTIME_FAILURE,
    }
}

/// Defines a C function for each line, and a lookup by name. The first parameter is the handle of an instance, a
/// session or a swapchain. The implementation receives the known object instead.
macro_rules! intercept {
    ($($name:literal $function:ident: $kind:ident($handle:ident: $type:ty $(, $parameter:ident: $other:ty)*) => $work:path;)*) => {
        $(unsafe extern "system" fn $function($handle: $type $(, $parameter: $other)*) -> sys::Result {
            without_panic(|| match objects::$handle($handle) {
                // SAFETY: the application's arguments for a live object.
                Some(object) => unsafe { $work(&object $(, $parameter)*) },
                None => {
                    let instance = objects::any_instance().ok_or(sys::Result::ERROR_HANDLE_INVALID)?;
                    // SAFETY: the application's own arguments.
                    Ok(unsafe { (instance.next.$function)($handle $(, $parameter)*) })
                }
            })
        })*

        /// Returns the layer's function of a name, if the layer intercepts it.
        fn intercepted(name: &CStr) -> Option<pfn::VoidFunction> {
            $(if name == $name {
                let function: pfn::$kind = $function;
                // SAFETY: the caller that asks for this name calls the function as this type.
                return Some(unsafe { std::mem::transmute::<pfn::$kind, pfn::VoidFunction>(function) });
            })*
            None
        }
    };
}

intercept! {
    c"xrEnumerateViewConfigurations" enumerate_view_configurations: EnumerateViewConfigurations(
        instance: sys::Instance, system: sys::SystemId, capacity: u32, count: *mut u32,
        types: *mut ViewConfigurationType
    ) => views::enumerate_configurations;
    c"xrGetViewConfigurationProperties" get_view_configuration_properties: GetViewConfigurationProperties(
        instance: sys::Instance, system: sys::SystemId, kind: ViewConfigurationType,
        properties: *mut sys::ViewConfigurationProperties
    ) => views::configuration_properties;
    c"xrEnumerateViewConfigurationViews" enumerate_view_configuration_views: EnumerateViewConfigurationViews(
        instance: sys::Instance, system: sys::SystemId, kind: ViewConfigurationType, capacity: u32, count: *mut u32,
        views: *mut sys::ViewConfigurationView
    ) => views::enumerate_views;
    c"xrEnumerateEnvironmentBlendModes" enumerate_environment_blend_modes: EnumerateEnvironmentBlendModes(
        instance: sys::Instance, system: sys::SystemId, kind: ViewConfigurationType, capacity: u32, count: *mut u32,
        modes: *mut sys::EnvironmentBlendMode
    ) => views::enumerate_blend_modes;
    c"xrEnumerateReprojectionModesMSFT" enumerate_reprojection_modes: EnumerateReprojectionModesMSFT(
        instance: sys::Instance, system: sys::SystemId, kind: ViewConfigurationType, capacity: u32, count: *mut u32,
        modes: *mut sys::ReprojectionModeMSFT
    ) => views::enumerate_reprojection_modes;
    c"xrPollEvent" poll_event: PollEvent(instance: sys::Instance, event: *mut sys::EventDataBuffer)
        => views::poll_event;
    c"xrCreateSession" create_session: CreateSession(
        instance: sys::Instance, info: *const sys::SessionCreateInfo, created: *mut sys::Session
    ) => sessions::create;
    c"xrDestroySession" destroy_session: DestroySession(session: sys::Session) => sessions::destroy;
    c"xrBeginSession" begin_session: BeginSession(session: sys::Session, info: *const sys::SessionBeginInfo)
        => sessions::begin;
    c"xrEndSession" end_session: EndSession(session: sys::Session) => sessions::end;
    c"xrGetVisibilityMaskKHR" get_visibility_mask: GetVisibilityMaskKHR(
        session: sys::Session, kind: ViewConfigurationType, view: u32, mask_kind: sys::VisibilityMaskTypeKHR,
        mask: *mut sys::VisibilityMaskKHR
    ) => views::visibility_mask;
    c"xrGetRecommendedLayerResolutionMETA" get_recommended_layer_resolution: GetRecommendedLayerResolutionMETA(
        session: sys::Session, info: *const sys::RecommendedLayerResolutionGetInfoMETA,
        resolution: *mut sys::RecommendedLayerResolutionMETA
    ) => views::recommended_layer_resolution;
    c"xrLocateViews" locate_views: LocateViews(
        session: sys::Session, info: *const sys::ViewLocateInfo, state: *mut sys::ViewState, capacity: u32,
        count: *mut u32, views: *mut sys::View
    ) => views::locate;
    c"xrBeginFrame" begin_frame: BeginFrame(session: sys::Session, info: *const sys::FrameBeginInfo)
        => sessions::begin_frame;
    c"xrEndFrame" end_frame: EndFrame(session: sys::Session, info: *const sys::FrameEndInfo) => sessions::end_frame;
    c"xrCreateSwapchain" create_swapchain: CreateSwapchain(
        session: sys::Session, info: *const sys::SwapchainCreateInfo, created: *mut sys::Swapchain
    ) => swapchains::create;
    c"xrDestroySwapchain" destroy_swapchain: DestroySwapchain(swapchain: sys::Swapchain) => swapchains::destroy;
    c"xrAcquireSwapchainImage" acquire_swapchain_image: AcquireSwapchainImage(
        swapchain: sys::Swapchain, info: *const sys::SwapchainImageAcquireInfo, index: *mut u32
    ) => swapchains::acquire;
    c"xrWaitSwapchainImage" wait_swapchain_image: WaitSwapchainImage(
        swapchain: sys::Swapchain, info: *const sys::SwapchainImageWaitInfo
    ) => swapchains::wait;
    c"xrReleaseSwapchainImage" release_swapchain_image: ReleaseSwapchainImage(
        swapchain: sys::Swapchain, info: *const sys::SwapchainImageReleaseInfo
    ) => swapchains::release;
}

unsafe extern "system" fn get_instance_proc_addr(
    handle: sys::Instance,
    name: *const c_char,
    function: *mut Option<pfn::VoidFunction>,
) -> sys::Result {
    without_panic(|| {
        // SAFETY: the caller passes a place for a function, and a string.
        let place = unsafe { function.as_mut() }.filter(|_| !name.is_null());
        let function = place.ok_or(sys::Result::ERROR_VALIDATION_FAILURE)?;
        // SAFETY: as above.
        let name = unsafe { CStr::from_ptr(name) };
        *function = None;
        let instance = objects::instance(handle).ok_or(sys::Result::ERROR_HANDLE_INVALID)?;
        // SAFETY: a live instance, and the same string.
        let result =
            check(unsafe { (instance.next.get_instance_proc_addr)(handle, name.as_ptr(), function) })?;
        // The layer only returns functions that the next layer has for this instance.
        if let Some(own) = own_function(name, &instance) {
            *function = Some(own);
        }
        Ok(result)
    })
}

/// Returns the layer's function of a name, if it has one for this instance.
fn own_function(name: &CStr, instance: &Instance) -> Option<pfn::VoidFunction> {
    // SAFETY: the caller that asks for these names calls the functions as these types.
    unsafe {
        if name == c"xrGetInstanceProcAddr" {
            let function: pfn::GetInstanceProcAddr = get_instance_proc_addr;
            return Some(std::mem::transmute::<pfn::GetInstanceProcAddr, pfn::VoidFunction>(function));
        }
        if name == c"xrDestroyInstance" {
            let function: pfn::DestroyInstance = loader::destroy_instance;
            return Some(std::mem::transmute::<pfn::DestroyInstance, pfn::VoidFunction>(function));
        }
    }
    if instance.serves { intercepted(name) } else { None }
}
