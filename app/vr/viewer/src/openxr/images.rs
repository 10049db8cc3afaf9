//! The runtime's images, with a framebuffer for each.

use std::num::NonZeroU32;
use std::rc::Rc;
use std::time::{Duration, Instant};

use openxr as xr;
use xr::sys::{self, Handle as _};

use super::error::{XrError, call, check};
use super::graphics::make_current;
use yoro::eyes::Eye;
use yoro_context::Graphics;
use yoro_gl::{Context, Destination, ForeignTarget, Format, GlError, Image};
use yoro_render::stereo::EyeTarget;

/// A compositor that holds an image for longer than this is considered stuck.
const TIMEOUT: Duration = Duration::from_secs(3);
/// The length of a single wait. Between waits the program can still be interrupted.
const WAIT_NS: i64 = 250_000_000;

/// The description of a swapchain's images.
#[derive(Clone, Copy, Debug)]
pub(super) struct ImageSpec {
    /// GL's internal format.
    pub format: u32,
    pub is_depth: bool,
    /// True if the runtime reads depth. It always reads colour.
    pub is_sampled: bool,
    pub size: [u32; 2],
    /// The flags of images whose density the runtime can change.
    pub foveation: Option<sys::SwapchainCreateFoveationFlagsFB>,
}

/// A swapchain.
pub(super) struct Images {
    // Dropped first: the framebuffers refer to the swapchain's images.
    framebuffers: Vec<ForeignTarget>,
    /// Those with an image of another swapchain as depth: by image and the other's image.
    with_depth: Vec<([usize; 2], ForeignTarget)>,
    textures: Vec<glow::Texture>,
    swapchain: xr::Swapchain<xr::OpenGlEs>,
    instance: xr::Instance,
    spec: ImageSpec,
    /// The image that is being drawn into.
    current: Option<usize>,
}

impl Images {
    /// Calls xrCreateSwapchain.
    pub fn new(
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        session: &xr::Session<xr::OpenGlEs>,
        spec: ImageSpec,
    ) -> Result<Images, XrError> {
        let mut usage = xr::SwapchainUsageFlags::COLOR_ATTACHMENT;
        if spec.is_depth {
            usage = xr::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        }
        if spec.is_sampled || !spec.is_depth {
            usage |= xr::SwapchainUsageFlags::SAMPLED;
        }
        let foveation = spec.foveation.map(|flags| sys::SwapchainCreateInfoFoveationFB {
            ty: sys::SwapchainCreateInfoFoveationFB::TYPE,
            next: std::ptr::null_mut(),
            flags,
        });
        let info = sys::SwapchainCreateInfo {
            ty: sys::SwapchainCreateInfo::TYPE,
            next: foveation.as_ref().map_or(std::ptr::null(), |info| std::ptr::from_ref(info).cast()),
            create_flags: xr::SwapchainCreateFlags::EMPTY,
            usage_flags: usage,
            format: spec.format.into(),
            sample_count: 1,
            width: spec.size[0],
            height: spec.size[1],
            face_count: 1,
            array_size: 1,
            mip_count: 1,
        };
        let mut swapchain = sys::Swapchain::NULL;
        let create = session.instance().fp().create_swapchain;
        // SAFETY: the session is live, the structures state their types, and there is room for the result.
        let result = unsafe { create(session.as_raw(), &info, &mut swapchain) };
        make_current(graphics)?;
        check("xrCreateSwapchain", result)?;
        // SAFETY: the session has just made it.
        let swapchain = unsafe { xr::Swapchain::from_raw(session.clone(), swapchain) };
        let images = swapchain.enumerate_images();
        make_current(graphics)?;
        let images = call("xrEnumerateSwapchainImages", images)?;
        if images.is_empty() {
            return Err(XrError::InvalidRuntimeData("offers a swapchain without images".into()));
        }
        let name = |image| match NonZeroU32::new(image) {
            Some(name) => Ok(glow::NativeTexture(name)),
            None => Err(XrError::InvalidRuntimeData("offers an image without a name".into())),
        };
        let textures = images.into_iter().map(name).collect::<Result<Vec<_>, _>>()?;
        // SAFETY: the textures live as long as the swapchain, which the framebuffers do not outlive.
        let framebuffer =
            |texture: &glow::Texture| unsafe { ForeignTarget::new(gl, *texture, spec.is_depth, spec.size) };
        let framebuffers = textures.iter().map(framebuffer).collect::<Result<_, _>>().map_err(XrError::Gl)?;
        Ok(Images {
            framebuffers,
            with_depth: Vec::new(),
            textures,
            swapchain,
            instance: session.instance().clone(),
            spec,
            current: None,
        })
    }

