//! A guard band as wide as it must be: how much of it is seen, measured, and how much is drawn, decided.

use std::rc::Rc;

use glam::Vec2;

use super::method::GuardBandUse;
use crate::render::Columns;
use yoro::eyes::{Eye, EyePair, Pose, SynthesisViews};
use yoro::gl::{
    Context, Filter, Format, GlError, PixelBuffer, Program, RasterState, RenderTarget, ShaderSource, Texture,
};
use yoro::synthesis::Uniforms;

/// Texels of the image that is read back; `stereo/border_need.frag`.
const CELLS: [u32; 2] = [4, 64];
const BYTES: usize = (CELLS[0] * CELLS[1] * 4) as usize;
/// The head may turn by so much (radians) before all of the band is looked at again.
const TURN: f32 = 1.0 * std::f32::consts::PI / 180.0;
/// It may move by so much of the distance between the eyes.
const MOVE: f32 = 0.5;
/// All of the band is looked at once in so many frames: things move by themselves, too.
const LOOK_EVERY: u32 = 30;
/// This part of the band is drawn in every frame: what reaches far, ambient occlusion and bloom, stops there, and must not
/// stop anywhere else in the next frame.
const LEAST: u32 = 4;
/// It has as many columns at least: beside its own a pixel that is shown may depend on those that filters reach, of ambient
/// occlusion at half size (5) and of FXAA (4).
const REACH: u32 = 10;
/// The head was put elsewhere, rather than moved, if it moved by so many times what it may between looks.
const CUT: f32 = 10.0;
/// Columns that are drawn beyond what is seen: filters of the renderer read so far to each side.
const SPARE: u32 = 4;

/// The eyes' geometry as far as a width in columns depends on it. Another one begins anew.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Geometry {
    size: [u32; 2],
    guard_columns: u32,
    dominant: Eye,
    focal_length: f32,
    ipd: f32,
}

/// What a frame showed of the band.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Need {
    /// Columns that are seen, or may be after as much motion as is allowed for.
    columns: u32,
    /// Pixels that were seen and not drawn.
    undrawn: u32,
}

/// How many columns of the band to draw. All of them in a look: at first, after some motion, when something nearer
/// comes to the border, and once in a while. Between looks as many as the last two found necessary.
#[derive(Debug, Default)]
struct Width {
    look: Option<Look>,
    columns: u32,
    /// What the look before the last one found.
    before: u32,
}

/// When all of the band was drawn last.
#[derive(Clone, Copy, Debug)]
struct Look {
    geometry: Geometry,
    pose: Pose,
    frames: u32,
    /// What was found; none until it is read back.
    found: Option<u32>,
}

impl Width {
    /// Columns to draw in a frame, from what the frame before found.
    fn next(&mut self, measured: Option<Need>, geometry: Geometry, pose: Pose) -> u32 {
        let full = geometry.guard_columns;
        let Some(look) = self.look.as_mut().filter(|look| look.geometry == geometry) else {
            self.before = 0;
            return self.look_again(geometry, pose);
        };
        look.frames += 1;
        let Some(need) = measured else { return full };
        match look.found {
            None => {
                let found = (need.columns + SPARE).max(least(full)).min(full);
                self.columns = found.max(self.before);
                self.before = found;
                look.found = Some(found);
            }
            Some(_) if need.undrawn > 0 || need.columns > self.columns => {
                return self.look_again(geometry, pose);
            }
            Some(_) => {}
        }
        let moved = (pose.position - look.pose.position).length() / (MOVE * geometry.ipd).max(1e-6);
        let turned = pose.orientation.angle_between(look.pose.orientation) / TURN;
        let motion = moved.max(turned);
        if motion > CUT {
            self.before = 0;
        }
        if motion > 1.0 || look.frames >= LOOK_EVERY {
            return self.look_again(geometry, pose);
        }
        self.columns
    }

    fn look_again(&mut self, geometry: Geometry, pose: Pose) -> u32 {
        self.look = Some(Look { geometry, pose, frames: 0, found: None });
        self.columns = geometry.guard_columns;
        geometry.guard_columns
    }
}

/// Columns of a band that are drawn in every frame.
fn least(guard_columns: u32) -> u32 {
    guard_columns.div_ceil(LEAST).max(REACH).min(guard_columns)
}

/// Decides and measures.
pub(super) struct AutoGuardBand {
    gl: Rc<Context>,
    program: Program,
    cells: RenderTarget,
    buffer: PixelBuffer,
    pending: bool,
    width: Width,
    /// Columns that were drawn last, of how many.
    drawn: Option<[u32; 2]>,
    last: Option<GuardBandUse>,
}

