//! Writes finished images into the runtime's images without changing their colours.
//!
//! Finished images are display-referred sRGB. The runtime's images should store exactly these values (SRGB8_ALPHA8),
//! but OpenGL ES encodes what is written to such a framebuffer a second time, unless GL_EXT_sRGB_write_control turns
//! this off. Where it does (tested once, for all ways of writing), eyes are drawn directly into the images; elsewhere
//! they are drawn into a target of their own and decoded on the way.

use std::rc::Rc;

use glow::HasContext as _;

use yoro_gl::{
    Context, Destination, Filter, Format, GlError, MultisampleTarget, Program, RasterState, RenderTarget,
    ShaderSource, Texture, TileTarget,
};
use yoro_render::stereo::{EyeTarget, LayerTargets, StereoFrame};

/// Formats of eye images, best first: stored as sRGB, with enough bits for linear colour, or neither.
pub(super) const COLOR_FORMATS: [u32; 4] = [glow::SRGB8_ALPHA8, glow::RGBA16F, glow::RGB10_A2, glow::RGBA8];
/// Formats of depth images, best first: 24 bits or floats, or else 16 bits.
pub(super) const DEPTH_FORMATS: [u32; 5] = [
    glow::DEPTH_COMPONENT24,
    glow::DEPTH24_STENCIL8,
    glow::DEPTH_COMPONENT32F,
    glow::DEPTH32F_STENCIL8,
    glow::DEPTH_COMPONENT16,
];

/// Returns the name of a GL format.
pub(super) fn format_name(format: u32) -> String {
    let name = match format {
        glow::SRGB8_ALPHA8 => "SRGB8_ALPHA8",
        glow::RGBA16F => "RGBA16F",
        glow::RGB10_A2 => "RGB10_A2",
        glow::RGBA8 => "RGBA8",
        glow::DEPTH_COMPONENT24 => "DEPTH_COMPONENT24",
        glow::DEPTH24_STENCIL8 => "DEPTH24_STENCIL8",
        glow::DEPTH_COMPONENT32F => "DEPTH_COMPONENT32F",
        glow::DEPTH32F_STENCIL8 => "DEPTH32F_STENCIL8",
        glow::DEPTH_COMPONENT16 => "DEPTH_COMPONENT16",
        other => return format!("0x{other:x}"),
    };
    name.into()
}

/// Returns the first of `wanted` that is in `offered`.
pub(super) fn choose(wanted: &[u32], offered: &[u32]) -> Option<u32> {
    wanted.iter().copied().find(|format| offered.contains(format))
}

/// True if the driver can turn off the encoding of what is written to sRGB framebuffers.
fn has_control(gl: &Context) -> bool {
    gl.raw().supported_extensions().contains("GL_EXT_sRGB_write_control")
}

/// Turns encoding on, which is OpenGL ES's default, or off. Requires [`has_control`].
fn set_encoding(gl: &Context, on: bool) {
    // SAFETY: the enum is valid with the extension.
    unsafe {
        if on { gl.raw().enable(glow::FRAMEBUFFER_SRGB) } else { gl.raw().disable(glow::FRAMEBUFFER_SRGB) }
    }
}

/// How the eyes get into the runtime's images.
pub(super) struct Storage {
    gl: Rc<Context>,
    /// The targets into which the wide eyes and the insets are drawn first, and the pass that decodes them; `None` if they
    /// are drawn directly.
    detour: Option<([StereoFrame; 2], Program)>,
}

impl Storage {
    /// Chooses how eyes are written into images of `format`.
    pub fn new(gl: &Rc<Context>, format: u32) -> Result<Storage, GlError> {
        let is_direct = format == glow::SRGB8_ALPHA8 && has_control(gl) && stores_as_written(gl)?;
        Storage::by(gl, is_direct)
    }

