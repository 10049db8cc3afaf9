//! Synthesis of images in memory: upload, run, read back.

use std::rc::Rc;

use yoro::eyes::Warp;
use yoro::synthesis::{History, Outputs, Source, Strips, Synthesis};
use yoro_gl::{Context, Destination, Filter, Format, RenderTarget, Texture};

/// The outputs of the pipelines here.
pub const OUTPUTS: Outputs = Outputs { depth: false, source_map: true, srgb: false };

/// A pipeline with its own textures. Rows of all arrays run from the bottom, as in GL.
pub struct InMemory {
    gl: Rc<Context>,
    pipeline: Box<dyn Synthesis>,
    target: RenderTarget,
}

/// A history in memory, and its relation to the target.
#[derive(Clone, Copy)]
pub struct Former<'a> {
    pub rgba: &'a [u8],
    pub depth: &'a [f32],
    pub size: [u32; 2],
    pub strips: Strips,
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
    pub fn new(gl: &Rc<Context>, pipeline: Box<dyn Synthesis>) -> InMemory {
        let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
        let target = RenderTarget::new(gl, [1, 1], &formats, None).unwrap();
        InMemory { gl: gl.clone(), pipeline, target }
    }

    /// Synthesizes one image from four colour bytes and one depth value per pixel.
    pub fn run(&mut self, rgba: &[u8], depth: &[f32], warp: &Warp) -> SynthesizedImage {
        self.recall(rgba, depth, warp, None)
    }

    /// Does the same with a history, for a pipeline that takes one.
    pub fn recall(
        &mut self,
        rgba: &[u8],
        depth: &[f32],
        warp: &Warp,
        history: Option<Former>,
    ) -> SynthesizedImage {
        let texture = |size, format, filter, bytes: &[u8]| {
            let texture = Texture::new(&self.gl, size, format, filter).unwrap();
            texture.upload(bytes);
            texture
        };
        let upload = |size, rgba, depth: &[f32]| {
            let depth: Vec<u8> = depth.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
            [
                texture(size, Format::Rgba8, Filter::Linear, rgba),
                texture(size, Format::R32F, Filter::Nearest, &depth),
            ]
        };
        let [color, depth] = upload(warp.source_size, rgba, depth);
        let former = history.map(|former| (upload(former.size, former.rgba, former.depth), former.strips));
        self.target.resize(warp.target_size).unwrap();
        let history = former.as_ref().map(|([color, depth], strips)| History {
            color: color.raw(),
            depth: depth.raw(),
            strips: *strips,
        });
        let source = Source { history, ..Source::new(color.raw(), depth.raw()) };
        self.pipeline.synthesize(source, warp, &Destination::whole(&self.target)).unwrap();
        SynthesizedImage {
            rgba: self.target.read_rgba8(0, [0, 0], warp.target_size),
            source_map: self.target.read_u32(1, [0, 0], warp.target_size),
        }
    }
}
