//! The functions of the runtime, by name.

use std::ffi::{CStr, c_char};
use std::mem;

use openxr_sys as sys;
use sys::{Handle, pfn};

use crate::extension::SetAndroidApplicationThreadKHR;
use crate::world::{Array, DONE, enter, forbidden, given};
use crate::{action, extension, frame, instance, session, space, swapchain};

/// The C type of a parameter.
macro_rules! parameter {
    (: $type:ty) => { $type };
    (out $type:ty) => { *mut $type };
    ($in_or_text:tt $type:ty) => { *const $type };
}

/// Converts a C parameter to the argument of the Rust function.
macro_rules! argument {
    (: $name:ident) => {
        $name
    };
    (text $name:ident) => {{
        given($name.is_null(), stringify!($name))?;
        // SAFETY: applications pass null-terminated strings.
        unsafe { CStr::from_ptr($name) }
    }};
    (in $name:ident) => {{
        given($name.is_null(), stringify!($name))?;
        // SAFETY: applications pass complete structures.
        unsafe { &*$name }
    }};
    (out $name:ident) => {{
        given($name.is_null(), stringify!($name))?;
        // SAFETY: applications pass structures and writable places.
        unsafe { &mut *$name }
    }};
}

/// Defines a C function for each line: the name without `xr`, the Rust function, its parameters (values, structures
/// that are read or written, texts) and, after a semicolon, an array that is returned by capacity and count. The
/// extension that the function needs comes after the parentheses.
macro_rules! table {
    ($($call:ident = $module:ident::$function:ident(
        $($parameter:ident $how:tt $type:ty),* $(; $array:ident: $item:ty)?
    ) $(, $extension:literal)?;)*) => {
        /// Returns a function by its name, and the extension that it needs.
        fn find(name: &str) -> Option<(pfn::VoidFunction, Option<&'static str>)> {
            use sys::{pfn::*, *};
            $(if name == concat!("xr", stringify!($call)) {
                unsafe extern "system" fn call(
                    $($parameter: parameter!($how $type),)*
                    $(capacity: u32, count: *mut u32, $array: *mut $item,)?
                ) -> sys::Result {
                    enter(concat!("xr", stringify!($call)), |world| {
                        // SAFETY: applications pass room for as many elements as they state.
                        $(let $array = unsafe { Array::<$item>::new(capacity, count, $array) };)?
                        $module::$function(world, $(argument!($how $parameter),)* $($array)?)
                    })
                }
                let function: $call = call;
                // SAFETY: callers use the type that belongs to the function's name.
                let function = unsafe { mem::transmute::<$call, VoidFunction>(function) };
                return Some((function, None$(.or(Some($extension)))?));
            })*
            if NOT_CALLED.contains(&name) {
                // SAFETY: the caller cleans up the stack, so parameters may be ignored.
                let function = unsafe { mem::transmute::<extern "system" fn() -> Result, VoidFunction>(not_called) };
                return Some((function, None));
            }
            if name == "xrGetInstanceProcAddr" {
                let function: GetInstanceProcAddr = get_instance_proc_addr;
                // SAFETY: as above.
                return Some((unsafe { mem::transmute::<GetInstanceProcAddr, VoidFunction>(function) }, None));
            }
            None
        }
    };
}

