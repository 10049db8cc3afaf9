//! Which functions there are.

use std::ffi::{CStr, c_char};
use std::mem;

use openxr_sys as sys;
use sys::{Handle, pfn};

use crate::world::{DONE, enter, forbidden};
use crate::{action, extension, frame, instance, session, space, swapchain};

/// A function by its name, and the extension that it needs.
fn find(name: &str) -> Option<(pfn::VoidFunction, Option<&'static str>)> {
    use extension::SetAndroidApplicationThreadKHR;
    use pfn::*;

    macro_rules! table {
        ($($name:literal $type:ident $function:path $(, $extension:literal)?;)*) => {
            match name {
                $($name => {
                    let function: $type = $function;
                    // SAFETY: functions are called by the type that belongs to their name.
                    let function = unsafe { mem::transmute::<$type, VoidFunction>(function) };
                    #[allow(unused_mut, unused_assignments)]
                    let mut extension = None;
                    $(extension = Some($extension);)?
                    Some((function, extension))
                })*
                _ => None,
            }
        };
    }
    table! {
        "xrGetInstanceProcAddr" GetInstanceProcAddr get_instance_proc_addr;
        "xrEnumerateInstanceExtensionProperties" EnumerateInstanceExtensionProperties
            instance::enumerate_instance_extension_properties;
        "xrEnumerateApiLayerProperties" EnumerateApiLayerProperties instance::enumerate_api_layer_properties;
        "xrInitializeLoaderKHR" InitializeLoaderKHR instance::initialize_loader;
        "xrCreateInstance" CreateInstance instance::create_instance;
        "xrDestroyInstance" DestroyInstance instance::destroy_instance;
        "xrGetInstanceProperties" GetInstanceProperties instance::get_instance_properties;
        "xrResultToString" ResultToString instance::result_to_string;
        "xrStructureTypeToString" StructureTypeToString instance::structure_type_to_string;
        "xrGetSystem" GetSystem instance::get_system;
        "xrGetSystemProperties" GetSystemProperties instance::get_system_properties;
        "xrPollEvent" PollEvent instance::poll_event;
        "xrStringToPath" StringToPath instance::string_to_path;
        "xrPathToString" PathToString instance::path_to_string;
        "xrCreateSession" CreateSession session::create_session;
        "xrDestroySession" DestroySession session::destroy_session;
        "xrBeginSession" BeginSession session::begin_session;
        "xrEndSession" EndSession session::end_session;
        "xrRequestExitSession" RequestExitSession session::request_exit_session;
        "xrEnumerateViewConfigurations" EnumerateViewConfigurations session::enumerate_view_configurations;
        "xrGetViewConfigurationProperties" GetViewConfigurationProperties
            session::get_view_configuration_properties;
        "xrEnumerateViewConfigurationViews" EnumerateViewConfigurationViews
            session::enumerate_view_configuration_views;
        "xrEnumerateEnvironmentBlendModes" EnumerateEnvironmentBlendModes
            session::enumerate_environment_blend_modes;
        "xrEnumerateReferenceSpaces" EnumerateReferenceSpaces space::enumerate_reference_spaces;
        "xrCreateReferenceSpace" CreateReferenceSpace space::create_reference_space;
        "xrCreateActionSpace" CreateActionSpace space::create_action_space;
        "xrLocateSpace" LocateSpace space::locate_space;
        "xrDestroySpace" DestroySpace space::destroy_space;
        "xrGetReferenceSpaceBoundsRect" GetReferenceSpaceBoundsRect space::get_reference_space_bounds_rect;
        "xrEnumerateSwapchainFormats" EnumerateSwapchainFormats swapchain::enumerate_swapchain_formats;
        "xrCreateSwapchain" CreateSwapchain swapchain::create_swapchain;
        "xrDestroySwapchain" DestroySwapchain swapchain::destroy_swapchain;
        "xrEnumerateSwapchainImages" EnumerateSwapchainImages swapchain::enumerate_swapchain_images;
        "xrAcquireSwapchainImage" AcquireSwapchainImage swapchain::acquire_swapchain_image;
        "xrWaitSwapchainImage" WaitSwapchainImage swapchain::wait_swapchain_image;
        "xrReleaseSwapchainImage" ReleaseSwapchainImage swapchain::release_swapchain_image;
        "xrWaitFrame" WaitFrame frame::wait_frame;
        "xrBeginFrame" BeginFrame frame::begin_frame;
        "xrLocateViews" LocateViews frame::locate_views;
        "xrEndFrame" EndFrame frame::end_frame;
        "xrCreateActionSet" CreateActionSet action::create_action_set;
        "xrDestroyActionSet" DestroyActionSet action::destroy_action_set;
        "xrCreateAction" CreateAction action::create_action;
        "xrDestroyAction" DestroyAction action::destroy_action;
        "xrSuggestInteractionProfileBindings" SuggestInteractionProfileBindings action::suggest_bindings;
        "xrAttachSessionActionSets" AttachSessionActionSets action::attach_action_sets;
        "xrGetCurrentInteractionProfile" GetCurrentInteractionProfile
            action::get_current_interaction_profile;
        "xrSyncActions" SyncActions action::sync_actions;
        "xrGetActionStateBoolean" GetActionStateBoolean action::get_action_state_boolean;
        "xrGetActionStateFloat" GetActionStateFloat action::get_action_state_float;
        "xrGetActionStateVector2f" GetActionStateVector2f action::get_action_state_vector2f;
        "xrGetActionStatePose" GetActionStatePose action::get_action_state_pose;
        "xrEnumerateBoundSourcesForAction" EnumerateBoundSourcesForAction action::enumerate_bound_sources;
        "xrGetInputSourceLocalizedName" GetInputSourceLocalizedName action::get_input_source_localized_name;
        "xrApplyHapticFeedback" ApplyHapticFeedback action::apply_haptic_feedback;
        "xrStopHapticFeedback" StopHapticFeedback action::stop_haptic_feedback;
        "xrGetOpenGLESGraphicsRequirementsKHR" GetOpenGLESGraphicsRequirementsKHR
            session::get_graphics_requirements, "XR_KHR_opengl_es_enable";
        "xrGetVulkanGraphicsRequirementsKHR" GetVulkanGraphicsRequirementsKHR
            session::get_vulkan_graphics_requirements, "XR_KHR_vulkan_enable";
        "xrGetVulkanGraphicsRequirements2KHR" GetVulkanGraphicsRequirements2KHR
            session::get_vulkan_graphics_requirements, "XR_KHR_vulkan_enable2";
        "xrEnumerateDisplayRefreshRatesFB" EnumerateDisplayRefreshRatesFB
            extension::enumerate_display_refresh_rates, "XR_FB_display_refresh_rate";
        "xrGetDisplayRefreshRateFB" GetDisplayRefreshRateFB
            extension::get_display_refresh_rate, "XR_FB_display_refresh_rate";
        "xrRequestDisplayRefreshRateFB" RequestDisplayRefreshRateFB
            extension::request_display_refresh_rate, "XR_FB_display_refresh_rate";
        "xrPerfSettingsSetPerformanceLevelEXT" PerfSettingsSetPerformanceLevelEXT
            extension::set_performance_level, "XR_EXT_performance_settings";
        "xrGetVisibilityMaskKHR" GetVisibilityMaskKHR extension::get_visibility_mask, "XR_KHR_visibility_mask";
        "xrSetAndroidApplicationThreadKHR" SetAndroidApplicationThreadKHR
            extension::set_android_application_thread, "XR_KHR_android_thread_settings";
    }
}

