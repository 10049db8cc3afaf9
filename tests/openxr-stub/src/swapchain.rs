//! Swapchains: images in the application's graphics.

use std::collections::VecDeque;

use openxr_sys as sys;
use sys::Handle;

use crate::graphics::Texture;
use crate::instance::fill;
use crate::log::Entry;
use crate::world::{DONE, Refusal, World, enter, forbidden};

const IMAGES: usize = 3;

pub struct Swapchain {
    pub format: i64,
    pub size: [u32; 2],
    pub layers: u32,
    pub textures: Vec<Texture>,
    /// Images in the order in which they were acquired, and whether they were waited for.
    pub acquired: VecDeque<(usize, bool)>,
    /// The image that was released last: the one that is shown.
    pub released: Option<usize>,
    next: usize,
}

impl Swapchain {
    pub fn is_depth(&self) -> bool {
        // As GL numbers them, then as Vulkan does.
        matches!(self.format, 0x81A5 | 0x81A6 | 0x8CAC | 0x88F0 | 0x8CAD | 124 | 126 | 129 | 130)
    }

    /// The texture that is shown.
    pub fn shown(&self) -> Option<Texture> {
        self.released.map(|index| self.textures[index])
    }
}

impl World {
    pub fn swapchain(&mut self, handle: sys::Swapchain) -> Result<&mut Swapchain, Refusal> {
        self.its_session()?;
        let known = self.current()?.swapchains.get_mut(&handle.into_raw());
        known.ok_or_else(|| forbidden(sys::Result::ERROR_HANDLE_INVALID, "not a swapchain"))
    }

    /// Runtimes use the application's context in these calls.
    fn need_context(&mut self) -> Result<(), Refusal> {
        if !self.its_session()?.graphics.is_current() {
            return Err(forbidden(
                sys::Result::ERROR_RUNTIME_FAILURE,
                "the session's context is not current on this thread",
            ));
        }
        Ok(())
    }

    fn leave_context(&mut self) {
        if self.script.unbind_context
            && let Ok(session) = self.its_session()
        {
            session.graphics.unbind();
        }
    }
}

pub unsafe extern "system" fn enumerate_swapchain_formats(
    session: sys::Session,
    capacity: u32,
    count: *mut u32,
    formats: *mut i64,
) -> sys::Result {
    enter("xrEnumerateSwapchainFormats", |world| {
        world.session(session)?;
        // SAFETY: as the caller says.
        unsafe { fill(capacity, count, formats, &world.script.formats, |to, from| *to = *from) }
    })
}

pub unsafe extern "system" fn create_swapchain(
    session: sys::Session,
    info: *const sys::SwapchainCreateInfo,
    out: *mut sys::Swapchain,
) -> sys::Result {
    enter("xrCreateSwapchain", |world| {
        world.session(session)?;
        world.need_context()?;
        // SAFETY: as the caller says.
        let info = unsafe { &*info };
        if info.ty != sys::SwapchainCreateInfo::TYPE {
            return Err(forbidden(sys::Result::ERROR_VALIDATION_FAILURE, "the structure's type is wrong"));
        }
        if !world.script.formats.contains(&info.format) {
            return Err(forbidden(
                sys::Result::ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
                format!("{:#x} is not offered", info.format),
            ));
        }
        if info.sample_count != 1 || info.face_count != 1 || info.mip_count != 1 {
            return Err(sys::Result::ERROR_FEATURE_UNSUPPORTED.into());
        }
        if info.width == 0 || info.height == 0 || info.array_size == 0 || info.width.max(info.height) > 4096 {
            return Err(forbidden(
                sys::Result::ERROR_VALIDATION_FAILURE,
                format!("{} x {} x {}", info.width, info.height, info.array_size),
            ));
        }
        let size = [info.width, info.height];
        let graphics = &mut world.session(session)?.graphics;
        let textures: Option<Vec<_>> = (0..IMAGES).map(|_| graphics.texture(info)).collect();
        let textures = textures.ok_or(sys::Result::ERROR_OUT_OF_MEMORY)?;
        let handle = world.new_handle();
        world.log.write(&Entry::Swapchain {
            id: handle,
            format: info.format,
            width: info.width,
            height: info.height,
            layers: info.array_size,
        });
        let swapchain = Swapchain {
            format: info.format,
            size,
            layers: info.array_size,
            textures,
            acquired: VecDeque::new(),
            released: None,
            next: 0,
        };
        world.current()?.swapchains.insert(handle, swapchain);
        // SAFETY: as the caller says.
        unsafe { *out = sys::Swapchain::from_raw(handle) };
        world.leave_context();
        world.success()
    })
}

