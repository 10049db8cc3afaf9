//! A simulated OpenXR runtime for tests.
//!
//! A loader loads the library like any runtime. A script ([`script`]) describes the headset: frusta, canted views, a
//! changing IPD, states, losses, controllers, and calls that fail. The runtime checks every call against the
//! specification and writes a log ([`log`]), in which a forbidden call is a [`log::Entry::Violation`]. It composes and
//! shows nothing, and must not depend on the application under test.
//!
//! Time is virtual: `xrWaitFrame` does not wait for a display, and each frame is one period later than the last. Images
//! of swapchains are real, and belong to the application's GL context or Vulkan device. The runtime has the functions
//! that an application needs on OpenGL ES, or on Vulkan if it creates its device itself.
//!
//! Tests that link it as a Rust library call [`begin`] with a script, as often as they like.

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
mod synthesis;
mod table;
mod world;

pub use world::{Watch, begin, is_inside, watch};

use openxr_sys as sys;

/// Sets a function that is called before every frame, outside all locks. A simulated Android uses it to control the
/// passing of time.
///
/// # Safety
/// `pace` may be called from any thread until the process ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_openxr_stub_pace(pace: extern "C" fn()) {
    *frame::PACE.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(pace);
}

/// Negotiates the interface. It is the first function that a loader calls.
///
/// # Safety
/// Both point to structures of the sizes that they state.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn xrNegotiateLoaderRuntimeInterface(
    info: *const sys::NegotiateLoaderInfo,
    request: *mut sys::NegotiateRuntimeRequest,
) -> sys::Result {
    // SAFETY: the loader's structures.
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