table! {
    EnumerateInstanceExtensionProperties = instance::enumerate_instance_extension_properties(
        layer: *const c_char; properties: ExtensionProperties
    );
    EnumerateApiLayerProperties = instance::enumerate_api_layer_properties(
        unused: u32, count out u32, unused1: *mut ApiLayerProperties
    );
    InitializeLoaderKHR = instance::initialize_loader(info in LoaderInitInfoBaseHeaderKHR);
    CreateInstance = instance::create_instance(info in InstanceCreateInfo, result out Instance);
    DestroyInstance = instance::destroy_instance(instance: Instance);
    GetInstanceProperties = instance::get_instance_properties(
        instance: Instance, properties out InstanceProperties
    );
    GetSystem = instance::get_system(instance: Instance, info in SystemGetInfo, result out SystemId);
    GetSystemProperties = instance::get_system_properties(
        instance: Instance, system: SystemId, properties out SystemProperties
    );
    PollEvent = instance::poll_event(instance: Instance, buffer out EventDataBuffer);
    StringToPath = instance::string_to_path(instance: Instance, string text c_char, path out Path);
    CreateSession = session::create_session(instance: Instance, info in SessionCreateInfo, result out Session);
    DestroySession = session::destroy_session(session: Session);
    BeginSession = session::begin_session(session: Session, info in SessionBeginInfo);
    EndSession = session::end_session(session: Session);
    RequestExitSession = session::request_exit_session(session: Session);
    EnumerateViewConfigurations = session::enumerate_view_configurations(
        instance: Instance, system: SystemId; types: ViewConfigurationType
    );
    EnumerateViewConfigurationViews = session::enumerate_view_configuration_views(
        instance: Instance, system: SystemId, configuration: ViewConfigurationType;
        views: ViewConfigurationView
    );
    EnumerateEnvironmentBlendModes = session::enumerate_environment_blend_modes(
        instance: Instance, system: SystemId, configuration: ViewConfigurationType;
        modes: EnvironmentBlendMode
    );
    CreateReferenceSpace = space::create_reference_space(
        session: Session, info in ReferenceSpaceCreateInfo, result out Space
    );
    CreateActionSpace = space::create_action_space(
        session: Session, info in ActionSpaceCreateInfo, result out Space
    );
    LocateSpace = space::locate_space(space: Space, base: Space, time: Time, result out SpaceLocation);
    DestroySpace = space::destroy_space(space: Space);
    EnumerateSwapchainFormats = swapchain::enumerate_swapchain_formats(session: Session; formats: i64);
    CreateSwapchain = swapchain::create_swapchain(
        session: Session, info in SwapchainCreateInfo, result out Swapchain
    );
    DestroySwapchain = swapchain::destroy_swapchain(swapchain: Swapchain);
    EnumerateSwapchainImages = swapchain::enumerate_swapchain_images(
        swapchain: Swapchain; images: SwapchainImageBaseHeader
    );
    AcquireSwapchainImage = swapchain::acquire_swapchain_image(
        swapchain: Swapchain, unused: *const SwapchainImageAcquireInfo, index out u32
    );
    WaitSwapchainImage = swapchain::wait_swapchain_image(
        swapchain: Swapchain, unused: *const SwapchainImageWaitInfo
    );
    ReleaseSwapchainImage = swapchain::release_swapchain_image(
        swapchain: Swapchain, unused: *const SwapchainImageReleaseInfo
    );
    WaitFrame = frame::wait_frame(session: Session, unused: *const FrameWaitInfo, result out FrameState);
    BeginFrame = frame::begin_frame(session: Session, unused: *const FrameBeginInfo);
    LocateViews = frame::locate_views(
        session: Session, info in ViewLocateInfo, state out ViewState; list: View
    );
    EndFrame = frame::end_frame(session: Session, info in FrameEndInfo);
    CreateActionSet = action::create_action_set(
        instance: Instance, info in ActionSetCreateInfo, result out ActionSet
    );
    DestroyActionSet = action::destroy_action_set(set: ActionSet);
    CreateAction = action::create_action(set: ActionSet, info in ActionCreateInfo, result out Action);
    DestroyAction = action::destroy_action(action: Action);
    SuggestInteractionProfileBindings = action::suggest_bindings(
        instance: Instance, suggested in InteractionProfileSuggestedBinding
    );
    AttachSessionActionSets = action::attach_action_sets(
        session: Session, info in SessionActionSetsAttachInfo
    );
    SyncActions = action::sync_actions(session: Session, info in ActionsSyncInfo);
    GetActionStateBoolean = action::get_action_state_boolean(
        session: Session, info in ActionStateGetInfo, result out ActionStateBoolean
    );
    GetActionStateVector2f = action::get_action_state_vector2f(
        session: Session, info in ActionStateGetInfo, result out ActionStateVector2f
    );
    GetOpenGLESGraphicsRequirementsKHR = session::get_graphics_requirements(
        instance: Instance, system: SystemId, requirements out GraphicsRequirementsOpenGLESKHR
    ), "XR_KHR_opengl_es_enable";
    GetVulkanGraphicsRequirementsKHR = session::get_vulkan_graphics_requirements(
        instance: Instance, system: SystemId, requirements out GraphicsRequirementsVulkanKHR
    ), "XR_KHR_vulkan_enable";
    GetVulkanGraphicsRequirements2KHR = session::get_vulkan_graphics_requirements(
        instance: Instance, system: SystemId, requirements out GraphicsRequirementsVulkanKHR
    ), "XR_KHR_vulkan_enable2";
    EnumerateDisplayRefreshRatesFB = extension::enumerate_display_refresh_rates(
        session: Session; rates: f32
    ), "XR_FB_display_refresh_rate";
    RequestDisplayRefreshRateFB = extension::request_display_refresh_rate(
        session: Session, rate: f32
    ), "XR_FB_display_refresh_rate";
    PerfSettingsSetPerformanceLevelEXT = extension::set_performance_level(
        session: Session, domain: PerfSettingsDomainEXT, level: PerfSettingsLevelEXT
    ), "XR_EXT_performance_settings";
    GetVisibilityMaskKHR = extension::get_visibility_mask(
        session: Session, configuration: ViewConfigurationType, view: u32, kind: VisibilityMaskTypeKHR,
        mask out VisibilityMaskKHR
    ), "XR_KHR_visibility_mask";
    EnumerateReprojectionModesMSFT = extension::enumerate_reprojection_modes(
        instance: Instance, system: SystemId, configuration: ViewConfigurationType;
        modes: ReprojectionModeMSFT
    ), "XR_MSFT_composition_layer_reprojection";
    GetRecommendedLayerResolutionMETA = extension::get_recommended_layer_resolution(
        session: Session, info in RecommendedLayerResolutionGetInfoMETA,
        resolution out RecommendedLayerResolutionMETA
    ), "XR_META_recommended_layer_resolution";
    CreateFoveationProfileFB = extension::create_foveation_profile(
        session: Session, info in FoveationProfileCreateInfoFB, result out FoveationProfileFB
    ), "XR_FB_foveation";
    DestroyFoveationProfileFB = extension::destroy_foveation_profile(profile: FoveationProfileFB), "XR_FB_foveation";
    UpdateSwapchainFB = extension::update_swapchain(
        swapchain: Swapchain, state in SwapchainStateBaseHeaderFB
    ), "XR_FB_swapchain_update_state";
    SetAndroidApplicationThreadKHR = extension::set_android_application_thread(
        session: Session, kind: AndroidThreadTypeKHR, thread: u32
    ), "XR_KHR_android_thread_settings";
}

