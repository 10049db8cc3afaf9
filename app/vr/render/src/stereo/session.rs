//! Both eyes of every frame: the one thing that a display, the page, the command line or a measurement holds to get them.

use std::rc::Rc;

use super::auto::Auto;
use super::fallback::{Fallback, FallbackReason, NearSwitch};
use super::frame::Frame;
use super::images::{LayerTargets, StereoImages};
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{HoleMethod, Method, MethodChoice, StereoOptions};
use super::rate::RateChooser;
use crate::prepared::PreparedScene;
use crate::view::RenderSettings;
use yoro::choice::{Cost, StereoPath};
use yoro::eyes::StereoViews;
use yoro::opengl::Part;
use yoro_gl::{Context, GlError};
use yoro_settings::FrameRate;

/// Where both eyes of a frame are written to.
#[expect(clippy::large_enum_variant, reason = "there is one, for the length of a call")]
pub enum FrameTargets<'a> {
    /// Each eye into its target, complete: eyes with an inset are composed there.
    ///
    /// The depth of composed eyes is that of the wide layer, if the target has its size and the layer has the eyes' frusta;
    /// otherwise it is cleared to the farthest depth. Motion vectors are the wide layer's.
    Eyes([EyeTarget<'a>; 2]),
    /// Each layer into targets of its own, for a runtime that composes the eyes.
    Layers(LayerTargets<'a>),
    /// Images for a last pass that reads, and composes, the finished eyes. They are fitted to the frame.
    Images(&'a mut StereoImages),
}

impl FrameTargets<'_> {
    /// Fills the targets with a colour, and their depth with the farthest, in place of a frame.
    ///
    /// # Errors
    /// [`GlError`] if the driver has no memory for the images.
    pub fn fill(self, gl: &Context, views: &StereoViews, color: [f32; 4]) -> Result<(), GlError> {
        let layers = match self {
            FrameTargets::Images(images) => images.fit(views, false, [None; 2])?,
            FrameTargets::Layers(layers) => layers,
            FrameTargets::Eyes(wide) => LayerTargets { wide, inset: None },
        };
        for eye in layers.layers().flatten() {
            eye.clear_depth(gl, views.shown.depth);
            let to = &eye.color;
            gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            gl.fill(to.origin, to.size, color);
        }
        Ok(())
    }
}

/// What a frame cost, when it was handed to the display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameLoad {
    /// The time at which the frame ended, in nanoseconds.
    pub ended_ns: i64,
    /// Rate in Hz at which frames are rendered for the display; 0 if unknown.
    pub refresh_hz: f32,
    /// Refresh rate of the display in Hz, which is twice `refresh_hz` while a runtime makes every second frame.
    pub display_hz: f32,
    /// Number of refreshes by which the frame was late.
    pub late_refreshes: u32,
    /// The time of a recent frame on the GPU, if it is known.
    pub gpu: Option<Cost>,
    /// The device's thermal headroom, if it is known; 1 is severe throttling.
    pub thermal_headroom: Option<f32>,
}

/// How a frame was rendered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// The reason why both eyes were rendered instead of using the method, if they were.
    pub fallback: Option<FallbackReason>,
    /// True if the targets' motion vectors were written. False if there were none, if the method writes none, or if the
    /// eyes changed so much since the previous frame that a runtime must not extrapolate this one.
    pub has_motion: bool,
    /// True if the targets' depth is that of what is shown.
    pub has_depth: bool,
    /// The first pixel of the dominant eye: beyond [0, 0] if it is a part of the view that was rendered into its texture.
    pub origin: [u32; 2],
}

/// How a frame is rendered.
struct Plan {
    path: StereoPath,
    fallback: Option<FallbackReason>,
    /// True if the frame counts for the automatic choice between two methods.
    counts: bool,
}

/// A method, named or chosen by its cost, and two renders in its place for eyes that it cannot use.
///
/// While sizes stay, frames allocate and compile nothing, once the session is prepared or has rendered one on each path:
/// two renders in place of a named method are made when they are first needed.
pub struct StereoSession {
    gl: Rc<Context>,
    options: StereoOptions,
    method: Method,
    /// The named method, or synthesis.
    chosen: LayerMethods,
    /// Two renders, made when first needed.
    both: Option<LayerMethods>,
    auto: Option<Auto>,
    fallback: Fallback,
    /// True while both eyes are rendered for a comparison with the method.
    is_comparing: bool,
    rate: RateChooser,
    /// The images of eyes that are composed here, made with the first of them.
    images: Option<StereoImages>,
}

