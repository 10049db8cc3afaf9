//! The forward renderer: lights surfaces as it draws them, with several samples in each pixel.
//!
//! opaque surfaces -> sky -> (transparent surfaces) -> average of the samples, and their nearest depth if something
//! reads it -> bloom and outlines. On a tile-based GPU everything before the average is one pass.

use std::rc::Rc;

use super::bloom::BloomPass;
use super::cluster::{Culler, Selection};
use super::common::Common;
use super::forward_targets::ForwardTargets;
use super::g_buffer::Layout;
use super::geometry::{GeometryPass, Part};
use super::light_tiles::LightTiles;
use super::lighting::shading_defines;
use super::request::DrawRequest;
use super::scene::GpuScene;
use super::settings::RenderSettings;
use super::view::{ViewImages, ViewRenderer};
use yoro::eyes::{Eye, View};
use yoro_assets::ShadingStyle;
use yoro_gl::{Context, GlError, Program, RenderTarget, ShaderSource};

/// The forward renderer of one scene: passes made for the scene's style and materials.
pub struct ForwardRenderer {
    pub(super) common: Common,
    /// True if the style has outlines, which read all samples.
    pub(super) ink: bool,
    /// The defines of `render/forward.frag`.
    defines: Vec<(&'static str, String)>,
    /// The passes for opaque surfaces, by [`Layout::index`].
    pub(super) geometry: [Option<GeometryPass>; Layout::COUNT],
    pub(super) sky: Program,
    pub(super) load: Program,
    /// `None` with one sample in each pixel.
    pub(super) soften: Option<Program>,
    /// `None` if shaders cannot read samples.
    pub(super) nearest: Option<Program>,
    pub(super) bloom: Option<BloomPass>,
    /// `None` without bloom and outlines.
    pub(super) develop: Option<Program>,
}

impl ForwardRenderer {
    /// Compiles the programs for single views; [`ForwardRenderer::prepare`] compiles the others.
    pub(crate) fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        scene: &GpuScene,
    ) -> Result<ForwardRenderer, GlError> {
        ForwardRenderer::build(gl, settings, scene, gl.capabilities().multisample_textures)
    }

    /// Compiles the programs for targets whose samples shaders can read (`readable`) or cannot.
    pub(super) fn build(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        scene: &GpuScene,
        readable: bool,
    ) -> Result<ForwardRenderer, GlError> {
        settings.supported(gl.capabilities())?;
        let samples = settings.samples();
        let ink = scene.style == ShadingStyle::Anime;
        let name = |name: &'static str| (name, String::new());
        let read = if readable { samples } else { 1 };
        let read_defines = [("SAMPLES", read.to_string())];
        let mut defines = shading_defines(gl, scene, settings);
        defines.extend(LightTiles::defines());
        let sky = Program::new(gl, ShaderSource::Screen("render/sky.frag"), &defines)?;
        defines.push(name("FORWARD"));
        defines.extend((samples > 1).then(|| name("MULTISAMPLE")));
        defines.extend(ink.then(|| name("INK")));
        let nearest = (read > 1)
            .then(|| Program::new(gl, ShaderSource::Screen("render/nearest_depth.frag"), &read_defines));
        let mut developed = read_defines.to_vec();
        developed.extend(settings.bloom.then(|| name("BLOOM")));
        developed.extend(ink.then(|| name("INK")));
        let develop = (ink || settings.bloom)
            .then(|| Program::new(gl, ShaderSource::Screen("render/develop.frag"), &developed));
        let bloom = settings.bloom.then(|| BloomPass::new(gl, &[name("DISPLAY_REFERRED")]));
        let soften = (samples > 1).then(|| Program::new(gl, ShaderSource::Screen("render/soften.frag"), &[]));
        let mut renderer = ForwardRenderer {
            common: Common::new(gl, settings, scene)?,
            ink,
            defines,
            geometry: [const { None }; Layout::COUNT],
            sky,
            load: Program::new(gl, ShaderSource::Screen("render/load.frag"), &[])?,
            soften: soften.transpose()?,
            nearest: nearest.transpose()?,
            bloom: bloom.transpose()?,
            develop: develop.transpose()?,
        };
        renderer.prepare(scene, Layout::Single)?;
        Ok(renderer)
    }

    /// Compiles the programs for views of a layout, unless they are compiled already.
    pub(crate) fn prepare(&mut self, scene: &GpuScene, layout: Layout) -> Result<(), GlError> {
        let pass = &mut self.geometry[layout.index()];
        if pass.is_none() {
            let (gl, multisample) = (&self.common.gl, self.common.settings.samples() > 1);
            *pass = Some(GeometryPass::forward(gl, scene, layout, &self.defines, multisample)?);
        }
        Ok(())
    }
}

/// Renders whole views into empty targets.
impl ViewRenderer for ForwardRenderer {
    type Targets = ForwardTargets;

    fn common(&self) -> &Common {
        &self.common
    }

    fn targets(gl: &Rc<Context>, settings: &RenderSettings) -> Result<ForwardTargets, GlError> {
        ForwardTargets::new(gl, Layout::Single, settings)
    }

    fn render(
        &self,
        targets: &mut ForwardTargets,
        scene: &GpuScene,
        view: &View,
        request: &DrawRequest,
    ) -> Result<(), GlError> {
        targets.fit(view.size, self.develops(), false)?;
        targets.request = *request;
        let drawn = request.bounds(view);
        let culler = request.culler(view);
        self.common.gl.within_columns(drawn, || {
            self.draw_on_sky(targets, scene, &[*view], &Part::Selected(&culler));
        });
        self.resolve(targets, view, true, request.keeps_samples);
        if let Some(drawn) = drawn {
            targets.repeat_columns(drawn)?;
        }
        self.develop(targets, view, Eye::Left, false);
        Ok(())
    }

