//! Both eyes of every frame: the one thing that a display, the page, the command line or a measurement holds to get them.

use std::rc::Rc;

use super::auto::Auto;
use super::fallback::{Fallback, FallbackReason, NearSwitch};
use super::frame::Frame;
use super::images::{LayerTargets, StereoImages};
use super::method::{EyeTarget, StereoError, StereoMethod};
use super::options::{Method, MethodChoice, StereoOptions};
use super::rate::RateChooser;
use crate::prepared::PreparedScene;
use crate::view::RenderSettings;
use yoro::choice::{Cost, StereoPath};
use yoro::eyes::StereoViews;
use yoro_gl::{Context, GlError};
use yoro_settings::FrameRate;

/// Where both eyes of a frame are written to.
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

/// What a frame cost, when it was handed to the display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameLoad {
    /// The time at which the frame ended, in nanoseconds.
    pub ended_ns: i64,
    /// Rate in Hz at which frames are rendered for the display; 0 if unknown.
    pub refresh_hz: f32,
    /// Refresh rate of the display in Hz, which is twice the former while a runtime makes every second frame.
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
}

/// A method, named or the cheaper of two, and two renders in its place for eyes that it cannot use.
///
/// While sizes stay, frames allocate and compile nothing; the first frame with an inset makes what insets need.
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
    /// Makes the method, or both of [`MethodChoice::Auto`], without what depends on a scene.
    ///
    /// # Errors
    /// [`GlError::Unsupported`] if the driver cannot run the method.
    pub fn new(
        gl: &Rc<Context>,
        choice: MethodChoice,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<StereoSession, GlError> {
        settings.supports(choice.first(), gl.capabilities())?;
        let method = choice.first();
        let is_auto = choice == MethodChoice::Auto;
        let mut session = StereoSession {
            gl: gl.clone(),
            options: *options,
            method,
            chosen: LayerMethods::new(gl, method, options)?,
            both: None,
            auto: is_auto.then(|| Auto::new(gl)),
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

    /// Returns the method; of [`MethodChoice::Auto`], the one chosen last. While a choice is being made, the two take turns.
    pub fn method(&self) -> Method {
        match self.auto.as_ref().map(|auto| auto.choice().path) {
            Some(StereoPath::TwoViews) => Method::Conventional,
            _ => self.method,
        }
    }

    /// Returns the choice between two methods, if there is one.
    pub fn auto(&self) -> Option<&Auto> {
        self.auto.as_ref()
    }

    /// True if the display's runtime is to make the frame after the next one of this session, from motion vectors.
    pub fn leaves_frames_to_runtime(&self) -> bool {
        self.options.motion_vectors
            && match self.options.frame_rate {
                FrameRate::Full => false,
                FrameRate::Half => true,
                FrameRate::Auto => self.rate.is_half(),
            }
    }

    /// Compiles what a scene's materials need, so that its first frame need not.
    ///
    /// # Errors
    /// [`StereoError::Gl`] if the driver refuses.
    pub fn prepare(&mut self, scene: &mut PreparedScene) -> Result<(), StereoError> {
        self.fallback.prepare(&scene.renderer)?;
        let both = self.both.as_mut().filter(|_| self.auto.is_some());
        [Some(&mut self.chosen), both].into_iter().flatten().try_for_each(|methods| methods.prepare(scene))
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
        match targets {
            FrameTargets::Images(images) => self.render(scene, views, &images.fit(views)?),
            FrameTargets::Layers(layers) => self.render(scene, views, &layers),
            FrameTargets::Eyes(to) if views.inset.is_none() => {
                self.render(scene, views, &LayerTargets { wide: to, inset: None })
            }
            FrameTargets::Eyes(to) => self.render_composed(scene, views, &to),
        }
    }

    /// Renders eyes with an inset into images of this session, and composes them.
    fn render_composed(
        &mut self,
        scene: &mut PreparedScene,
        views: &StereoViews,
        to: &[EyeTarget; 2],
    ) -> Result<FrameReport, StereoError> {
        let mut images = match self.images.take() {
            Some(images) => images,
            None => StereoImages::new(&self.gl)?,
        };
        let mut layers = images.fit(views)?;
        if views.wide.eyes.has_same_frusta(&views.shown) {
            for (layer, to) in layers.wide.iter_mut().zip(to) {
                layer.depth = to.depth.filter(|depth| depth.to.size == views.wide.eyes.size);
                layer.motion = to.motion;
            }
        }
        for (_, to) in layers.wide.iter().zip(to).filter(|(layer, _)| layer.depth.is_none()) {
            if let Some(depth) = to.depth.map(|depth| depth.to) {
                self.gl.bind_framebuffer(depth.framebuffer, depth.origin, depth.size);
                self.gl.clear_rectangle(depth.origin, depth.size, Some(views.shown.depth.clear_value()));
            }
        }
        let report = self.render(scene, views, &layers);
        let composed = images.compose(&to.each_ref().map(|eye| eye.color));
        self.images = Some(images);
        composed?;
        report
    }

    /// Renders all layers of a frame by the method, or by two renders.
    fn render(
        &mut self,
        scene: &mut PreparedScene,
        views: &StereoViews,
        to: &LayerTargets,
    ) -> Result<FrameReport, StereoError> {
        let has_depth = to.wide.iter().all(|eye| eye.depth.is_some());
        let eyes_differ = self.fallback.of_eyes(views);
        if eyes_differ.is_some() || self.is_comparing && self.method != Method::Conventional {
            if let Some(auto) = &mut self.auto {
                auto.skip_frame();
            }
            let has_motion = self.two_renders()?.render(scene, views, to, None)?;
            return Ok(FrameReport { fallback: eyes_differ, has_motion, has_depth });
        }
        let path = self.auto.as_ref().map_or(StereoPath::Synthesis, Auto::path);
        let is_new = self.auto.as_mut().is_some_and(Auto::take_new);
        if is_new {
            // Makes everything that the other method needs now, while the scene comes into view, rather than in its first
            // turn.
            self.render_by(path.other(), scene, views, to)?;
        }
        let begin = self.auto.as_ref().and_then(|auto| auto.begin(to));
        let (fallback, has_motion) = self.render_by(path, scene, views, to)?;
        if let Some(auto) = &mut self.auto {
            auto.end(fallback.is_none().then_some(path), begin, to);
        }
        Ok(FrameReport { fallback, has_motion, has_depth })
    }

    /// Renders all layers in one of two ways; by two renders instead of synthesis while most of the view is too near.
    /// Returns this reason, and whether motion vectors were written.
    fn render_by(
        &mut self,
        path: StereoPath,
        scene: &mut PreparedScene,
        views: &StereoViews,
        to: &LayerTargets,
    ) -> Result<(Option<FallbackReason>, bool), StereoError> {
        if path == StereoPath::TwoViews {
            return Ok((None, self.two_renders()?.render(scene, views, to, None)?));
        }
        self.fallback.prepare(&scene.renderer)?;
        let fallback = self.fallback.of_content();
        if fallback.is_some() {
            self.two_renders()?;
        }
        let methods = self.both.as_mut().filter(|_| fallback.is_some()).unwrap_or(&mut self.chosen);
        let has_motion = methods.render(scene, views, to, self.fallback.near())?;
        Ok((fallback, has_motion))
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
        if self.options.motion_vectors
            && self.options.frame_rate == FrameRate::Auto
            && self.rate.frame(load)
        {
            let which = if self.rate.is_half() { "every second frame" } else { "every frame" };
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
    /// Made for the first frame with an inset.
    inset: Option<Box<dyn StereoMethod>>,
}

impl LayerMethods {
    fn new(gl: &Rc<Context>, method: Method, options: &StereoOptions) -> Result<LayerMethods, GlError> {
        let wide = super::create(gl, method, options)?;
        Ok(LayerMethods { gl: gl.clone(), method, options: *options, wide, inset: None })
    }

    fn prepare(&mut self, PreparedScene { renderer, scene }: &mut PreparedScene) -> Result<(), StereoError> {
        let methods = [Some(&mut self.wide), self.inset.as_mut()];
        methods.into_iter().flatten().try_for_each(|method| method.prepare(renderer, scene))
    }

    /// Renders all layers of a frame. `near` measures the depth of the wide one. Returns true if its motion vectors were
    /// written.
    fn render(
        &mut self,
        scene: &mut PreparedScene,
        views: &StereoViews,
        to: &LayerTargets,
        near: Option<&mut NearSwitch>,
    ) -> Result<bool, StereoError> {
        let shown = views.inset.map(|_| &views.shown);
        let mut render = |method: &mut Box<dyn StereoMethod>, layer, to, near| {
            method.prepare(&mut scene.renderer, &scene.scene)?;
            method.render(&Frame::new(&scene.renderer, &scene.scene, layer, shown, to)?.measured_by(near))
        };
        let has_motion = render(&mut self.wide, &views.wide, &to.wide, near)?;
        if let Some((layer, to)) = views.inset.as_ref().zip(to.inset.as_ref()) {
            let inset = match self.inset.take() {
                Some(inset) => inset,
                // A runtime gets motion vectors of the wide layer alone.
                None => {
                    let options = StereoOptions { motion_vectors: false, ..self.options };
                    super::create(&self.gl, self.method, &options)?
                }
            };
            render(self.inset.insert(inset), layer, to, None)?;
        }
        Ok(has_motion)
    }
}
