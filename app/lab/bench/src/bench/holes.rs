//! Disocclusions: pixels of the other eye that the dominant eye does not show.

use std::rc::Rc;

use yoro::eyes::{EyePair, GuardBand};
use yoro::opengl::{Gather, Options, Outputs};
use yoro::synthesis::{HoleMark, Holes, SOURCE_MAP_HOLE};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource,
    StencilTest,
};
use yoro_render::stereo::{StereoError, StereoOptions};
use yoro_render::{PreparedScene, ViewTargets};

/// Finds holes from the depth of the dominant eye's own image, without a guard band. The mask is the same for all
/// contenders, whatever they do about holes. It includes the outer border.
pub struct HoleFinder {
    targets: ViewTargets,
    synthesis: Gather,
    map: RenderTarget,
}

impl HoleFinder {
    /// Compiles the default synthesis, whose source map marks holes.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target.
    pub fn new(gl: &Rc<Context>) -> Result<HoleFinder, GlError> {
        let outputs = Outputs { source_map: true, ..Outputs::default() };
        let formats = [(Format::Rgba8, Filter::Nearest), (Format::R32Ui, Filter::Nearest)];
        Ok(HoleFinder {
            targets: ViewTargets::default(),
            synthesis: Gather::new(gl, &Options::default(), outputs)?,
            map: RenderTarget::new(gl, [1, 1], &formats, None)?,
        })
    }

    /// Returns the holes of the eye that is not dominant, row by row from the top.
    ///
    /// # Errors
    /// [`StereoError`] for eyes that cannot be synthesized, or if GL refuses.
    pub fn find(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> Result<Vec<bool>, StereoError> {
        let views = pair.synthesis_views(GuardBand::None)?;
        prepared.synthesize(&mut self.synthesis, &mut self.targets, &views, &mut self.map)?;
        let entries = self.map.read_u32(1, [0, 0], pair.size);
        let rows = entries.chunks_exact(pair.size[0] as usize).rev();
        Ok(rows.flatten().map(|entry| entry & SOURCE_MAP_HOLE != 0).collect())
    }
}

/// Counts the pixels that the synthesis leaves open.
pub struct OpenPixels {
    gl: Rc<Context>,
    targets: ViewTargets,
    synthesis: Gather,
    image: RenderTarget,
    /// Fills the pixels with some stencil.
    fill: Program,
}

impl OpenPixels {
    /// Compiles the default synthesis, which marks pixels by stencil.
    ///
    /// # Errors
    /// As [`HoleFinder::new`].
    pub fn new(gl: &Rc<Context>) -> Result<OpenPixels, GlError> {
        let outputs = Outputs { holes: Holes::Open(HoleMark::Stencil), ..Outputs::default() };
        let color = (Format::Rgba8, Filter::Nearest);
        Ok(OpenPixels {
            gl: gl.clone(),
            targets: ViewTargets::default(),
            synthesis: Gather::new(gl, &Options::default(), outputs)?,
            image: RenderTarget::new(gl, [1, 1], &[color], Some(Format::Depth32FStencil8))?,
            fill: Program::new(gl, ShaderSource::Screen("render/fill.frag"), &[])?,
        })
    }

    /// Returns the share of the pixels of the eye that is not dominant, 0 to 1.
    ///
    /// # Errors
    /// As [`HoleFinder::find`].
    pub fn share(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> Result<f64, StereoError> {
        let views = pair.synthesis_views(StereoOptions::default().guard_band)?;
        prepared.synthesize(&mut self.synthesis, &mut self.targets, &views, &mut self.image)?;
        let to = Destination::whole(&self.image);
        self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
        self.fill.bind();
        for stencil in [0, 1] {
            let test = StencilTest::Equal(stencil);
            self.gl.set_raster_state(&RasterState { stencil: test, ..RasterState::SCREEN });
            self.fill.set("fill", glam::Vec4::splat(f32::from(stencil)));
            self.gl.draw_screen();
        }
        let pixels = self.image.read_rgba8(0, [0, 0], pair.size);
        let open = pixels.chunks_exact(4).filter(|pixel| pixel[0] == 0).count();
        Ok(open as f64 / (pixels.len() / 4) as f64)
    }
}
