//! The stereo session: of which method and pipeline it is, and at what quality it renders.

use std::rc::Rc;

use super::Viewer;
use crate::options::{render_settings, stereo_options};
use yoro_gl::{Context, GlError};
use yoro_render::stereo::{
    Auto, FallbackReason, ImBufferSize, Method, MethodChoice, Pipeline, StereoOptions, StereoSession,
};
use yoro_settings::Settings;

/// The methods that a tap goes through.
const TAPPED: [MethodChoice; 4] = [
    MethodChoice::Auto,
    MethodChoice::Named(Method::Synthesized),
    MethodChoice::Named(Method::Conventional),
    MethodChoice::Named(Method::Mono),
];

/// The method and the pipeline in use, which may differ from those of the settings.
pub(super) struct MethodInUse {
    pub choice: MethodChoice,
    pub pipeline: Pipeline,
    /// True if the display's runtime makes frames between those that are rendered.
    pub runtime_makes_frames: bool,
    /// True if all methods of [`MethodChoice::Auto`] were rendered in this second.
    pub is_mixed: bool,
    /// The reason that was logged last for rendering both eyes instead of using the method, while it holds.
    pub fallback: Option<FallbackReason>,
}

impl MethodInUse {
    pub fn new(settings: &Settings) -> MethodInUse {
        MethodInUse {
            choice: settings.method,
            pipeline: settings.pipeline,
            runtime_makes_frames: false,
            is_mixed: false,
            fallback: None,
        }
    }

    /// Logs the reason for rendering both eyes, if it is another one than before.
    pub fn log_fallback(&mut self, fallback: Option<FallbackReason>) {
        let kind = |reason: &FallbackReason| {
            let eyes = match reason {
                FallbackReason::Eyes(error) => Some(std::mem::discriminant(error)),
                _ => None,
            };
            (std::mem::discriminant(reason), eyes)
        };
        if fallback.as_ref().map(kind) != self.fallback.as_ref().map(kind) {
            let name = self.choice.name();
            match &fallback {
                Some(FallbackReason::Eyes(reason)) => {
                    log::warn!("both eyes are rendered instead of using {name}: {reason}");
                }
                Some(reason) => log::info!("both eyes are rendered instead of using {name}: {reason}"),
                None => log::info!("{name} can be used again"),
            }
        }
        self.fallback = fallback;
    }
}

impl Viewer {
    /// Returns the method that the settings or the user have chosen.
    pub fn method(&self) -> MethodChoice {
        self.method.choice
    }

    /// Returns the method that renders; of [`MethodChoice::Auto`], the one chosen last.
    pub(super) fn rendering_method(&self) -> Method {
        self.session.as_ref().map_or(self.method.choice.first(), StereoSession::method)
    }

    /// Returns the automatic choice between methods, if the settings ask for it and the methods are compiled.
    pub(super) fn auto(&self) -> Option<&Auto> {
        self.session.as_ref()?.auto()
    }

    /// Chooses the settings' pipeline, or the one that works with every driver.
    pub(super) fn choose_pipeline(&mut self, gl: &Context) {
        self.method.pipeline = self.settings.pipeline;
        if self.method.pipeline != Pipeline::Gather && !gl.capabilities().compute {
            log::warn!(
                "{} has no compute shaders (OpenGL ES 3.1), which the pipeline {} needs: gather is used instead",
                gl.capabilities().renderer,
                self.method.pipeline.name()
            );
            self.method.pipeline = Pipeline::Gather;
        }
    }

