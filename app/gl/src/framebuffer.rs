//! Render targets: colour textures and a depth texture behind one framebuffer.

use std::rc::Rc;

use glow::HasContext;

use crate::{Context, Filter, Format, GlError, PixelBuffer, Texture};

/// A rectangle of a framebuffer to draw into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Destination {
    /// The framebuffer; `None` for the window's.
    pub framebuffer: Option<glow::Framebuffer>,
    /// Lower left corner in pixels.
    pub origin: [u32; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl Destination {
    /// All of a render target.
    pub fn whole(target: &RenderTarget) -> Destination {
        Destination { framebuffer: Some(target.raw()), origin: [0, 0], size: target.size() }
    }
}

impl Context {
    /// Copies a rectangle of colour to another, of the same size or stretched without filtering. Bits stay what they are,
    /// unless just one of the two is stored as sRGB.
    pub fn copy(&self, from: &Destination, to: &Destination) {
        let gl = self.raw();
        let [x, y] = from.origin.map(|n| n as i32);
        let [w, h] = from.size.map(|n| n as i32);
        let ([tx, ty], [tw, th]) = (to.origin.map(|n| n as i32), to.size.map(|n| n as i32));
        let buffer = if from.framebuffer.is_some() { glow::COLOR_ATTACHMENT0 } else { glow::BACK };
        // SAFETY: both framebuffers are live; GL clips rectangles that do not fit.
        unsafe {
            gl.disable(glow::SCISSOR_TEST);
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, from.framebuffer);
            gl.read_buffer(buffer);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, to.framebuffer);
            let (mask, filter) = (glow::COLOR_BUFFER_BIT, glow::NEAREST);
            gl.blit_framebuffer(x, y, x + w, y + h, tx, ty, tx + tw, ty + th, mask, filter);
        }
    }
}

/// A framebuffer with its own textures. Resizing to the size it has costs nothing.
pub struct RenderTarget {
    gl: Rc<Context>,
    raw: glow::Framebuffer,
    /// The colour attachments alone, where there is depth, too.
    raw_color_only: Option<glow::Framebuffer>,
    color: Vec<Texture>,
    depth: Option<Texture>,
    formats: Vec<(Format, Filter)>,
    depth_format: Option<(Format, Filter)>,
    /// Two layers, drawn to at once.
    multiview: bool,
    size: [u32; 2],
}

