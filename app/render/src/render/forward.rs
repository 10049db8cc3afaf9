//! The forward renderer: surfaces are lit as they are drawn, with several samples in each pixel.
//!
//! opaque surfaces -> sky -> (transparent surfaces) -> average of the samples, and their nearest depth where something
//! reads it -> bloom and outlines. All before the average is one pass of a tile-based GPU.

use std::cell::Cell;
use std::rc::Rc;

use glam::{IVec2, Vec2, Vec3};

use super::Columns;
use super::bloom::{self, BloomPass, BloomTargets};
use super::cluster::Culler;
use super::deferred::hdr_format;
use super::g_buffer::Layout;
use super::geometry::GeometryPass;
use super::light_tiles::LightTiles;
use super::lighting::{line_width, shading_defines};
use super::scene::{FREE_UNIT, GpuScene};
use super::settings::RenderSettings;
use super::shadow::ShadowMap;
use super::uniforms::{Lights, nearer, set_view};
use yoro::eyes::{Eye, View};
use yoro_gl::{
    Context, DepthTest, Destination, Filter, Format, GlError, MultisampleTarget, Program, RasterState,
    RenderTarget, ShaderSource, Texture, TileTarget,
};
use yoro_scene::ShadingStyle;

/// Float for both conventions: what begins with a synthesized image has its depth format.
const DEPTH: Format = Format::Depth32F;

/// Which samples are still needed when a view is rendered. Others never leave the tiles of a tile-based GPU, as far as
/// its driver can help it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kept {
    /// To go on drawing, or to be read.
    pub color: bool,
    /// To go on drawing, or to be read.
    pub depth: bool,
}

/// The images of one view, or of both eyes side by side.
///
/// A pixel costs 8 bytes for each sample, where they leave the tile, 8 bytes of resolved colour and depth, and with
/// bloom or outlines 4 bytes of developed colour.
pub struct ForwardTargets {
    gl: Rc<Context>,
    layout: Layout,
    /// Where there is more than one in a pixel.
    samples: Option<MultisampleTarget>,
    /// Where samples can stay in tiles.
    tile: Option<TileTarget>,
    /// Whether they do in the frame that is drawn.
    in_tile: bool,
    /// Average colour, nearest depth.
    resolved: RenderTarget,
    bloom: Option<BloomTargets>,
    /// Colour with bloom and outlines, if there are any: of one eye.
    developed: Option<RenderTarget>,
    pub kept: Kept,
    /// [`ForwardTargets::depth`] is wanted of a view that is rendered.
    pub keeps_depth: bool,
    /// The first sample's depth is wanted, not the nearest.
    pub first_sample: bool,
    /// Whether the resolved depth is that of what was drawn.
    has_depth: Cell<bool>,
    /// Which columns are drawn; all if none.
    pub columns: Option<Columns>,
    /// One of them, on its way to those that are not.
    column: Option<RenderTarget>,
}

impl ForwardTargets {
    /// Targets for views of `size` pixels.
    ///
    /// # Errors
    /// As [`MultisampleTarget::new`] and [`RenderTarget::new`].
    pub fn new(
        gl: &Rc<Context>,
        layout: Layout,
        size: [u32; 2],
        settings: &RenderSettings,
    ) -> Result<ForwardTargets, GlError> {
        ForwardTargets::build(gl, layout, size, settings, gl.capabilities().multisample_textures)
    }

