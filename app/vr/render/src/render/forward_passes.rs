//! The passes of the forward renderer.

use glam::{IVec2, Vec2, Vec3};

use super::bloom;
use super::cluster::Culler;
use super::forward::ForwardRenderer;
use super::forward_targets::ForwardTargets;
use super::g_buffer::Layout;
use super::geometry::Part;
use super::light_tiles::LightTiles;
use super::lighting::line_width;
use super::lights::Lights;
use super::scene::{FREE_UNIT, GpuScene};
use super::shadow::ShadowMap;
use super::transparent::Onto;
use super::uniforms::{nearer, set_view};
use super::view::ViewImages;
use yoro::eyes::{Eye, View};
use yoro_gl::{DepthTest, Program, RasterState, RenderTarget, Texture};

/// The light in the views of a frame.
pub struct Illumination<'a> {
    pub scene: &'a GpuScene,
    pub shadow: Option<&'a ShadowMap>,
    /// Relative to `eye`.
    pub lights: Lights,
    pub tiles: LightTiles,
    pub eye: Vec3,
    pub exposure: f32,
}

impl Illumination<'_> {
    /// Sets the uniforms of `include/shade.glsl` in a bound program.
    fn set(&self, program: &Program) {
        program.set("exposure", self.exposure);
        if let Some(shadow) = self.shadow {
            shadow.set(program, FREE_UNIT, self.eye);
        }
        self.lights.set(program, &self.scene.sky);
        self.tiles.set(program);
    }
}

