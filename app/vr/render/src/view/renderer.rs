//! The renderer of a scene: lights surfaces as it draws them, with several samples in each pixel that never leave the
//! tile of a tile-based GPU.
//!
//! opaque surfaces -> sky -> (transparent surfaces) -> average of the samples, and their nearest depth if something
//! reads it -> bloom. Everything before the bloom is one pass on a tile-based GPU. Bloom is added where an eye is
//! written last: by the synthesis, or by [`Renderer::composite`].

use std::rc::Rc;

use super::bloom::{self, BloomPass};
use super::carry::CarryPass;
use super::depth::{DepthCopy, DepthImage, DepthResolve};
use super::geometry::{GeometryPass, Variant};
use super::layout::Layout;
use super::lights::Lights;
use super::lit::LitScene;
use super::passes::Known;
use super::rectangle::Rectangle;
use super::scene::GpuScene;
use super::settings::{MAX_POINT_LIGHTS, RenderSettings};
use super::shadow::ShadowMap;
use super::targets::{Needs, Targets};
use super::transparent::TransparentPass;
use crate::stereo::EyeTarget;
use yoro::eyes::{Eye, View};
use yoro_assets::ShadingStyle;
use yoro_gl::{Context, Destination, GlError, Program, RenderTarget, ShaderSource, TileTarget};

/// The renderer of one scene: programs for the scene's style and materials, and its shadow map.
/// After [`Renderer::new`] it is ready for single views. A stereo method compiles what else it needs once, in its first
/// frame of the scene or in [`crate::stereo::StereoSession::prepare`]. Nothing is compiled or allocated after that.
pub struct Renderer {
    pub(crate) gl: Rc<Context>,
    pub(crate) settings: RenderSettings,
    scene_id: u64,
    pub(super) shadow: Option<ShadowMap>,
    /// True if the style has outlines, which compare samples with their neighbours.
    pub(crate) ink: bool,
    /// How the samples of a pixel become one depth on this driver.
    pub depth_resolve: DepthResolve,
    /// The defines of `include/shade.glsl`.
    shading: Vec<(&'static str, String)>,
    pub(super) geometry: Vec<GeometryPass>,
    pub(super) transparent: TransparentPass,
    pub(super) skies: Vec<(Variant, Program)>,
    pub(super) carry: Option<CarryPass>,
    /// Hides what the other eye does not see, where its holes are rendered.
    pub(super) curtain: Option<Program>,
    /// Loads depth into tiles.
    pub(super) depth_load: Option<DepthCopy>,
    /// True if what is drawn over a picture begins with it.
    pub(crate) loads_pictures: bool,
    pub(super) resolve: Vec<(Resolve, Program)>,
    pub(super) bloom: Option<BloomPass>,
    pub(super) composite: Vec<(Composite, Program)>,
}

/// A variant of `render/resolve.frag`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Resolve {
    pub samples: u32,
    pub ink: bool,
    pub depth: bool,
    pub layer: bool,
}

/// A variant of `render/composite.frag`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Composite {
    pub bloom: bool,
    /// Writes depth; `Some(true)` from pairs.
    pub depth: Option<bool>,
    pub layer: bool,
    /// The number of samples of a target that carries depth; 0 if it does not.
    pub carries: u32,
}

/// The images of one view. They are made when the first view is rendered, and reused for the next.
#[derive(Default)]
pub struct ViewTargets(Option<(RenderSettings, DepthResolve, Targets)>);

/// A view that was rendered.
#[derive(Clone, Copy)]
pub struct RenderedView<'a> {
    /// Display-referred sRGB colour with luma in alpha, filtered linearly. With several samples in each pixel, alpha is
    /// undefined where something is cut out by a texture.
    pub color: &'a RenderTarget,
    /// Window depth, the nearest of each pixel's samples; without multisample textures (OpenGL ES 3.0) that of one.
    pub depth: DepthImage<'a>,
}

/// How ink outlines are drawn in a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outlines {
    /// The width in pixels.
    pub width: i32,
    /// The factor on the ink, below 1 for a line that is thinner than a pixel.
    pub strength: f32,
}

