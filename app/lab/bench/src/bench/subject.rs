//! The two eyes of a frame: the one place through which experiments render them.

use std::rc::Rc;
use std::time::{Duration, Instant};

use super::process;
use yoro::eyes::{EyePair, EyesError, FoveationLevel, Gaze, Levels};
use yoro_gl::{Context, GlError, Profiling};
use yoro_render::stereo::{
    EyeLevels, EyeTarget, FramesBetween, LevelFrame, LevelTargets, Method, MethodChoice, SelectedMethod,
    StereoError, StereoFrame, StereoMethod, StereoOptions,
};
use yoro_render::{PreparedScene, RenderSettings};

/// A stereo method with its programs and targets, ready to be measured.
pub struct Subject {
    gl: Rc<Context>,
    method: SelectedMethod,
    options: StereoOptions,
    level: FoveationLevel,
    /// What eyes of two levels are composed of; `None` without an inset.
    levels: Option<LevelFrame>,
}

/// The time that one frame took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTime {
    /// Wall-clock time up to glFinish.
    pub wall: Duration,
    /// CPU time of all threads of the process.
    pub cpu: Duration,
}

impl Subject {
    /// Compiles the method's programs.
    ///
    /// # Errors
    /// [`GlError`] with the reason if the driver cannot run the method.
    pub fn new(
        gl: &Rc<Context>,
        method: Method,
        settings: &RenderSettings,
        options: &StereoOptions,
    ) -> Result<Subject, GlError> {
        Ok(Subject {
            gl: gl.clone(),
            method: SelectedMethod::new(gl, MethodChoice::Named(method), settings, options)?,
            options: *options,
            level: FoveationLevel::Off,
            levels: None,
        })
    }

    /// Compiles a method that has all pixels only where the eyes look, and always does what its name says.
    ///
    /// # Errors
    /// As [`Subject::new`].
    pub fn foveated(
        gl: &Rc<Context>,
        method: Method,
        settings: &RenderSettings,
        level: FoveationLevel,
    ) -> Result<Subject, GlError> {
        let inset = level.foveation().map(|foveation| foveation.nearest);
        let options = StereoOptions { policy: None, inset, ..StereoOptions::default() };
        let levels = inset.map(|_| LevelFrame::new(gl, false)).transpose()?;
        Ok(Subject { level, levels, ..Subject::new(gl, method, settings, &options)? })
    }

    /// Compiles the same as [`Subject::foveated`] for a runtime that makes frames of motion vectors.
    ///
    /// # Errors
    /// As [`Subject::new`].
    pub fn with_motion(
        gl: &Rc<Context>,
        method: Method,
        settings: &RenderSettings,
        level: FoveationLevel,
    ) -> Result<Subject, GlError> {
        let made = Subject::foveated(gl, method, settings, level)?;
        let options = StereoOptions { frames_between: FramesBetween::Runtime, ..made.options };
        Ok(Subject { levels: made.levels, level, ..Subject::new(gl, method, settings, &options)? })
    }

    /// Renders both eyes into targets of the eyes' size. Motion vectors are those of the wide level.
    ///
    /// # Errors
    /// [`StereoError`] for eyes that the method cannot render, or if GL refuses.
    pub fn render_to(
        &mut self,
        scene: &mut PreparedScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<(), StereoError> {
        let PreparedScene { renderer, scene } = scene;
        let Some(frame) = &mut self.levels else {
            return self.method.render_levels(renderer, scene, &pair.into(), &to.into());
        };
        let levels = levels(pair, self.level, &self.options)?;
        let mut targets: LevelTargets = frame.fit(&levels)?;
        for (own, to) in targets.wide.iter_mut().zip(to) {
            own.motion = to.motion;
        }
        self.method.render_levels(renderer, scene, &EyeLevels::from(&levels), &targets)?;
        frame.compose(&to.map(|eye| eye.color));
        Ok(())
    }

    /// Renders a frame and waits for it.
    ///
    /// # Errors
    /// As [`Subject::render_to`].
    pub fn render(
        &mut self,
        scene: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<FrameTime, StereoError> {
        frame.resize(pair.size)?;
        let targets = frame.targets();
        let (start, cpu) = (Instant::now(), process::cpu_time());
        self.render_to(scene, pair, &targets)?;
        self.gl.finish();
        Ok(FrameTime { wall: start.elapsed(), cpu: process::cpu_time().saturating_sub(cpu) })
    }

    /// Renders a frame at a new place and waits for it, after the method has settled there: the third frame is the first
    /// to know whether all is near.
    ///
    /// # Errors
    /// As [`Subject::render_to`].
    pub fn render_settled(
        &mut self,
        scene: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<FrameTime, StereoError> {
        for _ in 0..if self.options.policy.is_some() { 2 } else { 0 } {
            self.render(scene, pair, frame)?;
        }
        self.render(scene, pair, frame)
    }

    /// Renders a frame after settling, with a timer around each pass. Returns the passes' names in the order of their
    /// first run, and milliseconds. The runs of a pass within a frame are added up. Empty if the driver cannot measure
    /// passes ([`Context::take_pass_times`]).
    ///
    /// # Errors
    /// As [`Subject::render_to`].
    pub fn pass_times(
        &mut self,
        scene: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<Vec<(&'static str, f64)>, StereoError> {
        self.render_settled(scene, pair, frame)?;
        self.gl.set_profiling(Profiling::Auto);
        let rendered = self.render(scene, pair, frame);
        let passes = self.gl.take_pass_times();
        self.gl.set_profiling(Profiling::Off);
        rendered?;
        let mut times: Vec<(&'static str, f64)> = Vec::new();
        for pass in passes {
            let milliseconds = pass.time.as_secs_f64() * 1e3;
            match times.iter_mut().find(|(name, _)| *name == pass.name) {
                Some((_, time)) => *time += milliseconds,
                None => times.push((pass.name, milliseconds)),
            }
        }
        Ok(times)
    }

    /// True if the last frame's motion targets were filled.
    pub fn has_motion(&self) -> bool {
        self.method.report().has_motion
    }

    /// Returns the levels in which a frame is rendered.
    ///
    /// # Errors
    /// [`EyesError`] for eyes that cannot be synthesized.
    pub fn levels(&self, pair: &EyePair) -> Result<Levels, EyesError> {
        levels(pair, self.level, &self.options)
    }
}

/// Returns a pair's levels with the inset on the axes of the eyes.
fn levels(pair: &EyePair, level: FoveationLevel, options: &StereoOptions) -> Result<Levels, EyesError> {
    pair.levels(level.foveation().as_ref(), Gaze::Axes(pair.axes()), options.guard_band)
}