impl StereoSession {
    /// Makes the method, or all of [`MethodChoice::Auto`], without what depends on a scene.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver cannot run the method.
    pub fn new(
        gl: &Rc<Context>,
        choice: MethodChoice,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<StereoSession, GlError> {
        let method = choice.first();
        settings.supports(method, gl.capabilities())?;
        options.check(method)?;
        let is_auto = choice == MethodChoice::Auto;
        let mut session = StereoSession {
            gl: gl.clone(),
            options: *options,
            method,
            chosen: LayerMethods::new(gl, method, options)?,
            both: None,
            auto: is_auto.then(|| Auto::new(gl, options.holes)),
            fallback: Fallback::new(gl, method, options)?,
            is_comparing: false,
            rate: RateChooser::default(),
            images: None,
        };
        if is_auto {
            session.two_renders()?;
        }
        Ok(session)
    }

    /// Returns the method; of [`MethodChoice::Auto`], the one chosen last. While a choice is being made, they take turns.
    pub fn method(&self) -> Method {
        match self.auto.as_ref().map(|auto| auto.choice().path) {
            Some(StereoPath::TwoViews) => Method::Conventional,
            _ => self.method,
        }
    }

    /// Returns the choice between methods, if there is one.
    pub fn auto(&self) -> Option<&Auto> {
        self.auto.as_ref()
    }

    /// True if the display's runtime makes every second frame, from motion vectors.
    pub fn uses_runtime_frame_synthesis(&self) -> bool {
        self.options.motion_vectors
            && match self.options.frame_rate {
                FrameRate::Full => false,
                FrameRate::Half => true,
                FrameRate::Auto => self.rate.is_half,
            }
    }

    /// Compiles what a scene's materials need, so that its first frame need not; with `has_inset`, also for frames that have an
    /// inset.
    ///
    /// # Errors
    /// [`StereoError::Gl`] if the driver refuses.
    pub fn prepare(&mut self, scene: &mut PreparedScene, has_inset: bool) -> Result<(), StereoError> {
        self.fallback.prepare(&scene.renderer)?;
        let both = self.both.as_mut().filter(|_| self.auto.is_some());
        let mut all = [Some(&mut self.chosen), both].into_iter().flatten();
        all.try_for_each(|methods| methods.prepare(scene, has_inset))
    }

    /// Makes two renders ready, so that the first frame of a comparison need not.
    ///
    /// # Errors
    /// [`GlError`] if the driver refuses.
    pub fn prepare_comparison(&mut self) -> Result<(), GlError> {
        self.two_renders().map(drop)
    }

    /// Starts or ends a comparison, during which both eyes are rendered. Returns true if this is a change.
    pub fn compare(&mut self, is_comparing: bool) -> bool {
        std::mem::replace(&mut self.is_comparing, is_comparing) != is_comparing
    }

    /// Makes an automatic choice measure again, after a change of the viewpoint or the resolution.
    pub fn measure_again(&mut self) {
        self.interrupt();
        if let Some(auto) = &mut self.auto {
            auto.scene_changed();
        }
    }

    /// Forgets the loads so far, which no longer describe the frames after a pause.
    pub fn interrupt(&mut self) {
        self.rate.interrupt();
    }

    /// Returns the size in pixels of the view of which the dominant eye is a part, if that view is rendered into the eye's
    /// texture where it is as large ([`EyeTarget::texture`]), also if that is sRGB.
    pub fn rendered_size(&self, scene: &PreparedScene, views: &StereoViews) -> Option<[u32; 2]> {
        let [wide, _] = self.chosen.rendered_parts(scene, views);
        let is_read = views.inset.is_none() && scene.renderer.reads_stored(&scene.scene);
        wide.filter(|_| is_read).map(|part| part.image_size)
    }

    /// Renders both eyes of a frame. `previous` is the load of the frame before it, for what is chosen by time; `None` for a
    /// first frame, and where nothing is.
    ///
    /// # Errors
    /// [`StereoError`] if neither the method nor two renders support the eyes, or GL refuses.
    pub fn frame(
        &mut self,
        scene: &mut PreparedScene,
        views: &StereoViews,
        targets: FrameTargets,
        previous: Option<&FrameLoad>,
    ) -> Result<FrameReport, StereoError> {
        if let Some(load) = previous {
            self.take_load(load);
        }
        let Plan { path, fallback, counts } = self.plan(views, scene)?;
        let is_synthesized = path != StereoPath::TwoViews && self.method == Method::Synthesized;
        // Of the synthesis on every path, since they take turns: images keep their sizes.
        let parts = self.chosen.rendered_parts(scene, views).map(|part| match path {
            StereoPath::TwoViews => part.map(|part| Part { origin: [0, 0], ..part }),
            _ => part,
        });
        // Eyes with an inset are composed of images of this session.
        let mut own = match &targets {
            FrameTargets::Eyes(_) if views.inset.is_some() => Some(self.take_images()?),
            _ => None,
        };
        let mut targets = targets;
        let mut origin = [0, 0];
        let to = match (&mut targets, &mut own) {
            (FrameTargets::Images(images), _) => images.fit(views, is_synthesized, parts)?,
            (FrameTargets::Layers(layers), _) => *layers,
            (FrameTargets::Eyes(to), None) => {
                let dominant = &mut to[views.shown.dominant.index()];
                let takes = |part: &Part| {
                    dominant.color.origin == [0, 0]
                        && dominant.takes_view(part.image_size, &scene.renderer, &scene.scene)
                };
                if let Some(part) = parts[0].filter(takes) {
                    origin = part.origin;
                    dominant.color.origin = origin;
                }
                LayerTargets { wide: *to, inset: None }
            }
            (FrameTargets::Eyes(to), Some(images)) => {
                self.layers_of(images.fit(views, is_synthesized, parts)?, views, to)
            }
        };
        if let Some(auto) = self.auto.as_mut().filter(|_| counts)
            && auto.take_new()
        {
            // Makes everything that the other ways need now, while the scene comes into view, rather than in their first
            // turns.
            for other in auto.paths().iter().filter(|other| **other != path) {
                self.methods(*other)?.0.render(scene, views, &to, (*other, None))?;
            }
        }
        let begin = self.auto.as_ref().filter(|_| counts).and_then(|auto| auto.begin(&to));
        let (methods, near) = self.methods(path)?;
        let near = near.filter(|_| path != StereoPath::TwoViews || fallback == Some(FallbackReason::Near));
        let has_motion = methods.render(scene, views, &to, (path, near))?;
        if let Some(auto) = &mut self.auto {
            auto.end((counts && fallback.is_none()).then_some(path), begin, &to);
        }
        let has_depth = to.wide.iter().all(|eye| eye.depth.is_some());
        match (targets, &mut own) {
            (FrameTargets::Images(images), _) => images.complete(),
            (FrameTargets::Eyes(to), Some(images)) => images.compose(&to)?,
            _ => {}
        }
        self.images = own.or(self.images.take());
        Ok(FrameReport { fallback, has_motion, has_depth, origin })
    }

    /// Decides how a frame is rendered. This is the only place that decides that both eyes must be.
    fn plan(&mut self, views: &StereoViews, scene: &PreparedScene) -> Result<Plan, StereoError> {
        let fallback = self.fallback.of_eyes(views);
        if fallback.is_some() || self.is_comparing && self.method != Method::Conventional {
            return Ok(Plan { path: StereoPath::TwoViews, fallback, counts: false });
        }
        let path = self.auto.as_ref().map_or_else(|| self.named_path(), Auto::path);
        if path == StereoPath::TwoViews {
            return Ok(Plan { path, fallback: None, counts: true });
        }
        self.fallback.prepare(&scene.renderer)?;
        let fallback = self.fallback.of_content();
        let path = if fallback.is_some() { StereoPath::TwoViews } else { path };
        Ok(Plan { path, fallback, counts: true })
    }

    /// Returns the path of the named method.
    fn named_path(&self) -> StereoPath {
        match self.options.holes {
            HoleMethod::Filled => StereoPath::Synthesis,
            HoleMethod::Rendered => StereoPath::RenderedHoles,
        }
    }

    /// Returns the methods of a path, and what measures the dominant eye's depth for later frames.
    fn methods(&mut self, path: StereoPath) -> Result<(&mut LayerMethods, Option<&mut NearSwitch>), GlError> {
        if path == StereoPath::TwoViews {
            self.two_renders()?;
        }
        let both = self.both.as_mut().filter(|_| path == StereoPath::TwoViews);
        Ok((both.unwrap_or(&mut self.chosen), self.fallback.near()))
    }

    /// Returns the targets of layers that are composed into the eyes' targets.
    fn layers_of<'a>(
        &self,
        images: LayerTargets<'a>,
        views: &StereoViews,
        to: &'a [EyeTarget<'a>; 2],
    ) -> LayerTargets<'a> {
        let mut layers = images;
        let has_same_frusta = views.wide.eyes.has_same_frusta(&views.shown);
        for (layer, to) in layers.wide.iter_mut().zip(to) {
            layer.motion = to.motion.filter(|_| has_same_frusta);
            let depth = to.depth_of_wide(views);
            if depth.is_none() {
                to.clear_depth(&self.gl, views.shown.depth);
            }
            layer.depth = layer.depth.or(depth);
        }
        layers
    }

    fn take_images(&mut self) -> Result<StereoImages, GlError> {
        self.images.take().map_or_else(|| StereoImages::new(&self.gl), Ok)
    }

    /// Returns two renders, made on the first call.
    fn two_renders(&mut self) -> Result<&mut LayerMethods, GlError> {
        let made = match self.both.take() {
            Some(made) => made,
            None => LayerMethods::new(&self.gl, Method::Conventional, &self.options)?,
        };
        Ok(self.both.insert(made))
    }

    /// Takes the load of the previous frame into account.
    fn take_load(&mut self, load: &FrameLoad) {
        if let Some(auto) = &mut self.auto {
            auto.end_frame(load);
        }
        if !self.options.motion_vectors || self.options.frame_rate != FrameRate::Auto {
            return;
        }
        // While a path is in use that is not the cheapest, the chooser gives up that path before the rate is halved.
        let is_settled = self.auto.as_ref().is_none_or(|auto| !auto.is_measuring() && !auto.has_cheaper());
        if !is_settled {
            self.rate.interrupt();
        } else if self.rate.frame(load) {
            let which = if self.rate.is_half { "every second frame" } else { "every frame" };
            log::info!("frame-rate: {which} is rendered");
        }
    }
}

