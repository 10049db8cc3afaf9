//! Motion vectors of a rendered view.

use std::rc::Rc;

use glam::{IVec2, Mat4, Vec2, Vec4};

use super::cluster::Culler;
use super::depth::{DepthImage, DepthProgram};
use super::scene::{Features, GpuScene};
use super::uniforms::{depth_test, eye_to_clip};
use yoro::eyes::{Ndc, View};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Program, RasterState, RenderTarget, ShaderSource, Texture,
};

/// Writes motion vectors and depth of a view, whose size need not be that of the rendered image: normalized device
/// coordinates minus those of the previous frame.
///
/// Sky and still surfaces have those of depth and poses. Moving surfaces are drawn, from the vertices that they have and
/// those that they had before the scene's time last changed.
pub(crate) struct VectorPass {
    gl: Rc<Context>,
    /// For surfaces that are not cut out, cut out by the opacity of their colour, and by a diffuse map.
    moving: [Program; 3],
    vectors: DepthProgram,
    /// Vectors and inverse distance of moving surfaces.
    target: RenderTarget,
    /// True if the target shows any.
    moves: bool,
}

/// A depth image, and the view that it shows.
#[derive(Clone, Copy)]
pub(crate) struct RenderedDepth<'a> {
    pub depth: &'a DepthImage<'a>,
    pub view: &'a View,
}

/// What moves between two frames: the view whose pixels get vectors, and the view of each frame in whose normalized device
/// coordinates these are, with the same pose. Only the first one's size matters. All have the convention of the depth
/// that is written.
#[derive(Clone, Copy)]
pub(crate) struct Step {
    pub view: View,
    pub now: View,
    pub then: View,
    pub ndc: Ndc,
}

impl VectorPass {
    /// Makes the pass for views with one depth a pixel, and perhaps for those with a pair ([`DepthImage::is_pair`]).
    pub fn new(gl: &Rc<Context>, is_pair: bool) -> Result<VectorPass, GlError> {
        let program = |features: Features| {
            let source =
                ShaderSource::Raster { vertex: "render/motion.vert", fragment: "render/motion.frag" };
            Program::new(gl, source, &features.defines())
        };
        let mut vectors = DepthProgram::new(gl, "render/vectors.frag");
        vectors.prepare(is_pair)?;
        vectors.prepare(false)?;
        let formats = [(Format::Rgba16F, Filter::Nearest)];
        Ok(VectorPass {
            gl: gl.clone(),
            moving: [
                program(Features::default())?,
                program(Features::CUTOUT)?,
                program(Features::CUTOUT.or(Features::DIFFUSE_MAP))?,
            ],
            vectors,
            target: RenderTarget::new(gl, [1, 1], &formats, Some(Format::Depth24))?,
            moves: false,
        })
    }

    /// Draws the moving surfaces of a view, for [`VectorPass::write`].
    pub fn draw_moving(&mut self, scene: &GpuScene, step: &Step) -> Result<(), GlError> {
        self.moves = scene.is_moving_in(&step.view);
        let Some(moving) = scene.moving.as_ref().filter(|_| self.moves) else { return Ok(()) };
        let Step { view, now, then, .. } = step;
        self.target.resize(view.size)?;
        let gl = &self.gl;
        let [vectors, depth] = [self.target.color(0), self.target.depth()].map(Texture::image);
        let pass = scene.declare(gl.pass("moving surfaces"), 1);
        pass.write([vectors]).in_tile([depth]).run(|| {
            self.target.bind();
            gl.clear(Some(view.depth.clear_value()));
            let culler = Culler::of_view(view);
            moving.bind_with_previous();
            for (material, _, clusters) in scene.opaque().filter(|(_, moves, _)| *moves) {
                let features = material.features;
                let program = match features.contains(Features::CUTOUT) {
                    false => &self.moving[0],
                    true => &self.moving[1 + usize::from(features.contains(Features::DIFFUSE_MAP))],
                };
                let depth = depth_test(view.depth.convention);
                let cull = !material.double_sided;
                gl.set_raster_state(&RasterState { depth, cull, ..RasterState::SCREEN });
                program
                    .bind()
                    .set("eye", view.pose.position)
                    .set("eye_to_clip", eye_to_clip(view))
                    .set("to_vectors", eye_to_clip(now))
                    .set("previous_eye", then.pose.position)
                    .set("previous_to_vectors", eye_to_clip(then));
                scene.set_material(program, material);
                culler.visible(clusters).for_each(|range| moving.mesh.draw(range, 1));
            }
            self.target.discard_depth();
        });
        Ok(())
    }

