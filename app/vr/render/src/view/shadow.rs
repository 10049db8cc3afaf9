//! The sun's shadow map.

use std::rc::Rc;

use glam::{Mat4, Quat, Vec3};

use super::cluster::Culler;
use super::scene::{Features, GpuScene};
use yoro::eyes::Pose;
use yoro_assets::{Bounds, Viewpoint};
use yoro_gl::{Context, DepthTest, Format, GlError, Pass, Program, RasterState, RenderTarget, ShaderSource};

/// Distance from the viewpoints, in metres, within which a large scene has shadows.
const REACH: f32 = 60.0;

/// Shadow map of a scene, drawn once, and again whenever something moves.
///
/// Writes a depth texture of its own; reads diffuse maps for alpha.
pub struct ShadowMap {
    target: RenderTarget,
    /// Transform from world space to the cube from 0 to 1.
    matrix: Mat4,
    /// See `include/shade.glsl`.
    texel: Vec3,
    /// `None` if the scene never moves.
    programs: Option<Programs>,
}

/// The programs that draw casters.
struct Programs {
    solid: Program,
    /// For casters cut out by the opacity of their colour.
    colored: Program,
    /// For casters cut out by a diffuse map.
    mapped: Program,
}

impl Programs {
    fn new(gl: &Rc<Context>) -> Result<Programs, GlError> {
        let program = |features: Features| {
            let source =
                ShaderSource::Raster { vertex: "render/geometry.vert", fragment: "render/shadow.frag" };
            Program::new(gl, source, &features.defines())
        };
        Ok(Programs {
            solid: program(Features::default())?,
            colored: program(Features::CUTOUT)?,
            mapped: program(Features::CUTOUT.or(Features::DIFFUSE_MAP))?,
        })
    }
}

impl ShadowMap {
    /// Draws the shadow map of a scene, `size` texels wide.
    pub fn new(gl: &Rc<Context>, scene: &GpuScene, size: u32) -> Result<ShadowMap, GlError> {
        let size = size.min(gl.capabilities().max_texture_size);
        let target = RenderTarget::shadow_map(gl, [size, size], Format::Depth16)?;
        let mut map = ShadowMap { target, matrix: Mat4::IDENTITY, texel: Vec3::ONE, programs: None };
        let programs = Programs::new(gl)?;
        map.draw(gl, scene, &programs);
        map.programs = scene.moves().then_some(programs);
        Ok(map)
    }

    /// Redraws the map of a scene that has moved.
    pub fn renew(&mut self, gl: &Context, scene: &GpuScene) {
        if let Some(programs) = self.programs.take() {
            self.draw(gl, scene, &programs);
            self.programs = Some(programs);
        }
    }

    fn draw(&mut self, gl: &Context, scene: &GpuScene, programs: &Programs) {
        let [size, _] = self.target.size();
        let (to_clip, extent) = light_box(scene.bounds(), &scene.viewpoints, scene.sky.sun_direction);
        let texel = extent.x.max(extent.y) / size as f32;
        scene.declare(gl.pass("shadow"), 1).write(self.target.images()).run(|| {
            self.target.bind();
            gl.clear(Some(1.0));
            let culler = Culler::new(Vec3::ZERO, &to_clip);
            let mut bound = None;
            for (material, moves, clusters) in scene.opaque() {
                let features = material.features.and(Features::CUTOUT.or(Features::DIFFUSE_MAP));
                let program = if !features.contains(Features::CUTOUT) {
                    &programs.solid
                } else if features.contains(Features::DIFFUSE_MAP) {
                    &programs.mapped
                } else {
                    &programs.colored
                };
                // Rooms are often shells that face inwards; the sun should pass through their roofs.
                let state = RasterState {
                    depth: DepthTest::Less,
                    cull: !material.double_sided,
                    ..RasterState::SCREEN
                };
                gl.set_raster_state(&state);
                program.bind().set("eye", Vec3::ZERO).set("eye_to_clip", to_clip);
                scene.set_material(program, material);
                let mesh = scene.bind_mesh(moves, &mut bound);
                culler.visible(clusters).for_each(|range| mesh.draw(range, 1));
            }
        });
        let to_unit =
            Mat4::from_scale_rotation_translation(Vec3::splat(0.5), Quat::IDENTITY, Vec3::splat(0.5));
        self.matrix = to_unit * to_clip;
        // Depth bias: the height of one texel on a slope of 45 degrees.
        self.texel = Vec3::new(1.0 / size as f32, texel, texel / extent.z.max(1e-3));
    }

    /// Declares that a pass samples the map.
    pub fn declare<'a>(&self, pass: Pass<'a>) -> Pass<'a> {
        pass.read("shadow_map", self.target.depth())
    }

    /// Sets the uniforms of `include/shade.glsl`, for positions relative to `eye`.
    pub fn set(&self, program: &Program, unit: u32, eye: Vec3) {
        program
            .texture("shadow_map", unit, self.target.depth().raw())
            .set("shadow_matrix", self.matrix * Mat4::from_translation(eye))
            .set("shadow_texel", self.texel);
    }
}

/// Returns the orthographic projection along the sun's rays and the extent of its box in metres. The box contains the
/// scene, or the surroundings of the viewpoints if the scene is large.
fn light_box(scene: Bounds, viewpoints: &[Viewpoint], sun: Vec3) -> (Mat4, Vec3) {
    let sun = sun.normalize_or(Vec3::Y);
    let rotation = Pose::look_at(Vec3::ZERO, -sun).view_matrix();
    let seen = viewpoints.iter().fold(Bounds::EMPTY, |b, v| b.including(v.position).including(v.target));
    let near = Bounds {
        min: (seen.min - Vec3::splat(REACH)).max(scene.min),
        max: (seen.max + Vec3::splat(REACH)).min(scene.max),
    };
    let whole = transformed(&rotation, if scene.is_empty() { near } else { scene });
    let lit = if near.min.cmple(near.max).all() { transformed(&rotation, near) } else { whole };
    // Casters outside the lit surroundings still cast shadows into them.
    let min = Vec3::new(lit.min.x, lit.min.y, whole.min.z) - Vec3::splat(0.05);
    let max = Vec3::new(lit.max.x, lit.max.y, whole.max.z) + Vec3::splat(0.05);
    let extent = max - min;
    // The sun is on the side of larger z, so larger z is nearer.
    let scale = Vec3::new(2.0, 2.0, -2.0) / extent;
    let to_clip = Mat4::from_scale_rotation_translation(scale, Quat::IDENTITY, -scale * 0.5 * (min + max));
    (to_clip * rotation, extent)
}

fn transformed(rotation: &Mat4, b: Bounds) -> Bounds {
    (0..8).fold(Bounds::EMPTY, |out, i| {
        let corner = |bit: u32, low: f32, high: f32| if i >> bit & 1 == 0 { low } else { high };
        let p =
            Vec3::new(corner(0, b.min.x, b.max.x), corner(1, b.min.y, b.max.y), corner(2, b.min.z, b.max.z));
        out.including(rotation.transform_point3(p))
    })
}
