//! Nearest depth where the graphics interface resolves only one sample's.

use std::rc::Rc;

use yoro_gl::{Context, Format, GlError, Image, Program, RenderTarget, ShaderSource};

use super::pipeline::preserving;
use super::{Destination, Options, Outputs, Source};
use crate::eyes::Warp;
use crate::synthesis::Uniforms;

/// Guesses each pixel's nearest depth from colour that was resolved from samples, and depth that is one sample's.
///
/// Where multisampled depth can be read, its nearest sample is exact, and better: this is for OpenGL ES 3.0 and WebGL 2,
/// whose `glBlitFramebuffer` resolves one sample of depth. A pixel takes the depth of a neighbour that is nearer by more
/// than half a pixel of disparity if the pixel's colour lies more than 15 % of the way to the nearer surface's. It
/// changes the state that [`Pipeline`](super::Pipeline) lists, or none with [`GlState::Preserve`](super::GlState).
pub struct GuessedDepth {
    gl: Rc<Context>,
    options: Options,
    program: Program,
    target: RenderTarget,
}

impl GuessedDepth {
    /// Compiles the pass for sources of the same kind as those of a pipeline with these options.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for layers of array textures; [`GlError::Shader`] if the driver refuses the shader.
    pub fn new(gl: &Rc<Context>, options: &Options) -> Result<GuessedDepth, GlError> {
        if options.array_textures {
            return Err(GlError::Unsupported(
                "nearest depth is not guessed for layers of array textures".into(),
            ));
        }
        preserving(gl, options, Outputs::default(), || {
            let screen = ShaderSource::Screen("synthesis/guessed_depth.frag");
            Ok(GuessedDepth {
                gl: gl.clone(),
                options: *options,
                program: Program::new(gl, screen, &options.defines())?,
                target: RenderTarget::new(gl, [1, 1], &[], Some(Format::Depth24))?,
            })
        })
    }

    /// Guesses the nearest depth, and returns the source with it in place of its own: a 24-bit texture of the same size
    /// as the source's, in which the source has the same place. It is valid until the next call.
    ///
    /// # Errors
    /// [`GlError`] if the size is beyond the driver's limits.
    pub fn guess(&mut self, source: Source, warp: &Warp) -> Result<Source, GlError> {
        let gl = self.gl.clone();
        let options = self.options;
        preserving(&gl, &options, Outputs::default(), || {
            gl.set_first_unit();
            let whole = Destination { framebuffer: None, origin: [0, 0], size: warp.source_size };
            let places = source.places(warp.source_size, &whole, options.parts);
            self.target.resize(places.image_size)?;
            gl.begin_synthesis(1, false);
            let [depth, color] = options.source_images(warp.source_size);
            let pass = gl.pass("guessed depth").read("depth_map", depth).read("color_map", color);
            pass.write([Image { format: Format::Depth24, ..depth }]).run(|| {
                let place = Destination {
                    origin: places.source_origin,
                    size: warp.source_size,
                    ..self.target.depth_only()
                };
                gl.overwrite(&place, 0, true);
                gl.set_depth_write(true);
                options.bind_source(self.program.bind(), source);
                Uniforms::of_part(warp, &places).set(&self.program);
                gl.draw_screen();
                gl.set_depth_write(false);
            });
            gl.end_synthesis();
            Ok(Source { depth: self.target.depth().raw(), ..source })
        })
    }
}
