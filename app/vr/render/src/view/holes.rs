//! The opaque scene, drawn in the holes of a synthesized eye.

use std::rc::Rc;

use glam::{Vec2, Vec4};

use super::cluster::Culler;
use super::depth::DepthResolve;
use super::geometry::{Surfaces, Variant};
use super::layout::Layout;
use super::lit::LitScene;
use super::renderer::{Renderer, Resolve};
use super::scene::{FREE_UNIT, GpuScene};
use super::targets::Targets;
use yoro::eyes::{DisparityMap, Eye, View, Warp};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Image, MultisampleTarget, Program, RasterState,
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
        let msaa = self.settings.msaa;
        for samples in [1, msaa].into_iter().take(1 + usize::from(msaa > 1)) {
            self.prepare_variant(scene, Variant { holes: true, ..Variant::plain(samples) })?;
        }
        if self.curtain.is_none() {
            let source = ShaderSource::Raster { vertex: "render/curtain.vert", fragment: "render/fill.frag" };
            self.curtain = Some(Program::new(&self.gl, source, &[])?);
        }
        if self.ink {
            let samples = self.inked_samples();
            self.prepare_resolve(Resolve { samples, ink: true, depth: true, holes: true, layer: false })?;
        }
        Ok(())
    }

    /// Hides surfaces in the bound view that lie beyond the border of the other eye, which only the guard band would show.
    pub(super) fn draw_curtain(&self, warp: &Warp) {
        let (Some(program), DisparityMap { offset, scale }) = (&self.curtain, warp.law) else { return };
        let [source, target] = [warp.source_size, warp.target_size].map(|size| f64::from(size[0]));
        let border = match warp.target_eye {
            Eye::Left => -CURTAIN_MARGIN,
            Eye::Right => target + CURTAIN_MARGIN,
        };
        // The depth in each column of what lands at the border; without disparity, there is none.
        let [left, right] = [0.0, source].map(|column| 2.0 * (border - column - offset) / scale - 1.0);
        if !(left.is_finite() && right.is_finite()) {
            return;
        }
        self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
        self.gl.mask_colors([false; 4]);
        program.bind().set("curtain", Vec2::new(left as f32, (right - left) as f32));
        self.gl.draw_screen();
    }

    /// True if outlines are drawn in holes, too, by [`Renderer::ink_holes`].
    pub(crate) fn inks_holes(&self) -> bool {
        self.ink
    }

    /// Returns the number of samples of [`InkedHoles`].
    fn inked_samples(&self) -> u32 {
        if self.depth_resolve == DepthResolve::Samples { self.settings.msaa } else { 1 }
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
            let culler = Culler::of_view(view);
            let bloom = |program: &Program| {
                if !self.ink {
                    self.set_hole_bloom(program, source);
                }
            };
            self.draw_opaque(variant, &light, views, &Surfaces::Selected(&culler), bloom);
            self.draw_sky(variant, &light, views, bloom);
        });
    }

    /// Sets the uniforms of `include/hole_bloom.glsl`.
    fn set_hole_bloom(&self, program: &Program, HoleSource { targets, warp }: &HoleSource) {
        let Some(bloom) = targets.bloom.as_ref().filter(|_| self.has_composite()) else { return };
        let (law, size) = (warp.law, Vec2::from(warp.source_size.map(|n| n as f32)));
        program
            .texture("bloom", FREE_UNIT + 1, bloom.result().raw())
            .set("bloom_strength", self.bloom_strength())
            .set("to_view", Vec4::new(law.offset as f32, law.scale as f32, warp.row_offset as f32, 0.0))
            .set("view_texel", 1.0 / size);
    }

    /// Averages an eye in its own samples into `to`, with outlines and bloom in its holes, and with its nearest depth.
    pub(crate) fn ink_holes(
        &self,
        from: &InkedHoles,
        view: &View,
        detail: f32,
        to: &Destination,
        source: &HoleSource,
    ) {
        let variant = Resolve { samples: from.samples, ink: true, depth: true, holes: true, layer: false };
        let Some((_, program)) = self.resolve.iter().find(|(made, _)| *made == variant) else { return };
        let [color, nearest] = [Format::Rgba8, Format::Depth32F].map(|format| Image {
            format,
            size: view.size,
            samples: from.samples,
        });
        let pass = self.gl.pass("resolve").read("color_map", color).read("depth_map", nearest);
        pass.in_tile([Format::Rgba8, MARKED_DEPTH].map(|format| to.image(format))).run(|| {
            self.gl.overwrite(to, 1, true);
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            from.bind_textures(program.bind());
            self.set_hole_bloom(program, source);
            self.draw_resolve(program, Layout::Single, view, detail, None);
        });
    }
}

