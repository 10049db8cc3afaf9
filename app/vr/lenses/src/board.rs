//! The menu's panel: tiles on a board that stands in the world in front of the eyes.

use std::rc::Rc;

use glam::{Mat3, Vec2, Vec3};

use crate::text::{CELL, Letters};
use yoro::eyes::{Eye, EyePair, Pose};
use yoro_gl::{
    Blend, Context, Destination, Filter, Format, GlError, Program, RasterState, ShaderSource, Texture,
};

/// Number of tiles in a row.
pub const ROW: usize = 4;
/// Maximum number of characters in a line of a tile, and in a line of the heading; longer lines are cut.
pub const TILE_COLUMNS: usize = 12;
/// See [`TILE_COLUMNS`].
pub const HEADING_COLUMNS: usize = 53;
const GAP: usize = 8;
const INSET: usize = 10;
const TILE: [usize; 2] = [TILE_COLUMNS * CELL[0] + 2 * INSET, 2 * CELL[1] + 2 * INSET];
/// With three rows of tiles there is room for four heading lines, with two rows for seven.
const SIZE: [usize; 2] = [ROW * (TILE[0] + GAP) + GAP, 4 * CELL[1] + 2 * INSET + 3 * (TILE[1] + GAP)];

/// Size in pixels of a camera's picture, which is shown on the right of the heading.
const PICTURE: [usize; 2] = [256, 192];
/// Number of characters at the end of the heading's lines that a camera's picture covers.
pub const PICTURE_COLUMNS: usize = (PICTURE[0] + INSET).div_ceil(CELL[0]);

/// Distance of the panel in metres, and its width in degrees.
const DISTANCE: f32 = 2.0;
const WIDTH_DEGREES: f32 = 40.0;
/// Diameter of the dot in degrees.
const DOT_DEGREES: f32 = 0.8;

const GROUND: u8 = 15;
const TILE_GROUND: u8 = 45;
const POINTED_GROUND: u8 = 95;
/// Height in pixels of the bar that fills while a tile is pointed at.
const BAR: usize = 6;

/// What the panel shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tiles {
    /// The lines of text above the tiles.
    pub heading: String,
    /// The text of each tile, two lines, row after row from the upper left. An empty text leaves a gap. The last row is
    /// at the panel's lower edge.
    pub tiles: Vec<String>,
    /// The tile that is pointed at, and the progress of its selection, 0 to 1.
    pub pointed: Option<(usize, f32)>,
}

/// Returns the pose of a panel in front of a head: its centre, with its own Z towards the reader.
pub fn board_pose(head: Pose) -> Pose {
    let ahead = head.forward();
    let (yaw, pitch) = ((-ahead.x).atan2(-ahead.z), ahead.y.clamp(-1.0, 1.0).asin());
    let orientation = glam::Quat::from_rotation_y(yaw) * glam::Quat::from_rotation_x(pitch);
    Pose { position: head.position + orientation * Vec3::NEG_Z * DISTANCE, orientation }
}

/// Returns the size of the panel in metres.
pub fn board_metres() -> [f32; 2] {
    let width = 2.0 * DISTANCE * (WIDTH_DEGREES.to_radians() / 2.0).tan();
    [width, width * SIZE[1] as f32 / SIZE[0] as f32]
}

/// Returns the point at which a ray along a pose's -Z hits the panel, 0 to 1 from the lower left; `None` if it misses.
pub fn board_hit(board: &Pose, ray: &Pose) -> Option<Vec2> {
    let inverse = board.orientation.inverse();
    let from = inverse * (ray.position - board.position);
    let along = inverse * ray.forward();
    let is_towards = from.z > 0.0 && along.z < 0.0;
    let at = (from - along * (from.z / along.z)).truncate() / Vec2::from(board_metres()) + 0.5;
    (is_towards && at.cmpge(Vec2::ZERO).all() && at.cmple(Vec2::ONE).all()).then_some(at)
}

/// Returns the height of the part above `tiles` tiles in pixels.
fn top(tiles: usize) -> usize {
    SIZE[1] - tiles.div_ceil(ROW) * (TILE[1] + GAP)
}

