//! The mask of the pixels that the lenses hide in each eye's image (XR_KHR_visibility_mask).

use std::rc::Rc;

use glam::Vec4;
use openxr as xr;

use super::error::{XrError, call};
use yoro::eyes::{Eye, Frustum};
use yoro_gl::{Context, Destination, Format, GlError, Mesh, Program, RasterState, ShaderSource};

/// The hidden parts of both eyes.
pub(super) struct Mask {
    gl: Rc<Context>,
    program: Program,
    /// `None` where nothing is hidden.
    meshes: [Option<Mesh>; 2],
}

impl Mask {
    /// Compiles the program.
    pub fn new(gl: &Rc<Context>) -> Result<Mask, GlError> {
        let source = ShaderSource::Raster { vertex: "openxr/hidden.vert", fragment: "openxr/hidden.frag" };
        Ok(Mask { gl: gl.clone(), program: Program::new(gl, source, &[])?, meshes: [None, None] })
    }

    /// Asks the runtime for the hidden part of an eye.
    pub fn update(
        &mut self,
        session: &xr::Session<xr::OpenGlEs>,
        views: xr::ViewConfigurationType,
        eye: Eye,
    ) -> Result<(), XrError> {
        let kind = xr::VisibilityMaskTypeKHR::HIDDEN_TRIANGLE_MESH;
        let mask =
            call("xrGetVisibilityMaskKHR", session.get_visibility_mask_khr(views, eye.index() as u32, kind))?;
        let vertices: Vec<[f32; 2]> = mask.vertices.iter().map(|v| [v.x, v.y]).collect();
        Ok(self.set(eye, &vertices, &mask.indices)?)
    }

    /// Sets a mesh of triangles whose vertices are tangents of view angles.
    fn set(&mut self, eye: Eye, vertices: &[[f32; 2]], indices: &[u32]) -> Result<(), GlError> {
        let whole = indices.len() - indices.len() % 3;
        let fits = indices[..whole].iter().all(|&i| (i as usize) < vertices.len());
        if !fits {
            log::warn!("the runtime's visibility mask names points that do not exist: it is ignored");
        }
        self.meshes[eye.index()] = (fits && whole > 0)
            .then(|| Mesh::new(&self.gl, &[2], vertices, &indices[..whole]))
            .transpose()?;
        Ok(())
    }

    /// True if anything is hidden.
    pub fn hides(&self) -> bool {
        self.meshes.iter().any(Option::is_some)
    }

    /// Blackens the hidden parts of both eyes. The compositor shows nothing there even after reprojection, and black
    /// compresses well.
    pub fn draw(&self, frusta: &[Frustum; 2], to: &[Destination; 2]) {
        if !self.hides() {
            return;
        }
        let images = to.each_ref().map(|eye| eye.image(Format::Rgba8));
        self.gl.pass("visibility mask").load(images).run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN);
            for eye in Eye::BOTH {
                let (Some(mesh), f) = (&self.meshes[eye.index()], &frusta[eye.index()]) else { continue };
                let to = &to[eye.index()];
                self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
                self.program.bind().set("frustum", Vec4::new(f.left, f.bottom, f.width(), f.height()));
                mesh.bind();
                mesh.draw(0..mesh.index_count(), 1);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro_context::{Backend, Headless};
    use yoro_gl::{Filter, RenderTarget};

    #[test]
    fn hidden_triangles_are_black_and_nothing_else() {
        let headless = Headless::open(Backend::Egl).unwrap();
        let gl = headless.gl();
        let mut mask = Mask::new(gl).unwrap();
        // Covers the left half of a frustum from -1 to 1.
        mask.set(Eye::Left, &[[-1.0, -1.0], [0.0, -1.0], [0.0, 1.0], [-1.0, 1.0]], &[0, 1, 2, 0, 2, 3])
            .unwrap();
        mask.set(Eye::Right, &[[0.0, 0.0]], &[0, 1, 2]).unwrap();
        let image = || RenderTarget::new(gl, [8, 8], &[(Format::Rgba8, Filter::Nearest)], None).unwrap();
        let images = [image(), image()];
        for image in &images {
            image.bind();
            gl.fill([0, 0], [8, 8], [1.0; 4]);
        }
        let frustum = Frustum { left: -1.0, right: 1.0, bottom: -1.0, top: 1.0 };
        let to = [Destination::whole(&images[0]), Destination::whole(&images[1])];
        mask.draw(&[frustum; 2], &to);
        let row = images[0].read_rgba8(0, [0, 3], [8, 1]);
        let red: Vec<u8> = row.iter().step_by(4).copied().collect();
        assert_eq!(red, [0, 0, 0, 0, 255, 255, 255, 255]);
        assert!(
            images[1].read_rgba8(0, [0, 0], [8, 8]).iter().all(|&c| c == 255),
            "a damaged mask hides nothing"
        );
        assert_eq!(gl.take_errors(), None);
    }
}
