//! The forward renderer: surfaces are lit as they are drawn, with several samples in each pixel.
//!
//! opaque surfaces -> sky -> (transparent surfaces) -> average of the samples, and their nearest depth where something
//! reads it -> bloom and outlines. All before the average is one pass of a tile-based GPU.

use std::rc::Rc;

use super::bloom::BloomPass;
use super::cluster::{Culler, Selection};
use super::common::Common;
use super::forward_targets::ForwardTargets;
use super::g_buffer::Layout;
use super::geometry::{GeometryPass, Part};
use super::light_tiles::LightTiles;
use super::lighting::shading_defines;
use super::request::{KeptSamples, PixelDepth, ViewRequest};
use super::scene::GpuScene;
use super::settings::RenderSettings;
use super::view::{ViewImages, ViewRenderer};
use yoro::eyes::{Eye, View};
use yoro_gl::{Context, GlError, Program, RenderTarget, ShaderSource};
use yoro_scene::ShadingStyle;

/// For images that are complete.
const NO_SAMPLES: KeptSamples = KeptSamples { color: false, depth: false };

/// The forward renderer of one scene: passes made for the scene's style and materials.
pub struct ForwardRenderer {
    pub(super) common: Common,
    /// True if there are outlines, which read all samples.
    pub(super) ink: bool,
    /// The defines of `render/forward.frag`.
    defines: Vec<(&'static str, String)>,
    /// The opaque surfaces by [`Layout::index`].
    pub(super) geometry: [Option<GeometryPass>; Layout::COUNT],
    pub(super) sky: Program,
    pub(super) load: Program,
    /// If a pixel has several samples.
    pub(super) soften: Option<Program>,
    /// If shaders can read samples.
    pub(super) nearest: Option<Program>,
    pub(super) bloom: Option<BloomPass>,
    /// If there are bloom or outlines.
    pub(super) develop: Option<Program>,
}

impl ForwardRenderer {
    /// Compiles what single views need; [`ForwardRenderer::prepare`] does the rest.
    pub(crate) fn new(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        scene: &GpuScene,
    ) -> Result<ForwardRenderer, GlError> {
        ForwardRenderer::build(gl, settings, scene, gl.capabilities().multisample_textures)
    }

    /// Compiles it for targets whose samples are `readable` by shaders or not.
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

    /// Compiles what views of a layout need, if it is not there already.
    pub(crate) fn prepare(&mut self, scene: &GpuScene, layout: Layout) -> Result<(), GlError> {
        let pass = &mut self.geometry[layout.index()];
        if pass.is_none() {
            let (gl, multisample) = (&self.common.gl, self.common.settings.samples() > 1);
            *pass = Some(GeometryPass::forward(gl, scene, layout, &self.defines, multisample)?);
        }
        Ok(())
    }
}

/// Whole views, from empty targets.
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
        request: &ViewRequest,
    ) -> Result<(), GlError> {
        targets.fit(view.size, self.develops(), false)?;
        targets.request = *request;
        let drawn = request.bounds(view);
        let culler = request.culler(view);
        self.common.gl.within_columns(drawn, || {
            self.draw_on_sky(targets, scene, &[*view], &Part::Selected(&culler));
        });
        self.resolve(targets, view, request.depth != PixelDepth::Unread, request.samples);
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
        self.resolve(targets, view, depth, NO_SAMPLES);
        self.develop(targets, view, Eye::Left, false);
        Ok(())
    }
}

/// Views in parts.
impl ForwardRenderer {
    /// Fits targets to a view that is completed at once, so that no sample is needed afterwards; with `depth` that of
    /// each pixel is.
    fn fit_for_all(&self, targets: &mut ForwardTargets, view: &View, depth: bool) -> Result<(), GlError> {
        targets.request = ViewRequest::default();
        // Outlines read the samples, and a tile's depth is lost: EXT_multisampled_render_to_texture2 discards it.
        targets.fit(view.size, self.develops(), !self.ink && !depth)
    }

    /// True if bloom or outlines come after the average of the samples.
    fn develops(&self) -> bool {
        self.develop.is_some()
    }

    /// Resumes drawing into the kept samples of a view, after synthesis: near objects and transparent surfaces.
    /// Resolves colour again, and with `depth` the depth.
    pub(crate) fn resume_samples(
        &self,
        targets: &ForwardTargets,
        scene: &GpuScene,
        view: &View,
        near: Option<Selection>,
        depth: bool,
    ) {
        self.draw_after_synthesis(targets, scene, view, near);
        self.resolve(targets, view, depth, NO_SAMPLES);
        self.develop(targets, view, Eye::Left, near.is_none());
    }

    /// Does the same as [`ForwardRenderer::resume_samples`] with an image that was not rendered: 8-bit colour and float
    /// depth, of the view's size. The targets must be no smaller than the view; their contents are gone afterwards.
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
        self.resolve_to(targets, image, view, depth, NO_SAMPLES);
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

    /// Renders what lies in a slice (near and far plane in metres) and the sky behind it: the beginning of
    /// [`ForwardRenderer::render_near`], without bloom and outlines.
    pub(crate) fn render_far(
        &self,
        targets: &mut ForwardTargets,
        scene: &GpuScene,
        view: &View,
        slice: [f32; 2],
    ) -> Result<(), GlError> {
        targets.fit(view.size, false, false)?;
        self.draw_on_sky(targets, scene, &[*view], &Part::Slice(slice));
        self.resolve(targets, view, true, NO_SAMPLES);
        Ok(())
    }

    /// Renders what lies in a slice over the part of another view whose lower left corner is given, and transparent
    /// surfaces over both. With `depth` the targets have that of opaque surfaces afterwards.
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
        self.resolve(targets, view, depth, NO_SAMPLES);
        self.develop(targets, view, Eye::Left, false);
        Ok(())
    }

    /// Renders both eyes at once: all of the scene, side by side in targets of such a layout. With `depth` these have
    /// that of opaque surfaces afterwards. [`ForwardRenderer::develop`] ends each eye.
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
        self.resolve(targets, view, depth, NO_SAMPLES);
        Ok(())
    }
}
