//! 2-D textures and arrays of them, with immutable storage.

use std::rc::Rc;

use glow::HasContext;

use crate::{Context, GlError, Image};

/// A pixel format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit RGBA, linear or already encoded.
    Rgba8,
    /// 8-bit sRGB colour with linear alpha, decoded when sampled.
    Srgb8Alpha8,
    /// 8-bit single channel.
    R8,
    /// 8-bit, two channels.
    Rg8,
    /// 10-bit RGB, 2-bit alpha.
    Rgb10A2,
    /// Half float RGBA.
    Rgba16F,
    /// Packed float RGB without sign or alpha.
    R11G11B10F,
    /// Half float, one channel.
    R16F,
    /// Half float, two channels.
    Rg16F,
    /// Float, one channel.
    R32F,
    /// Float, two channels.
    Rg32F,
    /// Float RGBA.
    Rgba32F,
    /// Unsigned 32-bit integer, one channel.
    R32Ui,
    /// Unsigned 32-bit integers, four channels.
    Rgba32Ui,
    /// 24-bit depth.
    Depth24,
    /// Float depth.
    Depth32F,
    /// 16-bit depth.
    Depth16,
    /// Float depth and 8-bit stencil.
    Depth32FStencil8,
}

impl Format {
    /// Returns GL's internal format, pixel format and type.
    pub fn gl(self) -> (u32, u32, u32) {
        match self {
            Format::Rgba8 => (glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Format::Srgb8Alpha8 => (glow::SRGB8_ALPHA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Format::R8 => (glow::R8, glow::RED, glow::UNSIGNED_BYTE),
            Format::Rg8 => (glow::RG8, glow::RG, glow::UNSIGNED_BYTE),
            Format::Rgb10A2 => (glow::RGB10_A2, glow::RGBA, glow::UNSIGNED_INT_2_10_10_10_REV),
            Format::Rgba16F => (glow::RGBA16F, glow::RGBA, glow::HALF_FLOAT),
            Format::R11G11B10F => (glow::R11F_G11F_B10F, glow::RGB, glow::UNSIGNED_INT_10F_11F_11F_REV),
            Format::R16F => (glow::R16F, glow::RED, glow::HALF_FLOAT),
            Format::Rg16F => (glow::RG16F, glow::RG, glow::HALF_FLOAT),
            Format::R32F => (glow::R32F, glow::RED, glow::FLOAT),
            Format::Rg32F => (glow::RG32F, glow::RG, glow::FLOAT),
            Format::Rgba32F => (glow::RGBA32F, glow::RGBA, glow::FLOAT),
            Format::R32Ui => (glow::R32UI, glow::RED_INTEGER, glow::UNSIGNED_INT),
            Format::Rgba32Ui => (glow::RGBA32UI, glow::RGBA_INTEGER, glow::UNSIGNED_INT),
            Format::Depth24 => (glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT, glow::UNSIGNED_INT),
            Format::Depth32F => (glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, glow::FLOAT),
            Format::Depth16 => (glow::DEPTH_COMPONENT16, glow::DEPTH_COMPONENT, glow::UNSIGNED_SHORT),
            Format::Depth32FStencil8 => {
                (glow::DEPTH32F_STENCIL8, glow::DEPTH_STENCIL, glow::FLOAT_32_UNSIGNED_INT_24_8_REV)
            }
        }
    }

    /// Returns the size in bytes of a pixel, or of a sample.
    pub fn bytes(self) -> usize {
        match self {
            Format::R8 => 1,
            Format::Rg8 | Format::R16F | Format::Depth16 => 2,
            Format::Rgba8 | Format::Srgb8Alpha8 | Format::Rgb10A2 | Format::R11G11B10F | Format::Rg16F => 4,
            Format::R32F | Format::R32Ui | Format::Depth24 | Format::Depth32F => 4,
            Format::Rgba16F | Format::Rg32F | Format::Depth32FStencil8 => 8,
            Format::Rgba32F | Format::Rgba32Ui => 16,
        }
    }

    /// True if the format holds depth.
    pub fn is_depth(self) -> bool {
        matches!(self, Format::Depth24 | Format::Depth32F | Format::Depth16 | Format::Depth32FStencil8)
    }

    /// Returns the attachment of a depth format.
    pub(crate) fn depth_attachment(self) -> u32 {
        if self == Format::Depth32FStencil8 { glow::DEPTH_STENCIL_ATTACHMENT } else { glow::DEPTH_ATTACHMENT }
    }
}

/// How a texture is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Nearest texel, clamped to the edge, for depth, integers and exact copies.
    Nearest,
    /// Bilinear, clamped to the edge, for render targets.
    Linear,
    /// Trilinear, anisotropic, repeating, for material maps.
    Material,
    /// [`Filter::Material`] with nearest magnification.
    MaterialNearest,
    /// Depth compared with a reference (LEQUAL), with 2x2 results averaged, for shadow maps in a `sampler2DShadow`.
    Compare,
}

/// A higher anisotropy costs time without a visible difference.
const MAX_ANISOTROPY: f32 = 8.0;

/// A 2-D texture, or an array of them.
pub struct Texture {
    gl: Rc<Context>,
    raw: glow::Texture,
    /// TEXTURE_2D or TEXTURE_2D_ARRAY.
    target: u32,
    size: [u32; 2],
    format: Format,
    /// Size in bytes of all levels and layers.
    bytes: usize,
}

impl Texture {
    /// Creates a 2-D texture. With a material filter it has a full mip chain, otherwise one level.
    ///
    /// # Errors
    /// [`GlError::TooLarge`] beyond the driver's limit; [`GlError::OutOfMemory`] if the driver has no memory;
    /// [`GlError::Object`] if it refuses.
    pub fn new(gl: &Rc<Context>, size: [u32; 2], format: Format, filter: Filter) -> Result<Texture, GlError> {
        Texture::with_layers(gl, size, None, format, filter)
    }

