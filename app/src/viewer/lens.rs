//! The pass that puts both eyes on the screen: lens distortion, chromatic correction, timewarp, vignette.

use std::rc::Rc;

use glam::{Mat4, Quat, Vec2, Vec3, Vec4};

use super::optics::{MeshVertex, Optics, mesh_strip};
use crate::eyes::{Eye, Frustum};
use crate::gl::{Context, Destination, GlError, Mesh, Program, RasterState, ShaderSource};
use crate::scene::Vertex;
use crate::stereo::StereoFrame;

/// How much further from the axis red and blue light is seen through a lens than green, for which lenses are
/// specified: acrylic (Abbe number 57, n - 1 of 0.494) at a screen's 620, 530 and 460 nm.
const DISPERSION: [f32; 2] = [0.9913, 1.0106];
/// Width of the vignette as a part of the image.
const VIGNETTE: f32 = 0.03;
/// Width of the alignment line in metres, and its grey.
const LINE_WIDTH: f32 = 0.0006;
const LINE_COLOR: [f32; 4] = [0.35, 0.35, 0.35, 1.0];

/// Distortion meshes of both eyes and the program that draws them.
pub(super) struct LensPass {
    gl: Rc<Context>,
    program: Program,
    meshes: [Mesh; 2],
    frusta: [Frustum; 2],
    line: f32,
}

impl LensPass {
    /// Compiles the program and makes the meshes of a viewer; `chromatic` turns chromatic correction on.
    pub fn new(gl: &Rc<Context>, optics: &Optics, chromatic: bool) -> Result<LensPass, GlError> {
        let defines = if chromatic { vec![("CHROMATIC", String::new())] } else { Vec::new() };
        let source = ShaderSource::Raster { vertex: "viewer/lens.vert", fragment: "viewer/lens.frag" };
        let program = Program::new(gl, source, &defines)?;
        let mesh = |eye| {
            let vertex =
                |v: MeshVertex| Vertex { position: v.position.extend(0.0), normal: Vec3::ZERO, uv: v.uv };
            let vertices: Vec<Vertex> = optics.mesh(eye).into_iter().map(vertex).collect();
            Mesh::new(gl, &vertices, &mesh_strip())
        };
        let meshes = [mesh(Eye::Left)?, mesh(Eye::Right)?];
        let frusta = Eye::BOTH.map(|eye| optics.frustum(eye));
        let line = LINE_WIDTH / optics.screen()[0];
        Ok(LensPass { gl: gl.clone(), program, meshes, frusta, line })
    }

    /// Fills the window. `turn` rotates a direction of the head as it is now into the head as it was when the
    /// frame was rendered.
    pub fn run(&self, frame: &StereoFrame, turn: Quat, window: &Destination) {
        let [width, height] = window.size;
        self.gl.pass("lens", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            self.gl.bind_framebuffer(window.framebuffer, window.origin, window.size);
            self.gl.fill(window.origin, window.size, [0.0, 0.0, 0.0, 1.0]);
            self.program
                .bind()
                .set("turn", Mat4::from_quat(turn))
                .set("dispersion", Vec2::from(DISPERSION))
                .set("vignette", VIGNETTE);
            for eye in Eye::BOTH {
                let frustum = &self.frusta[eye.index()];
                let rectangle = Vec4::new(frustum.left, frustum.bottom, frustum.width(), frustum.height());
                self.program.texture("image", 0, frame.eye(eye).color(0).raw()).set("frustum", rectangle);
                let mesh = &self.meshes[eye.index()];
                mesh.bind();
                mesh.draw_strip();
            }
            // Even, so that it lies symmetrically on an even width.
            let line = ((self.line * width as f32 / 2.0).round() as u32).max(1) * 2;
            let x = (width / 2).saturating_sub(line / 2);
            self.gl.fill([window.origin[0] + x, window.origin[1]], [line.min(width), height], LINE_COLOR);
        });
    }
}