impl ForwardRenderer {
    /// Returns the light of the views in an image of this layout, for positions relative to the view `from`.
    pub(super) fn illuminate<'a>(
        &'a self,
        layout: Layout,
        scene: &'a GpuScene,
        views: &[View],
        from: &View,
    ) -> Illumination<'a> {
        let (lights, eye) = (self.common.lights(scene, views), from.pose.position);
        Illumination {
            scene,
            shadow: self.common.shadow.as_ref(),
            tiles: LightTiles::new(&lights, layout, views),
            lights: lights.seen_from(eye),
            eye,
            exposure: self.common.settings.exposure,
        }
    }

    /// Clears the targets, and draws a part of the scene and the sky behind it.
    pub(super) fn draw_on_sky(
        &self,
        targets: &ForwardTargets,
        scene: &GpuScene,
        views: &[View],
        part: &Part,
    ) {
        let view = &views[0];
        self.common.gl.pass("forward", || {
            targets.bind(targets.layout().texture_size(view.size));
            targets.draws_depth();
            self.common.gl.clear(Some(view.depth.clear_value()));
            let light = self.illuminate(targets.layout(), scene, views, view);
            self.draw(targets, &light, views, part);
            self.draw_sky(targets, &light, views);
        });
    }

    /// Draws the transparent surfaces of each view.
    pub(super) fn draw_transparent(&self, targets: &ForwardTargets, scene: &GpuScene, views: &[View]) {
        if !scene.has_transparent() {
            return;
        }
        for (view, eye) in views.iter().zip(Eye::BOTH) {
            self.bind_eye(targets, view, eye);
            let (light, all) = (self.illuminate(targets.layout(), scene, views, view), Culler::of_view(view));
            self.common.transparent.run(Onto::Bound, scene, view, &all, |program| light.set(program));
        }
    }

    /// Fills the targets from the rectangle of an image and its depth that has the view's size and its lower left
    /// corner at pixel `crop`.
    pub(super) fn load(
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

    /// Softens the edges of the depth that later surfaces are tested against. Called after [`ForwardRenderer::load`],
    /// since the edges in the loaded image are soft.
    pub(super) fn soften(&self, targets: &ForwardTargets, depth: &Texture, view: &View) {
        let Some(program) = &self.soften else { return };
        targets.bind(view.size);
        self.common.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
        self.common.gl.set_alpha_to_coverage(true);
        self.common.gl.mask_color();
        program.bind().texture("depth_map", 0, depth.raw()).set("offset", IVec2::ZERO);
        set_view(program, view);
        self.common.gl.draw_screen();
        self.common.gl.set_alpha_to_coverage(false);
    }

    /// Fills the bound framebuffer from colour and depth of an image, starting at pixel `crop`.
    fn copy(&self, (color, depth): (&Texture, &Texture), crop: [u32; 2]) {
        self.common.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
        self.load
            .bind()
            .texture("color_map", 0, color.raw())
            .texture("depth_map", 1, depth.raw())
            .set("offset", IVec2::from(crop.map(|n| n as i32)));
        self.common.gl.draw_screen();
    }

    /// Draws and lights the opaque surfaces that nothing in the targets hides.
    pub(super) fn draw(&self, targets: &ForwardTargets, light: &Illumination, views: &[View], part: &Part) {
        let (Some(pass), Some(view)) = (&self.geometry[targets.layout().index()], views.first()) else {
            return;
        };
        targets.bind(targets.layout().texture_size(view.size));
        targets.draws_depth();
        pass.programs().for_each(|program| light.set(program.bind()));
        pass.draw(light.scene, views, part);
    }

    /// Draws the sky where nothing was drawn.
    pub(super) fn draw_sky(&self, targets: &ForwardTargets, light: &Illumination, views: &[View]) {
        let state = RasterState { depth: DepthTest::Equal, ..RasterState::SCREEN };
        for (view, eye) in views.iter().zip(Eye::BOTH) {
            let origin = targets.layout().origin(view.size, eye);
            self.bind_eye(targets, view, eye);
            self.common.gl.set_raster_state(&state);
            let far = view.depth.clear_value();
            self.common.gl.set_depth_window([far, far]);
            light.set(self.sky.bind());
            set_view(&self.sky, view);
            self.sky
                .set("view_origin", Vec2::from(origin.map(|n| n as f32)))
                .set("view_texel", 1.0 / Vec2::from(view.size.map(|n| n as f32)));
            self.common.gl.draw_screen();
            self.common.gl.set_depth_window([0.0, 1.0]);
        }
    }

    /// Binds the targets with the viewport of one of their views.
    pub(super) fn bind_eye(&self, targets: &ForwardTargets, view: &View, eye: Eye) {
        targets.bind(view.size);
        let origin = targets.layout().origin(view.size, eye);
        self.common.gl.set_viewport(origin, view.size);
    }

    /// Averages the samples, and takes their nearest depth if `depth` is set or outlines need it. Discards the samples
    /// unless `keep` is set.
    pub(super) fn resolve(&self, targets: &ForwardTargets, view: &View, depth: bool, keep: bool) {
        let depth = depth || (self.ink && !targets.is_readable());
        if let Some(tile) = targets.tile() {
            debug_assert!(!depth, "depth of tiles is lost");
            tile.discard_depth();
        } else if targets.samples().is_some() {
            self.resolve_to(targets, &targets.resolved, view, depth, keep);
        }
        if depth {
            targets.has_resolved_depth();
        }
    }

    /// Like [`ForwardRenderer::resolve`], but into another image, which has the view's size, 8-bit colour and float
    /// depth.
    pub(super) fn resolve_to(
        &self,
        targets: &ForwardTargets,
        to: &RenderTarget,
        view: &View,
        depth: bool,
        keep: bool,
    ) {
        let gl = &self.common.gl;
        let Some(samples) = targets.samples() else {
            let (color, depth) = (targets.resolved.color(0), targets.depth());
            gl.pass("resolve", || {
                to.bind();
                self.copy((color, depth), [0, 0]);
            });
            return;
        };
        let nearest = depth && targets.is_readable();
        let reads_depth = self.ink || nearest;
        gl.pass("resolve", || {
            samples.resolve_color(to);
            if depth && !nearest {
                samples.resolve_depth(to);
            }
            samples.discard(!(keep || self.ink), !(keep || reads_depth));
        });
        if let (true, Some(program), Some(map)) = (nearest, &self.nearest, samples.depth()) {
            gl.pass("nearest depth", || {
                to.overwrite_depth();
                gl.set_raster_state(&RasterState::SCREEN_DEPTH);
                program
                    .bind()
                    .texture_multisample("depth_map", 0, map)
                    .set("nearer", nearer(view.depth.convention));
                gl.draw_screen();
                gl.set_raster_state(&RasterState::SCREEN);
            });
        }
    }

    /// Adds bloom and outlines, if there are any, to an eye's image. With `reuse_bloom` the previous bloom is used reuse_bloom.
    /// Until another eye is developed, [`ViewImages::color`] is this eye's.
    pub(crate) fn develop(&self, targets: &ForwardTargets, view: &View, eye: Eye, reuse_bloom: bool) {
        let (Some(program), Some(to)) = (&self.develop, &targets.developed) else { return };
        let source = targets.resolved.color(0);
        let origin = targets.layout().origin(view.size, eye);
        let bloom = self.bloom.as_ref().zip(targets.bloom.as_ref());
        if let Some((pass, bloom)) = bloom.filter(|_| !reuse_bloom) {
            let columns = targets.request.columns.map_or([0, view.size[0]], |columns| columns.always);
            pass.run_display_referred(
                bloom,
                source,
                (origin, view.size),
                columns,
                self.common.settings.exposure,
            );
        }
        self.common.gl.pass("develop", || {
            self.common.gl.set_raster_state(&RasterState::SCREEN);
            to.overwrite();
            program
                .bind()
                .texture("source", 0, source.raw())
                .set("view_origin", IVec2::from(origin.map(|n| n as i32)))
                .set("view_size", IVec2::from(view.size.map(|n| n as i32)))
                .set("line_width", line_width(view));
            if let Some((_, bloom)) = bloom {
                program
                    .texture("bloom", 1, bloom.result().raw())
                    .set("bloom_strength", bloom::STRENGTH * self.common.settings.exposure);
            }
            if self.ink {
                match targets.samples().and_then(|s| s.depth().zip(s.color())) {
                    Some((depth, color)) => program
                        .texture_multisample("depth_map", 2, depth)
                        .texture_multisample("color_map", 3, color),
                    None => program.texture("depth_map", 2, targets.depth().raw()),
                };
            }
            set_view(program, view);
            self.common.gl.draw_screen();
        });
    }
}