impl AutoGuardBand {
    pub(super) fn new(gl: &Rc<Context>) -> Result<AutoGuardBand, GlError> {
        Ok(AutoGuardBand {
            gl: gl.clone(),
            program: Program::new(gl, ShaderSource::Screen("stereo/border_need.frag"), &[])?,
            cells: RenderTarget::new(gl, CELLS, &[(Format::Rgba8, Filter::Nearest)], None)?,
            buffer: PixelBuffer::new(gl, BYTES)?,
            pending: false,
            width: Width::default(),
            drawn: None,
            last: None,
        })
    }

    /// The columns of the source to draw in a frame.
    pub(super) fn columns(&mut self, pair: &EyePair, views: &SynthesisViews) -> Columns {
        let geometry = Geometry {
            size: views.source.size,
            guard_columns: views.guard_columns,
            dominant: pair.dominant,
            focal_length: pair.focal_length_pixels(),
            ipd: pair.ipd(),
        };
        let need = self.take();
        self.last = self.drawn.zip(need).map(|([columns, most], need)| GuardBandUse {
            columns,
            most,
            undrawn: need.undrawn,
        });
        let drawn = self.width.next(need, geometry, pair.poses[pair.dominant.index()]);
        let without = |left_out: u32| match views.warp.target_eye {
            Eye::Left => [left_out, views.source.size[0]],
            Eye::Right => [0, views.source.size[0] - left_out],
        };
        let guard = views.guard_columns;
        self.drawn = Some([drawn, guard]);
        Columns { drawn: without(guard - drawn), always: without(guard - least(guard)) }
    }