impl Outlines {
    /// Returns the outlines of a view, which is a level with this [detail](LitScene::detail). In the whole eye they are a
    /// 900th of 60 degrees wide, but at least a pixel. All levels have the same ink.
    pub fn of(view: &View, detail: f32) -> Outlines {
        let of_60_degrees =
            view.size[1] as f32 / detail / view.frustum.height() * 2.0 * 30f32.to_radians().tan();
        let width = (of_60_degrees / 900.0).round().max(1.0) * detail;
        Outlines { width: width.round().max(1.0) as i32, strength: width.min(1.0) }
    }
}

/// Returns the defines of `include/shade.glsl` for a scene.
fn shading_defines(scene: &GpuScene, settings: &RenderSettings) -> Vec<(&'static str, String)> {
    let mut defines = scene.style_defines();
    defines.extend(scene.has_sun().then(|| ("SUN", String::new())));
    let has_shadows = scene.has_sun() && settings.shadow_map_size > 0;
    defines.extend(has_shadows.then(|| ("SHADOWS", String::new())));
    defines.push(("MAX_POINT_LIGHTS", MAX_POINT_LIGHTS.to_string()));
    defines.extend(super::light_tiles::LightTiles::defines());
    defines
}

/// What is public: single views.
impl Renderer {
    /// Compiles the programs for a scene and draws its shadow map.
    ///
    /// # Errors
    /// [`GlError`] when the driver refuses a program or a target, or lacks the settings' number of samples.
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> Result<Renderer, GlError> {
        let capabilities = gl.capabilities();
        settings.supported(capabilities)?;
        let ink = scene.style == ShadingStyle::Anime;
        let mut depth_resolve = DepthResolve::best(gl, settings.msaa, ink);
        let mut carry = None;
        if depth_resolve == DepthResolve::InColor {
            match CarryPass::new(gl, settings.msaa)? {
                Some(pass) => carry = Some(pass),
                None => depth_resolve = DepthResolve::SingleSample,
            }
        }
        let has_shadow = scene.has_sun() && settings.shadow_map_size > 0;
        let mut renderer = Renderer {
            gl: gl.clone(),
            settings: settings.clone(),
            scene_id: scene.id,
            shadow: has_shadow.then(|| ShadowMap::new(gl, scene, settings.shadow_map_size)).transpose()?,
            ink,
            depth_resolve,
            shading: shading_defines(scene, settings),
            geometry: Vec::new(),
            transparent: TransparentPass::new(gl, scene),
            skies: Vec::new(),
            carry,
            curtain: None,
            depth_load: None,
            loads_pictures: !capabilities.tile_samples || TileTarget::loads(gl, settings.msaa)?,
            resolve: Vec::new(),
            bloom: (settings.bloom && scene.is_lit()).then(|| BloomPass::new(gl)).transpose()?,
            composite: Vec::new(),
        };
        renderer.prepare(scene, Layout::Single)?;
        Ok(renderer)
    }

    /// Moves everything in a scene to its place at a time in seconds, and redraws its shadow map. Costs nothing if the
    /// scene does not move or is there already.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for.
    pub fn set_time(&mut self, scene: &mut GpuScene, seconds: f64) -> Result<(), GlError> {
        self.check_scene(scene)?;
        if scene.set_time(seconds)
            && let Some(shadow) = &mut self.shadow
        {
            shadow.renew(&self.gl, scene);
        }
        Ok(())
    }

