//! The automatic guard band: measures how near the surfaces at its border are, and decides how much of it to draw.

use std::rc::Rc;

use super::border::{BANDS, Border, CELLS, Profile, Width};
use super::method::GuardBandUse;
use super::readback::Readback;
use crate::view::{Columns, DepthImage, DepthProgram, GpuScene, of_columns};
use yoro::eyes::{Eye, EyePair, SynthesisViews};
use yoro::synthesis::Uniforms;
use yoro_gl::{Context, GlError, RasterState};

/// Size of a profile in bytes, as in `stereo/border_profile.frag`.
const BYTES: usize = CELLS * BANDS * 4;
/// The innermost 1 / `PART` of the band is drawn in every frame. Bloom, which reaches far, stops at its edge in all frames.
const PART: u32 = 4;
/// Lower bound of that part in columns.
const REACH: u32 = 10;

/// Returns how many columns of a band are drawn in every frame.
fn least(guard_columns: u32) -> u32 {
    guard_columns.div_ceil(PART).max(REACH).min(guard_columns)
}

/// Measures each frame and decides the width of the next.
pub(super) struct AutoGuardBand {
    gl: Rc<Context>,
    program: DepthProgram,
    readback: Readback<Frame>,
    width: Width,
    /// The frame that is being rendered.
    frame: Option<Frame>,
    last: Option<GuardBandUse>,
}

/// A frame that is being measured.
struct Frame {
    border: Border,
    drawn: u32,
    /// Columns per texel of its profile.
    step: u32,
}

impl AutoGuardBand {
    pub(super) fn new(gl: &Rc<Context>) -> Result<AutoGuardBand, GlError> {
        Ok(AutoGuardBand {
            gl: gl.clone(),
            program: DepthProgram::new(gl, "stereo/border_profile.frag"),
            readback: Readback::new(gl, [CELLS as u32, BANDS as u32])?,
            width: Width::default(),
            frame: None,
            last: None,
        })
    }

    /// Returns the columns of the source to draw in a frame of a scene. Draws all of them if something moves in the
    /// band or beside it, because earlier frames do not tell where it is now.
    pub(super) fn columns(&mut self, pair: &EyePair, views: &SynthesisViews, scene: &GpuScene) -> Columns {
        let border = Border::new(pair, views);
        let mut texels = [0u8; BYTES];
        let frame = self.readback.take(&mut texels);
        let profile = frame.and_then(|frame| Profile::read(&texels, frame.border, frame.drawn, frame.step));
        self.last = profile.as_ref().map(|profile| GuardBandUse {
            columns: profile.drawn,
            most: profile.border.guard_columns,
            undrawn: profile.undrawn,
        });
        let guard = views.guard_columns;
        let mut drawn = self.width.next(profile.as_ref(), &border, least(guard));
        let [width, _] = views.source.size;
        let around = match views.warp.target_eye {
            Eye::Left => [0, (2 * guard).min(width)],
            Eye::Right => [width.saturating_sub(2 * guard), width],
        };
        if scene.is_moving_in(&of_columns(&views.source, around)) {
            drawn = guard;
        }
        // As far into the picture as the band is wide: surfaces that turn out of the picture come from there.
        self.frame = Some(Frame { border, drawn, step: (drawn + guard).div_ceil(CELLS as u32) });
        let without = |left_out: u32| match views.warp.target_eye {
            Eye::Left => [left_out, views.source.size[0]],
            Eye::Right => [0, views.source.size[0] - left_out],
        };
        Columns { drawn: without(guard - drawn), always: without(guard - least(guard)) }
    }

    /// Compiles the pass for whole depth textures or for pairs of depths, unless it is compiled already.
    pub(super) fn prepare(&mut self, is_pair: bool) -> Result<(), GlError> {
        self.program.prepare(is_pair)
    }

    /// Starts to measure the frame of the last [`AutoGuardBand::columns`].
    pub(super) fn measure(&mut self, depth: &DepthImage, views: &SynthesisViews) -> Result<(), GlError> {
        let Some(frame) = self.frame.take().filter(|frame| frame.border.guard_columns > 0) else {
            self.readback.forget();
            return Ok(());
        };
        let warp = Uniforms::new(&views.warp, [0, 0]);
        let (gl, program, readback) = (&self.gl, &mut self.program, &mut self.readback);
        gl.pass("border profile", || {
            gl.set_raster_state(&RasterState::SCREEN);
            readback.image().bind();
            program
                .bind(depth)?
                .set("mirrored", warp.mirrored)
                .set("guard", views.guard_columns as i32)
                .set("first", (views.guard_columns - frame.drawn) as i32)
                .set("columns", frame.step as i32)
                .set("law", warp.law - glam::Vec2::X * warp.far_displacement)
                .set("beyond", frame.border.beyond);
            gl.draw_screen();
            readback.start(frame);
            Ok(())
        })
    }

    /// Returns the newest measured frame.
    pub(super) fn last(&self) -> Option<GuardBandUse> {
        self.last
    }

    /// Forgets all measurements, for a frame that does not use the band.
    pub(super) fn interrupt(&mut self) {
        self.readback.forget();
        self.frame = None;
        self.last = None;
        self.width = Width::default();
    }
}
