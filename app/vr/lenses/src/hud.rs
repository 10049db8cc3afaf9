//! A small panel of text in front of the eyes that turns with the head.

use std::rc::Rc;

use glam::{Vec3, Vec4};

use crate::text::{CELL, Letters};
use yoro::eyes::{Eye, EyePair};
use yoro_gl::{
    Blend, Context, Destination, Filter, Format, GlError, Pass, Program, RasterState, ShaderSource, Texture,
};

/// Maximum number of characters in a line of the panel; longer lines are cut.
pub const COLUMNS: usize = 34;
const LINES: usize = 4;
const MARGIN: usize = 11;
const BAR_HEIGHT: usize = 16;
const SIZE: [usize; 2] = [COLUMNS * CELL[0] + 2 * MARGIN, LINES * CELL[1] + 3 * MARGIN + BAR_HEIGHT];
/// Width of the progress bar's moving part, as a share of the bar.
const BLOCK: f32 = 0.25;

/// Distance of the panel in metres, and the tangents of its width and of its centre's angle below the horizon.
const DISTANCE: f32 = 1.5;
const WIDTH: f32 = 0.42;
const BELOW: f32 = 0.40;

/// The panel's text and progress bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Content<'a> {
    /// At most four lines.
    pub text: &'a str,
    /// The position of the progress bar's moving part, 0 to 1. The bar does not show how much work is left.
    pub progress: Option<f32>,
}

/// The panel's pixels, rows from the top, 0 to 255.
struct Pixels(Vec<u8>);

impl Pixels {
    fn draw(&mut self, content: Content, letters: &Letters) {
        self.0.fill(0);
        for (i, line) in content.text.lines().take(LINES).enumerate() {
            letters.draw(line, COLUMNS, &mut self.0, SIZE[0], [MARGIN, MARGIN + i * CELL[1]]);
        }
        let Some(progress) = content.progress else { return };
        let (top, width) = (2 * MARGIN + LINES * CELL[1], SIZE[0] - 2 * MARGIN);
        let block = (width as f32 * BLOCK) as usize;
        let left = (progress.clamp(0.0, 1.0) * (width - block) as f32) as usize;
        for y in 0..BAR_HEIGHT {
            for x in 0..width {
                let is_frame = y == 0 || y + 1 == BAR_HEIGHT || x == 0 || x + 1 == width;
                if is_frame || (left..left + block).contains(&x) {
                    self.0[(top + y) * SIZE[0] + MARGIN + x] = 255;
                }
            }
        }
    }

    /// Writes the rows from the bottom, as GL takes them.
    fn flip_into(&self, rows: &mut Vec<u8>) {
        rows.clear();
        self.0.chunks_exact(SIZE[0]).rev().for_each(|row| rows.extend_from_slice(row));
    }
}

/// The panel on the GPU.
pub struct Hud {
    gl: Rc<Context>,
    program: Program,
    texture: Texture,
    letters: Letters,
    pixels: Pixels,
    rows: Vec<u8>,
    /// The text in the texture.
    text: String,
    progress: Option<f32>,
    /// Number of rows in use, counted from the top.
    used: usize,
    /// Number of changes of the text.
    version: u64,
}

impl Hud {
    /// Makes an empty panel.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses the program or the texture.
    pub fn new(gl: &Rc<Context>) -> Result<Hud, GlError> {
        Ok(Hud {
            gl: gl.clone(),
            program: Program::new(gl, ShaderSource::Screen("viewer/hud.frag"), &[])?,
            texture: Texture::new(gl, SIZE.map(|n| n as u32), Format::R8, Filter::Linear)?,
            letters: Letters::new(),
            pixels: Pixels(vec![0; SIZE[0] * SIZE[1]]),
            rows: Vec::with_capacity(SIZE[0] * SIZE[1]),
            text: String::with_capacity(256),
            progress: Some(f32::NAN),
            used: SIZE[1],
            version: 0,
        })
    }