/// A method for each layer, whose targets have its size.
struct LayerMethods {
    gl: Rc<Context>,
    method: Method,
    options: StereoOptions,
    wide: Box<dyn StereoMethod>,
    /// Made when first needed.
    inset: Option<Box<dyn StereoMethod>>,
}

impl LayerMethods {
    fn new(gl: &Rc<Context>, method: Method, options: &StereoOptions) -> Result<LayerMethods, GlError> {
        let wide = super::create(gl, method, options)?;
        Ok(LayerMethods { gl: gl.clone(), method, options: *options, wide, inset: None })
    }

    fn prepare(&mut self, scene: &mut PreparedScene, has_inset: bool) -> Result<(), StereoError> {
        let PreparedScene { renderer, scene } = scene;
        self.wide.prepare(renderer, scene)?;
        if has_inset { self.inset()?.prepare(renderer, scene) } else { Ok(()) }
    }

    /// Returns the inset's method, made on the first call.
    fn inset(&mut self) -> Result<&mut dyn StereoMethod, GlError> {
        let inset = match self.inset.take() {
            Some(inset) => inset,
            // A runtime gets motion vectors of the wide layer alone.
            None => {
                let options = StereoOptions { motion_vectors: false, ..self.options };
                super::create(&self.gl, self.method, &options)?
            }
        };
        Ok(self.inset.insert(inset).as_mut())
    }