/// Without an instance only these are there.
const BEFORE_INSTANCE: [&str; 5] = [
    "xrGetInstanceProcAddr",
    "xrEnumerateInstanceExtensionProperties",
    "xrEnumerateApiLayerProperties",
    "xrCreateInstance",
    "xrInitializeLoaderKHR",
];

pub unsafe extern "system" fn get_instance_proc_addr(
    instance: sys::Instance,
    name: *const c_char,
    out: *mut Option<pfn::VoidFunction>,
) -> sys::Result {
    // SAFETY: as the caller says.
    let name = unsafe { CStr::from_ptr(name) }.to_string_lossy().into_owned();
    enter("xrGetInstanceProcAddr", |world| {
        // SAFETY: as the caller says.
        unsafe { *out = None };
        let early = BEFORE_INSTANCE.contains(&name.as_str());
        if instance == sys::Instance::NULL && !early {
            return Err(sys::Result::ERROR_HANDLE_INVALID.into());
        }
        if instance != sys::Instance::NULL {
            world.any_instance(instance)?;
            if early && world.script.no_globals {
                return DONE;
            }
        }
        let (function, extension) = find(&name).ok_or(sys::Result::ERROR_FUNCTION_UNSUPPORTED)?;
        if let Some(extension) = extension
            && !world.any_instance(instance)?.extensions.iter().any(|enabled| enabled == extension)
        {
            return Err(forbidden(
                sys::Result::ERROR_FUNCTION_UNSUPPORTED,
                format!("{name} without {extension}"),
            ));
        }
        // SAFETY: as the caller says.
        unsafe { *out = Some(function) };
        DONE
    })
}
