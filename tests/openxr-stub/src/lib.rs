//! A simulated OpenXR runtime for tests.
//!
//! The library is negotiated with like any runtime. Its headset is scripted ([`script`]): frusta, canted views, a
//! changing IPD, states, losses, controllers, and results instead of calls. Time is virtual: `xrWaitFrame` does not
//! wait for a display, and each frame is one period later than the last. Swapchain images are real ones, made in the application's
//! GL context or on its Vulkan device. What the application does is checked against the specification and written to a log ([`log`]); what is
//! forbidden is a [`log::Entry::Violation`].
//!
//! Nothing is composed and nothing is shown. Only what an application on OpenGL ES needs is there, and on Vulkan what one needs
//! that makes its device itself; the functions of other extensions are not offered.
//!
//! Tests that link it as a Rust library begin with a script ([`begin`]), as often as they like.

mod action;
mod extension;
mod frame;
mod graphics;
mod instance;
pub mod log;
pub mod script;
mod session;
mod space;
mod swapchain;
mod table;
mod world;

pub use world::{begin, is_inside};

use openxr_sys as sys;

/// Has `pace` called before every frame, outside all locks: a simulated Android decides there when time goes on.
///
/// # Safety
/// `pace` can be called from any thread until the process ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_openxr_stub_pace(pace: extern "C" fn()) {
    *frame::PACE.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(pace);
}

/// What a loader calls first.
///
/// # Safety
/// Both point to structures of the sizes that they say.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn xrNegotiateLoaderRuntimeInterface(
    info: *const sys::NegotiateLoaderInfo,
    request: *mut sys::NegotiateRuntimeRequest,
) -> sys::Result {
    // SAFETY: the caller gives complete structures.
    let (info, request) = unsafe { (&*info, &mut *request) };
    let fits = info.struct_type == sys::NegotiateLoaderInfo::TYPE
        && info.struct_size == size_of::<sys::NegotiateLoaderInfo>()
        && request.struct_type == sys::NegotiateRuntimeRequest::TYPE
        && request.struct_size == size_of::<sys::NegotiateRuntimeRequest>()
        && (info.min_interface_version..=info.max_interface_version).contains(&1)
        && info.min_api_version <= instance::NEWEST
        && info.max_api_version >= instance::NEWEST;
    if !fits {
        return sys::Result::ERROR_INITIALIZATION_FAILED;
    }
    request.runtime_interface_version = 1;
    request.runtime_api_version = instance::NEWEST;
    request.get_instance_proc_addr = Some(table::get_instance_proc_addr);
    sys::Result::SUCCESS
}
