//! An OpenXR API layer that observes another layer from below, for tests of applications on Vulkan.
//!
//! * It recommends the size in YORO_MEASURED_SIZE (`1680x1760`) for every view.
//! * When the session ends, it writes the median frame time to standard error. A frame is measured from the return of
//!   xrWaitFrame until the application's queue is idle after xrEndFrame, so the wait for the display is not included.
//! * It writes pictures of one frame to the folder in YORO_MEASURED_PICTURES.
//! * With an XrTime in nanoseconds in YORO_MEASURED_TIME the world stands still, so that pictures of two runs can be
//!   compared: all views and spaces are located at that time, and LOCAL spaces become STAGE spaces, whose origin does
//!   not depend on when the session begins.

mod pictures;

use std::ffi::{CStr, c_char};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use ash::vk;
use ash::vk::Handle as _;
use openxr_sys as sys;
use sys::{Handle as _, pfn};

use pictures::Pictures;

/// The number of first frames that do not count, because they create what later ones use.
const FIRST: usize = 5;

/// The device that a session is bound to.
struct Device {
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: ash::Device,
    queue_family: u32,
    queue: vk::Queue,
}

/// What is observed of a session.
struct Observed {
    device: Device,
    start: Instant,
    times: Vec<Duration>,
    pictures: Option<Pictures>,
}

static NEXT: OnceLock<Next> = OnceLock::new();
static OBSERVED: Mutex<Option<Observed>> = Mutex::new(None);

fn observed() -> MutexGuard<'static, Option<Observed>> {
    OBSERVED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Defines a table of the runtime's functions, and a lookup of this layer's own. One instance per process is observed.
macro_rules! intercept {
    ($($field:ident: $kind:ident = $name:literal,)*) => {
        struct Next {
            get_instance_proc_addr: pfn::GetInstanceProcAddr,
            enumerate_swapchain_images: pfn::EnumerateSwapchainImages,
            $($field: pfn::$kind,)*
        }

        impl Next {
            /// Finds all functions.
            ///
            /// # Safety
            /// `get` is the next xrGetInstanceProcAddr for this live instance.
            unsafe fn new(get: pfn::GetInstanceProcAddr, instance: sys::Instance) -> Option<Next> {
                let find = |name: &CStr| {
                    let mut function = None;
                    // SAFETY: a live instance, and a null-terminated name.
                    unsafe { get(instance, name.as_ptr(), &mut function) };
                    function
                };
                // SAFETY: functions of these names have these types.
                unsafe {
                    let images = find(c"xrEnumerateSwapchainImages")?;
                    Some(Next {
                        get_instance_proc_addr: get,
                        enumerate_swapchain_images: std::mem::transmute::<
                            pfn::VoidFunction,
                            pfn::EnumerateSwapchainImages,
                        >(images),
                        $($field: std::mem::transmute::<pfn::VoidFunction, pfn::$kind>(find($name)?),)*
                    })
                }
            }
        }

        /// Returns this layer's function of a name.
        fn own(name: &CStr) -> Option<pfn::VoidFunction> {
            $(if name == $name {
                let function: pfn::$kind = $field;
                // SAFETY: the caller that asks for this name calls the function as this type.
                return Some(unsafe { std::mem::transmute::<pfn::$kind, pfn::VoidFunction>(function) });
            })*
            None
        }
    };
}

intercept! {
    enumerate_view_configuration_views: EnumerateViewConfigurationViews = c"xrEnumerateViewConfigurationViews",
    create_session: CreateSession = c"xrCreateSession",
    destroy_session: DestroySession = c"xrDestroySession",
    create_reference_space: CreateReferenceSpace = c"xrCreateReferenceSpace",
    locate_space: LocateSpace = c"xrLocateSpace",
    locate_views: LocateViews = c"xrLocateViews",
    create_swapchain: CreateSwapchain = c"xrCreateSwapchain",
    acquire_swapchain_image: AcquireSwapchainImage = c"xrAcquireSwapchainImage",
    release_swapchain_image: ReleaseSwapchainImage = c"xrReleaseSwapchainImage",
    wait_frame: WaitFrame = c"xrWaitFrame",
    end_frame: EndFrame = c"xrEndFrame",
}

/// Negotiates the interface. It is the first function that a loader calls.
///
/// # Safety
/// `request` points to a complete structure.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn xrNegotiateLoaderApiLayerInterface(
    _: *const sys::NegotiateLoaderInfo,
    _: *const c_char,
    request: *mut sys::NegotiateApiLayerRequest,
) -> sys::Result {
    // SAFETY: the loader's structure.
    let request = unsafe { &mut *request };
    request.layer_interface_version = sys::CURRENT_LOADER_API_LAYER_VERSION as u32;
    request.layer_api_version = sys::CURRENT_API_VERSION;
    request.get_instance_proc_addr = Some(get_instance_proc_addr);
    request.create_api_layer_instance = Some(create_instance);
    sys::Result::SUCCESS
}

