//! Checks of the caller's textures and framebuffer, for development. GL itself does not report most mistakes.

use std::num::NonZeroU32;

use glow::HasContext;
use yoro::eyes::Composition;
use yoro::opengl::{Context, Destination, LevelImages, Options, Outputs, Source};

use crate::result::{Failure, YORO_ERROR_DRIVER, YORO_ERROR_FORMAT};

/// Checks that the textures and the framebuffer are as [`YoroGlImages`](super::YoroGlImages) says. Restores all
/// bindings.
pub(super) fn check_images(
    context: &Context,
    options: &Options,
    outputs: Outputs,
    source: Source,
    size: [u32; 2],
    target: &Destination,
) -> Result<(), Failure> {
    check_pending(context)?;
    let size = source.part.map_or(size, |part| part.image_size);
    let kind = if options.array_textures { &ARRAY } else { &SINGLE };
    let is_here = |level: &Level| !options.array_textures || source.layer < level.layers;
    check_texture(context, source.color, "color_texture", kind, size, |level| {
        level.is_color() && is_here(level)
    })?;
    check_texture(context, source.depth, "depth_texture", kind, size, |level| {
        level.is_depth() && is_here(level)
    })?;
    let textures = [(source.color, "color_texture"), (source.depth, "depth_texture")];
    check_framebuffer(context, outputs, &textures, target)
}

/// Checks that the textures and the framebuffer are as [`YoroGlLevels`](super::YoroGlLevels) says. Restores all
/// bindings.
pub(super) fn check_levels(
    context: &Context,
    composition: &Composition,
    images: &LevelImages,
    target: &Destination,
) -> Result<(), Failure> {
    check_pending(context)?;
    let mut textures = vec![(images.wide.color, "wide_texture", images.wide.part, composition.wide.size)];
    if let Some((place, inset)) = composition.inset.zip(images.inset) {
        let (part, size) = (inset.image.part, place.place.size);
        textures.push((inset.image.color, "inset_texture", part, size));
        textures.extend(inset.depth.map(|depth| (depth, "inset_depth_texture", part, size)));
    }
    for &(texture, what, part, size) in &textures {
        let size = part.map_or(size, |part| part.image_size);
        let is_depth = what == "inset_depth_texture";
        let fits = |level: &Level| if is_depth { level.is_depth() } else { level.is_color() };
        check_texture(context, texture, what, &SINGLE, size, fits)?;
    }
    let textures: Vec<_> = textures.into_iter().map(|(texture, what, ..)| (texture, what)).collect();
    check_framebuffer(context, Outputs::default(), &textures, target)
}

/// Checks that no errors are pending: those from before the call are not caused by it.
fn check_pending(context: &Context) -> Result<(), Failure> {
    context.take_errors().map_or(Ok(()), |errors| {
        Err(Failure::new(
            YORO_ERROR_DRIVER,
            format!("GL already has errors from before the call ({errors}): look for them in the engine"),
        ))
    })
}

fn wrong(sentence: impl Into<String>) -> Failure {
    Failure::new(YORO_ERROR_FORMAT, sentence.into())
}

fn check_framebuffer(
    context: &Context,
    outputs: Outputs,
    textures: &[(glow::Texture, &str)],
    target: &Destination,
) -> Result<(), Failure> {
    let Some(framebuffer) = Framebuffer::query(context, target.framebuffer) else {
        return Err(wrong("framebuffer is not the name of a framebuffer of this GL context"));
    };
    if framebuffer.status != glow::FRAMEBUFFER_COMPLETE {
        let status = framebuffer.status;
        return Err(wrong(format!(
            "the framebuffer is incomplete (GL says 0x{status:04x}): check its attachments"
        )));
    }
    if outputs.depth && framebuffer.depth == Attachment::None {
        return Err(wrong("the framebuffer has no depth attachment, which YORO_OUTPUT_DEPTH writes"));
    }
    if outputs.holes.is_open() && framebuffer.depth == Attachment::None {
        return Err(wrong("the framebuffer has no depth attachment, which tells open pixels from others"));
    }
    for &(texture, what) in textures {
        if [framebuffer.color, framebuffer.depth].contains(&Attachment::Texture(texture)) {
            return Err(wrong(format!(
                "{what} is attached to the framebuffer, but an image cannot be read and drawn at once: give the \
                 framebuffer textures of its own"
            )));
        }
    }
    let [right, top] = [0, 1].map(|i| target.origin[i].saturating_add(target.size[i]));
    let level = match framebuffer.color {
        Attachment::Texture(texture) => Level::query(context, texture, &SINGLE),
        _ => None,
    };
    let [width, height] = level.map_or([0, 0], |level| level.size);
    if width > 0 && (right > width || top > height) {
        return Err(wrong(format!(
            "the rectangle ends at column {right} and row {top}, beyond the framebuffer's {width}x{height} pixels: give \
             smaller x and y"
        )));
    }
    Ok(())
}

#[derive(Clone, Copy, PartialEq)]
enum Attachment {
    None,
    Texture(glow::NativeTexture),
    Other,
}

struct Framebuffer {
    status: u32,
    color: Attachment,
    depth: Attachment,
}