/// Returns the tile at a point on a panel with `tiles` tiles, and the position in it from the left, 0 to 1.
pub fn tile_at(at: Vec2, tiles: usize) -> Option<(usize, f32)> {
    let [x, y] = [at.x * SIZE[0] as f32, (1.0 - at.y) * SIZE[1] as f32];
    let cell = |n: f32, size: usize| {
        let pitch = (size + GAP) as f32;
        let index = (n / pitch).floor();
        (n >= 0.0 && n - index * pitch <= size as f32)
            .then_some((index as usize, (n - index * pitch) / size as f32))
    };
    let (column, share) = cell(x - GAP as f32, TILE[0])?;
    let (row, _) = cell(y - top(tiles) as f32, TILE[1])?;
    (column < ROW && row * ROW + column < tiles).then_some((row * ROW + column, share))
}

/// Draws the panel's pixels, rows from the top.
fn draw(tiles: &Tiles, letters: &Letters, pixels: &mut [u8]) {
    pixels.fill(GROUND);
    let top_pixels = top(tiles.tiles.len());
    for (i, line) in tiles.heading.lines().take((top_pixels - 2 * INSET) / CELL[1]).enumerate() {
        letters.draw(line, HEADING_COLUMNS, pixels, SIZE[0], [GAP + INSET, INSET + i * CELL[1]]);
    }
    for (i, text) in tiles.tiles.iter().enumerate() {
        let left = GAP + (i % ROW) * (TILE[0] + GAP);
        let top = top_pixels + (i / ROW) * (TILE[1] + GAP);
        if text.is_empty() {
            continue;
        }
        let share = tiles.pointed.filter(|&(tile, _)| tile == i).map(|(_, share)| share);
        let ground = if share.is_some() { POINTED_GROUND } else { TILE_GROUND };
        let filled = (share.unwrap_or(0.0).clamp(0.0, 1.0) * TILE[0] as f32) as usize;
        for y in 0..TILE[1] {
            let row = &mut pixels[(top + y) * SIZE[0] + left..][..TILE[0]];
            row.fill(ground);
            if y + BAR >= TILE[1] {
                row[..filled].fill(255);
            }
        }
        for (n, line) in text.lines().take(2).enumerate() {
            letters.draw(
                line,
                TILE_COLUMNS,
                pixels,
                SIZE[0],
                [left + INSET, top + INSET + n * CELL[1] - BAR / 2],
            );
        }
    }
}

/// The panel on the GPU.
pub struct Board {
    gl: Rc<Context>,
    program: Program,
    texture: Texture,
    /// A camera's picture.
    picture: Texture,
    /// The cross and the gear.
    signs: [Texture; 2],
    letters: Letters,
    pixels: Vec<u8>,
    rows: Vec<u8>,
    shown: Tiles,
}

impl Board {
    /// Size of the panel in pixels.
    pub const SIZE: [u32; 2] = [SIZE[0] as u32, SIZE[1] as u32];

    /// Size of a camera's picture in pixels.
    pub const PICTURE: [u32; 2] = [PICTURE[0] as u32, PICTURE[1] as u32];

    /// Makes an empty panel.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses the program or the texture.
    pub fn new(gl: &Rc<Context>) -> Result<Board, GlError> {
        let sign = |is_inside: fn(Vec2) -> bool| {
            let texture = Texture::new(gl, [SIGN as u32; 2], Format::R8, Filter::Linear)?;
            texture.upload(&sign(is_inside));
            Ok(texture)
        };
        Ok(Board {
            signs: [sign(is_in_cross)?, sign(is_in_gear)?],
            gl: gl.clone(),
            program: Program::new(gl, ShaderSource::Screen("viewer/menu.frag"), &[])?,
            texture: Texture::new(gl, Board::SIZE, Format::R8, Filter::Linear)?,
            picture: Texture::new(gl, Board::PICTURE, Format::R8, Filter::Linear)?,
            letters: Letters::new(),
            pixels: vec![0; SIZE[0] * SIZE[1]],
            rows: Vec::with_capacity(SIZE[0] * SIZE[1]),
            shown: Tiles::default(),
        })
    }

