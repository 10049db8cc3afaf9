//! Swapchains and their images. Each function has the contract of its OpenXR counterpart.

use std::sync::Arc;

use ash::vk;
use openxr_sys as sys;

use crate::dispatch::{XrResult, check};
use crate::lock;
use crate::objects::{self, LiveSession};
use crate::structures;
use crate::swapchain::{Content, Swapchain};

/// True if the images are subsampled. They can be read only with a special sampler.
///
/// # Safety
/// `info` is the structure of a call of xrCreateSwapchain.
unsafe fn is_subsampled(info: &sys::SwapchainCreateInfo) -> bool {
    let ty = sys::VulkanSwapchainCreateInfoMETA::TYPE;
    // SAFETY: the structure's chain, and the structure of this type.
    let more = unsafe { structures::find::<sys::VulkanSwapchainCreateInfoMETA>(info.next, ty) };
    let subsampled = vk::ImageCreateFlags::SUBSAMPLED_EXT.as_raw();
    more.is_some_and(|more| more.additional_create_flags & u64::from(subsampled) != 0)
}

/// Creates a swapchain whose images the layer can read. If the runtime refuses that, creates it as the application
/// requests.
pub unsafe fn create(
    live: &LiveSession,
    info: *const sys::SwapchainCreateInfo,
    created: *mut sys::Swapchain,
) -> XrResult<sys::Result> {
    let session = &live.session;
    let next = &session.instance.next;
    // SAFETY: the application's arguments.
    unsafe {
        let Some(&asked) = info.as_ref() else {
            return Ok((next.create_swapchain)(session.handle, info, created));
        };
        let attached =
            sys::SwapchainUsageFlags::COLOR_ATTACHMENT | sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        let readable = asked.usage_flags.intersects(attached)
            && (asked.sample_count, asked.face_count) == (1, 1)
            && !asked.create_flags.contains(sys::SwapchainCreateFlags::PROTECTED_CONTENT)
            && !is_subsampled(&asked);
        let mut result = sys::Result::ERROR_FEATURE_UNSUPPORTED;
        let mut content = None;
        if let Some(binding) = session.binding.filter(|_| readable) {
            let usage_flags = asked.usage_flags | sys::SwapchainUsageFlags::SAMPLED;
            let more = sys::SwapchainCreateInfo { usage_flags, ..asked };
            result = (next.create_swapchain)(session.handle, &more, created);
            if check(result).is_ok() {
                content = Content::new(next, &binding, *created, &asked).ok();
            }
        }
        if check(result).is_err() {
            result = check((next.create_swapchain)(session.handle, info, created))?;
        }
        let instance = Arc::clone(&session.instance);
        objects::add_swapchain(Swapchain::new(*created, session.handle, instance, content));
        Ok(result)
    }
}

pub unsafe fn destroy(swapchain: &Swapchain) -> XrResult<sys::Result> {
    objects::remove_swapchain(swapchain.handle);
    swapchain.retire();
    if let (Some(content), Some(live)) = (&swapchain.content, objects::session(swapchain.session)) {
        lock(&live.frames).forget(content);
    }
    // SAFETY: the application's own call.
    Ok(unsafe { (swapchain.next().destroy_swapchain)(swapchain.handle) })
}

pub unsafe fn acquire(
    swapchain: &Swapchain,
    info: *const sys::SwapchainImageAcquireInfo,
    index: *mut u32,
) -> XrResult<sys::Result> {
    // SAFETY: the application's arguments.
    unsafe { swapchain.acquire(info, index) }
}

pub unsafe fn wait(swapchain: &Swapchain, info: *const sys::SwapchainImageWaitInfo) -> XrResult<sys::Result> {
    // SAFETY: the application's arguments.
    unsafe { swapchain.wait(info) }
}

pub unsafe fn release(
    swapchain: &Swapchain,
    info: *const sys::SwapchainImageReleaseInfo,
) -> XrResult<sys::Result> {
    let reads = objects::session(swapchain.session).is_some_and(|live| live.session.reads_images());
    // SAFETY: the application's arguments.
    unsafe { swapchain.release(info, reads) }
}
