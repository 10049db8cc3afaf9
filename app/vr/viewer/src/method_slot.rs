//! The stereo method in use, and the quality at which it renders.

use std::rc::Rc;

use crate::adaptive::{Controller, Load, Quality};
use crate::error::ViewerError;
use crate::options::{render_settings, stereo_options};
use crate::rate::RateChooser;
use crate::scene_slot::Shown;
use yoro::choice::Cost;
use yoro::eyes::Foveation;
use yoro_gl::{Context, GlError};
use yoro_render::stereo::{
    Auto, EyeLevels, ImBufferSize, LevelTargets, Method, MethodChoice, Pipeline,
    SelectedMethod, StereoMethod as _, StereoOptions, Substituted,
};
use yoro_settings::{FrameRate, Settings};

/// The stereo method in use. It is created once a scene is loaded.
pub(crate) struct MethodSlot {
    choice: MethodChoice,
    pipeline: Pipeline,
    controller: Controller,
    /// The device's thermal headroom, if it is known.
    headroom: Option<f32>,
    /// True if both methods of [`MethodChoice::Auto`] were rendered in this second.
    is_mixed: bool,
    /// The quality that the controller asked for last.
    quality: Quality,
    /// The reason that was logged last for rendering both eyes instead of using the method, while it holds.
    substituted: Option<Substituted>,
    /// The compiled method, while a scene is shown.
    made: Option<SelectedMethod>,
    /// True while both eyes are rendered for a comparison with the method.
    is_comparing: bool,
    /// True if the display's runtime makes the frames between those that are rendered.
    runtime_makes_frames: bool,
    /// True if the display's runtime shows insets, whatever the settings say since its session began.
    runtime_shows_insets: bool,
    rate: RateChooser,
}

impl MethodSlot {
    /// Creates a slot for the settings' method, at full quality.
    pub fn new(settings: &Settings) -> MethodSlot {
        MethodSlot {
            choice: settings.method,
            pipeline: settings.pipeline,
            controller: Controller::new(),
            headroom: None,
            is_mixed: false,
            quality: Quality::FULL,
            substituted: None,
            made: None,
            is_comparing: false,
            runtime_makes_frames: false,
            runtime_shows_insets: false,
            rate: RateChooser::default(),
        }
    }

    /// Returns method and pipeline, to be restored by [`MethodSlot::set_choice`].
    pub fn choice(&self) -> (MethodChoice, Pipeline) {
        (self.choice, self.pipeline)
    }

    /// Chooses a method and a pipeline without making them.
    pub fn set_choice(&mut self, (choice, pipeline): (MethodChoice, Pipeline)) {
        (self.choice, self.pipeline) = (choice, pipeline);
    }

    /// Chooses the settings' pipeline, or the one that works with every driver.
    pub fn choose_pipeline(&mut self, gl: &Context, settings: &Settings) {
        self.pipeline = settings.pipeline;
        if self.pipeline != Pipeline::Gather && !gl.capabilities().compute {
            log::warn!(
                "{} has no compute shaders (OpenGL ES 3.1), which the pipeline {} needs: gather is used instead",
                gl.capabilities().renderer,
                self.pipeline.name()
            );
            self.pipeline = Pipeline::Gather;
        }
    }

    /// Returns the method in use; with [`MethodChoice::Auto`], the one chosen last.
    pub fn method(&self) -> Method {
        self.auto().map_or(self.choice.first(), Auto::method)
    }

    /// Returns the automatic choice between two methods, if the settings ask for it and the methods are compiled.
    pub fn auto(&self) -> Option<&Auto> {
        self.made.as_ref()?.auto()
    }

    /// Returns the reason for the method in use, for the log line; `None` if the settings name the method.
    pub fn reason(&self) -> Option<String> {
        let auto = self.auto()?;
        Some(if self.is_mixed { "measuring".into() } else { auto.to_string() })
    }

    /// Begins a second of the log.
    pub fn begin_second(&mut self) {
        self.is_mixed = false;
    }

    pub fn pipeline(&self) -> Pipeline {
        self.pipeline
    }