    /// As [`ForwardTargets::new`], `readable` by shaders sample by sample or not.
    pub(super) fn build(
        gl: &Rc<Context>,
        layout: Layout,
        size: [u32; 2],
        settings: &RenderSettings,
        readable: bool,
    ) -> Result<ForwardTargets, GlError> {
        settings.supported(gl.capabilities())?;
        let bloom = settings.bloom.then(|| BloomTargets::new(gl, size, hdr_format(gl)));
        let size = layout.texture_size(size);
        let samples = (settings.samples() > 1)
            .then(|| MultisampleTarget::new(gl, size, settings.samples(), Format::Rgba8, DEPTH, readable));
        let tile = (settings.samples() > 1 && gl.capabilities().tile_samples)
            .then(|| TileTarget::new(gl, settings.samples()));
        let formats = [(Format::Rgba8, Filter::Linear)];
        Ok(ForwardTargets {
            gl: gl.clone(),
            layout,
            samples: samples.transpose()?,
            tile: tile.transpose()?,
            in_tile: false,
            resolved: RenderTarget::new(gl, size, &formats, Some(DEPTH))?,
            bloom: bloom.transpose()?,
            developed: None,
            kept: Kept::default(),
            keeps_depth: true,
            first_sample: false,
            has_depth: Cell::new(false),
            columns: None,
            column: None,
        })
    }

    /// Fits the targets to views of `size` pixels, which are developed or not; nothing is done when they fit already.
    /// With `in_tile` no sample is needed once they are drawn, so that all of them may stay in tiles.
    ///
    /// # Errors
    /// As [`ForwardTargets::new`].
    pub fn fit(&mut self, size: [u32; 2], is_developed: bool, in_tile: bool) -> Result<(), GlError> {
        let whole = self.layout.texture_size(size);
        self.resolved.resize(whole)?;
        self.in_tile = false;
        if in_tile && let Some(tile) = &mut self.tile {
            self.in_tile = tile.fit(&self.resolved).is_ok();
        }
        if let Some(samples) = self.samples.as_mut().filter(|_| !self.in_tile) {
            samples.resize(whole)?;
        }
        self.bloom.as_mut().map_or(Ok(()), |t| t.resize(size))?;
        match &mut self.developed {
            Some(_) if !is_developed => self.developed = None,
            Some(target) => target.resize(size)?,
            None if is_developed => {
                let formats = [(Format::Rgba8, Filter::Linear)];
                self.developed = Some(RenderTarget::new(&self.gl, size, &formats, None)?);
            }
            None => {}
        }
        Ok(())
    }

    /// Fills the resolved colour left of the columns `[first, end]` with the first of them, and right of them with the last.
    ///
    /// # Errors
    /// As [`RenderTarget::new`].
    pub fn repeat_columns(&mut self, [first, end]: [u32; 2]) -> Result<(), GlError> {
        let [width, height] = self.resolved.size();
        if self.column.is_none() {
            let formats = [(Format::Rgba8, Filter::Nearest)];
            self.column = Some(RenderTarget::new(&self.gl, [1, height], &formats, None)?);
        }
        let Some(column) = &mut self.column else { return Ok(()) };
        column.resize([1, height])?;
        let column = Destination::whole(column);
        let part = |x: u32, width: u32| Destination {
            origin: [x, 0],
            size: [width, height],
            ..Destination::whole(&self.resolved)
        };
        self.gl.pass("repeat", || {
            for (from, to, columns) in [(first, 0, first), (end - 1, end, width - end)] {
                if columns > 0 {
                    // OpenGL ES copies nothing within one image.
                    self.gl.copy(&part(from, 1), &column);
                    self.gl.copy(&column, &part(to, columns));
                }
            }
        });
        Ok(())
    }

    /// Which views it holds.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// The finished image: display-referred sRGB, filtered linearly. Alpha is luma; with several samples that of what
    /// is cut out is undefined.
    pub fn color(&self) -> &RenderTarget {
        self.developed.as_ref().unwrap_or(&self.resolved)
    }

    /// Where an eye of `size` pixels is in [`ForwardTargets::color`]: its lower left corner.
    pub fn origin(&self, size: [u32; 2], eye: Eye) -> [u32; 2] {
        if self.developed.is_some() { [0, 0] } else { self.layout.origin(size, eye) }
    }

    /// Average colour and nearest depth before bloom and outlines.
    pub fn resolved(&self) -> &RenderTarget {
        &self.resolved
    }

    /// The nearest depth of each pixel's samples; that of one of them without multisample textures (OpenGL ES 3.0), and
    /// where samples stayed in tiles.
    ///
    /// # Panics
    /// When it was not asked for since the last surface was drawn.
    pub fn depth(&self) -> &Texture {
        assert!(self.has_depth.get(), "this view was rendered without its depth");
        self.resolved.depth()
    }

