//! Render targets with several samples per pixel.

use std::rc::Rc;

use glow::HasContext;

use crate::framebuffer::Framebuffer;
use crate::{Attachments, Context, Event, Format, GlError, RenderTarget};

/// A colour or depth attachment.
enum Image {
    Texture(glow::Texture),
    Renderbuffer(glow::Renderbuffer),
}

/// A framebuffer with several samples of colour and depth per pixel, 4 bytes each. A tile-based GPU writes all samples
/// to memory unless they are discarded by [`MultisampleTarget::discard`].
pub struct MultisampleTarget {
    gl: Rc<Context>,
    framebuffer: Framebuffer,
    samples: u32,
    formats: [Format; 2],
    readable: bool,
    /// The colour image and the depth image.
    images: Option<[Image; 2]>,
    size: [u32; 2],
}

impl MultisampleTarget {
    /// Creates a target of `size` pixels with this many samples each ([`crate::Capabilities::check_samples`]). Both
    /// formats must be renderable and have 4 bytes. A `readable` target has textures, for shaders that read single
    /// samples ([`crate::Capabilities::multisample_textures`]).
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver lacks this many samples or multisample textures, or cannot render to the
    /// formats; [`GlError::TooLarge`] beyond its size limit; [`GlError::Object`] if it has no memory.
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        samples: u32,
        color: Format,
        depth: Format,
        readable: bool,
    ) -> Result<MultisampleTarget, GlError> {
        let capabilities = gl.capabilities();
        capabilities.check_samples(samples)?;
        if readable && !capabilities.multisample_textures {
            let name = &capabilities.renderer;
            return Err(GlError::Unsupported(format!("{name} has no multisample textures (OpenGL ES 3.1)")));
        }
        let mut target = MultisampleTarget {
            gl: gl.clone(),
            framebuffer: Framebuffer::new(gl)?,
            samples,
            formats: [color, depth],
            readable,
            images: None,
            size: [0, 0],
        };
        target.resize(size)?;
        Ok(target)
    }

    /// Resizes the target. If the size changes, its contents become undefined.
    ///
    /// # Errors
    /// Those of [`MultisampleTarget::new`].
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        if size == self.size {
            return Ok(());
        }
        let limit = self.gl.capabilities().max_texture_size;
        let [width, height] = size.map(|n| n.max(1));
        if width > limit || height > limit {
            return Err(GlError::TooLarge { width, height, limit });
        }
        self.delete_images();
        let [color, depth] = self.formats;
        self.images = Some([self.image(size, color)?, self.image(size, depth)?]);
        self.size = size;
        self.gl.count_texture_bytes(self.bytes());
        let [color, depth] = self.formats.map(|format| self.describe(format));
        for (image, what) in self.images.iter().flatten().zip([color, depth]) {
            if let Image::Texture(raw) = *image {
                self.gl.tell(Event::TextureMade(raw, what));
            }
        }
        let images = Attachments { color: vec![color], depth: Some(depth) };
        self.gl.tell(Event::FramebufferMade(self.framebuffer.raw, images));
        let gl = self.gl.raw();
        // SAFETY: the attachments were created for this target above.
        let (status, error) = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer.raw));
            let attachments = [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT];
            for (attachment, image) in attachments.into_iter().zip(self.images.iter().flatten()) {
                let (target, multisample) = (glow::FRAMEBUFFER, glow::TEXTURE_2D_MULTISAMPLE);
                match *image {
                    Image::Texture(raw) => {
                        gl.framebuffer_texture_2d(target, attachment, multisample, Some(raw), 0);
                    }
                    Image::Renderbuffer(raw) => {
                        gl.framebuffer_renderbuffer(target, attachment, glow::RENDERBUFFER, Some(raw));
                    }
                }
            }
            (gl.check_framebuffer_status(glow::FRAMEBUFFER), gl.get_error())
        };
        if error == glow::OUT_OF_MEMORY {
            let what = format!("a {width}x{height} image of {} samples a pixel", self.samples);
            let reason = "out of memory; choose a smaller size, or fewer samples".into();
            return Err(GlError::Object { what, reason });
        }
        if status != glow::FRAMEBUFFER_COMPLETE {
            return Err(GlError::Unsupported(format!(
                "the GL driver cannot render to {color:?} with depth {depth:?} in {} samples a pixel (status 0x{status:x}): choose fewer, or update the driver",
                self.samples
            )));
        }
        Ok(())
    }

    fn image(&self, size: [u32; 2], format: Format) -> Result<Image, GlError> {
        let gl = self.gl.raw();
        let ([w, h], samples) = (size.map(|n| n.max(1) as i32), self.samples as i32);
        let internal = format.gl().0;
        let refused = |reason| GlError::Object { what: "a multisample image".into(), reason };
        // SAFETY: the size is within the limits, and `new` has checked the number of samples.
        let image = unsafe {
            if self.readable {
                let raw = gl.create_texture().map_err(refused)?;
                let target = glow::TEXTURE_2D_MULTISAMPLE;
                gl.bind_texture(target, Some(raw));
                gl.tex_storage_2d_multisample(target, samples, internal, w, h, true);
                Image::Texture(raw)
            } else {
                let raw = gl.create_renderbuffer().map_err(refused)?;
                gl.bind_renderbuffer(glow::RENDERBUFFER, Some(raw));
                gl.renderbuffer_storage_multisample(glow::RENDERBUFFER, samples, internal, w, h);
                Image::Renderbuffer(raw)
            }
        };
        self.gl.count(1);
        Ok(image)
    }

    fn describe(&self, format: Format) -> crate::Image {
        crate::Image { format, size: self.size, samples: self.samples }
    }

    /// Returns the size of colour and depth in bytes.
    fn bytes(&self) -> isize {
        2 * 4 * self.samples as isize * self.size[0] as isize * self.size[1] as isize
    }

    fn delete_images(&mut self) {
        self.gl.count_texture_bytes(-self.bytes());
        self.size = [0, 0];
        for image in self.images.take().into_iter().flatten() {
            if let Image::Texture(raw) = image {
                self.gl.tell(Event::TextureDeleted(raw));
            }
            // SAFETY: created in `image`, deleted once.
            unsafe {
                match image {
                    Image::Texture(raw) => self.gl.raw().delete_texture(raw),
                    Image::Renderbuffer(raw) => self.gl.raw().delete_renderbuffer(raw),
                }
            }
            self.gl.count(-1);
        }
    }

    /// Binds the framebuffer and sets the viewport to its lower left part of this size, in pixels.
    pub fn bind(&self, size: [u32; 2]) {
        self.gl.bind_framebuffer(Some(self.framebuffer.raw), [0, 0], size);
    }

    /// Averages the samples into the first colour texture of `to`, which must have the same colour format. Resolves the
    /// lower left pixels, up to the size of `to`.
    pub fn resolve_color(&self, to: &RenderTarget) {
        self.blit(to, glow::COLOR_BUFFER_BIT);
    }

    /// Copies the depth of one sample, which the driver chooses, into the depth texture of `to`, which must have the
    /// same depth format. For drivers without multisample textures.
    pub fn resolve_depth(&self, to: &RenderTarget) {
        self.blit(to, glow::DEPTH_BUFFER_BIT);
    }

    fn blit(&self, to: &RenderTarget, mask: u32) {
        let (from, depth) = (self.framebuffer.raw, mask == glow::DEPTH_BUFFER_BIT);
        self.gl.tell(Event::Copied { from: Some(from), to: Some(to.raw()), size: to.size(), depth });
        let [w, h] = to.size().map(|n| n as i32);
        let gl = self.gl.raw();
        // SAFETY: both targets own their framebuffers; the rectangles are equal, as GL demands for multisampled ones.
        unsafe {
            gl.disable(glow::SCISSOR_TEST);
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(self.framebuffer.raw));
            gl.read_buffer(glow::COLOR_ATTACHMENT0);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to.raw()));
            gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, mask, glow::NEAREST);
        }
    }

    /// Discards the contents of colour, depth or both, so that a tile-based GPU does not write them to memory.
    pub fn discard(&self, color: bool, depth: bool) {
        let attachments = [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT];
        let discarded = match (color, depth) {
            (true, true) => &attachments[..],
            (true, false) => &attachments[..1],
            (false, true) => &attachments[1..],
            (false, false) => return,
        };
        self.gl.tell(Event::Discarded { framebuffer: self.framebuffer.raw, color, depth });
        // SAFETY: this target's framebuffer has these attachments.
        unsafe {
            self.gl.raw().bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer.raw));
            self.gl.raw().invalidate_framebuffer(glow::FRAMEBUFFER, discarded);
        }
    }

    /// Returns the colour of all samples as a multisample texture, if the target is readable.
    pub fn color(&self) -> Option<glow::Texture> {
        self.texture(0)
    }

    /// Returns the depth of all samples as a multisample texture, if the target is readable.
    pub fn depth(&self) -> Option<glow::Texture> {
        self.texture(1)
    }

    fn texture(&self, i: usize) -> Option<glow::Texture> {
        match self.images.as_ref()?[i] {
            Image::Texture(raw) => Some(raw),
            Image::Renderbuffer(_) => None,
        }
    }

    /// Returns the number of samples per pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Returns width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }
}

