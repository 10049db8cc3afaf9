//! Swapchains, whose images belong to the application's graphics.

use std::collections::VecDeque;

use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::graphics::Texture;
use crate::instance::FOVEATION;
use crate::world::{Answer, Array, DONE, Refusal, World, forbid_if, forbidden, found, in_chain};

const IMAGES: usize = 3;

pub struct Swapchain {
    pub format: i64,
    pub size: [u32; 2],
    pub layers: u32,
    pub usage: sys::SwapchainUsageFlags,
    /// True if the density of its images can change.
    pub is_foveated: bool,
    pub textures: Vec<Texture>,
    /// True if an image can be acquired only once.
    pub is_static: bool,
    /// Acquired images, oldest first, with true for those that were waited for.
    pub acquired: VecDeque<(usize, bool)>,
    /// The image that was released last, which is the one shown.
    pub released: Option<usize>,
    next: usize,
}

impl Swapchain {
    pub fn is_depth(&self) -> bool {
        // The formats' numbers in GL, then in Vulkan.
        matches!(self.format, 0x81A5 | 0x81A6 | 0x8CAC | 0x88F0 | 0x8CAD | 124 | 126 | 129 | 130)
    }

    /// True for GL_RGBA16F, the format of motion vectors.
    pub fn is_signed(&self) -> bool {
        self.format == 0x881A
    }

    /// Returns the texture that is shown.
    pub fn shown(&self) -> Option<Texture> {
        self.released.map(|index| self.textures[index])
    }
}

impl World {
    pub fn swapchain(&mut self, handle: sys::Swapchain) -> Result<&mut Swapchain, Refusal> {
        self.its_session()?;
        let known = self.current()?.swapchains.get_mut(&handle.into_raw());
        found(known, "not a swapchain")
    }

    /// Refuses a call in which runtimes use the application's context, unless the context is current.
    fn need_context(&mut self) -> Result<(), Refusal> {
        forbid_if(
            !self.its_session()?.graphics.is_current(),
            Code::ERROR_RUNTIME_FAILURE,
            "the session's context is not current on this thread",
        )
    }

    fn leave_context(&mut self) {
        if self.script.unbind_context
            && let Ok(session) = self.its_session()
        {
            session.graphics.unbind();
        }
    }
}

pub fn enumerate_swapchain_formats(world: &mut World, session: sys::Session, formats: Array<i64>) -> Answer {
    world.session(session)?;
    formats.fill(&world.script.formats, |to, from| *to = *from)
}

pub fn create_swapchain(
    world: &mut World,
    session: sys::Session,
    info: &sys::SwapchainCreateInfo,
    out: &mut sys::Swapchain,
) -> Answer {
    world.session(session)?;
    world.need_context()?;
    forbid_if(
        info.ty != sys::SwapchainCreateInfo::TYPE,
        Code::ERROR_VALIDATION_FAILURE,
        "the structure's type is wrong",
    )?;
    forbid_if(
        !world.script.formats.contains(&info.format),
        Code::ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
        format!("{:#x} is not offered", info.format),
    )?;
    if info.sample_count != 1 || info.face_count != 1 || info.mip_count != 1 {
        return Err(Code::ERROR_FEATURE_UNSUPPORTED.into());
    }
    forbid_if(
        info.width == 0 || info.height == 0 || info.array_size == 0 || info.width.max(info.height) > 4096,
        Code::ERROR_VALIDATION_FAILURE,
        format!("{} x {} x {}", info.width, info.height, info.array_size),
    )?;
    let size = [info.width, info.height];
    let graphics = &mut world.session(session)?.graphics;
    let textures: Option<Vec<_>> = (0..IMAGES).map(|_| graphics.texture(info)).collect();
    let textures = textures.ok_or(Code::ERROR_OUT_OF_MEMORY)?;
    let foveation = sys::SwapchainCreateInfoFoveationFB::TYPE;
    // SAFETY: a chain of structures, which begin with this header.
    let foveation = unsafe { in_chain::<sys::SwapchainCreateInfoFoveationFB>(info.next, foveation) };
    forbid_if(
        foveation.is_some() && !world.current()?.has(FOVEATION),
        Code::ERROR_VALIDATION_FAILURE,
        format!("a structure of {FOVEATION}, which is not enabled"),
    )?;
    let handle = world.new_handle();
    let swapchain = Swapchain {
        format: info.format,
        size,
        layers: info.array_size,
        usage: info.usage_flags,
        is_foveated: foveation.is_some(),
        is_static: info.create_flags.contains(sys::SwapchainCreateFlags::STATIC_IMAGE),
        textures,
        acquired: VecDeque::new(),
        released: None,
        next: 0,
    };
    world.current()?.swapchains.insert(handle, swapchain);
    *out = sys::Swapchain::from_raw(handle);
    world.leave_context();
    world.success()
}