    /// Returns the pipeline's name if the method synthesizes.
    pub fn pipeline_name(&self) -> Option<&'static str> {
        (self.method() == Method::Synthesized).then(|| self.pipeline.name())
    }

    /// Returns the factor by which the quality reduces the render scale.
    pub fn render_scale(&self) -> f32 {
        self.quality.render_scale
    }

    /// Returns the divisor of the ImBuffer's resolution, if the method has an ImBuffer sized relative to the eye.
    pub fn imbuffer_divisor(&self, settings: &Settings) -> Option<u32> {
        match self.options(settings).synthesis.paper.imbuffer {
            ImBufferSize::Divisor(n)
                if self.method() == Method::Synthesized && self.pipeline == Pipeline::Paper =>
            {
                Some(n)
            }
            _ => None,
        }
    }

    /// Returns the settings' options with the pipeline and the ImBuffer in use.
    fn options(&self, settings: &Settings) -> StereoOptions {
        let mut options = stereo_options(settings, self.pipeline);
        options.motion_vectors = self.runtime_makes_frames;
        if self.runtime_shows_insets {
            options.inset = options.inset.or(Some(Foveation::MEDIUM.nearest));
        }
        let (imbuffer, divisor) = (&mut options.synthesis.paper.imbuffer, self.quality.imbuffer);
        *imbuffer = match *imbuffer {
            ImBufferSize::Divisor(n) => ImBufferSize::Divisor(n * divisor),
            ImBufferSize::Fixed(size) => ImBufferSize::Fixed(size.map(|n| (n / divisor).max(1))),
        };
        options
    }

    /// Compiles the chosen method with the present options.
    fn create(&self, gl: &Rc<Context>, settings: &Settings) -> Result<SelectedMethod, GlError> {
        SelectedMethod::new(
            gl,
            self.choice,
            &render_settings(settings, Some(gl.capabilities())),
            &self.options(settings),
        )
    }

    /// Compiles the chosen method, if there is a context with a scene.
    pub fn make(&mut self, gl: Option<&Rc<Context>>, settings: &Settings) -> Result<(), GlError> {
        if let Some(gl) = gl {
            self.made = Some(self.create(gl, settings)?);
        }
        self.controller.restart();
        Ok(())
    }

    /// Compiles the method for the first time, or synthesis if the driver does not support the method.
    pub fn make_first(&mut self, gl: &Rc<Context>, settings: &Settings) -> Result<(), GlError> {
        let made = match self.create(gl, settings) {
            Err(GlError::Unsupported(reason)) if self.choice != Method::Synthesized.into() => {
                log::warn!(
                    "{} is used instead of {}: {reason}",
                    Method::Synthesized.name(),
                    self.choice.name()
                );
                self.choice = Method::Synthesized.into();
                self.create(gl, settings)
            }
            made => made,
        }?;
        self.made = Some(made);
        Ok(())
    }

    /// Drops the objects on the GPU.
    pub fn drop_made(&mut self) {
        self.made = None;
    }

    /// Switches to the next (1) or previous (-1) method of the settings' list that the driver supports.
    pub fn switch(
        &mut self,
        gl: Option<&Rc<Context>>,
        settings: &Settings,
        step: isize,
    ) -> Result<Option<MethodChoice>, GlError> {
        let methods = &settings.methods;
        let count = methods.len() as isize;
        let at = methods.iter().position(|m| *m == self.choice);
        // A method that is not in the list counts as before the first and after the last.
        let start = at.map_or(if step > 0 { 0 } else { -1 }, |at| at as isize + step);
        for next in (0..count).map(|i| methods[(start + i * step).rem_euclid(count) as usize]) {
            if next == self.choice {
                continue;
            }
            let before = std::mem::replace(&mut self.choice, next);
            match self.make(gl, settings) {
                Ok(()) => return Ok(Some(next)),
                Err(GlError::Unsupported(reason)) => {
                    log::warn!("the method {} is skipped: {reason}", next.name());
                    self.choice = before;
                }
                Err(error) => {
                    self.choice = before;
                    return Err(error);
                }
            }
        }
        Ok(None)
    }

    /// Compiles two real renders, so that the first frame of a comparison does not have to.
    pub fn prepare_comparison(&mut self) -> Result<(), GlError> {
        self.made.as_mut().map_or(Ok(()), SelectedMethod::prepare_comparison)
    }

    /// Starts or ends a comparison; returns true if this is a change.
    pub fn compare(&mut self, is_comparing: bool) -> bool {
        std::mem::replace(&mut self.is_comparing, is_comparing) != is_comparing
    }

    /// Says what the display's runtime does: whether it makes the frames between those that are rendered, and whether it
    /// shows insets. Returns true if this is a change, after which the method must be made again.
    pub fn share_with_runtime(&mut self, makes_frames: bool, shows_insets: bool) -> bool {
        let before = (self.runtime_makes_frames, self.runtime_shows_insets);
        (self.runtime_makes_frames, self.runtime_shows_insets) = (makes_frames, shows_insets);
        before != (makes_frames, shows_insets)
    }

    /// True if the display's runtime is to make every second frame.
    pub fn leaves_frames_to_runtime(&self, settings: &Settings) -> bool {
        self.runtime_makes_frames
            && match settings.frame_rate {
                FrameRate::Full => false,
                FrameRate::Half => true,
                FrameRate::Auto => self.rate.is_half(),
            }
    }

    /// True if the last frame's targets have motion vectors.
    pub fn has_motion(&self) -> bool {
        self.made.as_ref().is_some_and(|made| made.report().has_motion)
    }

    /// Renders both eyes of all levels.
    pub fn render(
        &mut self,
        shown: &mut Shown,
        levels: &EyeLevels,
        to: &LevelTargets,
    ) -> Result<(), ViewerError> {
        let made = self.made.as_mut().ok_or(ViewerError::NoContext)?;
        made.compare(self.is_comparing)?;
        made.render_levels(&mut shown.renderer, &shown.scene, levels, to)?;
        let report = made.report();
        self.tell(report.substituted);
        Ok(())
    }

    /// Logs the reason for rendering both eyes, if it is another one than before.
    fn tell(&mut self, substituted: Option<Substituted>) {
        let kind = |reason: &Substituted| {
            let eyes = match reason {
                Substituted::Eyes(error) => Some(std::mem::discriminant(error)),
                _ => None,
            };
            (std::mem::discriminant(reason), eyes)
        };
        if substituted.as_ref().map(kind) != self.substituted.as_ref().map(kind) {
            let name = self.choice.name();
            match &substituted {
                Some(Substituted::Eyes(reason)) => {
                    log::warn!("both eyes are rendered instead of using {name}: {reason}");
                }
                Some(reason) => log::info!("both eyes are rendered instead of using {name}: {reason}"),
                None => log::info!("{name} can be used again"),
            }
        }
        self.substituted = substituted;
    }

    /// Ends a frame that was handed to the display, with the GPU time of an earlier frame if it is known by now.
    pub fn end_frame(&mut self, now_ns: i64, refresh_hz: f32, gpu: Option<Cost>) {
        let Some(auto) = self.made.as_mut().and_then(SelectedMethod::auto_mut) else { return };
        let (was_measuring, before) = (auto.is_measuring(), auto.choice());
        auto.end_frame(now_ns, refresh_hz, gpu, self.headroom);
        self.is_mixed |= was_measuring;
        if was_measuring && !auto.is_measuring() {
            log::debug!("auto: {:?} after {before:?}", auto.choice());
        }
    }

    /// Makes an automatic choice measure again, after a change of the viewpoint or the resolution.
    pub fn measure_again(&mut self) {
        self.rate.interrupt();
        if let Some(auto) = self.made.as_mut().and_then(SelectedMethod::auto_mut) {
            auto.scene_changed();
        }
    }

    /// Takes a frame into account for `frame-rate=auto`. `display_hz` is the rate at which the display refreshes.
    pub fn judge_rate(&mut self, load: &Load, display_hz: f32, settings: &Settings) {
        if settings.frame_rate == FrameRate::Auto
            && self.runtime_makes_frames
            && self.rate.frame(load, display_hz)
        {
            let which = if self.rate.is_half() { "every second frame" } else { "every frame" };
            log::info!("frame-rate: {which} is rendered");
        }
    }

    /// Lets the controller judge a frame, except while two methods are being measured, since both have to have the same
    /// size. Returns true if the method has to be recompiled for another ImBuffer; the controller keeps this rare.
    pub fn adapt(&mut self, load: &Load, settings: &Settings) -> bool {
        if self.auto().is_some_and(Auto::is_measuring) {
            self.controller.restart();
            return false;
        }
        let before = std::mem::replace(&mut self.quality, self.controller.frame(load));
        before.imbuffer != self.quality.imbuffer && self.imbuffer_divisor(settings).is_some()
    }

    /// Sets the device's thermal headroom, if it is known.
    pub fn set_thermal_headroom(&mut self, headroom: Option<f32>) {
        self.headroom = headroom;
        self.controller.set_thermal_headroom(headroom);
    }

    /// Forgets the frames counted so far, which no longer describe the load after a pause.
    pub fn interrupt(&mut self) {
        self.rate.interrupt();
        self.controller.restart();
    }

    /// Restarts the controller for a new session.
    pub fn restart_controller(&mut self) {
        self.controller = Controller::new();
    }

    /// Returns to full quality after a change of the settings.
    pub fn restore_quality(&mut self) {
        self.restart_controller();
        self.quality = Quality::FULL;
    }
}
