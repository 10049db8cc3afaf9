//! Render targets: colour textures and a depth texture behind one framebuffer.

use std::rc::Rc;

use glow::HasContext;

use crate::{Context, Filter, Format, GlApi, GlError, Image, PixelBuffer, Texture};

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
    /// Returns the whole of a render target.
    pub fn whole(target: &RenderTarget) -> Destination {
        Destination { framebuffer: Some(target.raw()), origin: [0, 0], size: target.size() }
    }
}

impl Context {
    /// Copies a rectangle of colour to another one, stretched without filtering if the sizes differ. Values are copied
    /// bit by bit, unless only one of the two is stored as sRGB.
    pub fn copy(&self, from: &Destination, to: &Destination) {
        let gl = self.raw();
        let [x, y] = from.origin.map(|n| n as i32);
        let [w, h] = from.size.map(|n| n as i32);
        let ([tx, ty], [tw, th]) = (to.origin.map(|n| n as i32), to.size.map(|n| n as i32));
        let buffer = if from.framebuffer.is_some() { glow::COLOR_ATTACHMENT0 } else { glow::BACK };
        // SAFETY: GL clips rectangles that do not fit, and refuses names that are not framebuffers.
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

/// A framebuffer object.
pub(crate) struct Framebuffer {
    gl: Rc<Context>,
    pub(crate) raw: glow::Framebuffer,
}

impl Framebuffer {
    pub(crate) fn new(gl: &Rc<Context>) -> Result<Framebuffer, GlError> {
        // SAFETY: creates an object, which is deleted on drop.
        let raw = unsafe { gl.raw().create_framebuffer() }
            .map_err(|reason| GlError::Object { what: "a framebuffer".into(), reason })?;
        gl.count(1);
        Ok(Framebuffer { gl: gl.clone(), raw })
    }
}

impl Drop for Framebuffer {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe { self.gl.raw().delete_framebuffer(self.raw) };
        self.gl.count(-1);
    }
}

/// A framebuffer with its own textures. Resizing to the same size costs nothing.
pub struct RenderTarget {
    gl: Rc<Context>,
    framebuffer: Framebuffer,
    /// A framebuffer of the colour attachments alone, if the target also has depth.
    color_only: Option<Framebuffer>,
    /// A framebuffer of depth alone, if the target also has colour.
    depth_only: Option<Framebuffer>,
    color: Vec<Texture>,
    depth: Option<Texture>,
    formats: Vec<(Format, Filter)>,
    depth_format: Option<(Format, Filter)>,
    /// True if the textures have two layers, which are drawn to at once.
    multiview: bool,
    size: [u32; 2],
}

impl RenderTarget {
    /// Creates a target with one colour texture per entry of `formats` and optionally a depth texture, which can be
    /// sampled.
    ///
    /// # Errors
    /// Those of [`Texture::new`]; [`GlError::Unsupported`] if the driver cannot render to the formats.
    pub fn new(
        gl: &Rc<Context>,
        size: [u32; 2],
        formats: &[(Format, Filter)],
        depth_format: Option<Format>,
    ) -> Result<RenderTarget, GlError> {
        RenderTarget::build(gl, size, formats, depth_format.map(|format| (format, Filter::Nearest)), false)
    }

    /// Creates a target of array textures with one layer per eye, for programs that draw two views. It can be drawn to,
    /// cleared and sampled, but not read back.
    ///
    /// # Errors
    /// Those of [`RenderTarget::new`]; [`GlError::Unsupported`] without GL_OVR_multiview2.
    pub fn multiview(
        gl: &Rc<Context>,
        size: [u32; 2],
        formats: &[(Format, Filter)],
        depth_format: Option<Format>,
    ) -> Result<RenderTarget, GlError> {
        RenderTarget::build(gl, size, formats, depth_format.map(|format| (format, Filter::Nearest)), true)
    }