    /// Each sample's depth, if it is kept and can be read.
    pub fn depth_samples(&self) -> Option<glow::Texture> {
        self.samples.as_ref().filter(|_| self.kept.depth)?.depth()
    }

    /// Each sample's colour, if it is kept, can be read and is that of the finished image.
    pub fn color_samples(&self) -> Option<glow::Texture> {
        self.samples.as_ref().filter(|_| self.kept.color && self.developed.is_none())?.color()
    }

    /// Notes that depth is drawn: the resolved one is another until [`Forward::resolve`], if there are samples.
    fn draws_depth(&self) {
        self.has_depth.set(self.samples.is_none());
    }

    /// Binds what is drawn into, with a viewport for an image of `size` pixels.
    fn bind(&self, size: [u32; 2]) {
        match (&self.samples, &self.tile) {
            (_, Some(tile)) if self.in_tile => tile.bind(size),
            (Some(samples), _) => samples.bind(size),
            (None, _) => self.gl.bind_framebuffer(Some(self.resolved.raw()), [0, 0], size),
        }
    }

    fn is_readable(&self) -> bool {
        self.samples.as_ref().is_some_and(|samples| samples.depth().is_some())
    }
}

/// What lights a frame's views.
pub struct Illumination<'a> {
    pub scene: &'a GpuScene,
    pub shadow: Option<&'a ShadowMap>,
    /// Relative to `eye`.
    pub lights: &'a Lights,
    pub tiles: &'a LightTiles,
    pub eye: Vec3,
    pub exposure: f32,
}

impl Illumination<'_> {
    /// Sets what `include/shade.glsl` needs in a program that is bound.
    pub fn set(&self, program: &Program) {
        program.set("exposure", self.exposure);
        if let Some(shadow) = self.shadow {
            shadow.set(program, FREE_UNIT, self.eye);
        }
        self.lights.set(program, &self.scene.sky);
        self.tiles.set(program);
    }
}

/// What of a scene is drawn.
pub enum Part<'a> {
    /// Of one view what a culler lets through.
    Selected(&'a Culler),
    /// What lies between two distances in metres.
    Slice([f32; 2]),
}

/// The passes, made for a scene's style and materials.
pub struct Forward {
    gl: Rc<Context>,
    samples: u32,
    exposure: f32,
    /// Outlines, which read all samples.
    ink: bool,
    /// Of `render/forward.frag`.
    defines: Vec<(&'static str, String)>,
    /// By [`Layout::index`].
    geometry: [Option<GeometryPass>; Layout::COUNT],
    sky: Program,
    load: Program,
    /// Where there is more than one sample.
    soften: Option<Program>,
    /// Where samples can be read.
    nearest: Option<Program>,
    bloom: Option<BloomPass>,
    /// Where there are bloom or outlines.
    develop: Option<Program>,
}

impl Forward {
    /// Compiles what all views need; [`Forward::prepare`] does the rest.
    ///
    /// # Errors
    /// As [`Program::new`]; [`GlError::Unsupported`] when the driver has not as many samples.
    pub fn new(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> Result<Forward, GlError> {
        Forward::build(gl, settings, scene, gl.capabilities().multisample_textures)
    }

    /// As [`Forward::new`], for targets that are `readable` sample by sample or not.
    pub(super) fn build(
        gl: &Rc<Context>,
        settings: &RenderSettings,
        scene: &GpuScene,
        readable: bool,
    ) -> Result<Forward, GlError> {
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
        Ok(Forward {
            gl: gl.clone(),
            samples,
            exposure: settings.exposure,
            ink,
            defines,
            geometry: [const { None }; Layout::COUNT],
            sky,
            load: Program::new(gl, ShaderSource::Screen("render/load.frag"), &[])?,
            soften: soften.transpose()?,
            nearest: nearest.transpose()?,
            bloom: bloom.transpose()?,
            develop: develop.transpose()?,
        })
    }

    /// Compiles what views of a layout need; nothing is done if that is there already.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn prepare(&mut self, scene: &GpuScene, layout: Layout) -> Result<(), GlError> {
        let pass = &mut self.geometry[layout.index()];
        if pass.is_none() {
            let multisample = self.samples > 1;
            *pass = Some(GeometryPass::forward(&self.gl, scene, layout, &self.defines, multisample)?);
        }
        Ok(())
    }