pub unsafe extern "system" fn destroy_swapchain(swapchain: sys::Swapchain) -> sys::Result {
    enter("xrDestroySwapchain", |world| {
        let instance = world.instance.as_mut();
        let known = instance.and_then(|instance| {
            let known = instance.swapchains.remove(&swapchain.into_raw())?;
            if let Some(session) = &mut instance.session {
                session.graphics.delete(&known.textures);
            }
            Some(known)
        });
        known.ok_or_else(|| forbidden(sys::Result::ERROR_HANDLE_INVALID, "not a swapchain"))?;
        DONE
    })
}

pub unsafe extern "system" fn enumerate_swapchain_images(
    swapchain: sys::Swapchain,
    capacity: u32,
    count: *mut u32,
    images: *mut sys::SwapchainImageBaseHeader,
) -> sys::Result {
    enter("xrEnumerateSwapchainImages", |world| {
        let textures = world.swapchain(swapchain)?.textures.clone();
        let wanted = world.its_session()?.graphics.image_type();
        let vulkan = wanted == sys::SwapchainImageVulkanKHR::TYPE;
        let size = match vulkan {
            true => size_of::<sys::SwapchainImageVulkanKHR>(),
            false => size_of::<sys::SwapchainImageOpenGLESKHR>(),
        };
        for i in 0..capacity.min(textures.len() as u32) as usize {
            // SAFETY: the array has that many structures, of this size if they are of this type.
            if unsafe { (*images.byte_add(i * size)).ty } != wanted {
                return Err(forbidden(sys::Result::ERROR_VALIDATION_FAILURE, "the images' type is wrong"));
            }
        }
        // SAFETY: as the caller says, and of the type that was checked.
        unsafe {
            if vulkan {
                let images = images.cast::<sys::SwapchainImageVulkanKHR>();
                fill(capacity, count, images, &textures, |to, from| to.image = from.raw)
            } else {
                let images = images.cast::<sys::SwapchainImageOpenGLESKHR>();
                fill(capacity, count, images, &textures, |to, from| to.image = from.raw as u32)
            }
        }
    })
}

pub unsafe extern "system" fn acquire_swapchain_image(
    swapchain: sys::Swapchain,
    _: *const sys::SwapchainImageAcquireInfo,
    index: *mut u32,
) -> sys::Result {
    enter("xrAcquireSwapchainImage", |world| {
        let poison = world.script.poison;
        world.need_context()?;
        let known = world.swapchain(swapchain)?;
        if known.acquired.len() == IMAGES {
            return Err(forbidden(sys::Result::ERROR_CALL_ORDER_INVALID, "every image is acquired"));
        }
        let image = known.next;
        known.next = (known.next + 1) % IMAGES;
        known.acquired.push_back((image, false));
        let (texture, depth) = (known.textures[image], known.is_depth());
        if poison && !depth {
            world.its_session()?.graphics.poison(texture);
        }
        // SAFETY: as the caller says.
        unsafe { *index = image as u32 };
        world.leave_context();
        world.success()
    })
}

pub unsafe extern "system" fn wait_swapchain_image(
    swapchain: sys::Swapchain,
    _: *const sys::SwapchainImageWaitInfo,
) -> sys::Result {
    enter("xrWaitSwapchainImage", |world| {
        let known = world.swapchain(swapchain)?;
        let oldest = known.acquired.iter_mut().find(|(_, waited)| !waited);
        let oldest =
            oldest.ok_or_else(|| forbidden(sys::Result::ERROR_CALL_ORDER_INVALID, "no image is acquired"))?;
        oldest.1 = true;
        world.success()
    })
}

pub unsafe extern "system" fn release_swapchain_image(
    swapchain: sys::Swapchain,
    _: *const sys::SwapchainImageReleaseInfo,
) -> sys::Result {
    enter("xrReleaseSwapchainImage", |world| {
        world.need_context()?;
        let known = world.swapchain(swapchain)?;
        match known.acquired.front() {
            Some((image, true)) => known.released = Some(*image),
            _ => {
                return Err(forbidden(
                    sys::Result::ERROR_CALL_ORDER_INVALID,
                    "no image was acquired and waited for",
                ));
            }
        }
        known.acquired.pop_front();
        world.leave_context();
        world.success()
    })
}