    /// Acquires the next image and waits for it (xrAcquireSwapchainImage, xrWaitSwapchainImage).
    pub fn acquire(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        let (fp, raw) = (self.instance.fp(), self.swapchain.as_raw());
        let mut index = 0;
        // SAFETY: the swapchain is live, and there is room for the result.
        let result = unsafe { (fp.acquire_swapchain_image)(raw, std::ptr::null(), &mut index) };
        make_current(graphics)?;
        check("xrAcquireSwapchainImage", result)?;
        let info = sys::SwapchainImageWaitInfo {
            ty: sys::SwapchainImageWaitInfo::TYPE,
            next: std::ptr::null(),
            timeout: xr::Duration::from_nanos(WAIT_NS),
        };
        let begin = Instant::now();
        loop {
            // SAFETY: as above.
            let result = unsafe { (fp.wait_swapchain_image)(raw, &info) };
            make_current(graphics)?;
            if check("xrWaitSwapchainImage", result)? != sys::Result::TIMEOUT_EXPIRED {
                break;
            }
            if begin.elapsed() > TIMEOUT {
                return Err(XrError::Call { function: "xrWaitSwapchainImage", result });
            }
        }
        if index as usize >= self.framebuffers.len() {
            return Err(XrError::InvalidRuntimeData(format!(
                "names an image number {index} that does not exist"
            )));
        }
        self.current = Some(index as usize);
        Ok(())
    }

    /// Releases the image to the compositor (xrReleaseSwapchainImage).
    pub fn release(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        if self.current.take().is_none() {
            return Ok(());
        }
        // SAFETY: the swapchain is live.
        let result = unsafe {
            (self.instance.fp().release_swapchain_image)(self.swapchain.as_raw(), std::ptr::null())
        };
        make_current(graphics)?;
        check("xrReleaseSwapchainImage", result).map(drop)
    }

    /// Deletes the framebuffers, after which nothing can be drawn.
    pub fn close(&mut self) {
        self.framebuffers.clear();
        self.with_depth.clear();
    }

    /// Returns the lower left part, of this size, of the acquired image.
    pub fn destination(&self, size: [u32; 2]) -> Option<Destination> {
        Some(self.framebuffers.get(self.current?)?.part(size))
    }

    /// Returns the destination for the acquired image, with that of another swapchain as depth. Its framebuffer is made when
    /// the two images are first acquired together.
    fn with_depth(
        &mut self,
        gl: &Rc<Context>,
        size: [u32; 2],
        depth: &Images,
    ) -> Result<Option<Destination>, GlError> {
        let Some((color, with)) = self.current.zip(depth.current) else { return Ok(None) };
        let key = [color, with];
        if let Some((_, target)) = self.with_depth.iter().find(|(known, _)| *known == key) {
            return Ok(Some(target.part(size)));
        }
        // SAFETY: the textures live as long as their swapchains, which are closed together with the framebuffers.
        let target = unsafe {
            let target = ForeignTarget::new(gl, self.textures[color], false, self.spec.size)?;
            target.attach_depth(gl, depth.textures[with])?;
            target
        };
        let part = target.part(size);
        self.with_depth.push((key, target));
        Ok(Some(part))
    }

