//! The passes of the renderer.

use glam::{IVec2, Mat3, Vec2, Vec3};

use super::bloom::Shining;
use super::depth::DepthImage;
use super::geometry::Variant;
use super::layout::Layout;
use super::light_tiles::LightTiles;
use super::lights::Lights;
use super::lit::LitScene;
use super::rectangle::{Rectangle, Region};
use super::renderer::{Composite, Outlines, Renderer, Resolve};
use super::scene::{FREE_UNIT, GpuScene, MAP_NAMES};
use super::settings::SAMPLE_DEPTH;
use super::shadow::ShadowMap;
use super::targets::{Onto, Targets};
use super::uniforms::{nearer, set_view, view_rays};
use crate::stereo::EyeTarget;
use yoro::eyes::{DisparityMap, Eye, View, Warp};
use yoro_gl::{DepthTest, Destination, Format, GlError, Image, Pass, Program, RasterState, Texture};

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
    /// Declares what lit surfaces sample.
    pub fn declare<'p>(&self, pass: Pass<'p>) -> Pass<'p> {
        let pass = self.scene.declare(pass, MAP_NAMES.len());
        match self.shadow {
            Some(shadow) => shadow.declare(pass),
            None => pass,
        }
    }

    /// Sets the uniforms of `include/shade.glsl` in a bound program.
    pub fn set(&self, program: &Program) {
        program.set("exposure", self.exposure);
        if let Some(shadow) = self.shadow {
            shadow.set(program, FREE_UNIT, self.eye);
        }
        self.lights.set(program, &self.scene.sky);
        self.tiles.set(program);
    }
}

/// What the second eye takes from the dominant eye's image.
#[derive(Clone, Copy)]
pub(crate) struct Reprojection<'a> {
    /// Display-referred colour of the dominant eye, filtered linearly.
    pub color: &'a Texture,
    /// Its nearest depth.
    pub depth: &'a Texture,
    /// Maps a column of the dominant eye to that of the second.
    pub law: DisparityMap,
    /// Row of the second eye minus that of the dominant.
    pub row_offset: i32,
    /// Inverse distance, in 1 / metres, whose disparity is half a pixel.
    pub half_pixel: f32,
}

/// What is known of the other eye while a view is drawn.
#[derive(Clone, Copy)]
pub(crate) enum Known<'a> {
    Nothing,
    /// The dominant eye's colours, which are taken where it sees the surface.
    Colors(&'a Reprojection<'a>),
    /// How the view is displaced to the other eye, which sees nothing beyond its border.
    Border(&'a Warp),
}