/// The samples of an eye whose holes are drawn before their outlines, which compare samples with their neighbours. Alpha is
/// the material in holes, and 1 where the eye was synthesized with outlines.
pub(crate) struct InkedHoles {
    gl: Rc<Context>,
    samples: u32,
    images: Images,
    /// Fills the alpha of pixels with some stencil.
    fill: Program,
}

enum Images {
    One(RenderTarget),
    Several(MultisampleTarget),
}

impl InkedHoles {
    /// Makes samples of one pixel, to be fitted to each view.
    pub(crate) fn new(renderer: &Renderer) -> Result<InkedHoles, GlError> {
        let (gl, samples) = (&renderer.gl, renderer.inked_samples());
        let images = if samples == 1 {
            let color = (Format::Rgba8, Filter::Nearest);
            Images::One(RenderTarget::new(gl, [1, 1], &[color], Some(MARKED_DEPTH))?)
        } else {
            let colors = &[Format::Rgba8];
            Images::Several(MultisampleTarget::new(gl, [1, 1], samples, colors, MARKED_DEPTH, true)?)
        };
        let fill = Program::new(gl, ShaderSource::Screen("render/fill.frag"), &[])?;
        Ok(InkedHoles { gl: gl.clone(), samples, images, fill })
    }

    /// Fits the samples to a view, and returns the place to synthesize into, and the number of samples of a pixel.
    pub(crate) fn fit(&mut self, size: [u32; 2]) -> Result<(Destination, u32), GlError> {
        let place = match &mut self.images {
            Images::One(image) => {
                image.resize(size)?;
                Destination::whole(image)
            }
            Images::Several(samples) => {
                samples.resize(size)?;
                samples.part(size)
            }
        };
        Ok((place, self.samples))
    }

    /// Tells holes from the rest by alpha, which a shader can read, once an eye is synthesized into `to`.
    pub(crate) fn mark(&self, to: &Destination) {
        // The eye was synthesized into the same tiles, and its holes are drawn in them. Then they are stored once.
        let image = |format| Image { samples: self.samples, ..to.image(format) };
        self.gl.pass("mark").store([Format::Rgba8, Format::Depth32F].map(image)).run(|| {
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            self.fill.bind();
            for (stencil, alpha) in [(0, 0.0f32), (1, 1.0)] {
                let stencil = StencilTest::Equal(stencil);
                self.gl.set_raster_state(&RasterState { stencil, ..RasterState::SCREEN });
                self.gl.mask_colors([false, false, false, true]);
                self.fill.set("fill", Vec4::splat(alpha));
                self.gl.draw_screen();
            }
        });
    }

    fn bind_textures(&self, program: &Program) {
        match &self.images {
            Images::One(image) => {
                program.texture_of("color_map", 0, image.color(0)).texture_of("depth_map", 1, image.depth());
            }
            Images::Several(samples) => {
                if let Some((color, depth)) = samples.color().zip(samples.depth()) {
                    program.texture_multisample("color_map", 0, color).texture_multisample(
                        "depth_map",
                        1,
                        depth,
                    );
                }
            }
        }
    }
}