    /// Returns the dominant eye's place in the view that is rendered for the wide layer, and for the inset, if that view is
    /// rendered where the eye is shown.
    fn rendered_parts(&self, scene: &PreparedScene, views: &StereoViews) -> [Option<Part>; 2] {
        [Some(&views.wide), views.inset.as_ref()].map(|layer| {
            let layer = Frame::rendered_layer(layer?);
            self.wide.rendered_part(&scene.renderer, &scene.scene, &layer)
        })
    }

    /// Renders all layers of a frame along a path. `near` measures the depth of the wide one. Returns true if its motion
    /// vectors were written.
    fn render(
        &mut self,
        scene: &mut PreparedScene,
        views: &StereoViews,
        to: &LayerTargets,
        (path, near): (StereoPath, Option<&mut NearSwitch>),
    ) -> Result<bool, StereoError> {
        let shown = views.inset.map(|_| &views.shown);
        let fills = path == StereoPath::Synthesis;
        let mut render = |method: &mut dyn StereoMethod, layer, to, near, fills_holes| {
            method.prepare(&mut scene.renderer, &scene.scene)?;
            let frame = Frame::new(&scene.renderer, &scene.scene, layer, shown, to)?;
            method.render(&frame.measured_by(near).with_filled_holes(fills_holes))
        };
        // Where an inset is seen best, the layer around it is seen worst.
        let wide_fills = fills || views.inset.is_some();
        let has_motion = render(self.wide.as_mut(), &views.wide, &to.wide, near, wide_fills)?;
        if let Some((layer, to)) = views.inset.as_ref().zip(to.inset.as_ref()) {
            render(self.inset()?, layer, to, None, fills)?;
        }
        Ok(has_motion)
    }
}