/// Functions that loaders ask for, but that no application under test calls.
const NOT_CALLED: [&str; 15] = [
    "xrGetActionStateFloat",
    "xrGetActionStatePose",
    "xrGetCurrentInteractionProfile",
    "xrEnumerateBoundSourcesForAction",
    "xrGetInputSourceLocalizedName",
    "xrApplyHapticFeedback",
    "xrStopHapticFeedback",
    "xrResultToString",
    "xrStructureTypeToString",
    "xrPathToString",
    "xrGetViewConfigurationProperties",
    "xrEnumerateReferenceSpaces",
    "xrGetReferenceSpaceBoundsRect",
    "xrGetDisplayRefreshRateFB",
    "xrGetSwapchainStateFB",
];

extern "system" fn not_called() -> sys::Result {
    enter("a function of NOT_CALLED", |_| {
        Err(forbidden(
            sys::Result::ERROR_FUNCTION_UNSUPPORTED,
            "the simulated runtime does not have this function",
        ))
    })
}

/// The functions that can be obtained without an instance.
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
    enter("xrGetInstanceProcAddr", |world| {
        let (name, out) = (argument!(text name), argument!(out out));
        let name = name.to_string_lossy().into_owned();
        *out = None;
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
            && !world.any_instance(instance)?.has(extension)
        {
            return Err(forbidden(
                sys::Result::ERROR_FUNCTION_UNSUPPORTED,
                format!("{name} without {extension}"),
            ));
        }
        *out = Some(function);
        DONE
    })
}