impl RenderTarget {
    /// A target of `size` with one colour texture per entry of `formats`, and optionally a depth texture
    /// (which can be sampled).
    ///
    /// # Errors
    /// As [`Texture::new`]; [`GlError::Unsupported`] when the driver cannot render to the formats.
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        formats: &[(Format, Filter)],
        depth_format: Option<Format>,
    ) -> Result<RenderTarget, GlError> {
        RenderTarget::build(gl, size, formats, depth_format.map(|format| (format, Filter::Nearest)), false)
    }

    /// As [`RenderTarget::new`], of array textures with a layer for each eye, to be drawn to by programs with two
    /// views. Only drawing, clearing and sampling work on it, no reading back.
    ///
    /// # Errors
    /// As [`RenderTarget::new`]; [`GlError::Unsupported`] without GL_OVR_multiview2.
    pub fn multiview(
        gl: &Rc<Context>,
        size: [u32; 2],
        formats: &[(Format, Filter)],
        depth_format: Option<Format>,
    ) -> Result<RenderTarget, GlError> {
        RenderTarget::build(gl, size, formats, depth_format.map(|format| (format, Filter::Nearest)), true)
    }

    /// A target of depth alone, to be sampled with comparison.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn shadow_map(gl: &Rc<Context>, size: [u32; 2], format: Format) -> Result<RenderTarget, GlError> {
        RenderTarget::build(gl, size, &[], Some((format, Filter::Compare)), false)
    }

    fn build(
        gl: &Rc<Context>,
        size: [u32; 2],
        formats: &[(Format, Filter)],
        depth_format: Option<(Format, Filter)>,
        multiview: bool,
    ) -> Result<RenderTarget, GlError> {
        if multiview && !gl.capabilities().multiview {
            return Err(GlError::Unsupported("this GL context has no GL_OVR_multiview2".into()));
        }
        let framebuffer = || -> Result<_, GlError> {
            // SAFETY: plain creation.
            let raw = unsafe { gl.raw().create_framebuffer() }
                .map_err(|reason| GlError::Object { what: "a framebuffer".into(), reason })?;
            gl.count(1);
            Ok(raw)
        };
        let raw = framebuffer()?;
        let raw_color_only = (depth_format.is_some() && !formats.is_empty()).then(framebuffer).transpose()?;
        let mut target = RenderTarget {
            gl: gl.clone(),
            raw,
            raw_color_only,
            color: Vec::new(),
            depth: None,
            formats: formats.to_vec(),
            depth_format,
            multiview,
            size: [0, 0],
        };
        target.resize(size)?;
        Ok(target)
    }

    /// Gives the target another size; contents are undefined afterwards if it changed.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        if size == self.size {
            return Ok(());
        }
        self.color.clear();
        self.depth = None;
        self.size = [0, 0];
        let texture = |(format, filter)| match self.multiview {
            true => Texture::array(&self.gl, size, 2, format, filter),
            false => Texture::new(&self.gl, size, format, filter),
        };
        self.color = self.formats.iter().copied().map(texture).collect::<Result<_, _>>()?;
        self.depth = self.depth_format.map(texture).transpose()?;
        if let Some(color_only) = self.raw_color_only {
            self.attach(color_only, false);
        }
        let status = self.attach(self.raw, true);
        if status != glow::FRAMEBUFFER_COMPLETE {
            return Err(GlError::Unsupported(format!(
                "the GL driver cannot render to {:?} with depth {:?} (status 0x{status:x}); EXT_color_buffer_float may be missing: update the driver",
                self.formats.iter().map(|f| f.0).collect::<Vec<_>>(),
                self.depth_format.map(|f| f.0)
            )));
        }
        self.size = size;
        Ok(())
    }

    /// Attaches the textures to a framebuffer, leaves it bound and returns its status.
    fn attach(&self, framebuffer: glow::Framebuffer, with_depth: bool) -> u32 {
        let gl = self.gl.raw();
        // SAFETY: attachments are live textures of this object.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            let mut buffers = [glow::NONE; 8];
            for (i, texture) in self.color.iter().enumerate() {
                buffers[i] = glow::COLOR_ATTACHMENT0 + i as u32;
                self.attach_texture(buffers[i], texture);
            }
            if let Some(depth) = self.depth.as_ref().filter(|_| with_depth) {
                self.attach_texture(glow::DEPTH_ATTACHMENT, depth);
            }
            gl.draw_buffers(if self.color.is_empty() { &buffers[..1] } else { &buffers[..self.color.len()] });
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        }
    }

    fn attach_texture(&self, attachment: u32, texture: &Texture) {
        let raw = texture.raw();
        // SAFETY: a live texture of the kind that the call takes, and a bound framebuffer.
        unsafe {
            match self.multiview {
                true => self.gl.framebuffer_texture_layers(attachment, raw),
                false => {
                    let (target, gl) = (glow::FRAMEBUFFER, self.gl.raw());
                    gl.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, Some(raw), 0);
                }
            }
        }
    }

    /// All of the target without its depth attachment: for passes that sample its depth texture.
    pub fn color_only(&self) -> Destination {
        Destination { framebuffer: self.raw_color_only.or(Some(self.raw)), origin: [0, 0], size: self.size }
    }

    /// Copies the rectangle of colour attachment 0 whose lower left corner is `crop` into a destination of the
    /// same size as the rectangle.
    pub fn copy_color(&self, crop: [u32; 2], to: &Destination) {
        self.gl.copy(&Destination { framebuffer: Some(self.raw), origin: crop, size: to.size }, to);
    }

    /// Starts to read all of colour attachment 0, as RGBA8, into a buffer; does not wait.
    pub fn read_into(&self, buffer: &PixelBuffer) {
        let gl = self.gl.raw();
        let [w, h] = self.size.map(|n| n as i32);
        self.gl.set_tight_pack();
        // SAFETY: GL refuses a buffer that is too small.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw));
            gl.read_buffer(glow::COLOR_ATTACHMENT0);
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(buffer.raw()));
            let data = glow::PixelPackData::BufferOffset(0);
            gl.read_pixels(0, 0, w, h, glow::RGBA, glow::UNSIGNED_BYTE, data);
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        }
    }

    /// Binds the framebuffer and sets the viewport to all of it.
    pub fn bind(&self) {
        if self.multiview {
            self.gl.draws_both_eyes();
        }
        // SAFETY: a live framebuffer.
        unsafe {
            self.gl.raw().bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw));
            self.gl.raw().viewport(0, 0, self.size[0] as i32, self.size[1] as i32);
        }
    }

    /// Colour texture `i`.
    pub fn color(&self, i: usize) -> &Texture {
        &self.color[i]
    }

    /// The depth texture.
    ///
    /// # Panics
    /// When the target was made without depth.
    pub fn depth(&self) -> &Texture {
        self.depth.as_ref().expect("a target made with a depth format")
    }

    /// GL name of the framebuffer.
    pub fn raw(&self) -> glow::Framebuffer {
        self.raw
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Reads a rectangle of colour attachment `i` in its own format, rows from the bottom. Waits for the GPU.
    /// Formats without a guaranteed readback of their own are read as RGBA of their component type.
    pub fn read_rgba8(&self, i: usize, origin: [u32; 2], size: [u32; 2]) -> Vec<u8> {
        let mut bytes = vec![0; size[0] as usize * size[1] as usize * 4];
        self.read(i, origin, size, glow::RGBA, glow::UNSIGNED_BYTE, &mut bytes);
        bytes
    }

    /// Reads a rectangle of an integer attachment ([`Format::R32Ui`]), rows from the bottom.
    pub fn read_u32(&self, i: usize, origin: [u32; 2], size: [u32; 2]) -> Vec<u32> {
        // RGBA_INTEGER / UNSIGNED_INT is the one combination that ES guarantees for unsigned integer buffers.
        let mut rgba = vec![0u32; size[0] as usize * size[1] as usize * 4];
        self.read(
            i,
            origin,
            size,
            glow::RGBA_INTEGER,
            glow::UNSIGNED_INT,
            bytemuck::cast_slice_mut(&mut rgba),
        );
        rgba.chunks_exact(4).map(|texel| texel[0]).collect()
    }

    /// Reads a rectangle of a float attachment, all four channels, rows from the bottom.
    pub fn read_rgba32f(&self, i: usize, origin: [u32; 2], size: [u32; 2]) -> Vec<[f32; 4]> {
        let mut rgba = vec![[0f32; 4]; size[0] as usize * size[1] as usize];
        self.read(i, origin, size, glow::RGBA, glow::FLOAT, bytemuck::cast_slice_mut(&mut rgba));
        rgba
    }

    fn read(&self, i: usize, origin: [u32; 2], size: [u32; 2], format: u32, ty: u32, bytes: &mut [u8]) {
        let gl = self.gl.raw();
        self.gl.set_tight_pack();
        // SAFETY: `bytes` is as long as GL writes, by the callers' arithmetic on `size`.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw));
            gl.read_buffer(glow::COLOR_ATTACHMENT0 + i as u32);
            let [x, y] = origin.map(|n| n as i32);
            let [w, h] = size.map(|n| n as i32);
            gl.read_pixels(x, y, w, h, format, ty, glow::PixelPackData::Slice(Some(bytes)));
        }
    }
}

