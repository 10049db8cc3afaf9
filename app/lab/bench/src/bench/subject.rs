//! The two eyes of a frame: the one place through which experiments render them.

use std::cell::Cell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use super::process;
use yoro::eyes::{EyePair, EyesError, FoveationLevel, Gaze, StereoViews};
use yoro_gl::{Context, Draw, GlError, Observer, Profiling};
use yoro_render::stereo::{
    EyeTarget, FrameReport, FrameTargets, HoleMethod, Method, StereoError, StereoFrame, StereoOptions,
    StereoSession,
};
use yoro_render::{PreparedScene, RenderSettings};

/// A stereo method with its programs and targets, ready to be measured.
pub struct Subject {
    gl: Rc<Context>,
    session: StereoSession,
    options: StereoOptions,
    foveation: FoveationLevel,
}

/// What the passes of one frame took.
pub struct PassCosts {
    /// The passes' names in the order of their first run, and milliseconds. The runs of a pass within a frame are added up.
    /// Empty if the driver cannot measure passes ([`Context::take_pass_times`]).
    pub times: Vec<(&'static str, f64)>,
    /// The number of draw calls of all passes, without copies and clears.
    pub draw_calls: u32,
}

/// Counts draw calls.
struct DrawCounter(Rc<Cell<u32>>);

impl Observer for DrawCounter {
    fn draw_begins(&mut self, _gl: &Context, _draw: &Draw) {
        self.0.set(self.0.get() + 1);
    }
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
            session: StereoSession::new(gl, method.into(), settings, options)?,
            options: *options,
            foveation: FoveationLevel::Off,
        })
    }

    /// Compiles a method that has all pixels only where the eyes look, and always does what its name says. It may write
    /// motion vectors, for a runtime that makes frames of them.
    ///
    /// # Errors
    /// As [`Subject::new`].
    pub fn foveated(
        gl: &Rc<Context>,
        (method, holes): (Method, HoleMethod),
        settings: &RenderSettings,
        foveation: FoveationLevel,
        motion_vectors: bool,
    ) -> Result<Subject, GlError> {
        let options = StereoOptions { policy: None, motion_vectors, holes, ..StereoOptions::default() };
        Ok(Subject { foveation, ..Subject::new(gl, method, settings, &options)? })
    }

    /// Renders both eyes into targets of the eyes' size. Motion vectors are those of the wide layer.
    ///
    /// # Errors
    /// [`StereoError`] for eyes that the method cannot render, or if GL refuses.
    pub fn render_to(
        &mut self,
        scene: &mut PreparedScene,
        pair: &EyePair,
        to: &[EyeTarget; 2],
    ) -> Result<FrameReport, StereoError> {
        let views = self.views(pair)?;
        self.session.frame(scene, &views, FrameTargets::Eyes(*to), None)
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
        self.settle(scene, pair, frame)?;
        self.render(scene, pair, frame)
    }

    /// Renders until the method is what it stays at this place.
    fn settle(
        &mut self,
        scene: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<(), StereoError> {
        for _ in 0..if self.options.policy.is_some() { 2 } else { 0 } {
            self.render(scene, pair, frame)?;
        }
        Ok(())
    }

    /// Renders a frame after settling, with a timer around each pass.
    ///
    /// # Errors
    /// As [`Subject::render_to`].
    pub fn pass_costs(
        &mut self,
        scene: &mut PreparedScene,
        pair: &EyePair,
        frame: &mut StereoFrame,
    ) -> Result<PassCosts, StereoError> {
        self.settle(scene, pair, frame)?;
        let draw_calls = Rc::new(Cell::new(0));
        self.gl.set_observer(Some(Box::new(DrawCounter(draw_calls.clone()))));
        self.gl.set_profiling(Profiling::Auto);
        let rendered = self.render(scene, pair, frame);
        let passes = self.gl.take_pass_times();
        self.gl.set_observer(None);
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
        Ok(PassCosts { times, draw_calls: draw_calls.get() })
    }

    /// Returns what is rendered of a pair of eyes.
    ///
    /// # Errors
    /// [`EyesError`] for eyes that cannot be rendered.
    pub fn views(&self, pair: &EyePair) -> Result<StereoViews, EyesError> {
        pair.stereo_views(self.foveation.foveation().as_ref(), Gaze::Axes(pair.axes()))
    }

    /// Returns the options of the methods.
    pub fn options(&self) -> &StereoOptions {
        &self.options
    }
}