    /// Changes the contents of the panel, unless they are the same, and returns it.
    pub fn set(&mut self, content: Content, placement: Placement) -> Panel<'_> {
        if self.text != content.text || self.progress != content.progress {
            self.text.clear();
            self.text.push_str(content.text);
            self.progress = content.progress;
            self.used = match content.progress {
                Some(_) => SIZE[1],
                None => 2 * MARGIN + content.text.lines().count().min(LINES) * CELL[1],
            };
            self.version += 1;
            self.pixels.draw(content, &self.letters);
            self.pixels.flip_into(&mut self.rows);
            self.texture.upload(&self.rows);
        }
        Panel { hud: self, placement }
    }

    /// Draws the part in use over a rectangle.
    fn draw(&self, to: &Destination) {
        let rectangle = [to.origin[0], to.origin[1], to.size[0], to.size[1]].map(|n| n as f32);
        self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
        self.set_text(self.program.bind(), 0).set("rectangle", Vec4::from(rectangle));
        self.gl.draw_screen();
    }

    /// Sets the uniforms and the texture of `include/panel.glsl` in a bound program.
    fn set_text<'a>(&self, program: &'a Program, unit: u32) -> &'a Program {
        program.texture("panel", unit, self.texture.raw()).set("used", self.used as f32 / SIZE[1] as f32)
    }
}

/// Where the panel is relative to the viewing direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// Below the viewing direction.
    Below,
    /// Straight ahead, when there is nothing else to look at.
    Middle,
}

/// The panel in one frame.
pub struct Panel<'a> {
    hud: &'a Hud,
    placement: Placement,
}

impl Panel<'_> {
    /// The largest size of a panel in pixels.
    pub const MAX_SIZE: [u32; 2] = [SIZE[0] as u32, SIZE[1] as u32];

    /// Returns the size in pixels.
    pub fn size(&self) -> [u32; 2] {
        [SIZE[0], self.hud.used].map(|n| n as u32)
    }

    /// Returns the size in metres.
    pub fn metres(&self) -> [f32; 2] {
        let width = WIDTH * DISTANCE;
        [width, width * self.hud.used as f32 / SIZE[0] as f32]
    }

    /// Returns the panel's centre in metres, relative to the point between the eyes.
    pub fn center(&self) -> Vec3 {
        Vec3::new(0.0, below(self.placement), -1.0) * DISTANCE
    }

    /// Returns a number that changes whenever the text does.
    pub fn version(&self) -> u64 {
        self.hud.version
    }

    /// Fills a rectangle of the panel's size. The background of the letters is translucent; colour is not premultiplied
    /// by alpha.
    pub fn draw(&self, to: &Destination) {
        let pass = self.declare(self.hud.gl.pass("hud"));
        pass.write([to.image(Format::Rgba8)]).run(|| {
            self.hud.gl.set_raster_state(&RasterState::SCREEN);
            self.hud.draw(to);
        });
    }

    /// Draws the panel into the images of both eyes.
    pub fn draw_into_eyes(&self, pair: &EyePair, eyes: &[Destination; 2]) {
        let gl = &self.hud.gl;
        let images = eyes.each_ref().map(|eye| eye.image(Format::Rgba8));
        self.declare(gl.pass("hud")).load(images).run(|| {
            gl.set_raster_state(&RasterState { blend: Blend::Over, ..RasterState::SCREEN });
            for eye in Eye::BOTH {
                let to = &eyes[eye.index()];
                let (corner, size) = self.place(pair, eye);
                let origin = [0, 1].map(|i| to.origin[i].saturating_add_signed(corner[i]));
                self.hud.draw(&Destination { origin, size, ..*to });
            }
            gl.set_raster_state(&RasterState::SCREEN);
        });
    }

    /// Declares that a pass reads the panel.
    pub(crate) fn declare<'a>(&self, pass: Pass<'a>) -> Pass<'a> {
        pass.read("panel", &self.hud.texture)
    }

    /// Sets what the lenses' pass reads to draw the panel over an eye.
    pub(crate) fn set(&self, program: &Program, unit: u32, pair: &EyePair, eye: Eye) {
        let (corner, size) = self.place(pair, eye);
        let scale = [0, 1].map(|i| pair.size[i] as f32 / size[i] as f32);
        let first = [0, 1].map(|i| -(corner[i] as f32) / size[i] as f32);
        let place = Vec4::new(scale[0], scale[1], first[0], first[1]);
        self.hud.set_text(program, unit).set("panel_place", place);
    }

    fn place(&self, pair: &EyePair, eye: Eye) -> ([i32; 2], [u32; 2]) {
        place(pair, eye, self.hud.used, self.placement)
    }
}