/// A framebuffer around a texture that belongs to somebody else, an OpenXR runtime for instance.
pub struct ForeignTarget {
    gl: Rc<Context>,
    raw: glow::Framebuffer,
    size: [u32; 2],
}

impl ForeignTarget {
    /// A framebuffer that draws into a 2-D texture, or into a layer of an array of them: colour, or depth alone.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] when the driver cannot render to the texture.
    ///
    /// # Safety
    /// The texture is one of this context, of the kind that `layer` says and of this size, and lives longer than
    /// the framebuffer is used.
    pub unsafe fn new(
        gl: &Rc<Context>,
        texture: glow::Texture,
        layer: Option<u32>,
        is_depth: bool,
        size: [u32; 2],
    ) -> Result<ForeignTarget, GlError> {
        let raw_gl = gl.raw();
        let attachment = if is_depth { glow::DEPTH_ATTACHMENT } else { glow::COLOR_ATTACHMENT0 };
        // SAFETY: the caller's texture fits the call; the framebuffer is new.
        unsafe {
            let raw = raw_gl
                .create_framebuffer()
                .map_err(|reason| GlError::Object { what: "a framebuffer".into(), reason })?;
            gl.count(1);
            let target = ForeignTarget { gl: gl.clone(), raw, size };
            raw_gl.bind_framebuffer(glow::FRAMEBUFFER, Some(raw));
            match layer {
                Some(layer) => raw_gl.framebuffer_texture_layer(
                    glow::FRAMEBUFFER,
                    attachment,
                    Some(texture),
                    0,
                    layer as i32,
                ),
                None => raw_gl.framebuffer_texture_2d(
                    glow::FRAMEBUFFER,
                    attachment,
                    glow::TEXTURE_2D,
                    Some(texture),
                    0,
                ),
            }
            if is_depth {
                raw_gl.draw_buffers(&[glow::NONE]);
            }
            match raw_gl.check_framebuffer_status(glow::FRAMEBUFFER) {
                glow::FRAMEBUFFER_COMPLETE => Ok(target),
                status => Err(GlError::Unsupported(format!(
                    "the GL driver cannot render to a texture that was handed to it (status 0x{status:x})"
                ))),
            }
        }
    }

