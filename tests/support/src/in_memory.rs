//! Synthesis of images in memory: upload, run, read back.

use std::rc::Rc;

use yoro::eyes::Warp;
use yoro::opengl::{Destination, GlError, Outputs, Source};
use yoro::synthesis::Holes;
use yoro_gl::{Context, Filter, Format, RenderTarget, Texture};

/// The outputs of the pipelines here.
pub const OUTPUTS: Outputs = Outputs { depth: false, source_map: true, srgb: false, holes: Holes::Filled };

/// What a pipeline does.
pub type Synthesize = Box<dyn FnMut(Source, &Warp, &Destination) -> Result<(), GlError>>;

/// A pipeline with its own textures. Rows of all arrays run from the bottom, as in GL.
pub struct InMemory {
    gl: Rc<Context>,
    synthesize: Synthesize,
    target: RenderTarget,
}

/// The synthesized eye.
#[derive(Clone, Debug, PartialEq)]
pub struct SynthesizedImage {
    /// RGBA, 8 bits each.
    pub rgba: Vec<u8>,
    pub source_map: Vec<u32>,
}

impl InMemory {
    /// Wraps a pipeline with [`OUTPUTS`].
    pub fn new(gl: &Rc<Context>, synthesize: Synthesize) -> InMemory {
        let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
        let target = RenderTarget::new(gl, [1, 1], &formats, None).unwrap();
        InMemory { gl: gl.clone(), synthesize, target }
    }

    /// Synthesizes one image from four colour bytes and one depth value per pixel.
    pub fn run(&mut self, rgba: &[u8], depth: &[f32], warp: &Warp) -> SynthesizedImage {
        let texture = |format, filter, bytes: &[u8]| {
            let texture = Texture::new(&self.gl, warp.source_size, format, filter).unwrap();
            texture.upload(bytes);
            texture
        };
        let depth: Vec<u8> = depth.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        let color = texture(Format::Rgba8, Filter::Linear, rgba);
        let depth = texture(Format::R32F, Filter::Nearest, &depth);
        self.target.resize(warp.target_size).unwrap();
        let source = Source::new(color.raw(), depth.raw());
        (self.synthesize)(source, warp, &Destination::whole(&self.target)).unwrap();
        SynthesizedImage {
            rgba: self.target.read_rgba8(0, [0, 0], warp.target_size),
            source_map: self.target.read_u32(1, [0, 0], warp.target_size),
        }
    }
}
