//! The layer's own swapchains: colour and depth of the other eye.

use openxr_sys as sys;
use sys::Handle as _;

use crate::binding::Binding;
use crate::dispatch::check;
use crate::reason::Reason;
use crate::session::Session;
use crate::swapchain::Content;
use crate::synthesizer::{Image, TIMEOUT};

/// A swapchain for the other eye. It must be destroyed with [`Target::destroy`], unless its session is destroyed.
pub struct Target {
    pub handle: sys::Swapchain,
    pub content: Content,
    /// An image that was acquired, but that the runtime did not make available in time.
    acquired: Option<u32>,
}

impl Target {
    /// Creates a swapchain like one of the application's, for colour or for depth.
    ///
    /// # Errors
    /// [`Reason::Runtime`].
    pub fn new(
        session: &Session,
        binding: &Binding,
        attachment: sys::SwapchainUsageFlags,
        like: &Content,
    ) -> Result<Target, Reason> {
        let info = sys::SwapchainCreateInfo {
            ty: sys::SwapchainCreateInfo::TYPE,
            next: std::ptr::null(),
            create_flags: sys::SwapchainCreateFlags::EMPTY,
            usage_flags: attachment | sys::SwapchainUsageFlags::SAMPLED,
            format: like.format,
            sample_count: 1,
            width: like.size[0],
            height: like.size[1],
            face_count: 1,
            array_size: 1,
            mip_count: 1,
        };
        let next = &session.instance.next;
        let mut handle = sys::Swapchain::NULL;
        // SAFETY: a live session, and a valid description.
        check(unsafe { (next.create_swapchain)(session.handle, &info, &mut handle) })
            .map_err(|result| Reason::Runtime("xrCreateSwapchain", result))?;
        match Content::new(next, binding, handle, &info) {
            Ok(content) => Ok(Target { handle, content, acquired: None }),
            Err(result) => {
                // SAFETY: made above, and no longer used.
                unsafe { (next.destroy_swapchain)(handle) };
                Err(Reason::Runtime("xrEnumerateSwapchainImages", result))
            }
        }
    }

    /// True if this can replace a target like this swapchain of the application.
    pub fn fits(&self, like: &Content) -> bool {
        let Content { format, size, .. } = self.content;
        format == like.format && size[0] >= like.size[0] && size[1] >= like.size[1]
    }

    /// Acquires an image to write to, and waits until the runtime makes it available.
    ///
    /// # Errors
    /// [`Reason::Late`] after [`TIMEOUT`], and [`Reason::Runtime`].
    pub fn acquire(&mut self, session: &Session) -> Result<Acquired, Reason> {
        let next = &session.instance.next;
        let index = match self.acquired {
            Some(index) => index,
            None => {
                let mut index = 0;
                // SAFETY: a live swapchain.
                check(unsafe { (next.acquire_swapchain_image)(self.handle, std::ptr::null(), &mut index) })
                    .map_err(|result| Reason::Runtime("xrAcquireSwapchainImage", result))?;
                *self.acquired.insert(index)
            }
        };
        let info = sys::SwapchainImageWaitInfo {
            ty: sys::SwapchainImageWaitInfo::TYPE,
            next: std::ptr::null(),
            timeout: sys::Duration::from_nanos(TIMEOUT.as_nanos() as i64),
        };
        // SAFETY: a live swapchain, of which an image was acquired.
        match unsafe { (next.wait_swapchain_image)(self.handle, &info) } {
            sys::Result::TIMEOUT_EXPIRED => return Err(Reason::Late),
            result => check(result).map_err(|result| Reason::Runtime("xrWaitSwapchainImage", result))?,
        };
        self.acquired = None;
        let image = self.content.images.get(index as usize).ok_or(Reason::Beyond)?;
        Ok(Acquired { swapchain: self.handle, image: self.content.image(*image, 0) })
    }

    /// Destroys the swapchain. No command may still use its images.
    pub fn destroy(self, session: &Session) {
        // SAFETY: the layer's own swapchain, which nothing refers to any longer.
        unsafe { (session.instance.next.destroy_swapchain)(self.handle) };
    }
}

/// Images of the other eye that can be written to.
#[derive(Clone, Copy)]
pub struct AcquiredImages {
    pub color: Acquired,
    /// `None` if the runtime takes no depth.
    pub depth: Option<Acquired>,
}

/// An image of a [`Target`] that can be written to.
#[derive(Clone, Copy)]
pub struct Acquired {
    pub swapchain: sys::Swapchain,
    pub image: Image,
}

impl Acquired {
    /// Releases the image to the runtime.
    ///
    /// # Errors
    /// [`Reason::Runtime`].
    pub fn release(&self, session: &Session) -> Result<(), Reason> {
        let release = session.instance.next.release_swapchain_image;
        // SAFETY: a live swapchain, of which an image was acquired and waited for.
        match check(unsafe { release(self.swapchain, std::ptr::null()) }) {
            Ok(_) => Ok(()),
            Err(result) => Err(Reason::Runtime("xrReleaseSwapchainImage", result)),
        }
    }
}