    /// The lower left part of this size.
    pub fn part(&self, size: [u32; 2]) -> Destination {
        let size = [0, 1].map(|i| size[i].min(self.size[i]));
        Destination { framebuffer: Some(self.raw), origin: [0, 0], size }
    }
}

impl Drop for ForeignTarget {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe { self.gl.raw().delete_framebuffer(self.raw) };
        self.gl.count(-1);
    }
}

impl Context {
    /// Reads a rectangle of colour as it is stored, in RGBA, rows from the bottom. Waits for the GPU.
    pub fn read_rgba8(&self, from: &Destination) -> Vec<u8> {
        let gl = self.raw();
        let ([x, y], [w, h]) = (from.origin.map(|n| n as i32), from.size.map(|n| n as i32));
        let mut bytes = vec![0; from.size[0] as usize * from.size[1] as usize * 4];
        let buffer = if from.framebuffer.is_some() { glow::COLOR_ATTACHMENT0 } else { glow::BACK };
        self.set_tight_pack();
        // SAFETY: `bytes` is as long as GL writes.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, from.framebuffer);
            gl.read_buffer(buffer);
            let data = glow::PixelPackData::Slice(Some(&mut bytes));
            gl.read_pixels(x, y, w, h, glow::RGBA, glow::UNSIGNED_BYTE, data);
        }
        bytes
    }
}

impl Drop for RenderTarget {
    fn drop(&mut self) {
        for framebuffer in [Some(self.raw), self.raw_color_only].into_iter().flatten() {
            // SAFETY: created in `new`, deleted once.
            unsafe { self.gl.raw().delete_framebuffer(framebuffer) };
            self.gl.count(-1);
        }
    }
}
