//! The pass that draws and lights the opaque triangles.

use std::rc::Rc;

use glam::{Mat4, Vec3};

use super::cluster::{Culler, visible};
use super::layout::{Layout, Seam};
use super::scene::{Features, GpuScene};
use super::uniforms::{depth_test, eye_to_clip};
use yoro::eyes::{DepthRange, Eye, View};
use yoro_gl::{Context, GlError, Program, RasterState, ShaderSource, StencilTest};

/// A variant of the programs that draw triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// The views of the image.
    pub layout: Layout,
    /// The samples of a pixel.
    pub samples: u32,
    /// True if depth is written into a second colour, too (`include/carried.glsl`).
    pub carried: bool,
    /// True if the dominant eye's colours are taken where it sees the surface (`include/reprojection.glsl`).
    pub reprojected: bool,
    /// True if only the holes of a synthesized eye are drawn, with the bloom of the rendered one
    /// (`include/hole_bloom.glsl`).
    pub holes: bool,
}

impl Variant {
    /// Returns the variant that draws one view, and nothing besides.
    pub fn plain(samples: u32) -> Variant {
        Variant { layout: Layout::Single, samples, carried: false, reprojected: false, holes: false }
    }

    /// Returns the stencil test of opaque surfaces and sky.
    pub fn stencil(self) -> StencilTest {
        if self.holes { StencilTest::Equal(0) } else { StencilTest::Off }
    }

    /// Returns the defines of `render/geometry.vert`, `render/forward.frag` and `render/transparent.frag`.
    pub fn defines(self) -> Vec<(&'static str, String)> {
        let mut defines: Vec<_> = self.layout.defines().iter().map(|&name| (name, String::new())).collect();
        defines.extend(self.carried.then(|| ("CARRIED", self.samples.to_string())));
        defines.extend(self.reprojected.then(|| ("REPROJECTED", String::new())));
        defines
    }
}

/// The views of a draw, as the vertex shader takes them.
pub struct Eyes {
    layout: Layout,
    size: [u32; 2],
    positions: [Vec3; 2],
    to_clip: [Mat4; 2],
}

impl Eyes {
    /// Takes one view, or both eyes, which must have the same size.
    pub fn new(layout: Layout, views: &[View]) -> Eyes {
        // One of each for each eye. For a single view the second repeats the first and is not used.
        let both: [View; 2] = std::array::from_fn(|i| *views.get(i).unwrap_or(&views[0]));
        Eyes {
            layout,
            size: both[0].size,
            positions: both.map(|view| view.pose.position),
            to_clip: both.map(|view| eye_to_clip(&view)),
        }
    }

    /// Sets the uniforms of `render/geometry.vert` in a bound program.
    pub fn set(&self, program: &Program) {
        if self.layout == Layout::Single {
            program.set("eye", self.positions[0]).set("eye_to_clip", self.to_clip[0]);
            return;
        }
        let of = |eye: Eye| &self.to_clip[eye.index()];
        let placed = Eye::BOTH.map(|eye| self.layout.placement(self.size, eye) * *of(eye));
        let seams = Eye::BOTH.map(|eye| Layout::seam_plane(of(eye), eye));
        program
            .set("eyes", &self.positions[..])
            .set("eyes_to_clip", &placed[..])
            .set("seams", &seams[..])
            .set("seam", self.layout.origin(self.size, Eye::Right)[0] as f32);
    }

    /// True if the eyes are kept apart by clip distances.
    pub fn are_clipped(&self) -> bool {
        self.layout == Layout::DoubleWide(Seam::ClipDistance)
    }
}

/// Programs by [`Features::index`]; only those that a scene uses.
pub type Programs = [Option<Program>; Features::COMBINATIONS];

/// Draws and lights the opaque triangles of a scene into the bound framebuffer.
///
/// Writes display-referred colour (4 bytes a sample) and depth, and with [`Variant::carried`] depth as a colour; reads
/// the material's maps and the shadow map.
pub struct GeometryPass {
    gl: Rc<Context>,
    pub variant: Variant,
    /// True if cut-out materials cover samples by their alpha.
    alpha_to_coverage: bool,
    programs: Programs,
}

impl GeometryPass {
    /// Compiles the programs that the scene's materials need, with the defines of `render/forward.frag`.
    pub fn new(
        gl: &Rc<Context>,
        scene: &GpuScene,
        variant: Variant,
        shading: &[(&'static str, String)],
    ) -> Result<GeometryPass, GlError> {
        let mut programs = [const { None }; Features::COMBINATIONS];
        for (material, ..) in scene.opaque() {
            let slot: &mut Option<Program> = &mut programs[material.features.index()];
            if slot.is_none() {
                let mut defines = material.features.defines();
                defines.extend_from_slice(shading);
                defines.extend(variant.defines());
                let source =
                    ShaderSource::Raster { vertex: "render/geometry.vert", fragment: "render/forward.frag" };
                *slot = Some(Program::new(gl, source, &defines)?);
            }
        }
        Ok(GeometryPass { gl: gl.clone(), variant, alpha_to_coverage: variant.samples > 1, programs })
    }

    /// Returns all programs, for uniforms that are the same in all of them.
    pub fn programs(&self) -> impl Iterator<Item = &Program> {
        self.programs.iter().flatten()
    }

    /// Draws into an image of the pass's layout: one view, or both eyes, which must have the same size and depth range. Of a
    /// slice between two distances in metres, surfaces have the same depth as in the whole view.
    pub fn draw(&self, scene: &GpuScene, views: &[View], slice: Option<[f32; 2]>) {
        let Some(first) = views.first() else { return };
        let [near, far] = slice.unwrap_or([first.depth.near, first.depth.far]);
        let range = DepthRange { near, far, ..first.depth };
        let sliced: [View; 2] =
            std::array::from_fn(|i| View { depth: range, ..*views.get(i).unwrap_or(first) });
        let cullers = sliced.map(|view| Culler::of_view(&view));
        let cullers = &cullers[..views.len()];
        let eyes = Eyes::new(self.variant.layout, &sliced);
        let depth = depth_test(first.depth.convention);
        let stencil = self.variant.stencil();
        self.gl.set_depth_window(window(&first.depth, [near, far]));
        if eyes.are_clipped() {
            self.gl.set_clip_distance(true);
        }
        let mut bound = None;
        for (material, moves, clusters) in scene.opaque() {
            let Some(program) = &self.programs[material.features.index()] else { continue };
            let mut ranges = visible(cullers, clusters).peekable();
            if ranges.peek().is_none() {
                continue;
            }
            let state = RasterState { depth, cull: !material.double_sided, stencil, ..RasterState::SCREEN };
            self.gl.set_raster_state(&state);
            if self.alpha_to_coverage {
                self.gl.set_alpha_to_coverage(material.features.contains(Features::CUTOUT));
            }
            eyes.set(program.bind());
            scene.set_material(program, material);
            let mesh = scene.bind_mesh(moves, &mut bound);
            ranges.for_each(|range| mesh.draw(range, self.variant.layout.instances()));
        }
        if eyes.are_clipped() {
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
