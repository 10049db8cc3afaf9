//! The opaque scene, drawn in the holes of a synthesized eye.

use std::rc::Rc;

use glam::{Vec2, Vec4};

use super::geometry::Variant;
use super::layout::Layout;
use super::lit::LitScene;
use super::renderer::Renderer;
use super::scene::{FREE_UNIT, GpuScene};
use super::targets::Targets;
use yoro::eyes::{DisparityMap, Eye, View, Warp};
use yoro_gl::{
    Blend, Context, DepthTest, Destination, Filter, Format, GlError, Image, Program, RasterState,
    RenderTarget, ShaderSource, StencilTest,
};

/// Depth, with the stencil that tells holes: 0 in a hole, 1 elsewhere.
pub(crate) const MARKED_DEPTH: Format = Format::Depth32FStencil8;

/// Distance in pixels from the other eye's border at which surfaces are hidden: farther than outlines and silhouettes reach.
const CURTAIN_MARGIN: f64 = 4.0;

/// The rendered view, whose bloom the other eye's holes get.
#[derive(Clone, Copy)]
pub(crate) struct HoleSource<'a> {
    pub targets: &'a Targets,
    pub warp: &'a Warp,
}

impl Renderer {
    /// Compiles the programs that draw in holes.
    pub(crate) fn prepare_holes(&mut self, scene: &GpuScene) -> Result<(), GlError> {
        for samples in [1, self.settings.msaa] {
            self.prepare_variant(scene, Variant { holes: true, ..Variant::plain(samples) })?;
        }
        if self.curtain.is_none() {
            let source = ShaderSource::Raster { vertex: "render/curtain.vert", fragment: "render/fill.frag" };
            self.curtain = Some(Program::new(&self.gl, source, &[])?);
        }
        Ok(())
    }

    /// Hides surfaces in the bound view that lie beyond the border of the other eye, which only the guard band would show.
    pub(super) fn draw_curtain(&self, warp: &Warp) {
        if let (Some(program), Some(depth)) = (&self.curtain, curtain(warp)) {
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            self.gl.mask_colors([false; 4]);
            program.bind().set("curtain", 2.0 * depth - Vec2::X);
            self.gl.draw_screen();
        }
    }

    /// Draws opaque surfaces and sky in the holes of an eye that was synthesized into `to`, which has this many samples in
    /// each pixel and begins at pixel [0, 0] of its framebuffer.
    pub(crate) fn draw_holes(
        &self,
        scene: &LitScene,
        view: &View,
        to: &Destination,
        samples: u32,
        source: &HoleSource,
    ) {
        let variant = Variant { holes: true, ..Variant::plain(samples) };
        let views = std::slice::from_ref(view);
        let light = self.illuminate(Layout::Single, scene, views);
        let mut pass = light.declare(self.gl.pass("holes"));
        if let Some(bloom) = &source.targets.bloom {
            pass = pass.read("bloom", bloom.result());
        }
        let image = |format| Image { samples, ..to.image(format) };
        pass.in_tile([Format::Rgba8, MARKED_DEPTH].map(image)).run(|| {
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            let bloom = |program: &Program| self.set_hole_bloom(program, source);
            self.draw_opaque(variant, &light, views, None, bloom);
            self.draw_sky(variant, &light, views, bloom);
        });
    }

    /// Sets the uniforms of `include/hole_bloom.glsl`.
    fn set_hole_bloom(&self, program: &Program, HoleSource { targets, warp }: &HoleSource) {
        let Some(bloom) = targets.bloom.as_ref().filter(|_| self.has_composite()) else { return };
        let (law, part) = (warp.law, bloom.part());
        let [left, bottom] = part.origin.map(|n| n as f32);
        let rows = warp.row_offset as f32;
        program
            .texture("bloom", FREE_UNIT + 1, bloom.result().raw())
            .set("bloom_strength", self.bloom_strength())
            .set("to_bloom", Vec4::new(law.offset as f32 + left, law.scale as f32, rows + bottom, 0.0))
            .set("bloom_texel", 1.0 / Vec2::from(part.size.map(|n| n as f32)));
    }

    /// Writes an eye that was synthesized with outlines into `to`, which has this many samples in each pixel, and renders its
    /// holes there, with outlines. `inked` has the same eye with one sample in each pixel.
    pub(crate) fn ink_holes(
        &self,
        inked: &InkedHoles,
        scene: &LitScene,
        view: &View,
        (to, samples): (&Destination, u32),
        source: &HoleSource,
    ) {
        let pass = |name| {
            let images = [Format::Rgba8, MARKED_DEPTH].map(|format| Image { samples, ..to.image(format) });
            let [color, depth] = [inked.image.color(0), inked.image.depth()];
            self.gl.pass(name).read("color_map", color).read("depth_map", depth).in_tile(images)
        };
        pass("load").run(|| {
            self.gl.overwrite(to, 1, false);
            self.gl.clear_marks(to, view.depth.clear_value(), true);
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            inked.bind(&inked.load);
            self.gl.marking_stencil(|| self.gl.draw_screen());
        });
        self.draw_holes(scene, view, to, samples, source);
        pass("outlines").run(|| {
            // Samples pass that are not behind the outlined surface: depth is reversed.
            let (blend, stencil) = (Blend::Multiply, StencilTest::Equal(0));
            self.gl.set_raster_state(&RasterState { depth: DepthTest::Less, blend, stencil, cull: false });
            self.gl.mask_depth();
            inked.bind(&inked.ink);
            self.draw_resolve(&inked.ink, Layout::Single, view, scene.detail(view), None);
        });
    }
}

