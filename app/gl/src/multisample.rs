//! Render targets with several samples in each pixel.

use std::rc::Rc;

use glow::HasContext;

use crate::{Context, Format, GlError, RenderTarget};

/// One attachment.
enum Image {
    Texture(glow::Texture),
    Renderbuffer(glow::Renderbuffer),
}

/// A framebuffer with colour and depth of several samples a pixel: 4 bytes a sample each, which is what they cost in
/// memory, and in bandwidth whenever a tile-based GPU has to write them out: see [`MultisampleTarget::discard`].
pub struct MultisampleTarget {
    gl: Rc<Context>,
    raw: glow::Framebuffer,
    samples: u32,
    formats: [Format; 2],
    readable: bool,
    /// Colour and depth.
    images: Option<[Image; 2]>,
    size: [u32; 2],
}

impl MultisampleTarget {
    /// A target of `size` pixels with this many samples in each ([`crate::Capabilities::check_samples`]), of formats of
    /// 4 bytes that can be rendered to. `readable` ones are textures, for shaders that read single samples
    /// ([`crate::Capabilities::multisample_textures`]).
    ///
    /// # Errors
    /// [`GlError::Unsupported`] when the driver has not this many samples, no multisample textures, or cannot render to
    /// the formats; [`GlError::TooLarge`] beyond its limit, [`GlError::Object`] when it has no memory.
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
        // SAFETY: plain creation.
        let raw = unsafe { gl.raw().create_framebuffer() }
            .map_err(|reason| GlError::Object { what: "a framebuffer".into(), reason })?;
        gl.count(1);
        let mut target = MultisampleTarget {
            gl: gl.clone(),
            raw,
            samples,
            formats: [color, depth],
            readable,
            images: None,
            size: [0, 0],
        };
        target.resize(size)?;
        Ok(target)
    }

    /// Gives the target another size; contents are undefined afterwards if it changed.
    ///
    /// # Errors
    /// As [`MultisampleTarget::new`].
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
        let gl = self.gl.raw();
        // SAFETY: the attachments are live objects of this target.
        let (status, error) = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw));
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
        // SAFETY: sizes are inside the limits, and the driver has this many samples for these formats.
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

    /// Of colour and depth.
    fn bytes(&self) -> isize {
        2 * 4 * self.samples as isize * self.size[0] as isize * self.size[1] as isize
    }

    fn delete_images(&mut self) {
        self.gl.count_texture_bytes(-self.bytes());
        self.size = [0, 0];
        for image in self.images.take().into_iter().flatten() {
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

    /// Binds the framebuffer and sets the viewport to its lower left part of this size in pixels.
    pub fn bind(&self, size: [u32; 2]) {
        self.gl.bind_framebuffer(Some(self.raw), [0, 0], size);
    }

    /// Averages the samples of the lower left pixels, as many as `to` has, into its first colour texture, which has this
    /// target's colour format.
    pub fn resolve_color(&self, to: &RenderTarget) {
        self.blit(to, glow::COLOR_BUFFER_BIT);
    }

    /// Takes one sample's depth, which one is the driver's choice, into the depth texture of `to`, which has this
    /// target's depth format: for drivers without multisample textures.
    pub fn resolve_depth(&self, to: &RenderTarget) {
        self.blit(to, glow::DEPTH_BUFFER_BIT);
    }

    fn blit(&self, to: &RenderTarget, mask: u32) {
        let [w, h] = to.size().map(|n| n as i32);
        let gl = self.gl.raw();
        // SAFETY: both framebuffers are live and alike in their formats; the rectangles are the same, as multisampled
        // ones have to be.
        unsafe {
            gl.disable(glow::SCISSOR_TEST);
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(self.raw));
            gl.read_buffer(glow::COLOR_ATTACHMENT0);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to.raw()));
            gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, mask, glow::NEAREST);
        }
    }

    /// Gives up the contents of colour, of depth or of both, so that a tile-based GPU needs not write them to memory.
    pub fn discard(&self, color: bool, depth: bool) {
        let attachments = [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT];
        let given_up = match (color, depth) {
            (true, true) => &attachments[..],
            (true, false) => &attachments[..1],
            (false, true) => &attachments[1..],
            (false, false) => return,
        };
        // SAFETY: a live framebuffer with these attachments.
        unsafe {
            self.gl.raw().bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw));
            self.gl.raw().invalidate_framebuffer(glow::FRAMEBUFFER, given_up);
        }
    }

    /// The colour of every sample as a multisample texture, where the target is readable.
    pub fn color(&self) -> Option<glow::Texture> {
        self.texture(0)
    }

    /// The depth of every sample as a multisample texture, where the target is readable.
    pub fn depth(&self) -> Option<glow::Texture> {
        self.texture(1)
    }

    fn texture(&self, i: usize) -> Option<glow::Texture> {
        match self.images.as_ref()?[i] {
            Image::Texture(raw) => Some(raw),
            Image::Renderbuffer(_) => None,
        }
    }

    /// Samples in a pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }
}