    /// Creates a target of depth alone, which is sampled with comparison.
    ///
    /// # Errors
    /// Those of [`RenderTarget::new`].
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
        let with_both = depth_format.is_some() && !formats.is_empty();
        let mut target = RenderTarget {
            gl: gl.clone(),
            framebuffer: Framebuffer::new(gl)?,
            color_only: with_both.then(|| Framebuffer::new(gl)).transpose()?,
            depth_only: with_both.then(|| Framebuffer::new(gl)).transpose()?,
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

    /// Resizes the target. If the size changes, its contents become undefined.
    ///
    /// # Errors
    /// Those of [`RenderTarget::new`].
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), GlError> {
        if size == self.size {
            return Ok(());
        }
        self.color.clear();
        self.depth = None;
        self.size = [0, 0];
        let texture = |(format, filter)| {
            if self.multiview {
                Texture::array(&self.gl, size, 2, format, filter)
            } else {
                Texture::new(&self.gl, size, format, filter)
            }
        };
        self.color = self.formats.iter().copied().map(texture).collect::<Result<_, _>>()?;
        self.depth = self.depth_format.map(texture).transpose()?;
        if let Some(color_only) = &self.color_only {
            self.attach(color_only, &self.color, None);
        }
        if let Some(depth_only) = &self.depth_only {
            self.attach(depth_only, &[], self.depth.as_ref());
        }
        let status = self.attach(&self.framebuffer, &self.color, self.depth.as_ref());
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

    /// Attaches textures to a framebuffer, leaves it bound and returns its status.
    fn attach(&self, framebuffer: &Framebuffer, color: &[Texture], depth: Option<&Texture>) -> u32 {
        let gl = self.gl.raw();
        // SAFETY: the attachments are textures of this object.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer.raw));
            let mut buffers = [glow::NONE; 8];
            for (i, texture) in color.iter().enumerate() {
                buffers[i] = glow::COLOR_ATTACHMENT0 + i as u32;
                self.attach_texture(buffers[i], texture);
            }
            if let Some(depth) = depth {
                self.attach_texture(depth.format().depth_attachment(), depth);
            }
            gl.draw_buffers(&buffers[..color.len().max(1)]);
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        }
    }

    fn attach_texture(&self, attachment: u32, texture: &Texture) {
        let raw = texture.raw();
        // SAFETY: a framebuffer is bound, and the texture has two layers exactly if `multiview` is set.
        unsafe {
            if self.multiview {
                self.gl.framebuffer_texture_layers(attachment, raw);
            } else {
                let (target, gl) = (glow::FRAMEBUFFER, self.gl.raw());
                gl.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, Some(raw), 0);
            }
        }
    }

    /// Returns the whole target without its depth attachment, for passes that sample its depth texture.
    pub fn color_only(&self) -> Destination {
        let framebuffer = self.color_only.as_ref().unwrap_or(&self.framebuffer);
        Destination { framebuffer: Some(framebuffer.raw), origin: [0, 0], size: self.size }
    }

    /// Returns the whole target without its colour attachments.
    pub fn depth_only(&self) -> Destination {
        let framebuffer = self.depth_only.as_ref().unwrap_or(&self.framebuffer);
        Destination { framebuffer: Some(framebuffer.raw), origin: [0, 0], size: self.size }
    }

    /// Copies a rectangle of colour attachment 0 into a destination of the same size. `crop` is the rectangle's lower
    /// left corner.
    pub fn copy_color(&self, crop: [u32; 2], to: &Destination) {
        self.gl.copy(&Destination { framebuffer: Some(self.raw()), origin: crop, size: to.size }, to);
    }