impl Framebuffer {
    /// Returns `None` if the context has no such framebuffer.
    fn query(context: &Context, name: Option<glow::NativeFramebuffer>) -> Option<Framebuffer> {
        let gl = context.raw();
        // SAFETY: queries and bindings of the current context. GL reports an unknown name as an error, which is taken.
        unsafe {
            let bound = gl.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, name);
            let is_known = context.take_errors().is_none();
            let status = gl.check_framebuffer_status(glow::DRAW_FRAMEBUFFER);
            let attachment = |attachment| {
                // The window's framebuffer has attachments of other names, none of which is a texture.
                if name.is_none() {
                    return Attachment::Other;
                }
                let query = |what| {
                    gl.get_framebuffer_attachment_parameter_i32(glow::DRAW_FRAMEBUFFER, attachment, what)
                        as u32
                };
                match query(glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) {
                    glow::NONE => Attachment::None,
                    glow::TEXTURE => NonZeroU32::new(query(glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME))
                        .map_or(Attachment::Other, |name| Attachment::Texture(glow::NativeTexture(name))),
                    _ => Attachment::Other,
                }
            };
            let (color, depth) = (attachment(glow::COLOR_ATTACHMENT0), attachment(glow::DEPTH_ATTACHMENT));
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, bound);
            is_known.then_some(Framebuffer { status, color, depth })
        }
    }
}

fn check_texture(
    context: &Context,
    texture: glow::Texture,
    what: &str,
    kind: &TextureKind,
    size: [u32; 2],
    fits: impl FnOnce(&Level) -> bool,
) -> Result<(), Failure> {
    // Textures and renderbuffers have the same names, so that a renderbuffer's is often that of some other texture.
    // SAFETY: a query of the current context.
    let is_renderbuffer = unsafe { context.raw().is_renderbuffer(glow::NativeRenderbuffer(texture.0)) };
    let wrong = |sentence: String| match is_renderbuffer {
        true => wrong(format!(
            "{sentence}; {} is also a renderbuffer, which cannot be read: give a texture",
            texture.0
        )),
        false => wrong(sentence),
    };
    // SAFETY: as above.
    if !unsafe { context.raw().is_texture(texture) } {
        return Err(wrong(format!("{what} is {}, which is not a texture of this GL context", texture.0)));
    }
    let Some(level) = Level::query(context, texture, kind) else {
        return Err(wrong(format!("{what} is not a {}", kind.remedy)));
    };
    if level.is_known && level.size != size {
        let ([w, h], [x, y]) = (level.size, size);
        let remedy = match level_of(what) {
            Some(name) => format!("give the texture's size as {name}_image_width and {name}_image_height"),
            None => "render YoroViews.source, or give the textures' size as a part's".to_owned(),
        };
        return Err(wrong(format!("{what} has {w}x{h} pixels in place of {x}x{y}: {remedy}")));
    }
    if level.is_known && !fits(&level) {
        let structure = if level_of(what).is_some() { "YoroGlLevels" } else { "YoroGlImages" };
        return Err(wrong(format!(
            "{what} has a format or a number of layers that cannot be used here: see {structure}"
        )));
    }
    Ok(())
}

/// Returns the level, wide or inset, whose texture has this name in `YoroGlLevels`; `None` for the names of `YoroGlImages`.
fn level_of(what: &str) -> Option<&str> {
    what.split_once('_').map(|(level, _)| level).filter(|level| ["wide", "inset"].contains(level))
}

struct TextureKind {
    target: u32,
    binding: u32,
    /// The name of the target, and the remedy for a texture of another target.
    remedy: &'static str,
}

const SINGLE: TextureKind = TextureKind {
    target: glow::TEXTURE_2D,
    binding: glow::TEXTURE_BINDING_2D,
    remedy: "GL_TEXTURE_2D: give one layer without samples",
};
const ARRAY: TextureKind = TextureKind {
    target: glow::TEXTURE_2D_ARRAY,
    binding: glow::TEXTURE_BINDING_2D_ARRAY,
    remedy: "GL_TEXTURE_2D_ARRAY: give one, or no YORO_GL_SOURCE_LAYERS",
};

/// The first mip level of a texture.
struct Level {
    /// False where the driver cannot be queried (before OpenGL ES 3.1). All numbers are 0 then.
    is_known: bool,
    /// Width and height in pixels.
    size: [u32; 2],
    /// The layers of an array.
    layers: u32,
    /// The type of the colour components, such as GL_FLOAT; 0 for depth.
    color_type: u32,
    /// Bits of the red component.
    red: i32,
    /// Bits of the depth component.
    depth: i32,
}

impl Level {
    /// Returns `None` for a texture of another target.
    fn query(context: &Context, texture: glow::Texture, kind: &TextureKind) -> Option<Level> {
        let gl = context.raw();
        // SAFETY: queries and bindings of the current context. GL reports a texture of another target as an error,
        // which is taken.
        unsafe {
            let bound = gl.get_parameter_texture(kind.binding);
            gl.bind_texture(kind.target, Some(texture));
            let fits = context.take_errors().is_none();
            let is_known = fits && context.capabilities().compute;
            let query =
                |name| if is_known { gl.get_tex_level_parameter_i32(kind.target, 0, name) } else { 0 };
            let level = Level {
                is_known,
                size: [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| query(name) as u32),
                layers: query(glow::TEXTURE_DEPTH) as u32,
                color_type: query(glow::TEXTURE_RED_TYPE) as u32,
                red: query(glow::TEXTURE_RED_SIZE),
                depth: query(glow::TEXTURE_DEPTH_SIZE),
            };
            gl.bind_texture(kind.target, bound);
            fits.then_some(level)
        }
    }

    fn is_color(&self) -> bool {
        self.depth == 0 && self.color_type != glow::INT && self.color_type != glow::UNSIGNED_INT
    }

    fn is_depth(&self) -> bool {
        // R16 (GL_EXT_texture_norm16) has the precision of 16-bit depth. Eight bits are too few for depth.
        self.depth > 0
            || self.color_type == glow::FLOAT
            || (self.color_type == glow::UNSIGNED_NORMALIZED && self.red == 16)
    }
}