    /// Writes vectors (RGBA16F, alpha 1 on moving surfaces) and window depth of a part of the view whose moving surfaces
    /// were drawn last. The destination has the part's size; `corner` is the part's lower left pixel. `rendered` is the
    /// depth of a view from the same place in the same direction.
    pub fn write(
        &mut self,
        RenderedDepth { depth, view: rendered }: RenderedDepth,
        step: &Step,
        corner: [u32; 2],
        to: &Destination,
    ) -> Result<(), GlError> {
        let program = self.vectors.bind(depth)?;
        program.texture("moving_map", 1, self.target.color(0).raw()).set("moves", self.moves);
        set_places(program, depth, rendered, step);
        let signed = |at: [u32; 2]| IVec2::from(at.map(|n| n as i32));
        program
            .set("offset", signed(corner) - signed(to.origin))
            .set("last", signed(step.view.size) - 1)
            .set("reverse", depth.convention != step.view.depth.convention)
            .set("z_scale", if step.ndc == Ndc::ZeroToOne { 0.5f32 } else { 1.0 });
        let pass = self.gl.pass("vectors").read("depth_map", depth.texture);
        let pass = pass.read("moving_map", self.target.color(0));
        pass.write([Format::Rgba16F, Format::Depth32F].map(|format| to.image(format))).run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            self.gl.overwrite(to, 1, true);
            self.gl.draw_screen();
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
        Ok(())
    }
}

/// Sets where a pixel's depth and previous place are.
fn set_places(program: &Program, depth: &DepthImage, rendered: &View, step: &Step) {
    let Step { view, now, then, .. } = step;
    let pair = |[x, y]: [u32; 2]| Vec2::new(x as f32, y as f32);
    let corner = |view: &View| Vec2::new(view.frustum.left, view.frustum.bottom);
    let extent = |view: &View| Vec2::new(view.frustum.width(), view.frustum.height());
    let density = extent(view) / pair(view.size);
    let rendered_density = extent(rendered) / pair(rendered.size);
    let (scale, first) = (density / rendered_density, pair(depth.origin));
    let shift = (corner(view) - corner(rendered)) / rendered_density + first;
    let last = first + pair(rendered.size) - 1.0;
    let (to_unit, start) =
        (2.0 * density / extent(now), 2.0 * (corner(view) - corner(now)) / extent(now) - 1.0);
    let (constant, slope) = view.depth.inverse_distance_law();
    program
        .set("to_depth", Vec4::new(scale.x, scale.y, shift.x, shift.y))
        .set("depth_range", Vec4::new(first.x, first.y, last.x, last.y))
        .set("inverse_distance", Vec2::new(constant as f32, slope as f32))
        .set("to_place", Vec4::new(to_unit.x, to_unit.y, start.x, start.y))
        .set("to_previous", to_previous(now, then));
}

/// Returns the matrix from normalized device coordinates x and y, 1, and inverse distance to the previous frame's clip space.
fn to_previous(now: &View, then: &View) -> Mat4 {
    let f = &now.frustum;
    // The ray through a place in the image, at distance 1.
    let rays = Mat4::from_cols(
        Vec4::new(f.width() / 2.0, 0.0, 0.0, 0.0),
        Vec4::new(0.0, f.height() / 2.0, 0.0, 0.0),
        Vec4::new((f.left + f.right) / 2.0, (f.bottom + f.top) / 2.0, -1.0, 0.0),
        Vec4::ZERO,
    );
    let mut from_previous_eye = Mat4::from_quat(now.pose.orientation) * rays;
    from_previous_eye.w_axis = (now.pose.position - then.pose.position).extend(1.0);
    eye_to_clip(then) * from_previous_eye
}