    /// Whether samples are needed to end an image: outlines read them.
    pub fn reads_samples(&self) -> bool {
        self.ink
    }

    /// Whether something is done to an image after its samples are averaged.
    pub fn develops(&self) -> bool {
        self.develop.is_some()
    }

    /// Empties the targets for these views.
    pub fn clear(&self, targets: &ForwardTargets, view: &View) {
        targets.bind(targets.layout.texture_size(view.size));
        targets.draws_depth();
        self.gl.clear(Some(view.depth.clear_value()));
    }

    /// Begins with an image and its depth instead of nothing: the rectangle of the view's size whose lower left corner is
    /// pixel `crop`.
    pub fn load(
        &self,
        targets: &ForwardTargets,
        (color, depth): (&Texture, &Texture),
        crop: [u32; 2],
        view: &View,
    ) {
        targets.bind(view.size);
        targets.draws_depth();
        self.copy((color, depth), crop);
    }

    /// Makes the edges soft against which the rest is tested, after [`Forward::load`] of an image whose own edges are.
    pub fn soften(&self, targets: &ForwardTargets, depth: &Texture, crop: [u32; 2], view: &View) {
        let Some(program) = &self.soften else { return };
        targets.bind(view.size);
        self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
        self.gl.set_alpha_to_coverage(true);
        self.gl.mask_color();
        program
            .bind()
            .texture("depth_map", 0, depth.raw())
            .set("offset", IVec2::from(crop.map(|n| n as i32)));
        set_view(program, view);
        self.gl.draw_screen();
        self.gl.set_alpha_to_coverage(false);
    }

    /// Fills what is bound by colour and depth of an image, from pixel `crop` on.
    fn copy(&self, (color, depth): (&Texture, &Texture), crop: [u32; 2]) {
        self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
        self.load
            .bind()
            .texture("color_map", 0, color.raw())
            .texture("depth_map", 1, depth.raw())
            .set("offset", IVec2::from(crop.map(|n| n as i32)));
        self.gl.draw_screen();
    }

    /// Draws opaque surfaces, lit, where nothing in the targets hides them.
    pub fn draw(&self, targets: &ForwardTargets, light: &Illumination, views: &[View], part: &Part) {
        let (Some(pass), Some(view)) = (&self.geometry[targets.layout.index()], views.first()) else {
            return;
        };
        targets.bind(targets.layout.texture_size(view.size));
        targets.draws_depth();
        pass.programs().for_each(|program| light.set(program.bind()));
        match part {
            Part::Selected(culler) => pass.draw_selected(light.scene, view, culler),
            Part::Slice(slice) => pass.draw(light.scene, views, *slice),
        }
    }

    /// Draws the sky where nothing was drawn.
    pub fn draw_sky(&self, targets: &ForwardTargets, light: &Illumination, views: &[View]) {
        let state = RasterState { depth: DepthTest::Equal, ..RasterState::SCREEN };
        for (view, eye) in views.iter().zip(Eye::BOTH) {
            let origin = targets.layout.origin(view.size, eye);
            self.bind_eye(targets, view, eye);
            self.gl.set_raster_state(&state);
            let far = view.depth.clear_value();
            self.gl.set_depth_window([far, far]);
            light.set(self.sky.bind());
            set_view(&self.sky, view);
            self.sky
                .set("view_origin", Vec2::from(origin.map(|n| n as f32)))
                .set("view_texel", 1.0 / Vec2::from(view.size.map(|n| n as f32)));
            self.gl.draw_screen();
            self.gl.set_depth_window([0.0, 1.0]);
        }
    }

