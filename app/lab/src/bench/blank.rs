//! Views in which there is nothing to measure.

use std::rc::Rc;

use yoro::eyes::EyePair;
use yoro_gl::{Context, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource};
use yoro_render::{PreparedScene, Selection, ViewTargets};

/// Longest edge in pixels of the image that is looked at: what is smaller on the screen is as good as not there.
const EDGE: u32 = 256;

/// Finds views that show the sky alone: every method is perfect there.
pub struct BlankFinder {
    gl: Rc<Context>,
    targets: ViewTargets,
    copy: Program,
    depth: RenderTarget,
}

impl BlankFinder {
    /// Makes the targets.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target.
    pub fn new(gl: &Rc<Context>) -> Result<BlankFinder, GlError> {
        Ok(BlankFinder {
            gl: gl.clone(),
            targets: ViewTargets::default(),
            copy: Program::new(gl, ShaderSource::Screen("render/depth_copy.frag"), &[])?,
            depth: RenderTarget::new(gl, [1, 1], &[(Format::R32F, Filter::Nearest)], None)?,
        })
    }

    /// True if the dominant eye sees no surface. Transparent ones, which have no depth, do not count: synthesis does
    /// nothing for them.
    ///
    /// # Errors
    /// [`GlError`] when the driver has no memory for the targets.
    pub fn is_blank(&mut self, prepared: &mut PreparedScene, pair: &EyePair) -> Result<bool, GlError> {
        let mut view = pair.view(pair.dominant);
        let longest = view.size[0].max(view.size[1]);
        if longest > EDGE {
            view.size = view.size.map(|n| (n * EDGE / longest).max(1));
        }
        let PreparedScene { renderer, scene } = prepared;
        let rendered = renderer.render(&mut self.targets, scene, &view, Selection::All)?;
        self.depth.resize(view.size)?;
        self.depth.bind();
        self.gl.set_raster_state(&RasterState::SCREEN);
        self.copy.bind().texture("source", 0, rendered.depth.raw());
        self.gl.draw_screen();
        let far = view.depth.clear_value();
        Ok(self.depth.read_rgba32f(0, [0, 0], view.size).iter().all(|texel| texel[0] == far))
    }
}