unsafe extern "system" fn create_instance(
    info: *const sys::InstanceCreateInfo,
    layer: *const sys::ApiLayerCreateInfo,
    instance: *mut sys::Instance,
) -> sys::Result {
    // SAFETY: the loader's structures.
    unsafe {
        let failed = sys::Result::ERROR_INITIALIZATION_FAILED;
        let Some(own) = (*layer).next_info.as_ref() else { return failed };
        let functions = own.next_create_api_layer_instance.zip(own.next_get_instance_proc_addr);
        let Some((create, get)) = functions else { return failed };
        let below = sys::ApiLayerCreateInfo { next_info: own.next, ..*layer };
        let result = create(info, &below, instance);
        if result.into_raw() < 0 {
            return result;
        }
        let Some(next) = Next::new(get, *instance) else { return failed };
        NEXT.get_or_init(|| next);
        result
    }
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: sys::Instance,
    name: *const c_char,
    function: *mut Option<pfn::VoidFunction>,
) -> sys::Result {
    let Some(next) = NEXT.get().filter(|_| instance != sys::Instance::NULL) else {
        return sys::Result::ERROR_HANDLE_INVALID;
    };
    // SAFETY: the caller's name and place.
    unsafe {
        let Some(own) = own(CStr::from_ptr(name)) else {
            return (next.get_instance_proc_addr)(instance, name, function);
        };
        *function = Some(own);
    }
    sys::Result::SUCCESS
}

fn next() -> &'static Next {
    NEXT.get().expect("the instance exists")
}

fn size() -> Option<[u32; 2]> {
    let text = std::env::var("YORO_MEASURED_SIZE").ok()?;
    let (width, height) = text.split_once('x')?;
    Some([width.parse().ok()?, height.parse().ok()?])
}

/// Returns the time at which the world stands still, if it does.
fn still() -> Option<sys::Time> {
    let text = std::env::var("YORO_MEASURED_TIME").ok()?;
    Some(sys::Time::from_nanos(text.parse().ok()?))
}

unsafe extern "system" fn enumerate_view_configuration_views(
    instance: sys::Instance,
    system: sys::SystemId,
    kind: sys::ViewConfigurationType,
    capacity: u32,
    count: *mut u32,
    views: *mut sys::ViewConfigurationView,
) -> sys::Result {
    // SAFETY: the caller's arguments.
    unsafe {
        let call = next().enumerate_view_configuration_views;
        let result = call(instance, system, kind, capacity, count, views);
        if result == sys::Result::SUCCESS
            && capacity > 0
            && let Some([width, height]) = size()
        {
            for view in std::slice::from_raw_parts_mut(views, *count as usize) {
                (view.recommended_image_rect_width, view.recommended_image_rect_height) = (width, height);
                (view.max_image_rect_width, view.max_image_rect_height) = (4 * width, 4 * height);
            }
        }
        result
    }
}

unsafe extern "system" fn create_session(
    instance: sys::Instance,
    info: *const sys::SessionCreateInfo,
    session: *mut sys::Session,
) -> sys::Result {
    // SAFETY: the caller's arguments; the handles of the binding are valid as long as the session is.
    unsafe {
        let mut structure = (*info).next.cast::<sys::BaseInStructure>();
        while let Some(header) = structure.as_ref() {
            if header.ty == sys::GraphicsBindingVulkanKHR::TYPE
                && let Some(device) = Device::new(&*structure.cast::<sys::GraphicsBindingVulkanKHR>())
            {
                let pictures = Pictures::new();
                *observed() = Some(Observed { device, start: Instant::now(), times: Vec::new(), pictures });
            }
            structure = header.next;
        }
        (next().create_session)(instance, info, session)
    }
}

impl Device {
    /// Returns the device of a binding.
    ///
    /// # Safety
    /// The binding's handles are valid as long as the result is used.
    unsafe fn new(binding: &sys::GraphicsBindingVulkanKHR) -> Option<Device> {
        // SAFETY: the application's handles.
        unsafe {
            let entry = ash::Entry::load().ok()?;
            let instance = vk::Instance::from_raw(binding.instance as u64);
            let instance = ash::Instance::load(entry.static_fn(), instance);
            let device = vk::Device::from_raw(binding.device as u64);
            let device = ash::Device::load(instance.fp_v1_0(), device);
            let queue = device.get_device_queue(binding.queue_family_index, binding.queue_index);
            // The library stays loaded, because its functions are called until the process ends.
            std::mem::forget(entry);
            let physical_device = vk::PhysicalDevice::from_raw(binding.physical_device as u64);
            Some(Device {
                instance,
                physical_device,
                device,
                queue_family: binding.queue_family_index,
                queue,
            })
        }
    }
}