    /// Creates an array of `layers` textures, to be rendered to and sampled.
    ///
    /// # Errors
    /// Those of [`Texture::new`].
    pub fn array(
        gl: &Rc<Context>,
        size: [u32; 2],
        layers: u32,
        format: Format,
        filter: Filter,
    ) -> Result<Texture, GlError> {
        Texture::with_layers(gl, size, Some(layers), format, filter)
    }

    fn with_layers(
        gl: &Rc<Context>,
        size: [u32; 2],
        layers: Option<u32>,
        format: Format,
        filter: Filter,
    ) -> Result<Texture, GlError> {
        let limit = gl.capabilities().max_texture_size;
        let [width, height] = size.map(|n| n.max(1));
        if width > limit || height > limit {
            return Err(GlError::TooLarge { width, height, limit });
        }
        let mipmapped = matches!(filter, Filter::Material | Filter::MaterialNearest);
        let levels = if mipmapped { 32 - width.max(height).leading_zeros() } else { 1 };
        let (min, mag, wrap) = match filter {
            Filter::Nearest => (glow::NEAREST, glow::NEAREST, glow::CLAMP_TO_EDGE),
            Filter::Linear | Filter::Compare => (glow::LINEAR, glow::LINEAR, glow::CLAMP_TO_EDGE),
            Filter::Material => (glow::LINEAR_MIPMAP_LINEAR, glow::LINEAR, glow::REPEAT),
            Filter::MaterialNearest => (glow::LINEAR_MIPMAP_LINEAR, glow::NEAREST, glow::REPEAT),
        };
        let target = if layers.is_some() { glow::TEXTURE_2D_ARRAY } else { glow::TEXTURE_2D };
        let raw_gl = gl.raw();
        // SAFETY: the texture is new, its size is within the limit, and format and filter are valid together.
        let raw = unsafe {
            let raw = raw_gl
                .create_texture()
                .map_err(|reason| GlError::Object { what: "a texture".into(), reason })?;
            raw_gl.bind_texture(target, Some(raw));
            let (levels, internal, w, h) = (levels as i32, format.gl().0, width as i32, height as i32);
            match layers {
                Some(layers) => raw_gl.tex_storage_3d(target, levels, internal, w, h, layers as i32),
                None => raw_gl.tex_storage_2d(target, levels, internal, w, h),
            }
            for (name, value) in [
                (glow::TEXTURE_MIN_FILTER, min),
                (glow::TEXTURE_MAG_FILTER, mag),
                (glow::TEXTURE_WRAP_S, wrap),
                (glow::TEXTURE_WRAP_T, wrap),
            ] {
                raw_gl.tex_parameter_i32(target, name, value as i32);
            }
            if filter == Filter::Compare {
                let mode = glow::COMPARE_REF_TO_TEXTURE as i32;
                raw_gl.tex_parameter_i32(target, glow::TEXTURE_COMPARE_MODE, mode);
                raw_gl.tex_parameter_i32(target, glow::TEXTURE_COMPARE_FUNC, glow::LEQUAL as i32);
            }
            let anisotropy = gl.capabilities().max_anisotropy.min(MAX_ANISOTROPY);
            if mipmapped && anisotropy > 1.0 {
                raw_gl.tex_parameter_f32(target, glow::TEXTURE_MAX_ANISOTROPY_EXT, anisotropy);
            }
            raw
        };
        gl.count(1);
        let mut texture = Texture { gl: gl.clone(), raw, target, size: [width, height], format, bytes: 0 };
        // A full mip chain adds a third.
        let level_0 = texture.byte_len() * layers.unwrap_or(1) as usize;
        texture.bytes = if mipmapped { level_0 / 3 * 4 } else { level_0 };
        gl.count_texture_bytes(texture.bytes as isize);
        if !gl.has_storage(target) {
            let reason = gl.take_errors().unwrap_or_default();
            if reason.is_empty() || reason.contains("OUT_OF_MEMORY") {
                return Err(GlError::OutOfMemory { width, height });
            }
            return Err(GlError::Object { what: format!("a {width}x{height} texture"), reason });
        }
        Ok(texture)
    }

