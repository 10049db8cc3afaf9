//! Synthesis of images in memory: upload, run, read back.

use std::rc::Rc;

use super::options::PipelineOptions;
use super::pipeline::Synthesis;
use yoro::eyes::Warp;
use yoro::opengl::{Outputs, Source};
use yoro_gl::{Context, Destination, Filter, Format, GlError, RenderTarget, Texture};

/// A pipeline with its own textures. In all arrays rows run from the bottom, as in GL. The result does not depend on
/// the state of the context.
pub struct Offline {
    gl: Rc<Context>,
    pipeline: Box<dyn Synthesis>,
    color: Option<Texture>,
    depth: Option<Texture>,
    target: RenderTarget,
}

/// The result of [`Offline::run`].
#[derive(Clone, Debug, PartialEq)]
pub struct SynthesizedImage {
    /// RGBA, 8 bits each, of the target's size.
    pub rgba: Vec<u8>,
    /// Source map; see [`Outputs::source_map`].
    pub source_map: Vec<u32>,
}

impl Offline {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// As [`PipelineOptions::create`].
    pub fn new(gl: &Rc<Context>, options: &PipelineOptions) -> Result<Offline, GlError> {
        let outputs = Outputs { source_map: true, ..Outputs::default() };
        let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
        Ok(Offline {
            gl: gl.clone(),
            pipeline: options.create(gl, outputs)?,
            color: None,
            depth: None,
            target: RenderTarget::new(gl, [1, 1], &formats, None)?,
        })
    }

    /// Synthesizes one image. `rgba` has 4 bytes and `depth` one value for each pixel of [`Warp::source_size`].
    ///
    /// # Errors
    /// [`GlError::TooLarge`] for images beyond the driver's limit.
    pub fn run(&mut self, rgba: &[u8], depth: &[f32], warp: &Warp) -> Result<SynthesizedImage, GlError> {
        let size = warp.source_size;
        let color = upload(&self.gl, &mut self.color, size, Format::Rgba8, Filter::Linear, rgba)?;
        let depth = bytemuck::cast_slice(depth);
        let depth = upload(&self.gl, &mut self.depth, size, Format::R32F, Filter::Nearest, depth)?;
        let source = Source::new(color, depth);
        self.target.resize(warp.target_size)?;
        let target = Destination::whole(&self.target);
        self.pipeline.synthesize(source, warp, &target)?;
        Ok(SynthesizedImage {
            rgba: self.target.read_rgba8(0, [0, 0], warp.target_size),
            source_map: self.target.read_u32(1, [0, 0], warp.target_size),
        })
    }
}

fn upload(
    gl: &Rc<Context>,
    slot: &mut Option<Texture>,
    size: [u32; 2],
    format: Format,
    filter: Filter,
    bytes: &[u8],
) -> Result<glow::Texture, GlError> {
    let texture = match slot.take() {
        Some(texture) if texture.size() == size => texture,
        _ => Texture::new(gl, size, format, filter)?,
    };
    texture.upload(bytes);
    Ok(slot.insert(texture).raw())
}
