//! The application's swapchains: their images, and when these are released.
//!
//! The layer reads an image in xrEndFrame, after the application has released it. It therefore holds the release back
//! until then. As long as the runtime has not seen the release it does not own the image, and in Vulkan the image is in
//! an attachment layout.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use openxr_sys as sys;

use crate::binding::Binding;
use crate::dispatch::{Dispatch, XrResult, check};
use crate::instance::Instance;
use crate::lock;
use crate::synthesizer::Image;

/// One swapchain.
pub struct Swapchain {
    pub handle: sys::Swapchain,
    pub session: sys::Session,
    instance: Arc<Instance>,
    /// `None` if its images cannot be read.
    pub content: Option<Content>,
    state: Mutex<State>,
}

/// Images that can be read.
pub struct Content {
    /// VkImages, or names of textures.
    pub images: Vec<u64>,
    /// The format, as in XrSwapchainCreateInfo.
    pub format: i64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The number of layers of each image.
    pub array_size: u32,
}

impl Content {
    /// Asks the runtime for the images of a swapchain that was created with `info`.
    ///
    /// # Errors
    /// The result of xrEnumerateSwapchainImages.
    pub fn new(
        next: &Dispatch,
        binding: &Binding,
        swapchain: sys::Swapchain,
        info: &sys::SwapchainCreateInfo,
    ) -> XrResult<Content> {
        Ok(Content {
            images: binding.images(next, swapchain)?,
            format: info.format,
            size: [info.width, info.height],
            array_size: info.array_size,
        })
    }

    /// Returns one layer of one of the images.
    pub fn image(&self, image: u64, layer: u32) -> Image {
        Image { image, format: self.format, size: self.size, layer, layers: self.array_size }
    }
}

/// The states of images, which are given by their indices.
#[derive(Default)]
struct State {
    /// Acquired by the application, oldest first.
    acquired: VecDeque<u32>,
    /// True if the application has waited for the oldest of them.
    waited: bool,
    /// Released by the application, but not yet passed on to the runtime.
    held: Option<u32>,
    /// The number of images that the application has released.
    releases: u64,
}

impl Swapchain {
    pub fn new(
        handle: sys::Swapchain,
        session: sys::Session,
        instance: Arc<Instance>,
        content: Option<Content>,
    ) -> Swapchain {
        let images = content.as_ref().map_or(0, |content| content.images.len());
        let state = State { acquired: VecDeque::with_capacity(images), ..State::default() };
        Swapchain { handle, session, instance, content, state: Mutex::new(state) }
    }

    /// Returns the functions of the next layer or the runtime.
    pub fn next(&self) -> &Dispatch {
        &self.instance.next
    }

    /// Implements xrAcquireSwapchainImage.
    ///
    /// # Safety
    /// The arguments are those of the application's call.
    pub unsafe fn acquire(
        &self,
        info: *const sys::SwapchainImageAcquireInfo,
        index: *mut u32,
    ) -> XrResult<sys::Result> {
        let mut state = lock(&self.state);
        self.pass_on(&mut state)?;
        // SAFETY: the application's own arguments.
        let result = check(unsafe { (self.next().acquire_swapchain_image)(self.handle, info, index) })?;
        // SAFETY: the runtime has written the index.
        state.acquired.push_back(unsafe { *index });
        Ok(result)
    }

    /// Implements xrWaitSwapchainImage. No lock is held while it waits. An application waits on one thread at a time.
    ///
    /// # Safety
    /// The arguments are those of the application's call.
    pub unsafe fn wait(&self, info: *const sys::SwapchainImageWaitInfo) -> XrResult<sys::Result> {
        self.refuse_while_held(&lock(&self.state))?;
        // SAFETY: the application's own arguments.
        let result = unsafe { (self.next().wait_swapchain_image)(self.handle, info) };
        // XR_SESSION_LOSS_PENDING is a success too.
        if check(result).is_ok() && result != sys::Result::TIMEOUT_EXPIRED {
            lock(&self.state).waited = true;
        }
        Ok(result)
    }

    /// Implements xrReleaseSwapchainImage. If images are read at the end of the frame, the release is held back until
    /// then, or until the next acquire.
    ///
    /// # Safety
    /// The arguments are those of the application's call.
    pub unsafe fn release(
        &self,
        info: *const sys::SwapchainImageReleaseInfo,
        reads_images: bool,
    ) -> XrResult<sys::Result> {
        let mut state = lock(&self.state);
        self.refuse_while_held(&state)?;
        // If another image has already been acquired, this one is not the frame's. Its release must not be left to a
        // later call: the runtime may use the application's queue in this call, but not in xrWaitSwapchainImage
        // (XR_KHR_vulkan_enable).
        let is_last = state.acquired.len() == 1;
        if is_last && state.waited && self.content.is_some() && reads_images {
            state.waited = false;
            state.held = state.acquired.pop_front();
            state.releases += 1;
            return Ok(sys::Result::SUCCESS);
        }
        // SAFETY: the application's own arguments.
        let result = check(unsafe { (self.next().release_swapchain_image)(self.handle, info) })?;
        state.waited = false;
        state.acquired.pop_front();
        state.releases += 1;
        Ok(result)
    }

    /// Refuses to wait for an image and to release one while a release is held back: the application has acquired no other
    /// image, but to the runtime that one is acquired still.
    fn refuse_while_held(&self, state: &State) -> XrResult<()> {
        state.held.map_or(Ok(()), |_| Err(sys::Result::ERROR_CALL_ORDER_INVALID))
    }

    /// Returns the image whose release is held back, if it can be read.
    pub fn held(&self) -> Option<(&Content, u64)> {
        let index = lock(&self.state).held?;
        let content = self.content.as_ref()?;
        Some((content, *content.images.get(index as usize)?))
    }

    /// Returns the number of images that the application has released. While it is constant, the same image is shown.
    pub fn releases(&self) -> u64 {
        lock(&self.state).releases
    }

    /// Passes on a release that is held back.
    ///
    /// # Errors
    /// The result of xrReleaseSwapchainImage, which the application has not received yet.
    pub fn pass_on_release(&self) -> XrResult<()> {
        self.pass_on(&mut lock(&self.state))
    }

    fn pass_on(&self, state: &mut State) -> XrResult<()> {
        if state.held.is_some() {
            let info = sys::SwapchainImageReleaseInfo {
                ty: sys::SwapchainImageReleaseInfo::TYPE,
                next: std::ptr::null(),
            };
            // SAFETY: the swapchain is live, and the application has waited for this image.
            let result = unsafe { (self.next().release_swapchain_image)(self.handle, &info) };
            // After a failure the release is passed on in a later call, unless it would fail for ever.
            let is_final = [sys::Result::ERROR_CALL_ORDER_INVALID, sys::Result::ERROR_HANDLE_INVALID];
            if check(result).is_ok() || is_final.contains(&result) {
                state.held = None;
            }
            check(result)?;
        }
        Ok(())
    }

    /// Forgets a release that is held back. The swapchain is about to be destroyed, and a frame that ends at the same
    /// time must no longer use it.
    pub fn retire(&self) {
        lock(&self.state).held = None;
    }
}