impl Drop for MultisampleTarget {
    fn drop(&mut self) {
        self.delete_images();
        // SAFETY: created in `new`, deleted once.
        unsafe { self.gl.raw().delete_framebuffer(self.raw) };
        self.gl.count(-1);
    }
}

/// A framebuffer around the textures of a render target, drawn into with several samples a pixel that a tile-based GPU
/// keeps in its tiles and averages when it writes these out: 8 bytes a pixel, whatever the number of samples. They are gone
/// as soon as another framebuffer is bound.
pub struct TileTarget {
    gl: Rc<Context>,
    raw: glow::Framebuffer,
    samples: u32,
    /// Colour and depth.
    textures: Option<[glow::Texture; 2]>,
}

impl TileTarget {
    /// A framebuffer for this many samples, around nothing yet.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] without [`crate::Capabilities::tile_samples`]; [`GlError::Object`] when the driver
    /// refuses.
    pub fn new(gl: &Rc<Context>, samples: u32) -> Result<TileTarget, GlError> {
        let capabilities = gl.capabilities();
        if !capabilities.tile_samples {
            return Err(GlError::Unsupported(format!(
                "{} has no GL_EXT_multisampled_render_to_texture2",
                capabilities.renderer
            )));
        }
        // SAFETY: plain creation.
        let raw = unsafe { gl.raw().create_framebuffer() }
            .map_err(|reason| GlError::Object { what: "a framebuffer".into(), reason })?;
        gl.count(1);
        Ok(TileTarget { gl: gl.clone(), raw, samples, textures: None })
    }

    /// Puts it around the first colour texture and the depth texture of a target; nothing is done if it is there.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] when the driver cannot render to these with so many samples.
    pub fn fit(&mut self, target: &RenderTarget) -> Result<(), GlError> {
        let textures = [target.color(0).raw(), target.depth().raw()];
        if self.textures == Some(textures) {
            return Ok(());
        }
        self.textures = None;
        let gl = self.gl.raw();
        // SAFETY: live textures; the entry point exists, as the capability says.
        let status = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw));
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
        Ok(())
    }

    /// Binds the framebuffer and sets the viewport to its lower left part of this size in pixels.
    pub fn bind(&self, size: [u32; 2]) {
        self.gl.bind_framebuffer(Some(self.raw), [0, 0], size);
    }

    /// Gives up the depth, while the framebuffer is bound.
    pub fn discard_depth(&self) {
        // SAFETY: the framebuffer that is bound has the attachment.
        unsafe { self.gl.raw().invalidate_framebuffer(glow::FRAMEBUFFER, &[glow::DEPTH_ATTACHMENT]) }
    }
}

impl Drop for TileTarget {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe { self.gl.raw().delete_framebuffer(self.raw) };
        self.gl.count(-1);
    }
}