    /// Renders the opaque part of a scene to colour and depth. Where nothing is drawn, depth is the far value and
    /// colour is the sky.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] for another scene than the renderer was made for; as [`RenderTarget::new`].
    pub fn render<'a>(
        &self,
        targets: &'a mut ViewTargets,
        scene: &GpuScene,
        view: &View,
    ) -> Result<RenderedView<'a>, GlError> {
        let targets = self.fitting(targets, scene)?;
        self.draw_source(targets, &scene.into(), view, None, Known::Nothing, None)?;
        self.complete(targets, view)
    }

    /// Renders all of a scene, including transparent surfaces. Depth is that of opaque surfaces.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_all<'a>(
        &self,
        targets: &'a mut ViewTargets,
        scene: &GpuScene,
        view: &View,
    ) -> Result<RenderedView<'a>, GlError> {
        let targets = self.fitting(targets, scene)?;
        self.draw_all(targets, &scene.into(), std::slice::from_ref(view), true, None)?;
        self.complete(targets, view)
    }

    /// Returns the targets, or new ones if those were made for other settings.
    fn fitting<'a>(&self, made: &'a mut ViewTargets, scene: &GpuScene) -> Result<&'a mut Targets, GlError> {
        self.check_scene(scene)?;
        let fits = |(settings, depth_resolve, _): &(RenderSettings, DepthResolve, Targets)| {
            *settings == self.settings && *depth_resolve == self.depth_resolve
        };
        let fitting = match made.0.take().filter(fits) {
            Some(fitting) => fitting,
            None => (self.settings.clone(), self.depth_resolve, self.targets(Layout::Single)?),
        };
        Ok(&mut made.0.insert(fitting).2)
    }

    /// Composites the whole view in the targets.
    fn complete<'a>(&self, targets: &'a mut Targets, view: &View) -> Result<RenderedView<'a>, GlError> {
        if self.has_composite() {
            let to = Destination::whole(targets.complete_picture(view.size)?);
            self.composite(targets, view, Eye::Left, [0, 0], &to, None);
        }
        let color = targets.composited.as_ref().filter(|_| self.has_composite()).unwrap_or(targets.color());
        Ok(RenderedView { color, depth: targets.depth(view.size, Eye::Left, [0, 0]) })
    }
}

/// What methods use to prepare themselves.
impl Renderer {
    /// Returns an error unless this is the scene that the renderer was made for.
    pub(crate) fn check_scene(&self, scene: &GpuScene) -> Result<(), GlError> {
        if scene.id == self.scene_id {
            return Ok(());
        }
        Err(GlError::Unsupported(format!(
            "this renderer was made for another scene than {}; make one for each scene",
            scene.name
        )))
    }

    /// Makes targets, to be fitted to each view that is rendered.
    pub(crate) fn targets(&self, layout: Layout) -> Result<Targets, GlError> {
        Targets::new(&self.gl, layout, &self.settings, self.depth_resolve)
    }

    /// True if bloom is added to the average of the samples.
    pub(crate) fn has_composite(&self) -> bool {
        self.bloom.is_some()
    }

    /// True if the average of the samples is the picture: neither outlines nor bloom follow.
    pub(crate) fn is_complete(&self) -> bool {
        !self.has_composite() && !self.ink
    }

    /// True if a view of this scene can be rendered into a texture of sRGB and read as it is stored there. Where samples are
    /// not kept in tiles, transparent surfaces need a pass that decodes it.
    pub(crate) fn reads_stored(&self, scene: &GpuScene) -> bool {
        let is_loaded = scene.has_transparent() && self.settings.msaa > 1;
        self.gl.reads_stored() && (!is_loaded || self.gl.capabilities().tile_samples)
    }

    /// Returns the factor on the bloom in the targets.
    pub(crate) fn bloom_strength(&self) -> f32 {
        bloom::STRENGTH * self.settings.exposure / bloom::hdr_scale(&self.gl)
    }

    /// Compiles the programs for views of a layout, unless they are compiled already.
    pub(crate) fn prepare(&mut self, scene: &GpuScene, layout: Layout) -> Result<(), GlError> {
        let layer = layout == Layout::Layered;
        let samples = if layer { 1 } else { self.settings.msaa };
        let plain = Variant { layout, ..Variant::plain(samples) };
        self.prepare_variant(scene, plain)?;
        if self.depth_resolve == DepthResolve::InColor && !layer {
            self.prepare_variant(scene, Variant { carried: true, ..plain })?;
        }
        let samples =
            if self.depth_resolve == DepthResolve::Samples && !layer { self.settings.msaa } else { 1 };
        if self.ink || self.depth_resolve == DepthResolve::Samples {
            self.prepare_resolve(Resolve { samples, ink: self.ink, depth: samples > 1, layer })?;
        }
        if self.bloom.is_some() || layer {
            self.prepare_composite(Composite { bloom: self.bloom.is_some(), layer, ..Composite::default() })?;
        }
        Ok(())
    }

