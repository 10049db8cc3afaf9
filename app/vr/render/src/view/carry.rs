//! Carries the depth of two samples through the average that a driver makes of a pixel's samples.
//!
//! A second colour holds reversed depth, times the number of samples, in every sample. Before the samples are averaged,
//! all but the leftmost one are cleared in red, and all but the rightmost one in green. An average of one value and zeros
//! is that value, exactly: the larger of the two channels is the depth of the nearer of two samples. This needs neither
//! a resolve of depth nor a shader that sees other samples, so that no sample leaves the tile.

use std::rc::Rc;

use yoro_gl::{
    Blend, Context, Destination, Filter, Format, GlError, MultisampleTarget, Program, RasterState,
    RenderTarget, ShaderSource,
};

use super::settings::SAMPLE_DEPTH;

/// Clears the samples that are not carried.
pub struct CarryPass {
    gl: Rc<Context>,
    program: Program,
    samples: u32,
}

impl CarryPass {
    /// Compiles the pass, and tries it. `None` if the driver does not carry what it should.
    pub fn new(gl: &Rc<Context>, samples: u32) -> Result<Option<CarryPass>, GlError> {
        let program = Program::new(gl, ShaderSource::Screen("render/keep_sample.frag"), &[])?;
        let pass = CarryPass { gl: gl.clone(), program, samples };
        Ok(pass.works().unwrap_or(false).then_some(pass))
    }

    /// Clears the samples in the bound framebuffer, which must have two colours and this many samples.
    pub fn run(&self) {
        let [left, right] = self.gl.outermost_samples(self.samples);
        self.gl.set_raster_state(&RasterState { blend: Blend::Over, ..RasterState::SCREEN });
        self.program.bind();
        for (kept, channel) in [(left, 0), (right, 1)] {
            self.gl.mask_colors([channel == 0, channel == 1, false, false]);
            self.gl.mask_samples(Some(!(1 << kept)));
            self.gl.draw_screen();
        }
        self.gl.mask_samples(None);
        self.gl.set_raster_state(&RasterState::SCREEN);
    }

    /// True if a known value survives in both channels.
    fn works(&self) -> Result<bool, GlError> {
        const SIZE: [u32; 2] = [4, 4];
        let formats = [Format::Rgba8, Format::Rg16F];
        let samples = MultisampleTarget::new(&self.gl, SIZE, self.samples, &formats, SAMPLE_DEPTH, false)?;
        let pair = RenderTarget::new(&self.gl, SIZE, &[(Format::Rg16F, Filter::Nearest)], None)?;
        samples.bind(SIZE);
        self.gl.clear(Some(0.0));
        let value = 0.375;
        self.gl.fill([0, 0], SIZE, [self.samples as f32 * value; 4]);
        samples.bind(SIZE);
        self.run();
        samples.average(1, &Destination::whole(&pair));
        samples.discard(true, true);
        let texels = pair.read_rgba32f(0, [0, 0], SIZE);
        Ok(texels.iter().all(|texel| texel[..2] == [value; 2]))
    }
}
