//! Render targets with several samples per pixel.

use std::rc::Rc;

use glow::HasContext;

use crate::framebuffer::Framebuffer;
use crate::{Context, Destination, Filter, Format, GlError, RenderTarget, Texture};

/// What is averaged or copied out of a target: the colour attachment of a number, or depth.
#[derive(Clone, Copy)]
enum Aspect {
    Color(usize),
    Depth,
}

/// A colour or depth attachment.
enum Image {
    Texture(glow::Texture),
    Renderbuffer(glow::Renderbuffer),
}

/// A framebuffer with several samples of colours and depth per pixel. A tile-based GPU writes all samples to memory
/// unless they are discarded by [`MultisampleTarget::discard`].
pub struct MultisampleTarget {
    gl: Rc<Context>,
    framebuffer: Framebuffer,
    samples: u32,
    colors: Vec<Format>,
    depth: Format,
    readable: bool,
    /// The colour images and the depth image.
    images: Vec<Image>,
    size: [u32; 2],
}

impl MultisampleTarget {
    /// Creates a target of `size` pixels with this many samples each ([`crate::Capabilities::check_samples`]). All formats
    /// must be renderable. A `readable` target has textures, for shaders that read single samples
    /// ([`crate::Capabilities::multisample_textures`]).
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver lacks this many samples or multisample textures, or cannot render to the
    /// formats; [`GlError::TooLarge`] beyond its size limit; [`GlError::Object`] if it has no memory.
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        samples: u32,
        colors: &[Format],
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
            colors: colors.to_vec(),
            depth,
            readable,
            images: Vec::new(),
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
        for format in self.formats().collect::<Vec<_>>() {
            let image = self.image(size, format)?;
            self.images.push(image);
        }
        self.size = size;
        self.gl.count_texture_bytes(self.bytes());
        let gl = self.gl.raw();
        // SAFETY: the attachments were created for this target above.
        let (status, error) = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer.raw));
            let buffers: Vec<u32> =
                (0..self.colors.len() as u32).map(|i| glow::COLOR_ATTACHMENT0 + i).collect();
            let attachments = buffers.iter().copied().chain([self.depth.depth_attachment()]);
            for (attachment, image) in attachments.zip(&self.images) {
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
            gl.draw_buffers(&buffers);
            (gl.check_framebuffer_status(glow::FRAMEBUFFER), gl.get_error())
        };
        if error == glow::OUT_OF_MEMORY {
            let what = format!("a {width}x{height} image of {} samples a pixel", self.samples);
            let reason = "out of memory; choose a smaller size, or fewer samples".into();
            return Err(GlError::Object { what, reason });
        }
        if status != glow::FRAMEBUFFER_COMPLETE {
            return Err(GlError::Unsupported(format!(
                "the GL driver cannot render to {:?} with depth {:?} in {} samples a pixel (status 0x{status:x}): choose fewer, or update the driver",
                self.colors, self.depth, self.samples
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

    /// Returns the colour images and the depth image, for declarations of passes.
    pub fn images(&self) -> impl Iterator<Item = crate::Image> {
        let image = |format| crate::Image { format, size: self.size, samples: self.samples };
        self.formats().map(image)
    }

    /// Returns the formats of the images.
    fn formats(&self) -> impl Iterator<Item = Format> {
        self.colors.iter().copied().chain([self.depth])
    }

    /// Returns the size of all images in bytes.
    fn bytes(&self) -> isize {
        let sample: usize = self.formats().map(Format::bytes).sum();
        sample as isize * self.samples as isize * self.size[0] as isize * self.size[1] as isize
    }

    fn delete_images(&mut self) {
        self.gl.count_texture_bytes(-self.bytes());
        self.size = [0, 0];
        for image in std::mem::take(&mut self.images) {
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

    /// Averages the samples of a colour attachment into the same rectangle of a framebuffer of the same format: OpenGL ES
    /// averages between equal rectangles only.
    pub fn average(&self, attachment: usize, to: &Destination) {
        self.blit(Aspect::Color(attachment), to);
    }

    /// Copies the depth of one sample, which the driver chooses, into the depth texture of `to`, which must have the
    /// same depth format.
    pub fn copy_depth(&self, to: &RenderTarget) {
        self.blit(Aspect::Depth, &Destination::whole(to));
    }

    fn blit(&self, aspect: Aspect, to: &Destination) {
        let from = Some(self.framebuffer.raw);
        let ([x, y], [w, h]) = (to.origin.map(|n| n as i32), to.size.map(|n| n as i32));
        let (right, top) = (x + w, y + h);
        let gl = self.gl.raw();
        // SAFETY: the source is this target's framebuffer; the rectangles are equal, as GL demands for samples.
        unsafe {
            gl.disable(glow::SCISSOR_TEST);
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, from);
            let mask = match aspect {
                Aspect::Color(i) => {
                    gl.read_buffer(glow::COLOR_ATTACHMENT0 + i as u32);
                    glow::COLOR_BUFFER_BIT
                }
                Aspect::Depth => glow::DEPTH_BUFFER_BIT,
            };
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, to.framebuffer);
            gl.blit_framebuffer(x, y, right, top, x, y, right, top, mask, glow::NEAREST);
        }
    }

    /// Returns the lower left part of this size.
    pub fn part(&self, size: [u32; 2]) -> Destination {
        Destination { framebuffer: Some(self.framebuffer.raw), origin: [0, 0], size }
    }

    /// Discards the contents of all colours, depth or both, so that a tile-based GPU does not write them to memory.
    pub fn discard(&self, color: bool, depth: bool) {
        let colors = (0..self.colors.len() as u32).map(|i| glow::COLOR_ATTACHMENT0 + i).filter(|_| color);
        let mut discarded = [0; 4];
        let mut count = 0;
        for attachment in colors.chain(depth.then_some(self.depth.depth_attachment())) {
            discarded[count] = attachment;
            count += 1;
        }
        // SAFETY: this target's framebuffer has these attachments.
        unsafe {
            self.gl.raw().bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer.raw));
            self.gl.raw().invalidate_framebuffer(glow::FRAMEBUFFER, &discarded[..count]);
        }
    }

    /// Returns the samples of the first colour as a multisample texture, if the target is readable.
    pub fn color(&self) -> Option<glow::Texture> {
        self.texture(0)
    }

    /// Returns the samples of depth as a multisample texture, if the target is readable.
    pub fn depth(&self) -> Option<glow::Texture> {
        self.texture(self.colors.len())
    }

    fn texture(&self, i: usize) -> Option<glow::Texture> {
        match self.images.get(i)? {
            Image::Texture(raw) => Some(*raw),
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

/// A framebuffer for textures that others own. With several samples per pixel, a tile-based GPU keeps them in its tiles, and
/// averages them when it writes the tiles. The samples are lost as soon as another framebuffer is bound; what is drawn then
/// begins with the averages ([`TileTarget::loads`]).
pub struct TileTarget {
    gl: Rc<Context>,
    framebuffer: Framebuffer,
    samples: u32,
    /// The colour textures and the depth texture.
    textures: Vec<glow::Texture>,
    /// The number of textures that had been deleted when these were attached.
    deleted: u64,
}

impl TileTarget {
    /// Creates a framebuffer for this many samples, without textures.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for several samples without [`crate::Capabilities::tile_samples`]; [`GlError::Object`] if the
    /// driver refuses.
    pub fn new(gl: &Rc<Context>, samples: u32) -> Result<TileTarget, GlError> {
        let capabilities = gl.capabilities();
        if samples > 1 && !capabilities.tile_samples {
            return Err(GlError::Unsupported(format!(
                "{} has no GL_EXT_multisampled_render_to_texture2",
                capabilities.renderer
            )));
        }
        Ok(TileTarget {
            gl: gl.clone(),
            framebuffer: Framebuffer::new(gl)?,
            samples,
            textures: Vec::new(),
            deleted: 0,
        })
    }

    /// Attaches colour textures, which receive the averages, and a depth texture of the same size, which is written only
    /// with one sample per pixel, unless they are attached already.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver cannot render to these textures with this many samples.
    ///
    /// # Safety
    /// The colours are 2-D textures of this context, in the order of the attachments.
    pub unsafe fn fit(
        &mut self,
        colors: &[(glow::Texture, crate::Image)],
        depth: &Texture,
    ) -> Result<(), GlError> {
        let textures = || colors.iter().map(|(raw, _)| *raw).chain([depth.raw()]);
        let deleted = self.gl.deleted_textures.get();
        if self.textures.iter().copied().eq(textures()) && self.deleted == deleted {
            return Ok(());
        }
        let gl = self.gl.raw();
        let previous = self.textures.len().saturating_sub(1);
        self.textures.clear();
        let buffers: Vec<u32> = (0..colors.len() as u32).map(|i| glow::COLOR_ATTACHMENT0 + i).collect();
        let attachments = buffers.iter().copied().chain([depth.format().depth_attachment()]);
        // SAFETY: the caller's textures, and the entry point exists by `tile_samples`.
        let status = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer.raw));
            for unused in colors.len()..previous {
                let attachment = glow::COLOR_ATTACHMENT0 + unused as u32;
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, None, 0);
            }
            for (attachment, raw) in attachments.zip(textures()) {
                let (target, kind, samples) = (glow::FRAMEBUFFER, glow::TEXTURE_2D, self.samples as i32);
                if samples > 1 {
                    gl.framebuffer_texture_2d_multisample(target, attachment, kind, Some(raw), 0, samples);
                } else {
                    gl.framebuffer_texture_2d(target, attachment, kind, Some(raw), 0);
                }
            }
            gl.draw_buffers(&buffers);
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        };
        if status != glow::FRAMEBUFFER_COMPLETE {
            return Err(GlError::Unsupported(format!(
                "the GL driver cannot keep {} samples a pixel in its tiles (status 0x{status:x})",
                self.samples
            )));
        }
        self.textures = textures().collect();
        self.deleted = deleted;
        Ok(())
    }

    /// True if the driver has samples in tiles, and gives each sample its pixel's colour where a texture is drawn over that
    /// was drawn before. The extension's text does not say so.
    ///
    /// # Errors
    /// [`GlError::Object`] if the driver has no memory.
    pub fn loads(gl: &Rc<Context>, samples: u32) -> Result<bool, GlError> {
        const SIZE: [u32; 2] = [4, 4];
        if samples == 1 || !gl.capabilities().tile_samples {
            return Ok(samples == 1);
        }
        let color = RenderTarget::new(gl, SIZE, &[(Format::Rgba8, Filter::Nearest)], None)?;
        let depth = Texture::new(gl, SIZE, Format::Depth32F, Filter::Nearest)?;
        let mut tile = TileTarget::new(gl, samples)?;
        // SAFETY: the colour is a 2-D texture of this context.
        if unsafe { tile.fit(&[color.color(0).attachment()], &depth) }.is_err() {
            return Ok(false);
        }
        let to = tile.part(SIZE);
        let fill = |origin, size, color| {
            gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            gl.fill(origin, size, color);
        };
        fill([0, 0], SIZE, [1.0, 0.0, 0.0, 1.0]);
        let is_red = |pixels: &[u8]| pixels == [255, 0, 0, 255];
        let is_whole = color.read_rgba8(0, [0, 0], SIZE).chunks_exact(4).all(is_red);
        fill([1, 1], [1, 1], [0.0, 1.0, 0.0, 1.0]);
        let pixels = color.read_rgba8(0, [0, 0], SIZE);
        Ok(is_whole && pixels.chunks_exact(4).filter(|pixel| is_red(pixel)).count() == 15)
    }

    /// Returns the lower left part of this size.
    pub fn part(&self, size: [u32; 2]) -> Destination {
        Destination { framebuffer: Some(self.framebuffer.raw), origin: [0, 0], size }
    }

    /// Discards depth and stencil. The framebuffer must be bound.
    pub fn discard_depth(&self) {
        // SAFETY: the bound framebuffer has the attachment.
        unsafe { self.gl.raw().invalidate_framebuffer(glow::FRAMEBUFFER, &[glow::DEPTH_STENCIL_ATTACHMENT]) }
    }
}