    /// Uploads level 0 from tightly packed pixels, with rows from the bottom.
    ///
    /// # Panics
    /// If `bytes` does not have [`Texture::byte_len`] bytes.
    pub fn upload(&self, bytes: &[u8]) {
        self.upload_level(0, bytes);
    }

    /// Uploads a mip level, which has half the size of the one before, rounded down, from tightly packed pixels, with
    /// rows from the bottom.
    ///
    /// # Panics
    /// If `bytes` does not have the level's size.
    pub fn upload_level(&self, level: u32, bytes: &[u8]) {
        let (_, format, ty) = self.format.gl();
        let [w, h] = self.size.map(|n| (n >> level).max(1));
        assert_eq!(bytes.len(), w as usize * h as usize * self.format.bytes(), "upload of the wrong size");
        self.gl.set_tight_unpack();
        // SAFETY: the slice is as long as GL reads.
        unsafe {
            let gl = self.gl.raw();
            gl.bind_texture(glow::TEXTURE_2D, Some(self.raw));
            let data = glow::PixelUnpackData::Slice(Some(bytes));
            gl.tex_sub_image_2d(glow::TEXTURE_2D, level as i32, 0, 0, w as i32, h as i32, format, ty, data);
        }
    }

    /// Computes the other mip levels from level 0.
    pub fn generate_mipmaps(&self) {
        // SAFETY: the texture lives as long as this object.
        unsafe {
            self.gl.raw().bind_texture(glow::TEXTURE_2D, Some(self.raw));
            self.gl.raw().generate_mipmap(glow::TEXTURE_2D);
        }
    }

    /// Returns the number of bytes of level 0.
    pub fn byte_len(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize * self.format.bytes()
    }

    /// Returns its description.
    pub fn image(&self) -> Image {
        Image { format: self.format, size: self.size, samples: 1 }
    }

    /// Returns the GL name and the description, as [`TileTarget::fit`](crate::TileTarget::fit) takes them.
    pub fn attachment(&self) -> (glow::Texture, Image) {
        (self.raw, self.image())
    }

    /// Returns the GL name.
    pub fn raw(&self) -> glow::Texture {
        self.raw
    }

    /// Returns width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the pixel format.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Binds the texture to a texture unit.
    pub fn bind(&self, unit: u32) {
        bind_texture(&self.gl, unit, self.target, self.raw);
    }
}

/// Binds any texture to a unit; `target` must be the texture's own.
pub(crate) fn bind_texture(gl: &Context, unit: u32, target: u32, texture: glow::Texture) {
    // SAFETY: GL refuses a name that is not a texture of this target.
    unsafe {
        gl.raw().active_texture(glow::TEXTURE0 + unit);
        gl.raw().bind_texture(target, Some(texture));
    }
}

impl Context {
    /// True if the bound texture has storage. Asks the texture, to leave a host's pending error alone. In browsers,
    /// where glow cannot ask, it reads the error flag.
    fn has_storage(&self, target: u32) -> bool {
        let gl = self.raw();
        // SAFETY: a parameter of textures that every context has.
        unsafe {
            if cfg!(target_arch = "wasm32") {
                gl.get_error() != glow::OUT_OF_MEMORY
            } else {
                gl.get_tex_parameter_i32(target, glow::TEXTURE_IMMUTABLE_FORMAT) != 0
            }
        }
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        self.gl.deleted_textures.set(self.gl.deleted_textures.get() + 1);
        // SAFETY: created in `new`, deleted once.
        unsafe { self.gl.raw().delete_texture(self.raw) };
        self.gl.count(-1);
        self.gl.count_texture_bytes(-(self.bytes as isize));
    }
}