    /// Starts reading colour attachment 0 into a buffer, as RGBA8. Does not wait.
    pub fn read_into(&self, buffer: &PixelBuffer) {
        let gl = self.gl.raw();
        let [w, h] = self.size.map(|n| n as i32);
        self.gl.set_tight_pack();
        // SAFETY: GL refuses a buffer that is too small.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw()));
            gl.read_buffer(glow::COLOR_ATTACHMENT0);
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(buffer.raw()));
            let data = glow::PixelPackData::BufferOffset(0);
            gl.read_pixels(0, 0, w, h, glow::RGBA, glow::UNSIGNED_BYTE, data);
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        }
    }

    /// Binds the framebuffer and sets the viewport to the whole of it.
    pub fn bind(&self) {
        if self.multiview {
            self.gl.note_multiview();
        }
        self.gl.bind_framebuffer(Some(self.raw()), [0, 0], self.size);
    }

    /// Binds the framebuffer and sets the viewport to its lower left part of this size.
    pub fn bind_part(&self, size: [u32; 2]) {
        self.gl.bind_framebuffer(Some(self.raw()), [0, 0], size);
    }

    /// Binds the framebuffer, for draws that overwrite all of its colour: see [`Context::overwrite`].
    pub fn overwrite(&self) {
        self.gl.overwrite(&self.color_only(), self.color.len().min(2), false);
    }

    /// Discards depth and stencil, so that a tile-based GPU does not write them to memory.
    pub fn discard_depth(&self) {
        // SAFETY: this target's framebuffer has the attachments, or GL ignores those that it lacks.
        unsafe {
            self.gl.raw().bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw()));
            self.gl.raw().invalidate_framebuffer(glow::FRAMEBUFFER, &[glow::DEPTH_STENCIL_ATTACHMENT]);
        }
    }

    /// Returns the colour images and the depth image, for declarations of passes.
    pub fn images(&self) -> impl Iterator<Item = Image> {
        self.color.iter().chain(&self.depth).map(Texture::image)
    }

    /// Returns colour texture `i`.
    pub fn color(&self, i: usize) -> &Texture {
        &self.color[i]
    }

    /// Returns the depth texture.
    ///
    /// # Panics
    /// If the target was made without depth.
    pub fn depth(&self) -> &Texture {
        self.depth.as_ref().expect("a target made with a depth format")
    }

    /// Returns the GL name of the framebuffer.
    pub fn raw(&self) -> glow::Framebuffer {
        self.framebuffer.raw
    }

    /// Returns width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Reads a rectangle of colour attachment `i` as RGBA8, rows from the bottom. Waits for the GPU.
    pub fn read_rgba8(&self, i: usize, origin: [u32; 2], size: [u32; 2]) -> Vec<u8> {
        let mut bytes = vec![0; size[0] as usize * size[1] as usize * 4];
        self.read(i, origin, size, glow::RGBA, glow::UNSIGNED_BYTE, &mut bytes);
        bytes
    }

    /// Reads a rectangle of an integer attachment ([`Format::R32Ui`]), with rows from the bottom. Waits for the GPU.
    pub fn read_u32(&self, i: usize, origin: [u32; 2], size: [u32; 2]) -> Vec<u32> {
        // OpenGL ES guarantees only RGBA_INTEGER / UNSIGNED_INT for unsigned integer buffers.
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

    /// Reads all four channels of a rectangle of a float attachment, with rows from the bottom. Waits for the GPU.
    pub fn read_rgba32f(&self, i: usize, origin: [u32; 2], size: [u32; 2]) -> Vec<[f32; 4]> {
        let mut rgba = vec![[0f32; 4]; size[0] as usize * size[1] as usize];
        self.read(i, origin, size, glow::RGBA, glow::FLOAT, bytemuck::cast_slice_mut(&mut rgba));
        rgba
    }

    fn read(&self, i: usize, origin: [u32; 2], size: [u32; 2], format: u32, ty: u32, bytes: &mut [u8]) {
        let gl = self.gl.raw();
        self.gl.set_tight_pack();
        // SAFETY: `bytes` is as long as what GL writes for this size, format and type.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw()));
            gl.read_buffer(glow::COLOR_ATTACHMENT0 + i as u32);
            let [x, y] = origin.map(|n| n as i32);
            let [w, h] = size.map(|n| n as i32);
            gl.read_pixels(x, y, w, h, format, ty, glow::PixelPackData::Slice(Some(bytes)));
        }
    }
}

/// A framebuffer for a texture that somebody else owns, such as an OpenXR runtime.
pub struct ForeignTarget {
    framebuffer: Framebuffer,
    size: [u32; 2],
}

impl ForeignTarget {
    /// Creates a framebuffer that draws into a 2-D texture, which holds colour or depth.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver cannot render to the texture.
    ///
    /// # Safety
    /// The texture must be 2-D, belong to this context, have this size, and outlive the use of the framebuffer.
    pub unsafe fn new(
        gl: &Rc<Context>,
        texture: glow::Texture,
        is_depth: bool,
        size: [u32; 2],
    ) -> Result<ForeignTarget, GlError> {
        let target = ForeignTarget { framebuffer: Framebuffer::new(gl)?, size };
        // SAFETY: the framebuffer is new, and the caller's texture is of the kind that the call takes.
        unsafe {
            if is_depth {
                gl.raw().bind_framebuffer(glow::FRAMEBUFFER, Some(target.framebuffer.raw));
                gl.raw().draw_buffers(&[glow::NONE]);
            }
            target.attach(gl, texture, is_depth)?;
        }
        Ok(target)
    }

