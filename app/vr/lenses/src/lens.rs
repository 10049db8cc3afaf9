//! The pass that draws both eyes on the screen, with lens distortion, timewarp and dark
//! borders.

use std::rc::Rc;

use glam::{Mat4, Quat, Vec4};

use crate::hud::Panel;
use crate::optics::{Optics, mesh_strip};
use yoro::eyes::{Composition, Eye, EyePair, Frustum};
use yoro::opengl::{LevelImages, Part};
use yoro_gl::{Context, Destination, Format, GlError, Mesh, Pass, Program, RasterState, ShaderSource};

/// Width of the fade at the borders as a share of the image.
const BORDER: f32 = 0.03;
/// Width of the alignment line in metres, and its colour, a grey.
const LINE_WIDTH: f32 = 0.0006;
const LINE_COLOR: [f32; 4] = [0.35, 0.35, 0.35, 1.0];
/// First texture unit that levels leave free.
const PANEL_UNIT: u32 = 3;

/// Distortion meshes of both eyes and the program that draws them.
pub struct LensPass {
    gl: Rc<Context>,
    program: Program,
    /// Composes eyes of levels; `None` if there are none.
    of_levels: Option<Program>,
    meshes: [Mesh; 2],
    frusta: [Frustum; 2],
    line: f32,
}

impl LensPass {
    /// Compiles the program and makes the meshes for a viewer; with `levels`, also for eyes of levels.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses a program or a mesh.
    pub fn new(gl: &Rc<Context>, optics: &Optics, levels: bool) -> Result<LensPass, GlError> {
        let program = |levels: bool| {
            let defines: Vec<_> = levels.then(|| ("LEVELS", String::new())).into_iter().collect();
            let source = ShaderSource::Raster { vertex: "viewer/lens.vert", fragment: "viewer/lens.frag" };
            Program::new(gl, source, &defines)
        };
        let mesh = |eye| {
            // Position and uv of a `MeshVertex`.
            Mesh::new(gl, &[2, 2], &optics.mesh(eye), &mesh_strip())
        };
        let meshes = [mesh(Eye::Left)?, mesh(Eye::Right)?];
        let frusta = Eye::BOTH.map(|eye| optics.frustum(eye));
        let line = LINE_WIDTH / optics.screen()[0];
        Ok(LensPass {
            gl: gl.clone(),
            program: program(false)?,
            of_levels: levels.then(|| program(true)).transpose()?,
            meshes,
            frusta,
            line,
        })
    }

    /// Fills the window from the left and the right eye: for each its images, filtered linearly, and their places. Eyes of
    /// levels are composed on the way, and a panel is drawn over them, as these eyes see it; nothing is drawn if the pass was
    /// not made for levels. `turn` rotates directions from the head's current frame to its frame when the images were
    /// rendered.
    pub fn run(
        &self,
        eyes: &[(LevelImages, Composition); 2],
        panel: Option<(&Panel, &EyePair)>,
        turn: Quat,
        window: &Destination,
    ) {
        let pass = self.gl.pass("lens").write([window.image(Format::Rgba8)]);
        let pass = eyes.iter().fold(pass, |pass, (_, composition)| LevelImages::declare(pass, composition));
        if eyes.iter().all(|(images, _)| images.inset.is_none()) {
            return self.draw(pass, &self.program, turn, window, |eye| {
                let (LevelImages { wide, .. }, composition) = &eyes[eye.index()];
                let place = wide.part.map_or(Vec4::new(1.0, 1.0, 0.0, 0.0), |Part { origin, image_size }| {
                    let [[w, h], [x, y]] = [composition.wide.size, origin]
                        .map(|n| [0, 1].map(|i| n[i] as f32 / image_size[i] as f32));
                    Vec4::new(w, h, x, y)
                });
                self.program.set("image_place", place).texture("image", 0, wide.color);
            });
        }
        let Some(program) = &self.of_levels else { return };
        let pass = panel.into_iter().fold(pass, |pass, (panel, _)| panel.declare(pass));
        self.draw(pass, program, turn, window, |eye| {
            let (images, composition) = &eyes[eye.index()];
            images.set(program, composition, [0, 0]);
            match panel {
                Some((panel, pair)) => panel.set(program, PANEL_UNIT, pair, eye),
                // Outside of every place; every sampler needs a texture.
                None => {
                    program
                        .texture("panel", PANEL_UNIT, images.wide.color)
                        .set("panel_place", Vec4::new(0.0, 0.0, -1.0, -1.0));
                }
            }
        });
    }

