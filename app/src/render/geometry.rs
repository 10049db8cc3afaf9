//! The g-buffer pass.

use std::rc::Rc;

use super::cluster::Culler;
use super::scene::{Features, GpuScene};
use super::uniforms::{depth_test, eye_to_clip};
use crate::eyes::View;
use crate::gl::{Blend, Context, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource};
use crate::scene::ShadingStyle;

/// Colour attachments of the g-buffer: albedo and roughness, normal and reflectance, emission and material.
pub const FORMATS: [(Format, Filter); 3] = [(Format::Rgba8, Filter::Nearest); 3];

/// Draws the opaque triangles of a scene.
///
/// Writes the g-buffer's three colour textures (12 bytes a pixel) and its depth; reads the material's maps.
pub struct GeometryPass {
    gl: Rc<Context>,
    /// By [`Features::index`]; those that the scene uses.
    programs: [Option<Program>; Features::COMBINATIONS],
}

/// Whether a style has one normal per triangle.
pub fn style_defines(style: ShadingStyle) -> Vec<(&'static str, String)> {
    let name = match style {
        ShadingStyle::Realistic => "STYLE_REALISTIC",
        ShadingStyle::Cartoon => "STYLE_CARTOON",
        ShadingStyle::LowPoly => "STYLE_LOW_POLY",
        ShadingStyle::Voxel => "STYLE_VOXEL",
        ShadingStyle::Anime => "STYLE_ANIME",
    };
    let mut defines = vec![(name, String::new())];
    if matches!(style, ShadingStyle::LowPoly | ShadingStyle::Voxel) {
        defines.push(("FACE_NORMALS", String::new()));
    }
    defines
}

impl GeometryPass {
    /// Compiles the variants that the scene's materials need.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn new(gl: &Rc<Context>, scene: &GpuScene) -> Result<GeometryPass, GlError> {
        let mut programs = [const { None }; Features::COMBINATIONS];
        for (material, _) in scene.opaque() {
            let slot: &mut Option<Program> = &mut programs[material.features.index()];
            if slot.is_none() {
                let mut defines = material.features.defines();
                defines.extend(style_defines(scene.style));
                let source =
                    ShaderSource::Raster { vertex: "render/geometry.vert", fragment: "render/geometry.frag" };
                *slot = Some(Program::new(gl, source, &defines)?);
            }
        }
        Ok(GeometryPass { gl: gl.clone(), programs })
    }

    /// Clears the g-buffer and draws what the culler lets through.
    pub fn run(&self, target: &RenderTarget, scene: &GpuScene, view: &View, culler: &Culler) {
        self.gl.pass("g-buffer", || {
            target.bind();
            self.gl.clear(Some(view.depth.clear_value()));
            let depth = depth_test(view.depth.convention);
            let matrix = eye_to_clip(view);
            scene.mesh.bind();
            for (material, clusters) in scene.opaque() {
                let Some(program) = &self.programs[material.features.index()] else { continue };
                let mut ranges = culler.visible(clusters).peekable();
                if ranges.peek().is_none() {
                    continue;
                }
                let state = RasterState { depth, blend: Blend::Off, cull: !material.double_sided };
                self.gl.set_raster_state(&state);
                program.bind().set("eye", view.pose.position).set("eye_to_clip", matrix);
                scene.set_material(program, material);
                ranges.for_each(|range| scene.mesh.draw(range, 1));
            }
        });
    }
}