    /// Attaches a texture for depth beside the colour.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver cannot render to both.
    ///
    /// # Safety
    /// As for [`ForeignTarget::new`].
    pub unsafe fn attach_depth(&self, gl: &Context, texture: glow::Texture) -> Result<(), GlError> {
        // SAFETY: same contract.
        unsafe { self.attach(gl, texture, true) }
    }

    unsafe fn attach(&self, gl: &Context, texture: glow::Texture, is_depth: bool) -> Result<(), GlError> {
        let raw_gl = gl.raw();
        let attachment = if is_depth { glow::DEPTH_ATTACHMENT } else { glow::COLOR_ATTACHMENT0 };
        // SAFETY: a framebuffer of this context, and the caller's texture is of the kind that the call takes.
        unsafe {
            raw_gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer.raw));
            raw_gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, Some(texture), 0);
            match raw_gl.check_framebuffer_status(glow::FRAMEBUFFER) {
                glow::FRAMEBUFFER_COMPLETE => Ok(()),
                status => Err(GlError::Unsupported(format!(
                    "the GL driver cannot render to a texture that was handed to it (status 0x{status:x})"
                ))),
            }
        }
    }

    /// Returns the lower left part of the target, of at most this size.
    pub fn part(&self, size: [u32; 2]) -> Destination {
        let size = [0, 1].map(|i| size[i].min(self.size[i]));
        Destination { framebuffer: Some(self.framebuffer.raw), origin: [0, 0], size }
    }
}

impl Drop for ForeignTarget {
    fn drop(&mut self) {
        // Its owner may delete the texture now, whose name another one then takes.
        let deleted = &self.framebuffer.gl.deleted_textures;
        deleted.set(deleted.get() + 1);
    }
}

impl Context {
    /// Discards the stencil of the bound framebuffer, so that a tile-based GPU does not write it to memory.
    pub fn discard_stencil(&self) {
        // SAFETY: an attachment that every framebuffer may have.
        unsafe { self.raw().invalidate_framebuffer(glow::FRAMEBUFFER, &[glow::STENCIL_ATTACHMENT]) }
    }

    /// Binds a framebuffer and sets the viewport to a rectangle, for draws that overwrite all of it in the first
    /// `colors` (at most two) colour attachments and, if `depth` is true, in depth. On OpenGL ES the rectangle's old
    /// contents are invalidated, so that a tile-based GPU need not read them. On desktop OpenGL nothing is invalidated.
    pub fn overwrite(&self, to: &Destination, colors: usize, depth: bool) {
        self.bind_framebuffer(to.framebuffer, to.origin, to.size);
        if self.capabilities().api == GlApi::Desktop {
            return;
        }
        let attachments = match to.framebuffer {
            Some(_) => [glow::DEPTH_ATTACHMENT, glow::COLOR_ATTACHMENT0, glow::COLOR_ATTACHMENT1],
            // The window has one colour buffer.
            None => [glow::DEPTH, glow::COLOR, glow::COLOR],
        };
        let ([x, y], [w, h]) = (to.origin.map(|n| n as i32), to.size.map(|n| n as i32));
        let discarded = &attachments[usize::from(!depth)..=colors];
        // SAFETY: attachments that every framebuffer may have, and a rectangle whose size is not negative.
        unsafe { self.raw().invalidate_sub_framebuffer(glow::FRAMEBUFFER, discarded, x, y, w, h) }
    }

    /// Reads a rectangle of colour as RGBA8, rows from the bottom. sRGB colour stays encoded. Waits for the GPU.
    pub fn read_rgba8(&self, from: &Destination) -> Vec<u8> {
        let gl = self.raw();
        let ([x, y], [w, h]) = (from.origin.map(|n| n as i32), from.size.map(|n| n as i32));
        let mut bytes = vec![0; from.size[0] as usize * from.size[1] as usize * 4];
        let buffer = if from.framebuffer.is_some() { glow::COLOR_ATTACHMENT0 } else { glow::BACK };
        self.set_tight_pack();
        // SAFETY: `bytes` is as long as what GL writes.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, from.framebuffer);
            gl.read_buffer(buffer);
            let data = glow::PixelPackData::Slice(Some(&mut bytes));
            gl.read_pixels(x, y, w, h, glow::RGBA, glow::UNSIGNED_BYTE, data);
        }
        bytes
    }
}