    fn draw(&self, pass: Pass, program: &Program, turn: Quat, window: &Destination, set_eye: impl Fn(Eye)) {
        let [width, height] = window.size;
        pass.run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.gl.bind_framebuffer(window.framebuffer, window.origin, window.size);
            self.gl.fill(window.origin, window.size, [0.0, 0.0, 0.0, 1.0]);
            program.bind().set("turn", Mat4::from_quat(turn)).set("border", BORDER);
            for eye in Eye::BOTH {
                let frustum = &self.frusta[eye.index()];
                let rectangle = Vec4::new(frustum.left, frustum.bottom, frustum.width(), frustum.height());
                program.set("frustum", rectangle);
                set_eye(eye);
                let mesh = &self.meshes[eye.index()];
                mesh.bind();
                mesh.draw_strip();
            }
            // An even width, so that the line is symmetric on an even window.
            let line = ((self.line * width as f32 / 2.0).round() as u32).max(1) * 2;
            let x = (width / 2).saturating_sub(line / 2);
            self.gl.fill([window.origin[0] + x, window.origin[1]], [line.min(width), height], LINE_COLOR);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    use crate::optics::{Distortion, MESH_RESOLUTION, Rotation, Screen};
    use crate::params::ViewerParams;
    use yoro::eyes::LevelPlace;
    use yoro::opengl::LevelImage;
    use yoro_context::{Backend, Headless};
    use yoro_gl::{Filter, RenderTarget};

    const WINDOW: [u32; 2] = [320, 180];

    fn screen() -> Screen {
        // 110 x 62 mm.
        Screen { size: WINDOW, dpi: [74.0; 2], rotation: Rotation::LandscapeLeft }
    }

    fn optics() -> Optics {
        Optics::new(&ViewerParams::v1(), screen().metres())
    }

    fn window(gl: &Rc<Context>) -> RenderTarget {
        RenderTarget::new(gl, WINDOW, &[(Format::Rgba8, Filter::Nearest)], None).unwrap()
    }

    /// Reads the window's pixel at a position in metres from its lower left corner.
    fn pixel(window: &RenderTarget, metres: Vec2) -> [u8; 4] {
        let size = screen().metres();
        let at = [0, 1].map(|i| (metres[i] / size[i] * WINDOW[i] as f32) as u32);
        window.read_rgba8(0, at, [1, 1]).try_into().unwrap()
    }

    /// Two images of one colour each, with a white column in the middle (tangent 0).
    fn marked_eyes(gl: &Rc<Context>, optics: &Optics) -> [RenderTarget; 2] {
        let size = [256, 256];
        Eye::BOTH.map(|eye| {
            let target = RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Linear)], None).unwrap();
            let color = [[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]][eye.index()];
            let frustum = optics.frustum(eye);
            let middle = (-frustum.left / frustum.width() * size[0] as f32) as u32;
            target.bind();
            gl.fill([0, 0], size, color);
            gl.fill([middle - 4, 0], [8, size[1]], [1.0; 4]);
            target
        })
    }

    /// Returns eyes that fill their images, or are this part of them.
    fn shown(eyes: &[RenderTarget; 2], part: Option<(Part, [u32; 2])>) -> [(LevelImages, Composition); 2] {
        eyes.each_ref().map(|eye| {
            let size = part.map_or(eye.size(), |(_, size)| size);
            let wide = LevelImage { color: eye.color(0).raw(), part: part.map(|(part, _)| part) };
            let place = LevelPlace { size, scale: [1.0; 2], offset: [0.0; 2] };
            (LevelImages { wide, inset: None }, Composition { size, wide: place, inset: None })
        })
    }

    /// An eye that is a part of its image looks as in an image of its own.
    #[test]
    fn an_eye_may_be_a_part_of_its_image() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let (gl, optics) = (headless.gl(), optics());
        let (eyes, window) = (marked_eyes(gl, &optics), window(gl));
        let part = Part { origin: [37, 5], image_size: [320, 270] };
        let around = eyes.each_ref().map(|eye| {
            let image =
                RenderTarget::new(gl, part.image_size, &[(Format::Rgba8, Filter::Linear)], None).unwrap();
            image.bind();
            gl.fill([0, 0], part.image_size, [0.0, 1.0, 0.0, 1.0]);
            let to = Destination { origin: part.origin, size: eye.size(), ..Destination::whole(&image) };
            eye.copy_color([0, 0], &to);
            image
        });
        let lens = LensPass::new(gl, &optics, false).unwrap();
        let [whole, cropped] =
            [shown(&eyes, None), shown(&around, Some((part, eyes[0].size())))].map(|eyes| {
                lens.run(&eyes, None, Quat::from_rotation_y(0.2), &Destination::whole(&window));
                window.read_rgba8(0, [0, 0], WINDOW)
            });
        let largest = whole.iter().zip(&cropped).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(largest <= Some(1), "{largest:?} levels");
    }

    #[test]
    fn each_eye_sees_its_own_image_around_its_lens() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let (gl, optics) = (headless.gl(), optics());
        let (eyes, window) = (marked_eyes(gl, &optics), window(gl));
        let lens = LensPass::new(gl, &optics, false).unwrap();
        lens.run(&shown(&eyes, None), None, Quat::IDENTITY, &Destination::whole(&window));
        for (eye, color) in Eye::BOTH.into_iter().zip([[255, 0, 0, 255], [0, 0, 255, 255]]) {
            let center = optics.lens_center(eye);
            assert_eq!(pixel(&window, center), [255; 4], "straight ahead is at the lens's centre");
            for side in [-0.010, 0.010] {
                assert_eq!(pixel(&window, center + Vec2::new(side, 0.0)), color);
            }
        }
        let [line, ..] = pixel(&window, Vec2::new(screen().metres()[0] / 2.0, 0.001));
        assert_eq!(line, 89, "the alignment line");
        assert_eq!(pixel(&window, Vec2::new(0.0005, 0.0005)), [0, 0, 0, 255], "no lens shows the corner");
        assert_eq!(gl.take_errors(), None);
    }

    #[test]
    fn straight_lines_bow_towards_the_lens() {
        // The lens magnifies the border more than the middle (pincushion), so the screen shows a barrel: a vertical
        // line beside the centre is closer to it at its ends.
        let mesh = optics().mesh(Eye::Left);
        let center = optics().lens_center(Eye::Left).x / screen().metres()[0] * 2.0 - 1.0;
        let distance = |row: usize| (mesh[row * MESH_RESOLUTION].position.x - center).abs();
        assert!(distance(0) < distance(20) && distance(39) < distance(20));
    }

    /// Returns the mean column of the white mark in the left half, at the height of the lens.
    fn mark(window: &RenderTarget, optics: &Optics) -> f32 {
        let row = (optics.lens_center(Eye::Left).y / screen().metres()[1] * WINDOW[1] as f32) as u32;
        let pixels = window.read_rgba8(0, [0, row], [WINDOW[0] / 2 - 4, 1]);
        let white: Vec<usize> =
            (0..pixels.len() / 4).filter(|&x| pixels[x * 4..x * 4 + 3].iter().all(|&c| c > 200)).collect();
        white.iter().sum::<usize>() as f32 / white.len() as f32
    }

    #[test]
    fn timewarp_turns_the_image_against_the_head() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let (gl, optics) = (headless.gl(), optics());
        let (eyes, window) = (marked_eyes(gl, &optics), window(gl));
        let lens = LensPass::new(gl, &optics, false).unwrap();
        let at = |turn| {
            lens.run(&shown(&eyes, None), None, turn, &Destination::whole(&window));
            mark(&window, &optics)
        };
        let still = at(Quat::IDENTITY);
        // What was straight ahead is 10 degrees to the right once the head has turned 10 degrees to the left.
        let angle = 10f32.to_radians();
        let turned = at(Quat::from_rotation_y(angle));
        let metres = Distortion::new(&[0.441, 0.156]).undistort(angle.tan()) * 0.042;
        let expected = metres / screen().metres()[0] * WINDOW[0] as f32;
        assert!((turned - still - expected).abs() < 1.0, "{still} -> {turned}, expected {expected}");
        assert!(at(Quat::from_rotation_y(-angle)) < still);
    }
}
