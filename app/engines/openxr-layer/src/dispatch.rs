//! The functions of the next layer or the runtime, in one table per instance.

use std::ffi::CStr;

use openxr_sys as sys;
use sys::pfn;

/// The result of a call, with failures as errors.
pub type XrResult<T> = Result<T, sys::Result>;

/// Returns an error for results below zero, as XR_FAILED does.
pub fn check(result: sys::Result) -> XrResult<sys::Result> {
    if result.into_raw() < 0 { Err(result) } else { Ok(result) }
}

macro_rules! table {
    ($($field:ident: $function:ident = $name:literal $(or $missing:path)?,)*) => {
        /// The functions that the layer calls or intercepts.
        pub struct Dispatch {
            /// The function that finds all others.
            pub get_instance_proc_addr: pfn::GetInstanceProcAddr,
            $(pub $field: pfn::$function,)*
        }

        impl Dispatch {
            /// Looks up all functions.
            ///
            /// # Errors
            /// The runtime's error, or ERROR_FUNCTION_UNSUPPORTED if a core function is missing.
            ///
            /// # Safety
            /// `next` is the xrGetInstanceProcAddr for this live instance.
            pub unsafe fn new(next: pfn::GetInstanceProcAddr, instance: sys::Instance) -> XrResult<Dispatch> {
                let find = |name: &CStr| {
                    let mut function = None;
                    // SAFETY: a live instance, and a null-terminated name.
                    check(unsafe { next(instance, name.as_ptr(), &mut function) })?;
                    function.ok_or(sys::Result::ERROR_FUNCTION_UNSUPPORTED)
                };
                Ok(Dispatch {
                    get_instance_proc_addr: next,
                    $($field: {
                        let found = find($name).map(|function| {
                            // SAFETY: a function of this name has this type.
                            unsafe { std::mem::transmute::<pfn::VoidFunction, pfn::$function>(function) }
                        });
                        $(let found = found.or(Ok($missing));)?
                        found?
                    },)*
                })
            }
        }
    };
}

impl Dispatch {
    /// Returns all images of a swapchain.
    ///
    /// # Errors
    /// The result of xrEnumerateSwapchainImages.
    ///
    /// # Safety
    /// The swapchain is live, and `empty` is the image structure for its session.
    pub unsafe fn swapchain_images<T: Copy>(&self, swapchain: sys::Swapchain, empty: T) -> XrResult<Vec<T>> {
        let enumerate = self.enumerate_swapchain_images;
        let mut count = 0;
        // SAFETY: a live swapchain. With a capacity of 0 the runtime writes only the count.
        check(unsafe { enumerate(swapchain, 0, &mut count, std::ptr::null_mut()) })?;
        let mut images = vec![empty; count as usize];
        // SAFETY: a live swapchain, and room for `count` structures of its kind.
        check(unsafe { enumerate(swapchain, count, &mut count, images.as_mut_ptr().cast()) })?;
        Ok(images)
    }
}

/// Stands for xrGetVisibilityMaskKHR if the extension is not enabled.
unsafe extern "system" fn no_visibility_mask(
    _: sys::Session,
    _: sys::ViewConfigurationType,
    _: u32,
    _: sys::VisibilityMaskTypeKHR,
    _: *mut sys::VisibilityMaskKHR,
) -> sys::Result {
    sys::Result::ERROR_FUNCTION_UNSUPPORTED
}

/// Stands for xrEnumerateReprojectionModesMSFT if the extension is not enabled.
unsafe extern "system" fn no_reprojection_modes(
    _: sys::Instance,
    _: sys::SystemId,
    _: sys::ViewConfigurationType,
    _: u32,
    _: *mut u32,
    _: *mut sys::ReprojectionModeMSFT,
) -> sys::Result {
    sys::Result::ERROR_FUNCTION_UNSUPPORTED
}

/// Stands for xrGetRecommendedLayerResolutionMETA if the extension is not enabled.
unsafe extern "system" fn no_recommended_layer_resolution(
    _: sys::Session,
    _: *const sys::RecommendedLayerResolutionGetInfoMETA,
    _: *mut sys::RecommendedLayerResolutionMETA,
) -> sys::Result {
    sys::Result::ERROR_FUNCTION_UNSUPPORTED
}

table! {
    get_instance_properties: GetInstanceProperties = c"xrGetInstanceProperties",
    get_system_properties: GetSystemProperties = c"xrGetSystemProperties",
    poll_event: PollEvent = c"xrPollEvent",
    destroy_instance: DestroyInstance = c"xrDestroyInstance",
    create_session: CreateSession = c"xrCreateSession",
    destroy_session: DestroySession = c"xrDestroySession",
    begin_session: BeginSession = c"xrBeginSession",
    end_session: EndSession = c"xrEndSession",
    enumerate_view_configurations: EnumerateViewConfigurations = c"xrEnumerateViewConfigurations",
    get_view_configuration_properties: GetViewConfigurationProperties = c"xrGetViewConfigurationProperties",
    enumerate_view_configuration_views: EnumerateViewConfigurationViews = c"xrEnumerateViewConfigurationViews",
    enumerate_environment_blend_modes: EnumerateEnvironmentBlendModes = c"xrEnumerateEnvironmentBlendModes",
    locate_views: LocateViews = c"xrLocateViews",
    begin_frame: BeginFrame = c"xrBeginFrame",
    end_frame: EndFrame = c"xrEndFrame",
    create_swapchain: CreateSwapchain = c"xrCreateSwapchain",
    destroy_swapchain: DestroySwapchain = c"xrDestroySwapchain",
    enumerate_swapchain_images: EnumerateSwapchainImages = c"xrEnumerateSwapchainImages",
    acquire_swapchain_image: AcquireSwapchainImage = c"xrAcquireSwapchainImage",
    wait_swapchain_image: WaitSwapchainImage = c"xrWaitSwapchainImage",
    release_swapchain_image: ReleaseSwapchainImage = c"xrReleaseSwapchainImage",
    get_visibility_mask: GetVisibilityMaskKHR = c"xrGetVisibilityMaskKHR" or no_visibility_mask,
    enumerate_reprojection_modes: EnumerateReprojectionModesMSFT = c"xrEnumerateReprojectionModesMSFT"
        or no_reprojection_modes,
    get_recommended_layer_resolution: GetRecommendedLayerResolutionMETA = c"xrGetRecommendedLayerResolutionMETA"
        or no_recommended_layer_resolution,
}