    /// Starts to measure what of the band a frame's depth shows.
    pub(super) fn measure(&mut self, depth: &Texture, pair: &EyePair, views: &SynthesisViews) {
        let Some([drawn, _]) = self.drawn.filter(|_| views.guard_columns > 0) else { return };
        let (warp, guard) = (Uniforms::new(&views.warp, [0, 0]), views.guard_columns as f32);
        // Forward columns begin with the guard band: from its end a surface at infinity moves in by nothing.
        let law = warp.law + Vec2::X * guard;
        // At the border of a wide view things move faster than in its middle.
        let border = match views.warp.target_eye {
            Eye::Left => -views.target.frustum.left,
            Eye::Right => views.target.frustum.right,
        };
        let turn = pair.focal_length_pixels() * TURN * (1.0 + border * border);
        let along = MOVE * border.max(1.0);
        // Where the rendered eye sees further out than the other, infinity is as many columns away from being seen.
        let beyond = (-(warp.far_displacement + guard)).max(0.0);
        let motion = Vec2::new(turn + along * beyond, along);
        let inside = (turn + along * guard + beyond).ceil() as u32;
        let end = (views.guard_columns + inside).min(views.source.size[0]);
        self.gl.pass("border need", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.cells.bind();
            self.program
                .bind()
                .texture("depth_map", 0, depth.raw())
                .set("mirrored", warp.mirrored)
                .set("guard", views.guard_columns as i32)
                .set("first", (views.guard_columns - drawn) as i32)
                .set("end", end as i32)
                .set("law", law)
                .set("motion", motion);
            self.gl.draw_screen();
            self.cells.read_into(&self.buffer);
        });
        self.pending = true;
    }

    /// The frame before the last [`AutoGuardBand::columns`], if it was measured.
    pub(super) fn last(&self) -> Option<GuardBandUse> {
        self.last
    }

    /// Forgets what was seen: a frame goes by without the band.
    pub(super) fn interrupt(&mut self) {
        self.pending = false;
        self.drawn = None;
        self.last = None;
        self.width = Width::default();
    }

    fn take(&mut self) -> Option<Need> {
        if !std::mem::take(&mut self.pending) {
            return None;
        }
        let mut cells = [0u8; BYTES];
        self.buffer.read(&mut cells);
        let mut need = Need::default();
        for cell in cells.chunks_exact(4) {
            // Zeros come from a driver that could not give the buffer, and from nobody else.
            let columns = u32::from(u16::from_le_bytes([cell[0], cell[1]])).checked_sub(1)?;
            need.columns = need.columns.max(columns);
            need.undrawn += u32::from(u16::from_le_bytes([cell[2], cell[3]]));
        }
        Some(need)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Quat, Vec3};

    const GEOMETRY: Geometry = Geometry {
        size: [1080, 1024],
        guard_columns: 56,
        dominant: Eye::Right,
        focal_length: 886.8,
        ipd: 0.063,
    };

    fn needs(columns: u32) -> Option<Need> {
        Some(Need { columns, undrawn: 0 })
    }

    /// Widths of frames at one place, the first of which nothing was measured before.
    fn widths(width: &mut Width, pose: Pose, found: &[u32]) -> Vec<u32> {
        found.iter().map(|&columns| width.next(needs(columns), GEOMETRY, pose)).collect()
    }

    #[test]
    fn the_first_frame_is_a_look_and_the_next_as_wide_as_it_found() {
        let mut width = Width::default();
        assert_eq!(width.next(None, GEOMETRY, Pose::IDENTITY), 56);
        assert_eq!(widths(&mut width, Pose::IDENTITY, &[10, 10, 7]), [14, 14, 14]);
    }

    #[test]
    fn what_comes_nearer_is_looked_at_and_drawn() {
        let mut width = Width::default();
        width.next(None, GEOMETRY, Pose::IDENTITY);
        assert_eq!(widths(&mut width, Pose::IDENTITY, &[10, 15, 30, 30]), [14, 56, 34, 34]);
        // Never more than there are.
        assert_eq!(widths(&mut width, Pose::IDENTITY, &[90, 90]), [56, 56]);
        let undrawn = Some(Need { columns: 3, undrawn: 1 });
        let mut width = Width::default();
        width.next(None, GEOMETRY, Pose::IDENTITY);
        widths(&mut width, Pose::IDENTITY, &[10]);
        assert_eq!(width.next(undrawn, GEOMETRY, Pose::IDENTITY), 56);
    }

    #[test]
    fn a_part_is_always_drawn() {
        let mut width = Width::default();
        width.next(None, GEOMETRY, Pose::IDENTITY);
        assert_eq!(widths(&mut width, Pose::IDENTITY, &[0, 0]), [14, 14]);
        assert_eq!([0, 1, 10, 28, 56].map(least), [0, 1, 10, 10, 14]);
    }

    #[test]
    fn it_narrows_after_two_looks_that_agree() {
        let mut width = Width::default();
        width.next(None, GEOMETRY, Pose::IDENTITY);
        widths(&mut width, Pose::IDENTITY, &[40]);
        let away = |i: f32| Pose { position: Vec3::X * i, ..Pose::IDENTITY };
        assert_eq!(widths(&mut width, away(0.1), &[40, 10]), [56, 44]);
        assert_eq!(widths(&mut width, away(0.2), &[10, 10]), [56, 14]);
        // Elsewhere, what was before means nothing.
        widths(&mut width, away(0.3), &[40, 40]);
        assert_eq!(widths(&mut width, away(9.0), &[40, 10]), [56, 14]);
    }

    #[test]
    fn motion_of_the_head_and_time_make_it_look() {
        let mut width = Width::default();
        width.next(None, GEOMETRY, Pose::IDENTITY);
        widths(&mut width, Pose::IDENTITY, &[10]);
        let turned = |angle: f32| Pose { orientation: Quat::from_rotation_y(angle), ..Pose::IDENTITY };
        let moved = |by: f32| Pose { position: Vec3::Z * by, ..Pose::IDENTITY };
        for near in [turned(0.5 * TURN), moved(0.9 * MOVE * GEOMETRY.ipd)] {
            assert_eq!(widths(&mut width, near, &[10]), [14]);
        }
        for far in [turned(2.0 * TURN), moved(1.1 * MOVE * GEOMETRY.ipd)] {
            assert_eq!(widths(&mut width, far, &[10, 10]), [56, 14]);
        }
        let still = widths(&mut width, moved(1.1 * MOVE * GEOMETRY.ipd), &[10; 2 * LOOK_EVERY as usize]);
        assert_eq!(still.iter().filter(|columns| **columns == 56).count(), 2, "{still:?}");
    }

    #[test]
    fn other_eyes_begin_anew_and_without_a_measurement_all_is_drawn() {
        let mut width = Width::default();
        width.next(None, GEOMETRY, Pose::IDENTITY);
        assert_eq!(width.next(None, GEOMETRY, Pose::IDENTITY), 56);
        widths(&mut width, Pose::IDENTITY, &[10]);
        let other = Geometry { guard_columns: 112, focal_length: 2.0 * GEOMETRY.focal_length, ..GEOMETRY };
        assert_eq!(width.next(needs(10), other, Pose::IDENTITY), 112);
    }
}