unsafe extern "system" fn create_reference_space(
    session: sys::Session,
    info: *const sys::ReferenceSpaceCreateInfo,
    space: *mut sys::Space,
) -> sys::Result {
    // SAFETY: the caller's arguments.
    unsafe {
        let mut info = *info;
        if still().is_some() && info.reference_space_type == sys::ReferenceSpaceType::LOCAL {
            info.reference_space_type = sys::ReferenceSpaceType::STAGE;
        }
        (next().create_reference_space)(session, &info, space)
    }
}

unsafe extern "system" fn locate_space(
    space: sys::Space,
    base: sys::Space,
    time: sys::Time,
    location: *mut sys::SpaceLocation,
) -> sys::Result {
    // SAFETY: the caller's arguments.
    unsafe { (next().locate_space)(space, base, still().unwrap_or(time), location) }
}

unsafe extern "system" fn locate_views(
    session: sys::Session,
    info: *const sys::ViewLocateInfo,
    state: *mut sys::ViewState,
    capacity: u32,
    count: *mut u32,
    views: *mut sys::View,
) -> sys::Result {
    // SAFETY: the caller's arguments.
    unsafe {
        let display_time = still().unwrap_or((*info).display_time);
        let info = sys::ViewLocateInfo { display_time, ..*info };
        (next().locate_views)(session, &info, state, capacity, count, views)
    }
}

unsafe extern "system" fn create_swapchain(
    session: sys::Session,
    info: *const sys::SwapchainCreateInfo,
    swapchain: *mut sys::Swapchain,
) -> sys::Result {
    // SAFETY: the caller's arguments.
    unsafe {
        let call = next().create_swapchain;
        let observed = &mut *observed();
        let Some(pictures) = observed.as_mut().and_then(|observed| observed.pictures.as_mut()) else {
            return call(session, info, swapchain);
        };
        let usage_flags = (*info).usage_flags | sys::SwapchainUsageFlags::TRANSFER_SRC;
        let info = sys::SwapchainCreateInfo { usage_flags, ..*info };
        let result = call(session, &info, swapchain);
        if result.into_raw() >= 0 {
            pictures.add_swapchain(next().enumerate_swapchain_images, *swapchain, &info);
        }
        result
    }
}

unsafe extern "system" fn acquire_swapchain_image(
    swapchain: sys::Swapchain,
    info: *const sys::SwapchainImageAcquireInfo,
    index: *mut u32,
) -> sys::Result {
    // SAFETY: the caller's arguments. After a success the runtime has written the index.
    unsafe {
        let result = (next().acquire_swapchain_image)(swapchain, info, index);
        if result.into_raw() >= 0
            && let Some(Observed { pictures: Some(pictures), .. }) = &mut *observed()
        {
            pictures.acquire(swapchain, *index);
        }
        result
    }
}

unsafe extern "system" fn release_swapchain_image(
    swapchain: sys::Swapchain,
    info: *const sys::SwapchainImageReleaseInfo,
) -> sys::Result {
    // SAFETY: the caller's arguments. The runtime does not own the image yet, and nobody else uses the queue.
    unsafe {
        if let Some(Observed { pictures: Some(pictures), device, .. }) = &mut *observed() {
            pictures.release(device, swapchain);
        }
        (next().release_swapchain_image)(swapchain, info)
    }
}

unsafe extern "system" fn wait_frame(
    session: sys::Session,
    info: *const sys::FrameWaitInfo,
    state: *mut sys::FrameState,
) -> sys::Result {
    // SAFETY: the caller's arguments.
    let result = unsafe { (next().wait_frame)(session, info, state) };
    if let Some(observed) = &mut *observed() {
        observed.start = Instant::now();
    }
    result
}

unsafe extern "system" fn end_frame(session: sys::Session, info: *const sys::FrameEndInfo) -> sys::Result {
    // SAFETY: the caller's arguments. During xrEndFrame nobody else uses the queue.
    unsafe {
        let result = (next().end_frame)(session, info);
        if let Some(observed) = &mut *observed()
            && (*info).layer_count > 0
        {
            observed.device.device.queue_wait_idle(observed.device.queue).ok();
            observed.times.push(observed.start.elapsed());
            if let Some(pictures) = &mut observed.pictures {
                pictures.end_frame(&*info);
            }
        }
        result
    }
}

unsafe extern "system" fn destroy_session(session: sys::Session) -> sys::Result {
    if let Some(mut observed) = observed().take() {
        let times = &mut observed.times;
        times.drain(..FIRST.min(times.len()));
        times.sort_unstable();
        if let Some(median) = times.get(times.len() / 2) {
            eprintln!("\nmeasured: {:.3} ms, median of {} frames", median.as_secs_f64() * 1e3, times.len());
        }
    }
    // SAFETY: the caller's arguments.
    unsafe { (next().destroy_session)(session) }
}