    /// Changes the contents of the panel. Does nothing if they are the same.
    pub fn set(&mut self, tiles: &Tiles) {
        if self.shown != *tiles {
            self.shown.clone_from(tiles);
            draw(tiles, &self.letters, &mut self.pixels);
            self.rows.clear();
            self.pixels.chunks_exact(SIZE[0]).rev().for_each(|row| self.rows.extend_from_slice(row));
            self.texture.upload(&self.rows);
        }
    }

    /// Changes the camera's picture; `luma` has its rows from the bottom.
    pub fn set_picture(&mut self, luma: &[u8]) {
        self.picture.upload(luma);
    }

    /// Draws the panel at a pose in the scene into the images of both eyes, with a dot at `pointer`.
    pub fn draw_into_eyes(
        &self,
        board: &Pose,
        pointer: Option<Vec2>,
        pair: &EyePair,
        eyes: &[Destination; 2],
    ) {
        let images = eyes.each_ref().map(|eye| eye.image(Format::Rgba8));
        self.gl.pass("menu").read("panel", &self.texture).load(images).run(|| {
            self.gl.set_raster_state(&RasterState { blend: Blend::Over, ..RasterState::SCREEN });
            for eye in Eye::BOTH {
                self.run(&self.texture, to_panel(board, pair, eye), pointer, false, &eyes[eye.index()]);
            }
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }

    /// Fills an image of the panel's size with linear colour for a compositor, not premultiplied by alpha.
    pub fn draw_linear(&self, pointer: Option<Vec2>, to: &Destination) {
        self.gl.pass("menu").read("panel", &self.texture).write([to.image(Format::Rgba8)]).run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.run(&self.texture, onto(to), pointer, true, to);
        });
    }

    /// Draws the panel flat, as large as the window allows. `has_picture` adds the camera's picture in the upper right
    /// corner.
    pub fn draw_flat(&self, window: &Destination, has_picture: bool) {
        let ([x, y], size) = flat_place(window.size);
        let origin = [window.origin[0] + x, window.origin[1] + y];
        let panel = Destination { origin, size, ..*window };
        let picture = has_picture.then(|| picture_place(&panel));
        let mut pass = self.gl.pass("menu").read("panel", &self.texture);
        if picture.is_some() {
            pass = pass.read("panel", &self.picture);
        }
        pass.write([window.image(Format::Rgba8)]).run(|| {
            self.gl.bind_framebuffer(window.framebuffer, window.origin, window.size);
            self.gl.fill(window.origin, window.size, [f32::from(GROUND) / 255.0; 4]);
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.run(&self.texture, onto(&panel), None, false, &panel);
            if let Some(to) = &picture {
                self.run(&self.picture, onto(to), None, false, to);
            }
        });
    }

