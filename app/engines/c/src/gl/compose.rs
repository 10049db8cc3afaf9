//! The composer on OpenGL.

use std::num::NonZeroU32;

use yoro::eyes::Composition;
use yoro::opengl::{Destination, InsetImage, LevelImage, LevelImages, Part};

use super::{Gl, check, enter_gl, texture};
use crate::context::YoroContext;
use crate::levels::YoroComposition;
use crate::result::{Failure, YORO_ERROR_TOO_LARGE, YORO_ERROR_UNSUPPORTED, YoroResult};
use crate::versioned::{self, versioned};

/// The images of an eye's levels, and where its image is drawn. Rows are counted from the bottom.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroGlLevels {
    /// sizeof(YoroGlLevels).
    pub struct_size: u32,
    /// Colour of the wide level: name of a GL_TEXTURE_2D in any filterable format. Of the rendered eye it is the
    /// rendered image, in which the level begins at crop_x and crop_y; of the other, the synthesized one.
    pub wide_texture: u32,
    /// First column of the wide level in its texture.
    pub wide_x: u32,
    /// First row of the wide level in its texture.
    pub wide_y: u32,
    /// Width of the texture in pixels; 0 if the level fills it.
    pub wide_image_width: u32,
    /// Height of the texture in pixels; 0 if the level fills it.
    pub wide_image_height: u32,
    /// Colour of the inset, in the same way; ignored for a composition of one level.
    pub inset_texture: u32,
    /// Depth of the synthesized eye's inset, in a texture of the same size, or 0. With it, holes at the border of what was
    /// rendered show the wide view.
    pub inset_depth_texture: u32,
    /// First column of the inset in its texture.
    pub inset_x: u32,
    /// First row of the inset in its texture.
    pub inset_y: u32,
    /// Width of the texture in pixels; 0 if the inset fills it.
    pub inset_image_width: u32,
    /// Height of the texture in pixels; 0 if the inset fills it.
    pub inset_image_height: u32,
    /// The framebuffer to draw into, or 0 for the window's. Its first colour attachment is written. None of the textures
    /// above may be attached to it.
    pub framebuffer: u32,
    /// First column of the eye's image in the framebuffer.
    pub x: u32,
    /// First row of the eye's image in the framebuffer.
    pub y: u32,
}

versioned!(YoroGlLevels);

/// Composes an eye of its levels into a rectangle of its size, and overwrites all of it: the inset where it covers the eye
/// and has no hole at the border of what was rendered, else the wide view, bilinearly. The context must have been
/// created with `composes`; its warp_kind and sources do not matter.
///
/// Call it on the thread on which the GL context is current. YoroGlInfo says how GL state is treated. It allocates and
/// compiles nothing, and does not wait for the GPU.
///
/// @param context     The context.
/// @param composition The eye's composition, from yoro_levels_from_eyes with YORO_ROWS_UP.
/// @param levels      The images to read and where to draw.
/// @pre As for yoro_gl_synthesize.
/// @return YORO_ERROR_UNSUPPORTED without `composes`, YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE; with `check` also
///         YORO_ERROR_FORMAT and YORO_ERROR_DRIVER; YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL,
///         YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_gl_compose(
    context: *mut YoroContext,
    composition: *const YoroComposition,
    levels: *const YoroGlLevels,
) -> YoroResult {
    // SAFETY: the header requires pointers that are null or point to live objects of their types.
    unsafe {
        enter_gl(context, |gl| {
            let composition = versioned::given(composition)?;
            gl.compose(&composition, &versioned::read(levels, "levels")?)
        })
    }
}

impl Gl {
    fn compose(&mut self, composition: &Composition, levels: &YoroGlLevels) -> Result<(), Failure> {
        let Some(composer) = &self.composer else {
            return Err(Failure::new(
                YORO_ERROR_UNSUPPORTED,
                "the context was made without a composer: set composes of YoroGlInfo to 1",
            ));
        };
        let images = levels.images(composition)?;
        let target = Destination {
            framebuffer: NonZeroU32::new(levels.framebuffer).map(glow::NativeFramebuffer),
            origin: [levels.x, levels.y],
            size: composition.size,
        };
        if self.check {
            check::check_levels(&self.context, composition, &images, &target)?;
        }
        composer.compose(&images, composition, &target);
        self.end_call("yoro_gl_compose")
    }
}

impl YoroGlLevels {
    fn images(&self, composition: &Composition) -> Result<LevelImages, Failure> {
        let origin = [self.wide_x, self.wide_y];
        let image_size = [self.wide_image_width, self.wide_image_height];
        let wide = LevelImage {
            color: texture(self.wide_texture, "wide_texture")?,
            part: part("wide", origin, image_size, composition.wide.size)?,
        };
        let inset = |size| {
            let origin = [self.inset_x, self.inset_y];
            let image_size = [self.inset_image_width, self.inset_image_height];
            let image = LevelImage {
                color: texture(self.inset_texture, "inset_texture")?,
                part: part("inset", origin, image_size, size)?,
            };
            let depth = NonZeroU32::new(self.inset_depth_texture).map(glow::NativeTexture);
            Ok::<_, Failure>(InsetImage { image, depth })
        };
        let inset = composition.inset.map(|place| inset(place.place.size)).transpose()?;
        Ok(LevelImages { wide, inset })
    }
}

/// Returns the part of a texture, or `None` for all of it.
fn part(what: &str, origin: [u32; 2], image_size: [u32; 2], size: [u32; 2]) -> Result<Option<Part>, Failure> {
    let image_size = if image_size == [0, 0] { size } else { image_size };
    if (0..2).any(|i| u64::from(origin[i]) + u64::from(size[i]) > u64::from(image_size[i])) {
        let ([x, y], [w, h], [iw, ih]) = (origin, size, image_size);
        return Err(Failure::new(
            YORO_ERROR_TOO_LARGE,
            format!(
                "the {what} level of {w}x{h} pixels at ({x}, {y}) reaches beyond its texture of {iw}x{ih} pixels"
            ),
        ));
    }
    Ok(Some(Part { origin, image_size }))
}