pub fn destroy_swapchain(world: &mut World, swapchain: sys::Swapchain) -> Answer {
    let instance = world.instance.as_mut();
    let known = instance.and_then(|instance| {
        let known = instance.swapchains.remove(&swapchain.into_raw())?;
        if let Some(session) = &mut instance.session {
            session.graphics.delete(&known.textures);
        }
        Some(known)
    });
    found(known, "not a swapchain")?;
    DONE
}

pub fn enumerate_swapchain_images(
    world: &mut World,
    swapchain: sys::Swapchain,
    images: Array<sys::SwapchainImageBaseHeader>,
) -> Answer {
    let textures = world.swapchain(swapchain)?.textures.clone();
    let wanted = world.its_session()?.graphics.image_type();
    // SAFETY: the types are checked before anything is written.
    unsafe {
        if wanted == sys::SwapchainImageVulkanKHR::TYPE {
            let images = images.cast::<sys::SwapchainImageVulkanKHR>();
            images.check_types(textures.len(), wanted)?;
            images.fill(&textures, |to, from| to.image = from.raw)
        } else {
            let images = images.cast::<sys::SwapchainImageOpenGLESKHR>();
            images.check_types(textures.len(), wanted)?;
            images.fill(&textures, |to, from| to.image = from.raw as u32)
        }
    }
}

pub fn acquire_swapchain_image(
    world: &mut World,
    swapchain: sys::Swapchain,
    _: *const sys::SwapchainImageAcquireInfo,
    index: &mut u32,
) -> Answer {
    let poison = world.script.poison;
    world.need_context()?;
    let known = world.swapchain(swapchain)?;
    forbid_if(known.acquired.len() == IMAGES, Code::ERROR_CALL_ORDER_INVALID, "every image is acquired")?;
    forbid_if(
        known.is_static && (known.released.is_some() || !known.acquired.is_empty()),
        Code::ERROR_CALL_ORDER_INVALID,
        "the static image was acquired already",
    )?;
    let image = known.next;
    known.next = (known.next + 1) % IMAGES;
    known.acquired.push_back((image, false));
    let (texture, depth) = (known.textures[image], known.is_depth());
    if poison && !depth {
        world.its_session()?.graphics.poison(texture);
    }
    *index = image as u32;
    world.leave_context();
    world.success()
}

pub fn wait_swapchain_image(
    world: &mut World,
    swapchain: sys::Swapchain,
    _: *const sys::SwapchainImageWaitInfo,
) -> Answer {
    let known = world.swapchain(swapchain)?;
    let oldest = known.acquired.iter_mut().find(|(_, waited)| !waited);
    let oldest = oldest.ok_or_else(|| forbidden(Code::ERROR_CALL_ORDER_INVALID, "no image is acquired"))?;
    oldest.1 = true;
    world.success()
}

pub fn release_swapchain_image(
    world: &mut World,
    swapchain: sys::Swapchain,
    _: *const sys::SwapchainImageReleaseInfo,
) -> Answer {
    world.need_context()?;
    let known = world.swapchain(swapchain)?;
    match known.acquired.front() {
        Some((image, true)) => known.released = Some(*image),
        _ => {
            return Err(forbidden(Code::ERROR_CALL_ORDER_INVALID, "no image was acquired and waited for"));
        }
    }
    known.acquired.pop_front();
    world.leave_context();
    world.success()
}