    /// Returns the pipeline's name if the method synthesizes.
    pub(super) fn pipeline_name(&self) -> Option<&'static str> {
        (self.rendering_method() == Method::Synthesized).then(|| self.method.pipeline.name())
    }

    /// Returns the divisor of the ImBuffer's resolution, if the method has an ImBuffer sized relative to the eye.
    pub(super) fn imbuffer_divisor(&self) -> Option<u32> {
        let has_imbuffer =
            self.rendering_method() == Method::Synthesized && self.method.pipeline == Pipeline::Paper;
        match self.stereo_options().synthesis.paper.imbuffer {
            ImBufferSize::Divisor(n) if has_imbuffer => Some(n),
            _ => None,
        }
    }

    /// Returns the settings' options with the pipeline and the ImBuffer in use.
    fn stereo_options(&self) -> StereoOptions {
        let mut options = stereo_options(&self.settings, self.method.pipeline);
        options.motion_vectors = self.method.runtime_makes_frames;
        let (imbuffer, divisor) = (&mut options.synthesis.paper.imbuffer, self.controller.quality().imbuffer);
        *imbuffer = match *imbuffer {
            ImBufferSize::Divisor(n) => ImBufferSize::Divisor(n * divisor),
            ImBufferSize::Fixed(size) => ImBufferSize::Fixed(size.map(|n| (n / divisor).max(1))),
        };
        options
    }

    fn create_session(&self, gl: &Rc<Context>) -> Result<StereoSession, GlError> {
        let settings = render_settings(&self.settings, Some(gl.capabilities()));
        let mut session = StereoSession::new(gl, self.method.choice, &settings, &self.stereo_options())?;
        session.compare(self.menu.is_comparing());
        Ok(session)
    }

    /// Makes the session anew, if there is a scene for it.
    pub(super) fn make_session(&mut self) -> Result<(), GlError> {
        if let Some(attached) = self.attached.as_ref().filter(|_| self.scene.shown.is_some()) {
            self.session = Some(self.create_session(&attached.gl.clone())?);
        }
        self.controller.restart();
        Ok(())
    }

    /// Makes the session for the first time, of synthesis if the driver does not support the method.
    pub(super) fn make_first_session(&mut self, gl: &Rc<Context>) -> Result<(), GlError> {
        let made = match self.create_session(gl) {
            Err(GlError::Unsupported(reason)) if self.method.choice != Method::Synthesized.into() => {
                log::warn!(
                    "{} is used instead of {}: {reason}",
                    Method::Synthesized.name(),
                    self.method.choice.name()
                );
                self.method.choice = Method::Synthesized.into();
                self.create_session(gl)
            }
            made => made,
        }?;
        (self.session, self.load) = (Some(made), None);
        Ok(())
    }

    /// Switches to the next (1) or previous (-1) method of [`TAPPED`] that the driver supports.
    pub(super) fn switch_method(&mut self, step: isize) -> Result<Option<MethodChoice>, GlError> {
        let count = TAPPED.len() as isize;
        let at = TAPPED.iter().position(|method| *method == self.method.choice);
        // A method that is not in the list counts as before the first and after the last.
        let start = at.map_or(if step > 0 { 0 } else { -1 }, |at| at as isize + step);
        for next in (0..count).map(|i| TAPPED[(start + i * step).rem_euclid(count) as usize]) {
            if next == self.method.choice {
                continue;
            }
            let previous = std::mem::replace(&mut self.method.choice, next);
            match self.make_session() {
                Ok(()) => return Ok(Some(next)),
                Err(GlError::Unsupported(reason)) => {
                    log::warn!("the method {} is skipped: {reason}", next.name());
                    self.method.choice = previous;
                }
                Err(error) => {
                    self.method.choice = previous;
                    return Err(error);
                }
            }
        }
        Ok(None)
    }

    /// Makes an automatic choice measure again, after a change of the viewpoint or the resolution.
    pub(super) fn measure_again(&mut self) {
        if let Some(session) = &mut self.session {
            session.measure_again();
        }
    }

    /// Forgets the frames counted so far, which no longer describe the load after a pause.
    pub(super) fn interrupt(&mut self) {
        if let Some(session) = &mut self.session {
            session.interrupt();
        }
        self.load = None;
        self.controller.restart();
    }
}