impl Drop for MultisampleTarget {
    fn drop(&mut self) {
        self.delete_images();
    }
}

/// A framebuffer that renders with several samples per pixel into the textures of a render target. A tile-based GPU
/// keeps the samples in its tiles and averages them when it writes the tiles: 8 bytes per pixel, whatever the number of
/// samples. The samples are lost as soon as another framebuffer is bound.
pub struct TileTarget {
    gl: Rc<Context>,
    framebuffer: Framebuffer,
    samples: u32,
    /// The colour texture and the depth texture.
    textures: Option<[glow::Texture; 2]>,
}

impl TileTarget {
    /// Creates a framebuffer for this many samples, without textures.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] without [`crate::Capabilities::tile_samples`]; [`GlError::Object`] if the driver
    /// refuses.
    pub fn new(gl: &Rc<Context>, samples: u32) -> Result<TileTarget, GlError> {
        let capabilities = gl.capabilities();
        if !capabilities.tile_samples {
            return Err(GlError::Unsupported(format!(
                "{} has no GL_EXT_multisampled_render_to_texture2",
                capabilities.renderer
            )));
        }
        Ok(TileTarget { gl: gl.clone(), framebuffer: Framebuffer::new(gl)?, samples, textures: None })
    }

    /// Attaches the first colour texture and the depth texture of a target, unless they are attached already.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver cannot render to these textures with this many samples.
    pub fn fit(&mut self, target: &RenderTarget) -> Result<(), GlError> {
        let textures = [target.color(0).raw(), target.depth().raw()];
        if self.textures == Some(textures) {
            return Ok(());
        }
        self.textures = None;
        let gl = self.gl.raw();
        // SAFETY: the target owns the textures, and the entry point exists by `tile_samples`.
        let status = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer.raw));
            for (attachment, raw) in
                [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT].into_iter().zip(textures)
            {
                gl.framebuffer_texture_2d_multisample(
                    glow::FRAMEBUFFER,
                    attachment,
                    glow::TEXTURE_2D,
                    Some(raw),
                    0,
                    self.samples as i32,
                );
            }
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        };
        if status != glow::FRAMEBUFFER_COMPLETE {
            return Err(GlError::Unsupported(format!(
                "the GL driver cannot keep {} samples a pixel in its tiles (status 0x{status:x})",
                self.samples
            )));
        }
        self.textures = Some(textures);
        let images =
            Attachments { color: vec![target.color(0).image()], depth: Some(target.depth().image()) };
        self.gl.tell(Event::FramebufferMade(self.framebuffer.raw, images));
        Ok(())
    }

    /// Binds the framebuffer and sets the viewport to its lower left part of this size, in pixels.
    pub fn bind(&self, size: [u32; 2]) {
        self.gl.bind_framebuffer(Some(self.framebuffer.raw), [0, 0], size);
    }

    /// Discards the depth. The framebuffer must be bound.
    pub fn discard_depth(&self) {
        self.gl.tell(Event::Discarded { framebuffer: self.framebuffer.raw, color: false, depth: true });
        // SAFETY: the bound framebuffer has the attachment.
        unsafe { self.gl.raw().invalidate_framebuffer(glow::FRAMEBUFFER, &[glow::DEPTH_ATTACHMENT]) }
    }
}
