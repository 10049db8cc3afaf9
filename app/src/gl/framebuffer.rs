//! Render targets: colour textures and a depth texture behind one framebuffer.

use std::rc::Rc;

use glow::HasContext;

use super::{Context, Filter, Format, GlError, Texture};

/// A framebuffer with its own textures. Resizing to the size it has costs nothing.
pub struct RenderTarget {
    gl: Rc<Context>,
    raw: glow::Framebuffer,
    color: Vec<Texture>,
    depth: Option<Texture>,
    formats: Vec<(Format, Filter)>,
    depth_format: Option<(Format, Filter)>,
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
        RenderTarget::with_depth(gl, size, formats, depth_format.map(|format| (format, Filter::Nearest)))
    }

    /// A target of depth alone, to be sampled with comparison.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn shadow_map(gl: &Rc<Context>, size: [u32; 2], format: Format) -> Result<RenderTarget, GlError> {
        RenderTarget::with_depth(gl, size, &[], Some((format, Filter::Compare)))
    }

    fn with_depth(
        gl: &Rc<Context>,
        size: [u32; 2],
        formats: &[(Format, Filter)],
        depth_format: Option<(Format, Filter)>,
    ) -> Result<RenderTarget, GlError> {
        // SAFETY: plain creation.
        let raw = unsafe { gl.raw().create_framebuffer() }
            .map_err(|reason| GlError::Object { what: "a framebuffer".into(), reason })?;
        gl.count(1);
        let mut target = RenderTarget {
            gl: gl.clone(),
            raw,
            color: Vec::new(),
            depth: None,
            formats: formats.to_vec(),
            depth_format,
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
        for &(format, filter) in &self.formats {
            self.color.push(Texture::new(&self.gl, size, format, filter)?);
        }
        self.depth = self
            .depth_format
            .map(|(format, filter)| Texture::new(&self.gl, size, format, filter))
            .transpose()?;
        let gl = self.gl.raw();
        // SAFETY: attachments are live textures of this object.
        let status = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.raw));
            let mut buffers = [glow::NONE; 8];
            for (i, texture) in self.color.iter().enumerate() {
                buffers[i] = glow::COLOR_ATTACHMENT0 + i as u32;
                gl.framebuffer_texture_2d(
                    glow::FRAMEBUFFER,
                    buffers[i],
                    glow::TEXTURE_2D,
                    Some(texture.raw()),
                    0,
                );
            }
            if let Some(depth) = &self.depth {
                let raw = Some(depth.raw());
                gl.framebuffer_texture_2d(
                    glow::FRAMEBUFFER,
                    glow::DEPTH_ATTACHMENT,
                    glow::TEXTURE_2D,
                    raw,
                    0,
                );
            }
            gl.draw_buffers(if self.color.is_empty() { &buffers[..1] } else { &buffers[..self.color.len()] });
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        };
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

    /// Binds the framebuffer and sets the viewport to all of it.
    pub fn bind(&self) {
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

impl Drop for RenderTarget {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe { self.gl.raw().delete_framebuffer(self.raw) };
        self.gl.count(-1);
    }
}