/// Returns the tangent of the vertical angle of the panel's centre.
fn below(placement: Placement) -> f32 {
    match placement {
        Placement::Below => -BELOW,
        Placement::Middle => 0.0,
    }
}

/// Returns the origin and the size, in pixels of an eye's image, of the panel's upper `used` rows.
fn place(pair: &EyePair, eye: Eye, used: usize, placement: Placement) -> ([i32; 2], [u32; 2]) {
    let frustum = &pair.frusta[eye.index()];
    let height = WIDTH * used as f32 / SIZE[0] as f32;
    let x = -eye.side() * pair.ipd() / 2.0 / DISTANCE - WIDTH / 2.0;
    let y = below(placement).max(frustum.bottom + height) - height / 2.0;
    let per_tangent = [pair.size[0] as f32 / frustum.width(), pair.size[1] as f32 / frustum.height()];
    let corner = [(x - frustum.left) * per_tangent[0], (y - frustum.bottom) * per_tangent[1]];
    let size = [WIDTH * per_tangent[0], height * per_tangent[1]];
    (corner.map(|n| n.round() as i32), size.map(|n| n.round().max(1.0) as u32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{DepthRange, Frustum, Pose};

    #[test]
    fn text_and_progress_bar_are_drawn_in_their_rows() {
        let letters = Letters::new();
        let mut panel = Pixels(vec![0; SIZE[0] * SIZE[1]]);
        let lit = |panel: &Pixels, rows: std::ops::Range<usize>| {
            panel.0[rows.start * SIZE[0]..rows.end * SIZE[0]].iter().filter(|&&p| p > 0).count()
        };
        panel.draw(Content { text: "60 FPS\nyoro", progress: None }, &letters);
        let line = |n: usize| MARGIN + n * CELL[1]..MARGIN + (n + 1) * CELL[1];
        assert!(lit(&panel, line(0)) > 100 && lit(&panel, line(1)) > 50);
        assert_eq!(lit(&panel, line(1).end..SIZE[1]), 0);
        panel.draw(Content { text: "", progress: Some(0.5) }, &letters);
        let top = 2 * MARGIN + LINES * CELL[1];
        assert_eq!(lit(&panel, 0..top), 0);
        // The moving part is a quarter of the bar.
        let (bar, width) = (lit(&panel, top..SIZE[1]), SIZE[0] - 2 * MARGIN);
        assert!(bar > width * BAR_HEIGHT / 4 && bar < width * BAR_HEIGHT / 2, "{bar}");
        panel.draw(Content { text: &"x".repeat(200), progress: Some(1.0) }, &letters);
        assert_eq!(panel.0[(top + 4) * SIZE[0] + SIZE[0] - MARGIN - 4], 255);
        let mut rows = Vec::new();
        panel.flip_into(&mut rows);
        assert_eq!(rows[..SIZE[0]], panel.0[(SIZE[1] - 1) * SIZE[0]..]);
    }

    #[test]
    fn the_panel_hangs_at_its_distance() {
        let frustum = Frustum::from_fov(-0.7, 0.7, 0.7, -0.7);
        let pair = EyePair::parallel(Pose::IDENTITY, frustum, 0.06, DepthRange::PAPER, [1000; 2], Eye::Right);
        let [left, right] = Eye::BOTH.map(|eye| place(&pair, eye, SIZE[1], Placement::Below));
        assert_eq!(left.1, right.1);
        let disparity = left.0[0] as f32 - right.0[0] as f32;
        assert!((disparity - 0.06 / DISTANCE * pair.focal_length_pixels()).abs() <= 1.0);
        assert!(left.0[1] + (left.1[1] as i32) < 500, "below the horizon");
    }
}
