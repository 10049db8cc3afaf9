//! Passes that draw the opaque triangles, into the g-buffer or lit at once.

use std::rc::Rc;

use glam::{Mat4, Vec3};

use super::cluster::{Culler, visible};
use super::g_buffer::{Layout, Seam};
use super::scene::{Features, GpuScene};
use super::uniforms::{depth_test, eye_to_clip};
use yoro::eyes::{DepthRange, Eye, View};
use yoro_gl::{Blend, Context, GlError, Program, RasterState, ShaderSource};

/// A part of the opaque triangles.
#[derive(Clone, Copy)]
pub enum Part<'a> {
    /// Clusters that a culler lets through, for one view.
    Selected(&'a Culler),
    /// Surfaces between two distances in metres, drawn at the same depth as in the whole view.
    Slice([f32; 2]),
}

/// Draws the opaque triangles of a scene into the bound framebuffer.
///
/// Writes the g-buffer's three colour textures (12 bytes a pixel), or display-referred colour (4 bytes a sample), and
/// depth; reads the material's maps.
pub struct GeometryPass {
    gl: Rc<Context>,
    layout: Layout,
    /// True if cut-out materials cover samples by their alpha.
    alpha_to_coverage: bool,
    /// Programs by [`Features::index`]; only those that the scene uses.
    programs: [Option<Program>; Features::COMBINATIONS],
}

impl GeometryPass {
    /// Makes a pass that draws into the g-buffer. Compiles the variants that the scene's materials need.
    pub fn deferred(gl: &Rc<Context>, scene: &GpuScene, layout: Layout) -> Result<GeometryPass, GlError> {
        GeometryPass::new(gl, scene, layout, "render/geometry.frag", &scene.style_defines(), false)
    }

    /// Makes a pass that lights surfaces as it draws them. Compiles the variants that the scene's materials need, with
    /// the defines of `render/forward.frag`. With `multisample`, cut-out materials cover samples by their alpha.
    pub fn forward(
        gl: &Rc<Context>,
        scene: &GpuScene,
        layout: Layout,
        defines: &[(&'static str, String)],
        multisample: bool,
    ) -> Result<GeometryPass, GlError> {
        GeometryPass::new(gl, scene, layout, "render/forward.frag", defines, multisample)
    }

    fn new(
        gl: &Rc<Context>,
        scene: &GpuScene,
        layout: Layout,
        fragment: &str,
        more_defines: &[(&'static str, String)],
        alpha_to_coverage: bool,
    ) -> Result<GeometryPass, GlError> {
        let mut programs = [const { None }; Features::COMBINATIONS];
        for (material, ..) in scene.opaque() {
            let slot: &mut Option<Program> = &mut programs[material.features.index()];
            if slot.is_none() {
                let mut defines = material.features.defines();
                defines.extend_from_slice(more_defines);
                defines.extend(layout.defines().iter().map(|&name| (name, String::new())));
                let source = ShaderSource::Raster { vertex: "render/geometry.vert", fragment };
                *slot = Some(Program::new(gl, source, &defines)?);
            }
        }
        Ok(GeometryPass { gl: gl.clone(), layout, alpha_to_coverage, programs })
    }

    /// Returns all programs, for uniforms that are the same in all of them.
    pub fn programs(&self) -> impl Iterator<Item = &Program> {
        self.programs.iter().flatten()
    }

    /// Draws into a target of the pass's layout: one view, or both eyes, which must have the same size and depth range.
    pub fn draw(&self, scene: &GpuScene, views: &[View], part: &Part) {
        let Some(first) = views.first() else { return };
        match *part {
            Part::Selected(culler) => {
                let cullers = std::slice::from_ref(culler);
                self.draw_culled(scene, views, cullers, &[eye_to_clip(first); 2], [0.0, 1.0]);
            }
            Part::Slice([near, far]) => {
                let depth = DepthRange { near, far, ..first.depth };
                // One of each for each eye. For a single view the second repeats the first and is not used.
                let sliced: [View; 2] =
                    std::array::from_fn(|i| View { depth, ..*views.get(i).unwrap_or(first) });
                let (cullers, matrices) =
                    (sliced.map(|view| Culler::of_view(&view)), sliced.map(|view| eye_to_clip(&view)));
                let cullers = &cullers[..views.len()];
                self.draw_culled(scene, views, cullers, &matrices, window(&first.depth, [near, far]));
            }
        }
    }

    fn draw_culled(
        &self,
        scene: &GpuScene,
        views: &[View],
        cullers: &[Culler],
        matrices: &[Mat4; 2],
        depth_window: [f32; 2],
    ) {
        let Some(first) = views.first() else { return };
        let eyes: [Vec3; 2] = std::array::from_fn(|i| views.get(i).unwrap_or(first).pose.position);
        let placed = Eye::BOTH.map(|eye| self.layout.placement(first.size, eye) * matrices[eye.index()]);
        let seams = Eye::BOTH.map(|eye| Layout::seam_plane(&matrices[eye.index()], eye));
        let clip = self.layout == Layout::DoubleWide(Seam::ClipDistance);
        let depth = depth_test(first.depth.convention);
        self.gl.set_depth_window(depth_window);
        if clip {
            self.gl.set_clip_distance(true);
        }
        let mut bound = None;
        for (material, moves, clusters) in scene.opaque() {
            let Some(program) = &self.programs[material.features.index()] else { continue };
            let mut ranges = visible(cullers, clusters).peekable();
            if ranges.peek().is_none() {
                continue;
            }
            let state = RasterState { depth, blend: Blend::Off, cull: !material.double_sided };
            self.gl.set_raster_state(&state);
            if self.alpha_to_coverage {
                self.gl.set_alpha_to_coverage(material.features.contains(Features::CUTOUT));
            }
            program.bind();
            if self.layout == Layout::Single {
                program.set("eye", eyes[0]).set("eye_to_clip", matrices[0]);
            } else {
                program
                    .set("eyes", &eyes[..])
                    .set("eyes_to_clip", &placed[..])
                    .set("seams", &seams[..])
                    .set("seam", self.layout.origin(first.size, Eye::Right)[0] as f32);
            }
            scene.set_material(program, material);
            let mesh = scene.bind_mesh(moves, &mut bound);
            ranges.for_each(|range| mesh.draw(range, self.layout.instances()));
        }
        if clip {
            self.gl.set_clip_distance(false);
        }
        if self.alpha_to_coverage {
            self.gl.set_alpha_to_coverage(false);
        }
        self.gl.set_depth_window([0.0, 1.0]);
    }
}

/// Returns the part of the depth buffer that a slice (near and far plane in metres) of a depth range covers.
fn window(range: &DepthRange, [near, far]: [f32; 2]) -> [f32; 2] {
    // At the range's own planes the result is exact, free of rounding.
    let depth = |distance: f32, plane: f32, at_plane: f32| {
        if distance == plane { at_plane } else { range.depth(distance) }
    };
    let far_value = range.clear_value();
    let (near, far) = (depth(near, range.near, 1.0 - far_value), depth(far, range.far, far_value));
    [near.min(far), near.max(far)]
}
