//! The opaque scene, drawn in the holes of a synthesized eye.

use std::rc::Rc;

use glam::{Vec2, Vec4};

use super::cluster::Culler;
use super::geometry::{Surfaces, Variant};
use super::layout::Layout;
use super::lit::LitScene;
use super::renderer::{Renderer, Resolve};
use super::scene::{FREE_UNIT, GpuScene};
use super::targets::Targets;
use yoro::eyes::{View, Warp};
use yoro_gl::{
    Context, Destination, Filter, Format, GlError, Image, MultisampleTarget, Program, RasterState,
    RenderTarget, ShaderSource, StencilTest, Texture,
};

/// Depth, with the stencil that tells holes: 0 in a hole, 1 elsewhere.
pub(crate) const MARKED_DEPTH: Format = Format::Depth32FStencil8;

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
        if self.ink {
            self.prepare_resolve(InkedHoles::RESOLVE)?;
        }
        Ok(())
    }

    /// True if outlines are drawn in holes, too, by [`Renderer::ink_holes`].
    pub(crate) fn inks_holes(&self) -> bool {
        self.ink
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

    /// Draws an eye into `to`, with outlines and bloom in its holes, and with its depth.
    pub(crate) fn ink_holes(
        &self,
        from: &InkedHoles,
        view: &View,
        detail: f32,
        to: &Destination,
        source: &HoleSource,
    ) {
        let Some((_, program)) = self.resolve.iter().find(|(made, _)| *made == InkedHoles::RESOLVE) else {
            return;
        };
        let [color, depth] = [from.average.color(0), from.average.depth()];
        let pass = self.gl.pass("outlines").read("color_map", color).read("depth_map", depth);
        pass.in_tile([Format::Rgba8, MARKED_DEPTH].map(|format| to.image(format))).run(|| {
            self.gl.overwrite(to, 1, true);
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            program.bind().texture_of("color_map", 0, color).texture_of("depth_map", 1, depth);
            self.set_hole_bloom(program, source);
            self.draw_resolve(program, Layout::Single, view, detail, None);
        });
    }
}

/// An eye whose holes are drawn before their outlines, which compare pixels with their neighbours. Alpha is the material in
/// holes, and 1 where the eye was synthesized with outlines. Samples are averaged first: outlines of single samples, as
/// those of whole views are, would store all samples of an eye for a few pixels.
pub(crate) struct InkedHoles {
    gl: Rc<Context>,
    /// The samples, if a pixel has several.
    samples: Option<MultisampleTarget>,
    /// The average colour, and the depth of one sample.
    average: RenderTarget,
    /// Fills the alpha of pixels with some stencil.
    fill: Program,
}

impl InkedHoles {
    const RESOLVE: Resolve = Resolve { samples: 1, ink: true, depth: true, holes: true, layer: false };

    /// Makes images of one pixel, to be fitted to each view.
    pub(crate) fn new(renderer: &Renderer) -> Result<InkedHoles, GlError> {
        let (gl, samples) = (&renderer.gl, renderer.settings.msaa);
        let colors = &[Format::Rgba8];
        let several = || MultisampleTarget::new(gl, [1, 1], samples, colors, MARKED_DEPTH, false);
        Ok(InkedHoles {
            gl: gl.clone(),
            samples: (samples > 1).then(several).transpose()?,
            average: RenderTarget::new(gl, [1, 1], &[(colors[0], Filter::Nearest)], Some(MARKED_DEPTH))?,
            fill: Program::new(gl, ShaderSource::Screen("render/fill.frag"), &[])?,
        })
    }

    /// Fits the images to a view, and returns the place to synthesize into, and the number of samples of a pixel.
    pub(crate) fn fit(&mut self, size: [u32; 2]) -> Result<(Destination, u32), GlError> {
        self.average.resize(size)?;
        let Some(samples) = &mut self.samples else { return Ok((Destination::whole(&self.average), 1)) };
        samples.resize(size)?;
        Ok((samples.part(size), samples.samples()))
    }

    /// Tells holes from the rest by alpha, which a shader can read, once an eye is synthesized into `to`.
    pub(crate) fn mark(&self, to: &Destination) {
        let samples = self.samples.as_ref().map_or(1, MultisampleTarget::samples);
        let image = |format| Image { samples, ..to.image(format) };
        self.gl.pass("mark").in_tile([Format::Rgba8, MARKED_DEPTH].map(image)).run(|| {
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

    /// Averages the samples, once the holes are drawn. Nothing needs the stencil any more.
    pub(crate) fn average(&self) {
        let whole = Destination::whole(&self.average);
        let written = [self.average.color(0), self.average.depth()].map(Texture::image);
        // The eye was synthesized into the same tiles, and its holes are drawn in them: they are written once.
        self.gl.pass("resolve").write(written).run(|| match &self.samples {
            Some(samples) => {
                samples.average(0, &whole);
                samples.copy_depth(&self.average);
                samples.discard(true, true);
            }
            None => self.gl.discard_stencil(),
        });
    }
}
