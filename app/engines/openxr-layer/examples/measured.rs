//! An OpenXR API layer that measures another layer from below. It recommends the size in YORO_MEASURED_SIZE
//! (`1680x1760`) for every view. When the session ends, it writes the median frame time to standard error. A frame is
//! measured from the return of xrWaitFrame until the application's queue is idle after xrEndFrame, so the wait for the
//! display is not included.

use std::ffi::{CStr, c_char};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use ash::vk;
use ash::vk::Handle as _;
use openxr_sys as sys;
use sys::{Handle as _, pfn};

/// The number of first frames that do not count, because they create what later ones use.
const FIRST: usize = 5;

/// The functions of the runtime. One instance per process is measured.
struct Next {
    get_instance_proc_addr: pfn::GetInstanceProcAddr,
    enumerate_view_configuration_views: pfn::EnumerateViewConfigurationViews,
    create_session: pfn::CreateSession,
    wait_frame: pfn::WaitFrame,
    end_frame: pfn::EndFrame,
    destroy_session: pfn::DestroySession,
}

/// The measurements of a session.
struct Measured {
    device: ash::Device,
    queue: vk::Queue,
    start: Instant,
    times: Vec<Duration>,
}

static NEXT: OnceLock<Next> = OnceLock::new();
static MEASURED: Mutex<Option<Measured>> = Mutex::new(None);

fn measured() -> MutexGuard<'static, Option<Measured>> {
    MEASURED.lock().unwrap_or_else(PoisonError::into_inner)
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
    // SAFETY: the loader's structures; functions of these names have these types.
    unsafe {
        let own = &*(*layer).next_info;
        let failed = sys::Result::ERROR_INITIALIZATION_FAILED;
        let functions = own.next_create_api_layer_instance.zip(own.next_get_instance_proc_addr);
        let Some((create, get)) = functions else { return failed };
        let below = sys::ApiLayerCreateInfo { next_info: own.next, ..*layer };
        let result = create(info, &below, instance);
        if result.into_raw() < 0 {
            return result;
        }
        macro_rules! find {
            ($name:literal as $kind:ident) => {{
                let mut function = None;
                get(*instance, $name.as_ptr(), &mut function);
                let Some(function) = function else { return failed };
                std::mem::transmute::<pfn::VoidFunction, pfn::$kind>(function)
            }};
        }
        let next = Next {
            get_instance_proc_addr: get,
            enumerate_view_configuration_views: find!(
                c"xrEnumerateViewConfigurationViews" as EnumerateViewConfigurationViews
            ),
            create_session: find!(c"xrCreateSession" as CreateSession),
            wait_frame: find!(c"xrWaitFrame" as WaitFrame),
            end_frame: find!(c"xrEndFrame" as EndFrame),
            destroy_session: find!(c"xrDestroySession" as DestroySession),
        };
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
    // SAFETY: the caller's name and place. The caller that asks for these names calls the functions as these types.
    unsafe {
        macro_rules! own {
            ($function:ident as $kind:ident) => {
                std::mem::transmute::<pfn::$kind, pfn::VoidFunction>($function)
            };
        }
        let own = match CStr::from_ptr(name).to_bytes() {
            b"xrEnumerateViewConfigurationViews" => own!(views as EnumerateViewConfigurationViews),
            b"xrCreateSession" => own!(create_session as CreateSession),
            b"xrWaitFrame" => own!(wait_frame as WaitFrame),
            b"xrEndFrame" => own!(end_frame as EndFrame),
            b"xrDestroySession" => own!(destroy_session as DestroySession),
            _ => return (next.get_instance_proc_addr)(instance, name, function),
        };
        *function = Some(own);
    }
    sys::Result::SUCCESS
}

fn size() -> Option<[u32; 2]> {
    let text = std::env::var("YORO_MEASURED_SIZE").ok()?;
    let (width, height) = text.split_once('x')?;
    Some([width.parse().ok()?, height.parse().ok()?])
}

unsafe extern "system" fn views(
    instance: sys::Instance,
    system: sys::SystemId,
    kind: sys::ViewConfigurationType,
    capacity: u32,
    count: *mut u32,
    views: *mut sys::ViewConfigurationView,
) -> sys::Result {
    let Some(next) = NEXT.get() else { return sys::Result::ERROR_HANDLE_INVALID };
    // SAFETY: the caller's arguments.
    unsafe {
        let next = next.enumerate_view_configuration_views;
        let result = next(instance, system, kind, capacity, count, views);
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
    let Some(next) = NEXT.get() else { return sys::Result::ERROR_HANDLE_INVALID };
    // SAFETY: the caller's arguments; the handles of the binding are valid as long as the session is.
    unsafe {
        let mut structure = (*info).next.cast::<sys::BaseInStructure>();
        while let Some(header) = structure.as_ref() {
            if header.ty == sys::GraphicsBindingVulkanKHR::TYPE
                && let Ok(entry) = ash::Entry::load()
            {
                let binding = &*structure.cast::<sys::GraphicsBindingVulkanKHR>();
                let vulkan = vk::Instance::from_raw(binding.instance as u64);
                let vulkan = ash::Instance::load(entry.static_fn(), vulkan);
                let device = vk::Device::from_raw(binding.device as u64);
                let device = ash::Device::load(vulkan.fp_v1_0(), device);
                let queue = device.get_device_queue(binding.queue_family_index, binding.queue_index);
                // The library stays loaded, because its functions are called until the process ends.
                std::mem::forget(entry);
                *measured() = Some(Measured { device, queue, start: Instant::now(), times: Vec::new() });
            }
            structure = header.next;
        }
        (next.create_session)(instance, info, session)
    }
}

unsafe extern "system" fn wait_frame(
    session: sys::Session,
    info: *const sys::FrameWaitInfo,
    state: *mut sys::FrameState,
) -> sys::Result {
    let Some(next) = NEXT.get() else { return sys::Result::ERROR_HANDLE_INVALID };
    // SAFETY: the caller's arguments.
    let result = unsafe { (next.wait_frame)(session, info, state) };
    if let Some(measured) = &mut *measured() {
        measured.start = Instant::now();
    }
    result
}

unsafe extern "system" fn end_frame(session: sys::Session, info: *const sys::FrameEndInfo) -> sys::Result {
    let Some(next) = NEXT.get() else { return sys::Result::ERROR_HANDLE_INVALID };
    // SAFETY: the caller's arguments. During xrEndFrame nobody else uses the queue.
    unsafe {
        let result = (next.end_frame)(session, info);
        if let Some(measured) = &mut *measured()
            && (*info).layer_count > 0
        {
            measured.device.queue_wait_idle(measured.queue).ok();
            measured.times.push(measured.start.elapsed());
        }
        result
    }
}

unsafe extern "system" fn destroy_session(session: sys::Session) -> sys::Result {
    let Some(next) = NEXT.get() else { return sys::Result::ERROR_HANDLE_INVALID };
    if let Some(mut measured) = measured().take() {
        let times = &mut measured.times;
        times.drain(..FIRST.min(times.len()));
        times.sort_unstable();
        if let Some(median) = times.get(times.len() / 2) {
            eprintln!("\nmeasured: {:.3} ms, median of {} frames", median.as_secs_f64() * 1e3, times.len());
        }
    }
    // SAFETY: the caller's arguments.
    unsafe { (next.destroy_session)(session) }
}