    /// Binds the targets with the viewport of one of their views.
    pub fn bind_eye(&self, targets: &ForwardTargets, view: &View, eye: Eye) {
        targets.bind(view.size);
        let origin = targets.layout.origin(view.size, eye);
        self.gl.set_viewport(origin, view.size);
    }

    /// Averages the samples, and takes their nearest depth if `depth` is wanted, or if outlines need it; what
    /// [`ForwardTargets::kept`] does not name is given up.
    pub fn resolve(&self, targets: &ForwardTargets, view: &View, depth: bool) {
        let depth = depth || (self.ink && !targets.is_readable());
        if let Some(tile) = targets.tile.as_ref().filter(|_| targets.in_tile) {
            if !depth {
                tile.discard_depth();
            }
        } else if targets.samples.is_some() {
            self.resolve_to(targets, &targets.resolved, view, depth);
        }
        if depth {
            targets.has_depth.set(true);
        }
    }

    /// As [`Forward::resolve`], into another image, which has the view's size, 8-bit colour and float depth.
    pub fn resolve_to(&self, targets: &ForwardTargets, to: &RenderTarget, view: &View, depth: bool) {
        let Some(samples) = &targets.samples else {
            let (color, depth) = (targets.resolved.color(0), targets.depth());
            self.gl.pass("resolve", || {
                to.bind();
                self.copy((color, depth), [0, 0]);
            });
            return;
        };
        let Kept { color, depth: kept_depth } = targets.kept;
        let nearest = depth && targets.is_readable() && !targets.first_sample;
        let reads_depth = self.ink || nearest;
        self.gl.pass("resolve", || {
            samples.resolve_color(to);
            if depth && !nearest {
                samples.resolve_depth(to);
            }
            samples.discard(!(color || self.ink), !(kept_depth || reads_depth));
        });
        if let (true, Some(program), Some(map)) = (nearest, &self.nearest, samples.depth()) {
            self.gl.pass("nearest depth", || {
                to.bind();
                self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
                self.gl.mask_color();
                program
                    .bind()
                    .texture_multisample("depth_map", 0, map)
                    .set("nearer", nearer(view.depth.convention));
                self.gl.draw_screen();
                self.gl.set_raster_state(&RasterState::SCREEN);
            });
        }
    }

    /// Adds bloom and outlines to an eye's image, where there are any. With `again` the bloom is that of the time before.
    pub fn develop(&self, targets: &ForwardTargets, view: &View, eye: Eye, again: bool) {
        let (Some(program), Some(to)) = (&self.develop, &targets.developed) else { return };
        let source = targets.resolved.color(0);
        let origin = targets.layout.origin(view.size, eye);
        let bloom = self.bloom.as_ref().zip(targets.bloom.as_ref());
        if let Some((pass, bloom)) = bloom.filter(|_| !again) {
            let columns = targets.columns.map_or([0, view.size[0]], |columns| columns.always);
            pass.run_display_referred(bloom, source, (origin, view.size), columns, self.exposure);
        }
        self.gl.pass("develop", || {
            self.gl.set_raster_state(&RasterState::SCREEN);
            to.bind();
            program
                .bind()
                .texture("source", 0, source.raw())
                .set("view_origin", IVec2::from(origin.map(|n| n as i32)))
                .set("view_size", IVec2::from(view.size.map(|n| n as i32)))
                .set("line_width", line_width(view));
            if let Some((_, bloom)) = bloom {
                program
                    .texture("bloom", 1, bloom.result().raw())
                    .set("bloom_strength", bloom::STRENGTH * self.exposure);
            }
            if self.ink {
                match targets.samples.as_ref().and_then(|s| s.depth().zip(s.color())) {
                    Some((depth, color)) => program
                        .texture_multisample("depth_map", 2, depth)
                        .texture_multisample("color_map", 3, color),
                    None => program.texture("depth_map", 2, targets.depth().raw()),
                };
            }
            set_view(program, view);
            self.gl.draw_screen();
        });
    }
}
