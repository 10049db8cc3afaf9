//! Disocclusions: pixels of the other eye that the dominant eye does not show.

use std::rc::Rc;

use yoro::eyes::{EyePair, GuardBand};
use yoro::opengl::{Gather, Options, Outputs};
use yoro::synthesis::SOURCE_MAP_HOLE;
use yoro_gl::{Context, Filter, Format, GlError, RenderTarget};
use yoro_render::stereo::StereoError;
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
