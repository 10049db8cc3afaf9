//! The functions of the next layer or of the runtime, one table for each instance.

use std::ffi::CStr;

use openxr_sys as sys;
use sys::pfn;

/// The result of a call that returns nothing else.
pub type XrResult<T> = Result<T, sys::Result>;

/// `Err` for what is below zero: XR_FAILED.
pub fn check(result: sys::Result) -> XrResult<sys::Result> {
    if result.into_raw() < 0 { Err(result) } else { Ok(result) }
}

macro_rules! table {
    (required { $($field:ident: $function:ident = $name:literal,)* }
     optional { $($optional:ident: $optional_function:ident = $optional_name:literal,)* }) => {
        /// All that the layer calls or answers in place of.
        pub struct Dispatch {
            /// For everything else.
            pub get_instance_proc_addr: pfn::GetInstanceProcAddr,
            $(#[doc = $name] pub $field: pfn::$function,)*
            $(#[doc = $optional_name] pub $optional: Option<pfn::$optional_function>,)*
        }

        impl Dispatch {
            /// Asks for all of them.
            ///
            /// # Errors
            /// ERROR_FUNCTION_UNSUPPORTED and what the runtime says, when a function of the core is missing.
            ///
            /// # Safety
            /// The function answers for this instance, which is live.
            pub unsafe fn new(next: pfn::GetInstanceProcAddr, instance: sys::Instance) -> XrResult<Dispatch> {
                let find = |name: &CStr| {
                    let mut function = None;
                    // SAFETY: promised by the caller.
                    check(unsafe { next(instance, name.as_ptr(), &mut function) })?;
                    function.ok_or(sys::Result::ERROR_FUNCTION_UNSUPPORTED)
                };
                Ok(Dispatch {
                    get_instance_proc_addr: next,
                    $($field: {
                        let function = find(name($name))?;
                        // SAFETY: a function of this name has this type.
                        unsafe { std::mem::transmute::<pfn::VoidFunction, pfn::$function>(function) }
                    },)*
                    $($optional: find(name($optional_name)).ok().map(|function| {
                        // SAFETY: a function of this name has this type.
                        unsafe { std::mem::transmute::<pfn::VoidFunction, pfn::$optional_function>(function) }
                    }),)*
                })
            }
        }
    };
}

impl Dispatch {
    /// All images of a swapchain.
    ///
    /// # Errors
    /// What xrEnumerateSwapchainImages returns.
    ///
    /// # Safety
    /// The swapchain is live, and `empty` is the structure for images of its session.
    pub unsafe fn swapchain_images<T: Copy>(&self, swapchain: sys::Swapchain, empty: T) -> XrResult<Vec<T>> {
        let enumerate = self.enumerate_swapchain_images;
        let mut count = 0;
        // SAFETY: promised by the caller; without room only the number is told.
        check(unsafe { enumerate(swapchain, 0, &mut count, std::ptr::null_mut()) })?;
        let mut images = vec![empty; count as usize];
        // SAFETY: promised by the caller, and room for as many as is said.
        check(unsafe { enumerate(swapchain, count, &mut count, images.as_mut_ptr().cast()) })?;
        Ok(images)
    }
}

/// A literal of the table as C has it.
const fn name(with_nul: &str) -> &CStr {
    match CStr::from_bytes_with_nul(with_nul.as_bytes()) {
        Ok(name) => name,
        Err(_) => panic!("the table's names end with a zero"),
    }
}

table! {
    required {
        destroy_instance: DestroyInstance = "xrDestroyInstance\0",
        create_session: CreateSession = "xrCreateSession\0",
        destroy_session: DestroySession = "xrDestroySession\0",
        begin_session: BeginSession = "xrBeginSession\0",
        create_reference_space: CreateReferenceSpace = "xrCreateReferenceSpace\0",
        destroy_space: DestroySpace = "xrDestroySpace\0",
        locate_space: LocateSpace = "xrLocateSpace\0",
        enumerate_view_configurations: EnumerateViewConfigurations = "xrEnumerateViewConfigurations\0",
        get_view_configuration_properties: GetViewConfigurationProperties = "xrGetViewConfigurationProperties\0",
        enumerate_view_configuration_views: EnumerateViewConfigurationViews = "xrEnumerateViewConfigurationViews\0",
        enumerate_environment_blend_modes: EnumerateEnvironmentBlendModes = "xrEnumerateEnvironmentBlendModes\0",
        locate_views: LocateViews = "xrLocateViews\0",
        begin_frame: BeginFrame = "xrBeginFrame\0",
        end_frame: EndFrame = "xrEndFrame\0",
        create_swapchain: CreateSwapchain = "xrCreateSwapchain\0",
        destroy_swapchain: DestroySwapchain = "xrDestroySwapchain\0",
        enumerate_swapchain_images: EnumerateSwapchainImages = "xrEnumerateSwapchainImages\0",
        acquire_swapchain_image: AcquireSwapchainImage = "xrAcquireSwapchainImage\0",
        wait_swapchain_image: WaitSwapchainImage = "xrWaitSwapchainImage\0",
        release_swapchain_image: ReleaseSwapchainImage = "xrReleaseSwapchainImage\0",
    }
    optional {
        get_visibility_mask: GetVisibilityMaskKHR = "xrGetVisibilityMaskKHR\0",
    }
}
