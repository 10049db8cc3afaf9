//! Finished images on a screen.

use std::rc::Rc;

use glam::Vec4;
use yoro_gl::{Context, Destination, GlError, Program, RasterState, ShaderSource, Texture};

/// The programs that show images; they fill a rectangle, scaled to it.
pub struct Show {
    gl: Rc<Context>,
    plain: Program,
    anaglyph: Program,
    difference: Program,
    with_depth: Program,
}

impl Show {
    pub fn new(gl: &Rc<Context>) -> Result<Show, GlError> {
        let program = |define: Option<&'static str>| {
            let defines: Vec<_> = define.into_iter().map(|name| (name, String::new())).collect();
            Program::new(gl, ShaderSource::Screen("viewer/show.frag"), &defines)
        };
        Ok(Show {
            gl: gl.clone(),
            plain: program(None)?,
            anaglyph: program(Some("ANAGLYPH"))?,
            difference: program(Some("DIFFERENCE"))?,
            with_depth: program(Some("WITH_DEPTH"))?,
        })
    }

    fn run(&self, program: &Program, first: &Texture, second: Option<(&str, &Texture)>, to: &Destination) {
        self.gl.pass("show", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
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

    /// One image.
    pub fn image(&self, image: &Texture, to: &Destination) {
        self.run(&self.plain, image, None, to);
    }

    /// Red of the left eye's image, the rest of the right eye's.
    pub fn anaglyph(&self, left: &Texture, right: &Texture, to: &Destination) {
        self.run(&self.anaglyph, left, Some(("second", right)), to);
    }

    /// Where two images differ: black where they do not, white from a quarter of the range on.
    pub fn difference(&self, a: &Texture, b: &Texture, to: &Destination) {
        self.run(&self.difference, a, Some(("second", b)), to);
    }

    /// An image with its depth into the framebuffer that is bound, one that this library does not know, at its lower left
    /// corner.
    pub fn with_depth(&self, image: &Texture, depth: &Texture, origin: [u32; 2], size: [u32; 2]) {
        let to = Destination { framebuffer: None, origin, size };
        self.gl.pass("show", || {
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            self.draw(&self.with_depth, image, Some(("depth_map", depth)), &to);
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }
}
