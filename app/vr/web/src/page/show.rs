//! Shows finished images.

use std::ops::Range;
use std::rc::Rc;

use glam::Vec4;
use yoro::eyes::Eye;
use yoro_gl::{Context, Destination, Format, GlError, Program, RasterState, ShaderSource, Texture};
use yoro_render::stereo::StereoFrame;

use crate::settings::Display;

/// The position of images on the canvas, in pixels.
pub struct Layout {
    /// The lower left corner of the first or only image.
    pub origin: [u32; 2],
    /// Width and height of each image.
    pub size: [u32; 2],
    /// The distance from the first image's left edge to the second one's.
    pub step: u32,
    /// Columns of the image left of the divider, for displays with a divider.
    pub divider: u32,
}

impl Layout {
    /// Returns the layout for images of this aspect ratio, as large as possible and centred in parts of a canvas.
    pub fn whole(part: [u32; 2], [width, height]: [f32; 2]) -> Layout {
        let factor = (part[0] as f32 / width).min(part[1] as f32 / height);
        let size = [width, height].map(|side| ((side * factor).round() as u32).max(1));
        let origin = [part[0].saturating_sub(size[0]) / 2, part[1].saturating_sub(size[1]) / 2];
        Layout { origin, size, step: part[0], divider: 0 }
    }
}

/// The programs that show images, scaled to fill a rectangle.
pub struct Show {
    gl: Rc<Context>,
    plain: Program,
    anaglyph: Program,
    difference: Program,
    with_depth: Program,
}

fn compile(gl: &Rc<Context>, define: Option<&'static str>) -> Result<Program, GlError> {
    let defines: Vec<_> = define.into_iter().map(|name| (name, String::new())).collect();
    Program::new(gl, ShaderSource::Screen("viewer/show.frag"), &defines)
}

impl Show {
    pub fn new(gl: &Rc<Context>) -> Result<Show, GlError> {
        let program = |define| compile(gl, define);
        Ok(Show {
            gl: gl.clone(),
            plain: program(None)?,
            anaglyph: program(Some("ANAGLYPH"))?,
            difference: program(Some("DIFFERENCE"))?,
            with_depth: program(Some("WITH_DEPTH"))?,
        })
    }

    /// Writes depth as 24 bits of colour, red first, as WebGL cannot read depth. Compiles the program for each call.
    pub fn packed_depth(&self, depth: &Texture, to: &Destination) -> Result<(), GlError> {
        let program = compile(&self.gl, Some("PACKED_DEPTH"))?;
        self.run(&program, depth, None, to, 0..to.size[0]);
        Ok(())
    }

    /// Draws some columns of a rectangle; the images span the whole rectangle.
    fn run(
        &self,
        program: &Program,
        first: &Texture,
        second: Option<(&'static str, &Texture)>,
        to: &Destination,
        columns: Range<u32>,
    ) {
        let mut pass = self.gl.pass("show").read("first", first);
        if let Some((name, texture)) = second {
            pass = pass.read(name, texture);
        }
        pass.write([to.image(Format::Rgba8)]).run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN);
            let origin = [to.origin[0] + columns.start, to.origin[1]];
            self.gl.bind_framebuffer(to.framebuffer, origin, [columns.end - columns.start, to.size[1]]);
            self.draw(program, first, second, to);
        });
    }

    fn draw(&self, program: &Program, first: &Texture, second: Option<(&str, &Texture)>, to: &Destination) {
        let rectangle = [to.origin[0], to.origin[1], to.size[0], to.size[1]].map(|n| n as f32);
        program.bind().texture_of("first", 0, first).set("rectangle", Vec4::from(rectangle));
        if let Some((name, texture)) = second {
            program.texture_of(name, 1, texture);
        }
        self.gl.draw_screen();
    }

    /// Shows one image.
    pub fn image(&self, image: &Texture, to: &Destination) {
        self.run(&self.plain, image, None, to, 0..to.size[0]);
    }

    /// Shows the red of the left eye's image, and green and blue of the right eye's.
    pub fn anaglyph(&self, left: &Texture, right: &Texture, to: &Destination) {
        self.run(&self.anaglyph, left, Some(("second", right)), to, 0..to.size[0]);
    }

    /// Shows the real image left of the divider. Right of it is the method's image, or the difference of the two: black
    /// for equal pixels, white from a quarter of the range on.
    fn divided(&self, real: &Texture, made: &Texture, difference: bool, to: &Destination, divider: u32) {
        let [width, _] = to.size;
        let divider = divider.min(width);
        if divider > 0 {
            self.run(&self.plain, real, None, to, 0..divider);
        }
        if divider < width && difference {
            self.run(&self.difference, made, Some(("second", real)), to, divider..width);
        } else if divider < width {
            self.run(&self.plain, made, None, to, divider..width);
        }
    }

    /// Shows both eyes on a display. `real` is the image that the display compares with the non-dominant eye.
    pub fn eyes(
        &self,
        display: Display,
        frame: &StereoFrame,
        dominant: Eye,
        real: Option<&Texture>,
        layout: &Layout,
    ) {
        let Layout { origin: [x, y], size, step, divider } = *layout;
        let part = |x| Destination { framebuffer: None, origin: [x, y], size };
        let (first, second) = (part(x), part(x + step));
        let image = |eye: Eye| frame.eye(eye).color(0);
        let other = image(dominant.other());
        match display {
            Display::SideBySide | Display::CrossEyed => {
                let eye = if display == Display::SideBySide { Eye::Left } else { Eye::Right };
                self.image(image(eye), &first);
                self.image(image(eye.other()), &second);
            }
            Display::Anaglyph => self.anaglyph(image(Eye::Left), image(Eye::Right), &first),
            Display::Left => self.image(image(Eye::Left), &first),
            Display::Right => self.image(image(Eye::Right), &first),
            Display::Divider | Display::Difference | Display::Flicker => {
                let difference = display == Display::Difference;
                self.divided(real.unwrap_or(other), other, difference, &first, divider);
            }
        }
    }

    /// Draws an image with its depth into the framebuffer that is bound, which this library did not create.
    pub fn with_depth(&self, image: &Texture, depth: &Texture, origin: [u32; 2], size: [u32; 2]) {
        let to = Destination { framebuffer: None, origin, size };
        let pass = self.gl.pass("show").read("first", image).read("depth_map", depth);
        pass.write([to.image(Format::Rgba8)]).run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            self.draw(&self.with_depth, image, Some(("depth_map", depth)), &to);
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }
}