    /// Returns the acquired image as a texture, if it stores 8-bit sRGB.
    fn texture(&self) -> Option<(glow::Texture, Image)> {
        let texture = *self.textures.get(self.current?)?;
        let image = Image { format: Format::Srgb8Alpha8, size: self.spec.size, samples: 1 };
        (self.spec.format == glow::SRGB8_ALPHA8).then_some((texture, image))
    }

    /// Returns a rectangle of an image, as xrEndFrame takes it.
    pub fn sub_image(&self, origin: [u32; 2], size: [u32; 2]) -> sys::SwapchainSubImage {
        let ([x, y], [width, height]) = (origin.map(|n| n as i32), size.map(|n| n as i32));
        sys::SwapchainSubImage {
            swapchain: self.swapchain.as_raw(),
            image_rect: xr::Rect2Di {
                offset: xr::Offset2Di { x, y },
                extent: xr::Extent2Di { width, height },
            },
            image_array_index: 0,
        }
    }
}

/// The images of both eyes, by [`Eye::index`].
pub(super) struct EyeImages([Images; 2]);

impl EyeImages {
    /// Creates the images.
    pub fn new(
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        session: &xr::Session<xr::OpenGlEs>,
        spec: ImageSpec,
    ) -> Result<EyeImages, XrError> {
        let image = || Images::new(graphics, gl, session, spec);
        Ok(EyeImages([image()?, image()?]))
    }

    /// Replaces an eye's images by images of this size, unless they have it. Returns true if they were replaced; if that
    /// fails, they stay.
    pub fn fit(
        &mut self,
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        session: &xr::Session<xr::OpenGlEs>,
        eye: Eye,
        size: [u32; 2],
    ) -> Result<bool, XrError> {
        let images = &mut self.0[eye.index()];
        let fits = images.spec.size == size;
        if !fits {
            *images = Images::new(graphics, gl, session, ImageSpec { size, ..images.spec })?;
        }
        Ok(!fits)
    }

    /// Returns the swapchains.
    pub fn swapchains(&self) -> impl Iterator<Item = sys::Swapchain> {
        self.0.iter().map(|images| images.swapchain.as_raw())
    }

    pub fn acquire(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        self.0.iter_mut().try_for_each(|images| images.acquire(graphics))
    }

    pub fn release(&mut self, graphics: &dyn Graphics) -> Result<(), XrError> {
        self.0.iter_mut().try_for_each(|images| images.release(graphics))
    }

    pub fn close(&mut self) {
        self.0.iter_mut().for_each(Images::close);
    }

    /// Returns the destinations of both eyes, in the lower left of their images.
    pub fn destinations(&self, size: [u32; 2]) -> Option<[Destination; 2]> {
        let [left, right] = Eye::BOTH.map(|eye| self.0[eye.index()].destination(size));
        Some([left?, right?])
    }

    /// Returns the destinations of both eyes, with the depth of other images.
    pub fn with_depth(
        &mut self,
        gl: &Rc<Context>,
        depth: &EyeImages,
        size: [u32; 2],
    ) -> Result<Option<[Destination; 2]>, GlError> {
        let mut of = |eye: Eye| self.0[eye.index()].with_depth(gl, size, &depth.0[eye.index()]);
        Ok(of(Eye::Left)?.zip(of(Eye::Right)?).map(|(left, right)| [left, right]))
    }

    /// Returns the images of both eyes as targets, without depth.
    pub fn targets(&self, size: [u32; 2]) -> Option<[EyeTarget<'static>; 2]> {
        let colors = self.destinations(size)?;
        Some(Eye::BOTH.map(|eye| EyeTarget {
            texture: self.0[eye.index()].texture(),
            ..EyeTarget::rectangle(colors[eye.index()])
        }))
    }

    /// Returns a rectangle of an eye's image, as xrEndFrame takes it.
    pub fn sub_image(&self, eye: Eye, origin: [u32; 2], size: [u32; 2]) -> sys::SwapchainSubImage {
        self.0[eye.index()].sub_image(origin, size)
    }
}