    /// Compiles the programs that draw transparent surfaces over a composited eye, with one sample in each pixel, too, and
    /// those that composite it with its depth.
    pub(crate) fn prepare_over(&mut self, scene: &GpuScene) -> Result<(), GlError> {
        self.transparent.prepare(scene, Variant::plain(1), &self.shading)?;
        if self.is_complete() && scene.has_transparent() {
            if self.depth_load.is_none() {
                self.depth_load = Some(DepthCopy::new(&self.gl)?);
            }
            self.prepare_load()?;
        }
        let depth = Some(self.depth_resolve == DepthResolve::InColor);
        let plain = Composite { bloom: self.bloom.is_some(), ..Composite::default() };
        self.prepare_composite(plain)?;
        self.prepare_composite(Composite { depth, ..plain })
    }

    /// Compiles the program that loads an image and its depth without bloom, and the resolve of a view without
    /// outlines.
    pub(crate) fn prepare_load(&mut self) -> Result<(), GlError> {
        self.prepare_raw()?;
        let carried = self.depth_resolve == DepthResolve::InColor;
        for carries in [false, true].into_iter().take(1 + usize::from(carried)) {
            let carries = if carries { self.settings.msaa } else { 0 };
            self.prepare_composite(Composite { depth: Some(carried), carries, ..Composite::default() })?;
        }
        Ok(())
    }

    /// Compiles the resolve of a view without outlines.
    pub(crate) fn prepare_raw(&mut self) -> Result<(), GlError> {
        if self.depth_resolve == DepthResolve::Samples {
            let samples = self.settings.msaa;
            self.prepare_resolve(Resolve { samples, depth: true, ..Resolve::default() })?;
        }
        Ok(())
    }

    /// Compiles the programs that take the dominant eye's colours.
    pub(crate) fn prepare_reprojected(&mut self, scene: &GpuScene) -> Result<(), GlError> {
        let plain = Variant::plain(self.settings.msaa);
        if self.depth_resolve == DepthResolve::InColor {
            self.prepare_variant(scene, Variant { reprojected: true, carried: true, ..plain })?;
        }
        self.prepare_variant(scene, Variant { reprojected: true, ..plain })
    }

    pub(super) fn prepare_variant(&mut self, scene: &GpuScene, variant: Variant) -> Result<(), GlError> {
        if self.geometry.iter().any(|pass| pass.variant == variant) {
            return Ok(());
        }
        let gl = &self.gl;
        let mut shading = self.shading.clone();
        shading.extend((variant.samples > 1).then(|| ("MULTISAMPLE", String::new())));
        shading.extend(self.ink.then(|| ("INK", String::new())));
        if variant.reprojected && self.depth_resolve == DepthResolve::InColor {
            shading.push(("DEPTH_PAIRS", String::new()));
        }
        let holes = variant.holes && self.bloom.is_some();
        shading.extend(holes.then(|| ("BLOOM", String::new())));
        self.geometry.push(GeometryPass::new(gl, scene, variant, &shading)?);
        if !variant.reprojected {
            if !variant.holes {
                self.transparent.prepare(scene, variant, &self.shading)?;
            }
            let mut defines = self.shading.clone();
            defines.extend(holes.then(|| ("BLOOM", String::new())));
            defines.extend(variant.carried.then(|| ("CARRIED", variant.samples.to_string())));
            defines.extend((variant.layout == Layout::Layered).then(|| ("MULTIVIEW", String::new())));
            self.skies.push((variant, Program::new(gl, ShaderSource::Screen("render/sky.frag"), &defines)?));
        }
        Ok(())
    }