/// Returns the depth in the rendered view of what lands at the other eye's border, at the view's left border, and its change
/// up to the right one. Where it is negative, nothing is hidden. `None` without disparity.
fn curtain(warp: &Warp) -> Option<Vec2> {
    let DisparityMap { offset, scale } = warp.law;
    let border = match warp.target_eye {
        Eye::Left => -CURTAIN_MARGIN,
        Eye::Right => f64::from(warp.target_size[0]) + CURTAIN_MARGIN,
    };
    let left = (border - offset) / scale;
    let change = -f64::from(warp.source_size[0]) / scale;
    (scale != 0.0).then_some(Vec2::new(left as f32, change as f32))
}

/// An eye with one sample in each pixel whose holes are drawn, for their outlines, which compare pixels with their
/// neighbours. Alpha is the material in holes, and 1 where the eye was synthesized with outlines.
pub(crate) struct InkedHoles {
    gl: Rc<Context>,
    image: RenderTarget,
    /// Fills alpha outside of holes.
    fill: Program,
    /// Draws the eye outside of holes.
    load: Program,
    /// Draws outlines over holes.
    ink: Program,
}

impl InkedHoles {
    /// Makes an image of one pixel, to be fitted to each view.
    pub(crate) fn new(renderer: &Renderer) -> Result<InkedHoles, GlError> {
        let gl = &renderer.gl;
        let program = |file, defines: &[_]| Program::new(gl, ShaderSource::Screen(file), defines);
        Ok(InkedHoles {
            gl: gl.clone(),
            image: RenderTarget::new(gl, [1, 1], &[(Format::Rgba8, Filter::Nearest)], Some(MARKED_DEPTH))?,
            fill: program("render/fill.frag", &[])?,
            load: program("render/hole_ink.frag", &[])?,
            ink: program("render/hole_ink.frag", &[("INK", String::new())])?,
        })
    }

    /// Fits the image to a view, and returns the place to synthesize into.
    pub(crate) fn fit(&mut self, size: [u32; 2]) -> Result<Destination, GlError> {
        self.image.resize(size)?;
        Ok(Destination::whole(&self.image))
    }

    /// Marks pixels outside of holes by alpha, which a shader can read, once an eye is synthesized into `to`.
    pub(crate) fn mark(&self, to: &Destination) {
        // The eye was synthesized into the same tiles, and its holes are drawn in them. Then they are stored once.
        let images = [Format::Rgba8, Format::Depth32F].map(|format| to.image(format));
        self.gl.pass("mark").store(images).run(|| {
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            self.gl.set_raster_state(&RasterState { stencil: StencilTest::Equal(1), ..RasterState::SCREEN });
            self.gl.mask_colors([false, false, false, true]);
            self.fill.bind().set("fill", Vec4::ONE);
            self.gl.draw_screen();
        });
    }

    fn bind(&self, program: &Program) {
        let (color, depth) = (self.image.color(0), self.image.depth());
        program.bind().texture_of("color_map", 0, color).texture_of("depth_map", 1, depth);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{DepthConvention, DepthRange, EyeOptions, GuardBand, Pose, SynthesisViews};

    /// All that it hides lands beyond the border, and it hides nothing within the rendered eye.
    #[test]
    fn the_curtain_hangs_at_the_other_eyes_border() {
        for dominant in Eye::BOTH {
            let depth = DepthRange { convention: DepthConvention::Reversed, ..DepthRange::PAPER };
            let eyes = EyeOptions { dominant, depth, ..EyeOptions::default() }.pair(Pose::IDENTITY);
            let SynthesisViews { warp, source, dominant_crop, .. } =
                eyes.synthesis_views(GuardBand::Distance(1.0)).unwrap();
            let (curtain, [width, ..]) = (curtain(&warp).unwrap(), source.size);
            let depth = |column: u32| curtain.x + curtain.y * column as f32 / width as f32;
            let is_left = warp.target_eye == Eye::Left;
            for column in 0..width {
                let lands = f64::from(column) + warp.law.displacement(depth(column).into());
                let beyond = if is_left { -lands } else { lands - f64::from(warp.target_size[0]) };
                assert!((beyond - CURTAIN_MARGIN).abs() < 0.01, "column {column}: {lands}");
            }
            // The guard band is on the side of the other eye's border.
            let [outer, inner] = if is_left { [0, dominant_crop[0]] } else { [width, eyes.size[0]] };
            assert!(outer != inner && depth(outer) > 0.0 && depth(inner) <= 0.0);
        }
    }
}