    fn by(gl: &Rc<Context>, is_direct: bool) -> Result<Storage, GlError> {
        let detour = (!is_direct).then(|| -> Result<_, GlError> {
            let program = Program::new(gl, ShaderSource::Screen("openxr/transfer.frag"), &[])?;
            Ok(([StereoFrame::new(gl, [1, 1])?, StereoFrame::new(gl, [1, 1])?], program))
        });
        Ok(Storage { gl: gl.clone(), detour: detour.transpose()? })
    }

    /// True if eyes are drawn straight into the runtime's images.
    pub fn is_direct(&self) -> bool {
        self.detour.is_none()
    }

    /// Begins a frame. Returns the targets for eyes that are to end up in `images`.
    pub fn begin(&mut self, images: LayerTargets<'static>) -> Result<LayerTargets<'static>, GlError> {
        match &mut self.detour {
            None => {
                set_encoding(&self.gl, false);
                Ok(images)
            }
            Some((frames, _)) => {
                for (frame, images) in frames.iter_mut().zip(images.layers()) {
                    frame.resize(images[0].color.size)?;
                }
                let [wide, inset] = frames.each_ref().map(StereoFrame::targets);
                Ok(LayerTargets { wide, inset: images.inset.map(|_| inset) })
            }
        }
    }

    /// Ends a frame.
    pub fn end(&self, images: &LayerTargets) {
        let Some((frames, program)) = &self.detour else {
            set_encoding(&self.gl, true);
            return;
        };
        let mut pass = self.gl.pass("transfer");
        for (frame, images) in frames.iter().zip(images.layers()) {
            for (eye, EyeTarget { color: to, .. }) in yoro::eyes::Eye::BOTH.into_iter().zip(images) {
                pass = pass.read("source", frame.eye(eye).color(0)).write([to.image(Format::Srgb8Alpha8)]);
            }
        }
        pass.run(|| {
            // Synthesis turns encoding off.
            if has_control(&self.gl) {
                set_encoding(&self.gl, true);
            }
            self.gl.set_raster_state(&RasterState::SCREEN);
            for (frame, images) in frames.iter().zip(images.layers()) {
                for (eye, EyeTarget { color: to, .. }) in yoro::eyes::Eye::BOTH.into_iter().zip(images) {
                    self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
                    program.bind().texture_of("source", 0, frame.eye(eye).color(0));
                    self.gl.draw_screen();
                }
            }
        });
    }
}

/// Tests whether an sRGB framebuffer keeps the bits of what is drawn, cleared, copied and averaged into it while
/// encoding is off. Drivers may refuse to average samples of another format into it.
fn stores_as_written(gl: &Rc<Context>) -> Result<bool, GlError> {
    const SIZE: [u32; 2] = [4, 4];
    const SAMPLES: u32 = 4;
    const GREY: [f32; 4] = [100.0 / 255.0, 100.0 / 255.0, 100.0 / 255.0, 1.0];
    let target = |format| RenderTarget::new(gl, SIZE, &[(format, Filter::Nearest)], None);
    let (plain, first, second) =
        (target(Format::Rgba8)?, target(Format::Srgb8Alpha8)?, target(Format::Srgb8Alpha8)?);
    let draw = Program::new(gl, ShaderSource::Screen("viewer/hud.frag"), &[])?;
    let is_grey = |target: &RenderTarget| {
        let pixels = target.read_rgba8(0, [0, 0], SIZE);
        pixels.chunks_exact(4).all(|p| p[..3].iter().all(|c| c.abs_diff(100) <= 1))
    };
    set_encoding(gl, false);
    plain.bind();
    gl.fill([0, 0], SIZE, GREY);
    first.bind();
    gl.fill([0, 0], SIZE, GREY);
    let mut fine = is_grey(&first);
    gl.copy(&Destination::whole(&plain), &Destination::whole(&second));
    fine &= is_grey(&second);
    gl.copy(&Destination::whole(&second), &Destination::whole(&first));
    fine &= is_grey(&first);
    gl.set_raster_state(&RasterState::SCREEN);
    second.bind();
    gl.fill([0, 0], SIZE, [0.0; 4]);
    // The panel's shader shows its texture's red channel as grey.
    draw.bind()
        .texture_of("panel", 0, plain.color(0))
        .set("rectangle", glam::Vec4::new(0.0, 0.0, 4.0, 4.0))
        .set("used", 1.0);
    gl.draw_screen();
    fine &= is_grey(&second);
    let empty = || {
        second.bind();
        gl.fill([0, 0], SIZE, [0.0; 4]);
    };
    if gl.capabilities().check_samples(SAMPLES).is_ok() {
        let samples = MultisampleTarget::new(gl, SIZE, SAMPLES, &[Format::Rgba8], Format::Depth32F, false)?;
        empty();
        samples.bind(SIZE);
        gl.fill([0, 0], SIZE, GREY);
        samples.average(0, &Destination::whole(&second));
        fine &= gl.take_errors().is_none() && is_grey(&second);
    }
    if gl.capabilities().tile_samples {
        let (mut tile, depth) =
            (TileTarget::new(gl, SAMPLES)?, Texture::new(gl, SIZE, Format::Depth32F, Filter::Nearest)?);
        let color = second.color(0).attachment();
        empty();
        // SAFETY: the colour is a 2-D texture of this context.
        if unsafe { tile.fit(&[color], &depth) }.is_ok() {
            let to = tile.part(SIZE);
            gl.bind_framebuffer(to.framebuffer, to.origin, SIZE);
            gl.fill([0, 0], SIZE, GREY);
            fine &= is_grey(&second);
        }
    }
    set_encoding(gl, true);
    Ok(fine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::Eye;
    use yoro_context::{Backend, Headless};

    /// Both ways give the same bits, in sRGB and in other framebuffers.
    #[test]
    fn colours_reach_the_runtime_unchanged() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let objects = gl.object_count();
        let size = [64, 4];
        for is_direct in [true, false] {
            if is_direct && !Storage::new(gl, glow::SRGB8_ALPHA8).unwrap().is_direct() {
                eprintln!("SKIPPED: this driver always encodes");
                continue;
            }
            let mut storage = Storage::by(gl, is_direct).unwrap();
            let image = || RenderTarget::new(gl, size, &[(Format::Srgb8Alpha8, Filter::Nearest)], None);
            let images = [image().unwrap(), image().unwrap()];
            let to = images.each_ref().map(|image| EyeTarget::rectangle(Destination::whole(image)));
            let eyes = storage.begin(LayerTargets { wide: to, inset: None }).unwrap().wide;
            for x in 0..64u32 {
                for (eye, EyeTarget { color, .. }) in Eye::BOTH.into_iter().zip(eyes) {
                    gl.bind_framebuffer(color.framebuffer, color.origin, color.size);
                    let grey = (x * 4 + eye.index() as u32) as f32 / 255.0;
                    gl.fill([x, 0], [1, 4], [grey, grey, grey, 1.0]);
                }
            }
            storage.end(&LayerTargets { wide: to, inset: None });
            for eye in Eye::BOTH {
                let row = images[eye.index()].read_rgba8(0, [0, 1], [64, 1]);
                for (x, pixel) in row.chunks_exact(4).enumerate() {
                    let expected = (x * 4 + eye.index()) as u8;
                    assert!(
                        pixel[0].abs_diff(expected) <= 1,
                        "direct {is_direct}: {} for {expected}",
                        pixel[0]
                    );
                }
            }
        }
        assert_eq!((gl.object_count(), gl.take_errors()), (objects, None));
    }

    #[test]
    fn the_best_format_is_chosen() {
        assert_eq!(choose(&COLOR_FORMATS, &[glow::RGBA8, glow::SRGB8_ALPHA8]), Some(glow::SRGB8_ALPHA8));
        assert_eq!(choose(&DEPTH_FORMATS, &[glow::RGBA8]), None);
    }
}