    pub(super) fn prepare_resolve(&mut self, variant: Resolve) -> Result<(), GlError> {
        if self.resolve.iter().all(|(made, _)| *made != variant) {
            let mut defines = vec![("SAMPLES", variant.samples.to_string())];
            let flags = [("INK", variant.ink), ("WRITE_DEPTH", variant.depth), ("LAYER", variant.layer)];
            defines.extend(flags.into_iter().filter(|(_, on)| *on).map(|(name, _)| (name, String::new())));
            let program = Program::new(&self.gl, ShaderSource::Screen("render/resolve.frag"), &defines)?;
            self.resolve.push((variant, program));
        }
        Ok(())
    }

    fn prepare_composite(&mut self, variant: Composite) -> Result<(), GlError> {
        if self.composite.iter().all(|(made, _)| *made != variant) {
            let flags = [
                ("BLOOM", variant.bloom),
                ("WRITE_DEPTH", variant.depth.is_some()),
                ("DEPTH_PAIRS", variant.depth == Some(true)),
                ("LAYER", variant.layer),
            ];
            let on = flags.into_iter().filter(|(_, on)| *on);
            let mut defines: Vec<_> = on.map(|(name, _)| (name, String::new())).collect();
            defines.extend((variant.carries > 0).then(|| ("CARRIED", variant.carries.to_string())));
            let program = Program::new(&self.gl, ShaderSource::Screen("render/composite.frag"), &defines)?;
            self.composite.push((variant, program));
        }
        Ok(())
    }

    /// Returns the point lights of one view or of both eyes, with positions relative to the first view.
    pub(super) fn lights(&self, scene: &LitScene, views: &[View]) -> Lights {
        Lights::of(scene, scene.lit(views), views[0].pose.position, self.settings.point_lights)
    }
}

/// What methods use to draw.
impl Renderer {
    /// Renders the opaque part of a view for synthesis: its average colour without bloom, its nearest depth, and the
    /// bloom of the part that an eye sees (all of it if `None`). Returns true if the picture is in `to`, which may be given
    /// if nothing [follows](Renderer::is_complete) the surfaces.
    pub(crate) fn draw_source(
        &self,
        targets: &mut Targets,
        scene: &LitScene,
        view: &View,
        seen: Option<Rectangle>,
        known: Known,
        to: Option<&EyeTarget>,
    ) -> Result<bool, GlError> {
        let needs = Needs { bloom: seen, ..self.needs(true) };
        let direct = targets.fit(view, scene.detail(view), needs, to)?;
        self.draw_on_sky(targets, scene, &[*view], None, known);
        self.resolve(targets, view, true, self.ink, to.filter(|_| direct).map(|to| &to.color))?;
        self.render_bloom(targets, view, Eye::Left);
        Ok(direct)
    }

    /// Renders everything in one view, or in both eyes at once, and the bloom of a single view. With `depth`, the targets
    /// then hold the depth of opaque surfaces. Returns true if the picture is complete in `to` already.
    pub(crate) fn draw_all(
        &self,
        targets: &mut Targets,
        scene: &LitScene,
        views: &[View],
        depth: bool,
        to: Option<&EyeTarget>,
    ) -> Result<bool, GlError> {
        let view = &views[0];
        let to = to.filter(|_| self.is_complete());
        let direct = targets.fit(view, scene.detail(view), self.needs(depth), to)?;
        self.draw_on_sky(targets, scene, views, None, Known::Nothing);
        self.draw_transparent(targets, scene, views);
        self.resolve(targets, view, depth, self.ink, to.filter(|_| direct).map(|to| &to.color))?;
        if views.len() == 1 && !direct {
            self.render_bloom(targets, view, Eye::Left);
        }
        Ok(direct)
    }

    /// Returns what a view needs whose depth is read or not.
    pub(super) fn needs(&self, depth: bool) -> Needs {
        let samples = self.depth_resolve == DepthResolve::Samples && (depth || self.ink);
        // Outlines are found in the depth of the samples. Synthesis needs no more than half floats, as where depth is carried.
        let half_depth = samples && depth && self.ink && self.gl.capabilities().float_render_targets;
        Needs { depth, samples, half_depth, bloom: None }
    }
}