impl Renderer {
    /// Returns the light of the views in an image of this layout, for positions relative to the first view.
    pub(super) fn illuminate<'a>(
        &'a self,
        layout: Layout,
        scene: &LitScene<'a>,
        views: &[View],
    ) -> Illumination<'a> {
        let lights = self.lights(scene, views);
        Illumination {
            scene: scene.scene(),
            shadow: self.shadow.as_ref(),
            tiles: LightTiles::new(&lights, layout, views),
            lights,
            eye: views[0].pose.position,
            exposure: self.settings.exposure,
        }
    }

    fn variant(targets: &Targets) -> Variant {
        let (layout, samples) = (targets.layout, targets.samples);
        Variant { layout, carried: targets.carries, ..Variant::plain(samples) }
    }

    /// Clears the targets, and draws the scene, or a slice of it, and the sky behind it.
    pub(super) fn draw_on_sky(
        &self,
        targets: &mut Targets,
        scene: &LitScene,
        views: &[View],
        slice: Option<[f32; 2]>,
        known: Known,
    ) {
        let view = &views[0];
        let light = self.illuminate(targets.layout, scene, views);
        let mut pass = targets.declare(light.declare(self.gl.pass("surfaces")));
        if let Known::Colors(from) = known {
            pass = pass.read("dominant_color", from.color).read("depth_map", from.depth);
        }
        pass.run(|| {
            targets.bind(targets.layout.texture_size(view.size));
            self.gl.clear(Some(view.depth.clear_value()));
            if let Known::Border(warp) = known {
                self.draw_curtain(warp);
            }
            let variant =
                Variant { reprojected: matches!(known, Known::Colors(_)), ..Renderer::variant(targets) };
            self.draw_opaque(variant, &light, views, slice, |program| {
                if let Known::Colors(from) = known {
                    set_reprojection(program, from, view);
                }
            });
            self.draw_sky(Renderer::variant(targets), &light, views, |_| {});
        });
    }

    /// Draws and lights the opaque surfaces, or a slice of them, that nothing in the bound framebuffer hides.
    pub(super) fn draw_opaque(
        &self,
        variant: Variant,
        light: &Illumination,
        views: &[View],
        slice: Option<[f32; 2]>,
        more: impl Fn(&Program),
    ) {
        let Some(pass) = self.geometry.iter().find(|pass| pass.variant == variant) else { return };
        pass.programs().for_each(|program| {
            light.set(program.bind());
            more(program);
        });
        pass.draw(light.scene, views, slice);
    }

    /// Draws the sky where nothing was drawn.
    pub(super) fn draw_sky(
        &self,
        variant: Variant,
        light: &Illumination,
        views: &[View],
        more: impl Fn(&Program),
    ) {
        let Some((_, program)) = self.skies.iter().find(|(made, _)| *made == variant) else { return };
        let (layout, stencil) = (variant.layout, variant.stencil());
        // With multiview, one triangle is drawn for both eyes.
        let rays: [Mat3; 2] = std::array::from_fn(|i| view_rays(views.get(i).unwrap_or(&views[0])));
        let drawn = if layout == Layout::Layered { 1 } else { views.len() };
        for (i, eye) in Eye::BOTH.into_iter().enumerate().take(drawn) {
            let view = &views[i];
            let origin = layout.origin(view.size, eye);
            self.gl.set_viewport(origin, view.size);
            self.gl.set_raster_state(&RasterState {
                depth: DepthTest::Equal,
                stencil,
                ..RasterState::SCREEN
            });
            let far = view.depth.clear_value();
            self.gl.set_depth_window([far, far]);
            light.set(program.bind());
            more(program);
            program
                .set("rays", if layout == Layout::Layered { &rays[..] } else { &rays[i..=i] })
                .set("view_origin", Vec2::from(origin.map(|n| n as f32)))
                .set("pixel_extent", 1.0 / Vec2::from(view.size.map(|n| n as f32)));
            self.gl.draw_screen();
            self.gl.set_depth_window([0.0, 1.0]);
        }
        self.gl.set_viewport([0, 0], layout.texture_size(views[0].size));
    }

    /// Draws the transparent surfaces over what is in the targets.
    pub(super) fn draw_transparent(&self, targets: &Targets, scene: &LitScene, views: &[View]) {
        if scene.has_transparent() {
            let light = self.illuminate(targets.layout, scene, views);
            self.transparent.run(Renderer::variant(targets), scene, views, &light, None);
        }
    }

    /// Draws the transparent surfaces over the picture of a view, where it is seen in the rectangle `shown` of `to`, into
    /// which the view was drawn. Only the region around them is loaded, with its depth, and stored.
    pub(crate) fn draw_over_source(
        &self,
        targets: &mut Targets,
        scene: &LitScene,
        view: &View,
        shown: Rectangle,
        to: &EyeTarget,
    ) -> Result<(), GlError> {
        let Some(region) = scene.transparent_region(view) else { return Ok(()) };
        let parts = || region.rectangles().filter_map(|part| part.within(&shown));
        if parts().next().is_none() {
            return Ok(());
        }
        let framebuffer = targets.fit_over(view.size)?.framebuffer;
        let place = |Rectangle { origin, size }| Destination { framebuffer, origin, size };
        let picture = targets.picture().1;
        let color = |Rectangle { size, .. }| Image { size, ..picture };
        for part in parts() {
            let depth = targets.depth(view.size, Eye::Left, part.origin);
            let known = Image { size: part.size, ..depth.texture.image() };
            let pass = || self.gl.pass("load").load([color(part)]);
            match targets.onto {
                Onto::Resolved => pass().read("copied", known).run(|| {}),
                Onto::Tile => pass().read("depth_map", known).run(|| {
                    if let Some(load) = &self.depth_load {
                        load.draw(&depth, &place(part), view.depth.convention, [[1.0; 2], [0.0; 2]]);
                    }
                }),
                Onto::Samples => self.load(targets, view, part.origin, targets, &place(part)),
            }
        }
        self.gl.bind_framebuffer(framebuffer, [0, 0], view.size);
        let variant = Variant {
            carried: targets.carries && targets.onto == Onto::Samples,
            ..Variant::plain(targets.samples)
        };
        let views = std::slice::from_ref(view);
        let light = self.illuminate(Layout::Single, scene, views);
        self.transparent.run(variant, scene, views, &light, Some(&shown));
        match (targets.onto, targets.multisample()) {
            (Onto::Tile, _) => targets.discard_depth(),
            (Onto::Samples, Some(samples)) => {
                let framebuffer = to.color.framebuffer;
                let pass = self.gl.pass("resolve").in_tile(samples.images());
                pass.write(parts().map(color)).run(|| {
                    for part in parts() {
                        samples.average(0, &Destination { framebuffer, ..place(part) });
                    }
                    samples.discard(true, true);
                });
            }
            _ => {}
        }
        Ok(())
    }

    /// Draws the transparent surfaces over the bound framebuffer, which holds an eye and its depth from pixel [0, 0] on, and
    /// has this many samples in each pixel.
    pub(crate) fn draw_over(&self, scene: &LitScene, view: &View, samples: u32) {
        let views = std::slice::from_ref(view);
        let light = self.illuminate(Layout::Single, scene, views);
        self.transparent.run(Variant::plain(samples), scene, views, &light, None);
    }

    /// Averages the samples, into `to` if it is given, and takes their nearest depth if `depth` is set. With `ink`,
    /// outlines are drawn. The samples are lost.
    pub(super) fn resolve(
        &self,
        targets: &mut Targets,
        view: &View,
        depth: bool,
        ink: bool,
        to: Option<&Destination>,
    ) -> Result<(), GlError> {
        match targets.onto {
            Onto::Resolved if !depth && !ink => targets.discard_depth(),
            Onto::Resolved => {}
            Onto::Tile => {
                if targets.carries
                    && let Some(carry) = &self.carry
                {
                    self.gl.pass("carry").run(|| carry.run());
                }
                targets.discard_depth();
            }
            Onto::Samples => self.resolve_samples(targets, view, depth, ink, to),
        }
        targets.has_depth = depth;
        let is_drawn = targets.onto == Onto::Samples && self.reads(targets);
        // An array's outlines are drawn eye by eye.
        if ink && !is_drawn && targets.layout != Layout::Layered {
            targets.ink_picture()?;
            self.draw_ink(targets, view, Eye::Left);
        }
        Ok(())
    }

    /// Draws the outlines of an eye that is a layer of the targets, if the style has outlines.
    pub(crate) fn ink_layer(&self, targets: &mut Targets, view: &View, eye: Eye) -> Result<(), GlError> {
        if self.ink && targets.layout == Layout::Layered {
            targets.ink_picture()?;
            self.draw_ink(targets, view, eye);
        }
        Ok(())
    }

    /// True if shaders can read the samples.
    fn reads(&self, targets: &Targets) -> bool {
        targets.multisample().is_some_and(|samples| samples.depth().is_some())
    }

    fn resolve_samples(
        &self,
        targets: &Targets,
        view: &View,
        depth: bool,
        ink: bool,
        to: Option<&Destination>,
    ) {
        let Some(samples) = targets.multisample() else { return };
        if self.reads(targets) && (depth || ink) {
            let [color, nearest] = [targets.resolved.color(0), targets.nearest()].map(Texture::image);
            let written = [color].into_iter().chain(depth.then_some(nearest));
            self.read_samples(targets, view, ink, written, &targets.resolved_place());
            // The depth buffer is not what is wanted, or not wanted at all.
            if !depth || !nearest.format.is_depth() {
                targets.discard_depth();
            }
            return;
        }
        if targets.carries
            && let Some(carry) = &self.carry
        {
            self.gl.pass("carry").run(|| carry.run());
        }
        let whole = Destination::whole(&targets.resolved);
        let to = to.unwrap_or(&whole);
        let pair = targets.halves.as_ref().filter(|_| targets.carries);
        let nearest = (depth || ink || pair.is_some()).then(|| targets.nearest());
        let pass = self.gl.pass("resolve").in_tile(samples.images());
        pass.write([to.image(Format::Rgba8)]).write(nearest.map(Texture::image)).run(|| {
            samples.average(0, to);
            match pair {
                Some(pair) => samples.average(1, &Destination::whole(pair)),
                None if depth || ink => samples.copy_depth(&targets.resolved),
                None => {}
            }
            samples.discard(true, true);
        });
    }

    /// Averages the samples in memory and takes their nearest depth, with outlines or without.
    fn read_samples(
        &self,
        targets: &Targets,
        view: &View,
        ink: bool,
        written: impl Iterator<Item = Image>,
        to: &Destination,
    ) {
        let Some(samples) = targets.multisample() else { return };
        let Some((color, depth)) = samples.color().zip(samples.depth()) else { return };
        let variant = Resolve { samples: samples.samples(), ink, depth: true, ..Resolve::default() };
        let Some((_, program)) = self.resolve.iter().find(|(made, _)| *made == variant) else { return };
        let mut images = samples.images();
        let mut pass = self.gl.pass("resolve");
        for (name, image) in ["color_map", "depth_map"].into_iter().zip(&mut images) {
            pass = pass.read(name, image);
        }
        pass.write(written).run(|| {
            self.gl.overwrite(to, 2, true);
            self.gl.set_raster_state(&RasterState::SCREEN_DEPTH);
            program.bind().texture_multisample("color_map", 0, color).texture_multisample(
                "depth_map",
                1,
                depth,
            );
            self.draw_resolve(program, targets.layout, view, targets.detail, None);
        });
    }

    /// Draws outlines over the resolved picture, or over one of its layers, into another one.
    fn draw_ink(&self, targets: &Targets, view: &View, eye: Eye) {
        let layer = targets.layout == Layout::Layered;
        let variant = Resolve { samples: 1, ink: true, layer, ..Resolve::default() };
        let (Some((_, program)), Some(inked)) =
            (self.resolve.iter().find(|(made, _)| *made == variant), &targets.inked)
        else {
            return;
        };
        let pass = self.gl.pass("outlines").read("color_map", targets.resolved.color(0));
        pass.read("depth_map", targets.resolved.depth()).write(inked.images()).run(|| {
            self.gl.set_raster_state(&RasterState::SCREEN);
            inked.overwrite();
            program.bind().texture_of("color_map", 0, targets.resolved.color(0)).texture_of(
                "depth_map",
                1,
                targets.resolved.depth(),
            );
            self.draw_resolve(program, targets.layout, view, targets.detail, layer.then_some(eye));
        });
    }

    /// Draws outlines of a view whose picture was resolved without them, beside it, from what is still in its samples or
    /// in that picture.
    pub(crate) fn ink_beside(&self, targets: &mut Targets, view: &View) -> Result<(), GlError> {
        if !self.ink {
            return Ok(());
        }
        targets.ink_picture()?;
        match &targets.inked {
            Some(inked) if self.reads(targets) => {
                self.read_samples(targets, view, true, inked.images(), &Destination::whole(inked));
            }
            _ => self.draw_ink(targets, view, Eye::Left),
        }
        Ok(())
    }

    /// Draws `render/resolve.frag` for each eye of an image, or for one layer.
    pub(super) fn draw_resolve(
        &self,
        program: &Program,
        layout: Layout,
        view: &View,
        detail: f32,
        layer: Option<Eye>,
    ) {
        let outlines = Outlines::of(view, detail);
        let vector = |v: [u32; 2]| IVec2::from(v.map(|n| n as i32));
        program
            .set("view_size", vector(view.size))
            .set("line_width", outlines.width)
            .set("line_strength", outlines.strength)
            .set("nearer", nearer(view.depth.convention));
        set_view(program, view);
        let eyes = match (layer, layout) {
            (Some(eye), _) => [Some(eye), None],
            (None, Layout::DoubleWide(_)) => Eye::BOTH.map(Some),
            (None, _) => [Some(Eye::Left), None],
        };
        for eye in eyes.into_iter().flatten() {
            let origin = layout.origin(view.size, eye);
            self.gl.set_viewport(origin, view.size);
            program.set("view_origin", vector(origin)).set("view_layer", eye.index() as i32);
            self.gl.draw_screen();
        }
    }

    /// Computes the bloom of an eye's image in the targets, as far as it [shines](Targets::fit).
    pub(crate) fn render_bloom(&self, targets: &Targets, view: &View, eye: Eye) {
        if let Some((pass, bloom)) = self.bloom.as_ref().zip(targets.bloom.as_ref()) {
            let shining = Shining {
                picture: targets.color().color(0),
                layer: targets.color_layer(eye),
                corner: targets.layout.origin(view.size, eye),
            };
            pass.run(bloom, &shining, self.settings.exposure);
        }
    }

    /// Writes a part of an eye's image, from pixel `crop` of the eye on, with bloom. In the region `depth` of the target
    /// it also writes the depth of the image, to draw more over it.
    pub(crate) fn composite(
        &self,
        targets: &Targets,
        view: &View,
        eye: Eye,
        crop: [u32; 2],
        to: &Destination,
        depth: Option<Region>,
    ) {
        let kind = Composite { bloom: self.bloom.is_some(), ..Composite::default() };
        self.composite_as(targets, view, eye, crop, to, depth, kind);
    }

    /// Writes a part of an image and its depth, without bloom, into other targets, or into the samples of its own, over which
    /// more is drawn.
    fn load(&self, from: &Targets, view: &View, crop: [u32; 2], targets: &Targets, to: &Destination) {
        let carries = if targets.carries { targets.samples } else { 0 };
        let kind = Composite { carries, ..Composite::default() };
        let whole = Some(Region::whole(to.size));
        self.gl.within_tile(|| self.composite_as(from, view, Eye::Left, crop, to, whole, kind));
    }

    #[allow(clippy::too_many_arguments, reason = "a pass names what it reads and writes")]
    fn composite_as(
        &self,
        targets: &Targets,
        view: &View,
        eye: Eye,
        crop: [u32; 2],
        to: &Destination,
        depth: Option<Region>,
        kind: Composite,
    ) {
        // Outlines of an array's eye are in a picture of its own.
        let layer = targets.color_layer(eye);
        let is_alone = targets.layer(eye).is_some() && layer.is_none();
        let corner = if is_alone { [0, 0] } else { targets.layout.origin(view.size, eye) };
        let bloom = targets.bloom.as_ref().filter(|_| kind.bloom);
        if depth.is_none() && bloom.is_none() && layer.is_none() {
            let from = [0, 1].map(|i| corner[i] + crop[i]);
            let copied = Image { size: to.size, ..targets.picture().1 };
            let pass = self.gl.pass("copy").read("copied", copied).write([to.image(Format::Rgba8)]);
            return pass.run(|| targets.color().copy_color(from, to));
        }
        let plain = Composite { layer: layer.is_some(), ..kind };
        let offset = [0, 1].map(|i| (corner[i] + crop[i]) as i32 - to.origin[i] as i32);
        let draw = |variant: Composite, image: Option<&DepthImage>, region: Region| {
            let Some((_, program)) = self.composite.iter().find(|(made, _)| *made == variant) else { return };
            let state = if image.is_some() { RasterState::SCREEN_DEPTH } else { RasterState::SCREEN };
            self.gl.set_raster_state(&state);
            let program = program.bind();
            match layer {
                None => program.texture("color_map", 0, targets.picture().0),
                Some(_) => program.texture_of("color_map", 0, targets.color().color(0)),
            };
            program.set("color_layer", layer.unwrap_or(0) as i32).set("offset", IVec2::from(offset));
            if let Some(image) = image {
                program.texture_of("depth_map", 1, image.texture);
            }
            if let Some(bloom) = bloom {
                let Rectangle { origin, size } = bloom.part();
                program
                    .texture("bloom", 2, bloom.result().raw())
                    .set("bloom_strength", self.bloom_strength())
                    .set("bloom_origin", IVec2::from([0, 1].map(|i| (corner[i] + origin[i]) as i32)))
                    .set("bloom_size", IVec2::from(size.map(|n| n as i32)));
            }
            for part in region.rectangles() {
                self.gl.set_viewport([0, 1].map(|i| to.origin[i] + part.origin[i]), part.size);
                self.gl.draw_screen();
            }
        };
        let color = Image { size: to.size, ..targets.picture().1 };
        let mut pass = self.gl.pass("composite").read("color_map", color).write([to.image(Format::Rgba8)]);
        if let Some(bloom) = bloom {
            pass = pass.read("bloom", bloom.result());
        }
        if let Some(region) = depth {
            let image = targets.depth(view.size, eye, crop).texture.image();
            for part in region.rectangles() {
                pass = pass.read("depth_map", Image { size: part.size, ..image });
            }
            // Tested by what is drawn over it, and lost.
            pass = pass.in_tile([to.image(SAMPLE_DEPTH)]);
        }
        pass.run(|| {
            self.gl.overwrite(to, 1, depth.is_some());
            let Some(region) = depth else { return draw(plain, None, Region::whole(to.size)) };
            let image = targets.depth(view.size, eye, crop);
            draw(Composite { depth: Some(image.is_pair), ..plain }, Some(&image), region);
            draw(plain, None, region.rest());
        });
    }

    /// Renders opaque surfaces, or a slice of them (near and far plane in metres), and the sky behind them, without bloom
    /// and outlines, for [`Renderer::draw_near`] or [`Renderer::draw_reprojected`].
    pub(crate) fn draw_plain(
        &self,
        targets: &mut Targets,
        scene: &LitScene,
        view: &View,
        slice: Option<[f32; 2]>,
    ) -> Result<(), GlError> {
        targets.fit(view, scene.detail(view), self.needs(true), None)?;
        self.draw_on_sky(targets, scene, &[*view], slice, Known::Nothing);
        self.resolve(targets, view, true, false, None)
    }

    /// Renders the surfaces in a slice over a part of another view, given by its lower left corner, and transparent
    /// surfaces over both. With `depth`, the targets then hold the depth of opaque surfaces.
    pub(crate) fn draw_near(
        &self,
        targets: &mut Targets,
        scene: &LitScene,
        view: &View,
        slice: Option<[f32; 2]>,
        (far, far_view, crop): (&Targets, &View, [u32; 2]),
        depth: bool,
    ) -> Result<(), GlError> {
        targets.fit(view, scene.detail(view), self.needs(depth), None)?;
        let views = std::slice::from_ref(view);
        let light = self.illuminate(Layout::Single, scene, views);
        targets.declare(light.declare(self.gl.pass("surfaces"))).run(|| {
            let to = targets.destination(view.size);
            self.load(far, far_view, crop, targets, &to);
            if let Some(slice) = slice {
                self.draw_opaque(Renderer::variant(targets), &light, views, Some(slice), |_| {});
            }
        });
        self.draw_transparent(targets, scene, views);
        self.resolve(targets, view, depth, self.ink, None)?;
        self.render_bloom(targets, view, Eye::Left);
        Ok(())
    }

    /// Renders the second eye, and takes the colours of surfaces that the dominant eye sees from its image.
    pub(crate) fn draw_reprojected(
        &self,
        targets: &mut Targets,
        scene: &LitScene,
        view: &View,
        from: &Reprojection,
        depth: bool,
    ) -> Result<(), GlError> {
        targets.fit(view, scene.detail(view), self.needs(depth), None)?;
        self.draw_on_sky(targets, scene, &[*view], None, Known::Colors(from));
        self.draw_transparent(targets, scene, std::slice::from_ref(view));
        self.resolve(targets, view, depth, self.ink, None)?;
        self.render_bloom(targets, view, Eye::Left);
        Ok(())
    }
}

/// Sets the uniforms and textures of `include/reprojection.glsl`.
fn set_reprojection(program: &Program, from: &Reprojection, view: &View) {
    let (c, m) = view.depth.inverse_distance_law();
    program
        .texture_of("dominant_color", FREE_UNIT + 1, from.color)
        .texture_of("depth_map", FREE_UNIT + 2, from.depth)
        .set("law", Vec2::new(from.law.offset as f32, from.law.scale as f32))
        .set("row_offset", from.row_offset)
        .set("inverse_distance", Vec2::new(c as f32, m as f32))
        .set("half_pixel", from.half_pixel);
}