    /// Draws a cross into a window's upper left corner and a gear into its upper right corner, each `side` pixels wide.
    pub fn draw_corners(&self, side: u32, window: &Destination) {
        let pass = self.signs.iter().fold(self.gl.pass("menu"), |pass, sign| pass.read("panel", sign));
        pass.load([window.image(Format::Rgba8)]).run(|| {
            self.gl.set_raster_state(&RasterState { blend: Blend::Over, ..RasterState::SCREEN });
            for (sign, right) in self.signs.iter().zip([0, window.size[0].saturating_sub(side)]) {
                let y = window.origin[1] + window.size[1].saturating_sub(side);
                let to = Destination { origin: [window.origin[0] + right, y], size: [side; 2], ..*window };
                self.run(sign, onto(&to), None, false, &to);
            }
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }

    /// Draws brightness on a plane, as linear colour (`to_linear`) or display-referred.
    fn run(
        &self,
        texture: &Texture,
        to_panel: Mat3,
        pointer: Option<Vec2>,
        to_linear: bool,
        to: &Destination,
    ) {
        let radius = DISTANCE * (DOT_DEGREES.to_radians() / 2.0).tan();
        self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
        self.program
            .bind()
            .texture("panel", 0, texture.raw())
            .set("to_panel", to_panel)
            .set("origin", Vec2::new(to.origin[0] as f32, to.origin[1] as f32))
            .set("to_linear", to_linear)
            .set("pointer", pointer.unwrap_or(Vec2::splat(-9.0)))
            .set("dot_radius", radius / Vec2::from(board_metres()));
        self.gl.draw_screen();
    }
}

/// Returns where the camera's picture is drawn on a flat panel.
fn picture_place(panel: &Destination) -> Destination {
    let scaled = |n: usize| (n as u64 * u64::from(panel.size[0]) / SIZE[0] as u64) as u32;
    let (size, inset) = (PICTURE.map(scaled), scaled(INSET));
    let origin = [0, 1].map(|i| panel.origin[i] + panel.size[i] - size[i] - inset);
    Destination { origin, size, ..*panel }
}

/// Returns the lower left corner and the size of the flat panel in a window of this size, in pixels.
fn flat_place(window: [u32; 2]) -> ([u32; 2], [u32; 2]) {
    let [width, height] = window.map(u64::from);
    let [across, up] = SIZE.map(|n| n as u64);
    let size = if width * up <= height * across {
        [width, width * up / across]
    } else {
        [height * across / up, height]
    };
    ([(width - size[0]) / 2, (height - size[1]) / 2].map(|n| n as u32), size.map(|n| n as u32))
}

/// Returns the point on the flat panel, 0 to 1 from the lower left, under a pixel of the window, counted from the upper
/// left; `None` outside of the panel.
pub fn flat_hit(pixel: Vec2, window: [u32; 2]) -> Option<Vec2> {
    let ([left, bottom], size) = flat_place(window);
    let from_corner = Vec2::new(pixel.x - left as f32, window[1] as f32 - pixel.y - bottom as f32);
    let at = from_corner / Vec2::new(size[0] as f32, size[1] as f32);
    (at.cmpge(Vec2::ZERO).all() && at.cmple(Vec2::ONE).all()).then_some(at)
}

/// Returns the transform from pixels of an image to a panel that fills it.
fn onto(to: &Destination) -> Mat3 {
    Mat3::from_scale(Vec2::new(1.0 / to.size[0] as f32, 1.0 / to.size[1] as f32))
}

/// Edge length of a sign's image in pixels.
const SIGN: usize = 96;
/// Samples per pixel of a sign along each axis, of which the mean is taken.
const SAMPLES: usize = 4;

/// Draws a sign: for each pixel, the share that is inside. `is_inside` takes coordinates from -1 to 1.
fn sign(is_inside: fn(Vec2) -> bool) -> Vec<u8> {
    let fine = SIGN * SAMPLES;
    let place = |i: usize| 2.0 * (i as f32 + 0.5) / fine as f32 - 1.0;
    let pixel = |i: usize| {
        let [x, y] = [i % SIGN, i / SIGN].map(|n| n * SAMPLES);
        let samples =
            (0..SAMPLES * SAMPLES).map(|n| Vec2::new(place(x + n % SAMPLES), place(y + n / SAMPLES)));
        let inside = samples.filter(|&at| is_inside(at)).count();
        GROUND + ((255 - usize::from(GROUND)) * inside / (SAMPLES * SAMPLES)) as u8
    };
    (0..SIGN * SIGN).map(pixel).collect()
}

fn is_in_cross(at: Vec2) -> bool {
    at.abs().max_element() < 0.42 && (at.x.abs() - at.y.abs()).abs() < 0.12
}

fn is_in_gear(at: Vec2) -> bool {
    // A gear with eight teeth.
    let is_tooth = (8.0 * at.y.atan2(at.x)).cos() > 0.0;
    (0.18..if is_tooth { 0.52 } else { 0.38 }).contains(&at.length())
}

/// Returns the homogeneous transform from pixels of an eye's image to the panel.
fn to_panel(board: &Pose, pair: &EyePair, eye: Eye) -> Mat3 {
    let (pose, frustum) = (&pair.poses[eye.index()], &pair.frusta[eye.index()]);
    let inverse = board.orientation.inverse();
    let from = inverse * (pose.position - board.position);
    let [width, height] = pair.size.map(|n| n as f32);
    // From pixels to a direction in the eye's space, and on to the panel's.
    let direction = Mat3::from_cols(
        Vec3::new(frustum.width() / width, 0.0, 0.0),
        Vec3::new(0.0, frustum.height() / height, 0.0),
        Vec3::new(frustum.left, frustum.bottom, -1.0),
    );
    let along = Mat3::from_quat(inverse * pose.orientation) * direction;
    // The ray meets the panel's plane z = 0 at (from.xy along.z - from.z along.xy) / along.z; the eye sees its front.
    let metres = board_metres();
    let meet = Mat3::from_cols(
        Vec3::new(from.z / metres[0], 0.0, 0.0),
        Vec3::new(0.0, from.z / metres[1], 0.0),
        Vec3::new(-from.x / metres[0] - 0.5, -from.y / metres[1] - 0.5, -1.0),
    );
    meet * along
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{DepthRange, Frustum};

    #[test]
    fn the_panel_is_where_one_looks_and_each_tile_is_found() {
        let turned = glam::Quat::from_rotation_y(0.5) * glam::Quat::from_rotation_x(-0.3);
        let head = Pose {
            position: Vec3::new(0.1, 0.2, 0.3),
            orientation: turned * glam::Quat::from_rotation_z(0.4),
        };
        let board = board_pose(head);
        let middle = board_hit(&board, &head).unwrap();
        assert!((middle - 0.5).length() < 1e-4, "{middle}");
        let behind = Pose { orientation: turned * glam::Quat::from_rotation_y(3.0), ..head };
        assert_eq!(board_hit(&board, &behind), None);
        for (tiles, i) in (0..12).map(|i| (12, i)).chain((0..7).map(|i| (7, i))) {
            let x = GAP + (i % ROW) * (TILE[0] + GAP) + TILE[0] / 4;
            let y = top(tiles) + (i / ROW) * (TILE[1] + GAP) + TILE[1] / 2;
            let at = Vec2::new(x as f32 / SIZE[0] as f32, 1.0 - y as f32 / SIZE[1] as f32);
            let (tile, share) = tile_at(at, tiles).unwrap();
            assert!(tile == i && (share - 0.25).abs() < 0.01, "{tile} {share}");
        }
        assert_eq!(tile_at(Vec2::new(0.5, 0.99), 12), None);
        assert_eq!(tile_at(Vec2::new(0.9, 0.1), 7), None);
    }

    #[test]
    fn the_flat_panel_fills_a_window_and_is_found_by_its_pixels() {
        for window in [[2340, 1080], [1080, 2340], [320, 180]] {
            let ([x, y], [width, height]) = flat_place(window);
            assert!(width == window[0] && x == 0 || height == window[1] && y == 0, "{window:?}");
            let ratio = width as f32 / height as f32 * SIZE[1] as f32 / SIZE[0] as f32;
            assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
            let at =
                Vec2::new(x as f32 + 0.25 * width as f32, window[1] as f32 - y as f32 - 0.1 * height as f32);
            assert!((flat_hit(at, window).unwrap() - Vec2::new(0.25, 0.1)).length() < 1e-3);
        }
        assert_eq!(flat_hit(Vec2::new(1.0, 500.0), [2340, 1080]), None);
    }

    #[test]
    fn a_pixel_goes_to_the_panel_as_its_ray_does() {
        let frustum = Frustum::from_fov(-0.7, 0.7, 0.7, -0.7);
        let turn = glam::Quat::from_rotation_y(0.2);
        let head = Pose { orientation: turn, ..Pose::IDENTITY };
        let pair = EyePair::parallel(head, frustum, 0.06, DepthRange::PAPER, [1000; 2], Eye::Right);
        let board = board_pose(Pose::IDENTITY);
        for eye in Eye::BOTH {
            let pose = &pair.poses[eye.index()];
            let at = to_panel(&board, &pair, eye) * Vec3::new(500.0, 500.0, 1.0);
            let expected = board_hit(&board, pose).unwrap();
            assert!(at.z > 0.0 && (at.truncate() / at.z - expected).length() < 1e-4);
        }
    }
}