    fn render_all(
        &self,
        targets: &mut ForwardTargets,
        scene: &GpuScene,
        view: &View,
        depth: bool,
    ) -> Result<(), GlError> {
        self.fit_for_all(targets, view, depth)?;
        let culler = Culler::of_view(view);
        self.draw_on_sky(targets, scene, &[*view], &Part::Selected(&culler));
        self.draw_transparent(targets, scene, &[*view]);
        self.resolve(targets, view, depth, false);
        self.develop(targets, view, Eye::Left, false);
        Ok(())
    }
}

/// Renders views in parts.
impl ForwardRenderer {
    /// Fits targets to a view that is completed at once, so that no sample is needed afterwards. With `depth`, each
    /// pixel's depth is needed.
    fn fit_for_all(&self, targets: &mut ForwardTargets, view: &View, depth: bool) -> Result<(), GlError> {
        targets.request = DrawRequest::default();
        // Outlines read the samples; and depth is lost in tiles, since EXT_multisampled_render_to_texture2 discards it.
        targets.fit(view.size, self.develops(), !self.ink && !depth)
    }

    /// True if bloom or outlines come after the average of the samples.
    fn develops(&self) -> bool {
        self.develop.is_some()
    }

    /// Resumes drawing into the kept samples of a view after synthesis: draws near objects and transparent surfaces,
    /// then resolves colour again, and depth if `depth` is set.
    pub(crate) fn resume_samples(
        &self,
        targets: &ForwardTargets,
        scene: &GpuScene,
        view: &View,
        near: Option<Selection>,
        depth: bool,
    ) {
        self.draw_after_synthesis(targets, scene, view, near);
        self.resolve(targets, view, depth, false);
        self.develop(targets, view, Eye::Left, near.is_none());
    }

    /// Like [`ForwardRenderer::resume_samples`], but starts from an image: 8-bit colour and float depth, of the view's
    /// size. The targets must be no smaller than the view, and lose their contents.
    pub(crate) fn resume_samples_with(
        &self,
        targets: &ForwardTargets,
        image: &RenderTarget,
        scene: &GpuScene,
        view: &View,
        near: Option<Selection>,
        depth: bool,
    ) {
        self.common.gl.pass("load", || {
            self.load(targets, (image.color(0), image.depth()), [0, 0], view);
            self.soften(targets, image.depth(), view);
        });
        self.draw_after_synthesis(targets, scene, view, near);
        self.resolve_to(targets, image, view, depth, false);
    }

    /// Draws near objects and transparent surfaces into the targets of one view.
    fn draw_after_synthesis(
        &self,
        targets: &ForwardTargets,
        scene: &GpuScene,
        view: &View,
        near: Option<Selection>,
    ) {
        let views = std::slice::from_ref(view);
        if let Some(near) = near {
            let culler = Culler::selecting(view, near);
            self.common.gl.pass("near objects", || {
                let light = self.illuminate(Layout::Single, scene, views, view);
                self.draw(targets, &light, views, &Part::Selected(&culler));
            });
        }
        self.draw_transparent(targets, scene, views);
    }

    /// Renders the surfaces in a slice (near and far plane in metres) and the sky behind it, without bloom and
    /// outlines. [`ForwardRenderer::render_near`] completes the view.
    pub(crate) fn render_far(
        &self,
        targets: &mut ForwardTargets,
        scene: &GpuScene,
        view: &View,
        slice: [f32; 2],
    ) -> Result<(), GlError> {
        targets.fit(view.size, false, false)?;
        self.draw_on_sky(targets, scene, &[*view], &Part::Slice(slice));
        self.resolve(targets, view, true, false);
        Ok(())
    }

    /// Renders the surfaces in a slice over a part of another view, given by its lower left corner, and transparent
    /// surfaces over both. With `depth`, the targets then hold the depth of opaque surfaces.
    pub(crate) fn render_near(
        &self,
        targets: &mut ForwardTargets,
        scene: &GpuScene,
        view: &View,
        slice: Option<[f32; 2]>,
        (far, crop): (&ForwardTargets, [u32; 2]),
        depth: bool,
    ) -> Result<(), GlError> {
        self.fit_for_all(targets, view, depth)?;
        let views = std::slice::from_ref(view);
        self.common.gl.pass("forward", || {
            self.load(targets, (far.resolved.color(0), far.depth()), crop, view);
            if let Some(slice) = slice {
                let light = self.illuminate(Layout::Single, scene, views, view);
                self.draw(targets, &light, views, &Part::Slice(slice));
            }
        });
        self.draw_transparent(targets, scene, views);
        self.resolve(targets, view, depth, false);
        self.develop(targets, view, Eye::Left, false);
        Ok(())
    }

    /// Renders the whole scene for both eyes at once, side by side in targets with that layout. With `depth`, the
    /// targets then hold the depth of opaque surfaces. [`ForwardRenderer::develop`] finishes each eye.
    pub(crate) fn render_both(
        &self,
        targets: &mut ForwardTargets,
        scene: &GpuScene,
        views: &[View; 2],
        depth: bool,
    ) -> Result<(), GlError> {
        let view = &views[0];
        self.fit_for_all(targets, view, depth)?;
        self.draw_on_sky(targets, scene, views, &Part::Slice([view.depth.near, view.depth.far]));
        self.draw_transparent(targets, scene, views);
        self.resolve(targets, view, depth, false);
        Ok(())
    }
}
