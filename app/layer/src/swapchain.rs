//! The application's swapchains: what is in their images, and when these are released.
//!
//! An image is read in xrEndFrame, when the application has released it already. The layer keeps the release to itself
//! until then: as long as the runtime has not heard of it, the image is the application's side's, in Vulkan in the layout of
//! an attachment.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use openxr_sys as sys;

use crate::dispatch::{Dispatch, XrResult, check};
use crate::graphics::{Binding, Image};
use crate::lock;
use crate::session::Session;

/// One swapchain.
pub struct Swapchain {
    pub handle: sys::Swapchain,
    pub session: Arc<Session>,
    /// None when its images cannot be read.
    pub content: Option<Content>,
    state: Mutex<State>,
}

/// Images that can be read.
pub struct Content {
    pub images: Vec<u64>,
    /// As in XrSwapchainCreateInfo.
    pub format: i64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Layers.
    pub array_size: u32,
}

impl Content {
    /// Of a swapchain of a session.
    ///
    /// # Errors
    /// What xrEnumerateSwapchainImages returns.
    pub fn of(
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

    /// One of the images, with a layer of its array.
    pub fn image(&self, image: u64, layer: u32) -> Image {
        Image { image, format: self.format, size: self.size, layer, layers: self.array_size }
    }
}

/// Images by their index.
#[derive(Default)]
struct State {
    /// Acquired by the application, oldest first.
    acquired: VecDeque<u32>,
    /// The oldest was waited for.
    waited: bool,
    /// Released by the application, but not yet by the layer.
    held: Option<u32>,
}

impl Swapchain {
    pub fn new(handle: sys::Swapchain, session: Arc<Session>, content: Option<Content>) -> Swapchain {
        let images = content.as_ref().map_or(0, |content| content.images.len());
        let state = State { acquired: VecDeque::with_capacity(images), ..State::default() };
        Swapchain { handle, session, content, state: Mutex::new(state) }
    }

    fn next(&self) -> &Dispatch {
        &self.session.instance.next
    }

    /// xrAcquireSwapchainImage.
    ///
    /// # Safety
    /// As the specification says.
    pub unsafe fn acquire(
        &self,
        info: *const sys::SwapchainImageAcquireInfo,
        index: *mut u32,
    ) -> sys::Result {
        let mut state = lock(&self.state);
        if let Err(error) = self.give_up(&mut state) {
            return error;
        }
        // SAFETY: promised by the caller.
        let result = unsafe { (self.next().acquire_swapchain_image)(self.handle, info, index) };
        if check(result).is_ok() {
            // SAFETY: the call has succeeded.
            state.acquired.push_back(unsafe { *index });
        }
        result
    }

    /// xrWaitSwapchainImage.
    ///
    /// # Safety
    /// As the specification says.
    pub unsafe fn wait(&self, info: *const sys::SwapchainImageWaitInfo) -> sys::Result {
        // Waiting may take long, and locks nothing: the specification lets the application wait from one thread at a time.
        if let Err(error) = self.pass_on_release() {
            return error;
        }
        // SAFETY: promised by the caller.
        let result = unsafe { (self.next().wait_swapchain_image)(self.handle, info) };
        if result == sys::Result::SUCCESS {
            lock(&self.state).waited = true;
        }
        result
    }

    /// xrReleaseSwapchainImage: kept back until the end of the frame where images are read.
    ///
    /// # Safety
    /// As the specification says.
    pub unsafe fn release(&self, info: *const sys::SwapchainImageReleaseInfo) -> sys::Result {
        let mut state = lock(&self.state);
        if state.waited && self.content.is_some() && self.session.reads_images() {
            state.waited = false;
            state.held = state.acquired.pop_front();
            return sys::Result::SUCCESS;
        }
        // SAFETY: promised by the caller.
        let result = unsafe { (self.next().release_swapchain_image)(self.handle, info) };
        if check(result).is_ok() {
            state.waited = false;
            state.acquired.pop_front();
        }
        result
    }

    /// The image that the application has released last and the runtime has not got yet, if it is one that can be read.
    pub fn held(&self) -> Option<(&Content, u64)> {
        let index = lock(&self.state).held?;
        let content = self.content.as_ref()?;
        Some((content, *content.images.get(index as usize)?))
    }

    /// Passes on a release that was kept back.
    ///
    /// # Errors
    /// What the runtime returns: the application has not heard of it yet.
    pub fn pass_on_release(&self) -> XrResult<()> {
        self.give_up(&mut lock(&self.state))
    }

    fn give_up(&self, state: &mut State) -> XrResult<()> {
        if state.held.take().is_some() {
            let info = sys::SwapchainImageReleaseInfo {
                ty: sys::SwapchainImageReleaseInfo::TYPE,
                next: std::ptr::null(),
            };
            // SAFETY: a live swapchain, with an image that was waited for.
            check(unsafe { (self.next().release_swapchain_image)(self.handle, &info) })?;
        }
        Ok(())
    }
}
